//! A sweep file, read and checked once.
//!
//! ```toml
//! title = "Velocity control"              # optional
//! # optional: v_c as the delay vanishes, over gamma and mu_ratio and nothing else
//! protocol = "limit"
//! # optional, n_unstable by default; status is always there
//! fields = ["n_unstable", "abscissa"]
//! picture = "abscissa"                    # optional: the one of them that pictures show
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
//! # optional, for fields of motions: where they start, if no axis says so; by default at v0, 1 %
//! # faster than the block is pulled
//! [start]
//! x_dot0 = 0.1                            # and a0; or switch_on_phase, as in case files
//!
//! [simulation]                            # optional, for fields of motions: as in case files
//! horizon = 1000.0
//! tolerance = 1e-12
//! steps = 1000000
//!
//! # optional, for fields of many starts: by default over all that a block at rest can come to
//! [basin]
//! over = "state"                          # or "phase" of the uncontrolled cycle, at switch-on
//! starts = 256                            # a power of two
//! x_dot0 = { from = 0.0, to = 1.5 }
//! a0 = { from = -1.0, to = 1.0 }
//!
//! [units]                                 # optional: of numbers without a unit of their own
//! force = "N"
//! length = "m"
//! time = "s"
//!
//! [tolerance]                             # optional
//! marginal = 1.4e-14
//! ```

use std::sync::Arc;

use super::axis::Axis;
use super::basin::Basin;
use super::field::Field;
use super::parameter::Parameter;
use super::quantity::Quantity;
use super::search::Search;
use super::simulation::Simulation;
use super::source::Cost;
use super::units::Units;
use super::values::Setting;
use crate::linear::MarginalTolerance;

/// A sweep as described by its file: every value in range, every name known.
///
/// ```
/// use slipmap::setting::SweepSpec;
///
/// let sweep: SweepSpec = "
/// fields = [\"n_unstable\"]
/// [axes]
/// tau = { from = 1.0, to = 5.0, points = 9 }
/// [fixed]
/// mu_prime = -0.3
/// ".parse()?;
/// assert_eq!(sweep.axes[0].values[1], 1.5);
/// // An error points at its place.
/// let error = "field = []".parse::<SweepSpec>().unwrap_err();
/// assert_eq!(error.span, Some(0..5));
/// # Ok::<(), slipmap::text::SpecError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSpec {
    /// Title for pictures and the map; may be empty.
    pub title: String,
    /// The field that pictures show by default; not part of the plan.
    pub picture: Option<Field>,
    /// Whether it is a sweep of the limit of a short delay, [`crate::critical::limit`].
    pub limit: bool,
    /// Axes in the order of the file: the dimensions of the map.
    pub axes: Vec<Axis>,
    /// All other parameters.
    pub fixed: Setting,
    /// The fields to compute.
    pub fields: Vec<Field>,
    /// Whether to trace crossing curves; none: only where that is cheap.
    pub boundaries: Option<bool>,
    /// Degrees of stability σ > 0, in 1/time and increasing, whose curves max Re λ = −σ are traced
    /// beside the boundaries.
    pub degrees_of_stability: Vec<f64>,
    /// Whether to look for the best setting of every plane (gain, delay).
    pub best: bool,
    /// How close to a crossing a cell counts as marginal.
    pub tolerance: MarginalTolerance,
    /// How far and how exactly motions are followed.
    pub simulation: Simulation,
    /// The starts over which the share that ends in sliding is taken; none where no field needs it.
    pub basin: Option<Basin>,
    /// The search for critical velocities; none where no field needs them.
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
        match self.limit {
            true => parameter.of_limit() && self.fixed.says(parameter),
            false => self.fixed.uses(parameter),
        }
    }

    /// The quantities on which cells depend and that are no axes, with their values.
    #[must_use]
    pub fn scalars(&self) -> Vec<(Quantity, f64)> {
        let known = Parameter::ALL.into_iter().filter(|p| self.uses(*p));
        let own = self.fixed.own();
        let own = own.map(|(own, _)| Quantity::Own(Arc::clone(own)));
        let all = known.map(Quantity::from).chain(own);
        let on_axis = |of: &Quantity| self.axes.iter().any(|axis| axis.parameter == *of);
        all.filter(|of| !on_axis(of))
            .map(|of| {
                let value = self.fixed.value_of(&of);
                (of, value)
            })
            .collect()
    }

    /// Whether the linear model of every cell is the letter's own: without memory, latency, lags
    /// and a state of friction.
    #[must_use]
    pub fn is_of_letter(&self) -> bool {
        most(&self.fixed, &self.axes).is_of_letter()
    }

    /// Whether the feedback of some cells is read from time to time.
    #[must_use]
    pub fn is_sampled(&self) -> bool {
        most(&self.fixed, &self.axes).feedback().is_sampled()
    }

    /// What the system of the sweep is where it has neither crossing curves nor best settings;
    /// none where it has them.
    #[must_use]
    pub(crate) fn without_curves(&self) -> Option<&'static str> {
        most(&self.fixed, &self.axes).without_curves()
    }

    /// Whether each cell has a sliding state whose linear stability can be computed. A friction law
    /// needs a v0 for that.
    #[must_use]
    pub fn has_sliding(&self) -> bool {
        let on_axis = self.axes.iter().any(|a| a.parameter == Parameter::V0);
        let given =
            self.fixed.law().is_none() || on_axis || !self.fixed.get(Parameter::V0).is_nan();
        !self.limit && given
    }

    /// Whether the sweep has a delay, fixed or as an axis, that has no effect because both gains
    /// are 0 in all cells.
    #[must_use]
    pub fn has_idle_delay(&self) -> bool {
        let on_axis = |p| self.axes.iter().any(|axis| axis.parameter == p);
        let gain = on_axis(Parameter::AlphaV) || on_axis(Parameter::AlphaN);
        let mut setting = self.fixed.clone();
        if on_axis(Parameter::Tau) {
            setting.set(Parameter::Tau, 1.0);
        }
        !self.limit && !gain && setting.has_idle_delay()
    }

    /// A remark on the starts of motions: on many starts, or on one that is not given.
    #[must_use]
    pub fn said_of_starts(&self) -> Option<String> {
        let many = self.basin.as_ref().map(Basin::described);
        many.or_else(|| self.simulation.assumed_start())
    }

    /// What a cell costs: as much as its dearest field.
    #[must_use]
    pub fn cost(&self) -> Cost {
        let of_fields = self.fields.iter().map(|field| field.source().cost());
        of_fields.max().unwrap_or(Cost::Counted)
    }

    /// Motions of a cell in which motions are followed: one, or one for each start of a share.
    #[must_use]
    pub fn motions_per_cell(&self) -> u32 {
        self.basin.as_ref().map_or(1, |basin| basin.starts)
    }

    /// Whether motions from a start are followed.
    #[must_use]
    pub fn follows_motions(&self) -> bool {
        self.cost() == Cost::Followed
    }
}

/// A setting with all that acts in some cell.
pub(super) fn most(fixed: &Setting, axes: &[Axis]) -> Setting {
    let mut most = fixed.clone();
    for axis in axes {
        // One nonzero value is enough.
        let value = axis.values.iter().copied().find(|value| *value != 0.0);
        most.vary(&axis.parameter, value.unwrap_or(0.0));
    }
    most
}
