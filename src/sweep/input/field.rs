//! What a map can hold for each cell: every field's one name, meaning, unit and type.

use super::class::Class;
use super::limit_field::LimitField;
use super::parameter::{Parameter, Units};
use crate::critical::{Critical, End, Method};
use crate::linear::track::MOST_ROOTS;
use crate::slip::outcome::Outcome;

/// Names of the real and imaginary parts of the roots, by their rank from the right, and the rank
/// in words.
const ABSCISSAE: [&str; MOST_ROOTS] = [
    "abscissa",
    "abscissa_2",
    "abscissa_3",
    "abscissa_4",
    "abscissa_5",
    "abscissa_6",
    "abscissa_7",
    "abscissa_8",
];
const FREQUENCIES: [&str; MOST_ROOTS] = [
    "frequency",
    "frequency_2",
    "frequency_3",
    "frequency_4",
    "frequency_5",
    "frequency_6",
    "frequency_7",
    "frequency_8",
];
const ORDINALS: [&str; MOST_ROOTS] = [
    "rightmost",
    "second",
    "third",
    "fourth",
    "fifth",
    "sixth",
    "seventh",
    "eighth",
];

/// The place of a characteristic root from the right, conjugate pairs counted once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Rank(usize);

impl Rank {
    /// The rightmost root.
    pub const FIRST: Self = Self(0);

    /// 0 for the rightmost root, less than [`MOST_ROOTS`].
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0
    }
}

/// A parameter with respect to which the spectral abscissa is differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Slope {
    /// τ.
    Tau,
    /// α_v.
    AlphaV,
    /// α_N.
    AlphaN,
    /// μ_K′, at fixed μ_K.
    MuPrime,
}

impl Slope {
    /// The parameter.
    #[must_use]
    pub const fn parameter(self) -> Parameter {
        match self {
            Self::Tau => Parameter::Tau,
            Self::AlphaV => Parameter::AlphaV,
            Self::AlphaN => Parameter::AlphaN,
            Self::MuPrime => Parameter::MuPrime,
        }
    }
}

/// A quantity computed for every cell. `status` comes with every map and is not listed here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Field {
    /// Number of unstable roots.
    NUnstable,
    /// What becomes of the motion or, beside fields of the critical velocity, of stick-slip there:
    /// a number of [`OUTCOMES`].
    Outcome,
    /// Number of the [`Method`] that gave the critical velocity.
    Method,
    /// Number of the [`Class`] of v0.
    Class,
    /// Number of windows of v0, up to the largest one at which it is looked for, in which
    /// stick-slip survives, whatever ends it there: v_c, N ≤ 0 or the range.
    Windows,
    /// Signed distance in τ to the nearest change of stability.
    DelayMargin,
    /// Re λ of the root of that rank; −∞ where there are fewer roots. Of the first: the spectral
    /// abscissa.
    Abscissa(Rank),
    /// |Im λ| of the root of that rank, 0 for a real one; NaN where there are fewer roots.
    Frequency(Rank),
    /// −1/abscissa where the abscissa is negative, else +∞.
    RelaxationTime,
    /// Derivative of the spectral abscissa.
    AbscissaSlope(Slope),
    /// How far right of the spectral abscissa a line lies that no root is right of.
    CertificateMargin,
    /// From switch-on until ẋ stays within 1 % of v0; NaN where the motion does not come to slide.
    SettleTime,
    /// The smallest load since switch-on.
    NMin,
    /// The largest spring force since switch-on.
    PeakForce,
    /// The critical velocity; 0 where stick-slip is never sustained.
    Vc,
    /// The smallest v0 at which N ≤ 0 occurs.
    VLiftoff,
    /// Time stuck in a period at the critical velocity.
    StickTime,
    /// Time in slip in a period there.
    SlipTime,
    /// The velocity above which sliding is linearly stable and free of stick-slip.
    VSmooth,
    /// Of the limit of a short delay.
    Limit(LimitField),
}

/// Names of all that a motion or stick-slip can come to, in the order of their numbers in maps:
/// those of [`Outcome`], then those of [`End`] that are no outcome as well.
pub const OUTCOMES: [&str; Outcome::ALL.len() + End::ALL.len() - 1] = {
    let mut names = [""; Outcome::ALL.len() + End::ALL.len() - 1];
    let mut i = 0;
    while i < Outcome::ALL.len() {
        names[i] = Outcome::ALL[i].name();
        i += 1;
    }
    let mut j = 0;
    while j < End::ALL.len() {
        if !matches!(End::ALL[j], End::LiftOff) {
            names[i] = End::ALL[j].name();
            i += 1;
        }
        j += 1;
    }
    names
};

/// The place in [`OUTCOMES`] of what is told of stick-slip: undecided where none was found, but not
/// everywhere.
#[must_use]
pub fn number_of_outcome(critical: &Critical) -> u8 {
    match critical.end {
        End::Never if !critical.decided => Outcome::Undecided as u8,
        end => number_of_end(end),
    }
}

/// The place of an end in [`OUTCOMES`].
pub(crate) fn number_of_end(end: End) -> u8 {
    let first = Outcome::ALL.len() as u8;
    match end {
        End::LiftOff => Outcome::LiftOff as u8,
        _ if end < End::LiftOff => first + end as u8,
        _ => first + end as u8 - 1,
    }
}

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

impl Field {
    const COUNT: usize = 20 + 2 * MOST_ROOTS + LimitField::ALL.len();

    /// All fields, in the order in which maps hold them.
    pub const ALL: [Self; Self::COUNT] = Self::all();

    const fn all() -> [Self; Self::COUNT] {
        let mut all = [Self::NUnstable; Self::COUNT];
        all[1] = Self::Outcome;
        all[2] = Self::Method;
        all[3] = Self::Class;
        all[4] = Self::Windows;
        all[5] = Self::DelayMargin;
        let mut rank = 0;
        while rank < MOST_ROOTS {
            all[6 + rank] = Self::Abscissa(Rank(rank));
            all[6 + MOST_ROOTS + rank] = Self::Frequency(Rank(rank));
            rank += 1;
        }
        let rest = 6 + 2 * MOST_ROOTS;
        all[rest] = Self::RelaxationTime;
        all[rest + 1] = Self::AbscissaSlope(Slope::Tau);
        all[rest + 2] = Self::AbscissaSlope(Slope::AlphaV);
        all[rest + 3] = Self::AbscissaSlope(Slope::AlphaN);
        all[rest + 4] = Self::AbscissaSlope(Slope::MuPrime);
        all[rest + 5] = Self::CertificateMargin;
        all[rest + 6] = Self::SettleTime;
        all[rest + 7] = Self::NMin;
        all[rest + 8] = Self::PeakForce;
        all[rest + 9] = Self::Vc;
        all[rest + 10] = Self::VLiftoff;
        all[rest + 11] = Self::StickTime;
        all[rest + 12] = Self::SlipTime;
        all[rest + 13] = Self::VSmooth;
        let mut i = 0;
        while i < LimitField::ALL.len() {
            all[rest + 14 + i] = Self::Limit(LimitField::ALL[i]);
            i += 1;
        }
        all
    }

    /// The spectral abscissa.
    pub const ABSCISSA: Self = Self::Abscissa(Rank::FIRST);

    /// The name in sweep files and maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NUnstable => "n_unstable",
            Self::DelayMargin => "delay_margin",
            Self::Abscissa(rank) => ABSCISSAE[rank.0],
            Self::Frequency(rank) => FREQUENCIES[rank.0],
            Self::RelaxationTime => "relaxation_time",
            Self::AbscissaSlope(Slope::Tau) => "d_abscissa_d_tau",
            Self::AbscissaSlope(Slope::AlphaV) => "d_abscissa_d_alpha_v",
            Self::AbscissaSlope(Slope::AlphaN) => "d_abscissa_d_alpha_n",
            Self::AbscissaSlope(Slope::MuPrime) => "d_abscissa_d_mu_prime",
            Self::CertificateMargin => "certificate_margin",
            Self::Outcome => "outcome",
            Self::SettleTime => "settle_time",
            Self::NMin => "n_min",
            Self::PeakForce => "peak_force",
            Self::Limit(field) => field.name(),
            Self::Vc => "vc",
            Self::Method => "method",
            Self::Class => "class",
            Self::Windows => "windows",
            Self::VLiftoff => "v_liftoff",
            Self::StickTime => "stick_time",
            Self::SlipTime => "slip_time",
            Self::VSmooth => "v_smooth",
        }
    }

    /// The field of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }

    /// What it is, for `long_name` in maps and notes in pictures.
    #[must_use]
    pub fn long_name(self) -> String {
        match self {
            Self::NUnstable => "number of characteristic roots with positive real part".into(),
            Self::DelayMargin => {
                "distance in delay to the nearest change of stability, positive where stable".into()
            }
            Self::ABSCISSA => {
                "spectral abscissa, the largest real part of the characteristic roots".into()
            }
            Self::Abscissa(rank) => format!(
                "real part of the {} characteristic root from the right, pairs counted once",
                ORDINALS[rank.0]
            ),
            Self::Frequency(Rank::FIRST) => {
                "angular frequency of the rightmost characteristic root".into()
            }
            Self::Frequency(rank) => format!(
                "angular frequency of the {} characteristic root from the right, pairs counted \
                once",
                ORDINALS[rank.0]
            ),
            Self::RelaxationTime => "time in which a small disturbance decays by a factor e".into(),
            Self::AbscissaSlope(slope) => format!(
                "derivative of the spectral abscissa with respect to the {}",
                slope.parameter().long_name()
            ),
            Self::CertificateMargin => {
                "certified distance: no characteristic root lies farther right of the abscissa"
                    .into()
            }
            Self::Outcome => "what becomes of the motion".into(),
            Self::SettleTime => {
                "time from switch-on until the velocity stays within 1 % of v0".into()
            }
            Self::NMin => "smallest normal load since switch-on".into(),
            Self::PeakForce => "largest spring force since switch-on".into(),
            Self::Limit(field) => field.long_name().into(),
            Self::Vc => "critical velocity, above which stick-slip does not survive".into(),
            Self::Method => "what gave the critical velocity".into(),
            Self::Class => "what the working velocity v0 is good for".into(),
            Self::Windows => {
                "number of windows of v0, up to v_max, in which stick-slip survives".into()
            }
            Self::VLiftoff => "smallest v0 at which the normal load reaches 0".into(),
            Self::StickTime => "time stuck in a period at the critical velocity".into(),
            Self::SlipTime => "time in slip in a period at the critical velocity".into(),
            Self::VSmooth => {
                "velocity above which sliding is linearly stable and free of stick-slip".into()
            }
        }
    }

    /// What it is in a few words, for titles of axes and colour bars.
    #[must_use]
    pub fn short_name(self) -> String {
        match self {
            Self::NUnstable => "number of unstable roots".into(),
            Self::DelayMargin => "delay margin".into(),
            Self::ABSCISSA => "spectral abscissa".into(),
            Self::Abscissa(rank) => format!("Re λ, {} root", ORDINALS[rank.0]),
            Self::Frequency(Rank::FIRST) => "frequency".into(),
            Self::Frequency(rank) => format!("|Im λ|, {} root", ORDINALS[rank.0]),
            Self::RelaxationTime => "relaxation time".into(),
            Self::AbscissaSlope(slope) => {
                format!("∂ abscissa / ∂ {}", slope.parameter().symbol())
            }
            Self::CertificateMargin => "certificate margin".into(),
            Self::Outcome => "outcome".into(),
            Self::SettleTime => "settle time".into(),
            Self::NMin => "smallest load".into(),
            Self::PeakForce => "peak force".into(),
            Self::Limit(field) => field.short_name().into(),
            Self::Vc => "critical velocity".into(),
            Self::Method => "method".into(),
            Self::Class => "at v0".into(),
            Self::Windows => "windows of v0".into(),
            Self::VLiftoff => "lift-off velocity".into(),
            Self::StickTime => "stick time".into(),
            Self::SlipTime => "slip time".into(),
            Self::VSmooth => "smooth above".into(),
        }
    }

    /// What a reader of the map should know besides, if anything.
    #[must_use]
    pub const fn comment(self) -> Option<&'static str> {
        match self {
            Self::ABSCISSA => Some(
                "certified in status: the argument principle, which shares nothing with the \
                computation of the roots, \
                 finds no root with Re lambda > abscissa + certificate_margin * max(1/t, \
                 |abscissa|), \
                 t = sqrt(mass/stiffness)",
            ),
            Self::Abscissa(_) => Some("-infinity where there are fewer roots"),
            Self::RelaxationTime => {
                Some("-1/abscissa; infinity where the abscissa is not negative")
            }
            Self::AbscissaSlope(Slope::MuPrime) => Some("at fixed mu_k"),
            Self::CertificateMargin => {
                Some("in units of max(1/t, |abscissa|), t = sqrt(mass/stiffness)")
            }
            Self::Outcome => Some(
                "undecided: none of the others before the horizon or within the steps allowed, \
                not_converged in status; \
                 no-cycle: no uncontrolled stick-slip at whose phase control could be switched on",
            ),
            Self::SettleTime => Some("no value where the motion does not come to slide"),
            Self::Limit(field) => field.comment(),
            Self::NMin | Self::PeakForce => {
                Some("until the outcome was known; where control never acts, since t = 0")
            }
            Self::Vc => Some(
                "0 where stick-slip is not sustained at any v0; no value where N <= 0 ends it or \
                it survives at v_max",
            ),
            Self::Class => Some(
                "stable: sliding is linearly stable, without stick-slip beside it; bistable: \
                stick-slip persists beside it; \
                 lift-off: linearly stable, but stick-slip leads to N <= 0 at v0 or below; \
                 undecided: marginal, or not known",
            ),
            Self::Windows => Some(
                "those that end where N <= 0 or reach v_max count; follow: one, from 0, or none; \
                switch-on: windows between \
                 the velocities that are tried may be missed",
            ),
            Self::StickTime | Self::SlipTime => Some("no value for the protocol switch-on"),
            Self::VSmooth => {
                Some("up to v_max; no value where sliding is not stable at v_max or there is no vc")
            }
            _ => None,
        }
    }

    /// What there is of it to know beside fields of the critical velocity: its long name and
    /// comment.
    #[must_use]
    pub fn described_at_vc(self) -> (String, Option<&'static str>) {
        match self {
            Self::Outcome => (
                "how stick-slip ends at the critical velocity".into(),
                Some(
                    "lost: above it does not survive switching on, or there is none to switch on \
                    in; persists: it survives at \
                     v_max; undecided: it was not found, but it is not known everywhere",
                ),
            ),
            _ => (self.long_name(), self.comment()),
        }
    }

    /// The names of its kinds, in the order of their numbers; none where it is no
    /// [`Storage::Kind`].
    #[must_use]
    pub fn kinds(self) -> Option<Vec<&'static str>> {
        match self {
            Self::Outcome => Some(OUTCOMES.to_vec()),
            Self::Method => Some(Method::ALL.map(Method::name).to_vec()),
            Self::Class => Some(Class::ALL.map(Class::name).to_vec()),
            _ => None,
        }
    }

    /// The unit, as UDUNITS writes it; "1" if dimensionless.
    #[must_use]
    pub fn unit(self, units: &Units) -> String {
        match self {
            Self::NUnstable | Self::CertificateMargin | Self::Outcome | Self::Limit(_) => {
                units.of([0; 3])
            }
            Self::Method | Self::Class | Self::Windows => units.of([0; 3]),
            Self::Vc | Self::VLiftoff | Self::VSmooth => units.of([0, 1, -1]),
            Self::StickTime | Self::SlipTime => units.time(),
            Self::DelayMargin | Self::RelaxationTime | Self::SettleTime => units.time(),
            Self::NMin | Self::PeakForce => units.of([1, 0, 0]),
            Self::Abscissa(_) => units.of([0, 0, -1]),
            Self::Frequency(_) => units.angular_frequency(),
            Self::AbscissaSlope(slope) => {
                let [force, length, time] = slope.parameter().dimension();
                units.of([-force, -length, -1 - time])
            }
        }
    }

    /// How it is stored.
    #[must_use]
    pub const fn storage(self) -> Storage {
        match self {
            Self::NUnstable => Storage::Count,
            Self::Outcome | Self::Method | Self::Class => Storage::Kind,
            Self::Windows => Storage::Few,
            _ => Storage::Real,
        }
    }

    /// True for fields of the critical velocity, which need a friction law; [`Field::Outcome`] is
    /// one beside them only.
    #[must_use]
    pub const fn of_vc(self) -> bool {
        matches!(
            self,
            Self::Vc
                | Self::Method
                | Self::Class
                | Self::Windows
                | Self::VLiftoff
                | Self::StickTime
                | Self::SlipTime
                | Self::VSmooth
        )
    }

    /// True for fields of linear stability at v0 or at a given slope.
    #[must_use]
    pub const fn of_sliding(self) -> bool {
        !self.of_motion() && !self.of_vc() && !self.of_limit()
    }

    /// True for fields of the motion of the block, which need a friction law and depend on its
    /// start.
    #[must_use]
    pub const fn of_motion(self) -> bool {
        matches!(
            self,
            Self::Outcome | Self::SettleTime | Self::NMin | Self::PeakForce
        )
    }

    /// True for fields of the limit of a short delay, which need
    /// [`Protocol::Limit`](super::protocol::Protocol::Limit).
    #[must_use]
    pub const fn of_limit(self) -> bool {
        matches!(self, Self::Limit(_))
    }

    /// Number of roots from the right, pairs counted once, that the field needs; 0 if the closed
    /// form gives it.
    #[must_use]
    pub const fn roots_needed(self) -> usize {
        match self {
            Self::Abscissa(rank) | Self::Frequency(rank) => rank.0 + 1,
            Self::RelaxationTime | Self::AbscissaSlope(_) | Self::CertificateMargin => 1,
            _ => 0,
        }
    }

    /// Whether sliding is stable in a cell with this value; none for fields that do not tell.
    #[must_use]
    pub fn tells_stable(self, value: f64) -> Option<bool> {
        match self {
            Self::NUnstable => Some(value == 0.0),
            Self::DelayMargin => Some(value > 0.0),
            Self::ABSCISSA => Some(value < 0.0),
            Self::RelaxationTime => Some(value < f64::INFINITY),
            _ => None,
        }
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
    let last = MOST_ROOTS - 1;
    let names = Field::ALL.into_iter().filter_map(|field| match field {
        Field::Abscissa(Rank(1)) => Some(format!("{} … {}", ABSCISSAE[1], ABSCISSAE[last])),
        Field::Frequency(Rank(1)) => Some(format!("{} … {}", FREQUENCIES[1], FREQUENCIES[last])),
        Field::Abscissa(Rank(2..)) | Field::Frequency(Rank(2..)) => None,
        field => Some(field.name().to_owned()),
    });
    names.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_in_order_and_have_names_of_their_own() {
        assert!(Field::ALL.windows(2).all(|w| w[0] < w[1]));
        for field in Field::ALL {
            assert_eq!(Field::from_name(field.name()), Some(field));
            assert!(field.roots_needed() <= MOST_ROOTS);
        }
    }

    #[test]
    fn every_end_has_the_number_of_its_name() {
        for end in End::ALL {
            assert_eq!(OUTCOMES[usize::from(number_of_end(end))], end.name());
        }
        for outcome in Outcome::ALL {
            assert_eq!(OUTCOMES[outcome as usize], outcome.name());
        }
    }

    #[test]
    fn units_follow_from_what_is_divided_by_what() {
        let names = ["N", "mm", "s"].map(String::from);
        let units = Units {
            force_length_time: Some(names),
        };
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
        assert_eq!(
            known_fields(),
            "n_unstable, outcome, method, class, windows, delay_margin, abscissa, abscissa_2 … \
            abscissa_8, frequency, \
             frequency_2 … frequency_8, relaxation_time, d_abscissa_d_tau, d_abscissa_d_alpha_v, \
             d_abscissa_d_alpha_n, d_abscissa_d_mu_prime, certificate_margin, settle_time, n_min, \
             peak_force, \
             vc, v_liftoff, stick_time, slip_time, v_smooth, \
             vc_over_vtilde, omega0_T, liftoff_over_vtilde, vc_weak_control, vc_strong_control, \
             weak_control_error, \
             strong_control_error"
        );
    }
}
