//! Why a cell shows no value: the rule, its words, and how such cells are filled.

use super::colour::{self, Rgb};
use crate::linear::status::{CERTIFIED, DISAGREE, MARGINAL, NOT_CONVERGED, OUTSIDE_MODEL};
use crate::setting::Field;
use crate::setting::field::OUTCOMES;
use crate::setting::regime_at_v0::RegimeAtV0;
use crate::setting::source::Source;
use crate::slip::outcome::Outcome;
use crate::sweep::engine::STATUS_FILL;

/// Why a cell shows no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Gap {
    /// Its computation did not converge.
    NotConverged,
    /// Two methods disagree about it.
    Disagree,
    /// It lies within rounding of a boundary.
    Marginal,
    /// The field itself is undecided there.
    Undecided,
    /// The normal load reaches 0 first.
    LiftsOff,
    /// Stick-slip persists at the largest velocity that was tried.
    Persists,
    /// The setting is outside the model's range.
    OutsideModel,
    /// The field has no value there.
    NoValue,
    /// The cell is not computed yet.
    NotComputed,
}

impl Gap {
    /// Every gap, in the order of legends.
    pub(crate) const ALL: [Self; 9] = [
        Self::NotConverged,
        Self::Disagree,
        Self::Marginal,
        Self::Undecided,
        Self::LiftsOff,
        Self::Persists,
        Self::OutsideModel,
        Self::NoValue,
        Self::NotComputed,
    ];

    /// Whether an answer exists but is not known, whatever number the map has.
    pub(crate) const fn is_unknown(self) -> bool {
        matches!(
            self,
            Self::NotConverged | Self::Disagree | Self::Marginal | Self::Undecided
        )
    }

    /// Its words in the legend of a picture of `field`.
    pub(crate) fn words(self, field: Field) -> &'static str {
        match self {
            Self::NotConverged => "not converged",
            Self::Disagree => "methods disagree",
            Self::Marginal => "marginal",
            Self::Undecided => "undecided",
            Self::LiftsOff => "no value: lifts off",
            Self::Persists => "no value: persists",
            Self::OutsideModel => "no value: outside the model",
            Self::NoValue => match field {
                Field::VLiftoff => "no lift-off",
                Field::VSmooth => "not smooth at the largest velocity",
                Field::SettleTime => "does not settle",
                Field::LastRelease => "sticks go on",
                _ => "no value",
            },
            Self::NotComputed => "not computed",
        }
    }

    /// A word for it, for programs.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::NotConverged => "not-converged",
            Self::Disagree => "disagree",
            Self::Marginal => "marginal",
            Self::Undecided => "undecided",
            Self::LiftsOff => "lifts-off",
            Self::Persists => "persists",
            Self::OutsideModel => "outside-model",
            Self::NoValue => "no-value",
            Self::NotComputed => "not-computed",
        }
    }

    /// The lines over cells with it; none where the colour is enough.
    pub(crate) const fn lines(self) -> &'static [Run] {
        match self {
            Self::NotConverged => &[Run::Rising],
            Self::Marginal => &[Run::Falling],
            Self::Disagree => &[Run::Rising, Run::Falling],
            Self::Undecided => &[Run::Upright],
            Self::NoValue => &[Run::Level],
            Self::OutsideModel => &[Run::Level, Run::Rising],
            Self::LiftsOff | Self::Persists | Self::NotComputed => &[],
        }
    }

    /// The colour of cells with it, below the lines.
    pub(crate) const fn ground(self) -> Rgb {
        match self {
            Self::LiftsOff => colour::LIFTS_OFF,
            Self::Persists => colour::PERSISTS,
            Self::NoValue => colour::NO_VALUE,
            Self::OutsideModel => colour::OUTSIDE_MODEL,
            Self::NotComputed => colour::PAPER,
            Self::NotConverged | Self::Disagree | Self::Marginal | Self::Undecided => {
                colour::UNKNOWN
            }
        }
    }
}

/// Direction of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Run {
    Rising,
    Falling,
    Upright,
    Level,
}

impl Run {
    /// Its name.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Rising => "rising",
            Self::Falling => "falling",
            Self::Upright => "upright",
            Self::Level => "level",
        }
    }
}

/// The rule by which cells of a field show no value, beside the other fields that they have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rule {
    field: Field,
    with_roots: bool,
    /// The field that says why a cell has no value.
    why: Option<Field>,
}

impl Rule {
    /// The rule of a field among those that are `held`.
    pub(crate) fn of(field: Field, held: &[Field]) -> Self {
        let asked = match field {
            Field::VLiftoff | Field::Outcome => false,
            _ => field.of_vc() || field.of_motion(),
        };
        let mut telling = [Field::Outcome, Field::VLiftoff].into_iter();
        Self {
            field,
            with_roots: held.iter().any(|f| matches!(f.source(), Source::Roots(_))),
            why: telling.find(|other| asked && held.contains(other)),
        }
    }

    /// The field that says why a cell has no value, if there is one.
    pub(crate) fn why(self) -> Option<Field> {
        self.why
    }

    /// Why the number `value` of a cell with this status is not shown; none where it is. `why` is
    /// its value of the field that says so.
    pub(crate) fn gap(self, value: f64, status: u8, why: Option<f64>) -> Option<Gap> {
        let found = gap(self.field, value, status, self.with_roots)?;
        let ended = || ended(self.why?, why?);
        Some(match found {
            Gap::NoValue => ended().unwrap_or(found),
            _ => found,
        })
    }
}

/// The gap of a cell without a value, from the value of the field that says why.
fn ended(told_by: Field, value: f64) -> Option<Gap> {
    if told_by == Field::VLiftoff {
        return (!value.is_nan()).then_some(Gap::LiftsOff);
    }
    match kind_name(value)? {
        "lift-off" => Some(Gap::LiftsOff),
        "persists" => Some(Gap::Persists),
        _ => None,
    }
}

fn kind_name(number: f64) -> Option<&'static str> {
    // The cast would turn NaN into 0.
    (number >= 0.0).then(|| OUTCOMES.get(number as usize).copied())?
}

/// Why the number `value` of a cell with this status is not shown; none where it is.
fn gap(field: Field, value: f64, status: u8, with_roots: bool) -> Option<Gap> {
    if status == STATUS_FILL {
        return Some(Gap::NotComputed);
    }
    if status & OUTSIDE_MODEL != 0 && value.is_nan() {
        return Some(Gap::OutsideModel);
    }
    let undecided = match field {
        Field::Outcome => value == f64::from(Outcome::Undecided as u8),
        Field::Regime => value == f64::from(RegimeAtV0::Undecided as u8),
        _ => false,
    };
    let amiss = status & concerning(field, undecided || value.is_nan(), status, with_roots);
    [
        (DISAGREE, Gap::Disagree),
        (NOT_CONVERGED, Gap::NotConverged),
        (MARGINAL, Gap::Marginal),
    ]
    .into_iter()
    .find(|(flag, _)| amiss & flag != 0)
    .map(|(_, gap)| gap)
    .or(undecided.then_some(Gap::Undecided))
    .or(value.is_nan().then_some(Gap::NoValue))
}

/// The flags of a status with which a value of the field is not known; `open`: the field has no
/// answer. The status is shared by all fields of a cell, so flags of roots do not concern the
/// others.
fn concerning(field: Field, open: bool, status: u8, with_roots: bool) -> u8 {
    let of_count = match field.tells_stable(0.0) {
        Some(_) => MARGINAL,
        None => 0,
    };
    let certified = status & CERTIFIED != 0;
    match field.source() {
        Source::Line if field == Field::NUnstable && open => of_count | NOT_CONVERGED,
        Source::Line if with_roots && !certified => of_count | DISAGREE,
        Source::Line => of_count,
        Source::Linear(_) => 0,
        // A radius that is not tight is proved nevertheless.
        Source::Margins(_) if open => of_count | NOT_CONVERGED,
        Source::Margins(_) => of_count,
        Source::Roots(_) if certified => of_count,
        Source::Roots(_) => of_count | NOT_CONVERGED | DISAGREE,
        // Where v_c is undecided, its bounds may still decide the regime.
        Source::Critical(_) if field == Field::Regime && !open => DISAGREE,
        Source::Critical(_) if field == Field::Regime => DISAGREE | NOT_CONVERGED | MARGINAL,
        // The bounds are known even where v_c is not.
        Source::Critical(_) if matches!(field, Field::VcLower | Field::VcUpper) && !open => {
            DISAGREE
        }
        // The error and the upper bound are known even where the share is not.
        Source::Basin(_) if field != Field::BasinShare => DISAGREE,
        Source::Motion(_)
        | Source::MotionOrCritical(..)
        | Source::Critical(_)
        | Source::Basin(_) => NOT_CONVERGED | DISAGREE,
        Source::Limit(_) => NOT_CONVERGED,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_hide_the_fields_that_they_concern() {
        let of = |field, value, status| gap(field, value, status, false);
        assert_eq!(of(Field::Vc, 0.0, 0), None);
        assert_eq!(of(Field::Vc, 0.0, NOT_CONVERGED), Some(Gap::NotConverged));
        assert_eq!(
            of(Field::VSmooth, 1.0, NOT_CONVERGED),
            Some(Gap::NotConverged)
        );
        assert_eq!(of(Field::VcUpper, 1.0, NOT_CONVERGED), None);
        assert_eq!(of(Field::Regime, 0.0, NOT_CONVERGED), None);
        assert_eq!(of(Field::NUnstable, 2.0, NOT_CONVERGED), None);
        assert_eq!(
            of(Field::NUnstable, f64::NAN, NOT_CONVERGED),
            Some(Gap::NotConverged)
        );
        assert_eq!(of(Field::NUnstable, 2.0, MARGINAL), Some(Gap::Marginal));
        assert_eq!(of(Field::Vc, 1.0, MARGINAL), None);
        assert_eq!(
            of(Field::Vc, 1.0, DISAGREE | NOT_CONVERGED),
            Some(Gap::Disagree)
        );
        let undecided = f64::from(RegimeAtV0::Undecided as u8);
        assert_eq!(of(Field::Regime, undecided, 0), Some(Gap::Undecided));
        assert_eq!(of(Field::Regime, undecided, MARGINAL), Some(Gap::Marginal));
        assert_eq!(of(Field::Abscissa, -1.0, CERTIFIED | NOT_CONVERGED), None);
        assert_eq!(of(Field::Abscissa, -1.0, DISAGREE), Some(Gap::Disagree));
        assert_eq!(of(Field::Vc, f64::NAN, 0), Some(Gap::NoValue));
        let outside = of(Field::Vc, f64::NAN, OUTSIDE_MODEL);
        assert_eq!(outside, Some(Gap::OutsideModel));
        assert_eq!(of(Field::Vc, 0.0, STATUS_FILL), Some(Gap::NotComputed));
    }

    /// If the roots disagree with the closed form, the count is in dispute too.
    #[test]
    fn counts_are_known_where_roots_agree() {
        let of = |status, with_roots| gap(Field::NUnstable, 2.0, status, with_roots);
        assert_eq!(of(DISAGREE, true), Some(Gap::Disagree));
        assert_eq!(of(DISAGREE | CERTIFIED, true), None);
        assert_eq!(of(DISAGREE, false), None);
    }

    #[test]
    fn ends_of_stick_slip_tell_why_there_is_no_value() {
        let number = |name: &str| OUTCOMES.iter().position(|o| *o == name).unwrap() as f64;
        let by_outcome = |name| ended(Field::Outcome, number(name));
        assert_eq!(by_outcome("lift-off"), Some(Gap::LiftsOff));
        assert_eq!(by_outcome("persists"), Some(Gap::Persists));
        assert_eq!(by_outcome("grazing"), None);
        assert_eq!(ended(Field::Outcome, f64::NAN), None);
        assert_eq!(ended(Field::VLiftoff, 2.0), Some(Gap::LiftsOff));
        assert_eq!(ended(Field::VLiftoff, f64::NAN), None);
    }

    #[test]
    fn no_two_gaps_have_the_same_words() {
        for field in Field::ALL {
            for (i, gap) in Gap::ALL.into_iter().enumerate() {
                let mut others = Gap::ALL[..i].iter();
                assert!(others.all(|other| other.words(field) != gap.words(field)));
            }
        }
    }

    #[test]
    fn no_two_gaps_look_alike_or_share_a_name() {
        for (i, a) in Gap::ALL.into_iter().enumerate() {
            for b in &Gap::ALL[..i] {
                assert!(
                    a.ground() != b.ground() || a.lines() != b.lines(),
                    "{a:?} {b:?}"
                );
                assert_ne!(a.name(), b.name());
            }
        }
    }

    #[test]
    fn another_field_says_why_there_is_no_value() {
        let number = |name: &str| OUTCOMES.iter().position(|o| *o == name).unwrap() as f64;
        let rule = Rule::of(Field::Vc, &[Field::Vc, Field::VLiftoff, Field::Outcome]);
        assert_eq!(rule.why(), Some(Field::Outcome));
        let persists = Some(number("persists"));
        assert_eq!(rule.gap(f64::NAN, 0, persists), Some(Gap::Persists));
        assert_eq!(rule.gap(1.0, 0, persists), None);
        assert_eq!(rule.gap(f64::NAN, 0, None), Some(Gap::NoValue));
        assert_eq!(Rule::of(Field::Outcome, &Field::ALL).why(), None);
        assert_eq!(Rule::of(Field::Abscissa, &Field::ALL).why(), None);
    }
}
