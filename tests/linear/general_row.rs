//! Rows of cells of general systems: each cell as a single delay says, and margins as the stable
//! delays say.

use crate::general_rows::{degenerate, with_latency, without_latency};
use slipmap::linear::MarginalTolerance;
use slipmap::linear::general::{DelayLine, Reason, System};
use slipmap::linear::row::Delays;
use slipmap::linear::stable_delays::StableInterval;
use slipmap::linear::status::{MARGINAL, MOST_COUNTED, NOT_CONVERGED, NOT_COUNTED, SATURATED};

fn systems() -> Vec<(String, System)> {
    let all = without_latency()
        .into_iter()
        .chain(with_latency())
        .chain(degenerate());
    all.map(|(row, system)| (row.place, system)).collect()
}

/// What a cell of the row has to be.
fn expected(line: &DelayLine, tau: f64) -> (u16, u8) {
    if line.uncounted && tau > 0.0 {
        let infinite = line.reason == Some(Reason::Infinite);
        return (
            NOT_COUNTED,
            if infinite { SATURATED } else { NOT_CONVERGED },
        );
    }
    let count = line.count(tau, MarginalTolerance::default());
    let most = u64::from(MOST_COUNTED);
    let marginal = if count.marginal { MARGINAL } else { 0 };
    let saturated = if count.n_unstable > most {
        SATURATED
    } else {
        0
    };
    (count.n_unstable.min(most) as u16, marginal | saturated)
}

fn check(line: &DelayLine, delays: &[f64], place: &str) -> usize {
    let (mut n, mut status) = (vec![9; delays.len()], vec![0; delays.len()]);
    let tolerance = MarginalTolerance::default();
    let flagged = line.fill_counts(&Delays::new(delays), tolerance, &mut n, &mut status);
    assert_eq!(flagged, status.iter().any(|&s| s != 0), "{place}");
    for ((&tau, &n), &status) in delays.iter().zip(&n).zip(&status) {
        // A refused line has no count without delay either.
        if line.uncounted && tau == 0.0 && line.reason != Some(Reason::Infinite) {
            assert_eq!((n, status), (NOT_COUNTED, NOT_CONVERGED), "{place}");
        } else {
            assert_eq!((n, status), expected(line, tau), "{place} {tau}\n{line:?}");
        }
    }
    status.iter().filter(|&&s| s & MARGINAL != 0).count()
}

#[test]
fn rows_are_their_cells() {
    let (mut lines, mut marginal) = (0, 0);
    for (place, system) in systems() {
        let line = DelayLine::of(&system);
        let mut rows: Vec<Vec<f64>> = [(0.0, 30.0, 200), (0.0, 1e4, 50), (3.0, 9.0, 1000)]
            .iter()
            .map(|&(from, to, points)| {
                let step = (to - from) / f64::from(points);
                (0..points).map(|i| from + step * f64::from(i)).collect()
            })
            .collect();
        rows.push(rows[0].iter().map(|t| t * t).collect());
        rows.push(vec![0.7]);
        let mut on_crossings: Vec<f64> = line
            .crossings
            .iter()
            .flat_map(|c| (0..20).map(|k| c.delay(k + c.first_branch)))
            .collect();
        on_crossings.sort_by(f64::total_cmp);
        on_crossings.dedup();
        if !on_crossings.is_empty() {
            rows.push(on_crossings);
        }
        for row in &rows {
            marginal += check(&line, row, &place);
        }
        // The same line with its delays in other units.
        let unit = 0.37;
        let scaled: Vec<f64> = rows[0].iter().map(|t| t * unit).collect();
        check(&line.in_physical_time(unit), &scaled, &place);
        lines += 1;
    }
    assert!(lines > 500 && marginal > 5000, "{lines} {marginal}");
}

/// By looking through all intervals.
fn slow_margin(line: &DelayLine, tau: f64) -> f64 {
    if line.uncounted {
        return f64::NAN;
    }
    if line.always_marginal {
        return 0.0;
    }
    let mut apart = f64::INFINITY;
    for StableInterval { from, to } in line.stable_intervals().take(10_000) {
        if from < tau && tau <= to || (from == 0.0 && tau == 0.0) {
            let below = if from == 0.0 {
                f64::INFINITY
            } else {
                tau - from
            };
            return below.min(to - tau);
        }
        apart = apart.min(if tau <= from { from - tau } else { tau - to });
        if from > tau {
            break;
        }
    }
    -apart
}

#[test]
fn margins_are_distances_to_stable_delays() {
    let (mut stable, mut unstable) = (0, 0);
    for (place, system) in systems() {
        let line = DelayLine::of(&system);
        let delays: Vec<f64> = (0..80).map(|i| 0.31 * f64::from(i)).collect();
        let mut margins = vec![9.0; delays.len()];
        line.fill_delay_margins(&Delays::new(&delays), &mut margins);
        for (&tau, &margin) in delays.iter().zip(&margins) {
            let slow = slow_margin(&line, tau);
            let same = margin == slow || margin.is_nan() && slow.is_nan();
            assert!(same, "{place} {tau}: {margin} {slow}\n{line:?}");
            let alone = line.delay_margin(tau);
            assert!(alone.to_bits() == margin.to_bits(), "{place} {tau}");
            stable += usize::from(margin > 0.0);
            unstable += usize::from(margin < 0.0);
        }
    }
    assert!(stable > 5000 && unstable > 5000, "{stable} {unstable}");
}
