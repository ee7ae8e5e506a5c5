//! Control by the return map beside delayed feedback: the share of starts that reach sliding, with
//! the same largest change of the load.
//!
//! Starts are drawn near sliding, in a box of ẋ within ±v0 and κa within ±v0 √(κM), and from
//! uncontrolled stick-slip at a random phase. They are the same for all methods. Delayed feedback
//! has the load limits N0 ± amplitude. A start reaches sliding as [`crate::answers::reached`] says.

use std::convert::Infallible;

use serde::Serialize;

use crate::answers::basin::{BasinProblem, Region, STUDENT_95, Tally};
use crate::answers::reached::{Asked as Reached, reached};
use crate::model::stop::Stop;
use crate::model::{ActuatorLimits, Channel, Control, Feedback, MapModel, ReturnMap};
use crate::slip::case::{Case, CaseError, Start};
use crate::slip::cycle::NoCycle;
use crate::slip::outcome::Outcome;
use crate::slip::programme::Programme;
use crate::sweep::engine::{RunError, each_attended};
use crate::sweep::events::Attended;

/// What varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// The largest change of the load.
    Amplitude,
    /// By which share the model's μ_K′ is wrong.
    Slope,
    /// The noise of readings.
    Noise,
}

impl Over {
    /// The name in flags and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Amplitude => "amplitude",
            Self::Slope => "slope",
            Self::Noise => "noise",
        }
    }
}

/// One place on the axis, with what does not vary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct At {
    /// The largest change of the load.
    pub amplitude: f64,
    /// By which share the model's μ_K′ is wrong.
    pub slope: f64,
    /// The noise of readings.
    pub noise: f64,
}

/// What is compared, in the units of the case.
#[derive(Debug, Clone)]
pub struct Question {
    /// The block with its delayed feedback.
    pub case: Case,
    /// What varies.
    pub over: Over,
    /// Its values, with what else there is at each.
    pub at: Vec<At>,
    /// The sample times of the return map.
    pub sample_times: Vec<f64>,
    /// Where the return map comes from.
    pub model: MapModel,
    /// How many starts of each kind, as [`crate::setting::basin::Basin::check_starts`] allows.
    pub starts: u32,
    /// What starts, noise and records are drawn with.
    pub seed: u32,
    /// For how long after switch-on they are followed.
    pub horizon: f64,
}

/// A method of control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Method {
    Delayed,
    ReturnMap { sample_time: f64 },
}

/// The share of starts that reach sliding at one value.
#[derive(Debug, Clone, Copy, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct ReachedShare {
    /// The value of what varies.
    pub value: f64,
    /// The share; null where there is no stick-slip to start from.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub share: f64,
    /// Its standard error; null where the share is.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub error: f64,
    /// How many starts lift off, the load being 0 there; they are counted as not reaching sliding.
    pub lift_off: u32,
    /// Of how many starts it is not known, since they take too many steps; they are counted as not
    /// reaching sliding.
    pub undecided: u32,
}

/// The shares of one method.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Compared {
    /// `delayed-feedback` or `return-map`.
    pub method: &'static str,
    /// The time from reading to reading; null for delayed feedback that is not read.
    #[cfg_attr(feature = "serve", schema(required))]
    pub sample_time: Option<f64>,
    /// From starts near sliding.
    pub near: Vec<ReachedShare>,
    /// From uncontrolled stick-slip at a random phase.
    pub stick_slip: Vec<ReachedShare>,
}

/// The shares of all methods.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Comparison {
    /// What varies: `amplitude`, `slope` or `noise`.
    pub over: &'static str,
    /// The largest change of the load; null where it varies.
    #[cfg_attr(feature = "serve", schema(required))]
    pub amplitude: Option<f64>,
    /// By which share the model's slope of friction is wrong; null where it varies.
    #[cfg_attr(feature = "serve", schema(required))]
    pub slope: Option<f64>,
    /// The noise of readings; null where it varies.
    #[cfg_attr(feature = "serve", schema(required))]
    pub noise: Option<f64>,
    /// Where the return map comes from: `exact` or `reconstructed`.
    pub model: &'static str,
    /// How many starts of each kind.
    pub starts: u32,
    /// What they are drawn with.
    pub seed: u32,
    /// For how long after switch-on they are followed.
    pub horizon: f64,
    /// The period of uncontrolled stick-slip; null without.
    #[cfg_attr(feature = "serve", schema(required))]
    pub period: Option<f64>,
    /// The methods, delayed feedback first.
    pub methods: Vec<Compared>,
}

/// One share to be found.
struct Item {
    asked: BasinProblem,
    exact: bool,
}

impl Question {
    /// The case of a method at one place, with the delayed feedback of the file or the return map.
    pub(super) fn case(&self, method: Method, at: At) -> Case {
        let mut case = self.case.clone();
        case.programme = Programme::default();
        case.switch_on = 0.0;
        case.horizon = self.horizon;
        let n0 = case.oscillator.normal_load();
        let feedback = &mut case.feedback;
        feedback.readings.seed = u64::from(self.seed) << 32;
        feedback.readings.noise = at.noise;
        match method {
            Method::Delayed => {
                feedback.limits.load = [n0 - at.amplitude, n0 + at.amplitude];
            }
            Method::ReturnMap { sample_time } => {
                let mut readings = feedback.readings;
                readings.sample_time = sample_time;
                let model = match self.model {
                    MapModel::Law { .. } => MapModel::Law {
                        slope: 1.0 + at.slope,
                    },
                    model => model,
                };
                *feedback = Feedback {
                    gains: Control::default(),
                    tau: 0.0,
                    channel: Channel::default(),
                    limits: ActuatorLimits {
                        velocity: feedback.limits.velocity,
                        ..ActuatorLimits::default()
                    },
                    readings,
                    return_map: Some(ReturnMap {
                        amplitude: at.amplitude,
                        model,
                    }),
                    ..*feedback
                };
            }
        }
        case
    }

    pub(super) fn methods(&self) -> impl Iterator<Item = Method> {
        let of_map = self.sample_times.iter();
        let of_map = of_map.map(|&sample_time| Method::ReturnMap { sample_time });
        std::iter::once(Method::Delayed).chain(of_map)
    }

    /// The name of a method, and the time between its readings.
    pub(super) fn named(&self, method: Method) -> (&'static str, Option<f64>) {
        let own = self.case.feedback.readings.sample_time;
        match method {
            Method::Delayed => ("delayed-feedback", Some(own).filter(|h| *h > 0.0)),
            Method::ReturnMap { sample_time } => ("return-map", Some(sample_time)),
        }
    }

    /// Where the return map comes from.
    pub(super) fn model_name(&self) -> &'static str {
        match self.model {
            MapModel::Reconstructed(_) => "reconstructed",
            MapModel::Law { .. } | MapModel::Known(_) => "exact",
        }
    }

    /// Starts near sliding, and the uncontrolled cycle.
    fn regions(&self) -> Result<[Region; 2], CaseError> {
        let (v0, rest) = (self.case.v0, self.case.sliding_elongation());
        let reach = v0 * self.case.units().time;
        let near = Region::State {
            x_dot0: [0.0, 2.0 * v0],
            a0: [rest - reach, rest + reach],
        };
        let of_cycle = match self.case.uncontrolled_cycle() {
            Ok(cycle) => Region::Phase {
                period: cycle.period(),
            },
            Err(CaseError::NoCycle(NoCycle::NoStickSlip)) => Region::None,
            Err(error) => return Err(error),
        };
        Ok([near, of_cycle])
    }

    /// Checks every case by its motion from sliding.
    fn check(&self) -> Result<(), CaseError> {
        for method in self.methods() {
            for at in &self.at {
                let start = Start::State {
                    x_dot0: self.case.v0,
                    a0: self.case.sliding_elongation(),
                };
                let case = self.case(method, *at);
                Case { start, ..case }.motion()?;
            }
        }
        Ok(())
    }

    /// The places at which a method has shares of its own: the slope of the model is nothing to
    /// delayed feedback.
    fn places(&self, method: Method) -> &[At] {
        match (method, self.over) {
            (Method::Delayed, Over::Slope) => &self.at[..1],
            _ => &self.at,
        }
    }

    /// The shares, found on `threads` threads; they do not depend on their number.
    ///
    /// # Errors
    /// When a value is out of range, it is stopped, or the threads cannot be started.
    pub fn answer(
        &self,
        threads: usize,
        attended: Attended,
    ) -> Result<Comparison, RunError<Infallible>> {
        self.check()?;
        let regions = self.regions()?;
        let mut items = Vec::new();
        for method in self.methods() {
            for (region, at) in regions
                .iter()
                .flat_map(|region| self.places(method).iter().map(move |at| (region, at)))
            {
                let readings = self.case.feedback.readings;
                items.push(Item {
                    asked: BasinProblem::of_case(
                        self.case(method, *at),
                        *region,
                        self.starts,
                        self.seed,
                    ),
                    exact: at.noise == 0.0 && readings.resolution == 0.0,
                });
            }
        }
        let starts = |item: &Item| u64::from(item.asked.starts());
        let tallies = each_attended(&items, threads, attended, starts, Item::tally)?;
        Ok(self.told(&tallies, regions[1]))
    }

    /// The answer from what became of the starts.
    fn told(&self, tallies: &[Tally], cycle: Region) -> Comparison {
        let mut left = tallies.iter();
        let methods = self.methods().map(|method| {
            let mut shares = || self.shares(method, &mut left);
            let (near, stick_slip) = (shares(), shares());
            let (name, sample_time) = self.named(method);
            Compared {
                method: name,
                sample_time,
                near,
                stick_slip,
            }
        });
        let methods = methods.collect();
        let fixed = |over: Over, of: fn(&At) -> f64| {
            let first = self.at.first().filter(|_| over != self.over);
            first.map(of)
        };
        Comparison {
            over: self.over.name(),
            amplitude: fixed(Over::Amplitude, |at| at.amplitude),
            slope: fixed(Over::Slope, |at| at.slope),
            noise: fixed(Over::Noise, |at| at.noise),
            model: self.model_name(),
            starts: self.starts,
            seed: self.seed,
            horizon: self.horizon,
            period: match cycle {
                Region::Phase { period } => Some(period),
                Region::State { .. } | Region::None => None,
            },
            methods,
        }
    }

    /// The shares of a method from one kind of starts; what it has no tally of is as at the first
    /// place.
    fn shares<'t>(
        &self,
        method: Method,
        tallies: &mut impl Iterator<Item = &'t Tally>,
    ) -> Vec<ReachedShare> {
        let found: Vec<_> = tallies
            .take(self.places(method).len())
            .map(|tally| {
                let of = |outcome| tally.starts(outcome);
                let unreached = [Outcome::LiftOff, Outcome::Undecided].map(of);
                (tally.share(&[Outcome::Sliding]), unreached)
            })
            .collect();
        let values = self.at.iter().map(|at| match self.over {
            Over::Amplitude => at.amplitude,
            Over::Slope => at.slope,
            Over::Noise => at.noise,
        });
        let share = |(place, value): (usize, f64)| {
            let of = found.get(place).or(found.first());
            ReachedShare {
                value,
                share: of.map_or(f64::NAN, |(of, _)| of.share),
                error: of.map_or(f64::NAN, |(of, _)| of.error),
                lift_off: of.map_or(0, |(_, [lift_off, _])| *lift_off),
                undecided: of.map_or(0, |(_, [_, undecided])| *undecided),
            }
        };
        values.enumerate().map(share).collect()
    }
}

impl Item {
    /// What becomes of its starts; none once `stop` is set.
    fn tally(&self, stop: &Stop) -> Option<Tally> {
        let mut follower = self.asked.follower().heeding(stop);
        let (mut motion, mut tally) = (None, Tally::default());
        for place in self.asked.places() {
            if stop.is_set() {
                return None;
            }
            let begun = follower.begin(place, &mut motion);
            let outcome = begun.map_or(Outcome::Undecided, |(motion, case)| {
                let unit = case.units().time;
                let span = [case.switch_on, case.horizon].map(|t| t / unit);
                let exact = self.exact;
                reached(motion, Reached { span, exact })
            });
            tally.count(place, outcome);
        }
        Some(tally)
    }
}

impl ReachedShare {
    /// Half of the interval in which the share lies with 95 % confidence.
    #[must_use]
    pub fn within(&self) -> f64 {
        STUDENT_95 * self.error
    }
}
