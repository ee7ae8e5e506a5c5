//! What a sweep beyond the letter's own feedback cannot have.

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
    /// Motions and best settings know memory, latency, lags and a state of friction as far as they
    /// do, margins all but the state.
    pub(super) fn check_beyond_letter(&self, fixed: &Setting) -> Result<(), SpecError> {
        self.check_motions_are_known(fixed)?;
        let law = fixed.law().filter(|law| law.has_state());
        let of_slope =
            law.and_then(|law| Some((self.of_slope()?, format!("the {} law", law.name()))));
        let parameter = beyond_letter(fixed, &self.axes, &Parameter::BEYOND_LETTER);
        let beyond = match (parameter, law) {
            (Some(parameter), _) => Some(parameter.name().to_owned()),
            (None, law) => law.map(|law| format!("the {} law", law.name())),
        };
        let best = || Some((("best", self.best.clone()?), beyond?));
        match of_slope.or_else(best) {
            Some(((what, place), beyond)) => {
                let message = format!("{what} cannot be had with {beyond}");
                Err(SpecError::at(place, message)
                    .help(format!("leave it out, or {beyond}; {LINEAR}")))
            }
            None => Ok(()),
        }
    }

    /// Where motions are followed there is nothing that they do not know.
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

    /// What is asked for that is not known where friction has a state, as the slope does not say
    /// all of it there, and where.
    fn of_slope(&self) -> Option<(&'static str, Range<usize>)> {
        let margin = |field: Field| field.of_margins() && field != Field::LatencyMargin;
        let slope = |field: Field| field == Field::DAbscissaDMuPrime;
        let found = self.limit.first_field(margin);
        let found = found.or_else(|| self.limit.first_field(slope));
        found.map(|(field, place)| (field.name(), place.clone()))
    }

    /// The ratio of stiffnesses is that of one law.
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
