//! A cell of a map in the place of flags and case files: `--map MAP.h5 --at AXIS=VALUE`.

use std::path::{Path, PathBuf};

use slipmap::maps::look::as_text::CellTexts;
use slipmap::store::MapFile;
use slipmap::sweep::input::axis::{Axis, nearest};
use slipmap::sweep::input::basin::Basin;
use slipmap::sweep::input::nearest::did_you_mean;
use slipmap::sweep::input::point_file::{PointOf, PointSpec};
use slipmap::sweep::input::simulation::Simulation;
use slipmap::sweep::{Parameter, Plan};

use super::failure::Failure;
use super::say;

#[derive(Debug, clap::Args)]
pub(super) struct CellArgs {
    /// Take everything from a cell of this map
    #[arg(long, value_name = "MAP.h5")]
    pub map: Option<PathBuf>,
    /// With --map: the cell at the value nearest to this; once for each axis of several values
    #[arg(long, value_name = "AXIS=VALUE", value_parser = parse_at, requires = "map")]
    at: Vec<(Parameter, f64)>,
}

/// A parameter and its value, as flags say where on an axis.
pub(super) fn parse_at(text: &str) -> Result<(Parameter, f64), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("expected AXIS=VALUE, for example mu_prime=-0.3")?;
    let name = name.trim().replace('-', "_");
    let parameter = Parameter::from_name(&name).ok_or_else(|| {
        let names = Parameter::ALL.map(Parameter::name);
        let meant = did_you_mean(&name, names);
        format!(
            "unknown axis \"{name}\"; {meant}known: {}",
            names.join(", ")
        )
    })?;
    let value = value.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let value = value.ok_or("the value after = must be a finite number")?;
    Ok((parameter, value))
}

impl CellArgs {
    /// The flags `--at`, each after a space.
    pub(super) fn words(&self) -> String {
        let at = self.at.iter();
        at.map(|(axis, value)| format!(" --at {}={value}", axis.name()))
            .collect()
    }

    /// What can be asked at the cell; none where no map is given. Says which cell it is.
    pub(super) fn texts(&self) -> Result<Option<CellTexts>, Failure> {
        let Some(path) = &self.map else {
            return Ok(None);
        };
        let plan = plan_of(path)?;
        self.check_axes(&plan)?;
        let mut index = Vec::new();
        let mut there = Vec::new();
        for axis in &plan.spec.axes {
            let place = self.place(axis)?;
            there.push(format!(
                "{} = {}",
                axis.parameter.name(),
                axis.values[place]
            ));
            index.push(place);
        }
        say::note(format_args!("the cell at {}", there.join(", ")));
        Ok(Some(CellTexts::of(&plan, &index)))
    }

    /// The point of sliding at the cell, or its critical velocity.
    pub(super) fn point(&self, of: PointOf) -> Result<Option<PointSpec>, Failure> {
        let Some(texts) = self.texts()? else {
            return Ok(None);
        };
        let (text, lacks) = match of {
            PointOf::CriticalVelocity => (texts.vc, "its friction law or its delay"),
            _ => (texts.point, "its v0 or its delay"),
        };
        let text = text.ok_or_else(|| without(lacks))?;
        let read = PointSpec::read(&text, of);
        read.map(Some)
            .map_err(|error| Failure::in_file(error, "the cell", &text))
    }

    /// Of which starts the shares of the map are, and how these are followed; none where no map is
    /// given or it has no shares.
    pub(super) fn basin(&self) -> Result<Option<(Basin, Simulation)>, Failure> {
        let Some(path) = &self.map else {
            return Ok(None);
        };
        let spec = plan_of(path)?.spec;
        Ok(spec.basin.map(|basin| (basin, spec.simulation)))
    }

    /// The case of the motion at the cell.
    pub(super) fn case(&self) -> Result<Option<String>, Failure> {
        let texts = self.texts()?;
        let text = texts.map(|texts| {
            texts
                .motion
                .ok_or_else(|| without("its friction law or its v0"))
        });
        text.transpose()
    }

    /// Values are given on axes alone.
    fn check_axes(&self, plan: &Plan) -> Result<(), Failure> {
        let axes: Vec<_> = plan.spec.axes.iter().map(|axis| axis.parameter).collect();
        self.at
            .iter()
            .try_for_each(|(at, _)| axis_of(*at, &axes).map(drop))
    }

    /// Where on an axis: at the value nearest to the one given.
    fn place(&self, axis: &Axis) -> Result<usize, Failure> {
        let name = axis.parameter.name();
        let given = self.at.iter().filter(|(at, _)| *at == axis.parameter);
        let value = match given.map(|(_, value)| *value).collect::<Vec<_>>()[..] {
            [] if axis.len() == 1 => return Ok(0),
            [value] => value,
            [] => {
                let (low, high) = axis.range();
                let first = axis.values[0];
                let help = format!("for example --at {name}={first}; from {low} to {high}");
                let message = format!("--at {name}=VALUE is not given");
                return Err(Failure::bad_input_with_help(message, help));
            }
            _ => return Err(Failure::bad_input(format!("--at {name} is given twice"))),
        };
        place_on(axis.parameter, &axis.values, value)
    }
}

/// The number of an axis among `axes`.
pub(super) fn axis_of(at: Parameter, axes: &[Parameter]) -> Result<usize, Failure> {
    let place = axes.iter().position(|axis| *axis == at);
    place.ok_or_else(|| {
        let names: Vec<_> = axes.iter().map(|axis| axis.name()).collect();
        Failure::bad_input_with_help(
            format!("--at: {} is no axis of this map", at.name()),
            format!("its axes: {}", names.join(", ")),
        )
    })
}

/// The place on an axis of the value nearest to `value`, which the axis reaches.
pub(super) fn place_on(of: Parameter, values: &[f64], value: f64) -> Result<usize, Failure> {
    nearest(values, value).map_err(|[low, high]| {
        let message = format!("--at {}={value} is outside the axis", of.name());
        let help = format!("it goes from {low} to {high}");
        Failure::bad_input_with_help(message, help)
    })
}

/// Nothing else says what is asked where a cell or a file does.
pub(super) fn alone(flag: &str, given: bool) -> Result<(), Failure> {
    match given {
        false => Ok(()),
        true => Err(Failure::bad_input_with_help(
            format!("{flag} is given with other flags of the point"),
            match flag {
                "--map" => "the map says everything but the cell, which --at says",
                _ => "the file says everything",
            },
        )),
    }
}

fn without(lacks: &str) -> Failure {
    Failure::bad_input(format!("a cell of this map does not say {lacks}"))
}

/// The plan of a map.
fn plan_of(path: &Path) -> Result<Plan, Failure> {
    let map = MapFile::open(path)?;
    let plan = map.sweep().and_then(Plan::new);
    plan.map_err(|e| Failure::in_file(e, &path.display().to_string(), &map.sweep_text()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_on_axes_are_read() {
        assert_eq!(parse_at("mu_prime=-0.3"), Ok((Parameter::MuPrime, -0.3)));
        assert_eq!(parse_at("mu-prime = 1e-2"), Ok((Parameter::MuPrime, 0.01)));
        for (text, says) in [
            ("tau", "AXIS=VALUE"),
            ("delay=3", "unknown axis \"delay\""),
            ("tau=", "finite number"),
            ("tau=inf", "finite number"),
        ] {
            let error = parse_at(text).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
    }
}
