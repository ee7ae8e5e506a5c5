use super::*;
use crate::linear::certificate::roots_right_of;
use crate::linear::characteristic::Jet;
use crate::linear::lobes::LobeControl;
use crate::model::Groups;
use num_complex::Complex64;

const SLOPES: [f64; 5] = [-0.05, -0.1, -0.3, -0.5, -0.7];

fn velocity(b: f64) -> Search {
    Search {
        fixed: Groups::new(b, 0.0, 0.0),
        gain: SearchedGain::Velocity,
        gains: (-2.0, 1.0),
        delays: (0.0, 25.0),
    }
}

fn load(b: f64) -> Search {
    Search {
        gain: SearchedGain::Load,
        gains: (-8.0, 1.0),
        ..velocity(b)
    }
}

fn searches() -> impl Iterator<Item = Search> {
    SLOPES.into_iter().flat_map(|b| [velocity(b), load(b)])
}

fn value(search: &Search, gain: f64, tau: f64) -> f64 {
    Evaluator::default().abscissa(search, Place { gain, tau })
}

/// No place around any optimum, at any scale and in any direction, is better.
#[test]
fn nothing_around_an_optimum_is_better() {
    for search in searches() {
        for Region {
            best,
            gains,
            delays,
        } in best(&search).regions
        {
            assert!(best.certified, "{search:?} {best:?}");
            let (width, height) = (gains.1 - gains.0, delays.1 - delays.0);
            for scale in 2..14 {
                for step in 0..64 {
                    let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 64.0).sin_cos();
                    let size = 0.1_f64.powi(scale);
                    let (gain, tau) = (
                        best.gain + size * width * cos,
                        best.tau + size * height * sin,
                    );
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
fn zoomed(search: &Search, region: &Region) -> (f64, f64, f64) {
    let mut centre = (f64::NAN, f64::NAN, f64::INFINITY);
    let (mut from, mut size) = (
        (region.gains.0, region.delays.0),
        (
            region.gains.1 - region.gains.0,
            region.delays.1 - region.delays.0,
        ),
    );
    const CELLS: i32 = 40;
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

/// The first region, whose optimum is that of the whole box, against a search that shares nothing with it.
#[test]
fn optima_agree_with_a_zoom_by_brute_force() {
    for search in searches() {
        let region = &best(&search).regions[0];
        let (gain, tau, abscissa) = zoomed(&search, region);
        let found = &region.best;
        // At a root of multiplicity m the abscissa rises like the distance to the power 1/m, and the zoom sees no deeper.
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
            (gain - found.gain).abs() < place && (tau - found.tau).abs() < place,
            "{found:?} {gain} {tau}"
        );
    }
}

#[test]
fn optima_are_at_least_as_good_as_a_fine_grid() {
    for search in searches() {
        let found = best(&search).overall;
        let points = if search.fixed.b == -0.3 { 400 } else { 100 };
        let on = |(from, to): (f64, f64), i: i32| {
            from + (to - from) * f64::from(i) / f64::from(points - 1)
        };
        let mut finder = Evaluator::default();
        for i in 0..points {
            for j in 0..points {
                let place = Place {
                    gain: on(search.gains, i),
                    tau: on((0.0, 8.0), j),
                };
                assert!(finder.abscissa(&search, place) >= found.abscissa - found.margin);
            }
        }
    }
}

/// What the kinds say holds: derivatives of D vanish to rounding, and the certificate finds nothing to the right.
#[test]
fn kinds_are_what_they_say() {
    for search in searches() {
        for Region { best, .. } in best(&search).regions {
            let groups = search.groups(best.gain);
            let lambda = Complex64::new(best.abscissa, best.frequency());
            let jet = Jet::at(groups, best.tau, lambda);
            let rounding = 64.0 * jet.rounding(groups, best.tau, lambda);
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
                roots_right_of(groups, best.tau, best.abscissa + 0.02),
                Some(0)
            );
        }
    }
}

/// D = D′ = D″ = 0 for load control, solved by hand: λ = −b/2 − 1/τ, a_n E = −2/τ², and D = 0 gives a_n; what is left is one
/// equation for τ.
#[test]
fn the_triple_root_of_load_control_is_that_of_a_scalar_equation() {
    for b in SLOPES {
        let found = best(&load(b)).overall;
        assert_eq!(found.kind, Kind::TripleReal, "{found:?}");
        let gain = |tau: f64| {
            let lambda = -0.5 * b - 1.0 / tau;
            (lambda, lambda * (lambda + b) + 1.0 - 2.0 / (tau * tau))
        };
        let left = |tau: f64| {
            let (lambda, a_n) = gain(tau);
            a_n * (-lambda * tau).exp() + 2.0 / (tau * tau)
        };
        let tau = crate::linear::roots::bisect(0.9 * found.tau, 1.1 * found.tau, left);
        let (lambda, a_n) = gain(tau);
        assert!(
            (tau - found.tau).abs() < 1e-12 && (a_n - found.gain).abs() < 1e-11,
            "{found:?} {tau}"
        );
        assert!((lambda - found.abscissa).abs() < 1e-11);
    }
}

/// The letter: "stable regions at larger τ relax more slowly". In numbers, at b = −0.05 and velocity control, relaxation times
/// 3.033, 8.875, 16.269, 25.592 (double pairs, D = D′ = 0 by mpmath); lobes of positive and of negative load gain each keep this order, and so do all together.
#[test]
fn lobes_relax_more_slowly_at_larger_delays() {
    for search in searches() {
        let regions = best(&search).regions;
        let times: Vec<f64> = regions
            .iter()
            .filter_map(|r| r.best.relaxation_time())
            .collect();
        assert_eq!(times.len(), regions.len());
        assert!(times.is_sorted(), "{search:?} {times:?}");
    }
    let times: Vec<f64> = best(&velocity(-0.05))
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
    let end = LobeControl::Velocity.lobe_end(0);
    for by in [0.0256, 1e-3, 1e-5] {
        let search = velocity(end.b + by);
        let found = best(&search);
        assert_eq!(found.regions.len(), 1, "{by}");
        let best = &found.regions[0].best;
        assert!(best.abscissa < 0.0 && best.certified, "{best:?}");
        assert!(
            (best.tau - end.tau).abs() < 4.0 * by.sqrt() && (best.gain - end.gain).abs() < by,
            "{best:?}"
        );
    }
    assert!(best(&velocity(end.b - 1e-5)).regions.is_empty());
}

#[test]
fn boxes_without_stable_settings_give_the_least_unstable_one() {
    for search in [
        Search {
            gains: (0.1, 1.0),
            ..velocity(-0.3)
        },
        Search {
            gains: (-0.2, 0.2),
            ..load(-0.5)
        },
        velocity(-1.5),
    ] {
        let Best {
            overall, regions, ..
        } = best(&search);
        assert!(regions.is_empty() && overall.abscissa > 0.0, "{overall:?}");
        assert_eq!(overall.relaxation_time(), None);
        for step in 0..64 {
            let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 64.0).sin_cos();
            for size in [0.1, 1e-2, 1e-4] {
                let place = search.clamp(Place {
                    gain: overall.gain + size * cos,
                    tau: overall.tau + size * sin,
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
        gains: (-0.3, -0.3),
        delays: (3.0, 5.0),
        ..velocity(-0.3)
    };
    let along = best(&line).overall;
    assert_eq!((along.gain, along.kind), (-0.3, Kind::Edge));
    for i in 0..=2000 {
        assert!(value(&line, -0.3, 3.0 + f64::from(i) * 1e-3) >= along.abscissa - along.margin);
    }
    let across = best(&Search {
        gains: (-1.0, 0.0),
        delays: (4.0, 4.0),
        ..velocity(-0.3)
    })
    .overall;
    assert_eq!((across.tau, across.kind), (4.0, Kind::Edge));
    for i in 0..=1000 {
        assert!(value(&line, f64::from(i) * -1e-3, 4.0) >= across.abscissa - across.margin);
    }
    let point = best(&Search {
        gains: (-0.3, -0.3),
        delays: (4.0, 4.0),
        ..velocity(-0.3)
    })
    .overall;
    assert_eq!((point.gain, point.tau, point.kind), (-0.3, 4.0, Kind::Edge));
    assert_eq!(point.abscissa, value(&line, -0.3, 4.0));
    let no_delay = best(&Search {
        delays: (0.0, 0.0),
        ..velocity(0.2)
    })
    .overall;
    assert!((no_delay.abscissa + 0.1).abs() < 1e-12, "{no_delay:?}");
}

/// Without weakening, and at its edge, sliding is stable without control; the best setting is still a multiple root.
#[test]
fn friction_that_does_not_weaken() {
    for search in [velocity(0.0), load(0.0), velocity(0.2), load(0.2)] {
        let Best {
            overall, regions, ..
        } = best(&search);
        assert!(!regions.is_empty());
        assert!(
            matches!(overall.kind, Kind::DoublePair | Kind::TripleReal),
            "{overall:?}"
        );
        assert!(overall.abscissa < -0.5 * search.fixed.b && overall.certified);
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
            fixed,
            gain,
            gains: (-3.0, 3.0),
            delays: (0.0, 15.0),
        };
        let found = best(&search);
        assert!(!found.regions.is_empty());
        for Region { best, .. } in &found.regions {
            assert!(best.certified && best.abscissa < 0.0, "{best:?}");
        }
    }
}

/// Strong velocity control beside load control: a real root is double along a valley that falls slowly all the way to the
/// edge, and along which a search without knowledge of it gets stuck.
#[test]
fn a_valley_of_double_roots_is_followed_to_the_edge() {
    let search = Search {
        fixed: Groups::new(0.173_932_752, -0.915_096_374, 0.0),
        gain: SearchedGain::Load,
        gains: (-10.0, 5.0),
        delays: (0.0, 25.0),
    };
    let found = best(&search).overall;
    assert_eq!((found.gain, found.kind), (-10.0, Kind::Edge), "{found:?}");
    assert!(
        (found.abscissa - -0.9944).abs() < 1e-4 && found.certified,
        "{found:?}"
    );
}
