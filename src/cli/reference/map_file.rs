//! The contents of map and trace files.

use crate::answers::trace::{EVENTS, MODES};
use crate::linear::best::Kind;
use crate::sweep::described::curve_rows::CurveRows;
use crate::sweep::described::group_names;
use crate::sweep::described::schema::{self, root, summary};
use crate::sweep::described::trace::{QUANTITIES, TIME};

use super::markdown::{code, heading, paragraph, table};

/// Root attributes of maps, with their meanings.
const ROOT: [(&str, &str); 21] = [
    ("Conventions", "the conventions that the file follows"),
    (root::TITLE, "the title of the sweep"),
    (root::SOURCE, "the program"),
    (
        root::HISTORY,
        "when and by which command: the one thing that differs from run to run",
    ),
    ("references", "the letter"),
    (root::PROGRAM_VERSION, "the version of the program"),
    (root::GIT_REVISION, "the revision of its source"),
    (
        root::FORMAT_VERSION,
        "the version of the format; it marks a file as a map",
    ),
    (root::AXES, "the names of the axes, outermost first"),
    (
        root::PLAN_HASH,
        "a hash of everything on which cells depend",
    ),
    (root::SWEEP, "the text of the sweep file"),
    (
        root::CELLS_MISSING,
        "how many cells are not computed; absent in a complete map",
    ),
    (
        root::DISTURBANCE,
        "by which share of v0 motions without a start are faster than pulled",
    ),
    (
        root::MARGINAL_TOLERANCE,
        "the tolerance of the flag `marginal`",
    ),
    (root::PROTOCOL, "`limit`, in maps of that limit"),
    (root::FRICTION_LAW, "the name of the friction law"),
    (
        root::FRICTION_SPEEDS,
        "the speeds of a law of measured points",
    ),
    (root::FRICTION_MU_K, "its friction coefficients"),
    (root::FRICTION_FORMULA, "the formula of the formula law"),
    (
        schema::CONTENTS_SHA256,
        "SHA-256 of everything but cells, references and history",
    ),
    ("_NCProperties", "what netCDF readers look for"),
];

/// Attributes of datasets of cells, with their meanings.
const OF_CELLS: [(&str, &str); 9] = [
    ("coordinates", "the parameters that do not vary"),
    (
        schema::CHUNKS_SHA256,
        "SHA-256 of the stored bytes of all chunks, one after the other",
    ),
    (
        summary::ACTUAL_RANGE,
        "smallest and largest value, infinite ones among them",
    ),
    (summary::FINITE_RANGE, "smallest and largest finite one"),
    (summary::INFINITE, "how many values are −∞, and how many +∞"),
    (summary::WITHOUT_VALUE, "how many cells have no value"),
    (
        summary::FLAG_CELLS,
        "how many cells there are of each kind or flag, as in `flag_meanings`",
    ),
    (summary::UNFLAGGED, "how many cells have no flag"),
    (
        "ancillary_variables",
        "`status`, which speaks for all fields of a cell",
    ),
];

fn named(page: &mut String, rows: &[(&str, &str)]) {
    let rows = rows
        .iter()
        .map(|(name, what)| [code(name), (*what).to_owned()]);
    table(page, ["name", "what it is"], rows.collect());
}

/// The page.
pub(super) fn map_file(page: &mut String) {
    heading(page, 1, "The map file");
    paragraph(
        page,
        &format!(
            "HDF5 (1.10 or newer), laid out as netCDF-4 by the CF conventions. Version {} of the \
             format is written, versions from {} on are read. Axes are dimensions with \
             coordinates of the same name, the outermost first; parameters that do not vary are \
             scalar coordinates; each [field](fields.md) is a dataset over all axes. Behind the \
             end of the file stands a line with the SHA-256 of all its bytes.",
            schema::FORMAT_VERSION,
            schema::OLDEST_FORMAT_VERSION
        ),
    );
    heading(page, 2, "Attributes of the file");
    named(page, &ROOT);
    heading(page, 2, "Attributes of datasets of cells");
    paragraph(
        page,
        "Besides `long_name`, `units`, `comment`, `flag_values`, `flag_masks`, \
                     `flag_meanings` and `_FillValue`, as CF has them:",
    );
    named(page, &OF_CELLS);
    heading(page, 2, &format!("The group `{}`", schema::BOUNDARIES));
    paragraph(
        page,
        &format!(
            "Exact curves in every plane of two parameters (PARAMETER and SECOND below, which is \
             `tau` in planes with the delay), as contiguous ragged arrays of CF: curve after \
             curve, vertex after vertex. The axes outside of the plane stand in it once for every \
             curve, and with `corner_` before the name once for every corner. Where a system has \
             a parameter of the name of another column, such as `omega`, `{}` stands before the \
             parameter's name in this group and in tables of curves; the attribute `{}` then has \
             the name itself.",
            group_names::PREFIX,
            schema::PARAMETER
        ),
    );
    let rows = CurveRows::described().into_iter();
    let rows = rows.map(|(per, name, meaning)| [code(&name), per.to_owned(), meaning]);
    table(page, ["name", "one for each", "what it is"], rows.collect());
    heading(page, 2, &format!("The group `{}`", schema::BEST));
    let kinds: Vec<_> = Kind::ALL.into_iter().map(Kind::name).collect();
    paragraph(
        page,
        &format!(
            "With `best = true`: the setting of fastest decay of every plane, over the axes \
             outside of it. The gain and `tau`, and `{}` (one of: {}).",
            schema::best::ALL.join("`, `"),
            kinds.join(", "),
        ),
    );
    trace_file(page);
}

fn trace_file(page: &mut String) {
    heading(page, 2, "The trace file");
    paragraph(
        page,
        &format!(
            "What `slipmap simulate` writes, version {} of its format. Quantities over `{}`:",
            schema::TRACE_FORMAT_VERSION,
            TIME.name
        ),
    );
    let rows = QUANTITIES
        .iter()
        .map(|q| [code(q.name), q.long_name.to_owned()]);
    table(page, ["name", "what it is"], rows.collect());
    paragraph(
        page,
        &format!(
            "`{}` says what the block does from a sample on: {}. The group `{}` has `{}`, `{}` \
             and `{}` of every event; its kinds: {}.",
            schema::trace::MODE,
            MODES.map(|(_, name)| name).join(", "),
            schema::trace::EVENT,
            schema::trace::TIME,
            schema::trace::KIND,
            schema::trace::ELONGATION,
            EVENTS.map(|(_, name)| name).join(", "),
        ),
    );
}
