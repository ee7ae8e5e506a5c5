use super::*;
use crate::linear::certificate::roots_right_of;
use crate::linear::characteristic::Jet;
use crate::linear::lobes::LobeControl;
use crate::model::{Dashpots, Groups};
use num_complex::Complex64;

const SLOPES: [f64; 5] = [-0.05, -0.1, -0.3, -0.5, -0.7];

fn velocity(b: f64) -> Search<Letter> {
    Search {
        family: Letter {
            dashpots: Dashpots::default(),
            fixed: Groups::new(b, 0.0, 0.0),
            gain: SearchedGain::Velocity,
        },
        p: (-2.0, 1.0),
        q: (0.0, 25.0),
    }
}

fn load(b: f64) -> Search<Letter> {
    let of = velocity(b);
    Search {
        family: Letter {
            gain: SearchedGain::Load,
            ..of.family
        },
        p: (-8.0, 1.0),
        ..of
    }
}

fn searches() -> impl Iterator<Item = Search<Letter>> {
    SLOPES.into_iter().flat_map(|b| [velocity(b), load(b)])
}

fn value(search: &Search<Letter>, gain: f64, tau: f64) -> f64 {
    Evaluator::default().abscissa(search, Place { p: gain, q: tau })
}

/// No place around any optimum, at any scale and in any direction, is better.
#[test]
fn nothing_around_an_optimum_is_better() {
    for search in searches() {
        for Region {
            best,
            p: gains,
            q: delays,
            ..
        } in best(&search, &Stop::default()).regions
        {
            assert!(best.certified, "{search:?} {best:?}");
            let (width, height) = (gains.1 - gains.0, delays.1 - delays.0);
            for scale in 2..14 {
                for step in 0..64 {
                    let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 64.0).sin_cos();
                    let size = 0.1_f64.powi(scale);
                    let (gain, tau) = (best.p + size * width * cos, best.q + size * height * sin);
                    let there = value(&search, gain, tau);
                    assert!(
                        there >= best.abscissa - best.margin,
                        "{best:?} {gain} {tau} {there}"
                    );
                }
            }
        }
    }
}

/// A grid that is zoomed in around its best cell, on the box of a region alone.
fn zoomed(search: &Search<Letter>, region: &Region) -> (f64, f64, f64) {
    const CELLS: i32 = 40;
    let mut centre = (f64::NAN, f64::NAN, f64::INFINITY);
    let (mut from, mut size) = (
        (region.p.0, region.q.0),
        (region.p.1 - region.p.0, region.q.1 - region.q.0),
    );
    for _ in 0..16 {
        for i in 0..=CELLS {
            for j in 0..=CELLS {
                let gain = from.0 + size.0 * f64::from(i) / f64::from(CELLS);
                let tau = (from.1 + size.1 * f64::from(j) / f64::from(CELLS)).max(0.0);
                let there = value(search, gain, tau);
                if there < centre.2 {
                    centre = (gain, tau, there);
                }
            }
        }
        size = (0.35 * size.0, 0.35 * size.1);
        from = (centre.0 - 0.5 * size.0, centre.1 - 0.5 * size.1);
    }
    centre
}

/// The first region, whose optimum is that of the whole box, against a search that shares nothing
/// with it.
#[test]
fn optima_agree_with_a_zoom_by_brute_force() {
    for search in searches() {
        let region = &best(&search, &Stop::default()).regions[0];
        let (gain, tau, abscissa) = zoomed(&search, region);
        let found = &region.best;
        // At a root of multiplicity m the abscissa rises like the distance to the power 1/m, and
        // the zoom sees no deeper.
        let (value, place) = match found.kind {
            Kind::TripleReal => (0.05, 0.3),
            _ => (2e-3, 1e-3),
        };
        let apart = abscissa - found.abscissa;
        assert!(
            (-found.margin..value).contains(&apart),
            "{found:?} {abscissa}"
        );
        assert!(
            (gain - found.p).abs() < place && (tau - found.q).abs() < place,
            "{found:?} {gain} {tau}"
        );
    }
}

#[test]
fn optima_are_at_least_as_good_as_a_fine_grid() {
    for search in searches() {
        let found = best(&search, &Stop::default()).overall;
        let points = if search.family.fixed.b == -0.3 {
            400
        } else {
            100
        };
        let on = |(from, to): (f64, f64), i: i32| {
            from + (to - from) * f64::from(i) / f64::from(points - 1)
        };
        let mut finder = Evaluator::default();
        for i in 0..points {
            for j in 0..points {
                let place = Place {
                    p: on(search.p, i),
                    q: on((0.0, 8.0), j),
                };
                assert!(finder.abscissa(&search, place) >= found.abscissa - found.margin);
            }
        }
    }
}

/// What the kinds say holds: derivatives of D vanish to rounding, and the certificate finds nothing
/// to the right.
#[test]
fn kinds_are_what_they_say() {
    for search in searches() {
        for Region { best, .. } in best(&search, &Stop::default()).regions {
            let groups = search.family.groups(best.p);
            let lambda = Complex64::new(best.abscissa, best.frequency());
            let jet = Jet::at(groups, best.q, lambda);
            let rounding = 64.0 * jet.rounding(groups, best.q, lambda);
            assert!(
                jet.value.norm() < rounding && jet.first.norm() < 10.0 * rounding,
                "{best:?} {jet:?}"
            );
            match best.kind {
                Kind::DoublePair => assert!(best.frequency() > 0.0),
                Kind::TripleReal => {
                    assert!(best.frequency() == 0.0 && jet.second.norm() < 10.0 * rounding);
                }
                _ => panic!("{best:?}"),
            }
            assert_eq!(
                roots_right_of(groups, best.q, best.abscissa + 0.02),
                Some(0)
            );
        }
    }
}

/// D = D′ = D″ = 0 for load control, solved by hand: λ = −b/2 − 1/τ, a_n E = −2/τ², and D = 0 gives
/// a_n; what is left is one equation for τ.
#[test]
fn the_triple_root_of_load_control_is_that_of_a_scalar_equation() {
    for b in SLOPES {
        let found = best(&load(b), &Stop::default()).overall;
        assert_eq!(found.kind, Kind::TripleReal, "{found:?}");
        let gain = |tau: f64| {
            let lambda = -0.5 * b - 1.0 / tau;
            (lambda, lambda * (lambda + b) + 1.0 - 2.0 / (tau * tau))
        };
        let left = |tau: f64| {
            let (lambda, a_n) = gain(tau);
            a_n * (-lambda * tau).exp() + 2.0 / (tau * tau)
        };
        let tau = crate::linear::roots::bisect(0.9 * found.q, 1.1 * found.q, left);
        let (lambda, a_n) = gain(tau);
        assert!(
            (tau - found.q).abs() < 1e-12 && (a_n - found.p).abs() < 1e-11,
            "{found:?} {tau}"
        );
        assert!((lambda - found.abscissa).abs() < 1e-11);
    }
}

/// The letter: "stable regions at larger τ relax more slowly". In numbers, at b = −0.05 and
/// velocity control, relaxation times 3.033, 8.875, 16.269, 25.592 (double pairs, D = D′ = 0 by
/// mpmath); lobes of positive and of negative load gain each keep this order, and so do all
/// together.
#[test]
fn lobes_relax_more_slowly_at_larger_delays() {
    for search in searches() {
        let regions = best(&search, &Stop::default()).regions;
        let times: Vec<f64> = regions
            .iter()
            .filter_map(|r| r.best.relaxation_time())
            .collect();
        assert_eq!(times.len(), regions.len());
        assert!(times.is_sorted(), "{search:?} {times:?}");
    }
    let times: Vec<f64> = best(&velocity(-0.05), &Stop::default())
        .regions
        .iter()
        .filter_map(|r| r.best.relaxation_time())
        .collect();
    for (found, expected) in times.iter().zip([3.033, 8.875, 16.269, 25.592]) {
        assert!((found - expected).abs() < 1e-3, "{times:?}");
    }
    assert_eq!(times.len(), 4);
}

/// Lobes of velocity control up to where they end, however small they are there.
#[test]
fn tiny_lobes_are_found() {
    let end = LobeControl::Velocity { damping: 0.0 }.lobe_end(0);
    for by in [0.0256, 1e-3, 1e-5] {
        let search = velocity(end.b + by);
        let found = best(&search, &Stop::default());
        assert_eq!(found.regions.len(), 1, "{by}");
        let best = &found.regions[0].best;
        assert!(best.abscissa < 0.0 && best.certified, "{best:?}");
        assert!(
            (best.q - end.tau).abs() < 4.0 * by.sqrt() && (best.p - end.gain).abs() < by,
            "{best:?}"
        );
    }
    assert!(
        best(&velocity(end.b - 1e-5), &Stop::default())
            .regions
            .is_empty()
    );
}

#[test]
fn boxes_without_stable_settings_give_the_least_unstable_one() {
    for search in [
        Search {
            p: (0.1, 1.0),
            ..velocity(-0.3)
        },
        Search {
            p: (-0.2, 0.2),
            ..load(-0.5)
        },
        velocity(-1.5),
    ] {
        let Best {
            overall, regions, ..
        } = best(&search, &Stop::default());
        assert!(regions.is_empty() && overall.abscissa > 0.0, "{overall:?}");
        assert_eq!(overall.relaxation_time(), None);
        for step in 0..64 {
            let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 64.0).sin_cos();
            for size in [0.1, 1e-2, 1e-4] {
                let place = search.clamp(Place {
                    p: overall.p + size * cos,
                    q: overall.q + size * sin,
                });
                let there = Evaluator::default().abscissa(&search, place);
                assert!(
                    there >= overall.abscissa - overall.margin,
                    "{overall:?} {place:?} {there}"
                );
            }
        }
    }
}

/// Lines and points instead of boxes: the optimum on what is left.
#[test]
fn degenerate_boxes() {
    let line = Search {
        p: (-0.3, -0.3),
        q: (3.0, 5.0),
        ..velocity(-0.3)
    };
    let along = best(&line, &Stop::default()).overall;
    assert_eq!((along.p, along.kind), (-0.3, Kind::Edge));
    for i in 0..=2000 {
        assert!(value(&line, -0.3, 3.0 + f64::from(i) * 1e-3) >= along.abscissa - along.margin);
    }
    let across = best(
        &Search {
            p: (-1.0, 0.0),
            q: (4.0, 4.0),
            ..velocity(-0.3)
        },
        &Stop::default(),
    )
    .overall;
    assert_eq!((across.q, across.kind), (4.0, Kind::Edge));
    for i in 0..=1000 {
        assert!(value(&line, f64::from(i) * -1e-3, 4.0) >= across.abscissa - across.margin);
    }
    let point = best(
        &Search {
            p: (-0.3, -0.3),
            q: (4.0, 4.0),
            ..velocity(-0.3)
        },
        &Stop::default(),
    )
    .overall;
    assert_eq!((point.p, point.q, point.kind), (-0.3, 4.0, Kind::Edge));
    assert_eq!(point.abscissa, value(&line, -0.3, 4.0));
    let no_delay = best(
        &Search {
            q: (0.0, 0.0),
            ..velocity(0.2)
        },
        &Stop::default(),
    )
    .overall;
    assert!((no_delay.abscissa + 0.1).abs() < 1e-12, "{no_delay:?}");
}

/// Without weakening, and at its edge, sliding is stable without control; the best setting is still
/// a multiple root.
#[test]
fn friction_that_does_not_weaken() {
    for search in [velocity(0.0), load(0.0), velocity(0.2), load(0.2)] {
        let Best {
            overall, regions, ..
        } = best(&search, &Stop::default());
        assert!(!regions.is_empty());
        assert!(
            matches!(overall.kind, Kind::DoublePair | Kind::TripleReal),
            "{overall:?}"
        );
        assert!(overall.abscissa < -0.5 * search.family.fixed.b && overall.certified);
    }
}

/// Both gains at once: one fixed, the other searched.
#[test]
fn the_other_gain_may_act_too() {
    for (fixed, gain) in [
        (Groups::new(-0.4, 0.0, -0.5), SearchedGain::Velocity),
        (Groups::new(-0.4, -0.3, 0.0), SearchedGain::Load),
        (Groups::new(-0.2, 0.5, 0.0), SearchedGain::Load),
    ] {
        let search = Search {
            family: Letter {
                fixed,
                dashpots: Dashpots::default(),
                gain,
            },
            p: (-3.0, 3.0),
            q: (0.0, 15.0),
        };
        let found = best(&search, &Stop::default());
        assert!(!found.regions.is_empty());
        for Region { best, .. } in &found.regions {
            assert!(best.certified && best.abscissa < 0.0, "{best:?}");
        }
    }
}

/// Strong velocity control beside load control: a real root is double along a valley that falls
/// slowly all the way to the edge, and along which a search without knowledge of it gets stuck.
#[test]
fn a_valley_of_double_roots_is_followed_to_the_edge() {
    let search = Search {
        family: Letter {
            dashpots: Dashpots::default(),
            fixed: Groups::new(0.173_932_752, -0.915_096_374, 0.0),
            gain: SearchedGain::Load,
        },
        p: (-10.0, 5.0),
        q: (0.0, 25.0),
    };
    let found = best(&search, &Stop::default()).overall;
    assert_eq!((found.p, found.kind), (-10.0, Kind::Edge), "{found:?}");
    assert!(
        (found.abscissa - -0.9944).abs() < 1e-4 && found.certified,
        "{found:?}"
    );
}

/// The smallest abscissa of a box by two nested searches in one dimension each: over the delay,
/// from every lowest place among many, and over the gain. Walls of valleys are crossed, not
/// followed, so it does not matter what makes an optimum.
fn nested(search: &Search<Letter>, gains: usize, delays: usize) -> (f64, f64, f64) {
    let spread =
        |(from, to): (f64, f64), i: usize, n: usize| from + (to - from) * (i as f64 / n as f64);
    let mut evaluator = Evaluator::default();
    let mut at_gain = |gain: f64, around: Option<(f64, f64)>| -> (f64, f64) {
        let range = around.unwrap_or(search.q);
        let mut at = |tau: f64| evaluator.abscissa(search, search.clamp(Place { p: gain, q: tau }));
        let values: Vec<f64> = (0..=delays).map(|j| at(spread(range, j, delays))).collect();
        let mut best = (f64::NAN, f64::INFINITY);
        for j in 0..=delays {
            let lowest = values[j.saturating_sub(1)..=(j + 1).min(delays)]
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min);
            if values[j] > lowest {
                continue;
            }
            let found = golden(
                spread(range, j.saturating_sub(1), delays),
                spread(range, (j + 1).min(delays), delays),
                &mut at,
            );
            if found.1 < best.1 {
                best = found;
            }
        }
        best
    };
    let rows: Vec<(f64, f64)> = (0..=gains)
        .map(|i| at_gain(spread(search.p, i, gains), None))
        .collect();
    let mut best = (f64::NAN, f64::NAN, f64::INFINITY);
    for i in 0..=gains {
        let (low, high) = (i.saturating_sub(1), (i + 1).min(gains));
        if rows[low..=high].iter().any(|r| r.1 < rows[i].1) {
            continue;
        }
        let taus: Vec<f64> = rows[low..=high].iter().map(|r| r.0).collect();
        let (from, to) = (
            taus.iter().copied().fold(f64::INFINITY, f64::min),
            taus.iter().copied().fold(0.0, f64::max),
        );
        let pad = 2.0 * (search.q.1 - search.q.0) / delays as f64;
        let range = ((from - pad).max(search.q.0), (to + pad).min(search.q.1));
        let (gain, value) = golden(
            spread(search.p, low, gains),
            spread(search.p, high, gains),
            &mut |gain| at_gain(gain, Some(range)).1,
        );
        if value < best.2 {
            best = (gain, at_gain(gain, Some(range)).0, value);
        }
    }
    best
}

/// The lowest place between `from` and `to` of a function with one minimum there, and the value.
fn golden(mut from: f64, mut to: f64, at: &mut impl FnMut(f64) -> f64) -> (f64, f64) {
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut best = (from, at(from));
    let mut seen = |x: f64| {
        let value = at(x);
        if value < best.1 {
            best = (x, value);
        }
        value
    };
    seen(to);
    let (mut p, mut q) = (to - part * (to - from), from + part * (to - from));
    let (mut at_p, mut at_q) = (seen(p), seen(q));
    for _ in 0..60 {
        if at_p <= at_q {
            (to, q, at_q) = (q, p, at_p);
            p = to - part * (to - from);
            at_p = seen(p);
        } else {
            (from, p, at_p) = (p, q, at_q);
            q = from + part * (to - from);
            at_q = seen(q);
        }
    }
    best
}

/// A box by chance: all signs of b, the other gain acting, edges anywhere.
fn by_chance(number: u64) -> Search<Letter> {
    let mut state = number.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d;
    let mut chance = move |from: f64, to: f64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        from + (to - from) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    for _ in 0..8 {
        chance(0.0, 1.0);
    }
    // A third of them where valleys of double real roots have places at rest.
    let valley = chance(0.0, 1.0) < 0.33;
    let gain = match valley || chance(0.0, 1.0) < 0.5 {
        true => SearchedGain::Load,
        false => SearchedGain::Velocity,
    };
    let other = if valley {
        chance(-0.8, -0.4)
    } else {
        chance(-1.2, 1.2)
    };
    let b = if valley {
        chance(-1.4, -0.8)
    } else {
        chance(-1.2, 0.4)
    };
    let (low, high) = match gain {
        SearchedGain::Velocity => (chance(-3.0, 0.0), chance(-1.0, 1.0)),
        SearchedGain::Load => (chance(-8.0, 0.0), chance(-2.0, 3.0)),
    };
    Search {
        family: Letter {
            dashpots: Dashpots::default(),
            fixed: match gain {
                SearchedGain::Velocity => Groups::new(b, 0.0, other),
                SearchedGain::Load => Groups::new(b, other, 0.0),
            },
            gain,
        },
        p: (low.min(high), low.max(high)),
        q: (0.0, chance(0.5, 15.0)),
    }
}

/// Boxes by chance; in the first one the search once ended at a place at rest.
#[test]
fn optima_of_boxes_by_chance_agree_with_nested_searches() {
    for number in 180..204 {
        let search = by_chance(number);
        let found = best(&search, &Stop::default()).overall;
        let (gain, tau, lowest) = nested(&search, 60, 100);
        assert!(
            found.certified && found.abscissa <= lowest + found.margin + 1e-7,
            "{number} {search:?}: {found:?}, but {lowest} at {gain} {tau}"
        );
    }
}

/// A box in which the curve of double real roots has a place at rest that is no optimum: there the
/// search used to end. The abscissa by a program that shares nothing with this one.
#[test]
fn a_place_at_rest_is_no_optimum_where_the_valley_falls_from_it() {
    let search = Search {
        family: Letter {
            dashpots: Dashpots::default(),
            fixed: Groups::new(-1.085_950_199_932_85, -0.562_008_325_737_243_9, 0.0),
            gain: SearchedGain::Load,
        },
        p: (-5.307_106_585_327_528, -1.353_852_600_002_571),
        q: (0.0, 12.481_464_154_198_896),
    };
    let found = best(&search, &Stop::default()).overall;
    assert!((found.abscissa - -1.803_408_08).abs() < 1e-7, "{found:?}");
}
