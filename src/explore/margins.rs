//! How far a setting is from the boundary of stability, or from a decay rate that is required.
//!
//! A limit that is not lost is infinite here, and NaN where it was not decided or not searched for;
//! JSON has null for both.

use serde::Serialize;

use super::margin_crossings::CrossingFrequencies;
use super::margin_range::{Margin, Range};
use super::stability::Stability;
use crate::answers::drawn_laws::{DRAWS, DrawnLaws};
use crate::answers::margins::SettingMargins;
use crate::answers::system_margins::SystemMargins;
use crate::linear::margins::{Limits, MarginSearch, Radius};
use crate::model::stop::Stop;
use crate::setting::no_answer::NoAnswer;
use crate::setting::{Parameter, Setting};

/// Margins of a setting, in its units.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Margins {
    /// The decay rate that all roots have to have; 0 asks for stability.
    pub required_decay: f64,
    /// Whether the setting has it, beyond doubt.
    pub decays: bool,
    /// The factors of both gains between which the setting keeps the decay rate; null where it does
    /// not have it.
    #[cfg_attr(feature = "serve", schema(required))]
    pub gain_margin: Option<Range>,
    /// The least angle, rad, of either sign by which the loop may turn; null where it is infinite:
    /// the loop is nowhere as large as 1. 0 where the setting does not have the decay rate.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub phase_margin: f64,
    /// The largest latency of the feedback, counted from none; null where it is infinite. 0 where
    /// the setting without latency does not have the decay rate. Of a system of P and Q the largest
    /// further delay.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub latency_margin: f64,
    /// The least distance of the loop from −1, which is 1 over the largest sensitivity; 0 where the
    /// setting does not have the decay rate, null where it is not known.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub modulus_margin: f64,
    /// The delays between which the setting keeps the decay rate; null where it does not have it.
    #[cfg_attr(feature = "serve", schema(required))]
    pub tau_margin: Option<Margin>,
    /// The slopes μ_K′ between which it stays, at fixed μ_K; null where it does not have it, where
    /// there is a friction law, and of a system from a file.
    #[cfg_attr(feature = "serve", schema(required))]
    pub mu_prime_margin: Option<Margin>,
    /// The sliding velocities between which it stays; null where it does not have it, and where
    /// there is no friction law.
    #[cfg_attr(feature = "serve", schema(required))]
    pub v0_margin: Option<Margin>,
    /// The largest relative box of gain, delay and μ_K′ or v0 that is proved to have it, for the
    /// friction that was given; 0 where it does not have it, null where that is not known, and of a
    /// system from a file.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub stability_radius: f64,
    /// That box; null where the setting does not have the decay rate.
    #[cfg_attr(feature = "serve", schema(required))]
    pub stability_box: Option<StabilityBox>,
    /// The frequencies of the crossings that the margins come from.
    pub crossing_frequencies: CrossingFrequencies,
    /// The margins above that are undecided or not available for this system; their null values
    /// mean this.
    pub undecided: Vec<&'static str>,
    /// The ends of the searches for margins without an upper end here.
    pub looked_up_to: LookedUpTo,
    /// What the errors of a fitted friction law leave open; null where the law was not fitted.
    #[cfg_attr(feature = "serve", schema(required))]
    pub fit: Option<StableShare>,
}

/// What the errors of a fitted friction law leave open of a setting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct StableShare {
    /// The standard error of μ_K(v0).
    pub mu_k_error: f64,
    /// The standard error of μ_K′(v0).
    pub mu_prime_error: f64,
    /// How many friction laws were drawn, as the errors of the fit allow them.
    pub draws: u32,
    /// The share of them for which the setting has the decay rate.
    pub share: f64,
    /// For how many of them that is not known; they do not count in the share.
    pub unknown: u32,
    /// The largest spectral abscissa of all draws; null where none is known.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub worst_abscissa: f64,
    /// μ_K of that draw.
    pub worst_mu_k: f64,
    /// μ_K′ of that draw.
    pub worst_mu_prime: f64,
}

impl From<DrawnLaws> for StableShare {
    fn from(of: DrawnLaws) -> Self {
        Self {
            mu_k_error: of.sliding.mu_k_error,
            mu_prime_error: of.sliding.mu_prime_error,
            draws: DRAWS,
            share: f64::from(of.decay) / f64::from(DRAWS),
            unknown: of.unknown,
            worst_abscissa: of.worst.abscissa,
            worst_mu_k: of.worst.mu_k,
            worst_mu_prime: of.worst.mu_prime,
        }
    }
}

/// The ends of searches in which nothing was lost; beyond them nothing is known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct LookedUpTo {
    /// The factor of both gains; null where the upper end is known, known not to be, or not
    /// decided.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub gain_margin: f64,
    /// The latency; null where the margin is known.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub latency_margin: f64,
    /// The delay; null where the upper end is known, known not to be, or not decided.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub tau_margin: f64,
    /// The sliding velocity; null where the upper end is known, and without a friction law.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub v0_margin: f64,
}

impl LookedUpTo {
    /// No search that ended without a loss.
    const NONE: Self = Self {
        gain_margin: f64::NAN,
        latency_margin: f64::NAN,
        tau_margin: f64::NAN,
        v0_margin: f64::NAN,
    };
}

/// A box of relative changes, all of them at most the stability radius.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct StabilityBox {
    /// The parameters that change: `gain`, `tau`, `mu_prime`, `v0`.
    pub of: Vec<&'static str>,
    /// Those that are 0 and stay so.
    pub fixed: Vec<&'static str>,
    /// The box is within one per cent of the largest.
    pub tight: bool,
    /// Relative changes, in the order of gain, delay and third parameter, at which stability, or
    /// the decay rate, is lost just beyond the box, or a root touches the line within rounding;
    /// null where no change up to 1 does that.
    #[cfg_attr(feature = "serve", schema(required))]
    pub lost_at: Option<[f64; 3]>,
}

impl Margins {
    /// The margins of a setting with all its parameters, for a required decay rate of `decay` ≥ 0;
    /// none of friction with a state, nor of a system from a file where a rate is required. Once
    /// `stop` is set, the answer comes soon but is meaningless.
    ///
    /// # Errors
    /// When a parameter is outside the model's range, or nothing is known of such a model.
    pub fn at(setting: &Setting, decay: f64, stop: &Stop) -> Result<Option<Self>, NoAnswer> {
        if let Some(of) = SystemMargins::of(setting, stop)? {
            let tau = setting.get(Parameter::Tau);
            return Ok((decay == 0.0).then(|| Self::of_system(&of, tau)));
        }
        let Some(around) = SettingMargins::of(setting, decay)? else {
            return Ok(None);
        };
        let around = around.heeding(stop);
        let mut margins = Self {
            decays: around.stable(),
            fit: DrawnLaws::at(setting, decay, stop)?.map(Into::into),
            ..Self::lost(decay)
        };
        if margins.decays {
            margins.fill(&around, setting);
        } else if around.is_beyond() {
            // That counts from no latency at all, whatever holds at the setting's own.
            let latency = around.latency(&mut MarginSearch::default());
            margins.note("latency_margin", &[latency]);
            margins.latency_margin = latency;
        }
        Ok(Some(margins))
    }

    /// Of friction with a state, as far as stability over the delay tells: at the delay `tau`.
    #[must_use]
    pub fn of_stability(stability: &Stability, tau: f64) -> Self {
        let mut margins = Self {
            decays: stability.stable,
            ..Self::lost(0.0)
        };
        // This margin counts from no latency, whatever the setting's own latency is.
        let latency = stability.latencies.margin.unwrap_or(f64::NAN);
        margins.latency_margin = latency;
        margins.note("latency_margin", &[latency]);
        if !margins.decays {
            return margins;
        }
        let inside = |&&[from, to]: &&[f64; 2]| from <= tau && tau < to;
        let intervals = stability.stable_delays.as_deref().unwrap_or_default();
        let interval = intervals.iter().find(inside);
        margins.tau_margin =
            interval.map(|&[lower, upper]| Margin::of(tau, Limits { lower, upper }, 0.0));
        if interval.is_none() {
            margins.undecided.push("tau_margin");
        }
        margins.phase_margin = f64::NAN;
        margins.modulus_margin = f64::NAN;
        margins.stability_radius = f64::NAN;
        margins.undecided.extend([
            "gain_margin",
            "phase_margin",
            "modulus_margin",
            "mu_prime_margin",
            "v0_margin",
            "stability_radius",
        ]);
        margins
    }

    /// Of a system from a file, at the delay `tau`.
    fn of_system(of: &SystemMargins, tau: f64) -> Self {
        let mut margins = Self {
            decays: of.stable(),
            ..Self::lost(0.0)
        };
        let (latency, latency_omega) = of.latency();
        if !margins.decays {
            // Of B and A that counts from no latency at all, whatever holds at its own.
            if of.is_loop() {
                margins.note("latency_margin", &[latency]);
                margins.latency_margin = latency;
                margins.crossing_frequencies.latency_margin = latency_omega;
            }
            return margins;
        }
        let gain = of.gain(&mut MarginSearch::default());
        let (phase, modulus) = (of.phase(), of.modulus());
        let (delay, delay_omegas) = of.delay();
        let limits = [gain.limits.lower, gain.limits.upper];
        margins.note("gain_margin", &limits);
        margins.note("phase_margin", &[phase.angle]);
        margins.note("latency_margin", &[latency]);
        margins.note("modulus_margin", &[modulus.margin]);
        margins.note("tau_margin", &[delay.lower, delay.upper]);
        margins.undecided.push("stability_radius");
        let last = match gain.limits.upper == f64::INFINITY && of.is_loop() {
            true => of.most_gains(),
            false => f64::NAN,
        };
        Self {
            gain_margin: of.is_loop().then_some(Range::of(limits)),
            phase_margin: phase.angle,
            latency_margin: latency,
            modulus_margin: modulus.margin,
            tau_margin: (!delay.upper.is_nan()).then(|| Margin::of(tau, delay, 0.0)),
            stability_radius: f64::NAN,
            crossing_frequencies: CrossingFrequencies {
                gain_margin: Range::of(gain.omegas),
                phase_margin: phase.omega,
                latency_margin: latency_omega,
                modulus_margin: modulus.omega,
                tau_margin: Range::of(delay_omegas),
                ..CrossingFrequencies::NONE
            },
            looked_up_to: LookedUpTo {
                gain_margin: last,
                ..LookedUpTo::NONE
            },
            ..margins
        }
    }

    /// The margins of a setting without the decay rate: 0 or null.
    fn lost(required_decay: f64) -> Self {
        Self {
            required_decay,
            decays: false,
            gain_margin: None,
            phase_margin: 0.0,
            latency_margin: 0.0,
            modulus_margin: 0.0,
            tau_margin: None,
            mu_prime_margin: None,
            v0_margin: None,
            stability_radius: 0.0,
            stability_box: None,
            crossing_frequencies: CrossingFrequencies::NONE,
            undecided: Vec::new(),
            looked_up_to: LookedUpTo::NONE,
            fit: None,
        }
    }

    fn fill(&mut self, around: &SettingMargins, setting: &Setting) {
        let mut search = MarginSearch::default();
        let gain = around.gain(&mut search);
        self.note("gain_margin", &[gain.lower, gain.upper]);
        self.gain_margin = Some(Range {
            lower: gain.lower,
            upper: gain.upper,
        });
        let of_loop = around.of_loop(&mut search);
        self.note("phase_margin", &[of_loop.phase]);
        self.note("latency_margin", &[of_loop.latency]);
        self.phase_margin = of_loop.phase;
        self.latency_margin = of_loop.latency;
        let modulus = around.modulus();
        self.note("modulus_margin", &[modulus.margin]);
        self.modulus_margin = modulus.margin;
        let delay = around.delay();
        self.note("tau_margin", &[delay.lower, delay.upper]);
        self.tau_margin = Some(Margin::of(setting.get(Parameter::Tau), delay, 0.0));
        let (third, limits) = around.third(&mut search);
        let at = setting.get(third);
        let ends = [limits.lower, limits.upper];
        if third == Parameter::V0 {
            self.note("v0_margin", &ends);
            self.v0_margin = Some(Margin::of(at, limits, 0.0));
        } else {
            self.note("mu_prime_margin", &ends);
            self.mu_prime_margin = Some(Margin::of(at, limits, f64::NEG_INFINITY));
        }
        // Only for infinite ends; NaN is reported as undecided.
        let last = |end: f64, last: f64| match end == f64::INFINITY {
            true => last,
            false => f64::NAN,
        };
        let reach = around.reach();
        self.looked_up_to = LookedUpTo {
            gain_margin: last(gain.upper, reach.gain),
            latency_margin: last(of_loop.latency, reach.latency),
            tau_margin: last(delay.upper, reach.delay),
            v0_margin: last(limits.upper, around.highest_v0().unwrap_or(f64::NAN)),
        };
        let radius = around.radius();
        self.note("stability_radius", &[radius.proved]);
        self.stability_radius = radius.proved;
        self.stability_box = Some(StabilityBox::of(&radius, third));
        self.crossing_frequencies = CrossingFrequencies {
            phase_margin: of_loop.phase_omega,
            modulus_margin: modulus.omega,
            ..CrossingFrequencies::of_block(self, setting)
        };
    }

    fn note(&mut self, name: &'static str, values: &[f64]) {
        if values.iter().any(|value| value.is_nan()) {
            self.undecided.push(name);
        }
    }
}

impl StabilityBox {
    fn of(radius: &Radius, third: Parameter) -> Self {
        let names = ["gain", Parameter::Tau.name(), third.name()];
        let those = |fixed: bool| {
            let pairs = names.iter().zip(radius.fixed);
            pairs.filter(move |(_, f)| *f == fixed).map(|(n, _)| *n)
        };
        Self {
            of: those(false).collect(),
            fixed: those(true).collect(),
            tight: radius.tight,
            lost_at: radius.unstable,
        }
    }
}
