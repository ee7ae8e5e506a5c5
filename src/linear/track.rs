//! The rightmost roots along a line: all delays at one setting of the gains and the damping.
//!
//! Roots are continued from delay to delay: a predictor of second order from dλ/dτ, then Halley's
//! method, which from there is at rounding level in one evaluation of D. Besides the roots that are
//! reported, a few behind them are followed, so that it is known when another becomes the
//! rightmost. Nothing relies on that: in each cell the certificate counts the roots right of those
//! reported. Where it finds one, where roots run into one another or an iteration does not settle,
//! all are found anew ([`RootFinder`]). So they are at every [`BLOCK`]-th delay, which makes the
//! values of a cell independent of where a tile begins.
//!
//! - `step`: one root and its way from a delay to the next

mod step;

use num_complex::Complex64;

use super::equation::Equation;
use super::newton::Root;
use super::spectrum::RootFinder;
use super::status::{CERTIFIED, DISAGREE, MARGINAL, MOST_COUNTED, NOT_CONVERGED};
use step::{NO_TRACK, Track, correct, delay_slope};

/// Most roots that can be reported for a cell, pairs counted once.
pub const MOST_ROOTS: usize = 8;
/// Tracking starts anew at delays whose index on the line is a multiple of this.
pub const BLOCK: usize = 4096;
/// The margin of the certificate, but for nearly multiple roots.
pub const MARGIN: f64 = 1e-12;

/// Roots followed beyond those reported.
const COMPANIONS: usize = 2;
const MOST_TRACKS: usize = MOST_ROOTS + COMPANIONS;
/// Cells after which a narrower margin than before is tried.
const CELLS_WITH_A_MARGIN: u8 = 6;
/// How far the margin may be widened where a root is nearly multiple.
const WIDEST_MARGIN: f64 = 0.03;
/// The roots found in one cell.
#[derive(Debug, Clone, Copy)]
pub struct Cell<'t> {
    /// The rightmost roots by falling real part, as many as the tracker was asked for. There are
    /// fewer without control or delay, where no more exist, and in a cell that is marked not
    /// converged, where the others were not found. Dimensionless.
    pub roots: &'t [Root],
    /// No root lies right of Re λ + margin·max(1, |Re λ|), λ being the first of `roots`.
    pub margin: f64,
}

/// How much work was done, for tests and benchmarks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Cells visited.
    pub cells: u64,
    /// Cells in which all roots were found anew.
    pub reseeded: u64,
    /// Evaluations of D on the way from cell to cell.
    pub evaluations: u64,
}

const NO_ROOT: Root = Root {
    lambda: Complex64::ZERO,
    error: 0.0,
};

/// The margin with which a certificate is tried first.
#[derive(Debug, Clone, Copy)]
struct KeptMargin {
    margin: f64,
    /// The number of further cells that begin with it.
    cells: u8,
}

impl KeptMargin {
    const NONE: Self = Self {
        margin: MARGIN,
        cells: 0,
    };

    /// Learns from a cell that needed `margin`, widened or not.
    fn learn(&mut self, margin: f64, widened: bool) {
        if widened {
            (self.margin, self.cells) = (margin, CELLS_WITH_A_MARGIN);
        } else if self.cells > 0 {
            self.cells -= 1;
        } else {
            self.margin = (0.125 * margin).max(MARGIN);
        }
    }
}

/// Follows the rightmost roots along lines, keeping its memory from one line to the next.
#[derive(Debug, Clone)]
pub struct RootTracker {
    wanted: usize,
    finder: RootFinder,
    tracks: [Track; MOST_TRACKS],
    /// How many of `tracks` are in use.
    followed: usize,
    roots: [Root; MOST_ROOTS],
    /// How many of `roots` are reported, and how many should be.
    reported: usize,
    expected: usize,
    /// For each of `roots`, where certificates cost much.
    margins: [KeptMargin; MOST_ROOTS],
    /// Whether fewer roots were found than were asked for.
    short: bool,
    /// The delay at which `tracks` stand, and the step that led there.
    tau: f64,
    step: f64,
    /// Work done since the tracker was made.
    pub work: Work,
}

impl RootTracker {
    /// A tracker that reports the `wanted` rightmost roots of each cell, 1 to [`MOST_ROOTS`].
    #[must_use]
    pub fn new(wanted: usize) -> Self {
        Self {
            wanted: wanted.clamp(1, MOST_ROOTS),
            finder: RootFinder::default(),
            tracks: [NO_TRACK; MOST_TRACKS],
            followed: 0,
            roots: [NO_ROOT; MOST_ROOTS],
            margins: [KeptMargin::NONE; MOST_ROOTS],
            reported: 0,
            expected: 0,
            short: false,
            tau: 0.0,
            step: 0.0,
            work: Work::default(),
        }
    }

    /// Visits every cell of a line in order.
    ///
    /// `delays` increase; divided by `time_unit` = √(M/κ) they are dimensionless. `first` is the
    /// index of the first of them on the whole line. If it is a multiple of [`BLOCK`], values do
    /// not depend on how the line is cut. `counts` are the numbers of unstable roots by the closed
    /// form. `status` comes with the flags of that form, and gains certified, marginal, not
    /// converged or disagree.
    pub fn follow<E: Equation>(
        &mut self,
        equation: E,
        (delays, time_unit): (&[f64], f64),
        first: usize,
        counts: &[u16],
        status: &mut [u8],
        mut visit: impl FnMut(usize, Cell),
    ) {
        let controlled = !equation.uncontrolled();
        let unstable = equation.unstable();
        self.work.cells += delays.len() as u64;
        for (i, ((delay, &count), status)) in
            delays.iter().zip(counts).zip(status.iter_mut()).enumerate()
        {
            // Without control the delay is taken as 0: e^(−λτ) must not overflow where nothing
            // depends on it.
            let tau = if controlled { delay / time_unit } else { 0.0 };
            equation.begin();
            if i == 0 || (first + i).is_multiple_of(BLOCK) {
                self.margins = [KeptMargin::NONE; MOST_ROOTS];
            }
            // After τ = 0 there are more roots than before.
            let fresh =
                i == 0 || (first + i).is_multiple_of(BLOCK) || self.tau == 0.0 || self.short;
            let tracked = if !fresh && self.advance(equation, tau) {
                self.judge(
                    equation,
                    tau,
                    E::unstable_at(&unstable, tau),
                    (count, *status),
                )
            } else {
                Err(Doubt::Missed)
            };
            let found = tracked.or_else(|_| {
                self.start_anew(equation, tau)?;
                self.judge(
                    equation,
                    tau,
                    E::unstable_at(&unstable, tau),
                    (count, *status),
                )
            });
            let (margin, flag) = match found {
                Ok((margin, _)) if self.short => (margin, NOT_CONVERGED),
                Ok(found) => found,
                Err(doubt) => (f64::NAN, doubt.flag()),
            };
            *status |= flag;
            visit(
                i,
                Cell {
                    roots: &self.roots[..self.reported],
                    margin,
                },
            );
        }
    }

    /// Continues every track to `tau`; false where the roots to be reported are not among them any
    /// more.
    #[inline]
    fn advance(&mut self, equation: impl Equation, tau: f64) -> bool {
        let step = tau - self.tau;
        let bend = if self.step > 0.0 {
            0.5 * step / self.step
        } else {
            0.0
        };
        (self.tau, self.step) = (tau, step);
        let mut kept = 0;
        for i in 0..self.followed {
            let track = self.tracks[i];
            let ahead = track.slope + (track.slope - track.earlier_slope) * bend;
            let predicted = track.lambda + ahead * step;
            if let Some((found, evaluations)) = correct(equation, tau, predicted) {
                self.work.evaluations += u64::from(evaluations);
                self.tracks[kept] = Track {
                    earlier_slope: track.slope,
                    ..found
                };
                kept += 1;
            }
        }
        self.followed = kept;
        self.choose()
    }

    /// Fills `roots` with the rightmost tracks. False where there are too few, or two are the same
    /// root.
    #[inline]
    fn choose(&mut self) -> bool {
        let tracks = &mut self.tracks[..self.followed];
        let mut distinct = true;
        // Insertion sort: the order changes seldom.
        for i in 1..tracks.len() {
            let mut j = i;
            while j > 0 && tracks[j].lambda.re > tracks[j - 1].lambda.re {
                tracks.swap(j, j - 1);
                j -= 1;
            }
        }
        for i in 1..tracks.len() {
            for j in 0..i {
                let gap = tracks[i].lambda - tracks[j].lambda;
                distinct &= gap.norm_sqr() > 1e-16;
            }
        }
        self.reported = self.expected.min(tracks.len());
        for (root, track) in self.roots.iter_mut().zip(&tracks[..self.reported]) {
            *root = Root {
                lambda: track.lambda,
                error: track.error,
            };
        }
        distinct && self.reported == self.expected
    }

    /// Finds all roots anew at `tau`.
    #[cold]
    fn start_anew(&mut self, equation: impl Equation, tau: f64) -> Result<(), Doubt> {
        self.work.reseeded += 1;
        (self.tau, self.step) = (tau, 0.0);
        self.followed = 0;
        self.reported = 0;
        self.short = true;
        // Roots farther left than this are far from being the rightmost for many delays to come.
        let horizon = -0.5 - 3.0 / tau;
        let all = 2 * (self.wanted + COMPANIONS) as u64;
        self.seed(equation, tau, all, horizon)?;
        if self.followed < self.wanted
            && self
                .seed(equation, tau, 2 * self.wanted as u64, f64::NEG_INFINITY)
                .is_err()
        {
            self.seed(equation, tau, all, horizon)?;
        }
        self.expected = self.wanted.min(self.followed);
        // With control and delay there are infinitely many roots.
        self.short = self.expected < self.wanted && tau > 0.0;
        self.choose();
        Ok(())
    }

    fn seed(
        &mut self,
        equation: impl Equation,
        tau: f64,
        count: u64,
        leftmost: f64,
    ) -> Result<(), Doubt> {
        let found = self.finder.rightmost(equation, tau, count, leftmost);
        let roots = found.map_err(|_| Doubt::Undecided)?;
        self.followed = roots.len().min(MOST_TRACKS);
        for (track, root) in self.tracks.iter_mut().zip(roots) {
            let slope = delay_slope(equation, tau, root.lambda);
            *track = Track {
                lambda: root.lambda,
                slope,
                earlier_slope: slope,
                error: root.error,
            };
        }
        Ok(())
    }

    /// Shows that right of each reported root there are no others than those reported. Returns the
    /// margin.
    #[inline]
    fn certify<E: Equation>(&mut self, equation: E, tau: f64) -> Result<f64, Doubt> {
        let roots = &self.roots[..self.reported];
        if roots.is_empty() {
            return Err(Doubt::Undecided);
        }
        let mut widest = MARGIN;
        let essential = equation.essential_abscissa(tau);
        // With roots that accumulate, the rightmost one lies right of their line.
        if roots[0].lambda.re <= essential {
            return Err(Doubt::Missed);
        }
        for (root, kept) in roots.iter().zip(&mut self.margins) {
            if root.lambda.re <= essential {
                return Err(Doubt::Undecided);
            }
            let unit = root.lambda.re.abs().max(1.0);
            let first = kept.margin.max(16.0 * root.error / unit);
            let mut margin = first;
            let line = loop {
                let line = root.lambda.re + margin * unit;
                match equation.right_of(tau, line) {
                    Some(count) => break (line, count),
                    None if margin < WIDEST_MARGIN => margin *= 8.0,
                    None => return Err(Doubt::Undecided),
                }
            };
            let known = roots.iter().filter(|r| r.lambda.re > line.0);
            if known.map(Root::count).sum::<u64>() != line.1 {
                return Err(Doubt::Missed);
            }
            if E::KEEPS_MARGINS {
                kept.learn(margin, margin > first);
            }
            widest = widest.max(margin);
        }
        Ok(widest)
    }

    /// The margin and the status of the cell at `tau`. `unstable`, from the certificate, is the
    /// number of roots right of zero; `count` is that of the closed form, whose flags are in
    /// `status`.
    #[inline]
    fn judge(
        &mut self,
        equation: impl Equation,
        tau: f64,
        unstable: Option<u64>,
        (count, status): (u16, u8),
    ) -> Result<(f64, u8), Doubt> {
        let margin = self.certify(equation, tau)?;
        let Some(unstable) = unstable else {
            return Ok((margin, MARGINAL));
        };
        let rightmost = &self.roots[0];
        let sign_is_right = rightmost.lambda.re.abs() <= rightmost.error
            || (rightmost.lambda.re > 0.0) == (unstable > 0);
        if !sign_is_right {
            return Err(Doubt::Missed);
        }
        if unstable.min(u64::from(MOST_COUNTED)) == u64::from(count) {
            Ok((margin, CERTIFIED))
        } else if status & MARGINAL != 0 {
            Ok((margin, 0))
        } else {
            Err(Doubt::Missed)
        }
    }
}

/// Why a cell is not certified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Doubt {
    /// Some roots were not found, or some that were found are not roots.
    Missed,
    /// An iteration or the certificate did not decide.
    Undecided,
}

impl Doubt {
    const fn flag(self) -> u8 {
        match self {
            Self::Missed => DISAGREE,
            Self::Undecided => NOT_CONVERGED,
        }
    }
}
