//! The output of `slipmap compare` for people: a table, and what stands above it.

use std::path::Path;

use crate::explore::comparison::{Compared, Comparison, ReachedShare};
use crate::explore::route::Route;
use crate::report::numbers::{grouped, unit_behind, with_error};
use crate::report::picture::{self, ComparedPicture};
use crate::setting::{CaseSpec, Parameter};
use crate::text::Shown;

use super::failure::Failure;
use super::say;

/// What stands above pages and pictures.
pub(super) const TITLE: &str = "Control by the return map and delayed feedback";

/// An answer in words and a table.
pub(super) struct Told {
    /// Paragraphs.
    pub text: Vec<String>,
    /// The picture, if there is one.
    pub svg: Option<String>,
    /// The names of columns, and rows.
    pub head: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Told {
    /// Prints the words and the table, in columns as wide as their texts.
    pub(super) fn print(&self) -> Result<(), Failure> {
        for text in &self.text {
            say::result(text)?;
        }
        let width = |column: usize| {
            let rows = self.rows.iter().chain([&self.head]);
            let texts = rows.filter_map(move |row| row.get(column));
            texts.map(|text| text.chars().count()).max().unwrap_or(0)
        };
        for row in [&self.head].into_iter().chain(&self.rows) {
            let cells = row.iter().enumerate();
            let line: Vec<String> = cells
                .map(|(column, text)| format!("{text:<width$}", width = width(column)))
                .collect();
            say::result(format_args!("  {}", line.join("  ").trim_end()))?;
        }
        Ok(())
    }
}

/// The name of a method with its sample time.
fn method(name: &str, sample_time: Option<f64>, spec: &CaseSpec) -> String {
    let unit = unit_behind(&spec.units.of([0, 0, 1]));
    let words = name.replace('-', " ");
    match sample_time {
        Some(time) => format!("{words}, h = {}{unit}", Shown(time)),
        None => words,
    }
}

/// A kind of starts in words, with the shares of it.
type Kind = (&'static str, fn(&Compared) -> &[ReachedShare]);
const KINDS: [Kind; 2] = [
    ("near sliding", |of| &of.near),
    ("from stick-slip", |of| &of.stick_slip),
];

/// The shares of a comparison.
pub(super) fn of_shares(found: &Comparison, spec: &CaseSpec) -> Told {
    let of_value = match found.over {
        "amplitude" => unit(spec, Parameter::NormalLoad),
        "noise" => unit(spec, Parameter::Noise),
        _ => String::new(),
    };
    let values = found.methods.first().map_or(&[][..], |of| &of.near);
    let mut head = vec!["starts".to_owned(), "method".to_owned()];
    head.extend(
        values
            .iter()
            .map(|of| format!("{} = {}{of_value}", found.over, Shown(of.value))),
    );
    let rows = KINDS.iter().flat_map(|(kind, shares)| {
        found.methods.iter().map(move |of| {
            let name = method(of.method, of.sample_time, spec);
            let shares = shares(of).iter().map(percent);
            let names = [(*kind).to_owned(), name];
            names.into_iter().chain(shares).collect()
        })
    });
    let fixed = fixed([found.amplitude, found.slope, found.noise], spec);
    let over = found.over;
    let told = [
        format!("shares of starts that reach sliding, in %, over {over}{fixed}"),
        format!("{}; model {}", followed(found, spec), found.model),
    ];
    Told {
        text: told.into_iter().chain(not_counted(found)).collect(),
        svg: None,
        head,
        rows: rows.collect(),
    }
}

/// The unit of a parameter behind its value.
fn unit(spec: &CaseSpec, parameter: Parameter) -> String {
    unit_behind(&spec.units.of_parameter(parameter))
}

/// What does not vary, in words; a slope that is right and readings without noise are not told.
fn fixed([amplitude, slope, noise]: [Option<f64>; 3], spec: &CaseSpec) -> String {
    let acts = |value: &f64| *value != 0.0;
    let fixed = [
        ("amplitude", amplitude, unit(spec, Parameter::NormalLoad)),
        ("slope", slope.filter(acts), String::new()),
        ("noise", noise.filter(acts), unit(spec, Parameter::Noise)),
    ];
    let told = fixed.into_iter().filter_map(|(name, value, unit)| {
        let value = Shown(value?);
        Some(format!(", {name} = {value}{unit}"))
    });
    told.collect()
}

/// Why starts are counted as not reaching sliding, and how many of a share are.
type NotCounted = (&'static str, fn(&ReachedShare) -> u32);

/// How many starts of all methods lift off or are undecided, where there are any.
fn not_counted(found: &Comparison) -> Option<String> {
    let kinds: [NotCounted; 2] = [
        ("lift off, where the load is 0", |of| of.lift_off),
        ("take too many steps to be known", |of| of.undecided),
    ];
    let told = kinds.iter().filter_map(|(what, count)| {
        // Delayed feedback has one share for all slopes.
        let places = |of: &Compared| match (found.over, of.method) {
            ("slope", "delayed-feedback") => 1,
            _ => usize::MAX,
        };
        let shares = found.methods.iter().flat_map(|of| {
            let [near, stick_slip] = [&of.near, &of.stick_slip];
            let kinds = [near, stick_slip].map(|shares| shares.iter().take(places(of)));
            kinds.into_iter().flatten()
        });
        let starts: u64 = shares.map(|of| u64::from(count(of))).sum();
        (starts > 0).then(|| format!("{} {what}", grouped(starts)))
    });
    let told: Vec<String> = told.collect();
    (!told.is_empty()).then(|| {
        let told = told.join(", and ");
        format!("of all starts {told}: they are counted as not reaching sliding")
    })
}

/// A share in percent with its error.
fn percent(of: &ReachedShare) -> String {
    match of.share.is_finite() {
        true => {
            let (share, error) = with_error(100.0 * of.share, 100.0 * of.error);
            format!("{share} ± {error}")
        }
        false => "none".to_owned(),
    }
}

/// How low v0 may become.
pub(super) fn of_route(found: &Route, spec: &CaseSpec) -> Told {
    let of_v0 = unit_behind(&spec.units.of_parameter(Parameter::V0));
    let of_time = unit_behind(&spec.units.of([0, 0, 1]));
    let of_load = unit_behind(&spec.units.of_parameter(Parameter::NormalLoad));
    let [from, to] = found.v0.map(Shown);
    let rows = found.methods.iter().map(|held| {
        vec![
            method(held.method, held.sample_time, spec),
            held.amplitude
                .map_or("-".to_owned(), |x| format!("{}{of_load}", Shown(x))),
            match held.lost_at {
                Some(v0) => format!("lost at {v0:.6}{of_v0}"),
                None if held.held.is_none() => "not known: too many steps".to_owned(),
                None => "to the end".to_owned(),
            },
        ]
    });
    Told {
        text: vec![
            format!(
                "sliding is held while v0 falls from {from} to {to}{of_v0} by t = {}{of_time}",
                Shown(found.until)
            ),
            format!(
                "model {}{}",
                found.model,
                fixed([None, Some(found.slope), Some(found.noise)], spec)
            ),
        ],
        svg: None,
        head: ["method", "amplitude", "held"].map(String::from).to_vec(),
        rows: rows.collect(),
    }
}

/// The number of starts with the unit of their time, in words.
fn followed(found: &Comparison, spec: &CaseSpec) -> String {
    let unit = unit_behind(&spec.units.of([0, 0, 1]));
    let starts = grouped(u64::from(found.starts));
    format!(
        "{starts} starts of each kind, followed for {}{unit}",
        Shown(found.horizon)
    )
}

/// The picture of shares, as it stands in a page.
pub(super) fn svg(found: &Comparison, spec: &CaseSpec) -> Result<String, Failure> {
    let of = match found.over {
        "amplitude" => spec.units.of_parameter(Parameter::NormalLoad),
        "noise" => spec.units.of_parameter(Parameter::Noise),
        _ => String::new(),
    };
    let plain = |unit: String| if unit == "1" { String::new() } else { unit };
    let (unit, time) = (plain(of), plain(spec.units.of([0, 0, 1])));
    let picture = ComparedPicture {
        of: found,
        unit: &unit,
        time: &time,
        title: TITLE,
    };
    let drawn = picture::draw_compared(&picture, Path::new("compare.svg"))
        .map_err(|error| Failure::failed(error.to_string()))?;
    let text = String::from_utf8_lossy(drawn.bytes()).into_owned();
    // The declaration of a file is none of a page's.
    let begin = text.find("<svg").unwrap_or(0);
    Ok(text[begin..].to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Starts that are not counted are told by their numbers, those of all slopes once.
    #[test]
    fn what_is_not_counted_is_told() {
        let shares = |lift_off, undecided| {
            let share = ReachedShare {
                value: 0.1,
                share: 0.5,
                error: 0.1,
                lift_off,
                undecided,
            };
            vec![share; 2]
        };
        let of = |method, near, stick_slip| Compared {
            method,
            sample_time: None,
            near,
            stick_slip,
        };
        let mut found = Comparison {
            over: "slope",
            amplitude: Some(0.5),
            slope: None,
            noise: Some(0.0),
            model: "exact",
            starts: 64,
            seed: 0,
            horizon: 200.0,
            period: None,
            methods: vec![
                of("delayed-feedback", shares(1, 0), shares(2, 0)),
                of("return-map", shares(0, 0), shares(0, 5)),
            ],
        };
        let told = |found: &Comparison| not_counted(found).unwrap_or_default();
        assert_eq!(
            told(&found),
            "of all starts 3 lift off, where the load is 0, and 10 take too many steps to be \
             known: they are counted as not reaching sliding"
        );
        found.over = "noise";
        assert!(told(&found).contains("6 lift off"));
        let spec: CaseSpec = include_str!("../../sweeps/fig3b.toml").parse().unwrap();
        assert_eq!(of_shares(&found, &spec).text[2], told(&found));
        found.methods.clear();
        assert_eq!(told(&found), "");
    }
}
