//! Reference tables that another program worked out, by two step sizes each.

use super::block::Event;
use super::law::{Friction, Law, Shape};
use super::ramp::End;
use super::random::Start;
use super::setting::{FREE, Setting};
use super::switch_on::Fate;

/// A row by the names of its columns.
struct Row<'a> {
    names: Vec<&'a str>,
    words: Vec<&'a str>,
}

fn rows(table: &str) -> Vec<Row<'_>> {
    let mut lines = table.lines().map(|line| line.split(',').collect());
    let names: Vec<&str> = lines.next().expect("names of columns");
    let row = |words| Row {
        names: names.clone(),
        words,
    };
    lines.map(row).collect()
}

impl Row<'_> {
    fn word(&self, name: &str) -> Option<&str> {
        let column = self.names.iter().position(|n| *n == name)?;
        Some(self.words[column])
    }

    fn number(&self, name: &str) -> f64 {
        let word = self.word(name).expect("a column");
        word.parse().expect("a number")
    }

    /// A number; 0 where there is no such column or nothing in it.
    fn or_zero(&self, name: &str) -> f64 {
        let word = self.word(name).filter(|word| !word.is_empty());
        word.map_or(0.0, |word| word.parse().expect("a number"))
    }

    /// Two limits; none where there are no such columns or nothing in them.
    fn limits(&self, names: [&str; 2]) -> [f64; 2] {
        let given = |name: &str| self.word(name).filter(|word| !word.is_empty());
        let limit = |name: &str, none: f64| given(name).map_or(none, |_| self.number(name));
        [limit(names[0], FREE[0]), limit(names[1], FREE[1])]
    }

    /// The setting of a row; M, κ and N0 are 1, and so is μ_S unless a column says otherwise.
    fn setting(&self) -> Setting {
        let mu0 = self.number("mu0");
        let law = match self.word("friction_law").or(self.word("law")) {
            Some("coulomb") => Law::Coulomb { mu0 },
            Some("weakening") => Law::Weakening {
                mu0,
                v_s: self.number("v_s"),
            },
            Some("stribeck") => Law::Stribeck {
                mu0,
                v_s: self.number("v_s"),
            },
            Some("formula") => Law::Formula {
                shape: match self.or_zero("delta") {
                    0.0 => Shape::Hyperbolic,
                    delta => Shape::Exponential(delta),
                },
                mu0,
                v_s: self.number("v_s"),
                sigma: self.or_zero("sigma"),
            },
            other => panic!("{other:?}"),
        };
        let mu_s = self.word("mu_s").map_or(1.0, |_| self.number("mu_s"));
        Setting {
            friction: Friction { law, mu_s },
            mass: 1.0,
            stiffness: 1.0,
            load: 1.0,
            alpha_v: self.number("alpha_v"),
            alpha_n: self.number("alpha_n"),
            tau: self.number("tau"),
            memory: 0.0,
            latency: 0.0,
            sample_time: self.or_zero("sample_time"),
            amplitude: 0.0,
            damping: self.or_zero("damping"),
            viscous: self.or_zero("viscous"),
            of_v: self.limits(["v_min", "v_max"]),
            of_load: self.limits(["load_min", "load_max"]),
            programme: Vec::new(),
            v0: self.word("v0").map_or(1.0, |_| self.number("v0")),
            switch_on: self.or_zero("switch_on"),
        }
    }
}

/// A motion of `rig_motions.csv` or `rig_held.csv`: its start, its events, and a and ẋ at its end.
pub(crate) type RigMotion = (Start, Vec<(Event, f64)>, (f64, f64));

/// `rig_motions.csv`: motions with dashpots and limits.
pub(crate) fn rig_motions() -> Vec<RigMotion> {
    motions_of_rig(include_str!("../reference/rig_motions.csv"))
}

/// `rig_held.csv`: the same with readings at equal times, held in between.
pub(crate) fn held_motions() -> Vec<RigMotion> {
    motions_of_rig(include_str!("../reference/rig_held.csv"))
}

fn motions_of_rig(table: &str) -> Vec<RigMotion> {
    let motion = |row: Row| {
        let events = row.word("events").expect("events").split(';');
        let start = Start {
            setting: row.setting(),
            x_dot0: row.number("x_dot0"),
            a0: row.number("a0"),
            horizon: row.number("until"),
        };
        let last = (row.number("a_end"), row.number("x_dot_end"));
        (start, events.map(event).collect(), last)
    };
    rows(table).into_iter().map(motion).collect()
}

/// `rig_vc.csv`: critical velocities with dashpots and limits.
pub(crate) fn rig_velocities() -> Vec<(Setting, End)> {
    let velocity = |row: Row| {
        let vc = row.number("vc");
        let end = match row.word("how") {
            Some("lost") => End::Lost(vc),
            Some("lift-off") => End::LiftsOff(vc),
            other => panic!("{other:?}"),
        };
        (row.setting(), end)
    };
    rows(include_str!("../reference/rig_vc.csv"))
        .into_iter()
        .map(velocity)
        .collect()
}

/// `motion_events.csv`: starts, and their first events.
pub(crate) fn motions() -> Vec<(Start, Vec<(Event, f64)>)> {
    let table = include_str!("../reference/motion_events.csv");
    let motion = |row: Row| {
        let events = row.word("events").expect("events").split(';');
        let events: Vec<_> = events.map(event).collect();
        let horizon = events.last().expect("an event").1 + 1.0;
        let start = Start {
            setting: row.setting(),
            x_dot0: row.number("x_dot0"),
            a0: row.number("a0"),
            horizon,
        };
        (start, events)
    };
    rows(table).into_iter().map(motion).collect()
}

fn event(text: &str) -> (Event, f64) {
    let (t, kind) = text.split_once(':').expect("a time and a kind");
    let kind = match kind {
        "release" => Event::Release,
        "stick" => Event::Stick,
        "reversal" => Event::Reversal,
        "liftoff" | "lift_off" => Event::LiftOff,
        "switch_on" => Event::SwitchOn,
        other => panic!("{other}"),
    };
    (kind, t.parse().expect("a time"))
}

/// `vc_referee.csv`: critical velocities.
pub(crate) fn velocities() -> Vec<(Setting, End)> {
    let table = include_str!("../reference/vc_referee.csv");
    let velocity = |row: Row| {
        assert_eq!(row.word("outcome"), Some("lost"));
        (row.setting(), End::Lost(row.number("vc")))
    };
    rows(table).into_iter().map(velocity).collect()
}

/// `switch_on_fate.csv`: settings, phases of switch-on, and what becomes of stick-slip.
pub(crate) fn fates() -> Vec<(Setting, f64, Fate)> {
    let table = include_str!("../reference/switch_on_fate.csv");
    let fate = |row: Row| {
        let fate = match row.word("fate") {
            Some("survives") => Fate::Survives,
            Some("ends") => Fate::Ends,
            Some("lift") => Fate::LiftsOff,
            other => panic!("{other:?}"),
        };
        (row.setting(), row.number("switch_on_phase"), fate)
    };
    rows(table).into_iter().map(fate).collect()
}
