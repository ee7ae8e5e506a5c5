//! Every request by its name, with its answer as bytes: common to the server and the page without
//! one.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use serde::Serialize;

use super::best::{Recommended, Searched};
use super::best_answer::BestInPlane;
use super::chart::{self, Chart};
use super::given_setting::GivenSetting;
use super::known::{Known, KnownFormula};
use super::law::LawCurve;
use super::motion::{self, Followed};
use super::point::Point;
use super::problem::Problem;
use super::stability::Wanted;
use super::systems::KnownSystem;
use super::vc::CriticalVelocity;
use super::{chart_bytes, motion_bytes};
use crate::answers::best::default_ranges;
use crate::model::stop::Stop;
use crate::setting::command::{point_command, vc_command};
use crate::setting::point_file::{PointOf, PointSpec};
use crate::setting::table_file::Inlined;
use crate::setting::{CaseSpec, SweepSpec};
use crate::sweep::Plan;
use crate::sweep::plan::memory;

/// Number of roots in the answer for a point.
pub const ROOTS: u8 = 16;

/// The command for the point of a system that is no part of the program.
const POINT_OF_FILE: &str = "slipmap point --setting=point.toml";

/// The kind of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// Cells and curves of a sweep.
    Chart,
    /// Linear stability at a point.
    Point,
    /// The critical velocity at a point, by the protocol `follow`.
    CriticalVelocity,
    /// The best settings in the plane of a sweep.
    Best,
    /// The motion of a case.
    Motion,
    /// A friction law as a curve.
    Law,
    /// What a file says of a setting.
    Setting,
    /// The parameters of a friction law that is a formula.
    Formula,
    /// A system, from the text of its file.
    System,
    /// All parameters, laws and fields; its text is empty.
    Parameters,
}

impl Request {
    /// The requests that are answered.
    pub const ALL: [Self; 10] = [
        Self::Chart,
        Self::Point,
        Self::CriticalVelocity,
        Self::Best,
        Self::Motion,
        Self::Law,
        Self::Setting,
        Self::Formula,
        Self::System,
        Self::Parameters,
    ];

    /// The name, in addresses.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Chart => "chart",
            Self::Point => "point",
            Self::CriticalVelocity => "vc",
            Self::Best => "best",
            Self::Motion => "motion",
            Self::Law => "law",
            Self::Setting => "setting",
            Self::Formula => "formula",
            Self::System => "system",
            Self::Parameters => "parameters",
        }
    }

    /// The request with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|request| request.name() == name)
    }

    /// Whether its answer is bytes as in [`super::encoded`]; otherwise it is JSON.
    #[must_use]
    pub const fn is_encoded(self) -> bool {
        matches!(self, Self::Chart | Self::Motion)
    }

    /// The type of its answer.
    #[must_use]
    pub const fn content_type(self) -> &'static str {
        match self.is_encoded() {
            true => "application/octet-stream",
            false => "application/json",
        }
    }
}

/// Limits of what an answer may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Limits {
    /// A chart.
    pub chart: chart::Limits,
    /// A motion.
    pub motion: motion::Limits,
}

/// An answer with the command line that gives the same, and with a warning.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct WithCommand<T> {
    /// The answer.
    #[serde(flatten)]
    pub answer: T,
    /// The command line; none where flags cannot say it. That of a system that is no part of the
    /// program reads the text of the request from `point.toml`.
    #[cfg_attr(feature = "serve", schema(required))]
    pub command: Option<String>,
    /// What it assumes of friction at velocities that were not measured; null where it assumes
    /// nothing.
    #[cfg_attr(feature = "serve", schema(required))]
    pub warning: Option<String>,
}

/// A request that has been read and is within limits.
#[derive(Debug, Clone)]
pub enum Asked {
    /// [`Request::Chart`].
    Chart(Arc<Plan>),
    /// [`Request::Point`].
    Point(PointSpec),
    /// [`Request::CriticalVelocity`].
    CriticalVelocity(PointSpec),
    /// [`Request::Best`].
    Best(Box<Searched>),
    /// [`Request::Motion`].
    Motion(Box<CaseSpec>, motion::Limits),
    /// [`Request::Law`], with what is told of its points.
    Law(PointSpec, Vec<String>),
    /// [`Request::Setting`].
    Setting(GivenSetting),
    /// [`Request::Formula`].
    Formula(KnownFormula),
    /// [`Request::System`].
    System(Box<KnownSystem>),
    /// [`Request::Parameters`].
    Parameters,
}

impl Asked {
    /// Reads the text of a request.
    ///
    /// # Errors
    /// When it is not understood, or exceeds the limits.
    pub fn read(request: Request, text: &str, limits: &Limits) -> Result<Self, Problem> {
        let inlined = Inlined::pasted(text)?;
        let read = Self::read_inlined(request, &inlined, limits);
        read.map_err(|problem| Problem {
            span: problem.span.map(|[start, end]| {
                let place = inlined.original(start..end);
                [place.start, place.end]
            }),
            ..problem
        })
    }

    fn read_inlined(request: Request, of: &Inlined, limits: &Limits) -> Result<Self, Problem> {
        let Inlined { text, remarks, .. } = of;
        let point = |of| PointSpec::read(text, of);
        Ok(match request {
            Request::Chart => Self::Chart(Chart::plan(text, limits.chart)?),
            Request::Point => Self::Point(point(PointOf::Sliding)?),
            Request::CriticalVelocity => Self::CriticalVelocity(point(PointOf::CriticalVelocity)?),
            Request::Best => {
                let spec = SweepSpec::read(text, limits.chart.points)?;
                Self::Best(Box::new(Searched::in_plane(&spec)?))
            }
            Request::Motion => Self::Motion(Box::new(text.parse()?), limits.motion),
            Request::Law => Self::Law(point(PointOf::Law)?, remarks.clone()),
            Request::Setting => Self::Setting(GivenSetting::read(text, limits.chart.points)?),
            Request::Formula => Self::Formula(KnownFormula::read(text)?),
            Request::System => Self::System(Box::new(KnownSystem::read(text)?)),
            Request::Parameters => Self::Parameters,
        })
    }

    /// An upper bound on the bytes of the answer while it is computed and encoded; 0 where that is
    /// negligible.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Chart(plan) => chart::bytes(plan),
            Self::CriticalVelocity(point) => memory::of_critical_velocity(&point.setting),
            Self::Motion(case, limits) => memory::of_motion(&case.setting) + limits.bytes(),
            Self::Point(_)
            | Self::Best(_)
            | Self::Law(..)
            | Self::Setting(_)
            | Self::Formula(_)
            | Self::System(_)
            | Self::Parameters => 0,
        }
    }

    /// Whether it may take many seconds: what searches or follows motions does.
    #[must_use]
    pub fn is_slow(&self) -> bool {
        match self {
            Self::Chart(plan) => chart::is_slow(plan),
            Self::CriticalVelocity(_) | Self::Best(_) | Self::Motion(..) => true,
            Self::Point(_)
            | Self::Law(..)
            | Self::Setting(_)
            | Self::Formula(_)
            | Self::System(_)
            | Self::Parameters => false,
        }
    }

    /// The bytes of the answer, of [`Request::content_type`]. `stop` is checked all along: within
    /// motions and curves, between cells, and between counts of roots.
    ///
    /// # Errors
    /// When it cannot be computed, or is stopped.
    pub fn answer(&self, stop: &Arc<AtomicBool>) -> Result<Vec<u8>, Problem> {
        match self {
            Self::Chart(plan) => {
                // WebAssembly has no clock.
                let begun = (!cfg!(target_family = "wasm")).then(Instant::now);
                let chart = Chart::of(plan, stop)?;
                let took = begun.map(|begun| begun.elapsed().as_secs_f64() * 1e3);
                Ok(chart_bytes::encoded(&chart, took)?)
            }
            Self::Point(PointSpec { setting, units, .. }) => {
                let wanted = Wanted {
                    roots: ROOTS,
                    line: None,
                };
                let stop = Stop::when(stop);
                let answer = Point::at(setting, wanted, &stop)?;
                if stop.is_set() {
                    return Err(Problem::stopped());
                }
                let of_file = || setting.system().map(|_| POINT_OF_FILE.to_owned());
                json(&WithCommand {
                    answer,
                    command: point_command(setting)
                        .or_else(of_file)
                        .map(|command| format!("{command} --roots={ROOTS}")),
                    warning: setting.curve_remark(units),
                })
            }
            Self::CriticalVelocity(point) => {
                let stop = Stop::when(stop);
                let answer = CriticalVelocity::of(&point.setting, point.protocol, &stop)?;
                if stop.is_set() {
                    return Err(Problem::stopped());
                }
                json(&WithCommand {
                    command: vc_command(&point.setting, point.protocol),
                    warning: answer.beyond_curve(&point.setting, &point.units),
                    answer,
                })
            }
            Self::Best(searched) => {
                let stop = Stop::when(stop);
                let usual = default_ranges(&searched.setting, &searched.of)?;
                let found = Recommended::of(Searched::clone(searched), &stop)?;
                if stop.is_set() {
                    return Err(Problem::stopped());
                }
                json(&BestInPlane::of(&found, usual))
            }
            Self::Motion(case, limits) => {
                let followed = Followed::of(case, *limits, &Stop::when(stop))?;
                Ok(motion_bytes::encoded(&followed)?)
            }
            Self::Law(point, remarks) => json(&LawCurve {
                remarks: remarks.clone(),
                ..LawCurve::of(point)?
            }),
            Self::Setting(setting) => json(setting),
            Self::Formula(formula) => json(formula),
            Self::System(system) => json(system),
            Self::Parameters => json(&Known::all()),
        }
    }
}

/// The bytes of the answer to `request` for `text`.
///
/// ```
/// use slipmap::explore::{Limits, Request, answer};
///
/// let text = "[fixed]\nmu_prime = -0.3\nalpha_v = -0.33\ntau = 4.15\n";
/// let bytes = answer(Request::Point, text, &Limits::default(), &Default::default()).unwrap();
/// let point: serde_json::Value = serde_json::from_slice(&bytes)?;
/// assert_eq!(point["n_unstable"], 0);
/// # Ok::<(), serde_json::Error>(())
/// ```
///
/// # Errors
/// As [`Asked::read`] and [`Asked::answer`].
pub fn answer(
    request: Request,
    text: &str,
    limits: &Limits,
    stop: &Arc<AtomicBool>,
) -> Result<Vec<u8>, Problem> {
    Asked::read(request, text, limits)?.answer(stop)
}

fn json(answer: &impl Serialize) -> Result<Vec<u8>, Problem> {
    Ok(serde_json::to_vec(answer)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

    /// A long computation ends once its caller is gone.
    #[test]
    fn a_stop_is_heeded() {
        let vc = format!("[fixed]\nalpha_v = -0.33\ntau = 4.15\n{LAW}");
        let motion =
            format!("{vc}[start]\nx_dot0 = 0.3\n").replace("[fixed]", "[fixed]\nv0 = 0.35");
        let best = "[axes]\nalpha_v = [-1, 0]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.3\n".to_owned();
        let chart = "[axes]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.3\n".to_owned();
        for (request, text) in [
            (Request::CriticalVelocity, vc),
            (Request::Motion, motion),
            (Request::Best, best),
            (Request::Chart, chart),
        ] {
            let asked = |stopped| {
                let stop = Arc::new(AtomicBool::new(stopped));
                answer(request, &text, &Limits::default(), &stop)
            };
            assert!(asked(false).is_ok(), "{request:?}: {:?}", asked(false));
            assert_eq!(asked(true), Err(Problem::stopped()), "{request:?}");
        }
    }

    #[test]
    fn names_are_of_one_request_each() {
        for request in Request::ALL {
            assert_eq!(Request::from_name(request.name()), Some(request));
        }
    }
}
