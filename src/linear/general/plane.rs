//! A general system over a plane of two of its parameters, the delay among them or not.

use std::cell::RefCell;
use std::f64::consts::PI;

use num_complex::Complex64;

use super::line::DelayLine;
use super::right_of::RootCounter;
use super::system::System;
use super::turning::RightOf;
use crate::linear::curves::{Vertex, Window};
use crate::linear::plane::{Band, CharacteristicValue, Local, Plane};
use crate::model::stop::Stop;

/// Step of the central differences in p and q, over the widths of the window.
const DIFFERENCE: f64 = 1e-6;

/// A system at one point of a plane.
#[derive(Debug, Clone, Copy)]
pub struct SystemSetting {
    /// The system, dimensionless.
    pub system: System,
    /// The delay of the system, in the unit of time of the plane.
    pub tau: f64,
    /// One dimensionless unit of time, in the unit of time of the plane.
    pub unit: f64,
}

impl SystemSetting {
    /// The delay as the system takes it.
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.tau / self.unit
    }
}

/// A system over the window of a plane.
pub struct SystemPlane<'a> {
    /// The setting at (p, q) inside the window; none where no setting belongs to that point.
    setting_at: &'a dyn Fn(f64, f64) -> Option<SystemSetting>,
    window: &'a Window,
    delays: [bool; 2],
    lines: bool,
    stop: Stop,
    last: RefCell<Option<Counted>>,
}

/// The counter of the last question: many questions are about one point, or one line.
struct Counted {
    at: (f64, f64),
    setting: SystemSetting,
    counter: RootCounter,
}

impl<'a> SystemPlane<'a> {
    /// A plane without lines of delays; `delays` says of p and of q whether it is a delay.
    #[must_use]
    pub fn new(
        setting_at: &'a dyn Fn(f64, f64) -> Option<SystemSetting>,
        window: &'a Window,
        delays: [bool; 2],
    ) -> Self {
        Self {
            setting_at,
            window,
            delays,
            lines: false,
            stop: Stop::default(),
            last: RefCell::new(None),
        }
    }

    /// This plane, in which nothing is counted any more once `stop` is set.
    #[must_use]
    pub(crate) fn heeding(self, stop: &Stop) -> Self {
        let stop = stop.clone();
        Self { stop, ..self }
    }

    /// A plane where q is the delay τ and nothing else depends on q: each p is a line of delays.
    #[must_use]
    pub fn of_lines(
        setting_at: &'a dyn Fn(f64, f64) -> Option<SystemSetting>,
        window: &'a Window,
    ) -> Self {
        Self {
            lines: true,
            ..Self::new(setting_at, window, [false, true])
        }
    }

    /// Whether each p is a line of delays.
    #[must_use]
    pub(crate) fn has_lines(&self) -> bool {
        self.lines
    }

    /// The point of the window nearest to (p, q).
    fn clamped(&self, p: f64, q: f64) -> (f64, f64) {
        let window = self.window;
        (
            p.clamp(*window.p.start(), *window.p.end()),
            q.clamp(*window.q.start(), *window.q.end()),
        )
    }

    /// The setting at a point, or at the nearest one of the window; along a line beyond its ends,
    /// too.
    pub fn setting(&self, p: f64, q: f64) -> Option<SystemSetting> {
        let (p, inside) = self.clamped(p, q);
        let setting = (self.setting_at)(p, inside)?;
        Some(match self.lines {
            true => SystemSetting {
                tau: q.max(0.0),
                ..setting
            },
            false => setting,
        })
    }

    /// What `of` says of the roots at (p, q); none once the plane is stopped.
    fn counted<T>(
        &self,
        p: f64,
        q: f64,
        of: impl FnOnce(&RootCounter, SystemSetting) -> T,
    ) -> Option<T> {
        if self.stop.is_set() {
            return None;
        }
        let (p, inside) = self.clamped(p, q);
        // Along a line only the delay changes.
        let at = (p, if self.lines { 0.0 } else { inside });
        let mut last = self.last.borrow_mut();
        if last.as_ref().is_none_or(|l| l.at != at) {
            let setting = (self.setting_at)(p, inside)?;
            let counter = RootCounter::new(&setting.system);
            *last = Some(Counted {
                at,
                setting,
                counter,
            });
        }
        let Counted {
            setting, counter, ..
        } = last.as_ref()?;
        let mut setting = *setting;
        if self.lines {
            setting.tau = q.max(0.0);
        }
        Some(of(counter, setting))
    }

    /// The number of roots right of the line, where that is known.
    #[must_use]
    pub fn count(&self, p: f64, q: f64, sigma: f64, beside: f64) -> RightOf {
        let right_of = |counter: &RootCounter, setting: SystemSetting| {
            counter.right_of(setting.delay(), -sigma * setting.unit + beside)
        };
        self.counted(p, q, right_of).unwrap_or(RightOf::Undecided)
    }

    /// The largest degree of P and Q on a coarse grid.
    pub(super) fn largest_degree(&self) -> usize {
        let part = |i: u32, range: &std::ops::RangeInclusive<f64>| {
            range.start() + (range.end() - range.start()) * f64::from(i) / 8.0
        };
        let places = (0..=8).flat_map(|i| (0..=8).map(move |j| (i, j)));
        let degrees = places.filter_map(|(i, j)| {
            let (p, q) = (part(i, &self.window.p), part(j, &self.window.q));
            let System { p, q, .. } = self.setting(p, q)?.system;
            Some(p.degree().max(q.degree()))
        });
        degrees.max().unwrap_or(0)
    }

    /// The line of delays at `p`, in the unit of time of the plane.
    pub(super) fn line(&self, p: f64) -> Option<(DelayLine, f64)> {
        let setting = self.setting(p, *self.window.q.start())?;
        Some((DelayLine::of(&setting.system), setting.unit))
    }

    fn derivatives(&self, (p, q): (f64, f64), lambda: Complex64) -> [Complex64; 2] {
        let (window, value) = (self.window, |p, q| self.at(p, q, lambda).value);
        let across = |x: f64, width: f64, (from, to): (f64, f64)| {
            let h = DIFFERENCE * width;
            ((x - h).max(from), (x + h).min(to))
        };
        let ends = |range: &std::ops::RangeInclusive<f64>| (*range.start(), *range.end());
        let (low, high) = across(p, window.p_width(), ends(&window.p));
        let by_p = (value(high, q) - value(low, q)) / (high - low).max(f64::MIN_POSITIVE);
        let (low, high) = across(q, window.q_width(), ends(&window.q));
        let by_q = (value(p, high) - value(p, low)) / (high - low).max(f64::MIN_POSITIVE);
        [by_p, by_q]
    }
}

impl Plane for SystemPlane<'_> {
    fn window(&self) -> &Window {
        self.window
    }

    fn unit(&self, p: f64, q: f64) -> f64 {
        self.setting(p, q).map_or(1.0, |s| s.unit)
    }

    fn delay(&self, p: f64, q: f64) -> f64 {
        self.setting(p, q)
            .map_or(0.0, |s| s.tau + s.system.latency() * s.unit)
    }

    fn delays(&self) -> [bool; 2] {
        self.delays
    }

    fn at(&self, p: f64, q: f64, lambda: Complex64) -> CharacteristicValue {
        let Some(setting) = self.setting(p, q) else {
            let nothing = Complex64::new(f64::NAN, f64::NAN);
            return CharacteristicValue {
                value: nothing,
                by_lambda: nothing,
                by_lambda_twice: nothing,
                rounding: f64::NAN,
            };
        };
        let (unit, tau) = (setting.unit, setting.delay());
        let lambda = lambda * unit;
        let jet = setting.system.jet(tau, lambda);
        CharacteristicValue {
            value: jet.value,
            by_lambda: jet.first * unit,
            by_lambda_twice: jet.second * (unit * unit),
            rounding: setting.system.rounding(&jet, tau, lambda),
        }
    }

    fn local(&self, v: Vertex, sigma: f64) -> Local {
        let lambda = Complex64::new(-sigma, v.omega);
        let here = self.clamped(v.p, v.q);
        let at = self.at(here.0, here.1, lambda);
        let [by_p, by_q] = self.derivatives(here, lambda);
        Local {
            value: at.value + by_p * (v.p - here.0) + by_q * (v.q - here.1),
            by_lambda: at.by_lambda,
            by_lambda_twice: at.by_lambda_twice,
            by_p,
            by_q,
            rounding: at.rounding,
        }
    }

    fn right_of(&self, p: f64, q: f64, sigma: f64, beside: f64) -> Option<u64> {
        self.count(p, q, sigma, beside).finite()
    }

    fn frequencies(&self, p: f64, q: f64, sigma: f64) -> Vec<f64> {
        let frequencies = |counter: &RootCounter, setting: SystemSetting| {
            let unit = setting.unit;
            let all = counter.frequencies(setting.delay(), -sigma * unit);
            all.into_iter().map(|(omega, _)| omega / unit).collect()
        };
        self.counted(p, q, frequencies).unwrap_or_default()
    }

    /// Some root is right of the line for certain where, by (7) of `right_of` with phases that turn
    /// by at most half a turn for each zero of P and Q, (τ/π) Σ s_jω_j is more than the number of
    /// ω_j, half the degrees, and one each for ν₀ and rounding. The sum is the measure of {|P| <
    /// κ|Q|}. That set, and with it the bound, only grows with τ where P and Q stay as they are.
    fn band(&self, p: f64, q: f64, sigma: f64) -> Band {
        let band = |counter: &RootCounter, setting: SystemSetting| {
            let all = counter.frequencies(setting.delay(), -sigma * setting.unit);
            let below: f64 = all.iter().map(|&(omega, s)| omega * f64::from(s)).sum();
            let degrees = 2.0 * counter.system().p.degree() as f64;
            // A latency turns both by as much again.
            let late: f64 = all.iter().map(|(omega, _)| omega).sum();
            let late = 2.0 * late * counter.system().latency() / PI;
            let needed = all.len() as f64 + 0.5 * degrees + 2.0 + late;
            Band {
                highest: all.first().map_or(0.0, |(omega, _)| omega / setting.unit),
                enough: self.lines && below * setting.delay() / PI > needed,
            }
        };
        self.counted(p, q, band).unwrap_or(Band {
            highest: 0.0,
            enough: false,
        })
    }

    fn stopped(&self) -> bool {
        self.stop.is_set()
    }
}
