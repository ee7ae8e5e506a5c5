//! Where controls end: the slope beyond which velocity control fails, and the weakest gains of load
//! control.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::shortest;
use super::workshop::{Source, Workshop, planes, source};
use crate::linear::lobes::{
    LobeControl, has_stable_delay, minimal_negative_load_gain, minimal_positive_load_gain,
};
use crate::model::Groups;
use crate::setting::Field;

const LOBES: Source = source!("velocity_limit");
const BRACKET: Source = source!("velocity_limit_bracket");

/// The sources of the claims here.
pub(super) const SOURCES: [&Source; 2] = [&LOBES, &BRACKET];

/// The letter's slope at which velocity control ends, in units of √(κM)/N0, and its last digit.
const LETTER: (f64, f64) = (-0.68, 0.01);

/// The slope at which the last lobe of velocity control ends.
#[derive(Debug, Clone, PartialEq)]
struct VelocityLimit {
    /// b*, from the tangency.
    end: f64,
    /// Gain and delay there.
    place: (f64, f64),
    /// Slopes of maps, and how many stable cells each has.
    cells: Vec<(f64, usize)>,
}

/// The error of the tangency: its condition is solved to the last bits, and its terms are of order
/// 10.
const TANGENCY_ERROR: f64 = 1e-13;

impl VelocityLimit {
    /// Number of slopes beyond b* at which a map has stable cells.
    fn stable_beyond(&self) -> usize {
        let beyond = self.cells.iter();
        let beyond = beyond.filter(|(b, cells)| *b < self.end && *cells > 0);
        beyond.count()
    }

    /// The steepest slope with stable cells, and the flattest one without.
    fn bracket(&self) -> (f64, f64) {
        let with = self.cells.iter().filter(|(_, cells)| *cells > 0);
        let without = self.cells.iter().filter(|(_, cells)| *cells == 0);
        (
            with.map(|(b, _)| *b).fold(0.0, f64::min),
            without.map(|(b, _)| *b).fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// The results of the maps, in words.
    fn maps(&self) -> String {
        let (with, without) = self.bracket();
        let agree = match self.stable_beyond() {
            0 => format!("Maps have stable cells at {with} and none at {without}."),
            some => format!("But {some} maps beyond have stable cells."),
        };
        let past = self.cells.iter();
        let past = past.filter(|(b, cells)| *b < LETTER.0 && *cells > 0);
        let mut past: Vec<_> = past.copied().collect();
        past.sort_by(|one, other| other.0.total_cmp(&one.0));
        let past: Vec<_> = past.iter().map(|(b, n)| format!("{n} at {b}")).collect();
        match past.is_empty() {
            true => format!("{agree} None is stable beyond the letter's {}.", LETTER.0),
            false => format!(
                "{agree} Beyond the letter's {} the magnified lobe has stable cells: {}.",
                LETTER.0,
                past.join(", "),
            ),
        }
    }

    fn verdict(&self) -> Verdict {
        let (with, without) = self.bracket();
        let bracketed = without < self.end && self.end < with;
        let ends = Verdict::of(bracketed && self.stable_beyond() == 0);
        ends.max(Verdict::of_number(
            LETTER.0,
            LETTER.1,
            self.end,
            TANGENCY_ERROR,
        ))
    }

    fn claim(&self) -> Claim {
        let because = format!(
            "The crossing curves touch at {:.12} √(κM) (α_v = {:.6}, τ = {:.6}), and no lobe is \
             left beyond. {}",
            self.end,
            self.place.0,
            self.place.1,
            self.maps(),
        );
        let at = (
            "paragraph of Fig. 2",
            "it disappears if μ′_K(v0) N0 ≲ −0.68 √(κM)",
        );
        let how = "The first lobe shrinks to a point where both crossing frequencies are equal and \
            both arms of the fold have the same slope: one scalar equation. Two maps bracket it, \
            one shows the lobes beyond −0.68.";
        let cells = self.cells.iter().map(|(b, cells)| {
            let meaning = "stable cells of the map at this slope";
            ClaimValue::of(format!("stable cells at {b}"), meaning, *cells as f64)
        });
        let end = ClaimValue::of("b_star", "slope of the end, √(κM)/N0", self.end);
        let end = end.within(TANGENCY_ERROR).beside(LETTER.0);
        Claim::new("velocity_limit", at, self.verdict(), because, how)
            .by(std::iter::once(end).chain(cells))
            .from(&["velocity_limit", "velocity_limit_bracket", "fig2a"])
    }
}

/// The weakest gains of load control that stabilise, for increasing |b|.
#[derive(Debug, Clone, PartialEq)]
struct LoadGains {
    rows: Vec<LoadGain>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct LoadGain {
    b: f64,
    /// The weakest negative gain, and whether some delay is stable just beyond it.
    negative: f64,
    stable: bool,
    /// The weakest positive gain; infinite where none is found.
    positive: f64,
}

/// Relative distance beyond a gain at which a stable delay is searched for.
const RIGHT_BEYOND: f64 = 1e-6;
/// Slopes for load control: first, last, and number, evenly spaced in the logarithm.
const SLOPES: (f64, f64, u32) = (0.01, 20.0, 400);

impl LoadGains {
    fn found() -> Self {
        let (from, to, points) = SLOPES;
        let slope = |i: u32| -from * (to / from).powf(f64::from(i) / f64::from(points - 1));
        let last = LobeControl::PositiveLoad.lobe_end(0).b;
        let row = |b: f64| {
            let stable = |a_n: f64| has_stable_delay(Groups::new(b, 0.0, a_n));
            let negative = minimal_negative_load_gain(b);
            let positive = minimal_positive_load_gain(b);
            LoadGain {
                b,
                negative,
                stable: stable(negative * (1.0 + RIGHT_BEYOND))
                    && !stable(negative * (1.0 - RIGHT_BEYOND)),
                positive: match b > last {
                    true => positive,
                    false => f64::INFINITY,
                },
            }
        };
        Self {
            rows: (0..points).map(slope).map(row).collect(),
        }
    }

    fn always(&self) -> Verdict {
        Verdict::of(!self.rows.is_empty() && self.rows.iter().all(|row| row.stable))
    }

    /// The smallest |gain| of either sign.
    fn weakest(row: &LoadGain) -> f64 {
        row.negative.abs().min(row.positive)
    }

    /// Number of steps of the slope at which a gain increases.
    fn steps_up(&self, size: fn(&LoadGain) -> f64) -> usize {
        let pairs = self.rows.windows(2);
        pairs.filter(|pair| size(&pair[1]) > size(&pair[0])).count()
    }

    fn steps(&self) -> usize {
        self.rows.len().saturating_sub(1)
    }

    fn grows(&self) -> Verdict {
        let grows =
            |size: fn(&LoadGain) -> f64| self.steps() > 0 && self.steps_up(size) == self.steps();
        Verdict::of_parts(
            grows(Self::weakest) && grows(|row| row.negative.abs()),
            grows(|row| row.negative.abs()),
        )
    }

    /// The steepest slope at which a positive gain stabilises.
    fn positive_until(&self) -> f64 {
        let some = self.rows.iter().filter(|row| row.positive.is_finite());
        some.map(|row| row.b).fold(0.0, f64::min)
    }

    fn claims(&self) -> [Claim; 2] {
        let (from, to, points) = SLOPES;
        let stable = self.rows.iter().filter(|row| row.stable).count();
        let because = format!(
            "Some delay is stable right beyond the weakest negative gain at {stable} of {points} \
             slopes from −{from} to −{to} √(κM)/N0, and none at weaker ones."
        );
        let at = (
            "paragraph of Eq. (8)",
            "In pure load control there is always a stable region.",
        );
        let how = "Crossings exist from the gain −(b²/2 + |b|) κ/μ_K on, b being the slope; all \
            stable delays on either side of it follow from their closed form.";
        let count = ClaimValue::of("slopes", "slopes with a stable delay", stable as f64);
        let always = Claim::new("load_always", at, self.always(), because, how)
            .by([count])
            .from(&["fig2b"]);
        let until = LobeControl::PositiveLoad.lobe_end(0).b;
        let mut because = format!(
            "The smallest |α_N| grows at {} of {} steps of the slope.",
            self.steps_up(Self::weakest),
            self.steps(),
        );
        let positive = self.rows.iter();
        let positive = positive.filter(|row| row.positive < row.negative.abs());
        let (belongs, seen) = positive.fold((0, 0.0_f64), |(n, to), row| (n + 1, to.min(row.b)));
        if belongs > 0 {
            because += &format!(
                " What the letter does not say: at {belongs} of {} slopes, down to {seen:.6}, it \
                 belongs to a positive gain, in lobes of their own.",
                self.rows.len(),
            );
        }
        let at = (
            "paragraph of Eq. (8)",
            "Only the minimal value of |α_N| increases with increasing |μ′_K|",
        );
        let how = "The weakest negative gain −(b²/2 + |b|) and, down to the end of its first lobe, \
            the weakest positive one |b| − b²/2, in units of κ/μ_K.";
        let of = |b: f64| {
            let negative = minimal_negative_load_gain(b);
            let positive = match b > until {
                true => minimal_positive_load_gain(b),
                false => f64::INFINITY,
            };
            let meaning = "smallest |α_N| of either sign that stabilises, κ/μ_K";
            let weakest = negative.abs().min(positive);
            ClaimValue::of(format!("gain at {b}"), meaning, weakest).within(f64::EPSILON * weakest)
        };
        let end = "slope at which the last positive gain stabilises, √(κM)/N0";
        let end = ClaimValue::of("positive_until", end, until).within(TANGENCY_ERROR);
        let seen = "steepest of the slopes looked at with such a gain";
        let seen = ClaimValue::of("seen_until", seen, self.positive_until());
        let grows = Claim::new("minimal_load_gain", at, self.grows(), because, how)
            .by([-0.1, -1.0, -5.0].map(of))
            .by([end, seen])
            .from(&["fig2b"]);
        [always, grows]
    }
}

/// All claims of this file.
pub(super) fn claims(shop: &mut Workshop) -> Result<Vec<Claim>, LetterError> {
    let mut cells = Vec::new();
    for source in [&LOBES, &BRACKET] {
        for (outer, plane) in planes(&shop.map(source)?, Field::NUnstable)? {
            let stable = plane.cells.iter().filter(|n| **n == 0.0).count();
            cells.extend(outer.first().map(|(_, b)| (*b, stable)));
        }
    }
    let end = LobeControl::Velocity { damping: 0.0 }.lobe_end(0);
    let limit = VelocityLimit {
        end: end.b,
        place: (end.gain, end.tau),
        cells,
    };
    shop.step("the weakest gains of load control, and short delays")?;
    let mut claims = vec![limit.claim()];
    claims.extend(LoadGains::found().claims());
    claims.extend(shortest::claims());
    Ok(claims)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_needs_the_tangency_and_both_maps() {
        let found = VelocityLimit {
            end: -0.725_636,
            place: (-0.315, 4.36),
            cells: vec![(-0.7, 500), (-0.7256, 7), (-0.7257, 0)],
        };
        assert_eq!(found.verdict(), Verdict::Refined);
        let of = |end: f64, cells: &[(f64, usize)]| {
            let (cells, place) = (cells.to_vec(), found.place);
            VelocityLimit { end, place, cells }.verdict()
        };
        assert_eq!(of(-0.68, &[(-0.67, 9), (-0.69, 0)]), Verdict::Confirmed);
        assert_eq!(
            of(-0.725_636, &[(-0.7256, 7), (-0.7257, 1)]),
            Verdict::Contradicted
        );
        assert_eq!(
            of(-0.725_636, &[(-0.7256, 0), (-0.7257, 0)]),
            Verdict::Contradicted
        );
        assert_eq!(of(-0.8, &[(-0.79, 7), (-0.81, 0)]), Verdict::Contradicted);
    }

    /// The text beside a verdict states what was found.
    #[test]
    fn texts_follow_from_the_numbers() {
        let limit = |cells: &[(f64, usize)]| VelocityLimit {
            end: -0.7,
            place: (-0.3, 4.3),
            cells: cells.to_vec(),
        };
        let told = limit(&[(-0.69, 12), (-0.71, 0)]).claim().because;
        assert!(
            told.contains("stable cells at -0.69 and none at -0.71"),
            "{told}"
        );
        assert!(told.contains("stable cells: 12 at -0.69."), "{told}");
        let told = limit(&[(-0.67, 12), (-0.69, 0)]).claim().because;
        assert!(
            told.contains("None is stable beyond the letter's -0.68"),
            "{told}"
        );
        let told = limit(&[(-0.69, 12), (-0.71, 3)]).claim().because;
        assert!(
            told.contains("But 1 maps beyond have stable cells"),
            "{told}"
        );
        let row = |b: f64, negative: f64, positive: f64| LoadGain {
            b,
            negative,
            stable: true,
            positive,
        };
        let gains = |rows: &[LoadGain]| {
            LoadGains {
                rows: rows.to_vec(),
            }
            .claims()[1]
                .because
                .clone()
        };
        let endless = f64::INFINITY;
        let told = gains(&[
            row(-0.1, -0.2, 0.1),
            row(-0.2, -0.3, endless),
            row(-0.3, -0.25, endless),
        ]);
        assert!(told.contains("grows at 1 of 2 steps"), "{told}");
        assert!(
            told.contains("at 1 of 3 slopes, down to -0.100000"),
            "{told}"
        );
        let told = gains(&[row(-0.1, -0.2, endless), row(-0.2, -0.3, endless)]);
        assert!(!told.contains("positive"), "{told}");
    }

    #[test]
    fn load_control_needs_a_stable_delay_everywhere_and_growing_gains() {
        let row = |b: f64, negative: f64| LoadGain {
            b,
            negative,
            stable: true,
            positive: f64::INFINITY,
        };
        let mut found = LoadGains {
            rows: vec![row(-0.1, -0.1), row(-0.2, -0.3), row(-0.3, -0.5)],
        };
        assert_eq!(
            (found.always(), found.grows()),
            (Verdict::Confirmed, Verdict::Confirmed)
        );
        found.rows[2].positive = 0.2;
        assert_eq!(found.grows(), Verdict::Refined);
        found.rows[1].negative = -0.05;
        found.rows[1].stable = false;
        assert_eq!(
            (found.always(), found.grows()),
            (Verdict::Contradicted, Verdict::Contradicted)
        );
    }
}
