//! Checks of sweeps that go beyond the letter's own feedback.

use std::ops::Range;

use super::Draft;
use crate::sweep::input::field::Field;
use crate::sweep::input::law_kind::Formula;
use crate::sweep::input::parameter::Parameter;
use crate::sweep::input::setting::Setting;
use crate::sweep::input::simulation::NOT_IN_MOTIONS;
use crate::sweep::input::spec::beyond_letter;
use crate::sweep::input::toml_reader::SpecError;

const LINEAR: &str = "fields of linear stability take it: n_unstable, abscissa and others";

impl Draft {
    /// Checks that motions and margins support the memory, latency, lags and state of friction of
    /// the sweep.
    pub(super) fn check_beyond_letter(&self, fixed: &Setting) -> Result<(), SpecError> {
        self.check_motions_are_known(fixed)?;
        let law = fixed.law().filter(|law| law.has_state());
        let beyond = match (
            law,
            beyond_letter(fixed, &self.axes, &Parameter::BEYOND_LETTER),
        ) {
            (_, Some(parameter)) => parameter.name().to_owned(),
            (Some(law), None) => format!("the {} law", law.name()),
            (None, None) => return Ok(()),
        };
        match self.of_letter_alone(law.is_some()) {
            Some((what, place)) => {
                let message = format!("{what} cannot be had with {beyond}");
                Err(SpecError::at(place, message)
                    .help(format!("leave it out, or {beyond}; {LINEAR}")))
            }
            None => Ok(()),
        }
    }

    /// Checks that motions support all parameters of the sweep, where motions are followed.
    fn check_motions_are_known(&self, fixed: &Setting) -> Result<(), SpecError> {
        let nonlinear = [&self.motion_place, &self.vc_place].into_iter().flatten();
        let basin = self.basin_place.as_ref().map(|(_, place)| place);
        let Some(field) = nonlinear.chain(basin).next() else {
            return Ok(());
        };
        self.given.check_motions()?;
        match beyond_letter(fixed, &self.axes, NOT_IN_MOTIONS) {
            Some(parameter) => {
                let message = format!("{} is not known to motions", parameter.name());
                let place = self.given.place(parameter).unwrap_or(field);
                Err(SpecError::at(place.clone(), message).help(LINEAR))
            }
            None => Ok(()),
        }
    }

    /// The first request that is supported for the letter's own feedback only, with its place.
    fn of_letter_alone(&self, with_state: bool) -> Option<(&'static str, Range<usize>)> {
        // With a state, the slope does not describe friction completely.
        let slope = |field: Field| field == Field::DAbscissaDMuPrime;
        let slope = self.limit.first_field(slope).filter(|_| with_state);
        let margins = self
            .limit
            .first_field(|f| f.of_margins() && f != Field::LatencyMargin);
        let asked = margins.or(slope);
        asked.map(|(field, place)| (field.name(), place.clone()))
    }

    /// Checks that the ratio of stiffnesses is asked only of rate-and-state friction.
    pub(super) fn check_stiffness_ratio(&self, fixed: &Setting) -> Result<(), SpecError> {
        let ratio = |field: Field| field == Field::StiffnessRatio;
        match self.limit.first_field(ratio).filter(|_| !fixed.has_state()) {
            Some((field, place)) => {
                let law = Formula::RateAndState.name();
                let message = format!("{} is of the {law} law", field.name());
                Err(SpecError::at(place.clone(), message)
                    .help(format!("give [friction] law = \"{law}\", and v0")))
            }
            None => Ok(()),
        }
    }
}
