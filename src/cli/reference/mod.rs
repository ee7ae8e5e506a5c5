//! `slipmap reference`: the reference pages of the guide, generated from the tables that the
//! program itself uses. The command is hidden; `tests/guide/book.rs` compares the pages with its
//! output.
//!
//! - `command_line`: the command line, from the data of `--help`
//! - `map_file`: the contents of map and trace files
//! - `markdown`: pieces of a page in Markdown

mod command_line;
mod map_file;
mod markdown;

use std::fmt::Write;

use crate::linear::status::FLAGS;
use crate::setting::field::Storage;
use crate::setting::fit_keys;
use crate::setting::keys::{self, Key};
use crate::setting::law_kind::{LawKind, NamedLaw};
use crate::setting::system_keys;
use crate::setting::units::Units;
use crate::setting::{Field, Parameter};
use crate::sweep::described::schema;
use clap::ValueEnum;

use super::failure::Failure;
use super::say;
use command_line::command_line;
use map_file::map_file;
use markdown::{code, heading, paragraph, table};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The page
    #[arg(value_enum)]
    page: Page,
}

/// Pages, each named as its file.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Page {
    Parameters,
    Laws,
    Fields,
    SweepFiles,
    SystemFiles,
    MapFile,
    CommandLine,
}

/// The first lines of each page.
const NOTE: &str = "<!-- Printed by `slipmap reference`, from the tables of the program: \
                    SLIPMAP_WRITE=1 cargo test --test guide writes it anew. -->\n";

/// Prints a page.
pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let mut page = String::from(NOTE);
    match args.page {
        Page::Parameters => parameters(&mut page),
        Page::Laws => laws(&mut page),
        Page::Fields => fields(&mut page),
        Page::SweepFiles => sweep_files(&mut page),
        Page::SystemFiles => system_files(&mut page),
        Page::MapFile => map_file(&mut page),
        Page::CommandLine => command_line(&mut page),
    }
    say::text(&page)
}

/// Powers of force, length and time as a unit in these three words.
fn dimension(powers: [i32; 3]) -> String {
    let words = ["force", "length", "time"].into_iter().zip(powers);
    let words = words
        .filter(|(_, power)| *power != 0)
        .map(|(word, power)| match power {
            1 => word.to_owned(),
            _ => format!("{word}^{power}"),
        });
    let words: Vec<_> = words.collect();
    match words.is_empty() {
        true => "1".into(),
        false => words.join(" "),
    }
}

fn parameters(page: &mut String) {
    heading(page, 1, "Parameters");
    paragraph(
        page,
        "Each parameter has one name: as a key in sweep and case files, as a variable in maps, \
         and, with `-` for `_`, as a flag. Any of them can be an axis of a sweep.",
    );
    let rows = Parameter::ALL.into_iter().map(|of| {
        let default = of
            .default_value()
            .map_or_else(String::new, |v| match v.is_finite() {
                true => format!("{v}"),
                false => "no limit".into(),
            });
        let flag = of
            .long_flag()
            .map_or_else(String::new, |flag| code(&format!("--{flag}")));
        [
            code(of.name()),
            of.symbol().to_owned(),
            of.long_name().to_owned(),
            dimension(of.dimension()),
            of.allowed().to_owned(),
            default,
            flag,
            of.group().name().to_owned(),
        ]
    });
    let titles = [
        "name", "symbol", "meaning", "unit", "range", "default", "flag", "group",
    ];
    table(page, titles, rows.collect());
    paragraph(
        page,
        "Groups: *model* and *pull* always have a meaning, *sliding* without a friction law, \
         *law* in `[friction]`, *start* for motions, *limit* with `protocol = \"limit\"` alone. \
         Without units masses, stiffnesses, loads and friction coefficients are 1 unless given, \
         so that numbers are the dimensionless groups.",
    );
}

fn laws(page: &mut String) {
    heading(page, 1, "Friction laws");
    paragraph(
        page,
        "`law` in `[friction]` of a file, `--friction` on the command line. Every law has the \
         static coefficient `mu_s`, 1 unless given; `v` is the sliding velocity.",
    );
    let rows = NamedLaw::all().iter().map(|of| {
        let law = LawKind::Named(of);
        let parameters = law.parameters().iter().map(|p| code(p.name()));
        [
            code(of.name()),
            of.formula().to_owned(),
            parameters.collect::<Vec<_>>().join(", "),
            law.needed().to_string(),
        ]
    });
    let table_row = [
        code(LawKind::TABLE),
        "monotone cubics (PCHIP) through measured points, constant beyond them".into(),
        "points".into(),
        "2 to 4096 points".into(),
    ];
    let formula_row = [
        code(LawKind::FORMULA),
        "the expression `mu_k` in the speed `v`".into(),
        "the names in it".into(),
        "all".into(),
    ];
    let titles = ["name", "μ_K(v)", "parameters", "how many are needed"];
    table(page, titles, rows.chain([table_row, formula_row]).collect());
}

fn fields(page: &mut String) {
    heading(page, 1, "Fields");
    paragraph(
        page,
        "What a sweep can ask for in `fields`, in the order in which maps hold them. Every map \
         has `status` besides. Units are those of the sweep; \"1\" where a field has none.",
    );
    for field in Field::ALL {
        heading(page, 2, &code(field.name()));
        let stored = match field.storage() {
            Storage::Count => "integer of 16 bits",
            Storage::Kind | Storage::Few => "integer of 8 bits",
            Storage::Real => "real of 64 bits",
        };
        let unit = field.unit(&Units::symbolic());
        let mut text = format!("{}. Unit: {unit}. Stored as: {stored}.", field.long_name());
        if let Some(comment) = field.comment() {
            let _ = write!(text, " Note: {comment}.");
        }
        if let Some(kinds) = field.kinds() {
            let kinds = kinds.into_iter().enumerate();
            let kinds: Vec<_> = kinds.map(|(i, kind)| format!("{i} {kind}")).collect();
            let _ = write!(text, " Kinds: {}.", kinds.join(", "));
        }
        let (beside_vc, comment) = field.described_at_vc();
        if beside_vc != field.long_name() {
            let _ = write!(text, " Beside fields of the critical velocity: {beside_vc}");
            if let Some(comment) = comment {
                let _ = write!(text, " ({comment})");
            }
            text.push('.');
        }
        paragraph(page, &text);
    }
    heading(page, 2, &code(schema::STATUS));
    paragraph(page, "Flags of each cell, the bits of one integer.");
    let rows = FLAGS.into_iter().map(|(mask, name)| {
        [
            mask.to_string(),
            code(name),
            meaning_of_flag(name).to_owned(),
        ]
    });
    table(page, ["bit", "name", "meaning"], rows.collect());
}

fn meaning_of_flag(name: &str) -> &'static str {
    match name {
        "certified" => "the argument principle confirms the roots of the cell",
        "marginal" => "the cell lies within rounding of a change of stability",
        "not_converged" => {
            "a computation in the cell came to no end: what depends on it is not known"
        }
        "disagree" => "two methods differ about the cell",
        "saturated" => "the count is larger than the map can hold",
        "sampled" => "the cell was recomputed by a second method",
        "outside_model" => {
            "the setting is outside the model's range, as where a formula gives no coefficient of \
             friction above 0: the cell has no values, and `slipmap point --map` says why"
        }
        _ => "",
    }
}

fn keys_of(page: &mut String, keys: &[Key]) {
    let rows = keys.iter().map(|key| {
        [
            code(key.name),
            key.takes.to_owned(),
            key.default.unwrap_or("has to be given").to_owned(),
            key.meaning.to_owned(),
        ]
    });
    table(page, ["key", "takes", "default", "meaning"], rows.collect());
}

fn sweep_files(page: &mut String) {
    heading(page, 1, "Sweep and case files");
    paragraph(
        page,
        "All are [TOML](https://toml.io). A sweep file asks for a map, a case file for one \
         motion, an experiment for friction measured through control. A key that is not known, or \
         that has no meaning where it stands, is refused at its place; nothing is passed over.",
    );
    heading(page, 2, "Keys of a sweep file");
    keys_of(page, &keys::SWEEP);
    heading(page, 2, "A range of an axis");
    keys_of(page, &keys::RANGE);
    heading(page, 2, "`[friction]`");
    paragraph(page, "Besides the [parameters of the law](laws.md):");
    keys_of(page, &keys::FRICTION_TABLE);
    heading(page, 2, "A measured curve");
    paragraph(
        page,
        "The keys of `table` in `[friction]`, where it is a table itself:",
    );
    keys_of(page, &keys::CURVE);
    heading(page, 2, "`[friction.fit]`");
    paragraph(
        page,
        "What `slipmap fit --save` writes of a law beside its parameters:",
    );
    keys_of(page, &fit_keys::FIT);
    heading(page, 2, "`[simulation]`");
    keys_of(page, &keys::SIMULATION);
    heading(page, 2, "`[basin]`");
    keys_of(page, &keys::BASIN);
    heading(page, 2, "`[units]`");
    keys_of(page, &keys::UNITS);
    heading(page, 2, "`[tolerance]`");
    keys_of(page, &keys::TOLERANCE);
    heading(page, 2, "Keys of a case file");
    keys_of(page, &keys::CASE);
    heading(page, 2, "`[feedback]`");
    keys_of(page, &keys::FEEDBACK);
    heading(page, 2, "`[trace]`");
    keys_of(page, &keys::TRACE);
    heading(page, 2, "`[[programme]]`");
    keys_of(page, &keys::PROGRAMME);
    heading(page, 2, "Keys of an experiment");
    paragraph(page, "A file that `slipmap measure` takes:");
    keys_of(page, &keys::EXPERIMENT_FILE);
    heading(page, 2, "`[experiment]`");
    keys_of(page, &keys::EXPERIMENT);
}

fn system_files(page: &mut String) {
    heading(page, 1, "System files");
    paragraph(
        page,
        "A file, or the table `system` of a sweep file, names a system with one delay by its \
         characteristic function D(s), by P and Q, or B and A, or D; by its matrices; or by \
         plant and controller.",
    );
    heading(page, 2, "Keys of a system");
    keys_of(page, &system_keys::SYSTEM);
    heading(page, 2, "A parameter");
    paragraph(
        page,
        "A number alone is its default. `--set NAME=VALUE`, `[fixed]` and axes give it a value.",
    );
    keys_of(page, &system_keys::OWN_PARAMETER);
    heading(page, 2, "`speed_axis`");
    keys_of(page, &system_keys::SPEED_AXIS);
    paragraph(
        page,
        "With it a sweep with `units` may give `rpm`, `Hz` or `\"rad/s\"` in the place of `tau`, \
         whatever the unit of `speed_axis`: `rpm = { from = 1000, to = 6000, points = 200 }` in \
         `[axes]`, or one number in `[fixed]`. Values are evenly spaced in the speed; the axis of \
         the map is `tau`, increasing. `slipmap point` takes `--rpm` with `--units`, and `slipmap \
         export` has a column of the speed behind `tau`. `--at rpm=3000` holds the axis of a map \
         at the nearest of its speeds.",
    );
    heading(page, 2, "Limits");
    paragraph(
        page,
        "Expressions have numbers, names of parameters, `tau` (or `τ`), `+ - * / ^`, parentheses \
         and functions; exponents and arguments of functions are without s, and divisors in \
         matrices and gains.",
    );
    let limits = system_keys::limits();
    let rows = limits.map(|(of, limit)| [of.to_owned(), limit]);
    table(page, ["of", "limit"], rows.to_vec());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_flag_has_a_meaning() {
        for (_, name) in FLAGS {
            assert!(!meaning_of_flag(name).is_empty(), "{name}");
        }
    }
}
