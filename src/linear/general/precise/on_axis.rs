//! |P|² − |Q|² and the phase of −Q/P on the imaginary axis, with many digits.
//!
//! ```text
//! F = |P|² − |Q|² = c Re(U V*),   U = P − Q,   c V = P + Q                                    (1)
//! −4 P* Q = |U|² − c²|V|² + 2i c Im(U V*)                                                    (2)
//!
//! P and Q themselves           U = P − Q                      V = P + Q                c = 1
//! feedback                     U = (1 + R) B − 2A e^(−λδ)     V = B                    c = 1 − R
//! feedback along the latency   U = B + A − (A + R B) E        V = B − A + (A − R B) E  c = 1
//! ```
//!
//! Near a resonance V is small: nothing is subtracted there but what V itself is made of.

use std::array::from_fn;

use super::super::parts::FeedbackForm;
use super::super::system::System;
use super::number::{Number, UNIT};
use super::polynomial::{BOUNDS, Complex, Jet, Precise};
use super::turn::sine_and_cosine;

const BINOMIALS: [[f64; BOUNDS]; BOUNDS] = [
    [1.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0],
    [1.0, 3.0, 3.0, 1.0],
];

/// U and V.
pub(super) struct OnAxis {
    u: Swinging,
    v: Swinging,
    /// c.
    kept: Number,
}

/// X + Y e^(−λt).
struct Swinging {
    x: Precise,
    y: Precise,
    t: f64,
}

/// U and V at one frequency with derivatives, and bounds on the errors of the values and of the
/// first derivatives.
pub(super) struct At {
    u: Jet,
    v: Jet,
    u_errors: [f64; 2],
    v_errors: [f64; 2],
    kept: Number,
}

/// A number with a bound on its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    pub value: f64,
    pub error: f64,
}

impl Known {
    pub(super) fn decided(self) -> bool {
        self.value.abs() > self.error
    }
}

impl Swinging {
    fn new([x, y]: [Precise; 2], t: f64) -> Self {
        match t {
            0.0 => Self::still(x.plus(&y)),
            _ => Self { x, y, t },
        }
    }

    fn still(x: Precise) -> Self {
        Self {
            x,
            y: Precise::ZERO,
            t: 0.0,
        }
    }

    /// The value at iω with derivatives by ω, and bounds on the errors of the first two of them;
    /// none for extreme angles ωt.
    fn at(&self, omega: Number) -> Option<(Jet, [f64; 2])> {
        let size = omega.value();
        let (jet, errors) = (self.x.jet(omega), self.x.errors_at(size));
        if self.t == 0.0 {
            return Some((jet, errors));
        }
        let late = self.late(self.y.jet(omega), omega)?;
        let [value, slope] = self.y.errors_at(size);
        let rounding = 8.0 * UNIT * (1.0 + size * self.t);
        let [y, y_slope, ..] = self.y.bounds(size);
        let jet = from_fn(|order| jet[order] + late[order]);
        let more = [
            value + rounding * y,
            slope + value * self.t + rounding * (y_slope + y * self.t),
        ];
        Some((jet, from_fn(|order| errors[order] + more[order])))
    }

    /// Y e^(−iωt) from Y.
    fn late(&self, [value, slope, bend]: Jet, omega: Number) -> Option<Jet> {
        let t = Number::of(self.t);
        let [sine, cosine] = sine_and_cosine(omega * t)?;
        let by = Complex {
            re: cosine,
            im: -sine,
        };
        let back = |of: Complex| of.turned_back().scaled(t);
        let (once, twice) = (back(value), back(back(value)).scaled(Number::of(0.5)));
        Some([value, slope + once, bend + back(slope) + twice].map(|of| of * by))
    }

    /// Bounds on the size of the value and of its first three derivatives up to `omega`.
    fn bounds(&self, omega: f64) -> [f64; BOUNDS] {
        let (x, y, t) = (self.x.bounds(omega), self.y.bounds(omega), self.t);
        let powers = [1.0, t, t * t, t * t * t];
        from_fn(|order| {
            let late = (0..=order).map(|i| BINOMIALS[order][i] * y[i] * powers[order - i]);
            x[order] + late.sum::<f64>()
        })
    }
}

impl OnAxis {
    /// For delays: the line of `system`.
    pub(super) fn of_delays(system: &System) -> Self {
        let Some(feedback) = system.feedback_form() else {
            let [p, q] = [&system.p, &system.q].map(Precise::of);
            return Self {
                u: Swinging::still(p.minus(&q)),
                v: Swinging::still(p.plus(&q)),
                kept: Number::ONE,
            };
        };
        let [b, a] = open_and_gain(system, feedback);
        let memory = Number::of(feedback.channel.memory);
        let parts = [b.scaled(Number::ONE + memory), a.scaled(Number::of(-2.0))];
        Self {
            u: Swinging::new(parts, feedback.channel.latency),
            v: Swinging::still(b),
            kept: Number::ONE - memory,
        }
    }

    /// For latencies at the delay `tau`; none where `system` is not in feedback form.
    pub(super) fn of_latencies(system: &System, tau: f64) -> Option<Self> {
        let feedback = system.feedback_form()?;
        let [b, a] = open_and_gain(system, feedback);
        let remembered = b.scaled(Number::of(-feedback.channel.memory));
        Some(Self {
            u: Swinging::new([b.plus(&a), remembered.minus(&a)], tau),
            v: Swinging::new([b.minus(&a), remembered.plus(&a)], tau),
            kept: Number::ONE,
        })
    }

    /// U and V at `omega` > 0; none for extreme angles.
    pub(super) fn at(&self, omega: Number) -> Option<At> {
        let ((u, u_errors), (v, v_errors)) = (self.u.at(omega)?, self.v.at(omega)?);
        Some(At {
            u,
            v,
            u_errors,
            v_errors,
            kept: self.kept,
        })
    }

    /// A bound on |d³ Re(U V*)/dω³| up to `omega`.
    pub(super) fn third(&self, omega: f64) -> f64 {
        let (u, v) = (self.u.bounds(omega), self.v.bounds(omega));
        (0..BOUNDS).map(|i| BINOMIALS[3][i] * u[i] * v[3 - i]).sum()
    }
}

/// B and A.
fn open_and_gain(system: &System, feedback: &FeedbackForm) -> [Precise; 2] {
    match system.source {
        Some(source) => source.polynomials(),
        None => [&feedback.open, &feedback.gain].map(Precise::of),
    }
}

impl At {
    /// Re(U V*), which has the sign and the zeros of F.
    pub(super) fn modulus(&self) -> Known {
        let ([u, ..], [v, ..]) = (self.u, self.v);
        Known {
            value: u.along(v).value(),
            error: self.product_error(),
        }
    }

    /// Its derivative by ω.
    pub(super) fn slope(&self) -> Known {
        let ([u, u_slope, _], [v, v_slope, _]) = (self.u, self.v);
        let ([u_error, u_slope_error], [v_error, v_slope_error]) = (self.u_errors, self.v_errors);
        let error = u_slope_error * (v.size() + v_error)
            + u_slope.size() * v_error
            + u_error * (v_slope.size() + v_slope_error)
            + u.size() * v_slope_error;
        Known {
            value: (u_slope.along(v) + u.along(v_slope)).value(),
            error: 2.0 * error,
        }
    }

    /// Half its second derivative.
    pub(super) fn bend(&self) -> f64 {
        let ([u, u_slope, u_bend], [v, v_slope, v_bend]) = (self.u, self.v);
        (u_bend.along(v) + u_slope.along(v_slope) + u.along(v_bend)).value()
    }

    /// A bound on |U V*|.
    pub(super) fn size(&self) -> f64 {
        self.u[0].size() * self.v[0].size()
    }

    /// A bound on the error of U V*.
    fn product_error(&self) -> f64 {
        let (u, v) = (self.u[0].size(), self.v[0].size());
        let (u_error, v_error) = (self.u_errors[0], self.v_errors[0]);
        2.0 * (u * v_error + v * u_error + u_error * v_error + 8.0 * UNIT * u * v)
    }

    /// The real and the imaginary part of (2) where the frequency is known to within `moved`.
    pub(super) fn turned(&self, moved: f64) -> [Known; 2] {
        let ([u, u_slope, _], [v, v_slope, _]) = (self.u, self.v);
        let kept = self.kept;
        let across = (u.across(v) * kept).times(2.0);
        let squares = u.along(u) - v.along(v) * kept * kept;
        let kept = kept.value().abs();
        let drift = moved * (u_slope.size() * v.size() + u.size() * v_slope.size());
        let own = |of: Complex, error: f64, slope: Complex| {
            let (size, error) = (of.size(), error + moved * slope.size());
            2.0 * (2.0 * size * error + error * error) + 8.0 * UNIT * size * size
        };
        [
            Known {
                value: squares.value(),
                error: own(u, self.u_errors[0], u_slope)
                    + kept * kept * own(v, self.v_errors[0], v_slope),
            },
            Known {
                value: across.value(),
                error: 4.0 * kept * (self.product_error() + drift),
            },
        ]
    }
}
