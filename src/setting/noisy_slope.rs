//! Slopes of a measured curve that its own points contradict.

use crate::model::Table;

/// Slopes of neighbours that differ by more than this factor contradict one another.
const FACTOR: f64 = 2.0;
/// So many points tell noise from a curve.
const ENOUGH: usize = 12;
/// The median of the sizes of normal numbers is this part of their standard deviation.
const OF_MEDIAN: f64 = 0.674_489_75;

/// A slope that neighbours contradict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Noisy {
    /// The slopes between neighbouring points that differ, the one nearer to rest first.
    pub slopes: [f64; 2],
    /// The standard deviation of the points about straight lines between their neighbours; none of
    /// points that are too few to tell noise from a curve.
    pub noise: Option<f64>,
}

impl Noisy {
    /// What is told of the slope of a curve at a speed between its points: none where the slopes
    /// between the points about it have one sign and differ by no more than [`FACTOR`].
    pub(super) fn at(table: &Table, speed: f64) -> Option<Self> {
        let (speeds, mu_k) = (table.speeds(), table.mu_k());
        let slope = |i: usize| (mu_k[i + 1] - mu_k[i]) / (speeds[i + 1] - speeds[i]);
        let last = speeds.len() - 2;
        let within = table
            .region(speed)
            .unwrap_or_else(|below| below.max(1) - 1)
            .min(last);
        let about = within.saturating_sub(1)..(within + 1).min(last);
        let mut pairs = about.map(|i| [slope(i), slope(i + 1)]);
        let slopes = pairs.find(|of| contradict(*of))?;
        Some(Self {
            slopes,
            noise: noise(speeds, mu_k),
        })
    }
}

fn contradict([one, other]: [f64; 2]) -> bool {
    let (small, large) = (one.abs().min(other.abs()), one.abs().max(other.abs()));
    large > 0.0 && (one * other <= 0.0 || large > FACTOR * small)
}

/// The noise of points, by their distances from straight lines between their neighbours.
fn noise(speeds: &[f64], mu_k: &[f64]) -> Option<f64> {
    let off = |i: usize| {
        let part = (speeds[i] - speeds[i - 1]) / (speeds[i + 1] - speeds[i - 1]);
        let between = (1.0 - part) * mu_k[i - 1] + part * mu_k[i + 1];
        let variances = 1.0 + (1.0 - part) * (1.0 - part) + part * part;
        (mu_k[i] - between).abs() / variances.sqrt()
    };
    if speeds.len() < ENOUGH {
        return None;
    }
    let mut all: Vec<f64> = (1..speeds.len() - 1).map(off).collect();
    all.sort_by(f64::total_cmp);
    Some(all[all.len() / 2] / OF_MEDIAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(noise: f64) -> Table {
        let speeds: Vec<f64> = (0..40).map(|i| 0.02 + 0.01 * f64::from(i)).collect();
        // Independent enough for the size of the noise, and the same every time.
        let off = |i: usize| noise * (7.3 * (i * i) as f64).sin() * std::f64::consts::SQRT_2;
        let mu = |(i, v): (usize, &f64)| 0.3 + 0.2 * (-v / 0.2).exp() + off(i);
        let mu_k = speeds.iter().enumerate().map(mu).collect();
        Table::new(speeds, mu_k).unwrap()
    }

    #[test]
    fn noise_makes_slopes_unsure_and_its_size_is_told() {
        assert_eq!(Noisy::at(&curve(0.0), 0.1), None);
        let found = Noisy::at(&curve(0.01), 0.1).unwrap();
        assert!((0.006..0.015).contains(&found.noise.unwrap()), "{found:?}");
        assert!(contradict(found.slopes));
    }

    #[test]
    fn ends_and_points_have_neighbours_too() {
        let table = Table::new(vec![0.0, 0.1, 0.2], vec![0.5, 0.4, 0.45]).unwrap();
        for speed in [0.0, 0.05, 0.1, 0.15, 0.2, 0.3] {
            let found = Noisy::at(&table, speed).unwrap();
            assert!((found.slopes[0] + 1.0).abs() < 1e-12, "{speed}");
            assert_eq!(found.noise, None);
        }
        let two = Table::new(vec![0.0, 0.1], vec![0.5, 0.4]).unwrap();
        assert_eq!(Noisy::at(&two, 0.05), None);
    }
}
