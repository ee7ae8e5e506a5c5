//! A friction curve through measured points.

use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::text::Shown;

/// The most points of a table.
pub const MOST_POINTS: usize = 4096;

/// Two speeds must differ by more than this, relative to the larger one.
pub(crate) const NEAREST: f64 = 1e-6;

/// Allowed sizes of coefficients and of speeds other than 0: far beyond any experiment.
const SIZES: RangeInclusive<f64> = 1e-12..=1e12;

/// μ_K(v) through given points, by monotone cubics: between two points it is monotone, so it never
/// leaves their range.
///
/// Between points i and i + 1, h apart, with the secant δ_i = Δμ/h and w = (v − v_i)/h,
///
/// ```text
/// μ_K = μ_i + h d_i w + (3δ_i − 2d_i − d_{i+1}) h w² + (d_i + d_{i+1} − 2δ_i) h w³
/// ```
///
/// is continuous with its slope. The slope d_i at a point is 0 where the secants change sign, else
/// their harmonic mean with weights 2h_i + h_{i−1} and h_i + 2h_{i−1}; at the ends it is that of a
/// parabola through three points, limited to keep the curve monotone. This is PCHIP: SciPy's
/// `PchipInterpolator` and Octave's `pchip` draw the same curve. The error of a smooth law falls
/// like h³, that of its slope like h².
///
/// Below the first and beyond the last point μ_K is constant and its slope 0; at the points
/// themselves the slope is d_i.
///
/// Source: F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300.
///
/// Clones share their points.
///
/// ```
/// use slipmap::model::Table;
///
/// let measured = Table::new(vec![0.0, 0.1, 0.5, 1.0], vec![0.50, 0.45, 0.38, 0.36])?;
/// assert_eq!(measured.value(0.1), 0.45);
/// assert!(measured.slope(0.3) < 0.0, "friction weakens");
/// # Ok::<(), slipmap::model::table::TableError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Table(Arc<Points>);

#[derive(Debug, PartialEq)]
struct Points {
    speeds: Vec<f64>,
    mu_k: Vec<f64>,
    slopes: Vec<f64>,
}

/// The columns of a table, by their names in files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableColumn {
    /// Speeds.
    Speeds,
    /// μ_K at these.
    MuK,
}

impl TableColumn {
    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Speeds => "speeds",
            Self::MuK => "mu_k",
        }
    }
}

/// Why points do not make a friction curve.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Too few, too many, or not in pairs.
    #[error("{}", counted(*speeds, *mu_k))]
    Count {
        /// Number of speeds.
        speeds: usize,
        /// Number of coefficients.
        mu_k: usize,
    },
    /// One value is out of its range.
    #[error("{} = {} is outside its range: {allowed}", column.name(), Shown(*value))]
    Value {
        /// Where it stands.
        column: TableColumn,
        /// Its place in the column, from 0 on.
        index: usize,
        /// The value.
        value: f64,
        /// The range allowed, in words.
        allowed: &'static str,
    },
}

/// What is wrong with so many speeds and values of μ_K.
fn counted(speeds: usize, mu_k: usize) -> String {
    match speeds {
        1 if mu_k == 1 => format!("only 1 point: 2 to {MOST_POINTS} are needed"),
        points if mu_k == points => format!("{points} points: 2 to {MOST_POINTS} are needed"),
        _ => format!(
            "{speeds} speeds and {mu_k} values of mu_k: as many of each are needed, 2 to \
             {MOST_POINTS}"
        ),
    }
}

/// One cubic of a table: Σ c_k w^k, w = (v − from)/width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The speed at which it begins.
    pub from: f64,
    /// The distance to the speed at which it ends; for a constant, the width of the cubic beside
    /// it.
    pub width: f64,
    /// Its coefficients, dimensionless.
    pub c: [f64; 4],
}

impl Piece {
    fn value(&self, speed: f64) -> f64 {
        let w = (speed - self.from) / self.width;
        let [c0, c1, c2, c3] = self.c;
        c0 + w * (c1 + w * (c2 + w * c3))
    }

    fn slope(&self, speed: f64) -> f64 {
        let w = (speed - self.from) / self.width;
        let [_, c1, c2, c3] = self.c;
        (c1 + w * (2.0 * c2 + w * 3.0 * c3)) / self.width
    }
}

impl Table {
    /// The curve through the points (`speeds`\[i\], `mu_k`\[i\]): length/time, and dimensionless.
    ///
    /// # Errors
    /// 2 to [`MOST_POINTS`] points; speeds 0 or between 10⁻¹² and 10¹², increasing, neighbours more
    /// than 10⁻⁶ of the larger one apart; μ_K between 10⁻¹² and 10¹².
    pub fn new(speeds: Vec<f64>, mu_k: Vec<f64>) -> Result<Self, TableError> {
        let counts = (speeds.len(), mu_k.len());
        if counts.0 != counts.1 || !(2..=MOST_POINTS).contains(&counts.0) {
            let (speeds, mu_k) = counts;
            return Err(TableError::Count { speeds, mu_k });
        }
        check_speeds(&speeds)?;
        let allowed = "greater than 0, between 1e-12 and 1e12";
        check(TableColumn::MuK, &mu_k, allowed, |mu| SIZES.contains(&mu))?;
        let slopes = slopes(&speeds, &mu_k);
        Ok(Self(Arc::new(Points {
            speeds,
            mu_k,
            slopes,
        })))
    }

    /// The speeds of the points, increasing.
    #[must_use]
    pub fn speeds(&self) -> &[f64] {
        &self.0.speeds
    }

    /// μ_K at the points.
    #[must_use]
    pub fn mu_k(&self) -> &[f64] {
        &self.0.mu_k
    }

    /// μ_K at `speed` ≥ 0.
    #[must_use]
    pub fn value(&self, speed: f64) -> f64 {
        match self.region(speed) {
            Ok(point) => self.0.mu_k[point],
            Err(region) => self.piece(region).value(speed),
        }
    }

    /// μ_K′ at `speed` ≥ 0.
    #[must_use]
    pub fn slope(&self, speed: f64) -> f64 {
        match self.region(speed) {
            Ok(point) => self.0.slopes[point],
            Err(region) => self.piece(region).slope(speed),
        }
    }

    /// The index of the point at `speed`.
    ///
    /// # Errors
    /// If no point is at `speed`: the region that holds it, for [`Table::piece`], as the number of
    /// points below.
    pub fn region(&self, speed: f64) -> Result<usize, usize> {
        self.0.speeds.binary_search_by(|at| at.total_cmp(&speed))
    }

    /// The cubic between points `region` − 1 and `region`; constants before the first and after the
    /// last point.
    #[must_use]
    pub fn piece(&self, region: usize) -> Piece {
        let Points {
            speeds,
            mu_k,
            slopes,
        } = &*self.0;
        let last = speeds.len() - 1;
        if region == 0 || region > last {
            let (at, beside) = if region == 0 { (0, 1) } else { (last, last) };
            return Piece {
                from: speeds[at],
                width: speeds[beside] - speeds[beside - 1],
                c: [mu_k[at], 0.0, 0.0, 0.0],
            };
        }
        let (i, j) = (region - 1, region);
        let width = speeds[j] - speeds[i];
        let rise = mu_k[j] - mu_k[i];
        let (from, to) = (slopes[i] * width, slopes[j] * width);
        Piece {
            from: speeds[i],
            width,
            c: [
                mu_k[i],
                from,
                3.0 * rise - 2.0 * from - to,
                from + to - 2.0 * rise,
            ],
        }
    }
}

/// Checks that `allowed_when` holds for every value.
fn check(
    column: TableColumn,
    values: &[f64],
    allowed: &'static str,
    allowed_when: impl Fn(f64) -> bool,
) -> Result<(), TableError> {
    let wrong = |value: &f64| !allowed_when(*value);
    match values.iter().position(wrong) {
        Some(index) => Err(TableError::Value {
            column,
            index,
            value: values[index],
            allowed,
        }),
        None => Ok(()),
    }
}

fn check_speeds(speeds: &[f64]) -> Result<(), TableError> {
    let allowed = "0, or between 1e-12 and 1e12";
    check(TableColumn::Speeds, speeds, allowed, |speed| {
        speed == 0.0 || SIZES.contains(&speed)
    })?;
    let near = |pair: &[f64]| pair[1] - pair[0] <= NEAREST * pair[1];
    match speeds.windows(2).position(near) {
        Some(before) => Err(TableError::Value {
            column: TableColumn::Speeds,
            index: before + 1,
            value: speeds[before + 1],
            allowed: "speeds increase, each by more than a part in 1e6 of it",
        }),
        None => Ok(()),
    }
}

/// The slopes at the points.
fn slopes(speeds: &[f64], mu_k: &[f64]) -> Vec<f64> {
    let differences = |values: &[f64]| values.windows(2).map(|v| v[1] - v[0]).collect::<Vec<_>>();
    let widths = differences(speeds);
    let rises = differences(mu_k);
    let secants: Vec<f64> = rises.iter().zip(&widths).map(|(r, h)| r / h).collect();
    let Some(last) = secants.len().checked_sub(1).filter(|&last| last > 0) else {
        return vec![secants[0]; 2];
    };
    let inner = (1..=last).map(|i| {
        let (before, after) = (secants[i - 1], secants[i]);
        if before == 0.0 || after == 0.0 || before.signum() != after.signum() {
            return 0.0;
        }
        let weights = (
            2.0 * widths[i] + widths[i - 1],
            widths[i] + 2.0 * widths[i - 1],
        );
        (weights.0 + weights.1) / (weights.0 / before + weights.1 / after)
    });
    let first = end_slope([widths[0], widths[1]], [secants[0], secants[1]]);
    let end = end_slope(
        [widths[last], widths[last - 1]],
        [secants[last], secants[last - 1]],
    );
    std::iter::once(first)
        .chain(inner)
        .chain(std::iter::once(end))
        .collect()
}

/// The slope at an end, from the widths and secants of the nearest piece and the next one.
fn end_slope([h, next_h]: [f64; 2], [secant, next]: [f64; 2]) -> f64 {
    let slope = ((2.0 * h + next_h) * secant - h * next) / (h + next_h);
    if slope * secant <= 0.0 {
        0.0
    } else if secant * next <= 0.0 && slope.abs() > 3.0 * secant.abs() {
        3.0 * secant
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Points with speeds `widths` apart.
    fn table(first: f64, widths: &[f64], mu_k: &[f64]) -> Table {
        let mut speeds = vec![first];
        for (width, _) in widths.iter().zip(&mu_k[1..]) {
            speeds.push(speeds[speeds.len() - 1] + width);
        }
        Table::new(speeds, mu_k[..=widths.len()].to_vec()).unwrap()
    }

    fn points() -> impl Strategy<Value = Table> {
        let many = prop::collection::vec((0.01..2.0_f64, 0.1..1.0_f64), 1..12);
        (prop_oneof![Just(0.0), 0.0..1.0_f64], 0.1..1.0_f64, many).prop_map(
            |(first, mu, rest): (f64, f64, Vec<(f64, f64)>)| {
                let widths: Vec<f64> = rest.iter().map(|p| p.0).collect();
                let mu_k: Vec<f64> = std::iter::once(mu)
                    .chain(rest.iter().map(|p| p.1))
                    .collect();
                table(first, &widths, &mu_k)
            },
        )
    }

    proptest! {
        #[test]
        fn it_goes_through_its_points_and_is_monotone_between(table in points()) {
            let (speeds, mu_k) = (table.speeds(), table.mu_k());
            for (i, (&v, &mu)) in speeds.iter().zip(mu_k).enumerate() {
                prop_assert_eq!(table.value(v), mu);
                let Some((&next, &mu_next)) = speeds.get(i + 1).zip(mu_k.get(i + 1)) else { break };
                let up = (mu_next - mu).signum();
                let mut before = mu;
                for k in 1..=64 {
                    let at = v + (next - v) * f64::from(k) / 64.0;
                    let value = table.value(at);
                    prop_assert!(up * (value - before) >= -1e-14, "{at}");
                    prop_assert!(up * table.slope(at) >= -1e-12 / (next - v), "{at}");
                    before = value;
                }
            }
        }

        #[test]
        fn value_and_slope_are_continuous(table in points()) {
            for (i, &v) in table.speeds().iter().enumerate() {
                let (left, right) = (table.piece(i), table.piece(i + 1));
                prop_assert!((left.value(v) - right.value(v)).abs() < 1e-13);
                // At the first and the last point the slope jumps to that of the constant.
                if i > 0 && i + 1 < table.speeds().len() {
                    let scale = 1.0 / left.width + 1.0 / right.width;
                    prop_assert!((left.slope(v) - right.slope(v)).abs() < 1e-13 * scale);
                }
            }
        }

        #[test]
        fn slopes_are_the_derivatives_of_the_values(table in points(), v in 0.0..10.0_f64) {
            let h = 1e-6;
            let near = table.speeds().iter().any(|at| (at - v).abs() < 2.0 * h);
            prop_assume!(!near && v > h);
            let numeric = (table.value(v + h) - table.value(v - h)) / (2.0 * h);
            prop_assert!((numeric - table.slope(v)).abs() < 1e-5);
        }

        #[test]
        fn a_straight_line_is_reproduced(
            widths in prop::collection::vec(0.01..2.0_f64, 1..12),
            (from, slope) in (0.3..1.0_f64, -0.01..0.3_f64),
            part in 0.0..1.0_f64,
        ) {
            let mut at = 0.0;
            let mut mu_k = vec![from];
            for width in &widths {
                at += width;
                mu_k.push(from + slope * at);
            }
            let table = table(0.0, &widths, &mu_k);
            let v = part * at;
            prop_assert!((table.value(v) - from - slope * v).abs() < 1e-14 * (1.0 + at));
            prop_assert!((table.slope(v) - slope).abs() < 1e-12);
        }
    }

    /// Widths 1, 2, 1, secants −0.4, −0.05, 0.3: the slopes by hand.
    #[test]
    fn the_slopes_are_those_of_pchip() {
        let table = table(0.5, &[1.0, 2.0, 1.0], &[1.0, 0.6, 0.5, 0.8]);
        let slopes = [
            // (4·(−0.4) + 0.05)/3: it has the secant's sign and is below 3 times its size.
            -1.55 / 3.0,
            // (5 + 4)/(5/(−0.4) + 4/(−0.05)).
            -9.0 / 92.5,
            0.0,
            // (4·0.3 + 0.05)/3.
            1.25 / 3.0,
        ];
        for (v, slope) in table.speeds().iter().zip(slopes) {
            assert!((table.slope(*v) - slope).abs() < 1e-15, "{v}");
        }
        // Constant outside.
        assert_eq!((table.value(0.1), table.slope(0.1)), (1.0, 0.0));
        assert_eq!((table.value(9.0), table.slope(9.0)), (0.8, 0.0));
    }

    #[test]
    fn bad_points_are_named() {
        let wrong =
            |speeds: &[f64], mu_k: &[f64]| Table::new(speeds.to_vec(), mu_k.to_vec()).unwrap_err();
        let count = |error| matches!(error, TableError::Count { .. });
        assert!(count(wrong(&[0.0], &[0.5])));
        assert!(count(wrong(&[0.0, 1.0], &[0.5])));
        assert!(count(wrong(&vec![0.0; 5000], &vec![0.5; 5000])));
        for (speeds, mu_k, at) in [
            ([0.0, 1.0, 1.0], [0.5; 3], (TableColumn::Speeds, 2)),
            ([-1.0, 1.0, 2.0], [0.5; 3], (TableColumn::Speeds, 0)),
            ([0.0, f64::NAN, 2.0], [0.5; 3], (TableColumn::Speeds, 1)),
            (
                [0.0, 1.0, f64::INFINITY],
                [0.5; 3],
                (TableColumn::Speeds, 2),
            ),
            ([0.0, 1.0, 1.0 + 1e-7], [0.5; 3], (TableColumn::Speeds, 2)),
            ([0.0, 1.0, 2.0], [0.5, 0.0, 0.5], (TableColumn::MuK, 1)),
            ([0.0, 1.0, 2.0], [0.5, 0.5, f64::NAN], (TableColumn::MuK, 2)),
        ] {
            match wrong(&speeds, &mu_k) {
                TableError::Value { column, index, .. } => assert_eq!((column, index), at),
                other @ TableError::Count { .. } => panic!("{other}"),
            }
        }
    }
}
