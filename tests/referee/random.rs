//! Settings by chance: SplitMix64, and what the referee is asked about.

use super::law::{Friction, Law, Shape};
use super::pchip::Curve;
use super::return_map::damping;
use super::setting::{Corner, FREE, Setting};

/// Numbers that look random, the same for the same seed.
pub(crate) struct Chance(u64);

impl Chance {
    /// The `number`-th sequence of a seed, which depends on no other.
    pub(crate) fn of(seed: u64, number: usize) -> Self {
        let mut chance = Self(seed ^ (number as u64).wrapping_mul(0xd134_2543_de82_ef95));
        chance.unit();
        chance
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    pub(crate) fn log(&mut self, from: f64, to: f64) -> f64 {
        self.between(from.ln(), to.ln()).exp()
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
}

/// A block set in motion at t = 0, and until when it is followed.
pub(crate) struct Start {
    pub setting: Setting,
    pub x_dot0: f64,
    pub a0: f64,
    pub horizon: f64,
}

/// One of the four laws; v_s, and speeds of a table, of about the size 0.02 to 1.
fn friction(chance: &mut Chance) -> Friction {
    let mu_s = [1.0, chance.between(0.5, 1.2)][chance.below(2)];
    let mu0 = mu_s * chance.between(0.25, 0.9);
    let v_s = chance.log(0.02, 1.0);
    let law = match chance.below(10) {
        0 | 1 => Law::Coulomb { mu0 },
        2..5 => Law::Weakening { mu0, v_s },
        5..8 => Law::Stribeck { mu0, v_s },
        _ => Law::Table(curve(chance, mu_s, v_s)),
    };
    Friction { law, mu_s }
}

/// A formula, perhaps with a viscous part.
fn formula(chance: &mut Chance) -> Friction {
    let mu_s = [1.0, chance.between(0.5, 1.2)][chance.below(2)];
    let delta = [1.0, 2.0, 3.0, 1.5, chance.between(1.05, 2.5), 0.5][chance.below(6)];
    let shape = [
        Shape::Exponential(delta),
        Shape::Hyperbolic,
        Shape::Rational(delta),
        Shape::Tanh,
    ][chance.below(4)];
    let law = Law::Formula {
        shape,
        mu0: mu_s * chance.between(0.25, 0.9),
        v_s: chance.log(0.02, 1.0),
        sigma: [0.0, chance.log(0.005, 0.2)][chance.below(2)],
    };
    Friction { law, mu_s }
}

/// A motion whose friction law is a formula, here and there with dashpots or limits.
pub(crate) fn by_formula(chance: &mut Chance) -> Start {
    let mut start = [start, start, start, damped, limited][chance.below(5)](chance);
    let s = &start.setting;
    let velocity = s.load / s.stiffness / s.time();
    start.setting.friction = friction_in(formula(chance), velocity);
    start
}

/// A block whose critical velocity is asked for, with a formula.
pub(crate) fn problem_by_formula(chance: &mut Chance) -> Setting {
    let mut setting = [problem, damped_problem, limited_problem][chance.below(3)](chance);
    setting.friction = formula(chance);
    setting
}

/// A curve that falls from rest, over three to six points, and may rise again.
fn curve(chance: &mut Chance, mu_s: f64, v_s: f64) -> Curve {
    let mut x = vec![[0.0, 0.3 * v_s][chance.below(2)]];
    let mut y = vec![mu_s * chance.between(0.7, 1.0)];
    let points = 3 + chance.below(4);
    while x.len() < points {
        let last = x.len() - 1;
        x.push(x[last] + v_s * chance.between(0.3, 2.0));
        y.push(y[last] * chance.between(0.6, 1.08));
    }
    Curve::through(&x, &y)
}

/// Velocity control, load control, or both.
fn gains(chance: &mut Chance) -> (f64, f64) {
    let sign = |chance: &mut Chance| [-1.0, -1.0, -1.0, 0.3][chance.below(4)];
    let alpha_v = sign(chance) * chance.log(0.02, 1.0);
    let alpha_n = sign(chance) * chance.log(0.05, 6.0);
    match chance.below(3) {
        0 => (alpha_v, 0.0),
        1 => (0.0, alpha_n),
        _ => (alpha_v, alpha_n),
    }
}

/// M, κ and N0: 1, or others in one of four settings.
fn units(chance: &mut Chance) -> [f64; 3] {
    let others = [0; 3].map(|_| chance.log(0.3, 3.0));
    [[1.0; 3], [1.0; 3], [1.0; 3], others][chance.below(4)]
}

/// A motion, in the time unit followed for some cycles and delays.
pub(crate) fn start(chance: &mut Chance) -> Start {
    let [mass, stiffness, load] = units(chance);
    let (time, length) = ((mass / stiffness).sqrt(), load / stiffness);
    let friction = friction_in(friction(chance), length / time);
    let (alpha_v, alpha_n) = gains(chance);
    let tau = chance.log(0.05, 30.0);
    let v0 = chance.log(0.015, 1.0);
    let switch_on = [0.0, 0.0, chance.between(0.0, 20.0), f64::INFINITY][chance.below(4)];
    let x_dot0 = [
        0.0,
        v0,
        chance.between(-2.0, 3.0),
        chance.between(-2.0, 3.0),
    ][chance.below(4)];
    let a0 = friction.mu_s * chance.between(-1.2, 1.2);
    let horizon = (60.0 + 3.0 * tau + 5.0 * friction.mu_s / v0).min(300.0);
    Start {
        setting: Setting {
            friction,
            mass,
            stiffness,
            load,
            alpha_v: alpha_v / time,
            alpha_n: alpha_n * stiffness,
            tau: tau * time,
            memory: 0.0,
            latency: 0.0,
            sample_time: 0.0,
            amplitude: 0.0,
            damping: 0.0,
            viscous: 0.0,
            of_v: FREE,
            of_load: FREE,
            programme: Vec::new(),
            v0: v0 * length / time,
            switch_on: switch_on * time,
        },
        x_dot0: x_dot0 * length / time,
        a0: a0 * length,
        horizon: horizon * time,
    }
}

/// A motion whose feedback has memory, latency or both.
pub(crate) fn remembering(chance: &mut Chance) -> Start {
    let mut start = start(chance);
    echo(chance, &mut start.setting);
    start
}

/// A motion with one dashpot or both.
pub(crate) fn damped(chance: &mut Chance) -> Start {
    let mut start = start(chance);
    dashpots(chance, &mut start.setting);
    start
}

/// A motion with actuators that have limits, of v, of the load or of both, and perhaps dashpots.
pub(crate) fn limited(chance: &mut Chance) -> Start {
    let mut start = start(chance);
    if chance.below(2) == 0 {
        dashpots(chance, &mut start.setting);
    }
    if chance.below(4) == 0 {
        echo(chance, &mut start.setting);
        // Every limit that is passed has an echo in each delay remembered.
        start.setting.memory *= 0.3;
    }
    let (least, most) = (chance.between(-1.0, 1.0), chance.between(1.0, 4.0));
    limits(chance, &mut start.setting, [least, most]);
    start
}

/// A motion whose elongation is read at equal times, perhaps with dashpots, limits, memory and
/// latency.
pub(crate) fn held(chance: &mut Chance) -> Start {
    let mut start = [start, damped, limited, remembering][chance.below(4)](chance);
    let s = &mut start.setting;
    let in_delay = [1, 2, 3, 12, 20, 1 + chance.below(40)][chance.below(6)];
    s.sample_time = s.tau / in_delay as f64;
    s.latency = (s.latency / s.sample_time).round().min(60.0) * s.sample_time;
    start
}

/// A motion under control by the return map, perhaps with dashpots and a programme of v0 between
/// two values. Readings tell the velocity at both.
pub(crate) fn steered(chance: &mut Chance) -> Start {
    loop {
        let mut start = [start, damped][chance.below(2)](chance);
        let (horizon, s) = (start.horizon, &mut start.setting);
        (s.of_v, s.of_load) = (FREE, FREE);
        (s.memory, s.latency) = (0.0, 0.0);
        // The signal is the change of the load itself.
        (s.alpha_v, s.alpha_n) = (0.0, 1.0);
        s.amplitude = s.load * chance.between(0.03, 0.95);
        s.switch_on = [0.0, 0.0, chance.between(0.0, 0.3) * horizon][chance.below(3)];
        if chance.below(4) == 0 {
            s.programme = vec![Corner {
                at: s.switch_on + chance.between(0.1, 0.6) * horizon,
                v0: s.v0 * chance.log(0.5, 2.0),
                ramp: chance.below(2) == 0,
            }];
        }
        let last = s.programme.first().map_or(s.v0, |corner| corner.v0);
        let tells = [s.v0, last].map(|v0| 1.0 - 0.25 * damping(s, v0).powi(2));
        if tells.iter().all(|square| *square > 0.1) {
            let [slowest, fastest] = [f64::min, f64::max].map(|of| of(tells[0], tells[1]).sqrt());
            let angle = chance.between(0.06 / slowest, 3.05 / fastest);
            (s.sample_time, s.tau) = (angle * s.time(), angle * s.time());
            start.horizon = horizon.max(s.switch_on + 12.0 * s.time());
            return start;
        }
    }
}

/// Limits of v, these times v0, of the load, or of both.
fn limits(chance: &mut Chance, setting: &mut Setting, of_v: [f64; 2]) {
    let which = chance.below(3);
    let of_load = [
        [0.05, 0.2, 0.5, 0.9][chance.below(4)],
        chance.between(1.05, 3.0),
    ];
    if which != 1 {
        setting.of_v = of_v.map(|limit| limit * setting.v0);
    }
    if which != 0 {
        setting.of_load = of_load.map(|limit| limit * setting.load);
    }
}

/// A motion whose v0 follows a programme of steps and ramps, here and there with dashpots, limits,
/// memory or latency.
pub(crate) fn programmed(chance: &mut Chance) -> Start {
    let kinds = [start, damped, damped, limited, limited, remembering];
    let mut start = kinds[chance.below(6)](chance);
    // Every corner has an echo in each delay remembered.
    start.setting.memory = start.setting.memory.clamp(-0.25, 0.25);
    let (v0, limits) = (start.setting.v0, start.setting.of_v);
    // A tenth of the way to a limit is left.
    let [least, most] = limits.map(|limit| 0.9 * limit + 0.1 * v0);
    let count = 1 + chance.below(5);
    let mut at = 0.0;
    for _ in 0..count {
        at += chance.between(0.02, 0.8) * start.horizon / count as f64;
        start.setting.programme.push(Corner {
            at,
            v0: (v0 * chance.log(0.25, 4.0)).clamp(least.max(0.05 * v0), most),
            ramp: chance.below(2) == 0,
        });
    }
    start
}

/// Dashpots with damping ratios up to a half.
fn dashpots(chance: &mut Chance, setting: &mut Setting) {
    let unit = (setting.stiffness * setting.mass).sqrt();
    let [damping, viscous] = [0; 2].map(|_| unit * chance.log(0.02, 1.0));
    let which = chance.below(3);
    setting.damping = if which == 1 { 0.0 } else { damping };
    setting.viscous = if which == 0 { 0.0 } else { viscous };
}

/// Memory, latency or both.
fn echo(chance: &mut Chance, setting: &mut Setting) {
    let memory = [1.0, 0.0, 1.0][chance.below(3)] * chance.between(-0.7, 0.85);
    let late = memory == 0.0 || chance.below(2) == 0;
    let latency = chance.log(0.05, 4.0) * setting.time();
    setting.memory = memory;
    setting.latency = if late { latency } else { 0.0 };
}

/// A law whose speeds are given over a unit of velocity.
fn friction_in(mut friction: Friction, velocity: f64) -> Friction {
    match &mut friction.law {
        Law::Coulomb { .. } => {}
        Law::Weakening { v_s, .. } | Law::Stribeck { v_s, .. } => *v_s *= velocity,
        Law::Formula { v_s, sigma, .. } => {
            *v_s *= velocity;
            *sigma /= velocity;
        }
        Law::Table(curve) => {
            let x: Vec<f64> = curve.x.iter().map(|x| x * velocity).collect();
            *curve = Curve::through(&x, &curve.y);
        }
    }
    friction
}

/// A block under control whose critical velocity is asked for; M = κ = N0 = 1.
pub(crate) fn problem(chance: &mut Chance) -> Setting {
    let friction = friction(chance);
    let gains = gains(chance);
    Setting::plain(friction, gains, chance.log(0.05, 10.0), 1.0)
}

/// The same with memory, latency or both in the feedback.
pub(crate) fn remembering_problem(chance: &mut Chance) -> Setting {
    let mut setting = problem(chance);
    echo(chance, &mut setting);
    setting
}

/// The same with one dashpot or both.
pub(crate) fn damped_problem(chance: &mut Chance) -> Setting {
    let mut setting = problem(chance);
    dashpots(chance, &mut setting);
    setting
}

/// The same with limits of actuators, and perhaps dashpots.
pub(crate) fn limited_problem(chance: &mut Chance) -> Setting {
    let mut setting = problem(chance);
    if chance.below(2) == 0 {
        dashpots(chance, &mut setting);
    }
    // v0 is 1 here; the search goes from small ones to the largest v.
    let of_v = [chance.between(-1.0, 0.0), chance.log(0.3, 30.0)];
    limits(chance, &mut setting, of_v);
    setting
}

/// A block in uncontrolled stick-slip, and the phase at which control is switched on.
pub(crate) fn phase(chance: &mut Chance) -> (Setting, f64) {
    let mut setting = problem(chance);
    setting.v0 = chance.log(0.03, 3.0);
    (setting, [0.0, chance.between(0.0, 6.0)][chance.below(2)])
}

/// The same with dashpots and limits of actuators.
pub(crate) fn rig_phase(chance: &mut Chance) -> (Setting, f64) {
    let (mut setting, phase) = phase(chance);
    dashpots(chance, &mut setting);
    let of_v = [chance.between(-1.0, 1.0), chance.between(1.0, 4.0)];
    limits(chance, &mut setting, of_v);
    (setting, phase)
}
