//! From a place near an optimum to the optimum itself: Newton's method on the conditions that can
//! hold there.

use super::condition::{Condition, Followed};
use super::descend::Frame;
use super::found::{Kind, Optimum};
use super::search::{Evaluator, Family, Place, Search, beside_essential};
use crate::linear::equation::Equation;
use crate::linear::newton::Root;
use crate::model::elementary::{hypot, power};

/// Steps of Newton's method.
const MOST_STEPS: u32 = 30;
/// Step of a difference quotient, in units of the frame; what it is taken of is known nearly to
/// rounding.
const DIFFERENCE: f64 = 1e-4;
/// A polished place farther away than this many frames belongs to something else.
const FARTHEST: f64 = 4.0;
/// Roots among which those that share the largest real part are looked for.
const CANDIDATES: u64 = 12;
/// Distances from the abscissa at which the certificate is asked for: this many, each four times
/// the one before, from four times what rounding can do to the abscissa. Near a multiple root the
/// argument principle needs a line farther away than the root is blurred.
const DISTANCES: i32 = 9;
/// A line farther away than this, relative, says nothing of the abscissa.
const FARTHEST_LINE: f64 = 0.02;
/// What is left undecided of an abscissa that the descent alone has found.
const DESCENT_ERROR: f64 = 1e-8;

/// The optimum near `place`, where the descent came to `abscissa`: the first condition that can be
/// satisfied there with an abscissa that is certified and no worse.
pub(super) fn polished(
    evaluator: &mut Evaluator,
    search: &Search<impl Family>,
    (place, abscissa): (Place, f64),
    frame: &Frame,
) -> Option<Optimum> {
    let edge = search.on_edge(place);
    conditions(evaluator.roots(search, place, CANDIDATES), edge)
        .into_iter()
        .take_while(|_| !evaluator.ended())
        .filter_map(|condition| solve(&condition, search, place, frame, edge))
        .map(|(at, solved)| optimum(&solved, search, at, edge))
        .find(|found| found.certified && found.abscissa <= abscissa + 1e-9 * (1.0 + abscissa.abs()))
}

/// What the descent found, with as much certainty as that has.
pub(super) fn unpolished<F: Family>(
    evaluator: &mut Evaluator,
    search: &Search<F>,
    (place, abscissa): (Place, f64),
) -> Optimum {
    let rightmost = evaluator.roots(search, place, 1).first();
    let frequency = rightmost.map(|root| root.lambda.im);
    let margin = match evaluator.ended() {
        true => None,
        false => decided(search, place, abscissa, DESCENT_ERROR, 1.0, 0),
    };
    let accumulating = search.family.setting(place).is_some_and(|setting| {
        let essential = F::equation(&setting).essential_abscissa(search.family.delay(place));
        beside_essential(abscissa, essential)
    });
    Optimum {
        p: place.p,
        q: place.q,
        abscissa,
        frequencies: frequency.into_iter().collect(),
        kind: match search.on_edge(place) {
            (false, false) if frequency.is_none() && accumulating => Kind::Accumulation,
            (false, false) => Kind::Descent,
            _ => Kind::Edge,
        },
        certified: margin.is_some(),
        margin: margin.unwrap_or(DESCENT_ERROR),
    }
}

/// The number of roots right of `abscissa` + distance times `side`, at growing distances until one
/// decides: those at which it is `expected`. The smallest such distance.
fn decided<F: Family>(
    search: &Search<F>,
    place: Place,
    abscissa: f64,
    blur: f64,
    side: f64,
    expected: u64,
) -> Option<f64> {
    let setting = search.family.setting(place)?;
    let right_of = |line| F::equation(&setting).right_of(search.family.delay(place), line);
    let least = blur + 1e-13 * (1.0 + abscissa.abs());
    let most = FARTHEST_LINE * (1.0 + abscissa.abs());
    (1..=DISTANCES)
        .map(|i| least * power(4.0, i))
        .take_while(|&d| d <= most.max(4.0 * least))
        .find(|d| right_of(abscissa + side * d) == Some(expected))
}

fn optimum<F: Family>(
    condition: &Condition,
    search: &Search<F>,
    place: Place,
    edge: (bool, bool),
) -> Optimum {
    let abscissa = condition.abscissa();
    let imaginary = condition.followed.iter().map(|f| f.lambda().im.abs());
    let mut frequencies: Vec<f64> = imaginary.collect();
    frequencies.sort_by(f64::total_cmp);
    // All roots right of a line to the left are those that are followed, and right of a line to the
    // right there is none.
    let setting = search.family.setting(place);
    let blur = setting.map_or(f64::NAN, |setting| {
        condition.blur::<F>(&setting, search.family.delay(place))
    });
    let count = |side, expected| decided(search, place, abscissa, blur, side, expected).is_some();
    Optimum {
        p: place.p,
        q: place.q,
        abscissa,
        frequencies,
        kind: match edge {
            (false, false) => kind(&condition.followed),
            _ => Kind::Edge,
        },
        certified: count(-1.0, condition.roots()) && count(1.0, 0),
        margin: 4.0 * (blur + f64::EPSILON * (1.0 + abscissa.abs())),
    }
}

fn kind(followed: &[Followed]) -> Kind {
    let real = |f: &Followed| f.lambda().im == 0.0;
    match (followed[0], followed.len()) {
        (Followed::DoublePair(_), _) => Kind::DoublePair,
        (Followed::TripleReal(_), _) => Kind::TripleReal,
        (Followed::DoubleReal(_), 1) => Kind::DoubleReal,
        (Followed::DoubleReal(_), _) => Kind::DoubleRealAndPair,
        (Followed::Root(_), 3) if followed.iter().any(real) => Kind::RealAndTwoPairs,
        (Followed::Root(_), 3) => Kind::ThreePairs,
        (Followed::Root(_), 2) if followed.iter().any(real) => Kind::RealAndPair,
        (Followed::Root(_), 2) => Kind::TwoPairs,
        _ => Kind::OneRoot,
    }
}

/// The conditions to try, those on more roots first: where one of them holds, one on fewer roots
/// may be singular.
fn conditions(roots: &[Root], edge: (bool, bool)) -> Vec<Condition> {
    let simple: Vec<Followed> = roots
        .iter()
        .map(|r| Followed::Root(r.lambda))
        .take(4)
        .collect();
    let starts: Vec<_> = roots.iter().map(|r| r.lambda).take(3).collect();
    let of = |followed: &[Followed]| Condition {
        followed: followed.to_vec(),
    };
    let mut list = Vec::new();
    if edge == (false, false) {
        list.extend(starts.iter().map(|l| of(&[Followed::TripleReal(l.re)])));
        list.extend(starts.iter().map(|&l| of(&[Followed::DoublePair(l)])));
        for start in &starts {
            let pairs = simple.iter().filter(|f| f.lambda().im != 0.0);
            list.extend(pairs.map(|&pair| of(&[Followed::DoubleReal(start.re), pair])));
        }
        for last in (2..simple.len()).rev() {
            list.push(of(&[simple[0], simple[1], simple[last]]));
        }
    }
    list.extend(starts.iter().map(|l| of(&[Followed::DoubleReal(l.re)])));
    for (i, &p) in simple.iter().enumerate() {
        list.extend(simple[i + 1..].iter().map(|&q| of(&[p, q])));
    }
    list.extend(simple.iter().map(|&p| of(&[p])));
    list
}

/// The place where `condition` holds, and what is followed there.
fn solve(
    condition: &Condition,
    search: &Search<impl Family>,
    start: Place,
    frame: &Frame,
    edge: (bool, bool),
) -> Option<(Place, Condition)> {
    let mut state = condition.moved(search, start)?;
    let mut place = start;
    if edge.0 && edge.1 {
        // A corner: nothing is free.
        return (state.followed.len() == 1 && matches!(state.followed[0], Followed::Root(_)))
            .then_some((place, state));
    }
    let mut last_size = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let step = newton_step(&state, search, place, frame, edge)?;
        // In units of the frame.
        let size = hypot(step[0] / frame.p, step[1] / frame.q);
        let shortened = (0.5 / size).min(1.0);
        let next = Place {
            p: place.p - shortened * step[0],
            q: place.q - shortened * step[1],
        };
        if !size.is_finite() || search.clamp(next) != next {
            return None;
        }
        let away = hypot((next.p - start.p) / frame.p, (next.q - start.q) / frame.q);
        if away > FARTHEST {
            return None;
        }
        place = next;
        state = state.moved(search, place)?;
        let rounding = 1e-13 * (place.p.abs() / frame.p + place.q.abs() / frame.q);
        if size <= rounding || (size < 1e-7 && size >= 0.5 * last_size) {
            return Some((place, state));
        }
        last_size = size;
    }
    None
}

/// The step of Newton's method, with derivatives by central differences; zero along what an edge
/// holds.
fn newton_step(
    state: &Condition,
    search: &Search<impl Family>,
    place: Place,
    frame: &Frame,
    edge: (bool, bool),
) -> Option<[f64; 2]> {
    let moved = |p: f64, q: f64| Place {
        p: place.p + p,
        q: place.q + q,
    };
    let (h_p, h_q) = (DIFFERENCE * frame.p, DIFFERENCE * frame.q);
    if edge.0 || edge.1 {
        let along_p = edge.1;
        let at = |by: f64| {
            let place = if along_p {
                moved(by, 0.0)
            } else {
                moved(0.0, by)
            };
            state.moved(search, place)?.on_edge(search, place, along_p)
        };
        let h = if along_p { h_p } else { h_q };
        let slope = (at(h)? - at(-h)?) / (2.0 * h);
        let step = at(0.0)? / slope;
        return Some(if along_p { [step, 0.0] } else { [0.0, step] });
    }
    let at = |place: Place| state.moved(search, place)?.inside(search, place);
    let quotient = |ahead: [f64; 2], behind: [f64; 2], h: f64| {
        [0, 1].map(|i| (ahead[i] - behind[i]) / (2.0 * h))
    };
    let here = at(place)?;
    let by_p = quotient(at(moved(h_p, 0.0))?, at(moved(-h_p, 0.0))?, h_p);
    let by_q = quotient(at(moved(0.0, h_q))?, at(moved(0.0, -h_q))?, h_q);
    let determinant = by_p[0] * by_q[1] - by_p[1] * by_q[0];
    Some([
        (here[0] * by_q[1] - here[1] * by_q[0]) / determinant,
        (by_p[0] * here[1] - by_p[1] * here[0]) / determinant,
    ])
}
