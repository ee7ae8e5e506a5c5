//! Checks of sweeps that go beyond the letter's own feedback.

use std::ops::Range;

use super::Draft;
use crate::setting::field::Field;
use crate::setting::law_kind::Formula;
use crate::setting::simulation::NOT_IN_MOTIONS;
use crate::setting::spec::most;
use crate::setting::values::Setting;
use crate::text::SpecError;

const LINEAR: &str = "fields of linear stability take it: n_unstable, abscissa and others";

impl Draft {
    /// Checks that motions and margins support the memory, latency, lags and state of friction of
    /// the sweep.
    pub(super) fn check_beyond_letter(&self, fixed: &Setting) -> Result<(), SpecError> {
        self.check_motions_are_known(fixed)?;
        let law = fixed.law().filter(|law| law.has_state());
        match law.zip(self.of_slope()) {
            Some((law, (what, place))) => {
                let law = format!("the {} law", law.name());
                let message = format!("{what} cannot be had with {law}");
                Err(SpecError::at(place, message).help(format!("leave it out, or {law}; {LINEAR}")))
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
        match most(fixed, &self.axes).beyond_letter(NOT_IN_MOTIONS) {
            Some(parameter) => {
                let message = format!("{} is not known to motions", parameter.name());
                let place = self.given.place(parameter).unwrap_or(field);
                Err(SpecError::at(place.clone(), message).help(LINEAR))
            }
            None => Ok(()),
        }
    }

    /// The first request that is not known where friction has a state, with its place: there the
    /// slope does not describe friction completely.
    fn of_slope(&self) -> Option<(&'static str, Range<usize>)> {
        let margin = |field: Field| field.of_margins() && field != Field::LatencyMargin;
        let slope = |field: Field| field == Field::DAbscissaDMuPrime;
        let found = self.limit.first_field(margin);
        let found = found.or_else(|| self.limit.first_field(slope));
        found.map(|(field, place)| (field.name(), place.clone()))
    }

    /// Checks that the ratio of stiffnesses is asked only of rate-and-state friction.
    pub(super) fn check_stiffness_ratio(&self, fixed: &Setting) -> Result<(), SpecError> {
        let ratio = |field: Field| field == Field::StiffnessRatio;
        let without_state = fixed.rate_and_state().is_none();
        match self.limit.first_field(ratio).filter(|_| without_state) {
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
