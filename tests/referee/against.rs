//! slipmap's answers beside the referee's: each question is asked of both, of the referee by two
//! step sizes.

use slipmap::critical::switch_on::{Phase, Trials};
use slipmap::critical::{self, CriticalVelocity, Problem, Regime, critical_velocity};
use slipmap::model::{ActuatorLimits, Channel, Dashpots, Feedback, FrictionLaw, Table};
use slipmap::setting::CaseSpec;
use slipmap::setting::formula::GivenFormula;
use slipmap::setting::law_kind::LawKind;
use slipmap::slip::motion;
use slipmap::slip::outcome::Outcome;

use super::asked::{case_file, formula, phase_file, simulate_command, vc_command};
use super::block::{Block, Event};
use super::law::{Friction, Law};
use super::ramp::{self, Begin, End, Ramp};
use super::random::Start;
use super::setting::Setting;
use super::steps::Pace;
use super::switch_on::{self, Fate};

/// What comes of a question.
#[derive(Debug)]
pub(crate) enum Verdict {
    /// So many things were compared, and agree.
    Agree(usize),
    /// Where the referee's answer hangs on its steps, it says nothing from there on; so much agrees
    /// before.
    KnifeEdge(usize),
    /// slipmap claims nothing.
    Undecided,
    /// How to ask again, and both answers.
    Differ(String),
}

/// The step sizes of the referee's motions are this and half of it.
const MOTION_PACE: f64 = 0.5;
/// Events of one motion that are compared at most, and the referee's steps in it.
const MOST_EVENTS: usize = 30;
const MOST_STEPS: usize = 1_000_000;
/// Event times of the referee are known where both step sizes agree to this over 1 + t, in √(M/κ).
const KNOWN: f64 = 1e-7;
/// The error allowed to slipmap's besides twice the difference of the referee's.
const ALLOWED: f64 = 1e-9;

/// The events of a motion.
pub(crate) fn motion(start: &Start) -> Verdict {
    let pace = Pace::of(MOTION_PACE);
    let (coarse, _) = events(start, pace);
    let (fine, end) = events(start, pace.halved());
    let text = case_file(start);
    let found = events_of_slipmap(&text, start.horizon);
    let unit = start.setting.time();
    for i in 0..MOST_EVENTS {
        let Some(expected) = fine.get(i) else {
            // Nothing more, unless at the very end.
            let more = found.get(i).is_some_and(|e| e.1 < end - 1e-6 * unit);
            return match more {
                true => differ(&text, i, &fine, &found),
                false => Verdict::Agree(i),
            };
        };
        let scale = unit + expected.1;
        let off = |one: Option<&(Event, f64)>| match one {
            Some(one) if one.0 == expected.0 => (one.1 - expected.1).abs() / scale,
            _ => f64::INFINITY,
        };
        let unknown = off(coarse.get(i));
        if unknown > KNOWN {
            return Verdict::KnifeEdge(i);
        }
        if off(found.get(i)) > ALLOWED + 2.0 * unknown {
            return differ(&text, i, &fine, &found);
        }
    }
    Verdict::Agree(MOST_EVENTS)
}

fn differ(text: &str, i: usize, fine: &[(Event, f64)], found: &[(Event, f64)]) -> Verdict {
    Verdict::Differ(format!(
        "{}\n# event {i}: slipmap {:?}, referee {:?}",
        simulate_command(text),
        found.get(i),
        fine.get(i)
    ))
}

/// The referee's events, and until when it has followed the block.
pub(crate) fn events(start: &Start, pace: Pace) -> (Vec<(Event, f64)>, f64) {
    let (u, a) = (start.x_dot0, start.a0);
    let mut block = Block::at_rest_or_sliding(start.setting.clone(), pace, u, a);
    let mut events = Vec::new();
    for _ in 0..MOST_STEPS {
        let event = block.advance(start.horizon);
        events.extend(event.map(|event| (event, block.t)));
        let over = event == Some(Event::LiftOff) || events.len() >= MOST_EVENTS;
        if over || block.t >= start.horizon {
            break;
        }
    }
    (events, block.t)
}

/// slipmap's events of a case file, in its units, until the horizon.
pub(crate) fn events_of_slipmap(text: &str, horizon: f64) -> Vec<(Event, f64)> {
    let spec: CaseSpec = text.parse().expect("a case file");
    let unit = spec.case.units().time;
    let mut motion = spec.case.motion().expect("a motion");
    let mut events = Vec::new();
    while motion.t < horizon / unit && events.len() < MOST_EVENTS {
        let event = motion.advance(horizon / unit).map(named);
        events.extend(event.map(|event| (event, motion.t * unit)));
        if event == Some(Event::LiftOff) {
            break;
        }
    }
    events
}

/// a and ẋ of a case file at a time, by slipmap.
pub(crate) fn last_state_of_slipmap(text: &str, until: f64) -> (f64, f64) {
    let spec: CaseSpec = text.parse().expect("a case file");
    let units = spec.case.units();
    let mut motion = spec.case.motion().expect("a motion");
    while motion.t < until / units.time {
        motion.advance(until / units.time);
    }
    (motion.a * units.length, motion.u * units.velocity)
}

fn named(event: motion::Event) -> Event {
    match event {
        motion::Event::Release => Event::Release,
        motion::Event::Stick => Event::Stick,
        motion::Event::Reversal => Event::Reversal,
        motion::Event::LiftOff => Event::LiftOff,
        motion::Event::SwitchOn => Event::SwitchOn,
        motion::Event::Programme => Event::Programme,
    }
}

/// Two ramps that share neither steps of time nor of v0, nor how long they wait, nor how they begin.
const RAMPS: [Ramp; 2] = [
    Ramp {
        pace: Pace::of(2.0),
        largest: 0.05,
        stops: 30,
        begin: Begin::Released,
    },
    Ramp {
        pace: Pace::of(1.4),
        largest: 0.03,
        stops: 60,
        begin: Begin::AtRest,
    },
];
/// The referee's velocity is known where both ramps agree to this.
const RAMPS_AGREE: f64 = 3e-5;
/// The difference allowed to slipmap's.
const VELOCITY_ALLOWED: f64 = 2e-4;

/// The critical velocity.
pub(crate) fn velocity(setting: &Setting) -> Verdict {
    let found = critical_velocity(&problem(setting));
    if !found.decided {
        return Verdict::Undecided;
    }
    let ramps = RAMPS.map(|ramp| ramp::critical_velocity(setting, ramp));
    let command = vc_command(setting);
    let said = format!("{command}\n# slipmap {found:?}, referee {ramps:?}");
    match ramps[0].is_near(ramps[1], RAMPS_AGREE) && ramps[0] != End::Unfinished {
        true if ramps[1].is_near(end(&found), VELOCITY_ALLOWED) => Verdict::Agree(1),
        true => Verdict::Differ(said),
        false => Verdict::KnifeEdge(0),
    }
}

/// slipmap's critical velocity, and the referee's by its faster ramp, against a known one.
pub(crate) fn known_velocity(setting: &Setting, expected: End) -> Verdict {
    let found = critical_velocity(&problem(setting));
    let ramp = ramp::critical_velocity(setting, RAMPS[0]);
    let right = |one: End| one.is_near(expected, VELOCITY_ALLOWED);
    match (right(end(&found)), right(ramp)) {
        (true, true) if found.decided => Verdict::Agree(1),
        (true, true) => Verdict::Undecided,
        _ => Verdict::Differ(format!(
            "{}\n# slipmap {found:?}, referee {ramp:?}, expected {expected:?}",
            vc_command(setting)
        )),
    }
}

/// What slipmap says of the end of stick-slip, in the referee's words.
pub(crate) fn end(found: &CriticalVelocity) -> End {
    match found.transition {
        critical::Transition::LiftOff => End::LiftsOff(found.v_liftoff),
        critical::Transition::Persists => End::Persists,
        critical::Transition::Never => End::Never,
        _ => End::Lost(found.vc),
    }
}

/// The problem of a setting with M = κ = N0 = 1.
pub(crate) fn problem(setting: &Setting) -> Problem {
    let feedback = Feedback::new(setting.alpha_v, setting.alpha_n, setting.tau).through(Channel {
        memory: setting.memory,
        latency: setting.latency,
    });
    let feedback = Feedback {
        limits: ActuatorLimits {
            velocity: setting.of_v,
            load: [setting.of_load[0].max(0.0), setting.of_load[1]],
        },
        ..feedback
    };
    Problem {
        dashpots: Dashpots {
            damping: setting.damping,
            viscous: setting.viscous,
        },
        ..Problem::new(friction_law(&setting.friction), feedback)
    }
}

fn friction_law(friction: &Friction) -> FrictionLaw {
    let mu_s = friction.mu_s;
    let law = match &friction.law {
        Law::Coulomb { mu0 } => FrictionLaw::coulomb(*mu0, mu_s),
        Law::Weakening { mu0, v_s } => FrictionLaw::weakening(*mu0, *v_s, mu_s),
        Law::Stribeck { mu0, v_s } => FrictionLaw::stribeck(*mu0, *v_s, mu_s),
        Law::Table(curve) => {
            let table = Table::new(curve.x.clone(), curve.y.clone());
            FrictionLaw::table(table.expect("a table"), mu_s)
        }
        Law::Formula { mu0, v_s, .. } => {
            let (text, own) = formula(friction).expect("a formula");
            let law = LawKind::Formula(GivenFormula::read(&text).expect("an expression"));
            let known = [
                ("mu0", *mu0),
                ("v_s", *v_s),
                ("mu_s", mu_s),
                ("tau", 1.0),
                ("v0", 1.0),
            ];
            let given = own.into_iter().chain(known);
            let setting = slipmap::setting::Setting::checked(given, Some(law), &[]);
            setting
                .expect("a setting")
                .friction_law()
                .map(|law| law.expect("a law"))
        }
    };
    law.expect("a law")
}

/// Blocks are followed after switch-on by these steps, for so many times the period and the delay.
const FOLLOWED: [(f64, f64); 2] = [(2.0, 60.0), (1.0, 120.0)];

/// What becomes of stick-slip when control is switched on.
pub(crate) fn fate(setting: &Setting, phase: f64) -> Verdict {
    let text = phase_file(setting, phase);
    let command = simulate_command(&text);
    let fates = FOLLOWED.map(|(share, times)| {
        let pace = Pace::of(share);
        switch_on::fate(setting, pace, phase, times)
    });
    let found = [fate_of_slipmap(&text), fate_of_trial(setting, phase)];
    let differs = |found: &Option<Fate>| found.is_some() && *found != fates[1];
    match fates[0] == fates[1] && fates[0].is_some() {
        true if found == [None, None] => Verdict::Undecided,
        true if found.iter().any(differs) => {
            Verdict::Differ(format!("{command}\n# slipmap {found:?}, referee {fates:?}"))
        }
        true => Verdict::Agree(1),
        false => Verdict::KnifeEdge(0),
    }
}

/// What a scan of `slipmap vc --protocol switch-on` says at this v0; none where it is undecided.
pub(crate) fn fate_of_trial(setting: &Setting, phase: f64) -> Option<Fate> {
    let problem = problem(setting);
    let accuracy = motion::Accuracy::of(1e-9);
    let mut trials = Trials::new(&problem, Phase::After(phase), accuracy, MOST_STEPS as u64);
    match trials.at(setting.v0) {
        Regime::Periodic | Regime::Irregular => Some(Fate::Survives),
        Regime::Ended | Regime::Slips => Some(Fate::Ends),
        Regime::LiftOff => Some(Fate::LiftsOff),
        Regime::NoStickSlip => Some(Fate::NoCycle),
        Regime::Undecided => None,
    }
}

/// What slipmap says of a case file with a phase; none where it is undecided.
pub(crate) fn fate_of_slipmap(text: &str) -> Option<Fate> {
    match text.parse::<CaseSpec>() {
        Ok(spec) => fate_of(spec.case.run(&mut ()).expect("a motion").outcome),
        Err(error) if error.message.contains("there is none at this v0") => Some(Fate::NoCycle),
        Err(error) => panic!("{error}\n{text}"),
    }
}

/// An outcome in the referee's words.
pub(crate) fn fate_of(outcome: Outcome) -> Option<Fate> {
    match outcome {
        Outcome::StickSlip => Some(Fate::Survives),
        Outcome::Sliding | Outcome::Oscillation | Outcome::Diverged => Some(Fate::Ends),
        Outcome::LiftOff => Some(Fate::LiftsOff),
        Outcome::NoCycle => Some(Fate::NoCycle),
        Outcome::Undecided => None,
    }
}
