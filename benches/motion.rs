//! Time per unit of simulated time, and error, of the integrator on the three problems on which other programs were measured.
//!
//! `cargo bench --bench motion`. Smooth: the letter's Fig. 3 (a) parameters, sliding with control from the start at t = 0,
//! ẋ = v0 + 0.05. Hybrid: Fig. 3 (a) and (b) from rest at a = 0, control from t = 70 on. All until t = 200. Errors are the
//! largest ones of a (and of ẋ) at multiples of 0.1, and of event times, against this integrator at its tightest; where
//! `PEERS` names a folder with the reference arrays of the peers' scripts (`out/ref_S.csv`, …), against those. Medians of
//! rounds; a round is repeated until it takes some milliseconds.

use std::hint::black_box;
use std::time::Instant;

use slipmap::model::FrictionLaw;
use slipmap::slip::motion::{Accuracy, Event, Motion, Parameters};

const END: f64 = 200.0;
const EVERY: f64 = 0.1;
const POINTS: usize = 2000;
const ROUNDS: usize = 15;
const REPEATED: usize = 10;

struct Problem {
    name: &'static str,
    /// In the names of the reference files.
    key: &'static str,
    parameters: Parameters,
    u: f64,
    a: f64,
}

fn problems() -> [Problem; 3] {
    let law = FrictionLaw::weakening(0.5, 0.5, 1.0).expect("a law");
    let letter = |v0, alpha_v, alpha_n, tau, switch_on| Parameters {
        law: law.clone(),
        velocity_unit: 1.0,
        alpha_v,
        alpha_n,
        tau,
        v0,
        switch_on,
    };
    let problem = |name, key, parameters, u, a| Problem {
        name,
        key,
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
        problem("smooth", "S", smooth, 0.40, law.mu_k(0.35)),
        problem("hybrid 3a", "H3a", a, 0.0, 0.0),
        problem("hybrid 3b", "H3b", b, 0.0, 0.0),
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

    fn reference(&self) -> Samples {
        let Ok(folder) = std::env::var("PEERS") else {
            return self.samples(1e-15);
        };
        let read = |key: &str| {
            let path = format!("{folder}/out/ref_{key}.csv");
            let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
            let number = |x: &str| x.trim().parse::<f64>().expect("a number");
            let rows = text.lines().map(|l| l.split(',').map(number).collect());
            rows.collect::<Vec<Vec<f64>>>()
        };
        let states = read(self.key).into_iter().map(|row| [row[0], row[1]]);
        let events = match self.key.strip_prefix('H') {
            Some(letter) => read(&format!("E{letter}")).concat(),
            None => Vec::new(),
        };
        Samples {
            states: states.take(POINTS).collect(),
            events,
        }
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

fn main() {
    println!("problem     tolerance  µs per unit  steps  error of a  of ẋ      of events");
    for problem in problems() {
        let reference = problem.reference();
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
