//! Systems with a root at 0 at every delay that is left out: against closed forms, and against the
//! argument of D/λ along a contour, with the distributed delay as it stands.

use num_complex::Complex64;
use proptest::prelude::*;
use slipmap::linear::MarginalTolerance;
use slipmap::linear::general::{DelayLine, RightOf, RootCounter, System};
use slipmap::linear::line::Linear;
use slipmap::model::stop::Stop;
use std::f64::consts::PI;

/// s² + a s + b + (c s − b) e^(−sτ), which is s times `divided`.
#[derive(Debug, Clone, Copy)]
struct Distributed {
    a: f64,
    b: f64,
    c: f64,
}

impl Distributed {
    fn system(self) -> System {
        let Self { a, b, c } = self;
        let all = System::of_coefficients(&[b, a, 1.0], &[-b, c]).unwrap();
        all.without_roots_at_zero(1).unwrap()
    }

    /// s + a + c e^(−sτ) + b ∫ e^(−sθ) dθ from 0 to τ, the integral by Gauss's rule of ten points
    /// where its closed form cancels.
    fn divided(self, tau: f64, s: Complex64) -> Complex64 {
        let late = (-s * tau).exp();
        let integral = if s.norm() * tau > 1.0 {
            (1.0 - late) / s
        } else {
            let half = 0.5 * tau;
            let points = GAUSS.into_iter().flat_map(|(at, weight)| {
                [at, -at].map(|at| half * weight * (-s * half * (1.0 + at)).exp())
            });
            points.sum()
        };
        s + self.a + self.c * late + self.b * integral
    }

    /// The zeros of `divided` right of Re s = `line`, by its argument around a half disc; none where
    /// the contour comes too near to one.
    fn right_of(self, tau: f64, line: f64) -> Option<i64> {
        const STEPS: u32 = 6000;
        // Beyond this |s| outweighs all else right of the line.
        let growth = (-line.min(0.0) * tau).exp();
        let radius = 2.0 + self.a.abs() + growth * (self.c.abs() + self.b.abs() * tau);
        let up = |part: f64| Complex64::new(line, radius * (1.0 - 2.0 * part));
        let around = |part: f64| line + Complex64::from_polar(radius, PI * (part - 0.5));
        let part = |i: u32| f64::from(i) / f64::from(STEPS);
        let points = (0..STEPS)
            .map(|i| around(part(i)))
            .chain((0..=STEPS).map(|i| up(part(i))));
        let values: Vec<Complex64> = points.map(|s| self.divided(tau, s)).collect();
        let mut turned = 0.0;
        for pair in values.windows(2) {
            let by = (pair[1] / pair[0]).arg();
            if by.abs() > 0.8 {
                return None;
            }
            turned += by;
        }
        Some((turned / (2.0 * PI)).round() as i64)
    }
}

/// Half of the points and weights of Gauss's rule with ten points.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// s + k (1 − e^(−sτ))/s: a pair ±i√(2k) crosses at every odd multiple of π/√(2k), and never back.
#[test]
fn the_crossings_of_a_distributed_delay_are_those_of_its_closed_form() {
    for k in [0.3, 2.0, 7.5e4] {
        let of = Distributed {
            a: 0.0,
            b: k,
            c: 0.0,
        };
        let line = DelayLine::of(&of.system());
        let period = PI / (2.0 * k).sqrt();
        let stable: Vec<_> = line.stable_intervals().collect();
        assert_eq!((stable.len(), line.reason), (1, None));
        assert!((stable[0].to / period - 1.0).abs() < 1e-12 && stable[0].from == 0.0);
        for (tau, n) in [(0.5, 0), (1.5, 2), (2.9, 2), (3.1, 4), (8.0, 8)] {
            let count = line.count(tau * period, MarginalTolerance::default());
            assert_eq!((count.n_unstable, count.marginal), (n, false), "{k} {tau}");
        }
        // Without delay the integral vanishes, and s = 0 is a root of the system itself.
        assert!(line.marginal(0.0, MarginalTolerance::default()));
    }
}

/// A real root passes 0 at τ = −(a + c)/b, and the others are counted as ever.
#[test]
fn a_real_root_passes_zero_where_the_slope_there_vanishes() {
    let of = Distributed {
        a: 1.0,
        b: -0.5,
        c: 0.2,
    };
    let line = DelayLine::of(&of.system());
    let first = line.stable_intervals().next().unwrap();
    assert!((first.to - 2.4).abs() < 1e-12, "{}", first.to);
    for (tau, n) in [(2.3, 0), (2.5, 1)] {
        assert_eq!(of.right_of(tau, 0.0), Some(n));
        assert_eq!(line.n_unstable(tau), n as u64);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn counts_and_roots_are_those_of_the_argument(
        (a, b, c) in (-2.0..2.0_f64, -3.0..3.0_f64, -2.0..2.0_f64),
        tau in 0.05..4.0_f64,
    ) {
        let of = Distributed { a, b, c };
        prop_assume!(b.abs() > 0.05);
        let system = of.system();
        let counter = RootCounter::new(&system);
        for line in [-0.4, -0.05, 0.0, 0.3] {
            let Some(expected) = of.right_of(tau, line) else { continue };
            let found = counter.right_of(tau, line);
            prop_assert_eq!(found, RightOf::Roots(expected as u64), "{}", line);
            if line == 0.0 {
                let counted = DelayLine::of(&system).count(tau, MarginalTolerance::default());
                prop_assert_eq!(counted.n_unstable as i64, expected);
                prop_assert!(!counted.marginal);
                let by_turning = counter.unstable().and_then(|of| of.at(tau));
                prop_assert_eq!(by_turning, Some(expected as u64));
            }
        }
        let linear = Linear::General(Box::new(system));
        let found = linear.roots(&Stop::default()).spectrum(tau, 2);
        prop_assert!(found.certified, "{:?}", found);
        for root in &found.roots {
            let rest = of.divided(tau, root.lambda).norm();
            prop_assert!(rest < 1e-9 * (1.0 + root.lambda.norm()), "{} {}", root.lambda, rest);
        }
        let above = of.right_of(tau, found.abscissa + 1e-3);
        prop_assert!(above.is_none_or(|n| n == 0));
        let below = of.right_of(tau, found.abscissa - 1e-3);
        prop_assert!(below.is_none_or(|n| n > 0));
    }
}
