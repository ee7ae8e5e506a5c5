//! The letter's characteristic function over a plane (p, τ).

use num_complex::Complex64;

use crate::linear::certificate::roots_right_of;
use crate::linear::characteristic::Jet;
use crate::linear::curves::{Vertex, Window};
use crate::linear::plane::{Band, CharacteristicValue, Local, Plane};
use crate::model::Groups;
use crate::model::elementary::{exp, power};
use crate::model::groups::{feedback, open_loop};
use crate::model::stop::Stop;

/// Step of the central difference in p, over the width of the window.
const DIFFERENCE: f64 = 1e-6;
/// Turns of (ω₊ − ω₋)τ beyond which some root is right of the line, whatever the phases are (see
/// the module).
const TURNS_ENOUGH: f64 = 3.0;

/// Groups over a plane (p, τ).
pub(super) struct LetterPlane<'a> {
    /// Groups and time unit at a value of the parameter inside the window.
    pub groups_at: &'a dyn Fn(f64) -> (Groups, f64),
    pub window: &'a Window,
    pub stop: &'a Stop,
}

impl LetterPlane<'_> {
    /// `p`, or the end of the window beyond which the model may not be valid.
    fn clamped(&self, p: f64) -> f64 {
        p.clamp(*self.window.p.start(), *self.window.p.end())
    }

    fn groups(&self, p: f64) -> (Groups, f64) {
        (self.groups_at)(self.clamped(p))
    }

    fn jet(&self, p: f64, tau: f64, lambda: Complex64) -> (Jet, f64, f64) {
        let (groups, unit) = self.groups(p);
        let lambda = lambda * unit;
        let jet = Jet::at(groups, tau / unit, lambda);
        (jet, jet.rounding(groups, tau / unit, lambda), unit)
    }

    /// The frequencies ω₋ ≤ ω₊ at which a root may lie on the line: the zeros of |P|² − κ²|Q|²,
    /// with D = P + Q e^(−λτ) and κ = e^(στ), a quadratic in ω². |P| < κ|Q| between them; none
    /// where that holds nowhere, ω₋ = 0 where it holds at ω = 0.
    fn between(&self, p: f64, tau: f64, sigma: f64) -> Option<(f64, f64)> {
        let (Groups { b, a_v, a_n }, unit) = self.groups(p);
        let line = -sigma * unit;
        let kappa = exp(sigma * tau);
        let q0 = feedback(a_n, a_v, b + line);
        let c = open_loop(b, line) - q0;
        let damping = 2.0 * line + b - a_v;
        let half = 0.5 * (damping * damping - power(kappa * a_v, 2)) - c;
        let product = (c - kappa * q0) * (c + kappa * q0);
        let root = (half * half - product).sqrt();
        let upper = if half <= 0.0 {
            root - half
        } else {
            -product / (half + root)
        };
        // NaN: no frequency.
        (upper > 0.0).then(|| {
            let lower = (product / upper).max(0.0);
            (lower.sqrt() / unit, upper.sqrt() / unit)
        })
    }
}

impl Plane for LetterPlane<'_> {
    fn window(&self) -> &Window {
        self.window
    }

    fn unit(&self, p: f64, _: f64) -> f64 {
        self.groups(p).1
    }

    fn delay(&self, _: f64, tau: f64) -> f64 {
        tau
    }

    fn delays(&self) -> [bool; 2] {
        [false, true]
    }

    fn at(&self, p: f64, tau: f64, lambda: Complex64) -> CharacteristicValue {
        let (jet, rounding, unit) = self.jet(p, tau, lambda);
        CharacteristicValue {
            value: jet.value,
            by_lambda: jet.first * unit,
            by_lambda_twice: jet.second * (unit * unit),
            rounding,
        }
    }

    fn local(&self, v: Vertex, sigma: f64) -> Local {
        let lambda = Complex64::new(-sigma, v.omega);
        let (jet, rounding, unit) = self.jet(v.p, v.q, lambda);
        let h = DIFFERENCE * self.window.p_width();
        let here = self.clamped(v.p);
        let (below, above) = (self.clamped(here - h), self.clamped(here + h));
        let [low, high] = [below, above].map(|p| self.jet(p, v.q, lambda).0.value);
        let by_p = (high - low) / (above - below).max(f64::MIN_POSITIVE);
        Local {
            value: jet.value + by_p * (v.p - here),
            by_lambda: jet.first * unit,
            by_lambda_twice: jet.second * (unit * unit),
            by_p,
            by_q: -jet.feedback * lambda * jet.delayed,
            rounding,
        }
    }

    fn right_of(&self, p: f64, tau: f64, sigma: f64, beside: f64) -> Option<u64> {
        let (groups, unit) = self.groups(p);
        roots_right_of(groups, tau / unit, -sigma * unit + beside)
    }

    fn frequencies(&self, p: f64, tau: f64, sigma: f64) -> Vec<f64> {
        let between = self.between(p, tau, sigma);
        let both = between.map(|(lower, upper)| [lower, upper]);
        both.into_iter().flatten().collect()
    }

    fn band(&self, p: f64, tau: f64, sigma: f64) -> Band {
        let (lower, upper) = self.between(p, tau, sigma).unwrap_or((0.0, 0.0));
        Band {
            highest: upper,
            enough: (upper - lower) * tau > TURNS_ENOUGH * std::f64::consts::TAU,
        }
    }

    fn stopped(&self) -> bool {
        self.stop.is_set()
    }
}
