//! What slipmap is asked, in its own words: case files, flags, and shell commands that ask the same
//! again.

use super::law::{Friction, Law};
use super::random::Start;
use super::setting::{Corner, Setting};

/// A number as files and flags take it, to the last bit.
fn number(value: f64) -> String {
    format!("{value:?}")
}

/// The names and values of a law's coefficients.
fn coefficients(friction: &Friction) -> (&'static str, Vec<(&'static str, f64)>) {
    let (name, mut named) = match friction.law {
        Law::Coulomb { mu0 } => ("coulomb", vec![("mu0", mu0)]),
        Law::Weakening { mu0, v_s } => ("weakening", vec![("mu0", mu0), ("v_s", v_s)]),
        Law::Stribeck { mu0, v_s } => ("stribeck", vec![("mu0", mu0), ("v_s", v_s)]),
        Law::Table(_) => ("table", Vec::new()),
        Law::Formula { mu0, v_s, .. } => ("formula", vec![("mu0", mu0), ("v_s", v_s)]),
    };
    named.push(("mu_s", friction.mu_s));
    (name, named)
}

/// The expression of a formula, and the values of its own parameters.
pub(crate) fn formula(friction: &Friction) -> Option<(String, Vec<(&'static str, f64)>)> {
    let Law::Formula { shape, sigma, .. } = friction.law else {
        return None;
    };
    let text = format!("mu0 + (mu_s - mu0)*{} + sigma*v", shape.text());
    let delta = shape.exponent().map(|delta| ("delta", delta));
    Some((text, delta.into_iter().chain([("sigma", sigma)]).collect()))
}

/// M, κ, N0, the gains, the delay, memory and latency, as far as they are not by default.
fn parameters(s: &Setting) -> Vec<(&'static str, f64)> {
    let plain = [
        ("mass", s.mass),
        ("stiffness", s.stiffness),
        ("normal_load", s.load),
    ];
    let mut given: Vec<_> = plain.into_iter().filter(|(_, x)| *x != 1.0).collect();
    if s.amplitude == 0.0 {
        let gains = [("alpha_v", s.alpha_v), ("alpha_n", s.alpha_n)];
        given.extend(gains.into_iter().filter(|(_, x)| *x != 0.0));
        given.push(("tau", s.tau));
    }
    let echo = [
        ("memory", s.memory),
        ("latency", s.latency),
        ("sample_time", s.sample_time),
        ("damping", s.damping),
        ("viscous", s.viscous),
    ];
    given.extend(echo.into_iter().filter(|(_, x)| *x != 0.0));
    let limits = [
        ("v_min", s.of_v[0]),
        ("v_max", s.of_v[1]),
        ("load_min", s.of_load[0]),
        ("load_max", s.of_load[1]),
    ];
    given.extend(limits.into_iter().filter(|(_, x)| x.is_finite()));
    given
}

fn lines(named: &[(&str, f64)]) -> String {
    let line = |(name, value): &(&str, f64)| format!("{name} = {}\n", number(*value));
    named.iter().map(line).collect()
}

/// The tables `[friction]` and `[fixed]` of a file, with v0.
pub(crate) fn law_and_parameters(s: &Setting) -> String {
    let (name, named) = coefficients(&s.friction);
    let mut text = format!("[friction]\nlaw = \"{name}\"\n{}", lines(&named));
    if let Law::Table(curve) = &s.friction.law {
        text += &format!("speeds = {:?}\nmu_k = {:?}\n", curve.x, curve.y);
    }
    if let Some((expression, own)) = formula(&s.friction) {
        text += &format!("mu_k = \"{expression}\"\n{}", lines(&own));
    }
    text += &format!(
        "[fixed]\n{}{}",
        lines(&parameters(s)),
        lines(&[("v0", s.v0)])
    );
    if s.amplitude > 0.0 {
        let amplitude = lines(&[("amplitude", s.amplitude)]);
        text += &format!("[feedback]\ncontrol = \"return-map\"\n{amplitude}");
    }
    text
}

/// A case file that traces a motion to its horizon.
pub(crate) fn case_file(start: &Start) -> String {
    let s = &start.setting;
    let switch_on = match s.switch_on.is_finite() {
        true => number(s.switch_on),
        false => "false".into(),
    };
    // The horizon has to be later than the switch-on; events are told to the end of the trace in
    // any case.
    let horizon = 1.0
        + start.horizon
        + if s.switch_on.is_finite() {
            s.switch_on
        } else {
            0.0
        };
    let entry = |corner: &Corner| {
        let numbers = lines(&[("at", corner.at), ("v0", corner.v0)]);
        format!("[[programme]]\n{numbers}ramp = {}\n", corner.ramp)
    };
    let programme: String = s.programme.iter().map(entry).collect();
    format!(
        "switch_on = {switch_on}\nhorizon = {}\n{}[start]\n{}[trace]\nuntil = {}\n{programme}",
        number(horizon),
        law_and_parameters(s),
        lines(&[("x_dot0", start.x_dot0), ("a0", start.a0)]),
        number(start.horizon)
    )
}

/// A case file in which control is switched on at a phase of uncontrolled stick-slip.
pub(crate) fn phase_file(s: &Setting, phase: f64) -> String {
    format!(
        "{}[start]\n{}",
        law_and_parameters(s),
        lines(&[("switch_on_phase", phase)])
    )
}

/// Shell commands that write a case file and simulate it.
pub(crate) fn simulate_command(case: &str) -> String {
    format!("cat > case.toml <<'END'\n{case}END\nslipmap simulate case.toml --json --fresh")
}

/// A shell command that asks for the critical velocity.
pub(crate) fn vc_command(s: &Setting) -> String {
    let (name, named) = coefficients(&s.friction);
    let mut command = String::new();
    if let Law::Table(curve) = &s.friction.law {
        let rows = curve.x.iter().zip(&curve.y);
        let rows: String = rows.map(|(x, y)| format!("{x:?},{y:?}\n")).collect();
        command = format!("cat > curve.csv <<'END'\n{rows}END\n");
    }
    command += &format!("slipmap vc --friction {name}");
    if name == "table" {
        command += " --table curve.csv";
    }
    if let Some((expression, own)) = formula(&s.friction) {
        command += &format!(" --mu-k='{expression}'");
        for (name, value) in own {
            command += &format!(" --set={name}={}", number(value));
        }
    }
    for (name, value) in named.into_iter().chain(parameters(s)) {
        command += &format!(" --{}={}", name.replace('_', "-"), number(value));
    }
    command
}
