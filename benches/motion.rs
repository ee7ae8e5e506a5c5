//! Time per unit of simulated time, and error, of the integrator on the three problems on which
//! other programs were measured.
//!
//! `cargo bench --bench motion`. Smooth: the letter's Fig. 3 (a) parameters, sliding with control
//! from the start at t = 0, ẋ = v0 + 0.05. Hybrid: Fig. 3 (a) and (b) from rest at a = 0, control
//! from t = 70 on. All until t = 200. Errors are the largest ones of a (and of ẋ) at multiples of
//! 0.1, and of event times, against this integrator at its tightest. Medians of rounds; a round is
//! repeated until it takes some milliseconds.
//!
//! Then what motions cost whose feedback is read at equal times and held in between, beside the
//! same without interruption.
//!
//! At the end: what a law costs that is given as a formula, beside the built-in law of the same
//! form.
//!
//! `-- --write-reference FOLDER` writes what it gives at its tightest: `smooth.csv`,
//! `hybrid-3a.csv`, `hybrid-3b.csv` with a and ẋ in a line, and the times of events in
//! `…-events.csv`. `-- --reference FOLDER` measures errors against such files and prints one line
//! for each problem and tolerance, `program problem setting µs-per-unit error-of-a`: for
//! `benches/peers/run.sh`, which compares other programs.

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Instant;

use slipmap::model::{Dashpots, Feedback, FrictionLaw, Readings};
use slipmap::setting::Setting;
use slipmap::setting::formula::GivenFormula;
use slipmap::setting::law_kind::LawKind;
use slipmap::slip::motion::{Accuracy, Event, Motion, Parameters};

const END: f64 = 200.0;
const EVERY: f64 = 0.1;
const POINTS: usize = 2000;
const ROUNDS: usize = 15;
const REPEATED: usize = 10;

struct Problem {
    name: &'static str,
    parameters: Parameters,
    u: f64,
    a: f64,
}

/// The letter's law as the law of its name and as a formula.
fn laws() -> [FrictionLaw; 2] {
    let formula = GivenFormula::read("mu0/(1 + v/v_s)").expect("an expression");
    let given = [("mu0", 0.5), ("v_s", 0.5), ("v0", 0.1), ("tau", 1.0)];
    let setting = Setting::checked(given, Some(LawKind::Formula(formula)), &[]);
    let formula = setting.expect("a setting").friction_law();
    [
        FrictionLaw::weakening(0.5, 0.5, 1.0).expect("a law"),
        formula.expect("a law").expect("a law"),
    ]
}

/// Stribeck's law as the law of its name and as a formula, on the last problem.
fn stribeck_laws() -> [FrictionLaw; 2] {
    [
        FrictionLaw::stribeck(0.3, 0.2, 1.0).expect("a law"),
        FrictionLaw::stribeck_with(0.3, 0.2, 1.0, (2.0, 0.0)).expect("a law"),
    ]
}

fn problems() -> [Problem; 3] {
    let [law, _] = laws();
    let letter = |v0, alpha_v, alpha_n, tau, switch_on| Parameters {
        law: law.clone(),
        velocity_unit: 1.0,
        dashpots: Dashpots::default(),
        feedback: Feedback::new(alpha_v, alpha_n, tau),
        v0,
        switch_on,
    };
    let problem = |name, parameters, u, a| Problem {
        name,
        parameters,
        u,
        a,
    };
    let smooth = letter(0.35, -0.33, 0.0, 4.15, 0.0);
    let (a, b) = (
        letter(0.35, -0.33, 0.0, 4.15, 70.0),
        letter(0.1, 0.0, -10.0, 0.5, 70.0),
    );
    [
        problem("smooth", smooth, 0.40, law.mu_k(0.35)),
        problem("hybrid-3a", a, 0.0, 0.0),
        problem("hybrid-3b", b, 0.0, 0.0),
    ]
}

impl Problem {
    fn motion(&self, tolerance: f64) -> Motion {
        let accuracy = Accuracy {
            tolerance,
            ..Accuracy::default()
        };
        Motion::new(self.parameters.clone(), accuracy, self.u, self.a)
    }

    /// Steps taken.
    fn run(&self, tolerance: f64) -> u32 {
        let mut motion = self.motion(tolerance);
        let mut steps = 0;
        while motion.t < END {
            black_box(motion.advance(END));
            steps += 1;
        }
        steps
    }

    /// a and ẋ at multiples of [`EVERY`], and the times of events.
    fn samples(&self, tolerance: f64) -> Samples {
        let mut motion = self.motion(tolerance);
        let mut samples = Samples::default();
        while motion.t < END {
            let start = motion.t;
            match motion.advance(END) {
                None | Some(Event::SwitchOn) => {}
                Some(_) => samples.events.push(motion.t),
            }
            while samples.states.len() < POINTS {
                let t = EVERY * samples.states.len() as f64;
                if t > motion.t {
                    break;
                }
                let (u, a, _) = motion.last_step().state(t - start);
                samples.states.push([a, u]);
            }
        }
        samples
    }

    /// This integrator at its tightest.
    fn tightest(&self) -> Samples {
        self.samples(1e-15)
    }

    /// Median of microseconds per unit of time.
    fn time(&self, tolerance: f64) -> f64 {
        let mut times: Vec<_> = (0..ROUNDS)
            .map(|_| {
                let start = Instant::now();
                for _ in 0..REPEATED {
                    black_box(self.run(black_box(tolerance)));
                }
                start.elapsed().as_secs_f64() * 1e6 / (END * REPEATED as f64)
            })
            .collect();
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    }
}

#[derive(Default)]
struct Samples {
    states: Vec<[f64; 2]>,
    events: Vec<f64>,
}

impl Samples {
    /// Largest differences of a, ẋ and event times; infinite where the events are others.
    fn distance(&self, other: &Self) -> [f64; 3] {
        let mut largest = [0.0_f64; 3];
        for (p, q) in self.states.iter().zip(&other.states) {
            largest[0] = largest[0].max((p[0] - q[0]).abs());
            largest[1] = largest[1].max((p[1] - q[1]).abs());
        }
        if self.events.len() != other.events.len() {
            largest[2] = f64::INFINITY;
        }
        for (p, q) in self.events.iter().zip(&other.events) {
            largest[2] = largest[2].max((p - q).abs());
        }
        largest
    }
}

/// The files of a problem's reference in `folder`: states, and times of events.
fn files(folder: &Path, problem: &str) -> [PathBuf; 2] {
    ["", "-events"].map(|of| folder.join(format!("{problem}{of}.csv")))
}

fn write_reference(folder: &Path) {
    for problem in problems() {
        let samples = problem.tightest();
        let states = samples.states.iter().map(|[a, u]| format!("{a:e},{u:e}\n"));
        let events = samples.events.iter().map(|t| format!("{t:e}\n"));
        let texts: [String; 2] = [states.collect(), events.collect()];
        for (path, text) in files(folder, problem.name).iter().zip(texts) {
            std::fs::write(path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        }
    }
}

fn read_reference(folder: &Path, problem: &str) -> Samples {
    let [states, events] = files(folder, problem).map(|path| {
        let text = std::fs::read_to_string(&path);
        let text = text.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let number = |x: &str| x.trim().parse::<f64>().expect("a number");
        let rows = text.lines().map(|l| l.split(',').map(number).collect());
        rows.collect::<Vec<Vec<f64>>>()
    });
    let states = states.into_iter().map(|row| [row[0], row[1]]);
    Samples {
        states: states.take(POINTS).collect(),
        events: events.concat(),
    }
}

/// The value of an option on the command line.
fn option(name: &str) -> Option<String> {
    let mut arguments = std::env::args().skip_while(|a| a != name);
    arguments.next()?;
    Some(arguments.next().unwrap_or_else(|| panic!("{name} FOLDER")))
}

fn print_lines(folder: &Path) {
    for problem in problems() {
        let reference = read_reference(folder, problem.name);
        for exponent in 6..=12 {
            let tolerance = 10.0_f64.powi(-exponent);
            let [error, ..] = problem.samples(tolerance).distance(&reference);
            let time = problem.time(tolerance);
            let name = problem.name;
            println!("slipmap {name} 1e-{exponent} {time:.5} {error:.3e}");
        }
    }
}

fn print_table() {
    println!("problem     tolerance  µs per unit  steps  error of a  of ẋ      of events");
    for problem in problems() {
        let reference = problem.tightest();
        for exponent in 6..=12 {
            let tolerance = 10.0_f64.powi(-exponent);
            let [a, u, event] = problem.samples(tolerance).distance(&reference);
            let (time, steps) = (problem.time(tolerance), problem.run(tolerance));
            println!(
                "{:<11} {tolerance:<9e}  {time:<11.3}  {steps:<5}  {a:<10.1e}  {u:<8.1e}  {event:.1e}",
                problem.name
            );
        }
    }
}

/// What readings cost that are held, so many in a delay, beside feedback without interruption:
/// rounds in turn.
fn print_held() {
    println!("\nheld        in a delay  tolerance  without, µs per unit  held    ratio");
    for problem in &problems()[1..] {
        for (in_delay, tolerance) in [(20.0, 1e-12), (20.0, 1e-9), (5.0, 1e-12)] {
            let mut held = Problem {
                parameters: problem.parameters.clone(),
                ..*problem
            };
            let feedback = &mut held.parameters.feedback;
            feedback.readings = Readings {
                sample_time: feedback.tau / in_delay,
                ..Readings::default()
            };
            let [without, held] = medians([problem, &held].map(|p| || p.time(tolerance)));
            println!(
                "{:<11} {in_delay:<11} {tolerance:<9e}  {without:<21.3} {held:<7.3} {:.3}",
                problem.name,
                held / without
            );
        }
    }
}

/// Medians of two times that are taken in turn.
fn medians(mut times: [impl FnMut() -> f64; 2]) -> [f64; 2] {
    let mut taken = [const { Vec::new() }; 2];
    for _ in 0..ROUNDS {
        for (taken, time) in taken.iter_mut().zip(&mut times) {
            taken.push(time());
        }
    }
    taken.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    })
}

/// What a formula costs beside the built-in law of the same form, at 1e-9: rounds in turn.
fn print_formulas() {
    println!("\nformula     built-in, µs per unit  formula  ratio");
    let [_, _, last] = problems();
    for (name, laws) in [("hybrid-3b", laws()), ("stribeck-3b", stribeck_laws())] {
        let [built_in, formula] = laws.map(|law| {
            let parameters = Parameters {
                law,
                ..last.parameters.clone()
            };
            Problem { parameters, ..last }
        });
        let [built_in, formula] = medians([&built_in, &formula].map(|p| || p.time(1e-9)));
        println!(
            "{name:<11} {built_in:<22.3} {formula:<8.3} {:.3}",
            formula / built_in
        );
    }
}

fn main() {
    if let Some(folder) = option("--write-reference") {
        write_reference(folder.as_ref());
    } else if let Some(folder) = option("--reference") {
        print_lines(folder.as_ref());
    } else {
        print_table();
        print_held();
        print_formulas();
    }
}
