//! The keys of sweep and case files, one row for each. Readers, messages and the guide's reference
//! use the same rows.
//!
//! Longer than most files: it is a table, with a row for each key.

/// A key of a file, with the facts about it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Key {
    /// The name.
    pub name: &'static str,
    /// The values that it takes: a type and, where there are limits, its range.
    pub takes: &'static str,
    /// The value if it is left out; none for a required key.
    pub default: Option<&'static str>,
    /// Its meaning.
    pub meaning: &'static str,
}

pub(super) const fn key(
    name: &'static str,
    takes: &'static str,
    default: &'static str,
    meaning: &'static str,
) -> Key {
    Key {
        name,
        takes,
        default: Some(default),
        meaning,
    }
}

pub(super) const fn needed(name: &'static str, takes: &'static str, meaning: &'static str) -> Key {
    Key {
        name,
        takes,
        default: None,
        meaning,
    }
}

/// The names of the keys of a table.
pub(super) fn names(keys: &[Key]) -> Vec<&'static str> {
    keys.iter().map(|key| key.name).collect()
}

const TITLE: Key = key(
    "title",
    "one line of at most 200 characters",
    "none",
    "stands above pictures and in the file",
);
const FIXED: Key = key(
    "fixed",
    "a table",
    "defaults of the parameters",
    "parameters that do not vary; those of a friction law stand in `[friction]`",
);
const FRICTION: Key = key(
    "friction",
    "a table",
    "no law: then mu_prime and mu_k are parameters",
    "the friction law",
);
const START: Key = key(
    "start",
    "a table",
    "even sliding at v0, 1 % faster than pulled",
    "where motions begin: x_dot0 and a0, or switch_on_phase",
);
const UNITS_KEY: Key = key(
    "units",
    "\"SI\", \"dimensionless\" or a table",
    "\"dimensionless\"; \"SI\" if a number has a unit",
    "the units of numbers without one of their own, and of what is made of the file",
);

/// The keys of a sweep file.
pub(crate) const SWEEP: [Key; 18] = [
    TITLE,
    key(
        "system",
        "a system file, the name of a shipped system, or a table",
        "the letter's",
        "the linear system; axes and `[fixed]` take its parameters, and tau",
    ),
    key(
        "picture",
        "the name of one of the fields",
        "the field that says most",
        "the field that pictures show; no part of what is computed",
    ),
    key(
        "fields",
        "a list of names of fields",
        "[\"n_unstable\"]; with protocol = \"limit\" all of its fields",
        "what is computed for every cell",
    ),
    key(
        "boundaries",
        "true or false",
        "true with fields of sliding, up to 1000 planes over the delay and one more axis; beyond \
         the letter up to 100 planes of any two axes",
        "whether the exact boundaries of stability are traced",
    ),
    key(
        "degree_of_stability",
        "a list of 1 to 16 rates, increasing, each from 1e-12 to 1e12",
        "none",
        "curves on which the abscissa is minus this, beside the boundaries",
    ),
    key(
        "best",
        "true or false",
        "false",
        "whether the setting of fastest decay is looked for in every plane of a gain and the delay",
    ),
    key(
        "protocol",
        "\"follow\", \"switch-on\" or \"limit\"",
        "\"follow\"",
        "which question the critical velocity answers: v0 raised under control; control switched \
         on at a phase; Coulomb friction under load control as the delay vanishes",
    ),
    key(
        "phase",
        "\"worst\"",
        "switch_on_phase, 0 unless given",
        "with protocol = \"switch-on\": the worst of 32 phases counts",
    ),
    key(
        "verify",
        "a share, from 0 to 1",
        "1/256",
        "with protocol = \"follow\": how many cells are recomputed by simulation",
    ),
    needed(
        "axes",
        "a table: for each parameter a list of values or a range",
        "parameters that vary, the outermost first",
    ),
    FIXED,
    FRICTION,
    START,
    key(
        "simulation",
        "a table",
        "its defaults",
        "how far and how exactly motions are followed",
    ),
    key(
        "basin",
        "a table",
        "its defaults",
        "of which starts `basin_share` is the share",
    ),
    UNITS_KEY,
    key(
        "tolerance",
        "a table",
        "its default",
        "how near to a boundary a cell is marginal",
    ),
];

/// The keys of a range of an axis.
pub(crate) const RANGE: [Key; 4] = [
    needed(
        "from",
        "a number, or text like \"1 mm/s\"",
        "the first value",
    ),
    needed("to", "a number, or text like \"1 mm/s\"", "the last value"),
    needed(
        "points",
        "a whole number, 2 to 10 000 000",
        "how many values",
    ),
    key(
        "spacing",
        "\"linear\" or \"log\"",
        "\"linear\"",
        "equal differences, or equal ratios; these on either side of 0",
    ),
];

/// The keys of `[friction]` besides the parameters of the laws.
pub(crate) const FRICTION_TABLE: [Key; 6] = [
    needed("law", "the name of a law", "the law"),
    key(
        "speeds",
        "2 to 4096 numbers of 0 or more, increasing",
        "none",
        "with law = \"table\": the speeds of the measured points",
    ),
    key(
        "mu_k",
        "as many numbers",
        "none",
        "with law = \"table\": the friction coefficients there; with law = \"formula\": an \
         expression in the speed `v`, whose other names are keys beside it",
    ),
    key(
        "table",
        "the name of a file of columns, a table of keys, or a list of pairs [speed, mu_k]",
        "none",
        "with law = \"table\": the points, in place of both lists; a name is read from the folder \
         of the file it stands in",
    ),
    key(
        "units",
        "a table of units, such as { sigma = \"s/m\" }",
        "those in which the parameters are given",
        "with law = \"formula\": the units of its own parameters, made of those of the file",
    ),
    key(
        "fit",
        "a table",
        "none: the law is as given",
        "what `slipmap fit` found of the errors of the law; `point`, `margins` and `best` tell \
         what follows from them",
    ),
];

/// The keys of a measured curve, `table` of `[friction]`.
pub(crate) const CURVE: [Key; 5] = [
    key(
        "file",
        "the name of a file of columns",
        "none: then text",
        "the file with the points",
    ),
    key(
        "text",
        "a text of columns",
        "none: then file",
        "the points as text, in place of a file",
    ),
    key(
        "columns",
        "a list like \"speed=2,mu=3\" or \"speed=v,force=F,load=5\"",
        "by titles, or the only two columns of numbers",
        "the columns of speed, and mu or force and load, by title or number",
    ),
    key(
        "normal_load",
        "a number from 1e-12 to 1e12",
        "normal_load in `[fixed]`",
        "the load by which a force is divided where no column has it",
    ),
    key(
        "speed_unit",
        "a length over a time, like \"mm/s\"",
        "the unit in the title, or else that of `[units]`",
        "the unit of the speeds, which are turned into that of `[units]`",
    ),
];

/// The keys of `[simulation]` in a sweep file; in a case file they stand at the top.
pub(crate) const SIMULATION: [Key; 4] = [
    key(
        "horizon",
        "a time, from 1e-12 to 1e12",
        "1000 sqrt(mass/stiffness) after switch-on",
        "until when the outcome is looked for",
    ),
    key(
        "tolerance",
        "a number from 1e-15 to 1e-3",
        "1e-12",
        "the error allowed in a step, relative",
    ),
    key(
        "steps",
        "a whole number from 1 to 1 000 000 000",
        "1 000 000",
        "the most steps of a motion, which is undecided beyond them",
    ),
    key(
        "seed",
        "a whole number from 0 on",
        "0",
        "what the noise of readings is drawn with: another one, other noise",
    ),
];

/// The keys of `[basin]`.
pub(crate) const BASIN: [Key; 4] = [
    key(
        "over",
        "\"state\" or \"phase\"",
        "\"state\"",
        "velocities and elongations that control finds at t = 0, or phases of uncontrolled \
         stick-slip at which it is switched on",
    ),
    key(
        "starts",
        "a power of two from 64 to 1 048 576",
        "256",
        "how many starts are followed in every cell",
    ),
    key(
        "x_dot0",
        "{ from, to }",
        "0 to v0 + sqrt(v0^2 + (mu_s normal_load)^2/(stiffness mass))",
        "the range of velocities",
    ),
    key(
        "a0",
        "{ from, to }",
        "-mu_s normal_load/stiffness to mu_s normal_load/stiffness",
        "the range of elongations",
    ),
];

/// The keys of an interval of `[basin]`.
pub(super) const ENDS: [&str; 2] = ["from", "to"];

/// The keys of `[units]`.
pub(crate) const UNITS: [Key; 3] = [
    needed("force", "one word of 1 to 20 letters", "the unit of force"),
    needed(
        "length",
        "one word of 1 to 20 letters",
        "the unit of length",
    ),
    needed("time", "one word of 1 to 20 letters", "the unit of time"),
];

/// The keys of `[tolerance]`.
pub(crate) const TOLERANCE: [Key; 1] = [key(
    "marginal",
    "a number from 2.220446049250313e-16 to 0.01",
    "1.4210854715202004e-14",
    "a delay this near to a crossing, relative to the larger of the crossing and 1, is marginal",
)];

/// The keys of a case file.
pub(crate) const CASE: [Key; 13] = [
    TITLE,
    needed("friction", "a table", "the friction law"),
    FIXED,
    key(
        "feedback",
        "a table",
        "delayed feedback by the gains of `[fixed]`",
        "control by the return map",
    ),
    key(
        "switch_on",
        "a time from 0 to 1e12, or false",
        "0",
        "when control begins to act; false: never",
    ),
    Key {
        default: Some("1000 sqrt(mass/stiffness) after switch-on and the last `[[programme]]`"),
        ..SIMULATION[0]
    },
    SIMULATION[1],
    SIMULATION[2],
    SIMULATION[3],
    START,
    key(
        "programme",
        "up to 1000 tables `[[programme]]`",
        "v0 stays what it is",
        "v0 in time",
    ),
    key(
        "trace",
        "a table",
        "its defaults",
        "until when the motion is written, and how densely",
    ),
    UNITS_KEY,
];

/// The keys of `[feedback]`.
pub(crate) const FEEDBACK: [Key; 5] = [
    needed(
        "control",
        "\"return-map\"",
        "at each reading, `sample_time` apart, the load is set to what brings the block to sliding",
    ),
    needed(
        "amplitude",
        "a load greater than 0 and less than normal_load",
        "the largest change of the load; where more is needed there is none",
    ),
    key(
        "model",
        "\"exact\" or \"reconstructed\"",
        "\"exact\"",
        "where the return map comes from: the friction law, or a record near sliding",
    ),
    key(
        "record",
        "a whole number from 7 to 100 000",
        "20",
        "the most readings of the record; it ends where the block leaves the vicinity of sliding",
    ),
    key(
        "pulse",
        "a load greater than 0 and less than normal_load",
        "0.01 normal_load",
        "the largest pulse of the load in the record",
    ),
];

/// The keys of `[[programme]]`.
pub(crate) const PROGRAMME: [Key; 3] = [
    needed(
        "at",
        "a time greater than 0, to 1e12, later than that of the entry before",
        "when v0 is this",
    ),
    needed(
        "v0",
        "a velocity from 1e-12 to 1e12, within v_min and v_max",
        "the pulling velocity from then on",
    ),
    key(
        "ramp",
        "true or false",
        "false: v0 jumps",
        "whether v0 comes there on a straight line from the entry before, or from t = 0",
    ),
];

/// The keys of `[trace]`.
pub(crate) const TRACE: [Key; 3] = [
    key(
        "until",
        "a time, from 1e-12 to 1e12",
        "when the outcome is known",
        "the end of the trace",
    ),
    key(
        "samples",
        "a whole number from 1 to 64",
        "24",
        "samples in each step of the integrator",
    ),
    key(
        "interval",
        "a time, from 1e-12 to 1e12",
        "none",
        "samples at all multiples of this time instead",
    ),
];

/// The keys of an experiment, a file that `slipmap measure` reads.
pub(crate) const EXPERIMENT_FILE: [Key; 8] = [
    TITLE,
    needed("experiment", "a table", "what is measured, and how"),
    needed("friction", "a table", "the friction law that is put in"),
    Key {
        meaning: "parameters but v0; gain and delay with setting = \"given\"",
        ..FIXED
    },
    SIMULATION[1],
    SIMULATION[2],
    SIMULATION[3],
    UNITS_KEY,
];

/// The keys of `[experiment]`.
pub(crate) const EXPERIMENT: [Key; 8] = [
    needed(
        "v0",
        "a list of 1 to 1000 velocities, or a range as of an axis",
        "the pulling velocities, in the order in which they are measured",
    ),
    key(
        "setting",
        "\"best\" or \"given\"",
        "\"best\"",
        "gain and delay: the robust best ones of each v0, or those in `[fixed]`",
    ),
    key(
        "control",
        "\"load\" or \"velocity\"",
        "\"load\"",
        "with setting = \"best\": the gain that is searched beside the delay",
    ),
    key(
        "start",
        "\"sliding\", \"step\" or \"stick-slip\"",
        "\"sliding\"",
        "how each v0 begins: sliding, 1 % faster than pulled, as after a small step; from sliding \
         at the v0 before, v0 jumps; or just released from uncontrolled stick-slip",
    ),
    key(
        "wait",
        "a time, from 1e-12 to 1e12",
        "25 relaxation times and 2 delays",
        "how long each v0 is held before the mean begins",
    ),
    key(
        "average",
        "a time, from 1e-12 to 1e12",
        "100 relaxation times",
        "how long the elongation is averaged",
    ),
    key(
        "drift",
        "a rate, 1/time",
        "0",
        "r of a v0 that drifts as v0 (1 + r t), t from its beginning",
    ),
    key(
        "repeats",
        "a whole number from 1 to 100 000",
        "1",
        "how often each v0 is measured, with noise of its own",
    ),
];

#[cfg(test)]
mod tests {
    use super::super::axis::MOST_POINTS;
    use super::super::basin::{Basin, FEWEST_STARTS, MOST_STARTS};
    use super::super::parameter::LARGEST;
    use super::super::search::{LIMIT, PHASES, Protocol};
    use super::super::simulation::Simulation;
    use super::*;
    use crate::linear::MarginalTolerance;
    use crate::model::Record;

    fn row<'a>(keys: &'a [Key], name: &str) -> &'a Key {
        keys.iter().find(|key| key.name == name).unwrap()
    }

    /// A number with its digits in groups of three, as in the rows.
    fn grouped(number: u64) -> String {
        let digits = number.to_string();
        let mut text = String::new();
        for (place, digit) in digits.chars().enumerate() {
            if place > 0 && (digits.len() - place).is_multiple_of(3) {
                text.push(' ');
            }
            text.push(digit);
        }
        text
    }

    /// The numbers in the rows are those of the code.
    #[test]
    fn rows_tell_the_numbers_of_the_program() {
        let simulation = Simulation::default();
        assert_eq!(
            row(&SIMULATION, "steps").default,
            Some(&*grouped(simulation.steps))
        );
        let tolerance = row(&SIMULATION, "tolerance").default.unwrap();
        assert_eq!(tolerance.parse::<f64>().unwrap(), simulation.tolerance);
        let starts = row(&BASIN, "starts");
        assert_eq!(starts.default, Some(&*Basin::default().starts.to_string()));
        let [fewest, most] = [FEWEST_STARTS, MOST_STARTS].map(|n| grouped(n.into()));
        assert!(starts.takes.ends_with(&format!("from {fewest} to {most}")));
        let marginal = row(&TOLERANCE, "marginal").default.unwrap();
        assert_eq!(
            marginal.parse::<f64>().unwrap(),
            MarginalTolerance::default().0
        );
        let takes = row(&TOLERANCE, "marginal").takes;
        assert!(
            takes.contains(&format!("from {:e} to", f64::EPSILON)),
            "{takes}"
        );
        assert!(row(&RANGE, "points").takes.ends_with(&grouped(MOST_POINTS)));
        for name in Protocol::NAMES.into_iter().chain([LIMIT]) {
            assert!(row(&SWEEP, "protocol").takes.contains(name));
        }
        assert!(row(&SWEEP, "phase").meaning.contains(&PHASES.to_string()));
        assert_eq!(
            row(&FEEDBACK, "record").default,
            Some(&*Record::READINGS.to_string())
        );
        assert!(
            row(&FEEDBACK, "pulse")
                .default
                .unwrap()
                .starts_with(&Record::PULSE.to_string())
        );
        assert_eq!(LARGEST, 1e12);
    }

    #[test]
    fn no_key_is_named_twice() {
        for keys in [
            &SWEEP[..],
            &RANGE,
            &FRICTION_TABLE,
            &crate::setting::fit_keys::FIT,
            &CURVE,
            &SIMULATION,
            &BASIN,
            &UNITS,
            &TOLERANCE,
            &CASE,
            &FEEDBACK,
            &PROGRAMME,
            &TRACE,
            &EXPERIMENT_FILE,
            &EXPERIMENT,
        ] {
            let mut names = names(keys);
            names.sort_unstable();
            let all = names.len();
            names.dedup();
            assert_eq!(names.len(), all);
        }
    }
}
