//! Checks that the entries of a sweep file are consistent.

use std::ops::Range;

use super::SweepFile;
use crate::model::ModelError;
use crate::setting::axis::{Axis, plane_of_curves};
use crate::setting::best_plane::gain_plane;
use crate::setting::field::Field;
use crate::setting::fields_asked::FieldsAsked;
use crate::setting::given_system::GivenSystem;
use crate::setting::limit_spec;
use crate::setting::needs::{Stage, no_meaning, unmet};
use crate::setting::parameter::{Group, Parameter};
use crate::setting::search::Search;
use crate::setting::spec::most;
use crate::setting::values::Setting;
use crate::setting::vc_keys::VcKeys;
use crate::text::{Shown, SpecError};

impl SweepFile<'_> {
    /// Checks a sweep of sliding or of motions. Returns the search for the critical velocity.
    pub(super) fn check(&self) -> Result<Option<Search>, SpecError> {
        let fixed = &self.spec.fixed;
        self.check_needs(fixed, Stage::Protocol)?;
        let without_v0 = self.given.law_place().is_some() && !self.asked(fixed).needs_v0();
        let optional = without_v0.then_some(Parameter::V0);
        self.given
            .check(optional.as_slice(), self.document.key("axes"))?;
        self.check_degrees()?;
        self.check_best()?;
        self.check_curves(fixed)?;
        self.check_law(fixed)?;
        self.check_needs(fixed, Stage::Model)?;
        self.check_nonlinear(fixed)
    }

    /// Checks a sweep of the limit of a short delay. Returns the parameters that are no axes.
    pub(super) fn check_limit(&self) -> Result<Setting, SpecError> {
        let mut keys = self.document.keys();
        if let Some((key, place)) = keys.find(|(key, _)| !limit_spec::KEYS.contains(key)) {
            return Err(self.given.unmet(no_meaning(key), Some(place)));
        }
        self.check_needs(&self.spec.fixed, Stage::Protocol)?;
        let fixed = limit_spec::check(&self.given, self.document.key("axes"))?;
        let none = |p| self.asked(&fixed).values(p).any(|value| value == 0.0);
        if none(Parameter::Gamma) && none(Parameter::DampingRatio) {
            let message = "gamma = 0 is outside its range: greater than 0 without damping_ratio";
            return Err(SpecError {
                span: self.given.place(Parameter::Gamma).cloned(),
                ..SpecError::whole(message)
                    .help("without either a slip is not damped, and stick-slip persists")
            });
        }
        Ok(fixed)
    }

    /// Checks a sweep of a system. Returns the parameters that are no axes.
    pub(super) fn check_system(&self, system: &GivenSystem) -> Result<Setting, SpecError> {
        self.check_degrees()?;
        self.check_curves(&system.setting)?;
        system.check_delay(self.document.key("axes"))?;
        self.check_needs(&system.setting, Stage::Model)?;
        Ok(system.setting.clone())
    }

    /// Checks that boundaries are traced where degrees of stability are requested.
    fn check_degrees(&self) -> Result<(), SpecError> {
        let Some(place) = self.document.key("degree_of_stability") else {
            return Ok(());
        };
        let refuse = |message: &str, help: &str| {
            Err(SpecError::at(place.clone(), format!("degree_of_stability: {message}")).help(help))
        };
        if self.spec.boundaries == Some(false) {
            return refuse(
                "its curves are traced with the boundaries, and boundaries = false",
                "set boundaries = true, or leave degree_of_stability out",
            );
        }
        if plane_of_curves(&self.spec.axes).is_none() {
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
        match self.document.key("best") {
            Some(place) if self.spec.best && gain_plane(&self.spec.axes).is_none() => {
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

    /// Checks that no crossing curves are asked of a digital loop, which would need every delay,
    /// and of systems of which none are known.
    fn check_curves(&self, fixed: &Setting) -> Result<(), SpecError> {
        let asked = [
            ("boundaries", self.spec.boundaries == Some(true)),
            (
                "degree_of_stability",
                !self.spec.degrees_of_stability.is_empty(),
            ),
        ];
        let found = asked.into_iter().find(|(_, asked)| *asked);
        let Some((key, _)) = found else {
            return Ok(());
        };
        let (message, help) = match most(fixed, &self.spec.axes).without_curves() {
            Some(of) => (
                format!("{key}: of {of} no crossing curves are known"),
                "counts, roots and delays of its cells are: leave it out",
            ),
            None if self.spec.is_sampled() => (
                format!("{key} needs every delay"),
                "with a sample time there are delays of whole samples alone: leave it out",
            ),
            None => return Ok(()),
        };
        Err(SpecError {
            span: self.document.key(key).cloned(),
            ..SpecError::whole(message).help(help)
        })
    }

    /// Checks that the law is well posed in every cell: the largest μ0 against the smallest μ_S. A
    /// formula has to be so in one of them.
    fn check_law(&self, fixed: &Setting) -> Result<(), SpecError> {
        if fixed.formula().is_some() {
            let of_law = |axis: &&Axis| match axis.parameter.known() {
                Some(parameter) => matches!(parameter.group(), Group::Law | Group::Pull),
                None => true,
            };
            let axes: Vec<&Axis> = self.spec.axes.iter().filter(of_law).collect();
            let each = values_each(&axes);
            let found = self.check_formula(&axes, each, &mut fixed.clone());
            return found.map_or(Ok(()), Err);
        }
        let mut worst = fixed.clone();
        for axis in &self.spec.axes {
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

/// The most settings at which a formula is checked before a sweep.
const MOST_CHECKED: usize = 10_000;

/// So many values of each axis, from end to end, make no more settings than are checked.
fn values_each(axes: &[&Axis]) -> usize {
    let settings = |each: usize| {
        let counts = axes.iter().map(|axis| axis.len().min(each));
        counts.fold(1, usize::saturating_mul)
    };
    let longest = axes.iter().map(|axis| axis.len()).max().unwrap_or(1);
    let halves = std::iter::successors(Some(longest), |each| Some(each / 2));
    let mut halves = halves.take_while(|&each| each > 1);
    halves
        .find(|&each| settings(each) <= MOST_CHECKED)
        .unwrap_or(2)
}

/// Why friction has no coefficient at rest or at v0; none where it has one.
fn no_coefficient(setting: &Setting) -> Option<ModelError> {
    let has_v0 = !setting.get(Parameter::V0).is_nan();
    match has_v0 {
        true => setting.sliding_point().err(),
        false => setting.friction_law().err(),
    }
}

/// The error, with the value of an axis at which it is found.
fn at_value(error: SpecError, axis: &Axis, value: f64) -> SpecError {
    let at = format!("{} = {}", axis.parameter.name(), Shown(value));
    let help = match &error.help {
        Some(more) => format!("{more}, {at}"),
        None => format!("at {at}"),
    };
    error.help(help)
}

/// Formulas, whose worst values are not known beforehand.
impl SweepFile<'_> {
    /// The first error of a formula where it has no coefficient at rest or at v0 for any of up to
    /// `each` values of these axes, the last ones innermost; none where it has one.
    fn check_formula(
        &self,
        axes: &[&Axis],
        each: usize,
        setting: &mut Setting,
    ) -> Option<SpecError> {
        let Some((axis, others)) = axes.split_first() else {
            let error = no_coefficient(setting)?;
            return Some(self.given.refused(&error));
        };
        let (count, last) = (each.min(axis.len()), axis.len() - 1);
        let mut first = None;
        for i in 0..count {
            let value = axis.values[i * last / (count - 1).max(1)];
            setting.vary(&axis.parameter, value);
            let error = self.check_formula(others, each, setting)?;
            first.get_or_insert_with(|| at_value(error, axis, value));
        }
        first
    }
}

/// What fields need, and what has no effect on them.
impl SweepFile<'_> {
    /// Whether a field of this kind is asked for.
    pub(super) fn asks(&self, of: fn(Field) -> bool) -> bool {
        self.asked.iter().any(|&field| of(field))
    }

    fn asked<'a>(&'a self, fixed: &'a Setting) -> FieldsAsked<'a> {
        FieldsAsked {
            fields: &self.asked,
            fixed,
            ..FieldsAsked::of(&self.spec)
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
        match self.document.key("basin") {
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
            return self
                .vc
                .search(&self.document, self.given.place(phase))
                .map(Some);
        }
        if motion {
            let latest = self.asked(fixed).values(phase).fold(0.0, f64::max);
            let horizon = self.horizon.as_ref();
            self.spec
                .simulation
                .check_horizon(horizon, phase.name(), latest)?;
        }
        Ok(None)
    }

    /// The names and places of what is given about motions: parameters of the start, the table
    /// `[simulation]`.
    fn of_motions(&self) -> impl Iterator<Item = (&'static str, &Range<usize>)> {
        let start = Parameter::ALL.into_iter().filter(|p| p.of_start());
        let start = start.filter_map(|p| Some((p.name(), self.given.place(p)?)));
        start.chain(
            self.document
                .key("simulation")
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
        match VcKeys::given(&self.document) {
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
