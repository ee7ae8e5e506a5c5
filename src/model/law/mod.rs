//! Kinetic friction laws μ_K(v): a law is one file, and its lines here.
//!
//! - `coulomb`: the same at all speeds
//! - `discs`: how far a series holds whose first coefficients do not tell
//! - `form`: what is said of a law wherever laws are named
//! - `formula`: any formula in the speed
//! - `hyperbolic`: a transition by 1/cosh
//! - `stribeck`: a Gaussian transition
//! - `table`: measured points
//! - `weakening`: the letter's velocity weakening

mod coulomb;
mod discs;
mod form;
pub(crate) mod formula;
mod hyperbolic;
mod stribeck;
mod table;
mod weakening;

pub use coulomb::Coulomb;
pub use form::Form;
pub(crate) use form::Made;
pub use formula::{ByFormula, Formula};
pub use stribeck::Stribeck;
pub(crate) use table::Crossing;
pub use weakening::Weakening;

use super::error::AT_MOST_MU_S;
use super::series::Coefficients;
use super::{ModelError, RateAndState, Table};

/// The least and the greatest value.
type Range = (f64, f64);

/// A law of kinetic friction as a function of the sliding speed, in its own units.
pub(crate) trait Law {
    /// Its Taylor series along a motion.
    type Series: Series;

    /// Its row where laws are named; none where parameters alone do not describe it.
    const FORM: Option<&'static Form> = None;

    /// See [`FrictionLaw::mu_k`].
    fn mu_k(&self, speed: f64) -> f64;

    /// See [`FrictionLaw::mu_prime`].
    fn mu_prime(&self, speed: f64) -> f64;

    /// See [`FrictionLaw::speed_scale`].
    fn speed_scale(&self, speed: f64) -> f64;

    /// See [`FrictionLaw::least_speed`].
    fn least_speed(&self) -> f64 {
        f64::NEG_INFINITY
    }

    /// See [`FrictionLaw::last_speed`].
    fn last_speed(&self) -> Option<f64> {
        None
    }

    /// See [`FrictionLaw::slopes_between`].
    fn slopes_between(&self, from: f64, to: f64) -> Range;

    /// See [`FrictionLaw::curvatures_between`].
    fn curvatures_between(&self, from: f64, to: f64) -> Range;

    /// The series at the speed 0, with ẋ in units of `velocity_unit`.
    fn series(&self, velocity_unit: f64) -> Self::Series;
}

/// Coefficients of the friction μ_K(|ẋ|) n along a motion, grown one by one as those of speed and
/// load become known.
pub(crate) trait Series {
    /// Coefficient `k`; `speed` is coefficient k of |ẋ|, and the smaller ones were given before.
    /// `load` is known up to k.
    fn extend(&mut self, k: usize, speed: f64, load: &Coefficients) -> f64;

    /// The longest step, at most `length`, on which the series is accurate to `error`, relative to
    /// the load. `speed` holds the coefficients of ẋ. All of `length` where the law is a polynomial
    /// of the speed, or shows in the growth of its coefficients how far they hold. Far above the
    /// scale of an exponential the first ones are small whatever the later ones are: see `discs`.
    fn resolved(&self, speed: &[f64], length: f64, error: f64) -> f64;

    /// μ_K at a speed in the motion's units by the piece of the law in use, also beyond its ends;
    /// none where the law is of one piece.
    fn value(&self, _speed: f64) -> Option<f64> {
        None
    }

    /// Restarts at `speed`, whatever the speed was before.
    fn restart(&mut self, _speed: f64) {}

    /// Takes over the place of `other`, the series of the same law.
    fn copy_place(&mut self, _other: &Self) {}
}

/// The laws, each with its name and its type.
macro_rules! laws {
    ($d:tt $($name:ident: $law:ty),* $(,)?) => {
        /// A law, with its parameters in the symbols of the constructors of [`FrictionLaw`].
        #[derive(Debug, Clone, PartialEq)]
        pub enum Kind {
            $(
                #[doc = concat!("The law of [`FrictionLaw`] called ", stringify!($name), ".")]
                $name($law)
            ),*
        }

        /// A law's series, with its speeds in the motion's units. One type for each law, so that a
        /// step asks only once which it is.
        #[allow(
            clippy::large_enum_variant,
            reason = "one for each motion, and never moved"
        )]
        #[derive(Debug, Clone)]
        pub(crate) enum FrictionSeries {
            $($name(<$law as Law>::Series)),*
        }

        impl FrictionSeries {
            /// For `law` at the speed 0, with ẋ in units of `velocity_unit`.
            pub(crate) fn new(law: &FrictionLaw, velocity_unit: f64) -> Self {
                match &law.kind {
                    $(Kind::$name(law) => Self::$name(law.series(velocity_unit))),*
                }
            }

            /// Restarts at `speed`, whatever the speed was before.
            pub(crate) fn restart(&mut self, speed: f64) {
                match self {
                    $(Self::$name(series) => series.restart(speed)),*
                }
            }

            /// See [`Series::resolved`].
            pub(crate) fn resolved(&self, speed: &[f64], length: f64, error: f64) -> f64 {
                match self {
                    $(Self::$name(series) => series.resolved(speed, length, error)),*
                }
            }

            /// Takes over the place of `other`, the series of the same law.
            pub(crate) fn copy_place(&mut self, other: &Self) {
                match (self, other) {
                    $((Self::$name(series), Self::$name(other)) => series.copy_place(other),)*
                    _ => {}
                }
            }
        }

        /// The forms of all laws that parameters alone describe; that with a state is the last.
        const FORMS: &[Option<&Form>] =
            &[$(<$law as Law>::FORM,)* Some(&hyperbolic::FORM), Some(&RateAndState::FORM)];

        /// Evaluates an expression with the law behind a [`Kind`].
        macro_rules! with_law {
            ($d kind:expr, $d law:ident => $d body:expr) => {
                match $d kind {
                    $(Kind::$name($d law) => $d body),*
                }
            };
        }

        /// Evaluates an expression with the series behind a [`FrictionSeries`].
        macro_rules! with_series {
            ($d series:expr, $d of:ident => $d body:expr) => {
                match $d series {
                    $($crate::model::law::FrictionSeries::$name($d of) => $d body),*
                }
            };
        }
        pub(crate) use with_series;
    };
}

laws! {
    $
    Coulomb: Coulomb,
    Weakening: Weakening,
    Stribeck: Stribeck,
    Table: Table,
    Formula: ByFormula,
}

/// A law of kinetic friction together with the static coefficient μ_S that goes with it.
///
/// Every law is a function of the sliding speed |ẋ| > 0; the force points against the motion.
/// A law with μ_K(0⁺) > μ_S is refused: release from stick would accelerate backwards.
///
/// ```
/// use slipmap::model::FrictionLaw;
///
/// // μ_K = 0.5/(1 + |ẋ|/0.5) and μ_S = 1.
/// let law = FrictionLaw::weakening(0.5, 0.5, 1.0)?;
/// assert_eq!((law.mu_k(0.5), law.mu_prime(0.5)), (0.25, -0.25));
/// # Ok::<(), slipmap::model::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionLaw {
    kind: Kind,
    mu_s: f64,
}

impl Form {
    /// All forms, in the order of lists.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        FORMS.iter().copied().flatten()
    }
}

impl FrictionLaw {
    fn new(kind: Kind, mu_s: f64) -> Self {
        Self { kind, mu_s }
    }

    /// The form of the law and its parameters.
    #[must_use]
    pub fn kind(&self) -> &Kind {
        &self.kind
    }

    /// μ_S.
    #[must_use]
    pub fn mu_s(&self) -> f64 {
        self.mu_s
    }

    /// μ_K(v), dimensionless, at the sliding speed `speed` ≥ 0 (at 0: the limit 0⁺).
    #[must_use]
    pub fn mu_k(&self, speed: f64) -> f64 {
        with_law!(&self.kind, law => Law::mu_k(law, speed))
    }

    /// μ_K′(v), time/length, at the sliding speed `speed` ≥ 0 (at 0: the limit 0⁺, the slope at
    /// rest).
    #[must_use]
    pub fn mu_prime(&self, speed: f64) -> f64 {
        with_law!(&self.kind, law => Law::mu_prime(law, speed))
    }

    /// The change of speed over which μ_K changes its form, length/time, at the sliding speed
    /// `speed` ≥ 0. Steps of a method that knows the law only by its values have to be short
    /// against it. Infinite for Coulomb's law, and for a table, where steps end at the ends of its
    /// cubics.
    #[must_use]
    pub fn speed_scale(&self, speed: f64) -> f64 {
        with_law!(&self.kind, law => Law::speed_scale(law, speed))
    }

    /// The speed, 0 or below, from which on the law can be evaluated: a method that tries speeds a
    /// little below 0 goes on from there.
    #[must_use]
    pub fn least_speed(&self) -> f64 {
        with_law!(&self.kind, law => Law::least_speed(law))
    }

    /// The last speed that was measured; none where the law holds at all speeds.
    #[must_use]
    pub fn last_speed(&self) -> Option<f64> {
        with_law!(&self.kind, law => Law::last_speed(law))
    }

    /// Bounds of μ_K′, time/length, over speeds from `from` to `to`, 0 ≤ `from` ≤ `to`.
    #[must_use]
    pub fn slopes_between(&self, from: f64, to: f64) -> (f64, f64) {
        with_law!(&self.kind, law => Law::slopes_between(law, from, to))
    }

    /// Bounds of μ_K″, (time/length)², over speeds from `from` to `to`, 0 ≤ `from` ≤ `to`; infinite
    /// where the slope jumps, at the ends of a table.
    #[must_use]
    pub fn curvatures_between(&self, from: f64, to: f64) -> (f64, f64) {
        with_law!(&self.kind, law => Law::curvatures_between(law, from, to))
    }
}

/// A generous bound of the rounding of the values computed here, relative to their largest term.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The range of some values, widened by rounding.
fn hull(values: impl IntoIterator<Item = f64>) -> Range {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let range = values
        .into_iter()
        .fold(none, |(low, high), v| (low.min(v), high.max(v)));
    let rounding = ROUNDING * range.0.abs().max(range.1.abs());
    (range.0 - rounding, range.1 + rounding)
}

fn checked_coefficients(mu0: f64, mu_s: f64) -> Result<(f64, f64), ModelError> {
    let mu_s = ModelError::positive("mu_s", mu_s)?;
    let mu0 = ModelError::positive("mu0", mu0)?;
    checked_at_rest("mu0", mu0, mu_s)?;
    Ok((mu0, mu_s))
}

/// μ_K(0⁺) ≤ μ_S.
fn checked_at_rest(parameter: &'static str, at_rest: f64, mu_s: f64) -> Result<(), ModelError> {
    ModelError::check(parameter, at_rest, AT_MOST_MU_S, at_rest <= mu_s).map(|_| ())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::formula::{Builder, Node, Operand};
    use super::*;
    use crate::model::elementary;
    use crate::model::series::{MOST_ORDER, value};

    fn laws() -> [FrictionLaw; 8] {
        laws_and(Table::new(vec![0.0, 0.25, 1.5, 3.0], vec![0.8, 0.4, 0.5, 0.6]).unwrap())
    }

    /// All laws, that of the table first.
    fn laws_and(table: Table) -> [FrictionLaw; 8] {
        [
            FrictionLaw::table(table, 1.0).unwrap(),
            FrictionLaw::coulomb(0.4, 1.0).unwrap(),
            FrictionLaw::weakening(0.5, 0.7, 1.0).unwrap(),
            FrictionLaw::stribeck(0.3, 0.2, 0.9).unwrap(),
            FrictionLaw::stribeck_with(0.3, 0.5, 0.9, (1.5, 0.02)).unwrap(),
            FrictionLaw::stribeck_with(0.3, 0.4, 0.9, (1.0, 0.0)).unwrap(),
            FrictionLaw::hyperbolic(0.3, 0.4, 0.9, 0.01).unwrap(),
            every_function(),
        ]
    }

    /// A formula of every kind of node.
    fn every_function() -> FrictionLaw {
        let mut make = Builder::default();
        let v = make.speed();
        let one = Operand::Number(1.0);
        let above = make.sum(v, one);
        let ln = make.function(above, elementary::ln, Node::Ln);
        let tanh = make.function(v, elementary::tanh, Node::Tanh);
        let atan = make.function(v, elementary::atan, Node::Atan);
        let sin = make.function(tanh, elementary::sin, Node::Sin);
        let cos = make.function(atan, elementary::cos, Node::Cos);
        let sinh = make.function(tanh, elementary::sinh, Node::Sinh);
        let cosh = make.function(tanh, elementary::cosh, Node::Cosh);
        let root = make.power(above, Operand::Number(-0.5));
        let quotient = make.quotient(sinh, cosh);
        let difference = make.difference(sin, quotient);
        let product = make.product(cos, root);
        let whole =
            [ln, product, difference]
                .into_iter()
                .fold(Operand::Number(0.5), |sum, term| {
                    let term = make.product(Operand::Number(0.1), term);
                    make.sum(sum, term)
                });
        FrictionLaw::formula(make.finish(whole).unwrap(), 1.0).unwrap()
    }

    #[test]
    fn slopes_are_the_derivatives_of_the_values() {
        for law in laws() {
            for v in [0.01, 0.1, 0.35, 1.0, 4.0] {
                let h = 1e-5 * v;
                let numeric = (law.mu_k(v + h) - law.mu_k(v - h)) / (2.0 * h);
                assert!(
                    (numeric - law.mu_prime(v)).abs() < 1e-8,
                    "{law:?} at {v}: {numeric}"
                );
            }
        }
    }

    /// Over a quarter of its scale of speed every law is nearly a cubic: fourth differences are
    /// small.
    #[test]
    fn a_law_is_smooth_over_its_scale_of_speed() {
        for law in laws().into_iter().skip(1) {
            for v in [0.0, 0.05, 0.35, 1.0, 1.3, 4.0] {
                let h = 0.25 * law.speed_scale(v).min(1.0) / 4.0;
                let at = |i: f64| law.mu_k(v + i * h);
                let fourth = at(0.0) - 4.0 * at(1.0) + 6.0 * at(2.0) - 4.0 * at(3.0) + at(4.0);
                assert!(fourth.abs() < 1e-3, "{law:?} at {v}: {fourth}");
            }
        }
    }

    #[test]
    fn limits_at_rest_and_at_high_speed() {
        let [table, coulomb, weakening, stribeck, ..] = laws();
        assert_eq!((table.mu_k(0.0), table.mu_k(10.0)), (0.8, 0.6));
        assert!(table.mu_prime(0.0) < 0.0 && table.mu_prime(10.0) == 0.0);
        assert_eq!(coulomb.mu_k(0.0), 0.4);
        assert_eq!(weakening.mu_k(0.0), 0.5);
        assert_eq!(weakening.mu_prime(0.0), -0.5 / 0.7);
        assert!((stribeck.mu_k(0.0) - 0.9).abs() < 1e-15);
        assert_eq!(stribeck.mu_prime(0.0), 0.0);
        assert!((stribeck.mu_k(10.0) - 0.3).abs() < 1e-15);
    }

    #[test]
    fn ill_posed_laws_are_refused_by_name() {
        let error = FrictionLaw::weakening(1.2, 0.5, 1.0).unwrap_err();
        assert_eq!(error.parameter, "mu0");
        assert_eq!(
            FrictionLaw::stribeck(0.3, 0.0, 1.0).unwrap_err().parameter,
            "v_s"
        );
        assert_eq!(
            FrictionLaw::coulomb(f64::NAN, 1.0).unwrap_err().parameter,
            "mu0"
        );
        assert_eq!(
            FrictionLaw::coulomb(0.5, -1.0).unwrap_err().parameter,
            "mu_s"
        );
        let table = Table::new(vec![0.1, 1.0], vec![0.8, 0.4]).unwrap();
        let error = FrictionLaw::table(table, 0.7).unwrap_err();
        assert_eq!((error.parameter, error.value), ("mu_k", 0.8));
    }

    #[test]
    fn the_series_is_the_law_along_a_motion() {
        let mut load = [0.0; MOST_ORDER + 1];
        (load[0], load[1]) = (1.0, -0.5);
        // Speed 0.3 + 0.2 s − 0.1 s², in units of 2.
        let speed = [0.15, 0.1, -0.05];
        for law in laws() {
            let mut coefficients = [0.0; MOST_ORDER + 1];
            let mut series = FrictionSeries::new(&law, 2.0);
            series.restart(0.15);
            for (k, c) in coefficients.iter_mut().enumerate() {
                let speed = speed.get(k).copied().unwrap_or(0.0);
                *c = with_series!(&mut series, of => of.extend(k, speed, &load));
            }
            for s in [0.0, 0.05, 0.1] {
                let exact = law.mu_k(0.3 + 0.2 * s - 0.1 * s * s) * (1.0 - 0.5 * s);
                assert!(
                    (value(&coefficients, s) - exact).abs() < 1e-13,
                    "{law:?} {s}"
                );
            }
        }
    }

    fn laws_of_ranges() -> [FrictionLaw; 8] {
        let speeds = vec![0.1, 0.3, 0.9, 1.5, 3.0];
        laws_and(Table::new(speeds, vec![0.8, 0.4, 0.35, 0.5, 0.6]).unwrap())
    }

    proptest! {
        /// Slopes at all speeds between two lie within the bounds, and difference quotients of
        /// slopes within those of the curvature.
        #[test]
        fn slopes_and_their_changes_lie_within(from in 0.0..3.5, width in 1e-6..2.0,
                                               parts in prop::array::uniform2(0.0..1.0)) {
            let to = from + width;
            let [v, w] = parts.map(|part: f64| from + part * width);
            for law in laws_of_ranges() {
                let (low, high) = law.slopes_between(from, to);
                let slope = law.mu_prime(v);
                prop_assert!(low <= slope && slope <= high, "{law:?} {v}: {low} {slope} {high}");
                let (least, most) = law.curvatures_between(from, to);
                let change = law.mu_prime(w) - slope;
                let (one, other) = (least * (w - v), most * (w - v));
                let near = 1e-13;
                prop_assert!(v == w || least.is_infinite()
                    || (one.min(other) - near <= change && change <= one.max(other) + near),
                    "{law:?} {v} {w}: {least} {change} {most}");
            }
        }

        /// The bounds are attained, to the resolution of the samples.
        #[test]
        fn bounds_are_no_wider_than_needed(from in 0.0..3.5, width in 1e-3..2.0) {
            for law in laws_of_ranges() {
                let (low, high) = law.slopes_between(from, from + width);
                let slopes = (0..=2000).map(|i| law.mu_prime(from + width * f64::from(i) / 2000.0));
                let (least, most) = hull(slopes);
                // A jump at an end of the table can lie between two samples; intervals of formulas
                // are wider than needed by a share of their parts.
                let allowed = match law.kind() {
                    Kind::Table(_) => f64::INFINITY,
                    Kind::Formula(_) => 0.2 * least.abs().max(most.abs()) + 0.02,
                    _ => 2e-2 * (most - least) + 1e-9,
                };
                prop_assert!(low > least - allowed, "{law:?} {low} {least}");
                prop_assert!(high < most + allowed, "{law:?} {high} {most}");
            }
        }
    }
}
