//! Checks that the entries of a sweep file are consistent.

use std::ops::Range;

use super::Draft;
use crate::setting::axis::plane_of_curves;
use crate::setting::best_plane::gain_plane;
use crate::setting::field::Field;
use crate::setting::limit_spec;
use crate::setting::needs::{Asked, Stage, no_meaning, unmet};
use crate::setting::parameter::Parameter;
use crate::setting::search::Search;
use crate::setting::system_draft::SystemDraft;
use crate::setting::values::Setting;
use crate::text::SpecError;

impl Draft {
    /// Checks a sweep of sliding or of motions. Returns the parameters that are no axes, and the
    /// search for the critical velocity.
    pub(super) fn check(&self) -> Result<(Setting, Option<Search>), SpecError> {
        let fixed = self.given.setting();
        self.check_needs(&fixed, Stage::Protocol)?;
        let without_v0 = self.given.law_place().is_some() && !self.asked(&fixed).needs_v0();
        let optional = without_v0.then_some(Parameter::V0);
        self.given
            .check(optional.as_slice(), self.axes_place.as_ref())?;
        self.check_degrees()?;
        self.check_best()?;
        self.check_law(&fixed)?;
        self.check_needs(&fixed, Stage::Model)?;
        let critical = self.check_nonlinear(&fixed)?;
        Ok((fixed, critical))
    }

    /// Checks a sweep of the limit of a short delay. Returns the parameters that are no axes.
    pub(super) fn check_limit(&self) -> Result<Setting, SpecError> {
        if let Some((key, place)) = &self.foreign {
            return Err(self.given.unmet(no_meaning(key), Some(place)));
        }
        self.check_needs(&self.given.setting(), Stage::Protocol)?;
        limit_spec::check(&self.given, self.axes_place.as_ref())
    }

    /// Checks a sweep of a system. Returns the parameters that are no axes.
    pub(super) fn check_system(&self, system: &SystemDraft) -> Result<Setting, SpecError> {
        self.check_degrees()?;
        let tau = Parameter::Tau;
        if !system.given.iter().any(|(of, _)| *of == tau) {
            return Err(SpecError {
                span: self.axes_place.clone(),
                ..SpecError::whole("tau is not given").help(format!(
                    "tau: {}, {}",
                    tau.long_name(),
                    tau.allowed()
                ))
            });
        }
        self.check_needs(&system.setting, Stage::Model)?;
        Ok(system.setting.clone())
    }

    /// Checks that boundaries are traced where degrees of stability are requested.
    fn check_degrees(&self) -> Result<(), SpecError> {
        let Some(place) = &self.degrees_place else {
            return Ok(());
        };
        let refuse = |message: &str, help: &str| {
            Err(SpecError::at(place.clone(), format!("degree_of_stability: {message}")).help(help))
        };
        if self.boundaries == Some(false) {
            return refuse(
                "its curves are traced with the boundaries, and boundaries = false",
                "set boundaries = true, or leave degree_of_stability out",
            );
        }
        if plane_of_curves(&self.axes).is_none() {
            return refuse(
                "there is no plane for its curves",
                "two axes of linear stability are needed, such as a gain and tau, each with two \
                 values or more",
            );
        }
        Ok(())
    }

    /// Checks that the sweep has axes for a gain and the delay, the planes of best settings.
    fn check_best(&self) -> Result<(), SpecError> {
        match &self.best {
            Some(place) if gain_plane(&self.axes).is_none() => {
                let message =
                    "best needs an axis of a gain and one of the delay, with two points or more";
                Err(SpecError::at(place.clone(), message).help(
                    "alpha_v or alpha_n, and tau, in [axes]; the best setting is looked for within \
                        their ranges",
                ))
            }
            _ => Ok(()),
        }
    }

    /// Checks that the law is well posed in every cell: the largest μ0 against the smallest μ_S.
    fn check_law(&self, fixed: &Setting) -> Result<(), SpecError> {
        let mut worst = fixed.clone();
        for axis in &self.axes {
            let (smallest, largest) = axis.range();
            // With a given slope at rest, μ0 grows with v_s and with the magnitude of the slope.
            let Some(parameter) = axis.parameter.known() else {
                continue;
            };
            let value = match parameter {
                Parameter::Mu0 | Parameter::VS => largest,
                _ => smallest,
            };
            worst.set(parameter, value);
        }
        worst
            .friction_law()
            .map(|_| ())
            .map_err(|error| self.given.refused(&error))
    }
}

/// What fields need, and what has no effect on them.
impl Draft {
    /// Whether a field of this kind is asked for.
    pub(super) fn asks(&self, of: fn(Field) -> bool) -> bool {
        self.asked.iter().any(|&field| of(field))
    }

    fn asked<'a>(&'a self, fixed: &'a Setting) -> Asked<'a> {
        let curves = self.boundaries == Some(true) || !self.degrees.is_empty();
        Asked {
            fields: &self.asked,
            fixed,
            axes: &self.axes,
            limit: self.is_limit,
            planes: curves || self.best.is_some(),
        }
    }

    /// Checks the needs of a stage.
    fn check_needs(&self, fixed: &Setting, stage: Stage) -> Result<(), SpecError> {
        let Some((field, unmet)) = unmet(&self.asked(fixed), stage) else {
            return Ok(());
        };
        let place = self.asked.iter().position(|asked| *asked == field);
        Err(self.given.unmet(unmet, place.map(|i| &self.places[i])))
    }

    /// Checks what fields of the critical velocity or of motions need of one another, of the law
    /// and of values, and that nothing is given that would be ignored. Returns the search.
    fn check_nonlinear(&self, fixed: &Setting) -> Result<Option<Search>, SpecError> {
        let kinds = [Field::of_basin, Field::of_vc, Field::of_motion];
        let [basin, vc, motion] = kinds.map(|of| self.asks(of));
        match self.basin.place() {
            Some(place) if !basin => {
                let share = Field::BasinShare.name();
                let help = format!("starts are followed for the field {share}");
                return Err(no_effect("basin", place).help(help));
            }
            _ => {}
        }
        if basin || !vc {
            self.check_no_search()?;
        }
        self.check_needs(fixed, Stage::Company)?;
        if vc {
            self.check_no_effect_on_vc(fixed)?;
        } else if !motion && !basin {
            self.check_no_motions()?;
        }
        self.check_needs(fixed, Stage::Values)?;
        let phase = Parameter::SwitchOnPhase;
        if vc {
            return self.vc.search(self.given.place(phase)).map(Some);
        }
        if motion {
            let latest = self.asked(fixed).values(phase).fold(0.0, f64::max);
            self.simulation.check_horizon(phase.name(), latest)?;
        }
        Ok(None)
    }

    /// The names and places of what is given about motions: parameters of the start, the table
    /// `[simulation]`.
    fn of_motions(&self) -> impl Iterator<Item = (&'static str, &Range<usize>)> {
        let start = Parameter::ALL.into_iter().filter(|p| p.of_start());
        let start = start.filter_map(|p| Some((p.name(), self.given.place(p)?)));
        start.chain(
            self.simulation_place
                .as_ref()
                .map(|place| ("simulation", place)),
        )
    }

    /// Checks that nothing is given about motions without a field of them.
    fn check_no_motions(&self) -> Result<(), SpecError> {
        let Some((name, place)) = self.of_motions().next() else {
            return Ok(());
        };
        let names = names(Field::of_motion);
        let (last, others) = names.split_last().unwrap_or((&"", &[]));
        Err(no_effect(name, place).help(format!(
            "motions are followed for the fields {} and {last}",
            others.join(", ")
        )))
    }

    /// Checks that nothing is given that has no effect on a critical velocity.
    fn check_no_effect_on_vc(&self, fixed: &Setting) -> Result<(), SpecError> {
        let v0 = self
            .given
            .place(Parameter::V0)
            .filter(|_| !self.asked(fixed).needs_v0());
        if let Some(place) = v0 {
            return Err(no_effect(Parameter::V0.name(), place).help(
                "v0 is what is looked for; the field regime, fields of linear stability and \
                 boundaries = true are about one",
            ));
        }
        let phase = Parameter::SwitchOnPhase.name();
        match self.of_motions().find(|(name, _)| *name != phase) {
            Some((name, place)) => Err(no_effect(name, place).help(
                "the critical velocity does not depend on where a motion starts, and has \
                 accuracies of its own",
            )),
            None => Ok(()),
        }
    }

    /// Checks that there are no keys of the critical velocity without a field of it.
    fn check_no_search(&self) -> Result<(), SpecError> {
        match self.vc.given().next() {
            Some((key, place)) => Err(no_effect(key, place).help(format!(
                "it is for the fields {}",
                names(Field::of_vc).join(", ")
            ))),
            None => Ok(()),
        }
    }
}

fn no_effect(name: &str, place: &Range<usize>) -> SpecError {
    let message = format!("{name} has no effect on the fields that are asked for");
    SpecError::at(place.clone(), message)
}

fn names(of: fn(Field) -> bool) -> Vec<&'static str> {
    let fields = Field::ALL.into_iter().filter(|field| of(*field));
    fields.map(Field::name).collect()
}
