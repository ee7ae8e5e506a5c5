//! A system with its start and its input in the form of the room.

use crate::linear::general::{Polynomial, System};
use crate::linear::matrix::{Matrix, MatrixError, MatrixSystem};

/// The most steps of a response.
pub const MOST_STEPS: usize = 10_000_000;

/// Why there is no response.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoResponse {
    /// It would take too many steps.
    #[error("the response would take {steps:e} steps, at most {MOST_STEPS} are taken")]
    TooLong {
        /// How many.
        steps: f64,
    },
    /// It grows out of all bounds.
    #[error("the response grows beyond 1e150 at t = {at:e}")]
    Grows {
        /// When.
        at: f64,
    },
    /// The system is of a kind that has none here.
    #[error("{0}")]
    Refused(&'static str),
    /// Its numbers make no system.
    #[error("{0}")]
    Numbers(#[from] MatrixError),
}

/// A system that is excited at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Excited {
    pub(super) a: Matrix,
    pub(super) b: Matrix,
    pub(super) c: Matrix,
    pub(super) d: Matrix,
    /// x at t = 0; nothing was before.
    pub(super) start: Vec<f64>,
    /// b and e: what a unit step adds to ẋ and to w.
    pub(super) input: [Vec<f64>; 2],
    /// Which part of x and w is told, counted through both.
    pub(super) told: Option<usize>,
    /// What is added to it.
    pub(super) offset: f64,
    /// τ.
    pub(super) tau: f64,
    /// A bound on its rates.
    pub(super) rate: f64,
}

const LATE: &str = "responses are not computed with a latency";
const NO_STATE: &str = "this system has no state that could be disturbed: D has degree 0";

impl Excited {
    /// What a disturbance of the state leaves: y = p_n s^(n−1)/D in the place of s, so that
    /// y(0) = 1 and y = 0 before. The coefficients of the powers of e^(−sτ) in D are `powers`, each
    /// from the constant on.
    ///
    /// # Errors
    /// When the first polynomial has a lower degree than another, or degree 0.
    pub fn by_start_of_powers(powers: &[Vec<f64>], tau: f64) -> Result<Self, NoResponse> {
        let mut excited = Self::at_rest(powers, tau)?;
        let Some(last) = excited.start.last_mut() else {
            return Err(NoResponse::Refused(NO_STATE));
        };
        *last = 1.0;
        Ok(excited)
    }

    /// What a disturbance of the state leaves of P and Q, as [`Excited::by_start_of_powers`].
    ///
    /// # Errors
    /// As [`Excited::by_start_of_powers`], and with a latency.
    pub fn by_start(system: &System, tau: f64) -> Result<Self, NoResponse> {
        Self::by_start_of_powers(&powers(system)?, tau)
    }

    /// What a disturbance of the state `state` leaves in that state, x(0) = 1, where nothing was
    /// fed back before.
    ///
    /// # Errors
    /// When there is no such state, or the closed loop without delay has no solution.
    pub fn by_start_of_matrices(
        system: &MatrixSystem,
        state: usize,
        tau: f64,
    ) -> Result<Self, NoResponse> {
        if state >= system.states() {
            return Err(NoResponse::Refused("there is no such state"));
        }
        let mut excited = Self::of(system, tau)?;
        excited.told = Some(state);
        excited.start[state] = 1.0;
        Ok(excited)
    }

    /// The output of a loop P y = −Q (y − r)(t − τ) after a unit step of r.
    ///
    /// # Errors
    /// When deg Q > deg P, with a latency, and where P + Q has a lower degree at τ = 0.
    pub fn by_reference(system: &System, tau: f64) -> Result<Self, NoResponse> {
        let [p, q] = powers(system)?;
        if tau == 0.0 {
            return Self::without_delay([&p, &q], &q);
        }
        let mut excited = Self::at_rest(&[p, q], tau)?;
        // The signal is the error y − r.
        if let Some(first) = excited.input[1].first_mut() {
            *first = -1.0;
            excited.offset = 1.0;
        }
        Ok(excited)
    }

    /// The output of P y + Q y(t − τ) = N d after a unit step of d, which `through`, N, takes up.
    ///
    /// # Errors
    /// As [`Excited::by_reference`], and when deg N > deg P.
    pub fn by_disturbance(
        system: &System,
        through: &Polynomial,
        tau: f64,
    ) -> Result<Self, NoResponse> {
        let [p, q] = powers(system)?;
        if tau == 0.0 {
            return Self::without_delay([&p, &q], through.coefficients());
        }
        let mut excited = Self::at_rest(&[p.clone(), q], tau)?;
        excited.feed(&p, through.coefficients())?;
        Ok(excited)
    }

    /// (P + Q) y = N u.
    fn without_delay([p, q]: [&Vec<f64>; 2], through: &[f64]) -> Result<Self, NoResponse> {
        let at = |of: &Vec<f64>, k: usize| of.get(k).copied().unwrap_or(0.0);
        let sum: Vec<f64> = (0..p.len().max(q.len()))
            .map(|k| at(p, k) + at(q, k))
            .collect();
        let mut excited = Self::at_rest(std::slice::from_ref(&sum), 0.0)?;
        excited.feed(&sum, through)?;
        Ok(excited)
    }

    /// Lets a unit step act through N/p₀.
    fn feed(&mut self, p0: &[f64], through: &[f64]) -> Result<(), NoResponse> {
        let n = self.start.len();
        let at = |of: &[f64], k: usize| of.get(k).copied().unwrap_or(0.0) / p0[n];
        let highest = through.iter().rposition(|c| *c != 0.0);
        if highest > Some(n) {
            let why = "the numerator has a higher degree than the denominator";
            return Err(NoResponse::Refused(why));
        }
        let direct = at(through, n);
        self.input[0] = (0..n)
            .map(|k| at(through, k) - direct * at(p0, k))
            .collect();
        match self.input[1].first_mut() {
            Some(signal) => *signal = direct,
            None => self.offset = direct,
        }
        Ok(())
    }

    /// Σ p_k e^(−ksτ) before anything acts; y is the first signal, or the last state where nothing
    /// is delayed.
    fn at_rest(powers: &[Vec<f64>], tau: f64) -> Result<Self, NoResponse> {
        if tau == 0.0 && powers.len() > 1 {
            let length = powers.iter().map(Vec::len).max().unwrap_or(0);
            let at = |k: usize| powers.iter().filter_map(|p| p.get(k)).sum::<f64>();
            let sum: Vec<f64> = (0..length).map(at).collect();
            return Self::at_rest(&[sum], 0.0);
        }
        let form = MatrixSystem::observer(powers)?;
        let (states, signals) = (form.states(), form.signals());
        let rate = MatrixSystem::of_powers(powers)?.bound();
        let mut excited = Self::in_form(&form, tau, rate);
        excited.told = match signals {
            0 => states.checked_sub(1),
            _ => Some(states),
        };
        Ok(excited)
    }

    fn of(system: &MatrixSystem, tau: f64) -> Result<Self, NoResponse> {
        if tau > 0.0 {
            return Ok(Self::in_form(system, tau, system.bound()));
        }
        let none = "without delay its equations have no solution: E1 has the eigenvalue 1";
        let closed = system.closed_loop().ok_or(NoResponse::Refused(none))?;
        let n = system.states();
        let still = MatrixSystem::of_matrices(&closed, &Matrix::new(n, n, vec![0.0; n * n]), None)?;
        // That form has its own units of states; one state is told in the unit of its start.
        Ok(Self::in_form(&still, 0.0, still.bound()))
    }

    fn in_form(form: &MatrixSystem, tau: f64, rate: f64) -> Self {
        let [a, b, c, d] = form.parts();
        Self {
            start: vec![0.0; a.rows()],
            input: [vec![0.0; a.rows()], vec![0.0; b.columns()]],
            a: a.clone(),
            b: b.clone(),
            c: c.clone(),
            d: d.clone(),
            told: None,
            offset: 0.0,
            tau,
            rate,
        }
    }
}

/// The coefficients of P and Q, without zeros behind the highest.
fn powers(system: &System) -> Result<[Vec<f64>; 2], NoResponse> {
    if system.latency() > 0.0 {
        return Err(NoResponse::Refused(LATE));
    }
    Ok(system.polynomials().map(|of| of.coefficients().to_vec()))
}
