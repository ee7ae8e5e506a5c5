//! What the options of a search for a critical velocity do: each is halved and doubled.
//!
//! `cargo bench --bench critical_options`, one core, half an hour; `SLIPMAP_CELLS` asks for more or
//! less than 300 random cells (seed fixed), an argument for the options whose names contain it.
//! Options of continuation are tried on lines of delays as well, those of a line on these alone,
//! those of switching on on scans. A value beyond the range of its option is the end of the range.
//!
//! Prints for every option and factor how many answers change, by more than 1e-5 or otherwise, the
//! largest change, and the ratio of the times: usual and changed ones in turn, the lesser of two
//! each, so that other work on the machine shows little. At the end those that change nothing, not
//! even a bit, and those that change no answer and take the same time.

use std::time::Instant;

use slipmap::critical::along_delay::critical_velocities;
use slipmap::critical::switch_on::{Phase, Scan, windows};
use slipmap::critical::{CriticalVelocity, Options, Problem, Transition, critical_velocity};
use slipmap::model::Feedback;
use slipmap::slip::motion::Accuracy;

#[path = "../tests/common/chance.rs"]
mod chance;
#[path = "../tests/common/chance_problem.rs"]
mod chance_problem;
use chance::Chance;

/// Answers that differ by more than this are others.
const SAME: f64 = 1e-5;
/// Times that differ by less than this are the same: noise.
const SAME_TIME: f64 = 0.03;
/// Cells of a line, and their distance, relative.
const LINE: usize = 60;
const APART: f64 = 0.004;

/// What is looked for.
enum Search {
    Cell(Problem),
    Line(Vec<Problem>),
    Scan(Problem, Phase),
}

/// An answer to be compared: a velocity, and what goes with it.
type Answer = (f64, Option<Transition>, bool);

fn of_cell(found: &CriticalVelocity) -> Answer {
    let end = found.end_of_stick_slip();
    (end, Some(found.transition), found.decided)
}

fn with(problem: &Problem, options: &Options) -> Problem {
    Problem {
        options: *options,
        ..problem.clone()
    }
}

impl Search {
    fn answers(&self, options: &Options) -> Vec<Answer> {
        match self {
            Self::Cell(problem) => {
                let found = critical_velocity(&with(problem, options));
                let bounds = [found.vc_lower, found.vc_upper];
                let bounds = bounds.map(|bound| (bound, None, found.decided));
                [&[of_cell(&found)], &bounds[..]].concat()
            }
            Self::Line(line) => {
                let line: Vec<Problem> = line.iter().map(|one| with(one, options)).collect();
                let found = critical_velocities(&line, || false);
                found.iter().flatten().map(of_cell).collect()
            }
            Self::Scan(problem, phase) => {
                let scan = Scan {
                    points: 31,
                    ..Scan::default()
                };
                let accuracy = Accuracy::of(1e-9);
                let found = windows(&with(problem, options), *phase, &scan, accuracy);
                let edges = found.survives.iter().flatten();
                edges.map(|edge| (*edge, None, found.decided)).collect()
            }
        }
    }
}

/// What an option is tried on.
fn searches(table: &str, cells: usize) -> Vec<Search> {
    let mut chance = Chance(11);
    let mut some = |n: usize| -> Vec<Problem> {
        let one = |i: usize| match i % 3 {
            2 => chance.problem_of_other_laws(),
            _ => chance.problem(),
        };
        (0..n).map(one).collect()
    };
    let line = |one: Problem| {
        let at = |i: usize| Problem {
            feedback: Feedback {
                tau: one.feedback.tau * (1.0 + APART * i as f64),
                ..one.feedback
            },
            ..one.clone()
        };
        Search::Line((0..LINE).map(at).collect())
    };
    let phase = |(one, i): (Problem, i32)| Search::Scan(one, Phase::After(0.3 * f64::from(i)));
    let [ordinary, lines, scans] = match table {
        "switch_on" => [0, 0, cells.div_ceil(30)],
        "along_delay" => [0, cells.div_ceil(LINE), 0],
        "ramp" => [cells, 0, 0],
        _ => [cells, cells.div_ceil(3 * LINE), 0],
    };
    let mut all: Vec<Search> = some(ordinary).into_iter().map(Search::Cell).collect();
    all.extend(some(lines).into_iter().map(line));
    all.extend(some(scans).into_iter().zip(0..).map(phase));
    all
}

/// What a change of an option does.
#[derive(Clone, Copy, Default)]
struct Effect {
    /// Answers that change, and those of which only some bits do.
    changed: usize,
    bits: usize,
    most: f64,
    /// Time without the change and with it.
    usual: f64,
    time: f64,
}

impl Effect {
    fn see(&mut self, before: &[Answer], after: &[Answer]) {
        self.changed += before.len().abs_diff(after.len());
        for (a, b) in before.iter().zip(after) {
            let alike = a.0.to_bits() == b.0.to_bits() || a.0.is_nan() && b.0.is_nan();
            let off = (b.0 / a.0 - 1.0).abs();
            if off.is_finite() {
                self.most = self.most.max(off);
            }
            let same = (alike || off <= SAME) && (a.1, a.2) == (b.1, b.2);
            self.changed += usize::from(!same);
            self.bits += usize::from(!alike);
        }
    }

    fn ratio(&self) -> f64 {
        self.time / self.usual
    }
}

fn timed(search: &Search, options: &Options) -> (Vec<Answer>, f64) {
    let start = Instant::now();
    let found = search.answers(options);
    (found, start.elapsed().as_secs_f64())
}

/// The effects of some changed options on all searches.
fn effects(searches: &[Search], changed: &[Options]) -> Vec<Effect> {
    let mut effects = vec![Effect::default(); changed.len()];
    for search in searches {
        let round = |options: &Options| timed(search, options);
        let usual = Options::default();
        let [mut before, again] = [0, 1].map(|_| {
            let found = round(&usual);
            (found, changed.iter().map(round).collect::<Vec<_>>())
        });
        before.0.1 = before.0.1.min(again.0.1);
        for (i, effect) in effects.iter_mut().enumerate() {
            effect.see(&before.0.0, &before.1[i].0);
            effect.usual += before.0.1;
            effect.time += before.1[i].1.min(again.1[i].1);
        }
    }
    effects
}

fn main() {
    let asked = std::env::var("SLIPMAP_CELLS").ok();
    let cells: usize = asked.and_then(|n| n.parse().ok()).unwrap_or(300);
    let wanted = std::env::args().skip(1).find(|one| !one.starts_with('-'));
    let wanted = wanted.unwrap_or_default();
    let (mut nothing, mut idle) = (Vec::new(), Vec::new());
    let (mut table, mut all) = (String::new(), Vec::new());
    println!("answers that change by more than {SAME:e}, the largest change, the time's ratio");
    for name in Options::names().filter(|name| name.contains(&wanted)) {
        let of = name.split('.').next().unwrap_or_default();
        if of != table {
            of.clone_into(&mut table);
            all = searches(&table, cells);
        }
        let scaled = [0.5, 2.0].map(|factor| {
            let mut options = Options::default();
            options.scale(&name, factor).then_some(options)
        });
        let changed: Vec<Options> = scaled.iter().flatten().copied().collect();
        let mut found = effects(&all, &changed).into_iter();
        let (mut bits, mut does) = (0, false);
        let mut line = format!("{name:<36}");
        for (factor, scaled) in ["/ 2", "* 2"].iter().zip(scaled) {
            let Some(effect) = scaled.and_then(|_| found.next()) else {
                line += &format!("  {factor}    -");
                continue;
            };
            bits += effect.bits + effect.changed;
            does |= effect.changed > 0 || (effect.ratio() - 1.0).abs() > SAME_TIME;
            let Effect { changed, most, .. } = effect;
            let ratio = effect.ratio();
            line += &format!("  {factor} {changed:>4} {most:>8.1e} time {ratio:>5.2}");
        }
        println!("{line}");
        if bits == 0 {
            nothing.push(name);
        } else if !does {
            idle.push(name);
        }
    }
    println!("change no bit: {}", nothing.join(", "));
    println!("change no answer and no time: {}", idle.join(", "));
}
