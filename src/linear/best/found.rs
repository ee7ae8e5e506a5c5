//! What the search finds: optima, and the regions they are in.

use super::regions::{Stretch, Stretches};

/// Regions that are told; the others are counted.
pub const MOST_REGIONS: usize = 64;

/// What makes a setting an optimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A complex pair is double: D = D′ = 0.
    DoublePair,
    /// A real root is triple: D = D′ = D″ = 0.
    TripleReal,
    /// A real root is double, and as far left as along its curve it gets.
    DoubleReal,
    /// A double real root and a pair have the same real part.
    DoubleRealAndPair,
    /// Three pairs have the same real part.
    ThreePairs,
    /// A real root and two pairs have the same real part.
    RealAndTwoPairs,
    /// Two pairs have the same real part, as far left as they get together.
    TwoPairs,
    /// A real root and a pair have the same real part, as far left as they get together.
    RealAndPair,
    /// One root or pair, as far left as it gets.
    OneRoot,
    /// The optimum lies on an edge of the box: beyond it there is a better one.
    Edge,
    /// No condition could be confirmed; the place is as good as the direct search found it.
    Descent,
    /// No root lies right of the line at which infinitely many accumulate.
    Accumulation,
}

impl Kind {
    /// All kinds, in the order of their numbers in maps.
    pub(crate) const ALL: [Self; 12] = [
        Self::DoublePair,
        Self::TripleReal,
        Self::DoubleReal,
        Self::DoubleRealAndPair,
        Self::ThreePairs,
        Self::RealAndTwoPairs,
        Self::TwoPairs,
        Self::RealAndPair,
        Self::OneRoot,
        Self::Edge,
        Self::Descent,
        Self::Accumulation,
    ];

    /// In words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::DoublePair => "double pair",
            Self::TripleReal => "triple real root",
            Self::DoubleReal => "double real root",
            Self::DoubleRealAndPair => "double real root and pair",
            Self::ThreePairs => "three pairs",
            Self::RealAndTwoPairs => "real root and two pairs",
            Self::TwoPairs => "two pairs",
            Self::RealAndPair => "real root and pair",
            Self::OneRoot => "one root",
            Self::Edge => "edge of the range",
            Self::Descent => "direct search",
            Self::Accumulation => "roots accumulate",
        }
    }
}

/// A setting at which the abscissa is smallest, dimensionless.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// p, such as a gain.
    pub p: f64,
    /// q, such as the delay.
    pub q: f64,
    /// The spectral abscissa max Re λ; negative where sliding is stable.
    pub abscissa: f64,
    /// |Im λ| of the roots that share this real part, rising; 0 for a real one. A double root
    /// stands once. None where roots accumulate there.
    pub frequencies: Vec<f64>,
    /// What makes it an optimum.
    pub kind: Kind,
    /// The argument principle confirms the abscissa: right of a line a little farther left there
    /// are no roots but those of `kind`, and none right of a line a little farther right. At
    /// multiple roots these lines are farther away than `margin`.
    pub certified: bool,
    /// What rounding can do to the abscissa: about 1e-15 at simple roots, 1e-7 at double and 1e-4
    /// at triple ones.
    pub margin: f64,
}

impl Optimum {
    /// The lowest frequency among the rightmost roots; NaN where there is none.
    #[must_use]
    pub(crate) fn frequency(&self) -> f64 {
        self.frequencies.first().copied().unwrap_or(f64::NAN)
    }

    /// The relaxation time −1/abscissa; none where the setting is not stable.
    #[must_use]
    pub fn relaxation_time(&self) -> Option<f64> {
        (self.abscissa < 0.0).then(|| -1.0 / self.abscissa)
    }

    /// Whether roots decay by more than rounding, or what the search left open, can do to the
    /// abscissa.
    pub(super) fn decays(&self) -> bool {
        self.abscissa < -self.margin
    }
}

/// A stable region of the box.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// The smallest and the largest p at which it was sampled, or its best setting is.
    pub p: (f64, f64),
    /// The smallest and the largest stable q at these p.
    pub q: (f64, f64),
    /// The setting of fastest decay in it.
    pub best: Optimum,
    /// Its stable q at the p sampled.
    pub(super) stretches: Stretches,
}

impl Region {
    /// A region of which the stable q are not kept.
    pub(super) fn without_stretches(p: (f64, f64), q: (f64, f64), best: Optimum) -> Self {
        Self {
            p,
            q,
            best,
            stretches: Stretches::new(),
        }
    }

    /// Whether a place is in the region, as the sampled p next to it has it.
    pub(super) fn holds(&self, place: &Optimum) -> bool {
        let apart = |s: &&Stretch| (s.p - place.p).abs();
        let nearest = self.stretches.iter();
        let nearest = nearest.min_by(|p, q| apart(p).total_cmp(&apart(q)));
        let ends = [self.stretches.first(), self.stretches.last()];
        let ([Some(first), Some(last)], Some(nearest)) = (ends, nearest) else {
            return false;
        };
        let there = |s: &Stretch| s.p == nearest.p && s.from <= place.q && place.q <= s.to;
        (first.p..=last.p).contains(&place.p) && self.stretches.iter().any(there)
    }

    /// Both regions as one.
    pub(super) fn joined(mut self, other: Self) -> Self {
        let hull = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        self.p = hull(self.p, other.p);
        self.q = hull(self.q, other.q);
        self.stretches.extend(other.stretches);
        self.stretches.sort_by(|p, q| {
            let by_p = p.p.total_cmp(&q.p);
            by_p.then(p.from.total_cmp(&q.from))
        });
        if other.best.abscissa < self.best.abscissa {
            self.best = other.best;
        }
        self
    }

    /// The smallest stable q that was seen.
    pub(super) fn smallest(&self) -> f64 {
        let all = self.stretches.iter().map(|s| s.from);
        all.fold(f64::INFINITY, f64::min)
    }
}

/// What [`best`](super::best) finds.
#[derive(Debug, Clone, PartialEq)]
pub struct Best {
    /// The setting of fastest decay in the box; where nothing is stable, of slowest growth.
    pub overall: Optimum,
    /// Every stable region with its own best setting, by their smallest q. Stable is where
    /// roots decay by more than rounding can do to the abscissa; regions with the same best setting
    /// are one.
    pub regions: Vec<Region>,
    /// Regions that are not told: those beyond the first [`MOST_REGIONS`], those at which the work
    /// of the search came to its bound, and those where roots decay by less than rounding can do to
    /// the abscissa, if at all.
    pub regions_left_out: usize,
}
