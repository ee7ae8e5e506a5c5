//! What the user wrote: a sweep file, read and checked once.
//!
//! ```toml
//! title = "Velocity control"              # optional
//! # optional: v_c as the delay vanishes, over gamma and mu_ratio and nothing else
//! protocol = "limit"
//! # optional, n_unstable by default; status is always there
//! fields = ["n_unstable", "abscissa"]
//! boundaries = true                       # optional: the exact crossing curves as polylines
//! # optional: also the curves max Re λ = −σ for these σ, in 1/time
//! degree_of_stability = [0.05, 0.1]
//! # optional: the gain and delay of fastest decay in every plane of the two
//! best = true
//! # optional, for fields of the critical velocity: or "switch-on"
//! protocol = "follow"
//! # optional, with "switch-on": the worst phase; else switch_on_phase, 0 by default
//! phase = "worst"
//! # optional, with "follow": the share of cells that are recomputed by simulation
//! verify = 0.004
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
//! # or coulomb, stribeck; or table, with speeds and mu_k at them as lists
//! law = "weakening"
//! mu0 = 0.5
//! # with "weakening" also two of mu0, v_s and mu_prime_rest, here or as axes
//! v_s = 0.5
//!
//! # optional, for fields of motions: where they start, if no axis says so
//! [start]
//! x_dot0 = 0.1                            # and a0; or switch_on_phase, as in case files
//!
//! [simulation]                            # optional, for fields of motions: as in case files
//! horizon = 1000.0
//! tolerance = 1e-12
//! steps = 1000000
//!
//! [units]                                 # optional: names for the map, dimensionless without
//! force = "N"
//! length = "m"
//! time = "s"
//!
//! [tolerance]                             # optional
//! marginal = 1.4e-14
//! ```

mod vc_keys;

use std::ops::Range;

use super::axis::{Axis, MOST_POINTS, Spacing, plane_of_curves, spaced};
use super::best_plane::gain_plane;
use super::field::{Field, known_fields};
use super::given::{GivenParameters, read_units};
use super::limit_spec::LimitDraft;
use super::parameter::Parameter;
use super::protocol::Protocol;
use super::search::Search;
use super::setting::Setting;
use super::simulation::Simulation;
pub use super::toml_reader::SpecError;
use super::toml_reader::{Entry, entries, parse};
use super::units::Units;
use crate::linear::MarginalTolerance;
use crate::model::Shown;
use vc_keys::VcKeys;

/// More points than this on all axes but the last are refused: their product would be too many
/// cells.
const MOST_POINTS_TOGETHER: u64 = 2 * MOST_POINTS;
/// More degrees of stability than this are refused.
const MOST_DEGREES: usize = 16;
/// The largest degree of stability, in 1/time.
const LARGEST_DEGREE: f64 = 1e12;

/// A sweep as its file describes it: every value in range, every name known.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSpec {
    /// Title for pictures and the map; may be empty.
    pub title: String,
    /// Which critical velocity is asked for, if one is.
    pub protocol: Option<Protocol>,
    /// Axes in the order of the file: the dimensions of the map.
    pub axes: Vec<Axis>,
    /// All other parameters.
    pub fixed: Setting,
    /// What to compute.
    pub fields: Vec<Field>,
    /// Whether to trace crossing curves; none: where that is cheap.
    pub boundaries: Option<bool>,
    /// Degrees of stability σ > 0, in 1/time and increasing, whose curves max Re λ = −σ are traced
    /// beside the boundaries.
    pub degrees_of_stability: Vec<f64>,
    /// Whether to look for the best setting of every plane (gain, delay).
    pub best: bool,
    /// How near to a crossing a cell is marginal.
    pub tolerance: MarginalTolerance,
    /// How far and how exactly motions are followed.
    pub simulation: Simulation,
    /// How critical velocities are looked for; none where no field asks for them.
    pub critical: Option<Search>,
    /// Units of the parameters.
    pub units: Units,
    /// The text of the file.
    pub text: String,
}

impl SweepSpec {
    /// True for the parameters on which a cell can depend.
    #[must_use]
    pub fn uses(&self, parameter: Parameter) -> bool {
        match self.protocol {
            Some(Protocol::Limit) => parameter.of_limit(),
            None => self.fixed.uses(parameter),
        }
    }

    /// Whether there is a sliding state in each cell whose linear stability can be asked for: a
    /// friction law needs a v0.
    #[must_use]
    pub fn has_sliding(&self) -> bool {
        let on_axis = self.axes.iter().any(|a| a.parameter == Parameter::V0);
        let given =
            self.fixed.law().is_none() || on_axis || !self.fixed.get(Parameter::V0).is_nan();
        self.protocol.is_none() && given
    }

    /// Whether motions from a start are followed.
    #[must_use]
    pub fn follows_motions(&self) -> bool {
        self.critical.is_none() && self.fields.iter().any(|f| f.of_motion())
    }
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
            draft.limit.note_key(&entry);
            match entry.key {
                "title" => draft.title = entry.line()?.to_owned(),
                "protocol" if entry.string()? == Protocol::Limit.name() => {
                    draft.protocol = Some(Protocol::Limit);
                }
                "fields" => draft.read_fields(&entry)?,
                "boundaries" => draft.boundaries = Some(entry.boolean()?),
                "degree_of_stability" => draft.read_degrees(&entry)?,
                "best" => draft.best = entry.boolean()?.then(|| entry.key_span.clone()),
                "axes" => draft.read_axes(&entry)?,
                "fixed" => draft.given.read_fixed(&entry)?,
                "friction" => draft.given.read_friction(&entry)?,
                "start" => draft.given.read_start(&entry)?,
                "simulation" => draft.read_simulation(&entry)?,
                "units" => draft.units = read_units(&entry)?,
                "tolerance" => draft.tolerance = read_tolerance(&entry)?,
                _ if draft.vc.read(&entry)? => {}
                _ => return Err(entry.unknown(&KEYS)),
            }
        }
        draft.finish(text)
    }
}

/// The keys of a sweep file.
const KEYS: [&str; 15] = [
    "title",
    "fields",
    "boundaries",
    "degree_of_stability",
    "best",
    VcKeys::KEYS[0],
    VcKeys::KEYS[1],
    VcKeys::KEYS[2],
    "axes",
    "fixed",
    "friction",
    "start",
    "simulation",
    "units",
    "tolerance",
];

#[derive(Default)]
struct Draft {
    title: String,
    protocol: Option<Protocol>,
    limit: LimitDraft,
    fields: Option<Vec<Field>>,
    /// Where the first field of motions is asked for, if one is.
    motion_place: Option<Range<usize>>,
    /// The first of these that depends on where a motion starts, with its name.
    start_place: Option<(&'static str, Range<usize>)>,
    /// Where the first field of the critical velocity is asked for, if one is.
    vc_place: Option<Range<usize>>,
    vc: VcKeys,
    simulation: Simulation,
    simulation_place: Option<Range<usize>>,
    boundaries: Option<bool>,
    degrees: Vec<f64>,
    degrees_place: Option<Range<usize>>,
    /// Where the best settings are asked for, if they are.
    best: Option<Range<usize>>,
    axes: Vec<Axis>,
    axes_place: Option<Range<usize>>,
    given: GivenParameters,
    units: Units,
    tolerance: MarginalTolerance,
}

impl Draft {
    fn read_fields(&mut self, fields: &Entry) -> Result<(), SpecError> {
        self.fields = Some(read_fields(fields)?);
        self.limit.note_fields(fields)?;
        for element in fields.array()? {
            let Some(field) = Field::from_name(element.string()?) else {
                continue;
            };
            let place = || Some(element.span.clone());
            if field.of_vc() {
                self.vc_place = self.vc_place.take().or_else(place);
            }
            if field.of_motion() {
                self.motion_place = self.motion_place.take().or_else(place);
            }
            if field.of_motion() && field != Field::Outcome {
                let named = || Some((field.name(), element.span.clone()));
                self.start_place = self.start_place.take().or_else(named);
            }
        }
        Ok(())
    }

    fn read_simulation(&mut self, simulation: &Entry) -> Result<(), SpecError> {
        self.simulation_place = Some(simulation.key_span.clone());
        self.simulation.read_table(simulation)
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
            self.given.give(&entry, parameter)?;
            let points: u64 = self.axes.iter().map(|axis| axis.len() as u64).sum();
            if points > MOST_POINTS_TOGETHER {
                let message = format!(
                    "the axes before it have {points} points together; at most \
                    {MOST_POINTS_TOGETHER} are allowed"
                );
                return Err(entry.error(message));
            }
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

    fn finish(self, text: &str) -> Result<SweepSpec, SpecError> {
        if self.axes.is_empty() {
            let message = "a sweep needs at least one axis";
            return Err(SpecError {
                span: self.axes_place,
                ..SpecError::whole(message)
                    .help("for example: [axes] tau = { from = 0, to = 12, points = 1201 }")
            });
        }
        let (fixed, critical, default_fields) = match self.protocol {
            Some(Protocol::Limit) => (
                self.limit.check(&self.given, self.axes_place.as_ref())?,
                None,
                Field::all_of_limit().collect(),
            ),
            None => {
                let (fixed, critical) = self.check()?;
                (fixed, critical, vec![Field::NUnstable])
            }
        };
        Ok(SweepSpec {
            title: self.title,
            protocol: self.protocol,
            axes: self.axes,
            fixed,
            fields: self.fields.unwrap_or(default_fields),
            boundaries: self.boundaries,
            degrees_of_stability: self.degrees,
            best: self.best.is_some(),
            tolerance: self.tolerance,
            simulation: self.simulation,
            critical,
            units: self.units,
            text: text.to_owned(),
        })
    }

    /// Everything fits together in a sweep of sliding or of motions; gives the parameters that are
    /// no axes, and what is looked for of the critical velocity.
    fn check(&self) -> Result<(Setting, Option<Search>), SpecError> {
        self.limit.check_absent()?;
        let without_v0 = self.given.law_place().is_some() && !self.needs_v0();
        let optional = without_v0.then_some(Parameter::V0);
        self.given.check(optional, self.axes_place.as_ref())?;
        self.check_degrees()?;
        self.check_best()?;
        let fixed = self.given.setting();
        self.check_law(&fixed)?;
        let critical = self.check_nonlinear(&fixed)?;
        Ok((fixed, critical))
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
                Err(SpecError::at(place.clone(), message).help(
                    "alpha_v or alpha_n, and tau, in [axes]; the best setting is looked for \
                        within their ranges",
                ))
            }
            _ => Ok(()),
        }
    }

    /// The law is well posed in every cell: μ0 at its largest against μ_S at its smallest.
    fn check_law(&self, fixed: &Setting) -> Result<(), SpecError> {
        let Some(place) = self.given.ill_posed_place() else {
            return Ok(());
        };
        let mut worst = fixed.clone();
        for axis in &self.axes {
            let (smallest, largest) = axis.range();
            // With a slope at rest, μ0 grows with v_s and with the slope's size.
            let value = match axis.parameter {
                Parameter::Mu0 | Parameter::VS => largest,
                _ => smallest,
            };
            worst.set(axis.parameter, value);
        }
        worst
            .friction_law()
            .map(|_| ())
            .map_err(|e| SpecError::at(place.clone(), e.to_string()))
    }
}

/// Motions: what fields of theirs need, and what has no effect without them.
impl Draft {
    /// The values of a parameter in the sweep: of its axis, or the fixed one.
    fn values(&self, fixed: &Setting, parameter: Parameter) -> Vec<f64> {
        let axis = self.axes.iter().find(|axis| axis.parameter == parameter);
        axis.map_or_else(|| vec![fixed.get(parameter)], |axis| axis.values.clone())
    }

    /// Fields of the critical velocity or of motions have what they need; what is looked for.
    fn check_nonlinear(&self, fixed: &Setting) -> Result<Option<Search>, SpecError> {
        if let Some(place) = &self.vc_place {
            return self.critical_search(fixed, place).map(Some);
        }
        self.check_no_search()?;
        match &self.motion_place {
            Some(place) => self.check_motions(fixed, place)?,
            None => self.check_no_motions()?,
        }
        Ok(None)
    }

    fn check_law_is_there(&self, place: &Range<usize>, why: &str) -> Result<(), SpecError> {
        if self.given.law_place().is_some() {
            return Ok(());
        }
        let message = format!("this field needs a friction law: {why}");
        Err(SpecError::at(place.clone(), message)
            .help("give [friction] and v0 instead of mu_prime and mu_k"))
    }

    /// No gain acts without a delay.
    fn check_delays(&self, fixed: &Setting, place: &Range<usize>) -> Result<(), SpecError> {
        let gains = [Parameter::AlphaV, Parameter::AlphaN];
        let mut gains = gains.into_iter().flat_map(|p| self.values(fixed, p));
        let acts = gains.any(|gain| gain != 0.0);
        if acts && self.values(fixed, Parameter::Tau).contains(&0.0) {
            let message = "tau = 0 is outside its range: greater than 0 where gains act and \
                motions are followed";
            let place = self.given.place(Parameter::Tau).unwrap_or(place);
            return Err(SpecError::at(place.clone(), message));
        }
        Ok(())
    }

    fn check_motions(&self, fixed: &Setting, place: &Range<usize>) -> Result<(), SpecError> {
        self.check_law_is_there(place, "motions stick and slip by it")?;
        self.given.check_start()?;
        self.check_delays(fixed, place)?;
        let phases = self.values(fixed, Parameter::SwitchOnPhase);
        let latest = phases.into_iter().fold(0.0, f64::max);
        let name = Parameter::SwitchOnPhase.name();
        self.simulation.check_horizon(name, latest)
    }

    fn check_no_motions(&self) -> Result<(), SpecError> {
        let start = Parameter::ALL.into_iter().filter(|p| p.of_start());
        let start = start.filter_map(|p| Some((p.name(), self.given.place(p)?)));
        let simulation = self.simulation_place.as_ref().map(|s| ("simulation", s));
        match start.chain(simulation).next() {
            Some((name, place)) => {
                let message = format!("{name} has no effect on the fields that are asked for");
                Err(SpecError::at(place.clone(), message).help(
                    "motions are followed for the fields outcome, settle_time, n_min and \
                    peak_force",
                ))
            }
            None => Ok(()),
        }
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
                "{} is outside its range: greater than 0, between 1e-12 and 1e12",
                Shown(value)
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
    // An abscissa without the distance that its certificate leaves open would say less than it
    // seems to.
    if fields.contains(&Field::Abscissa) && !fields.contains(&Field::CertificateMargin) {
        fields.push(Field::CertificateMargin);
    }
    fields.sort_unstable();
    Ok(fields)
}

fn read_tolerance(tolerance: &Entry) -> Result<MarginalTolerance, SpecError> {
    let mut result = MarginalTolerance::default();
    for entry in tolerance.table()? {
        match entry.key {
            "marginal" => {
                result = MarginalTolerance(entry.number_within(f64::EPSILON..=0.01)?);
            }
            _ => return Err(entry.unknown(&["marginal"])),
        }
    }
    Ok(result)
}
