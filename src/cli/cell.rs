//! A cell of a map instead of flags or a case file: `--map MAP.h5 --at AXIS=VALUE`.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use crate::maps::look::as_text::CellTexts;
use crate::report::numbers::unit_behind;
use crate::setting::axis::Axis;
use crate::setting::basin::Basin;
use crate::setting::point_file::{PointOf, PointSpec};
use crate::setting::simulation::Simulation;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::store::MapFile;
use crate::store::tiles::Survey;
use crate::sweep::Plan;
use crate::text::Shown;

use super::at::{At, Axes, parse_at};
use super::failure::Failure;
use super::open::tell_partial;
use super::output::warn_beyond_curve;
use super::say;

#[derive(Debug, clap::Args)]
pub(super) struct CellArgs {
    /// Take everything from a cell of this map
    #[arg(long, value_name = "MAP.h5")]
    pub map: Option<PathBuf>,
    /// With --map: the cell at the value nearest to this; once for each axis of several values
    #[arg(long, value_name = "AXIS=VALUE", value_parser = parse_at, requires = "map")]
    at: Vec<At>,
    /// The plan of the map, once it is read.
    #[arg(skip)]
    read: OnceCell<Plan>,
}

impl CellArgs {
    /// The flags `--at`, each preceded by a space.
    pub(super) fn words(&self) -> String {
        self.at.iter().map(|at| format!(" --at {at}")).collect()
    }

    /// The plan of the map, read once; none without a map.
    fn plan(&self) -> Result<Option<&Plan>, Failure> {
        let Some(path) = &self.map else {
            return Ok(None);
        };
        if self.read.get().is_none() {
            let _ = self.read.set(plan_of(path)?);
        }
        Ok(self.read.get())
    }

    /// The setting of the cell and its units, if the map is of a system from a file.
    pub(super) fn of_system(&self) -> Result<Option<(Setting, Units)>, Failure> {
        let Some(plan) = self.plan()? else {
            return Ok(None);
        };
        match plan.spec.fixed.system() {
            Some(_) => Ok(Some((
                plan.setting(&self.index(plan)?),
                plan.spec.units.clone(),
            ))),
            None => Ok(None),
        }
    }

    /// The requests about the cell, and its setting; none without a map.
    fn texts(&self) -> Result<Option<(CellTexts, Setting)>, Failure> {
        let Some(plan) = self.plan()? else {
            return Ok(None);
        };
        let index = self.index(plan)?;
        let setting = plan.setting(&index);
        Ok(Some((CellTexts::of(plan, &index), setting)))
    }

    /// The index of the cell along every axis. It also reports the cell.
    fn index(&self, plan: &Plan) -> Result<Vec<usize>, Failure> {
        let index = self.places(plan)?;
        let mut there = Vec::new();
        for (axis, &place) in plan.spec.axes.iter().zip(&index) {
            let unit = unit_behind(&axis.parameter.unit(&plan.spec.units));
            let (name, value) = (axis.parameter.name(), Shown(axis.values[place]));
            there.push(format!("{name} = {value}{unit}"));
        }
        say::note(format_args!("the cell at {}", there.join(", ")));
        Ok(index)
    }

    /// The point of sliding at the cell, or its critical velocity.
    pub(super) fn point(&self, of: PointOf) -> Result<Option<PointSpec>, Failure> {
        let Some((texts, setting)) = self.texts()? else {
            return Ok(None);
        };
        let (text, needed) = if of == PointOf::CriticalVelocity {
            (texts.vc, &[Needed::Law, Needed::Delay][..])
        } else {
            let units = self.plan()?.map(|plan| &plan.spec.units);
            warn_beyond_curve(units.and_then(|units| setting.curve_remark(units)));
            (texts.point, &[Needed::V0, Needed::Delay][..])
        };
        let of_block = text.filter(|_| setting.system().is_none());
        let text = of_block.ok_or_else(|| without(&setting, needed))?;
        let read = PointSpec::read(&text, of);
        read.map(Some)
            .map_err(|error| Failure::in_file(error, "the cell", &text))
    }

    /// The starts of the map's shares, and how they are followed; none without a map, or if it has
    /// no shares.
    pub(super) fn basin(&self) -> Result<Option<(Basin, Simulation)>, Failure> {
        let Some(Plan { spec, .. }) = self.plan()? else {
            return Ok(None);
        };
        Ok(spec.basin.map(|basin| (basin, spec.simulation.clone())))
    }

    /// The case of the motion at the cell.
    pub(super) fn case(&self) -> Result<Option<String>, Failure> {
        let text = self.texts()?.map(|(texts, setting)| {
            let needed = [Needed::Law, Needed::V0, Needed::Delay];
            texts.motion.ok_or_else(|| without(&setting, &needed))
        });
        text.transpose()
    }

    /// The place on every axis that has one value or is given one.
    fn places(&self, plan: &Plan) -> Result<Vec<usize>, Failure> {
        let places = Axes::from(plan).held(&self.at)?;
        let place = |(axis, place): (&Axis, Option<usize>)| match place {
            None if axis.len() == 1 => Ok(0),
            place => place.ok_or_else(|| not_given(axis)),
        };
        plan.spec.axes.iter().zip(places).map(place).collect()
    }
}

/// The failure without a value on an axis of several.
fn not_given(axis: &Axis) -> Failure {
    let name = axis.parameter.name();
    let (low, high) = axis.range();
    let [low, high, first] = [low, high, axis.values[0]].map(Shown);
    let help = format!("for example --at {name}={first}; from {low} to {high}");
    Failure::bad_input_with_help(format!("--at {name}=VALUE is not given"), help)
}

/// Refuses other flags of the setting if a cell of a map or a file gives it.
pub(super) fn alone(flag: &str, given: bool) -> Result<(), Failure> {
    match given {
        false => Ok(()),
        true => Err(Failure::bad_input_with_help(
            format!("{flag} is given with other flags"),
            match flag {
                "--map" => "the map says everything but the cell, which --at says",
                "--system" => "--set and --tau say everything of it",
                _ => "edit the file, or give all flags in its place",
            },
        )),
    }
}

/// What a command may need of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Needed {
    Law,
    V0,
    Delay,
}

impl Needed {
    /// Its name, if a setting lacks it.
    fn lacking(self, setting: &Setting) -> Option<&'static str> {
        let lacks = |parameter| setting.get(parameter).is_nan();
        match self {
            Self::Law => setting.law().is_none().then_some("friction law"),
            Self::V0 => (setting.law().is_some() && lacks(Parameter::V0)).then_some("v0"),
            Self::Delay => lacks(Parameter::Tau).then_some("delay"),
        }
    }
}

/// The failure of a cell that lacks what a command needs.
fn without(setting: &Setting, needed: &[Needed]) -> Failure {
    if setting.system().is_some() {
        return Failure::bad_input_with_help(
            "this map is one of a system from a file, which has counts, roots and delays alone",
            "slipmap point --map takes its cells",
        );
    }
    let lacking = needed.iter().filter_map(|needed| needed.lacking(setting));
    match lacking.collect::<Vec<_>>()[..] {
        // A cell of the limit of a short delay lacks nothing, but is of another kind.
        [] => Failure::bad_input_with_help(
            "this map is one of the limit of a short delay",
            "its cells are asked for by slipmap vc --protocol limit --gamma G --mu-ratio R",
        ),
        ref lacking => Failure::bad_input(format!(
            "a cell of this map has no {}",
            lacking.join(" and no ")
        )),
    }
}

/// The plan of a map or, if it does not exist yet, of its tiles.
fn plan_of(path: &Path) -> Result<Plan, Failure> {
    if !path.exists()
        && let Some(survey) = Survey::of(path)?
    {
        let cells = survey.plan.cells();
        tell_partial(path, cells - survey.cells_done.min(cells), cells);
        return Ok(survey.plan);
    }
    let map = MapFile::open(path)?;
    let plan = map.sweep().and_then(Plan::new);
    plan.map_err(|e| Failure::in_file(e, &path.display().to_string(), &map.sweep_text()))
}
