//! What the user wrote: a sweep file, read and checked once.
//!
//! ```toml
//! title = "Velocity control"              # optional
//! fields = ["n_unstable", "abscissa"]     # optional, n_unstable by default; status is always there
//! boundaries = true                       # optional: the exact crossing curves as polylines
//! degree_of_stability = [0.05, 0.1]       # optional: also the curves max Re λ = −σ for these σ, in 1/time
//! best = true                             # optional: the gain and delay of fastest decay in every plane of the two
//!
//! [axes]                                  # in this order they are the dimensions of the map
//! mu_prime = [-0.1, -0.2, -0.5]
//! alpha_v = { from = -1.6, to = 0.4, points = 801 }
//! tau = { from = 0.0, to = 12.0, points = 1201, spacing = "linear" }
//!
//! [fixed]                                 # every other parameter that is not at its default
//! alpha_n = 0.0
//!
//! [friction]                              # optional, with v0 instead of mu_prime and mu_k
//! law = "weakening"
//! mu0 = 0.5
//! v_s = 0.5
//!
//! [units]                                 # optional: names for the map, dimensionless without
//! force = "N"
//! length = "m"
//! time = "s"
//!
//! [tolerance]                             # optional
//! marginal = 1.4e-14
//! ```

use std::ops::Range;

use super::axis::{Axis, Spacing, plane_of_curves, spaced};
use super::best::gain_plane;
use super::field::{Field, known_fields};
use super::parameter::{GivenError, LawKind, Parameter, Setting, Units};
pub use super::toml_reader::SpecError;
use super::toml_reader::{Entry, entries, parse};
use crate::linear::MarginalTolerance;

/// More degrees of stability than this are refused.
const MOST_DEGREES: usize = 16;
/// The largest degree of stability, in 1/time.
const LARGEST_DEGREE: f64 = 1e12;

/// A sweep as its file describes it: every value in range, every name known.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSpec {
    /// Title for pictures and the map; may be empty.
    pub title: String,
    /// Axes in the order of the file: the dimensions of the map.
    pub axes: Vec<Axis>,
    /// All other parameters.
    pub fixed: Setting,
    /// What to compute.
    pub fields: Vec<Field>,
    /// Whether to trace crossing curves; none: where that is cheap.
    pub boundaries: Option<bool>,
    /// Degrees of stability σ > 0, in 1/time and increasing, whose curves max Re λ = −σ are traced beside the boundaries.
    pub degrees_of_stability: Vec<f64>,
    /// Whether to look for the best setting of every plane (gain, delay).
    pub best: bool,
    /// How near to a crossing a cell is marginal.
    pub tolerance: MarginalTolerance,
    /// Units of the parameters.
    pub units: Units,
    /// The text of the file.
    pub text: String,
}

impl std::str::FromStr for SweepSpec {
    type Err = SpecError;

    /// Reads a sweep file.
    ///
    /// # Errors
    /// Points at the first place that is not understood, out of range or contradictory.
    fn from_str(text: &str) -> Result<Self, SpecError> {
        let document = parse(text)?;
        let mut draft = Draft::default();
        for entry in entries(document.get_ref(), "") {
            match entry.key {
                "title" => draft.title = entry.string()?.to_owned(),
                "fields" => draft.fields = Some(read_fields(&entry)?),
                "boundaries" => draft.boundaries = Some(entry.boolean()?),
                "degree_of_stability" => draft.read_degrees(&entry)?,
                "best" => draft.best = entry.boolean()?.then(|| entry.key_span.clone()),
                "axes" => draft.read_axes(&entry)?,
                "fixed" => draft.read_fixed(&entry)?,
                "friction" => draft.read_friction(&entry)?,
                "units" => draft.units = read_units(&entry)?,
                "tolerance" => draft.tolerance = read_tolerance(&entry)?,
                _ => {
                    return Err(entry.unknown(&[
                        "title",
                        "fields",
                        "boundaries",
                        "degree_of_stability",
                        "best",
                        "axes",
                        "fixed",
                        "friction",
                        "units",
                        "tolerance",
                    ]));
                }
            }
        }
        draft.finish(text)
    }
}

/// A parameter that the file gives, with the place of its key.
struct Given {
    parameter: Parameter,
    place: Range<usize>,
}

#[derive(Default)]
struct Draft {
    title: String,
    fields: Option<Vec<Field>>,
    boundaries: Option<bool>,
    degrees: Vec<f64>,
    degrees_place: Option<Range<usize>>,
    /// Where the best settings are asked for, if they are.
    best: Option<Range<usize>>,
    axes: Vec<Axis>,
    axes_place: Option<Range<usize>>,
    fixed: Vec<(Parameter, f64)>,
    law: Option<(LawKind, Range<usize>)>,
    units: Units,
    tolerance: MarginalTolerance,
    given: Vec<Given>,
}

impl Draft {
    fn give(&mut self, entry: &Entry, parameter: Parameter) -> Result<(), SpecError> {
        if self.given.iter().any(|g| g.parameter == parameter) {
            let message = format!("{} is given twice", parameter.name());
            return Err(SpecError::at(entry.key_span.clone(), message)
                .help("a parameter is either an axis or a fixed value"));
        }
        self.given.push(Given {
            parameter,
            place: entry.key_span.clone(),
        });
        Ok(())
    }

    fn read_degrees(&mut self, degrees: &Entry) -> Result<(), SpecError> {
        self.degrees = read_degrees(degrees)?;
        self.degrees_place = Some(degrees.key_span.clone());
        Ok(())
    }

    fn read_axes(&mut self, axes: &Entry) -> Result<(), SpecError> {
        self.axes_place = Some(axes.key_span.clone());
        for entry in axes.table()? {
            let parameter = Parameter::from_name(entry.key)
                .ok_or_else(|| entry.unknown(&Parameter::ALL.map(Parameter::name)))?;
            self.give(&entry, parameter)?;
            let values = if entry.is_table() {
                read_range(&entry)?
            } else {
                read_list(&entry, parameter)?
            };
            let axis = Axis::new(parameter, values).map_err(|e| entry.error(e.0))?;
            self.axes.push(axis);
        }
        Ok(())
    }

    fn read_fixed(&mut self, fixed: &Entry) -> Result<(), SpecError> {
        for entry in fixed.table()? {
            let known = Parameter::ALL.into_iter().filter(|p| !p.of_friction_law());
            let names: Vec<_> = known.clone().map(Parameter::name).collect();
            let parameter = known
                .into_iter()
                .find(|p| p.name() == entry.key)
                .ok_or_else(|| entry.unknown(&names))?;
            self.read_value(&entry, parameter)?;
        }
        Ok(())
    }

    fn read_value(&mut self, entry: &Entry, parameter: Parameter) -> Result<(), SpecError> {
        self.give(entry, parameter)?;
        let value = entry.number()?;
        parameter
            .check(value)
            .map_err(|e| SpecError::at(entry.span.clone(), e.to_string()))?;
        self.fixed.push((parameter, value));
        Ok(())
    }

    fn read_friction(&mut self, friction: &Entry) -> Result<(), SpecError> {
        let names = ["law", "mu0", "v_s", "mu_s"];
        for entry in friction.table()? {
            match Parameter::from_name(entry.key).filter(|p| p.of_friction_law()) {
                Some(parameter) => self.read_value(&entry, parameter)?,
                None if entry.key == "law" => {
                    let name = entry.string()?;
                    let law = LawKind::ALL
                        .into_iter()
                        .find(|law| law.name() == name)
                        .ok_or_else(|| {
                            let laws = LawKind::ALL.map(LawKind::name).join(", ");
                            entry
                                .error(format!("unknown friction law \"{name}\""))
                                .help(format!("known: {laws}"))
                        })?;
                    self.law = Some((law, entry.span.clone()));
                }
                None => return Err(entry.unknown(&names)),
            }
        }
        if self.law.is_none() {
            return Err(SpecError::at(
                friction.key_span.clone(),
                "[friction] needs a law",
            ));
        }
        Ok(())
    }

    fn finish(self, text: &str) -> Result<SweepSpec, SpecError> {
        if self.axes.is_empty() {
            let message = "a sweep needs at least one axis";
            return Err(SpecError {
                span: self.axes_place,
                ..SpecError::whole(message)
                    .help("for example: [axes] tau = { from = 0, to = 12, points = 1201 }")
            });
        }
        self.check_what_is_given()?;
        self.check_degrees()?;
        self.check_best()?;
        let mut fixed = Setting::new(self.law.as_ref().map(|(law, _)| *law));
        for (parameter, value) in &self.fixed {
            fixed.set(*parameter, *value);
        }
        self.check_law(&fixed)?;
        Ok(SweepSpec {
            title: self.title,
            axes: self.axes,
            fixed,
            fields: self.fields.unwrap_or_else(|| vec![Field::NUnstable]),
            boundaries: self.boundaries,
            degrees_of_stability: self.degrees,
            best: self.best.is_some(),
            tolerance: self.tolerance,
            units: self.units,
            text: text.to_owned(),
        })
    }

    /// There are boundaries beside which to trace degrees of stability.
    fn check_degrees(&self) -> Result<(), SpecError> {
        let Some(place) = &self.degrees_place else {
            return Ok(());
        };
        let refuse = |message: &str, help: &str| {
            Err(SpecError::at(place.clone(), format!("degree_of_stability: {message}")).help(help))
        };
        if self.boundaries == Some(false) {
            return refuse(
                "its curves are traced with the boundaries, and boundaries = false",
                "set boundaries = true, or leave degree_of_stability out",
            );
        }
        if plane_of_curves(&self.axes).is_none() {
            return refuse(
                "there is no plane for its curves",
                "an axis tau and another axis are needed, with two values or more each",
            );
        }
        Ok(())
    }

    /// Best settings are looked for in planes of a gain and the delay: both must be axes.
    fn check_best(&self) -> Result<(), SpecError> {
        match &self.best {
            Some(place) if gain_plane(&self.axes).is_none() => {
                let message =
                    "best needs an axis of a gain and one of the delay, with two points or more";
                Err(SpecError::at(place.clone(), message)
                    .help("alpha_v or alpha_n, and tau, in [axes]; the best setting is looked for within their ranges"))
            }
            _ => Ok(()),
        }
    }

    /// Every parameter that is needed is there, none that would be ignored.
    fn check_what_is_given(&self) -> Result<(), SpecError> {
        let law = self.law.as_ref().map(|(law, _)| *law);
        let place = |p: Parameter| self.given.iter().find(|g| g.parameter == p);
        Setting::check_given(law, |p| place(p).is_some()).map_err(|error| {
            let span = match error {
                GivenError::Unused(p) => place(p).map(|g| g.place.clone()),
                GivenError::Missing(Parameter::Mu0 | Parameter::VS | Parameter::V0) => {
                    self.law.as_ref().map(|(_, place)| place.clone())
                }
                GivenError::Missing(_) => self.axes_place.clone(),
            };
            SpecError {
                message: error.message(law),
                span,
                help: Some(error.help()),
            }
        })
    }

    /// The law is well posed in every cell: μ0 at its largest against μ_S at its smallest.
    fn check_law(&self, fixed: &Setting) -> Result<(), SpecError> {
        let Some((_, place)) = &self.law else {
            return Ok(());
        };
        let mut worst = *fixed;
        for axis in &self.axes {
            let (smallest, largest) = axis.range();
            let value = if axis.parameter == Parameter::Mu0 {
                largest
            } else {
                smallest
            };
            worst.set(axis.parameter, value);
        }
        worst
            .friction_law()
            .map(|_| ())
            .map_err(|e| SpecError::at(place.clone(), e.to_string()))
    }
}

fn read_range(axis: &Entry) -> Result<Vec<f64>, SpecError> {
    let (mut from, mut to, mut points, mut spacing) = (None, None, None, Spacing::Linear);
    for entry in axis.table()? {
        match entry.key {
            "from" => from = Some(entry.number()?),
            "to" => to = Some(entry.number()?),
            "points" => points = Some(entry.whole()?),
            "spacing" => {
                spacing = match entry.string()? {
                    "linear" => Spacing::Linear,
                    "log" => Spacing::Log,
                    other => {
                        return Err(entry
                            .error(format!("unknown spacing \"{other}\""))
                            .help("known: linear, log"));
                    }
                }
            }
            _ => return Err(entry.unknown(&["from", "to", "points", "spacing"])),
        }
    }
    let missing = |name| axis.error(format!("{name} is missing"));
    let from = from.ok_or_else(|| missing("from"))?;
    let to = to.ok_or_else(|| missing("to"))?;
    let points = points.ok_or_else(|| missing("points"))?;
    spaced(from, to, points, spacing).map_err(|e| axis.error(e.0))
}

fn read_list(axis: &Entry, parameter: Parameter) -> Result<Vec<f64>, SpecError> {
    let elements = axis
        .array()
        .map_err(|e| e.help("an axis is a list of values or { from = …, to = …, points = … }"))?;
    elements
        .iter()
        .map(|element| {
            let value = element.number()?;
            parameter
                .check(value)
                .map_err(|e| SpecError::at(element.span.clone(), e.to_string()))
        })
        .collect()
}

fn read_degrees(entry: &Entry) -> Result<Vec<f64>, SpecError> {
    let elements = entry
        .array()
        .map_err(|e| e.help("for example: degree_of_stability = [0.05, 0.1]"))?;
    if elements.is_empty() || elements.len() > MOST_DEGREES {
        let message = format!("{} values; 1 to {MOST_DEGREES} are allowed", elements.len());
        return Err(entry.error(message));
    }
    let mut degrees: Vec<f64> = Vec::new();
    for element in &elements {
        let value = element.number()?;
        if !(1.0 / LARGEST_DEGREE..=LARGEST_DEGREE).contains(&value) {
            return Err(element.error(format!(
                "{value} is outside its range: greater than 0, between 1e-12 and 1e12"
            )));
        }
        if degrees.last().is_some_and(|last| *last >= value) {
            return Err(element.error("the values must be strictly increasing"));
        }
        degrees.push(value);
    }
    Ok(degrees)
}

fn read_fields(entry: &Entry) -> Result<Vec<Field>, SpecError> {
    let mut fields = Vec::new();
    for element in entry.array()? {
        let name = element.string()?;
        let field = Field::from_name(name).ok_or_else(|| {
            element
                .error(format!("unknown field \"{name}\""))
                .help(format!("known: {}", known_fields()))
        })?;
        if fields.contains(&field) {
            return Err(element.error(format!("\"{name}\" is listed twice")));
        }
        fields.push(field);
    }
    if fields.is_empty() {
        return Err(entry
            .error("the list is empty")
            .help(format!("known: {}", known_fields())));
    }
    // An abscissa without the distance that its certificate leaves open would say less than it seems to.
    if fields.contains(&Field::ABSCISSA) && !fields.contains(&Field::CertificateMargin) {
        fields.push(Field::CertificateMargin);
    }
    fields.sort_unstable();
    Ok(fields)
}

fn read_units(units: &Entry) -> Result<Units, SpecError> {
    let [mut force, mut length, mut time] = [None, None, None];
    for entry in units.table()? {
        let slot = match entry.key {
            "force" => &mut force,
            "length" => &mut length,
            "time" => &mut time,
            _ => return Err(entry.unknown(&["force", "length", "time"])),
        };
        let name = entry.string()?;
        if name.is_empty() || !name.chars().all(|c| c.is_alphabetic() || c == '%') {
            return Err(entry.error("a unit is one word of letters, like \"N\" or \"mm\""));
        }
        *slot = Some(name.to_owned());
    }
    match (force, length, time) {
        (Some(force), Some(length), Some(time)) => Ok(Units {
            force_length_time: Some([force, length, time]),
        }),
        _ => Err(SpecError::at(
            units.key_span.clone(),
            "units: force, length and time are needed, all three",
        )),
    }
}

fn read_tolerance(tolerance: &Entry) -> Result<MarginalTolerance, SpecError> {
    let mut result = MarginalTolerance::default();
    for entry in tolerance.table()? {
        match entry.key {
            "marginal" => {
                let value = entry.number()?;
                if !(f64::EPSILON..=0.01).contains(&value) {
                    return Err(entry.error(format!(
                        "{value} is outside its range: {:e} to 0.01",
                        f64::EPSILON
                    )));
                }
                result = MarginalTolerance(value);
            }
            _ => return Err(entry.unknown(&["marginal"])),
        }
    }
    Ok(result)
}
