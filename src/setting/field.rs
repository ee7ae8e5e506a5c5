//! The fields that a map can hold for each cell: name, meaning, unit, type and source of each.
//!
//! Longer than most files: it is a table, with a row for each field.

use super::catalogue::catalogue;
use super::parameter::Parameter;
use super::regime_at_v0::RegimeAtV0;
use super::source::{OfLinear, OfMargins, OfRoots, Slope, Source};
use super::units::Units;
use crate::critical::{CriticalVelocity, Method, Transition};
use crate::linear::general::Reason;
use crate::slip::outcome::Outcome;
use crate::text::nearest::did_you_mean;

/// How a field is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// u16: a count, saturating.
    Count,
    /// u8: one of few kinds.
    Kind,
    /// u8: a small count, saturating.
    Few,
    /// f64, NaN for no value.
    Real,
}

impl Storage {
    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Count => "count",
            Self::Kind => "kind",
            Self::Few => "few",
            Self::Real => "real",
        }
    }
}

/// How the values of a field are distributed, which determines the scale of pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// Numbers of unstable roots.
    Counts,
    /// From 0 to the largest value; kinds and small counts.
    FromZero,
    /// From 0 upwards, with a few values far above all others.
    LongTail,
    /// Velocities and times above 0, over few or many orders of magnitude.
    Magnitudes,
    /// Velocities that fall to 0 faster than any power.
    Decades,
    /// Relaxation times: the shortest matter most; infinite where nothing decays.
    Relaxation,
    /// On both sides of a change of stability at 0; `stable` is the sign of the stable side.
    AboutZero {
        /// 1 or −1.
        stable: f64,
    },
    /// On both sides of 0, better below it; a few values are far from all others.
    BetterBelow,
    /// On both sides of 0, of order 1.
    RelativeError,
}

impl Spread {
    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Counts => "counts",
            Self::FromZero => "from-zero",
            Self::LongTail => "long-tail",
            Self::Magnitudes => "magnitudes",
            Self::Decades => "decades",
            Self::Relaxation => "relaxation",
            Self::AboutZero { .. } => "about-zero",
            Self::BetterBelow => "better-below",
            Self::RelativeError => "relative-error",
        }
    }

    /// The sign of stable sliding, for values on both sides of a change of stability.
    #[must_use]
    pub const fn stable_sign(self) -> Option<f64> {
        match self {
            Self::AboutZero { stable } => Some(stable),
            _ => None,
        }
    }
}

/// Powers of force, length and time in a unit, or a quantity without a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measure {
    Powers([i32; 3]),
    AngularFrequency,
    Angle,
}

const NUMBER: Measure = Measure::Powers([0, 0, 0]);
const FORCE: Measure = Measure::Powers([1, 0, 0]);
const VELOCITY: Measure = Measure::Powers([0, 1, -1]);
const TIME: Measure = Measure::Powers([0, 0, 1]);
const RATE: Measure = Measure::Powers([0, 0, -1]);

/// The facts about a field.
struct Row {
    /// The name in sweep files and maps.
    name: &'static str,
    /// Its former name, which sweep files may still use and old maps have.
    former: Option<&'static str>,
    /// Its meaning, for `long_name` in maps and notes in pictures.
    long_name: &'static str,
    /// Its meaning in a few words, for titles of axes and colour bars.
    short_name: &'static str,
    /// A comment for readers of the map: where there is no value, and why.
    comment: Option<&'static str>,
    /// Meaning and comment beside fields of the critical velocity, where these differ.
    beside_vc: Option<(&'static str, &'static str)>,
    measure: Measure,
    storage: Storage,
    /// The names of its kinds, in the order of their numbers.
    kinds: Option<fn() -> Vec<&'static str>>,
    source: Source,
    spread: Spread,
    /// Whether sliding is stable in a cell with this value.
    stable: Option<fn(f64) -> bool>,
}

/// The facts that most rows share.
const ROW: Row = Row {
    name: "",
    former: None,
    long_name: "",
    short_name: "",
    comment: None,
    beside_vc: None,
    measure: NUMBER,
    storage: Storage::Real,
    kinds: None,
    source: Source::Line,
    spread: Spread::FromZero,
    stable: None,
};

/// Re λ of the root with a given rank.
macro_rules! real_part {
    ($rank:literal, $name:literal, $ordinal:literal) => {
        Row {
            name: $name,
            long_name: concat!(
                "real part of the ",
                $ordinal,
                " characteristic root from the right, pairs counted once"
            ),
            short_name: concat!("Re λ, ", $ordinal, " root"),
            comment: Some("-infinity where there are fewer roots"),
            measure: RATE,
            source: Source::Roots(OfRoots::RealPart($rank)),
            spread: Spread::BetterBelow,
            ..ROW
        }
    };
}

/// |Im λ| of the root with a given rank.
macro_rules! frequency {
    ($rank:literal, $name:literal, $ordinal:literal) => {
        Row {
            name: $name,
            long_name: concat!(
                "angular frequency of the ",
                $ordinal,
                " characteristic root from the right, pairs counted once"
            ),
            short_name: concat!("|Im λ|, ", $ordinal, " root"),
            measure: Measure::AngularFrequency,
            source: Source::Roots(OfRoots::Frequency($rank)),
            ..ROW
        }
    };
}

/// A derivative of the spectral abscissa.
const fn slope(of: Slope) -> Row {
    let [force, length, time] = of.parameter().dimension();
    Row {
        measure: Measure::Powers([-force, -length, -1 - time]),
        source: Source::Roots(OfRoots::Derivative(of)),
        spread: Spread::BetterBelow,
        ..ROW
    }
}

/// A margin.
const fn margin(of: OfMargins) -> Row {
    Row {
        source: Source::Margins(of),
        ..ROW
    }
}

const UNTIL_KNOWN: &str = "until the outcome was known; where control never acts, since t = 0";
const APPROXIMATION_OVER: &str =
    "approximation over vc_over_vtilde, less 1; no value where that is 0";

catalogue! {
    /// A quantity computed for every cell, in the order in which maps hold them. `status` comes
    /// with every map and is not listed here.
    pub enum Field: Row {
        /// Number of unstable roots.
        NUnstable = Row {
            name: "n_unstable",
            long_name: "number of characteristic roots with positive real part",
            short_name: "number of unstable roots",
            storage: Storage::Count,
            source: Source::Line,
            spread: Spread::Counts,
            stable: Some(|value| value == 0.0),
            ..ROW
        };
        /// Outcome of the motion or, beside fields of the critical velocity, of stick-slip: a
        /// number of [`OUTCOMES`].
        Outcome = Row {
            name: "outcome",
            long_name: "what becomes of the motion",
            short_name: "outcome",
            storage: Storage::Kind,
            kinds: Some(|| OUTCOMES.to_vec()),
            source: Source::MotionOrCritical(
                |motion| f64::from(motion.outcome as u8),
                |cell| f64::from(number_of_outcome(&cell.found.critical)),
            ),
            comment: Some(
                "undecided: none of the others before the horizon or within the steps allowed, \
                 not_converged in status; no-cycle: no uncontrolled stick-slip at whose phase \
                 control could be switched on",
            ),
            beside_vc: Some((
                "how stick-slip ends at the critical velocity",
                "lost: above it does not survive switching on, or there is none to switch on in; \
                 persists: it survives at v_max; undecided: it was not found, but it is not known \
                 everywhere",
            )),
            ..ROW
        };
        /// Number of the [`Method`] that gave the critical velocity.
        Method = Row {
            name: "method",
            long_name: "what gave the critical velocity",
            short_name: "method",
            storage: Storage::Kind,
            kinds: Some(|| Method::ALL.map(Method::name).to_vec()),
            source: Source::Critical(|cell| f64::from(cell.found.critical.method as u8)),
            ..ROW
        };
        /// Number of the [`RegimeAtV0`] of v0.
        Regime = Row {
            name: "regime",
            former: Some("class"),
            long_name: "what the working velocity v0 is good for",
            short_name: "at v0",
            storage: Storage::Kind,
            kinds: Some(|| RegimeAtV0::ALL.map(RegimeAtV0::name).to_vec()),
            source: Source::Critical(|cell| cell.regime.map_or(f64::NAN, |of| f64::from(of as u8))),
            comment: Some(
                "stable: sliding is linearly stable, without stick-slip beside it; bistable: \
                 stick-slip persists beside it; lift-off: linearly stable, but stick-slip leads to \
                 N <= 0 at v0 or below; undecided: marginal, between vc_lower and vc_upper, or not \
                 known",
            ),
            ..ROW
        };
        /// Number of windows of v0 in which stick-slip survives, up to the largest v0 of the
        /// search, whatever ends them: v_c, N ≤ 0 or the end of the range.
        Windows = Row {
            name: "windows",
            long_name: "number of windows of v0, up to v_max, in which stick-slip survives",
            short_name: "windows of v0",
            storage: Storage::Few,
            source: Source::Critical(|cell| cell.found.windows.len() as f64),
            comment: Some(
                "those that end where N <= 0 or reach v_max count; follow: one, from 0, or none; \
                 switch-on: windows between the velocities that are tried may be missed",
            ),
            ..ROW
        };
        /// Why the cell is special: 0 for no reason, or the number of a [`Reason`].
        Reason = Row {
            name: "reason",
            long_name: "why the linear stability of the cell is not like that of others",
            short_name: "reason",
            storage: Storage::Kind,
            kinds: Some(|| {
                let names = Reason::ALL.into_iter().map(Reason::name);
                std::iter::once("none").chain(names).collect()
            }),
            source: Source::Linear(OfLinear::Reason),
            comment: Some(
                "root-at-origin, root-on-axis: at every delay a root lies on the imaginary axis, \
                 marginal in status; infinite: infinitely many unstable roots, n_unstable has no \
                 value; neutral-limit: roots accumulate at the imaginary axis, it is never \
                 exponentially stable; no-rightmost-root: the abscissa is the essential one, a \
                 supremum, and there are no other roots, told beside fields of roots; \
                 degree-unknown: the highest coefficient is within rounding of 0; refused: the \
                 imaginary axis is crossed everywhere or nowhere",
            ),
            ..ROW
        };
        /// Signed distance in τ to the nearest change of stability.
        DelayMargin = Row {
            name: "delay_margin",
            long_name: "distance in delay to the nearest change of stability, \
                        positive where stable",
            short_name: "delay margin",
            measure: TIME,
            source: Source::Line,
            spread: Spread::AboutZero { stable: 1.0 },
            stable: Some(|value| value > 0.0),
            ..ROW
        };
        /// The spectral abscissa, Re λ of the rightmost root.
        Abscissa = Row {
            name: "abscissa",
            long_name: "spectral abscissa, the largest real part of the characteristic roots",
            short_name: "spectral abscissa",
            spread: Spread::AboutZero { stable: -1.0 },
            stable: Some(|value| value < 0.0),
            comment: Some(
                "certified in status: the argument principle, which shares nothing with the \
                 computation of the roots, finds no root with Re lambda > abscissa + \
                 certificate_margin * max(1/t, |abscissa|), t = sqrt(mass/stiffness)",
            ),
            ..real_part!(0, "abscissa", "rightmost")
        };
        /// Re λ of the second root from the right; −∞ where there are fewer.
        Abscissa2 = real_part!(1, "abscissa_2", "second");
        /// Re λ of the third root from the right; −∞ where there are fewer.
        Abscissa3 = real_part!(2, "abscissa_3", "third");
        /// Re λ of the fourth root from the right; −∞ where there are fewer.
        Abscissa4 = real_part!(3, "abscissa_4", "fourth");
        /// Re λ of the fifth root from the right; −∞ where there are fewer.
        Abscissa5 = real_part!(4, "abscissa_5", "fifth");
        /// Re λ of the sixth root from the right; −∞ where there are fewer.
        Abscissa6 = real_part!(5, "abscissa_6", "sixth");
        /// Re λ of the seventh root from the right; −∞ where there are fewer.
        Abscissa7 = real_part!(6, "abscissa_7", "seventh");
        /// Re λ of the eighth root from the right; −∞ where there are fewer.
        Abscissa8 = real_part!(7, "abscissa_8", "eighth");
        /// |Im λ| of the rightmost root, 0 for a real one.
        Frequency = Row {
            long_name: "angular frequency of the rightmost characteristic root",
            short_name: "frequency",
            ..frequency!(0, "frequency", "rightmost")
        };
        /// |Im λ| of the second root from the right; NaN where there are fewer.
        Frequency2 = frequency!(1, "frequency_2", "second");
        /// |Im λ| of the third root from the right; NaN where there are fewer.
        Frequency3 = frequency!(2, "frequency_3", "third");
        /// |Im λ| of the fourth root from the right; NaN where there are fewer.
        Frequency4 = frequency!(3, "frequency_4", "fourth");
        /// |Im λ| of the fifth root from the right; NaN where there are fewer.
        Frequency5 = frequency!(4, "frequency_5", "fifth");
        /// |Im λ| of the sixth root from the right; NaN where there are fewer.
        Frequency6 = frequency!(5, "frequency_6", "sixth");
        /// |Im λ| of the seventh root from the right; NaN where there are fewer.
        Frequency7 = frequency!(6, "frequency_7", "seventh");
        /// |Im λ| of the eighth root from the right; NaN where there are fewer.
        Frequency8 = frequency!(7, "frequency_8", "eighth");
        /// −1/abscissa where the abscissa is negative, else +∞.
        RelaxationTime = Row {
            name: "relaxation_time",
            long_name: "time in which a small disturbance decays by a factor e",
            short_name: "relaxation time",
            measure: TIME,
            source: Source::Roots(OfRoots::RelaxationTime),
            spread: Spread::Relaxation,
            stable: Some(|value| value < f64::INFINITY),
            comment: Some("-1/abscissa; infinity where the abscissa is not negative"),
            ..ROW
        };
        /// The largest |z| of a digital loop, from one reading to the next.
        SpectralRadius = Row {
            name: "spectral_radius",
            long_name: "factor by which a small disturbance changes from one reading to the next",
            short_name: "spectral radius",
            source: Source::Roots(OfRoots::SpectralRadius),
            stable: Some(|value| value < 1.0),
            comment: Some("e^(abscissa h), with the sample time h"),
            ..ROW
        };
        /// The derivative of the spectral abscissa with respect to τ.
        DAbscissaDTau = Row {
            name: "d_abscissa_d_tau",
            long_name: "derivative of the spectral abscissa with respect to the delay of the \
                        feedback",
            short_name: "∂ abscissa / ∂ τ",
            ..slope(Slope::Tau)
        };
        /// The derivative of the spectral abscissa with respect to α_v.
        DAbscissaDAlphaV = Row {
            name: "d_abscissa_d_alpha_v",
            long_name: "derivative of the spectral abscissa with respect to the gain of velocity \
                        control",
            short_name: "∂ abscissa / ∂ α_v",
            ..slope(Slope::AlphaV)
        };
        /// The derivative of the spectral abscissa with respect to α_N.
        DAbscissaDAlphaN = Row {
            name: "d_abscissa_d_alpha_n",
            long_name: "derivative of the spectral abscissa with respect to the gain of load \
                        control",
            short_name: "∂ abscissa / ∂ α_N",
            ..slope(Slope::AlphaN)
        };
        /// The derivative of the spectral abscissa with respect to μ_K′, at fixed μ_K.
        DAbscissaDMuPrime = Row {
            name: "d_abscissa_d_mu_prime",
            long_name: "derivative of the spectral abscissa with respect to the slope of the \
                        kinetic friction coefficient at the sliding velocity",
            short_name: "∂ abscissa / ∂ μ′",
            comment: Some("at fixed mu_k"),
            ..slope(Slope::MuPrime)
        };
        /// Distance from the spectral abscissa to a line on its right, to the right of which no
        /// root lies.
        CertificateMargin = Row {
            name: "certificate_margin",
            long_name: "certified distance: no characteristic root lies farther right of the \
                        abscissa",
            short_name: "certificate margin",
            source: Source::Roots(OfRoots::CertificateMargin),
            comment: Some("in units of max(1/t, |abscissa|), t = sqrt(mass/stiffness)"),
            ..ROW
        };
        /// The real part at which roots accumulate.
        EssentialAbscissa = Row {
            name: "essential_abscissa",
            long_name: "real part at which infinitely many characteristic roots accumulate",
            short_name: "essential abscissa",
            measure: RATE,
            source: Source::Linear(OfLinear::EssentialAbscissa),
            spread: Spread::BetterBelow,
            comment: Some(
                "log|memory|/tau; -infinity where they accumulate nowhere: without memory or delay",
            ),
            ..ROW
        };
        /// Stiffness over the critical stiffness of rate-and-state friction.
        StiffnessRatio = Row {
            name: "stiffness_ratio",
            long_name: "stiffness over the critical one, below which steady sliding without \
                        control is unstable",
            short_name: "κ/κ_c",
            source: Source::Linear(OfLinear::StiffnessRatio),
            spread: Spread::Magnitudes,
            comment: Some(
                "of rate-and-state friction; infinity where evolution_effect is not larger than \
                 direct_effect: stable at every stiffness",
            ),
            ..ROW
        };
        /// The factor of both gains, below 1, at which sliding is no longer stable.
        GainMarginLower = Row {
            name: "gain_margin_lower",
            long_name: "factor of both gains, below 1, at which sliding is no longer stable",
            short_name: "lower gain margin",
            comment: Some("0 where every smaller gain is stable; no value where sliding is not"),
            ..margin(OfMargins::GainLower)
        };
        /// The factor of both gains, above 1, at which sliding is no longer stable.
        GainMarginUpper = Row {
            name: "gain_margin_upper",
            long_name: "factor of both gains, above 1, at which sliding is no longer stable",
            short_name: "upper gain margin",
            comment: Some(
                "infinity where every larger gain is stable, up to 1e12 times as large where no \
                 bound is known; no value where sliding is not, or the end is not known",
            ),
            spread: Spread::LongTail,
            ..margin(OfMargins::GainUpper)
        };
        /// The smallest phase shift of the loop at which stability is lost.
        PhaseMargin = Row {
            name: "phase_margin",
            long_name: "least angle of either sign by which the loop of the feedback may turn",
            short_name: "phase margin",
            measure: Measure::Angle,
            comment: Some("infinity where the loop is nowhere as large as 1; 0 where unstable"),
            stable: Some(|value| value > 0.0),
            ..margin(OfMargins::Phase)
        };
        /// The largest latency of the feedback, counted from none, at which sliding stays stable.
        LatencyMargin = Row {
            name: "latency_margin",
            long_name: "largest latency of the feedback, counted from none, up to which sliding \
                        stays stable",
            short_name: "latency margin",
            measure: TIME,
            comment: Some(
                "infinity where no latency matters; 0 where unstable without latency; of a system \
                 of P and Q the largest further delay",
            ),
            spread: Spread::LongTail,
            stable: Some(|value| value > 0.0),
            ..margin(OfMargins::Latency)
        };
        /// The least distance of the loop from −1.
        ModulusMargin = Row {
            name: "modulus_margin",
            long_name: "least distance of the loop of the feedback from -1, which is 1 over the \
                        largest sensitivity",
            short_name: "modulus margin",
            comment: Some("0 where unstable"),
            stable: Some(|value| value > 0.0),
            ..margin(OfMargins::Modulus)
        };
        /// The largest relative box of gain, delay and μ_K′ (or v0) in which sliding is stable.
        StabilityRadius = Row {
            name: "stability_radius",
            long_name: "largest relative change of gain, delay and mu_prime (with a friction law: \
                        v0) together up to which sliding is proved to be stable",
            short_name: "stability radius",
            comment: Some(
                "within 1 % of the largest; not_converged in status where not; 0 where unstable",
            ),
            stable: Some(|value| value > 0.0),
            ..margin(OfMargins::StabilityRadius)
        };
        /// Time from switch-on until ẋ stays within 1 % of v0; NaN for motions that do not end in
        /// sliding.
        SettleTime = Row {
            name: "settle_time",
            long_name: "time from switch-on until the velocity stays within 1 % of v0",
            short_name: "settle time",
            measure: TIME,
            source: Source::Motion(|motion| motion.settle_time),
            spread: Spread::LongTail,
            comment: Some("no value where the motion does not come to slide"),
            ..ROW
        };
        /// Time from switch-on until the end of the last stick; 0 where no stick follows switch-on,
        /// NaN where sticks go on.
        LastRelease = Row {
            name: "last_release",
            long_name: "time from switch-on until the last stick ends",
            short_name: "last release",
            measure: TIME,
            source: Source::Motion(|motion| motion.last_release),
            spread: Spread::LongTail,
            comment: Some(
                "0 where the block does not stick after switch-on; no value where sticks go on \
                 periodically; as far as it was followed where the motion is undecided",
            ),
            ..ROW
        };
        /// The smallest normal load since switch-on.
        NMin = Row {
            name: "n_min",
            long_name: "smallest normal load since switch-on",
            short_name: "smallest load",
            measure: FORCE,
            // N_min is infinite where control never acted.
            source: Source::Motion(|motion| match motion.n_min.is_finite() {
                true => motion.n_min,
                false => f64::NAN,
            }),
            comment: Some(UNTIL_KNOWN),
            ..ROW
        };
        /// The largest force of spring and dashpot since switch-on.
        PeakForce = Row {
            name: "peak_force",
            long_name: "largest force of spring and dashpot since switch-on",
            short_name: "peak force",
            measure: FORCE,
            source: Source::Motion(|motion| motion.peak),
            comment: Some(UNTIL_KNOWN),
            ..ROW
        };
        /// How long an actuator is at a limit.
        TimeAtLimit = Row {
            name: "time_at_limit",
            long_name: "time since switch-on for which velocity or load is at a limit of its \
                        actuator",
            short_name: "time at a limit",
            measure: TIME,
            source: Source::Motion(|motion| motion.time_at_limit),
            spread: Spread::LongTail,
            comment: Some(UNTIL_KNOWN),
            ..ROW
        };
        /// That time over the time since switch-on.
        ShareAtLimit = Row {
            name: "share_at_limit",
            long_name: "share of the time since switch-on for which velocity or load is at a \
                        limit of its actuator",
            short_name: "share at a limit",
            source: Source::Motion(|motion| motion.share_at_limit),
            comment: Some(UNTIL_KNOWN),
            ..ROW
        };
        /// The share of starts from which control ends in sliding.
        BasinShare = Row {
            name: "basin_share",
            long_name: "share of starts from which control ends in sliding",
            short_name: "share that slides",
            source: Source::Basin(|cell| cell.share),
            comment: Some(
                "of those whose end is known: not_converged in status where some are undecided, \
                 which count in basin_share_upper alone; 0 where sliding is linearly unstable; no \
                 value where there is no uncontrolled stick-slip to switch on in",
            ),
            ..ROW
        };
        /// The standard error of that share.
        BasinShareError = Row {
            name: "basin_share_error",
            long_name: "standard error of basin_share and basin_share_upper",
            short_name: "error of the share",
            source: Source::Basin(|cell| cell.error),
            comment: Some(
                "from the spread between independent scramblings of the sequence of starts, at \
                 least 3.1 starts in all where fewer than five differ from the others; 0 where \
                 sliding is linearly unstable",
            ),
            ..ROW
        };
        /// The share if all undecided starts ended in sliding.
        BasinShareUpper = Row {
            name: "basin_share_upper",
            long_name: "share of starts from which control ends in sliding or nothing is decided",
            short_name: "share that may slide",
            source: Source::Basin(|cell| cell.upper),
            ..ROW
        };
        /// The critical velocity; 0 where stick-slip is never sustained.
        Vc = Row {
            name: "vc",
            long_name: "critical velocity, above which stick-slip does not survive",
            short_name: "critical velocity",
            measure: VELOCITY,
            source: Source::Critical(|cell| cell.found.critical.vc),
            spread: Spread::Magnitudes,
            comment: Some(
                "0 where stick-slip is not sustained at any v0; no value where N <= 0 ends it or \
                 it survives at v_max",
            ),
            ..ROW
        };
        /// The lower bound of the critical velocity.
        VcLower = Row {
            name: "vc_lower",
            long_name: "lower bound of the critical velocity",
            short_name: "critical velocity, at least",
            measure: VELOCITY,
            source: Source::Critical(|cell| cell.found.critical.vc_lower),
            spread: Spread::Magnitudes,
            comment: Some(
                "below the ends that all searches came to, by a margin; vc where that is decided, \
                 v_liftoff where N <= 0 ends stick-slip, v_max where it survives there; no value \
                 where N <= 0 comes before any stick-slip",
            ),
            ..ROW
        };
        /// The upper bound of the critical velocity: the smallest v0 at which stick-slip was lost
        /// for good.
        VcUpper = Row {
            name: "vc_upper",
            long_name: "smallest v0 at which stick-slip was lost for good or ended by N <= 0",
            short_name: "critical velocity, at most",
            measure: VELOCITY,
            source: Source::Critical(|cell| cell.found.critical.vc_upper),
            spread: Spread::Magnitudes,
            comment: Some(
                "vc where that is decided, v_liftoff where N <= 0 ends stick-slip; no value where \
                 neither was seen up to v_max",
            ),
            ..ROW
        };
        /// The smallest v0 at which N ≤ 0 occurs.
        VLiftoff = Row {
            name: "v_liftoff",
            long_name: "smallest v0 at which the normal load reaches 0",
            short_name: "lift-off velocity",
            measure: VELOCITY,
            source: Source::Critical(|cell| cell.found.critical.v_liftoff),
            spread: Spread::Magnitudes,
            ..ROW
        };
        /// Time of sticking in a period at the critical velocity.
        StickTime = Row {
            name: "stick_time",
            long_name: "time stuck in a period at the critical velocity",
            short_name: "stick time",
            measure: TIME,
            source: Source::Critical(|cell| cell.found.critical.stick_time),
            spread: Spread::Magnitudes,
            comment: Some("no value for the protocol switch-on"),
            ..ROW
        };
        /// Time of slipping in a period at the critical velocity.
        SlipTime = Row {
            name: "slip_time",
            long_name: "time in slip in a period at the critical velocity",
            short_name: "slip time",
            measure: TIME,
            source: Source::Critical(|cell| cell.found.critical.slip_time),
            comment: Some("no value for the protocol switch-on"),
            ..ROW
        };
        /// The velocity above which sliding is linearly stable and free of stick-slip.
        VSmooth = Row {
            name: "v_smooth",
            long_name: "velocity above which sliding is linearly stable and free of stick-slip",
            short_name: "smooth above",
            measure: VELOCITY,
            source: Source::Critical(|cell| cell.v_smooth),
            spread: Spread::Magnitudes,
            comment: Some(
                "up to v_max; above vc_upper where vc is not decided; no value where sliding is \
                 not stable at v_max or neither is known",
            ),
            ..ROW
        };
        /// v_c/ṽ in the limit of a short delay, with ṽ = (μ_S−μ_K)N0/√(κM).
        VcOverVtilde = Row {
            name: "vc_over_vtilde",
            long_name: "critical velocity over vtilde: below it stick-slip survives",
            short_name: "v_c/ṽ",
            source: Source::Limit(|cell| cell.exact.vc_over_vtilde),
            spread: Spread::Decades,
            comment: Some(
                "vtilde = (mu_s - mu_k) normal_load / sqrt(stiffness mass), gamma = -mu_k alpha_n \
                 tau / (2 sqrt(stiffness mass)), mu_ratio = mu_k/mu_s; 0 from gamma = 1 on",
            ),
            ..ROW
        };
        /// ω0 T, the duration of the grazing slip in that limit, ω0 = √(κ/M).
        Omega0T = Row {
            name: "omega0_T",
            long_name: "duration of the slip that just grazes, over sqrt(mass/stiffness)",
            short_name: "duration of the slip ω_0T",
            source: Source::Limit(|cell| cell.exact.omega0_t),
            comment: Some("infinity from gamma = 1 on"),
            ..ROW
        };
        /// The pulling velocity from which the block lifts off in that limit, over ṽ.
        LiftoffOverVtilde = Row {
            name: "liftoff_over_vtilde",
            long_name: "pulling velocity over vtilde from which the block lifts off \
                        while it sticks",
            short_name: "lift-off",
            source: Source::Limit(|cell| cell.exact.liftoff_over_vtilde),
            spread: Spread::Decades,
            comment: Some("infinity at mu_ratio = 1"),
            ..ROW
        };
        /// The letter's approximation of v_c/ṽ for γ → 0.
        VcWeakControl = Row {
            name: "vc_weak_control",
            long_name: "the letter's approximation of v_c/vtilde as gamma goes to 0",
            short_name: "v_c/ṽ for γ → 0",
            source: Source::Limit(|cell| cell.weak),
            spread: Spread::Decades,
            comment: Some("1/(2 sqrt(pi gamma))"),
            ..ROW
        };
        /// The letter's approximation of v_c/ṽ for γ → 1.
        VcStrongControl = Row {
            name: "vc_strong_control",
            long_name: "the letter's approximation of v_c/vtilde as gamma goes to 1",
            short_name: "v_c/ṽ for γ → 1",
            source: Source::Limit(|cell| cell.strong),
            spread: Spread::Decades,
            comment: Some("exp(-1 - pi gamma/sqrt(1 - gamma^2))/gamma; 0 from gamma = 1 on"),
            ..ROW
        };
        /// Relative error of [`Field::VcWeakControl`].
        WeakControlError = Row {
            name: "weak_control_error",
            long_name: "relative error of vc_weak_control",
            short_name: "error of v_c for γ → 0",
            source: Source::Limit(|cell| cell.error(cell.weak)),
            spread: Spread::RelativeError,
            comment: Some(APPROXIMATION_OVER),
            ..ROW
        };
        /// Relative error of [`Field::VcStrongControl`].
        StrongControlError = Row {
            name: "strong_control_error",
            long_name: "relative error of vc_strong_control",
            short_name: "error of v_c for γ → 1",
            source: Source::Limit(|cell| cell.error(cell.strong)),
            spread: Spread::RelativeError,
            comment: Some(APPROXIMATION_OVER),
            ..ROW
        };
    }
}

/// Names of all outcomes of a motion or of stick-slip, in the order of their numbers in maps: those
/// of [`Outcome`], then those of [`Transition`] that are no [`Outcome`].
pub const OUTCOMES: [&str; Outcome::ALL.len() + Transition::ALL.len() - 1] = {
    let mut names = [""; Outcome::ALL.len() + Transition::ALL.len() - 1];
    let mut i = 0;
    while i < Outcome::ALL.len() {
        names[i] = Outcome::ALL[i].name();
        i += 1;
    }
    let mut j = 0;
    while j < Transition::ALL.len() {
        if !matches!(Transition::ALL[j], Transition::LiftOff) {
            names[i] = Transition::ALL[j].name();
            i += 1;
        }
        j += 1;
    }
    names
};

/// The place in [`OUTCOMES`] of the end of stick-slip; undecided where no stick-slip was found but
/// it could not be excluded.
#[must_use]
pub fn number_of_outcome(critical: &CriticalVelocity) -> u8 {
    match critical.transition {
        Transition::Never if !critical.decided => Outcome::Undecided as u8,
        transition => number_of_transition(transition),
    }
}

/// The place of a transition in [`OUTCOMES`].
pub(crate) fn number_of_transition(transition: Transition) -> u8 {
    let first = Outcome::ALL.len() as u8;
    match transition {
        Transition::LiftOff => Outcome::LiftOff as u8,
        _ if transition < Transition::LiftOff => first + transition as u8,
        _ => first + transition as u8 - 1,
    }
}

impl Field {
    /// The velocities of the limit of a short delay, which one picture shows together.
    pub const LIMIT_VELOCITIES: [Self; 4] = [
        Self::VcOverVtilde,
        Self::VcWeakControl,
        Self::VcStrongControl,
        Self::LiftoffOverVtilde,
    ];

    /// The name in sweep files and maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// The first name of the field. Plans are compared by it, so that those of old maps stay equal.
    #[must_use]
    pub const fn first_name(self) -> &'static str {
        match self.row().former {
            Some(former) => former,
            None => self.row().name,
        }
    }

    /// The field with this name or former name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let named = |f: &Self| f.name() == name || f.first_name() == name;
        Self::ALL.into_iter().find(named)
    }

    /// Its meaning, for `long_name` in maps and notes in pictures.
    #[must_use]
    pub const fn long_name(self) -> &'static str {
        self.row().long_name
    }

    /// Its meaning in a few words, for titles of axes and colour bars.
    #[must_use]
    pub const fn short_name(self) -> &'static str {
        self.row().short_name
    }

    /// A comment for readers of the map, if there is one.
    #[must_use]
    pub const fn comment(self) -> Option<&'static str> {
        self.row().comment
    }

    /// Its long name and comment beside fields of the critical velocity.
    #[must_use]
    pub fn described_at_vc(self) -> (&'static str, Option<&'static str>) {
        match self.row().beside_vc {
            Some((long_name, comment)) => (long_name, Some(comment)),
            None => (self.long_name(), self.comment()),
        }
    }

    /// The names of its kinds, in the order of their numbers; only for [`Storage::Kind`].
    #[must_use]
    pub fn kinds(self) -> Option<Vec<&'static str>> {
        self.row().kinds.map(|names| names())
    }

    /// The unit, as UDUNITS writes it; "1" if dimensionless.
    #[must_use]
    pub fn unit(self, units: &Units) -> String {
        match self.row().measure {
            Measure::Powers(powers) => units.of(powers),
            Measure::AngularFrequency => units.angular_frequency(),
            Measure::Angle => "rad".into(),
        }
    }

    /// How it is stored.
    #[must_use]
    pub const fn storage(self) -> Storage {
        self.row().storage
    }

    /// What computes it.
    #[must_use]
    pub const fn source(self) -> Source {
        self.row().source
    }

    /// How its values are distributed.
    #[must_use]
    pub const fn spread(self) -> Spread {
        self.row().spread
    }

    /// True for fields of the critical velocity, which need a friction law. [`Field::Outcome`] is
    /// one only beside them.
    #[must_use]
    pub const fn of_vc(self) -> bool {
        matches!(self.source(), Source::Critical(_))
    }

    /// True for fields of linear stability at v0 or at a given slope.
    #[must_use]
    pub const fn of_sliding(self) -> bool {
        matches!(
            self.source(),
            Source::Line | Source::Roots(_) | Source::Linear(_) | Source::Margins(_)
        )
    }

    /// True for margins.
    #[must_use]
    pub const fn of_margins(self) -> bool {
        matches!(self.source(), Source::Margins(_))
    }

    /// True for fields of the motion of the block, which need a friction law and depend on its
    /// start.
    #[must_use]
    pub const fn of_motion(self) -> bool {
        matches!(
            self.source(),
            Source::Motion(_) | Source::MotionOrCritical(..)
        )
    }

    /// True for fields over many motions, which need a friction law but no start.
    #[must_use]
    pub const fn of_basin(self) -> bool {
        matches!(self.source(), Source::Basin(_))
    }

    /// These fields and what bounds their errors, in the order of a map. An abscissa alone would
    /// claim more than is certified: the margin of the certificate comes with it. Likewise a share
    /// comes with its error and its upper bound.
    #[must_use]
    pub fn with_bounds(mut fields: Vec<Self>) -> Vec<Self> {
        if fields.contains(&Self::Abscissa) {
            fields.push(Self::CertificateMargin);
        }
        if fields.contains(&Self::BasinShare) {
            fields.extend([Self::BasinShareError, Self::BasinShareUpper]);
        }
        fields.sort_unstable();
        fields.dedup();
        fields
    }

    /// True for fields of the limit of a short delay, which only sweeps of it have.
    #[must_use]
    pub const fn of_limit(self) -> bool {
        matches!(self.source(), Source::Limit(_))
    }

    /// The fields of the limit of a short delay.
    pub fn all_of_limit() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|field| field.of_limit())
    }

    /// Number of roots from the right, pairs counted once, that the field needs; 0 if the closed
    /// form gives it.
    #[must_use]
    pub const fn roots_needed(self) -> usize {
        match self.source() {
            Source::Roots(of) => of.needed(),
            _ => 0,
        }
    }

    /// Whether sliding is stable in a cell with this value; none for fields that do not say.
    #[must_use]
    pub fn tells_stable(self, value: f64) -> Option<bool> {
        self.row().stable.map(|stable| stable(value))
    }

    /// Bytes per cell, uncompressed.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self.storage() {
            Storage::Count => size_of::<u16>(),
            Storage::Kind | Storage::Few => size_of::<u8>(),
            Storage::Real => size_of::<f64>(),
        }
    }
}

/// The names of all fields, for messages; numbered ones as a range.
#[must_use]
pub fn known_fields() -> String {
    let names = Field::ALL.into_iter().filter_map(|field| match field {
        Field::Abscissa2 => Some(range(field, Field::Abscissa8)),
        Field::Frequency2 => Some(range(field, Field::Frequency8)),
        _ if field.roots_needed() > 1 => None,
        field => Some(field.name().to_owned()),
    });
    names.collect::<Vec<_>>().join(", ")
}

/// A message about an unknown name: which field may be meant, and all fields.
#[must_use]
pub fn fields_meant(name: &str) -> String {
    let meant = match Parameter::from_name(name) {
        Some(parameter) => format!("{} is a parameter, not a field; ", parameter.name()),
        None => did_you_mean(name, Field::ALL.map(Field::name)),
    };
    format!("{meant}known: {}", known_fields())
}

fn range(first: Field, last: Field) -> String {
    format!("{} … {}", first.name(), last.name())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::track::MOST_ROOTS;

    /// Fields stand in the order in which a tile, and so a map, stores its columns.
    #[test]
    fn counts_stand_before_kinds_and_kinds_before_numbers() {
        let place = |field: Field| match field.storage() {
            Storage::Count => 0,
            Storage::Kind | Storage::Few => 1,
            Storage::Real => 2,
        };
        assert!(Field::ALL.is_sorted_by_key(|field| place(*field)));
    }

    #[test]
    fn every_field_has_a_name_and_a_meaning_of_its_own() {
        for field in Field::ALL {
            assert_eq!(Field::from_name(field.name()), Some(field));
            assert!(field.roots_needed() <= MOST_ROOTS);
            let others = || Field::ALL.into_iter().filter(|f| *f != field);
            assert!(others().all(|other| other.long_name() != field.long_name()));
            assert!(others().all(|other| other.short_name() != field.short_name()));
            assert_eq!(field.kinds().is_some(), field.storage() == Storage::Kind);
        }
    }

    #[test]
    fn roots_are_told_by_their_rank() {
        let of = |rank: usize| match rank {
            0 => String::new(),
            _ => format!("_{}", rank + 1),
        };
        for rank in 0..MOST_ROOTS {
            let named = |name: &str| {
                let field = Field::from_name(&format!("{name}{}", of(rank)));
                field.expect("a field").source()
            };
            let real_part = named("abscissa");
            assert!(matches!(real_part, Source::Roots(OfRoots::RealPart(r)) if r == rank));
            let frequency = named("frequency");
            assert!(matches!(frequency, Source::Roots(OfRoots::Frequency(r)) if r == rank));
        }
    }

    #[test]
    fn slopes_name_their_parameter() {
        let slopes = Field::ALL
            .into_iter()
            .filter_map(|field| match field.source() {
                Source::Roots(OfRoots::Derivative(slope)) => Some((field, slope.parameter())),
                _ => None,
            });
        for (field, parameter) in slopes {
            let (name, symbol) = (parameter.name(), parameter.symbol());
            assert_eq!(field.name(), format!("d_abscissa_d_{name}"));
            assert_eq!(field.short_name(), format!("∂ abscissa / ∂ {symbol}"));
            assert!(field.long_name().ends_with(parameter.long_name()));
        }
    }

    #[test]
    fn every_transition_has_the_number_of_its_name() {
        for transition in Transition::ALL {
            let number = number_of_transition(transition);
            assert_eq!(OUTCOMES[usize::from(number)], transition.name());
        }
        for outcome in Outcome::ALL {
            assert_eq!(OUTCOMES[outcome as usize], outcome.name());
        }
    }

    #[test]
    fn units_follow_from_what_is_divided_by_what() {
        let units = Units::read("N,mm,s").unwrap();
        for (name, unit) in [
            ("n_unstable", "1"),
            ("delay_margin", "s"),
            ("abscissa_3", "s-1"),
            ("frequency", "rad s-1"),
            ("relaxation_time", "s"),
            ("d_abscissa_d_tau", "s-2"),
            ("d_abscissa_d_alpha_v", "1"),
            ("d_abscissa_d_alpha_n", "N-1 mm s-1"),
            ("d_abscissa_d_mu_prime", "mm s-2"),
            ("certificate_margin", "1"),
            ("outcome", "1"),
            ("settle_time", "s"),
            ("last_release", "s"),
            ("n_min", "N"),
            ("peak_force", "N"),
            ("vc_over_vtilde", "1"),
            ("vc", "mm s-1"),
            ("slip_time", "s"),
        ] {
            let field = Field::from_name(name).expect("a field");
            assert_eq!(field.unit(&units), unit, "{name}");
            assert_eq!(field.unit(&Units::default()), "1");
        }
    }

    #[test]
    fn numbered_names_are_listed_as_ranges() {
        let known = known_fields();
        for part in [
            "abscissa, abscissa_2 … abscissa_8, ",
            "frequency, frequency_2 … frequency_8, ",
        ] {
            assert!(known.contains(part), "{known}");
        }
        let one_by_one = known.split(", ").filter(|name| !name.contains('…'));
        let fields = Field::ALL
            .into_iter()
            .filter(|field| field.roots_needed() < 2);
        assert!(one_by_one.eq(fields.map(Field::name)), "{known}");
    }
}
