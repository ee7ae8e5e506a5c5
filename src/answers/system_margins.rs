//! Margins of a system from a file, in its own units.

use crate::linear::MarginalTolerance;
use crate::linear::line::{Line, Linear};
use crate::linear::margins::{
    GainMargin, Limits, MarginSearch, Modulus, PhaseMargin, SystemLoop, omega_at,
};
use crate::linear::stable_delays::StableInterval;
use crate::model::stop::Stop;
use crate::setting::no_answer::NoAnswer;
use crate::setting::parameter::Parameter;
use crate::setting::values::Setting;

/// A system from a file at one setting, as a loop whose margins are asked for.
pub struct SystemMargins {
    /// All delays.
    line: Box<dyn Line>,
    /// Whether they are those of the system: P and Q do not depend on the delay.
    of_delays: bool,
    tau: f64,
    /// The loop; none of matrices, and where a root at 0 is left out.
    of_loop: Option<SystemLoop>,
    stable: bool,
}

impl SystemMargins {
    /// The margins of a system from a file; none of any other setting. Once `stop` is set, they are
    /// told soon, and mean nothing.
    ///
    /// # Errors
    /// When an expression has no value, or the system is not answered.
    pub fn of(setting: &Setting, stop: &Stop) -> Result<Option<Self>, NoAnswer> {
        if setting.system().is_none() {
            return Ok(None);
        }
        let (linear, _) = setting.answered()?;
        let linear = linear.settled();
        let tau = setting.get(Parameter::Tau);
        let line = linear.roots(stop).line(1.0);
        let count = line.count(tau, MarginalTolerance::default());
        let of_loop = match &linear {
            Linear::General(system) => SystemLoop::new(system, tau),
            _ => None,
        };
        Ok(Some(Self {
            line,
            of_delays: setting.has_lines(),
            tau,
            of_loop: of_loop.map(|of| of.heeding(stop)),
            stable: count.is_some_and(|count| count.stable()),
        }))
    }

    /// Whether the system is stable, beyond doubt.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.stable
    }

    /// Whether the system is given by P and Q, or B and A: then all of its margins are known.
    #[must_use]
    pub fn is_loop(&self) -> bool {
        self.of_loop.is_some()
    }

    /// How many times as large gains are looked at where no loss is found; infinite where all are,
    /// NaN of matrices.
    #[must_use]
    pub fn most_gains(&self) -> f64 {
        self.of_loop
            .as_ref()
            .map_or(f64::NAN, SystemLoop::most_gains)
    }

    /// The factors of what is fed back at which stability is lost.
    pub fn gain(&self, search: &mut MarginSearch) -> GainMargin {
        match &self.of_loop {
            Some(of) => search.gain_margin(of),
            None => GainMargin::UNKNOWN,
        }
    }

    /// The phase margin. Of matrices it is that of turning all that is late.
    #[must_use]
    pub fn phase(&self) -> PhaseMargin {
        match &self.of_loop {
            Some(of) => of.phase(),
            None if !self.line.crossings_known() => PhaseMargin::UNKNOWN,
            None => PhaseMargin::of(self.line.crossings(), self.tau),
        }
    }

    /// The latency margin with ω of the crossing there: of B and A the largest latency, counted
    /// from none; else the largest further delay.
    #[must_use]
    pub fn latency(&self) -> (f64, f64) {
        if let Some(of) = &self.of_loop {
            return of.latency();
        }
        let (limits, [_, omega]) = self.around();
        (limits.upper - self.tau, omega)
    }

    /// How near the loop comes to −1.
    #[must_use]
    pub fn modulus(&self) -> Modulus {
        self.of_loop
            .as_ref()
            .map_or(Modulus::UNKNOWN, SystemLoop::modulus)
    }

    /// The delays at which stability is lost, with ω of the crossings there; NaN where the system
    /// is another one at other delays.
    #[must_use]
    pub fn delay(&self) -> (Limits, [f64; 2]) {
        match self.of_delays {
            true => self.around(),
            false => (Limits::UNDECIDED, [f64::NAN; 2]),
        }
    }

    /// The stable delays around this one, of the system as it is here.
    fn around(&self) -> (Limits, [f64; 2]) {
        let inside = |found: &StableInterval| found.from <= self.tau && self.tau < found.to;
        let found = self.line.stable_intervals().find(inside);
        let Some(StableInterval { from, to }) = found else {
            return (Limits::UNDECIDED, [f64::NAN; 2]);
        };
        let limits = Limits {
            lower: from,
            upper: to,
        };
        (
            limits,
            [from, to].map(|tau| omega_at(self.line.crossings(), tau)),
        )
    }
}
