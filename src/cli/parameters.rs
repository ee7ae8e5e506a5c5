//! The flags that give a point of parameter space, the same words as in sweep files.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use slipmap::model::{ModelError, Shown};
use slipmap::sweep::Parameter;
use slipmap::sweep::input::parameter::{LawKind, Setting};

use super::failure::Failure;
use super::sweep_file::read_table;

/// Friction laws by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Law {
    /// μ_K = μ0
    Coulomb,
    /// μ_K = μ0/(1 + v/v_s)
    Weakening,
    /// μ_K = μ0 + (μ_S − μ0) exp(−(v/v_s)²)
    Stribeck,
    /// The points in the file --table, joined by monotone cubics
    Table,
}

/// A point of parameter space.
#[derive(Debug, Args)]
pub struct ParameterArgs {
    /// μ_K′(v0), slope of the friction coefficient at the sliding velocity
    #[arg(long, allow_hyphen_values = true, value_name = "B")]
    mu_prime: Option<f64>,
    /// α_v, gain of velocity control [default: 0]
    #[arg(long, allow_hyphen_values = true, value_name = "A")]
    alpha_v: Option<f64>,
    /// α_N, gain of load control [default: 0]
    #[arg(long, allow_hyphen_values = true, value_name = "A")]
    alpha_n: Option<f64>,
    /// τ, delay of the feedback
    #[arg(long, allow_hyphen_values = true, value_name = "T")]
    tau: Option<f64>,
    /// μ_K(v0), kinetic friction coefficient at the sliding velocity [default: 1]
    #[arg(long, allow_hyphen_values = true, value_name = "M")]
    mu_k: Option<f64>,
    /// M, mass [default: 1]
    #[arg(long, allow_hyphen_values = true)]
    mass: Option<f64>,
    /// κ, stiffness [default: 1]
    #[arg(long, allow_hyphen_values = true)]
    stiffness: Option<f64>,
    /// N0, normal load [default: 1]
    #[arg(long, allow_hyphen_values = true)]
    normal_load: Option<f64>,
    /// Friction law, instead of --mu-prime and --mu-k
    #[arg(long)]
    friction: Option<Law>,
    /// Points of a measured friction law, for --friction table: two columns, speed and μ_K
    #[arg(long, value_name = "FILE.csv")]
    table: Option<PathBuf>,
    /// v0, pulling velocity (with --friction)
    #[arg(long, allow_hyphen_values = true)]
    v0: Option<f64>,
    /// μ0 of the friction law
    #[arg(long, allow_hyphen_values = true)]
    mu0: Option<f64>,
    /// v_s of the friction law
    #[arg(long, allow_hyphen_values = true)]
    v_s: Option<f64>,
    /// Slope of the weakening law at rest, −μ0/v_s, instead of --mu0 or --v-s
    #[arg(long, allow_hyphen_values = true, value_name = "B")]
    mu_prime_rest: Option<f64>,
    /// μ_S, static friction coefficient [default: 1]
    #[arg(long, allow_hyphen_values = true)]
    mu_s: Option<f64>,
}

/// The flag that gives a parameter.
pub fn flag(parameter: Parameter) -> String {
    format!("--{}", parameter.name().replace('_', "-"))
}

impl ParameterArgs {
    fn given(&self, parameter: Parameter) -> Option<f64> {
        match parameter {
            Parameter::MuPrime => self.mu_prime,
            Parameter::AlphaV => self.alpha_v,
            Parameter::AlphaN => self.alpha_n,
            Parameter::Tau => self.tau,
            Parameter::V0 => self.v0,
            Parameter::MuK => self.mu_k,
            Parameter::Mass => self.mass,
            Parameter::Stiffness => self.stiffness,
            Parameter::NormalLoad => self.normal_load,
            Parameter::Mu0 => self.mu0,
            Parameter::VS => self.v_s,
            Parameter::MuPrimeRest => self.mu_prime_rest,
            Parameter::MuS => self.mu_s,
            Parameter::XDot0 | Parameter::A0 | Parameter::SwitchOnPhase => None,
            Parameter::Gamma | Parameter::MuRatio => None,
        }
    }

    /// The friction law that the flags name, with the points of its file.
    fn law(&self) -> Result<Option<LawKind>, Failure> {
        let help =
            "--friction table --table FILE.csv, with a speed and a value of mu_k in each line";
        match (self.friction, &self.table) {
            (Some(Law::Table), Some(path)) => Ok(Some(LawKind::Table(read_table(path)?))),
            (Some(Law::Table), None) => Err(Failure::bad_input_with_help(
                "--table is not given: the table law goes through the points of a file",
                help,
            )),
            (_, Some(_)) => Err(Failure::bad_input_with_help(
                "--table has a meaning with --friction table only",
                help,
            )),
            (Some(Law::Coulomb), None) => Ok(Some(LawKind::Coulomb)),
            (Some(Law::Weakening), None) => Ok(Some(LawKind::Weakening)),
            (Some(Law::Stribeck), None) => Ok(Some(LawKind::Stribeck)),
            (None, None) => Ok(None),
        }
    }

    /// The setting that the flags describe.
    pub fn setting(&self) -> Result<Setting, Failure> {
        let setting = self.setting_but(&[], "")?;
        setting.sliding_point().map_err(|e| self.refused(&e))?;
        Ok(setting)
    }

    /// The setting of a critical velocity: a friction law, no v0, and a delay only where control
    /// acts.
    pub fn setting_without_v0(&self) -> Result<Setting, Failure> {
        if self.friction.is_none() {
            return Err(Failure::bad_input_with_help(
                "--friction is not given: the critical velocity depends on the whole friction law",
                "for example: --friction weakening --mu0 0.5 --v-s 0.5",
            ));
        }
        let unneeded = match (self.alpha_v, self.alpha_n) {
            (None | Some(0.0), None | Some(0.0)) => Some((Parameter::Tau, 0.0)),
            _ => None,
        };
        let help = "leave it out: v0 is what is looked for";
        let setting = self.setting_with(unneeded, &[Parameter::V0], help)?;
        setting.friction_law().map_err(|e| self.refused(&e))?;
        Ok(setting)
    }

    /// Whether any parameter is given.
    pub fn any_given(&self) -> bool {
        let flags = self.friction.is_some() || self.table.is_some();
        flags || Parameter::ALL.into_iter().any(|p| self.given(p).is_some())
    }

    /// The setting that the flags describe but for the parameters `searched`, which must not be
    /// given. `help` says why.
    pub fn setting_but(&self, searched: &[Parameter], help: &str) -> Result<Setting, Failure> {
        self.setting_with(None, searched, help)
    }

    /// The setting that the flags describe, as [`ParameterArgs::setting_but`] reads it, with a
    /// value for a parameter that need not be given.
    fn setting_with(
        &self,
        unneeded: Option<(Parameter, f64)>,
        searched: &[Parameter],
        help: &str,
    ) -> Result<Setting, Failure> {
        let law = self.law()?;
        for parameter in searched {
            if let Some(value) = self.given(*parameter) {
                let (flag, name) = (flag(*parameter), parameter.name());
                return Err(Failure::bad_input_with_help(
                    format!("{flag} {value} would fix {name}, which is searched"),
                    help,
                ));
            }
        }
        let without = |p| unneeded.is_some_and(|(unneeded, _)| unneeded == p);
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
        Ok(setting)
    }

    /// What the model refuses, by the name of the flag that gave it.
    pub fn refused(&self, error: &ModelError) -> Failure {
        let named = |p: &Parameter| p.name() == error.parameter;
        let Some(parameter) = Parameter::ALL.into_iter().find(named) else {
            return Failure::bad_input(error.to_string());
        };
        if self.given(parameter).is_some() {
            return Failure::out_of_range(&flag(parameter), error);
        }
        let follows = matches!(parameter, Parameter::Mu0 | Parameter::VS);
        let from = match (follows, self.mu_prime_rest) {
            (true, Some(_)) => format!(", which follows from {},", flag(Parameter::MuPrimeRest)),
            _ => String::new(),
        };
        Failure::bad_input(format!(
            "{} = {}{from} is outside its range: {}",
            parameter.name(),
            Shown(error.value),
            error.allowed
        ))
    }
}
