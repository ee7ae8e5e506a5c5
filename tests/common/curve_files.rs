//! Measured curves as programs and people write them, in `tests/program/curves`, and what is read
//! from each.

/// What is said beside the name of a file.
#[derive(Clone, Copy, Default)]
pub(crate) struct Said {
    pub columns: Option<&'static str>,
    pub load: Option<&'static str>,
    pub speed_unit: Option<&'static str>,
    pub si: bool,
}

/// What comes of a file.
pub(crate) enum Read {
    /// The three points at 0, 0.25 and 0.5, with a remark or none.
    Points(&'static str),
    /// A mistake: what is said of it, and what to type as flags and as keys.
    Refused(&'static str, [&'static str; 2]),
}

/// A file of columns.
pub(crate) struct Curve {
    pub file: &'static str,
    pub said: Said,
    pub read: Read,
}

/// The points of every curve that is read.
pub(crate) const SPEEDS: [f64; 3] = [0.0, 0.25, 0.5];
pub(crate) const MU_K: [f64; 3] = [0.5, 0.4, 0.375];

const NOTHING: Said = Said {
    columns: None,
    load: None,
    speed_unit: None,
    si: false,
};
const SI: Said = Said {
    si: true,
    ..NOTHING
};

const fn columns(columns: &'static str) -> Said {
    Said {
        columns: Some(columns),
        ..NOTHING
    }
}

const fn points(file: &'static str, said: Said, remark: &'static str) -> Curve {
    let read = Read::Points(remark);
    Curve { file, said, read }
}

const fn refused(
    file: &'static str,
    said: Said,
    message: &'static str,
    advice: [&'static str; 2],
) -> Curve {
    let read = Read::Refused(message, advice);
    Curve { file, said, read }
}

pub(crate) const CURVES: &[Curve] = &[
    points("plain.csv", NOTHING, ""),
    points("untitled.txt", NOTHING, ""),
    points("german.csv", SI, ""),
    points("german.csv", NOTHING, "speeds are in m/s by their title"),
    points("tabs.tsv", NOTHING, ""),
    points("bom.csv", SI, ""),
    points("windows1252.csv", NOTHING, ""),
    points("utf16.txt", NOTHING, ""),
    points("comments.csv", SI, ""),
    points("separator.csv", NOTHING, ""),
    points("index.csv", NOTHING, ""),
    points("further.csv", columns("speed=2,mu=4"), ""),
    points("named.csv", columns("speed=belt,mu=3"), ""),
    points(
        "order.csv",
        NOTHING,
        "column 1 (belt) is taken as the speed, column 2 (ratio) as the friction",
    ),
    points("swapped.csv", NOTHING, ""),
    points(
        "force.csv",
        Said {
            load: Some("10"),
            ..SI
        },
        "",
    ),
    points(
        "newtons.csv",
        Said {
            load: Some("10"),
            ..NOTHING
        },
        "forces are in N by their title, but the setting has no units: they are divided by the \
         normal load as it is given, 10",
    ),
    points("loads.csv", NOTHING, ""),
    points("loads.csv", columns("load=3,force=2,speed=1"), ""),
    points(
        "negative.csv",
        NOTHING,
        "2 readings at negative speeds taken as at positive ones: mu_k is the same there",
    ),
    points("unsorted.csv", NOTHING, ""),
    points(
        "duplicates.csv",
        NOTHING,
        "2 readings at the same speeds are averaged to 1 point, with a standard deviation of up \
         to 8.8 %",
    ),
    points(
        "gaps.csv",
        NOTHING,
        "3 rows are left out: they are no numbers; the first is line 3",
    ),
    points(
        "infinite.csv",
        NOTHING,
        "2 rows are left out: they are no numbers; the first is line 3",
    ),
    points(
        "millimetres.csv",
        Said {
            speed_unit: Some("mm/s"),
            ..SI
        },
        "",
    ),
    points(
        "titled_unit.csv",
        SI,
        "speeds are in mm/s by their title, and turned into m s-1",
    ),
    refused(
        "millimetres.csv",
        Said {
            speed_unit: Some("mm/s"),
            ..NOTHING
        },
        "speeds in mm/s need units of the setting",
        ["say --units SI", "say units = \"SI\""],
    ),
    refused(
        "unclear.csv",
        NOTHING,
        "it is not clear which column is the speed",
        [
            "columns: 1 t, 2 belt, 3 ratio; say which: --columns speed=1,mu=2",
            "say which: table = { …, columns = \"speed=1,mu=2\" }",
        ],
    ),
    refused(
        "named.csv",
        columns("speed=4,mu=3"),
        "there is no column 4, given as the speed",
        [
            "columns: 1 t, 2 belt, 3 ratio; say which: --columns speed=2",
            "say which: table = { …, columns = \"speed=2\" }",
        ],
    ),
    refused(
        "named.csv",
        columns("speed=blet,mu=3"),
        "there is no column blet, given as the speed",
        ["did you mean `belt`?", "did you mean `belt`?"],
    ),
    refused(
        "unloaded.csv",
        NOTHING,
        "column 2 (F) is a force, and the load by which it is divided is not given",
        ["--normal-load 12.5", "normal_load = 12.5"],
    ),
    refused(
        "thousands.csv",
        NOTHING,
        "line 3, column 1 (v): 1,000 may be 1.000 or 1000",
        ["1000 and not 1,000"; 2],
    ),
    refused(
        "grouped.csv",
        NOTHING,
        "line 3, column 1 (v): 1.250,5 has separators of thousands",
        ["1000 and not 1,000"; 2],
    ),
    refused(
        "commas.csv",
        NOTHING,
        "it is not clear which column is the speed",
        ["columns are to be separated by `;` or tabs"; 2],
    ),
    refused(
        "not_positive.csv",
        NOTHING,
        "line 3, column 2 (mu): friction is greater than 0",
        ["leave the row out"; 2],
    ),
    refused(
        "rpm.csv",
        SI,
        "column 1 (v (rpm)): rpm is no known unit of speed",
        [
            "say the unit: --speed-unit mm/s",
            "say the unit: table = { …, speed_unit = \"mm/s\" }",
        ],
    ),
    refused(
        "words.csv",
        NOTHING,
        "no line has two numbers, a speed and mu_k or a force",
        ["columns are separated by `;`, tabs, commas or blanks"; 2],
    ),
];

/// Where the files are.
pub(crate) fn path(file: &str) -> std::path::PathBuf {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    root.join("tests/program/curves").join(file)
}

impl Said {
    /// The same as keys of a file, beside the source of the columns.
    pub(crate) fn keys(&self, source: &str) -> String {
        let key = |name: &str, value: Option<&str>| {
            value.map_or_else(String::new, |value| format!(", {name} = \"{value}\""))
        };
        let columns = key("columns", self.columns);
        let unit = key("speed_unit", self.speed_unit);
        let load = self
            .load
            .map_or_else(String::new, |load| format!(", normal_load = {load}"));
        let units = if self.si { "units = \"SI\"\n" } else { "" };
        let table = format!("table = {{ {source}{columns}{unit}{load} }}\n");
        format!("{units}[friction]\nlaw = \"table\"\n{table}")
    }
}

/// Whether a text says this, however its lines are broken.
pub(crate) fn says(text: &str, words: &str) -> bool {
    let plain = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    plain(text).contains(&plain(words))
}
