//! Checks that the entries of a sweep file are consistent.

use std::ops::Range;

use super::Draft;
use crate::setting::axis::plane_of_curves;
use crate::setting::best_plane::gain_plane;
use crate::setting::field::Field;
use crate::setting::parameter::Parameter;
use crate::setting::search::Search;
use crate::setting::values::Setting;
use crate::text::SpecError;

impl Draft {
    /// Checks a sweep of sliding or of motions. Returns the parameters that are no axes, and the
    /// search for the critical velocity.
    pub(super) fn check(&self) -> Result<(Setting, Option<Search>), SpecError> {
        self.limit.check_absent()?;
        let without_v0 = self.given.law_place().is_some() && !self.needs_v0();
        let optional = without_v0.then_some(Parameter::V0);
        self.given
            .check(optional.as_slice(), self.axes_place.as_ref())?;
        self.check_degrees()?;
        self.check_best()?;
        let fixed = self.given.setting();
        self.check_law(&fixed)?;
        self.check_beyond_letter(&fixed)?;
        self.check_stiffness_ratio(&fixed)?;
        let critical = self.check_nonlinear(&fixed)?;
        Ok((fixed, critical))
    }

    /// Checks that boundaries are traced where degrees of stability are requested.
    pub(super) fn check_degrees(&self) -> Result<(), SpecError> {
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

/// Motions: what their fields need, and what has no effect without them.
impl Draft {
    /// The values of a parameter in the sweep: those of its axis, or the fixed one.
    fn values(&self, fixed: &Setting, parameter: Parameter) -> Vec<f64> {
        let axis = self.axes.iter().find(|axis| axis.parameter == parameter);
        axis.map_or_else(|| vec![fixed.get(parameter)], |axis| axis.values.clone())
    }

    /// Checks the needs of fields of the critical velocity or of motions. Returns the search.
    fn check_nonlinear(&self, fixed: &Setting) -> Result<Option<Search>, SpecError> {
        if let Some((name, place)) = &self.basin_place {
            self.check_no_search()?;
            self.check_basin(fixed, name, place)?;
            return Ok(None);
        }
        if let Some(place) = self.basin.place() {
            let message = "basin has no effect on the fields that are asked for";
            return Err(SpecError::at(place.clone(), message).help(format!(
                "starts are followed for the field {}",
                Field::BasinShare.name()
            )));
        }
        if let Some(place) = &self.vc_place {
            return self.critical_search(fixed, place).map(Some);
        }
        self.check_no_search()?;
        match &self.motion_place {
            Some(place) => self.check_motions(fixed, place)?,
            None => self.check_no_motions()?,
        }
        Ok(None)
    }

    fn check_law_is_there(&self, place: &Range<usize>, why: &str) -> Result<(), SpecError> {
        if self.given.law_place().is_some() {
            return Ok(());
        }
        let message = format!("this field needs a friction law: {why}");
        let help = match self.needs_v0() {
            true => "give [friction] and v0 instead of mu_prime and mu_k",
            false => "give [friction] instead of mu_prime and mu_k",
        };
        Err(SpecError::at(place.clone(), message).help(help))
    }

    /// Checks that no delay is 0 where a gain acts.
    fn check_delays(&self, fixed: &Setting, place: &Range<usize>) -> Result<(), SpecError> {
        let gains = [Parameter::AlphaV, Parameter::AlphaN];
        let mut gains = gains.into_iter().flat_map(|p| self.values(fixed, p));
        let acts = gains.any(|gain| gain != 0.0);
        if acts && self.values(fixed, Parameter::Tau).contains(&0.0) {
            let message = "tau = 0 is outside its range: greater than 0 where gains act and \
                motions are followed";
            let place = self.given.place(Parameter::Tau).unwrap_or(place);
            return Err(SpecError::at(place.clone(), message));
        }
        Ok(())
    }

    fn check_motions(&self, fixed: &Setting, place: &Range<usize>) -> Result<(), SpecError> {
        self.check_law_is_there(place, "motions stick and slip by it")?;
        self.given.check_start()?;
        self.check_delays(fixed, place)?;
        let phases = self.values(fixed, Parameter::SwitchOnPhase);
        let latest = phases.into_iter().fold(0.0, f64::max);
        let name = Parameter::SwitchOnPhase.name();
        self.simulation.check_horizon(name, latest)
    }

    /// Checks the needs of fields over many starts, the first of which is `name`.
    fn check_basin(
        &self,
        fixed: &Setting,
        name: &str,
        place: &Range<usize>,
    ) -> Result<(), SpecError> {
        if self.motion_place.is_some() || self.vc_place.is_some() {
            let others = match self.vc_place {
                Some(_) => "fields of the critical velocity",
                None => "fields of one motion",
            };
            let message = format!("{name} cannot stand beside {others}");
            return Err(SpecError::at(place.clone(), message).help(
                "it is about motions from many starts: make a sweep of its own for it; fields of \
                 linear stability can stand beside it",
            ));
        }
        self.check_law_is_there(place, "motions stick and slip by it")?;
        self.check_delays(fixed, place)?;
        let mut start = Parameter::ALL.into_iter().filter(|p| p.of_start());
        match start.find_map(|p| Some((p, self.given.place(p)?))) {
            Some((parameter, place)) => {
                let message = format!("{} says one start", parameter.name());
                Err(SpecError::at(place.clone(), message).help(format!(
                    "{name} is of many: [basin] says their ranges, or over = \"phase\""
                )))
            }
            None => Ok(()),
        }
    }

    fn check_no_motions(&self) -> Result<(), SpecError> {
        let start = Parameter::ALL.into_iter().filter(|p| p.of_start());
        let start = start.filter_map(|p| Some((p.name(), self.given.place(p)?)));
        let simulation = self.simulation_place.as_ref().map(|s| ("simulation", s));
        match start.chain(simulation).next() {
            Some((name, place)) => {
                let message = format!("{name} has no effect on the fields that are asked for");
                let fields = Field::ALL.into_iter().filter(|f| f.of_motion());
                let names: Vec<_> = fields.map(Field::name).collect();
                let (last, others) = names.split_last().unwrap_or((&"", &[]));
                Err(SpecError::at(place.clone(), message).help(format!(
                    "motions are followed for the fields {} and {last}",
                    others.join(", ")
                )))
            }
            None => Ok(()),
        }
    }
}

/// Critical velocities: what their fields need, and what has no effect without them.
impl Draft {
    /// Whether anything in the sweep depends on v0. A law without v0 still has a critical velocity.
    fn needs_v0(&self) -> bool {
        let fields = self.fields.iter().flatten();
        let curves = self.boundaries == Some(true) || !self.degrees.is_empty();
        let about_v0 = |f: &Field| f.of_sliding() || *f == Field::Regime;
        self.vc_place.is_none()
            || self.best.is_some()
            || curves
            || fields.copied().any(|f| about_v0(&f))
    }

    /// The search, where a field of the critical velocity stands at `place`.
    fn critical_search(&self, fixed: &Setting, place: &Range<usize>) -> Result<Search, SpecError> {
        self.check_law_is_there(place, "the critical velocity depends on the whole of it")?;
        if let Some((name, place)) = &self.start_place {
            let message = format!("{name} cannot stand beside fields of the critical velocity");
            return Err(SpecError::at(place.clone(), message).help(
                "it is about a motion from one start: make a sweep of its own for it; outcome can \
                stand in both",
            ));
        }
        self.check_no_effect_on_vc()?;
        self.check_delays(fixed, place)?;
        let phase = self.given.place(Parameter::SwitchOnPhase);
        self.vc.search(phase)
    }

    /// Checks that nothing is given that would be ignored.
    fn check_no_effect_on_vc(&self) -> Result<(), SpecError> {
        let place = |p: Parameter| Some((p.name(), self.given.place(p)?));
        let v0 = place(Parameter::V0).filter(|_| !self.needs_v0());
        let start = place(Parameter::XDot0).or(place(Parameter::A0));
        let simulation = self.simulation_place.as_ref().map(|s| ("simulation", s));
        let help = match v0 {
            Some(_) => {
                "v0 is what is looked for; the field regime, fields of linear stability and \
                boundaries = true are about one"
            }
            None => {
                "the critical velocity does not depend on where a motion starts, and has \
                accuracies of its own"
            }
        };
        match v0.or(start).or(simulation) {
            Some((name, place)) => {
                let message = format!("{name} has no effect on the fields that are asked for");
                Err(SpecError::at(place.clone(), message).help(help))
            }
            None => Ok(()),
        }
    }

    /// Checks that there are no keys of the critical velocity without a field of it.
    fn check_no_search(&self) -> Result<(), SpecError> {
        match self.vc.given().next() {
            Some((key, place)) => {
                let message = format!("{key} has no effect on the fields that are asked for");
                let fields = Field::ALL.into_iter().filter(|f| f.of_vc());
                let names: Vec<_> = fields.map(Field::name).collect();
                Err(SpecError::at(place.clone(), message)
                    .help(format!("it is for the fields {}", names.join(", "))))
            }
            None => Ok(()),
        }
    }
}
