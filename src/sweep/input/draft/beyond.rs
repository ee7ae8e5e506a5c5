//! What a sweep beyond the letter's own feedback cannot have.

use std::ops::Range;

use super::Draft;
use crate::sweep::input::field::Field;
use crate::sweep::input::parameter::Parameter;
use crate::sweep::input::setting::Setting;
use crate::sweep::input::simulation::NOT_IN_MOTIONS;
use crate::sweep::input::spec::beyond_letter;
use crate::sweep::input::toml_reader::SpecError;

const LINEAR: &str = "fields of linear stability take it: n_unstable, abscissa and others";

impl Draft {
    /// Motions, margins, best settings and curves know memory, latency and lags as far as they do.
    pub(super) fn check_beyond_letter(&self, fixed: &Setting) -> Result<(), SpecError> {
        let nonlinear = [&self.motion_place, &self.vc_place].into_iter().flatten();
        let basin = self.basin_place.as_ref().map(|(_, place)| place);
        if let Some(field) = nonlinear.chain(basin).next()
            && let Some(parameter) = beyond_letter(fixed, &self.axes, NOT_IN_MOTIONS)
        {
            let message = format!("{} is not known to motions", parameter.name());
            let place = self.given.place(parameter).unwrap_or(field);
            return Err(SpecError::at(place.clone(), message).help(LINEAR));
        }
        let Some(parameter) = beyond_letter(fixed, &self.axes, &Parameter::BEYOND_LETTER) else {
            return Ok(());
        };
        match self.of_letter_alone() {
            Some((what, place)) => {
                let name = parameter.name();
                let message = format!("{what} cannot be had with {name}");
                Err(SpecError::at(place, message)
                    .help(format!("leave it out, or {name}; {LINEAR}")))
            }
            None => Ok(()),
        }
    }

    /// What is asked for that is known of the letter's own feedback alone, and where.
    fn of_letter_alone(&self) -> Option<(&'static str, Range<usize>)> {
        let margins = self.limit.first_field(Field::of_margins);
        let margin = margins.map(|(field, place)| (field.name(), place.clone()));
        let best = self.best.as_ref().map(|place| ("best", place.clone()));
        let curves = self.boundaries_place.as_ref();
        let curves = curves.filter(|_| self.boundaries == Some(true));
        let degrees = self.degrees_place.as_ref();
        margin
            .or(best)
            .or(degrees.map(|place| ("degree_of_stability", place.clone())))
            .or(curves.map(|place| ("boundaries", place.clone())))
    }
}
