//! A cell's setting as text that gives the same setting when it is read: for requests, files and
//! the command line.

use crate::critical::switch_on::Phase;
use crate::setting::SweepSpec;
use crate::setting::command::{command_line, point_command, vc_command};
use crate::setting::parameter::Parameter;
use crate::setting::search::Protocol;
use crate::setting::setting_text::{number, setting_text, table};
use crate::setting::simulation::Simulation;
use crate::setting::values::Setting;
use crate::sweep::Plan;

/// The requests about a cell, as text; none for those that do not apply to it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct CellTexts {
    /// A point of continuous sliding, or of a system from a file.
    pub point: Option<String>,
    /// A problem of the critical velocity.
    pub vc: Option<String>,
    /// A case file: the motion from the cell's start.
    pub motion: Option<String>,
    /// The command line for the point or, if there is none, for the critical velocity; none for a
    /// law or a system that flags cannot express.
    pub command: Option<String>,
}

impl CellTexts {
    /// The texts of the cell at `index`.
    #[must_use]
    pub(crate) fn of(plan: &Plan, index: &[usize]) -> Self {
        let spec = &plan.spec;
        let setting = plan.setting(index);
        if spec.limit {
            let asked = "vc --protocol=limit";
            return Self {
                command: command_line(asked, &setting, Parameter::of_limit),
                ..Self::default()
            };
        }
        let whole = || setting_text(&setting, &spec.units, |_| true);
        if setting.system().is_some() {
            return Self {
                point: Some(whole()),
                command: point_command(&setting),
                ..Self::default()
            };
        }
        let has = |parameter| !setting.get(parameter).is_nan();
        let uncontrolled = !setting.control().act();
        let delay = has(Parameter::Tau);
        let slides = setting.law().is_none() || has(Parameter::V0);
        let law = setting.law().is_some();
        let point = (slides && delay).then(whole);
        let no_v0 = |parameter| parameter != Parameter::V0;
        let protocol = spec
            .critical
            .map_or(Protocol::Follow, |search| search.protocol);
        let protocol = protocol.at(&setting);
        let vc = (law && (delay || uncontrolled))
            .then(|| asked_for(protocol) + &setting_text(&setting, &spec.units, no_v0));
        let moves = law && slides && (delay || uncontrolled);
        let command = match (&point, &vc) {
            (Some(_), _) => point_command(&setting),
            (None, Some(_)) => vc_command(&setting, protocol),
            (None, None) => None,
        };
        Self {
            point,
            vc,
            motion: moves.then(|| case(spec, &setting)),
            command,
        }
    }
}

/// The keys of the protocol for a critical velocity.
fn asked_for(protocol: Protocol) -> String {
    let name = protocol.name();
    match protocol {
        Protocol::Follow => String::new(),
        Protocol::SwitchOn(Phase::Worst(_)) => {
            format!("protocol = \"{name}\"\nphase = \"worst\"\n\n")
        }
        Protocol::SwitchOn(Phase::After(time)) => {
            let phase = Parameter::SwitchOnPhase.name();
            format!(
                "protocol = \"{name}\"\nstart.{phase} = {}\n\n",
                number(time)
            )
        }
    }
}

/// The motion of a setting from its start.
fn case(spec: &SweepSpec, setting: &Setting) -> String {
    let mut said = String::new();
    let Simulation {
        horizon,
        tolerance,
        steps,
        seed,
        ..
    } = &spec.simulation;
    let usual = Simulation::default();
    if let Some(horizon) = horizon {
        said += &format!("horizon = {}\n", number(*horizon));
    }
    if *tolerance != usual.tolerance {
        said += &format!("tolerance = {}\n", number(*tolerance));
    }
    if *steps != usual.steps {
        said += &format!("steps = {steps}\n");
    }
    if *seed != usual.seed {
        said += &format!("seed = {seed}\n");
    }
    if !said.is_empty() {
        said += "\n";
    }
    said += &setting_text(setting, &spec.units, |_| true);
    let begins = |p: Parameter| p.of_start() && !setting.get(p).is_nan();
    if Parameter::ALL.into_iter().any(begins) {
        said += &table("start", setting, begins);
    } else if spec.follows_motions() && spec.simulation.disturbance == 0.0 {
        // Motions of such a map, which is an older one, start in equilibrium.
        let v0 = number(setting.get(Parameter::V0));
        said += &format!("\n[start]\n{} = {v0}\n", Parameter::XDot0.name());
    }
    said
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::CaseSpec;
    use crate::setting::point_file::{PointOf, PointSpec};

    /// Checks that settings are equal; two missing values count as equal.
    #[track_caller]
    fn assert_same(found: &Setting, expected: &Setting, but: &[Parameter]) {
        assert_eq!(found.law(), expected.law());
        assert_eq!(found.system(), expected.system());
        assert!(found.own().eq(expected.own()));
        for parameter in Parameter::ALL.into_iter().filter(|p| !but.contains(p)) {
            let bits = |setting: &Setting| setting.get(parameter).to_bits();
            assert_eq!(bits(found), bits(expected), "{}", parameter.name());
        }
    }

    const START: [Parameter; 3] = [Parameter::XDot0, Parameter::A0, Parameter::SwitchOnPhase];

    /// A measured friction law.
    const TABLE: &str = "[friction]\nlaw = \"table\"\nmu_s = 0.7\n\
        speeds = [0.0, 0.1, 0.30000000000000004]\nmu_k = [0.6, 0.5, 0.1]\n";

    #[test]
    fn texts_are_read_as_the_setting_that_they_are_of() {
        let ranges = "tau = { from = 0.03, to = 3.0, points = 41, spacing = \"log\" }\n";
        let units = "[units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n";
        for (sweep, told) in [
            (
                format!("[axes]\nmu_prime = [-0.1, -0.30000000000000004]\n{ranges}"),
                [true, false, false],
            ),
            (
                format!(
                    "[axes]\nmu_prime_rest = [-0.5, -2.0]\nalpha_n = {{ from = -12.0, to = -0.2, \
                     points = 7 }}\n{ranges}[friction]\nlaw = \"weakening\"\nmu0 = 0.5\n[fixed]\n\
                     v0 = 0.2\nmass = 1.7e-9\n{units}"
                ),
                [true, true, true],
            ),
            (
                format!("[axes]\nv0 = [0.1, 0.2]\n{ranges}[fixed]\nalpha_v = -0.1\n{TABLE}"),
                [true, true, true],
            ),
            (
                format!(
                    "fields = [\"vc\"]\n[axes]\nalpha_v = [-0.3, -0.1]\n{ranges}\
                     [friction]\nlaw = \"stribeck\"\nmu0 = 0.5\nv_s = 0.1\nmu_s = 0.9\n"
                ),
                [false, true, false],
            ),
            (
                "fields = [\"outcome\"]\n[axes]\na0 = [-0.6, 0.1]\nx_dot0 = [0.5, 1.5]\n\
                 [friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n[fixed]\n\
                 v0 = 0.118\nalpha_n = -7.0\ntau = 1.0\n\
                 [simulation]\nhorizon = 900.5\ntolerance = 1e-9\nsteps = 12345\n"
                    .to_owned(),
                [true, true, true],
            ),
            (
                format!(
                    "system = \"letter\"\n[axes]\nalpha_v = [-0.3, -0.1]\n{ranges}[fixed]\n\
                     mu_prime = -0.30000000000000004\nlatency = 0.1\n{units}"
                ),
                [true, false, false],
            ),
            (
                format!(
                    "[system]\nP = \"s^2 + c*s + 1\"\nQ = \"k\"\n[system.parameters]\n\
                     c = {{ default = 0.1, long_name = \"a \\\"word\\\"\" }}\nk = 0\n\
                     [axes]\nk = [-0.3, -0.1]\n{ranges}"
                ),
                [true, false, false],
            ),
        ] {
            let plan = Plan::new(sweep.parse().unwrap()).unwrap();
            for number in [0, plan.cells() / 2 + 1, plan.cells() - 1] {
                let index = crate::sweep::plan::tile::index_of(number, plan.shape());
                let (texts, setting) = (CellTexts::of(&plan, &index), plan.setting(&index));
                let found = [&texts.point, &texts.vc, &texts.motion].map(Option::is_some);
                assert_eq!(found, told, "{sweep}");
                assert_read(&texts, &plan, &setting);
            }
        }
    }

    /// Checks that reading the texts gives the setting.
    #[track_caller]
    fn assert_read(texts: &CellTexts, plan: &Plan, setting: &Setting) {
        if let Some(text) = &texts.point {
            let read = PointSpec::read(text, PointOf::Sliding).unwrap();
            assert_same(&read.setting, setting, &START);
            assert_eq!(read.units, plan.spec.units);
        }
        if let Some(text) = &texts.vc {
            let read = PointSpec::read(text, PointOf::CriticalVelocity).unwrap();
            let but = [&START[..], &[Parameter::V0]].concat();
            assert_same(&read.setting, setting, &but);
        }
        if let Some(text) = &texts.motion {
            let read: CaseSpec = text.parse().unwrap();
            // Without a given start, the case disturbs sliding.
            let but = if read.start_assumed { &START[..] } else { &[] };
            assert_same(&read.setting, setting, but);
            let motion = plan.spec.simulation.case(&read.setting, 0.0).unwrap();
            assert_eq!(Some(read.case), motion);
        }
    }

    #[test]
    fn commands_say_it_by_flags_where_they_can() {
        let plan = |text: &str| Plan::new(text.parse().unwrap()).unwrap();
        let sliding =
            plan("[axes]\nmu_prime = [-0.3]\ntau = [0.1, 4.15]\n[fixed]\nalpha_v = -0.33\n");
        let command = CellTexts::of(&sliding, &[0, 1]).command.unwrap();
        let parts = [
            "slipmap point",
            "--mu-prime=-0.3",
            "--alpha-v=-0.33",
            "--tau=4.15",
        ];
        assert!(parts.iter().all(|part| command.contains(part)), "{command}");
        let limit = plan(
            "protocol = \"limit\"\nfields = [\"vc_over_vtilde\"]\n\
             [axes]\ngamma = [0.1, 0.2]\nmu_ratio = [0.5]\n",
        );
        let command = CellTexts::of(&limit, &[1, 0]).command.unwrap();
        assert_eq!(
            command,
            "slipmap vc --protocol=limit --gamma=0.2 --mu-ratio=0.5"
        );
    }
}
