//! The flags for a point of parameter space, with the same words as sweep files.

use std::marker::PhantomData;

use crate::model::{ModelError, RateAndState};
use crate::setting::Parameter;
use crate::setting::law_kind::{LawKind, NO_MOTIONS, NamedLaw};
use crate::setting::measured::{CurveOptions, Spoken};
use crate::setting::parameter::Group;
use crate::setting::simulation::NOT_IN_MOTIONS;
use crate::setting::units::Units;
use crate::setting::values::Setting;
use crate::text::Shown;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};

use super::asks::{Asks, OfSliding};
use super::assumed_units::units_of;
use super::failure::Failure;
use super::formula_args;
use super::law_args::{LawArgs, law_names};
use super::output::{tell_assumed_units, warn_beyond_curve, warn_of_idle_delay};
use super::parameter_values::Values;
use super::say;
use super::sets::SetArgs;
use super::sweep_file::read_table;

/// The failure for a law with a state where motions are followed.
fn no_motions() -> Failure {
    let law = RateAndState::FORM.name;
    Failure::bad_input_with_help(format!("--friction {law} has no motions here"), NO_MOTIONS)
}

/// The flag that rounds delays.
const ROUND_DELAY: &str = "round-delay";

/// A point of parameter space.
#[derive(Debug)]
pub(super) struct ParameterArgs<A: Asks = OfSliding> {
    values: Values,
    /// The text of --mu-k.
    mu_k: Option<String>,
    law: LawArgs,
    /// The units of all numbers.
    units: Units,
    /// Whether delay and latency are rounded to whole multiples of the sample time.
    rounds: bool,
    asks: PhantomData<A>,
}

impl<A: Asks> ParameterArgs<A> {
    /// Whether parameters of this group also exist without a friction law.
    const fn without_law(group: Group) -> bool {
        matches!(group, Group::Model | Group::Sliding)
    }

    const fn of_law(group: Group) -> bool {
        matches!(group, Group::Pull | Group::Law)
    }

    /// Hides flags that would always be refused from the help. If one is given nevertheless, the
    /// error says why.
    fn offered(arg: Arg) -> Arg {
        let parameter = Parameter::from_name(arg.get_id().as_str());
        let of_slope = |p: Parameter| p.group() == Group::Sliding;
        let moves = |p: Parameter| !NOT_IN_MOTIONS.contains(&p) && !LawKind::only_with_state(p);
        let refused = |p: Parameter| (of_slope(p) && p != Parameter::MuK) || !moves(p);
        arg.hide(A::LAW && parameter.is_some_and(refused))
    }
}

impl<A: Asks> Args for ParameterArgs<A> {
    fn augment_args(command: Command) -> Command {
        let command = command.args(Values::flags(Self::without_law).map(Self::offered));
        let command = LawArgs::augment_args(command);
        let command = match A::LAW {
            true => command.mut_arg("friction", |arg| {
                arg.help("Friction law").value_parser(law_names(true))
            }),
            false => command,
        };
        let command = command.args(Values::flags(Self::of_law).map(Self::offered));
        let round = Arg::new(ROUND_DELAY)
            .long(ROUND_DELAY)
            .action(ArgAction::SetTrue);
        command.arg(round.help("With --sample-time: round delay and latency to multiples of it"))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<A: Asks> FromArgMatches for ParameterArgs<A> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let wanted = |group| Self::without_law(group) || Self::of_law(group);
        let law = LawArgs::from_arg_matches(matches)?;
        let units = units_of(matches, law.units.as_ref());
        let mut values = Values::of(matches, wanted, &units)?;
        if law.friction.as_deref() == Some(LawKind::FORMULA) {
            values.forget(Parameter::MuK);
        }
        Ok(Self {
            values,
            mu_k: Values::text(matches).cloned(),
            law,
            units,
            rounds: matches.get_flag(ROUND_DELAY),
            asks: PhantomData,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The flag of a parameter; the name of a parameter without one.
pub(super) fn flag(parameter: Parameter) -> String {
    match parameter.long_flag() {
        Some(flag) => format!("--{flag}"),
        None => parameter.key(),
    }
}

impl<A: Asks> ParameterArgs<A> {
    pub(super) fn given(&self, parameter: Parameter) -> Option<f64> {
        self.values.get(parameter)
    }

    pub(super) fn sets(&self) -> &SetArgs {
        &self.law.sets
    }

    /// The friction law of the flags, with the points of its file.
    fn law(&self) -> Result<Option<LawKind>, Failure> {
        if self.law.friction.as_deref() == Some(LawKind::FORMULA) && self.law.table.is_none() {
            let (mu_k, sets) = (self.mu_k.as_deref(), &self.law.sets);
            return formula_args::law(mu_k, sets, &self.units).map(Some);
        }
        let no_number = self
            .mu_k
            .as_ref()
            .filter(|_| self.given(Parameter::MuK).is_none());
        formula_args::check_none(no_number, &self.law.sets)?;
        let help =
            "--friction table --table FILE.csv, with columns of the speed and of mu_k or a force";
        match (self.law.friction.as_deref(), &self.law.table) {
            (Some(LawKind::TABLE), Some(path)) => {
                let table = read_table(path, &self.of_curve(), self.given(Parameter::MuS))?;
                Ok(Some(LawKind::Table(table)))
            }
            (Some(LawKind::TABLE), None) => Err(Failure::bad_input_with_help(
                "--table is not given: the table law goes through the points of a file",
                help,
            )),
            (_, Some(_)) => Err(Failure::bad_input_with_help(
                "--table has a meaning with --friction table only",
                help,
            )),
            // The flag accepts only the names of laws.
            (name, None) => Ok(name.and_then(NamedLaw::from_name).map(LawKind::Named)),
        }
    }

    /// How the file of a measured law is to be read.
    fn of_curve(&self) -> CurveOptions {
        CurveOptions {
            columns: self.law.columns.clone().unwrap_or_default(),
            normal_load: self.given(Parameter::NormalLoad),
            speed_unit: self.law.speed_unit.clone(),
            units: self.units(),
            spoken: Spoken::Flags,
        }
    }

    /// The setting of the flags. It needs a delay only if control acts.
    pub(super) fn setting(&self) -> Result<Setting, Failure> {
        self.check_law()?;
        let setting = self.setting_with(self.unneeded_delay(), None, &[], "")?;
        setting.sliding_point().map_err(|e| self.refused(&e))?;
        Ok(setting)
    }

    /// Whether the friction law has a state.
    fn has_state(&self) -> bool {
        let law = self.law.friction.as_deref().and_then(NamedLaw::from_name);
        law.is_some_and(|law| LawKind::Named(law).has_state())
    }

    /// A value for the delay where it is not needed, because both gains are 0.
    fn unneeded_delay(&self) -> Option<(Parameter, f64)> {
        match [Parameter::AlphaV, Parameter::AlphaN].map(|p| self.given(p)) {
            [None | Some(0.0), None | Some(0.0)] => Some((Parameter::Tau, 0.0)),
            _ => None,
        }
    }

    /// Refuses a missing friction law where one is needed, and flags without a meaning beside a
    /// law.
    fn check_law(&self) -> Result<(), Failure> {
        let help = "for example: --friction weakening --mu0 0.5 --v-s 0.5";
        let mut of_slope = Parameter::ALL.into_iter();
        let of_slope = of_slope.find(|p| p.group() == Group::Sliding && self.given(*p).is_some());
        let why = "stick and slip depend on the whole friction law";
        match of_slope.filter(|_| A::LAW) {
            Some(parameter) => Err(Failure::bad_input_with_help(
                format!("{} does not say enough: {why}", flag(parameter)),
                help,
            )),
            None if A::LAW && self.has_state() => Err(no_motions()),
            None if A::LAW && self.law.friction.is_none() => Err(Failure::bad_input_with_help(
                format!("--friction is not given: {why}"),
                help,
            )),
            None => Ok(()),
        }
    }

    /// The setting for a critical velocity: it needs a friction law, and a delay only if control
    /// acts. A v0 is no part of it, so that the same flags work for all commands.
    pub(super) fn setting_without_v0(&self) -> Result<Setting, Failure> {
        self.check_law()?;
        let mut setting = self.setting_with(self.unneeded_delay(), Some(Parameter::V0), &[], "")?;
        if self.given(Parameter::V0).is_some() {
            setting.set(Parameter::V0, f64::NAN);
        }
        setting.friction_law().map_err(|e| self.refused(&e))?;
        Ok(setting)
    }

    /// The setting for motions: it needs a friction law and v0, and a delay only if control acts.
    pub(super) fn setting_of_motions(&self) -> Result<Setting, Failure> {
        match self.law.friction {
            Some(_) if self.has_state() => Err(no_motions()),
            Some(_) => self.setting(),
            None => Err(Failure::bad_input_with_help(
                "--friction is not given: motions stick and slip by a friction law",
                "for example: --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.1",
            )),
        }
    }

    /// Tells that μ_S is not given with a measured friction law, whose points say nothing about it,
    /// and what depends on it.
    pub(super) fn tell_static_friction(&self, dependence: &str) {
        let (mu_s, table) = (Parameter::MuS, Some(LawKind::TABLE));
        if let Some(value) = mu_s.default_value()
            && self.law.friction.as_deref() == table
            && self.given(mu_s).is_none()
        {
            let (flag, name) = (flag(mu_s), mu_s.name());
            say::note(format_args!(
                "{flag} is not given: {name} is taken as {value}; {dependence}"
            ));
        }
    }

    /// The units of all numbers.
    pub(super) fn units(&self) -> Units {
        self.units.clone()
    }

    /// Refuses numbers with units, for systems from files: their own parameters have none that are
    /// known here.
    pub(super) fn refuse_units(&self) -> Result<(), Failure> {
        match self.units.assumed {
            false => Ok(()),
            true => Err(Failure::bad_input_with_help(
                "a number has a unit, and units of a system from a file are not known here",
                "say the units of the system, as in --units SI; or give all numbers in them",
            )),
        }
    }

    /// Whether any flag is given besides those of `these` parameters.
    pub(super) fn any_but(&self, these: &[Parameter]) -> bool {
        self.law.units.is_some() || self.any_but_units(these)
    }

    /// Whether any flag is given besides that of units and those of `these` parameters.
    pub(super) fn any_but_units(&self, these: &[Parameter]) -> bool {
        let given = |p: Parameter| !these.contains(&p) && self.given(p).is_some();
        let LawArgs {
            friction,
            table,
            units: _,
            sets: _,
            // They are given with a table only.
            columns: _,
            speed_unit: _,
        } = &self.law;
        let flags = friction.is_some() || table.is_some();
        flags || Parameter::ALL.into_iter().any(given)
    }

    /// The setting of the flags without the parameters `searched`; if one of these is given, the
    /// error has this `help`.
    pub(super) fn setting_but(
        &self,
        searched: &[Parameter],
        help: &str,
    ) -> Result<Setting, Failure> {
        self.setting_with(None, None, searched, help)
    }

    /// The setting of the flags, as [`ParameterArgs::setting_but`] reads it. `unneeded` has a value
    /// for a parameter that need not be given; the parameter `left_out` may be missing.
    fn setting_with(
        &self,
        unneeded: Option<(Parameter, f64)>,
        left_out: Option<Parameter>,
        searched: &[Parameter],
        help: &str,
    ) -> Result<Setting, Failure> {
        let law = self.law()?;
        for parameter in searched {
            if let Some(value) = self.given(*parameter) {
                let (flag, name) = (flag(*parameter), parameter.name());
                let value = Shown(value);
                return Err(Failure::bad_input_with_help(
                    format!("{flag} {value} would fix {name}, which is searched"),
                    help,
                ));
            }
        }
        tell_assumed_units(&self.units);
        let without = |p| left_out == Some(p) || unneeded.is_some_and(|(u, _)| u == p);
        let there = |p| searched.contains(&p) || without(p) || self.given(p).is_some();
        Setting::check_given(law.as_ref(), there).map_err(|e| {
            Failure::bad_input_with_help(e.message(law.as_ref(), flag), e.help(flag))
        })?;
        let mut setting = Setting::new(law);
        if let Some((parameter, value)) = unneeded {
            setting.set(parameter, value);
        }
        for parameter in Parameter::ALL {
            if let Some(value) = self.given(parameter) {
                let value = parameter.check(value).map_err(|e| self.refused(&e))?;
                setting.set(parameter, value);
            }
        }
        if let Some((message, help)) = setting.excluded_by_limits(left_out, flag) {
            return Err(Failure::bad_input_with_help(message, help));
        }
        if self.rounds {
            for (parameter, value) in setting.round_to_samples() {
                let (given, rounded) = (Shown(value), Shown(setting.get(parameter)));
                let flag = flag(parameter);
                say::note(format_args!("{flag} {given} is rounded to {rounded}"));
            }
        }
        if let Some((message, help)) = setting.not_sampled(flag) {
            let help = match self.rounds || !setting.is_between_samples() {
                true => help,
                false => format!("{help}; --{ROUND_DELAY} takes the nearer one"),
            };
            return Err(Failure::bad_input_with_help(message, help));
        }
        if !searched.contains(&Parameter::Tau) {
            warn_of_idle_delay(setting.has_idle_delay());
        }
        if left_out != Some(Parameter::V0) {
            // Motions do not depend on the slope at v0 alone.
            warn_beyond_curve(match A::LAW {
                true => setting.beyond_curve(&self.units()),
                false => setting.curve_remark(&self.units()),
            });
        }
        Ok(setting)
    }

    /// An error of the model, with the name of the flag that caused it.
    pub(super) fn refused(&self, error: &ModelError) -> Failure {
        let named = |p: &Parameter| p.name() == error.parameter;
        let Some(parameter) = Parameter::ALL.into_iter().find(named) else {
            return Failure::bad_input(error.to_string());
        };
        let mu_s = Parameter::MuS;
        let default = mu_s.default_value().filter(|_| self.given(mu_s).is_none());
        let allowed = error.allowed_by_default(default);
        if self.given(parameter).is_some() {
            let (flag, value) = (flag(parameter), Shown(error.value));
            return Failure::bad_input(format!("{flag} {value} is outside its range: {allowed}"));
        }
        let follows = matches!(parameter, Parameter::Mu0 | Parameter::VS);
        let from = match (follows, self.given(Parameter::MuPrimeRest)) {
            (true, Some(_)) => format!(", which follows from {},", flag(Parameter::MuPrimeRest)),
            _ => String::new(),
        };
        Failure::bad_input(format!(
            "{} = {}{}{from} is outside its range: {allowed}",
            parameter.name(),
            Shown(error.value),
            error.place(),
        ))
    }
}
