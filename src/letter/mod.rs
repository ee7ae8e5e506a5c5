//! The letter, reproduced: every claim of F.-J. Elmer, *Controlling friction* (1997), computed
//! again, with a verdict that follows from the results.
//!
//! ```text
//! sweeps and cases → [workshop] maps, traces, pictures → evidence: plain numbers
//!                  → [claim] claims with verdicts → [page] one page of HTML, or JSON
//! ```
//!
//! - `stability`, `limits`, `shortest`: linear stability, the letter's Fig. 2; where controls end;
//!   short delays
//! - `damping`: velocity control of a damped spring
//! - `roots`: characteristic roots: their number, bounds and decay
//! - `motions`: the motions of its Fig. 3, the fate of stick-slip, basins
//! - `forces`: the forces of control while the block comes to slide
//! - `robustness`, `measures`: critical velocities at finite delays; comparison of both controls
//! - `short_delay`: Coulomb friction in the limit of a vanishing delay, its Fig. 4
//! - `return_map`, `routes`, `drift`: control by the return map beside delayed feedback: its
//!   vicinity; the slow approach; maps that were reconstructed once
//! - `measuring`: friction measured through control
//!
//! Each of these has structures of evidence, filled by a run. A claim is a pure function of one of
//! them: equal numbers give equal verdicts.
//!
//! - `one_variable`: integrals and minima of functions of one variable
//! - `claim`: a claim, the values by which it is judged, its verdict
//! - `page`: the page, and pages of other results; the only file that imports maud
//! - `kept_picture`: pictures in a folder that is kept, and whether one there is such a picture
//! - `workshop`: the maps and traces behind claims: sweeps of `sweeps/` computed into files, drawn
//!   and read

mod claim;
mod damping;
mod drift;
mod forces;
mod kept_picture;
mod limits;
mod measures;
mod measuring;
mod motions;
mod one_variable;
mod page;
mod return_map;
mod robustness;
mod roots;
mod routes;
mod short_delay;
mod shortest;
mod stability;
mod workshop;

use std::convert::Infallible;
use std::path::{Path, PathBuf};

use serde::Serialize;
use utoipa::ToSchema;

use crate::answers::trace::TraceError;
use crate::model::ModelError;
use crate::report::picture::PictureError;
use crate::slip::case::CaseError;
use crate::store::StoreError;
use crate::sweep::RunError;
use crate::text::SpecError;
pub(crate) use claim::{Claim, Verdict};
pub(crate) use page::{GENERATOR, GENERATOR_OF_COMPARE, Sheet};
pub(crate) use workshop::{Figure, Workshop};

/// The letter with what this program finds.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub(crate) struct Reproduction {
    /// Every claim, linear stability first.
    pub claims: Vec<Claim>,
    /// The maps and traces behind them.
    pub figures: Vec<Figure>,
}

/// Why the letter could not be reproduced.
#[derive(Debug, thiserror::Error)]
pub(crate) enum LetterError {
    /// It was stopped.
    #[error("interrupted")]
    Stopped,
    /// A sweep or a case is not understood, which is a fault of the program.
    #[error("{name}: {error}; this is a fault of slipmap")]
    Spec {
        /// The name of the sweep or case.
        name: &'static str,
        /// What is wrong.
        error: SpecError,
    },
    /// There is already a file with this name that this run did not make.
    #[error("{} is already there, and not of this run", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// A map could not be computed.
    #[error(transparent)]
    Run(RunError<StoreError>),
    /// A question about motions could not be answered.
    #[error(transparent)]
    Unanswered(RunError<Infallible>),
    /// A motion could not be followed.
    #[error(transparent)]
    Trace(TraceError),
    /// A picture could not be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A file could not be read or written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The model refuses a value, which is a fault of the program.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl LetterError {
    fn spec(name: &'static str) -> impl Fn(SpecError) -> Self {
        move |error| Self::Spec { name, error }
    }

    fn case(error: CaseError) -> Self {
        Self::Trace(error.into())
    }

    fn io(action: &'static str, path: &Path) -> impl Fn(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| {
            let path = path.clone();
            Self::Store(StoreError::Io {
                action,
                path,
                source,
            })
        }
    }
}

impl From<RunError<StoreError>> for LetterError {
    fn from(error: RunError<StoreError>) -> Self {
        match error {
            RunError::Interrupted => Self::Stopped,
            other => Self::Run(other),
        }
    }
}

impl From<RunError<Infallible>> for LetterError {
    fn from(error: RunError<Infallible>) -> Self {
        match error {
            RunError::Interrupted => Self::Stopped,
            other => Self::Unanswered(other),
        }
    }
}

impl From<TraceError> for LetterError {
    fn from(error: TraceError) -> Self {
        match error {
            TraceError::Stopped => Self::Stopped,
            other => Self::Trace(other),
        }
    }
}

/// Reproduces the letter.
///
/// # Errors
/// When the run is stopped, the folder cannot be written to or holds other files of the same names,
/// or a map cannot be computed.
pub(crate) fn reproduce(mut workshop: Workshop) -> Result<Reproduction, LetterError> {
    let shop = &mut workshop;
    shop.look(&stability::SOURCES)?;
    shop.look(&limits::SOURCES)?;
    shop.look(&damping::SOURCES)?;
    shop.look(&motions::SOURCES)?;
    shop.look(&robustness::SOURCES)?;
    shop.look(&short_delay::SOURCES)?;
    let mut claims = roots::claims(shop)?;
    claims.extend(stability::claims(shop)?);
    claims.extend(limits::claims(shop)?);
    claims.extend(damping::claims(shop)?);
    claims.extend(motions::claims(shop)?);
    claims.extend(robustness::claims(shop)?);
    claims.extend(short_delay::claims(shop)?);
    claims.extend(of_return_maps(shop)?);
    claims.extend(measuring::claims(shop)?);
    shop.step("the page")?;
    let made = workshop.made;
    for claim in &mut claims {
        let commands = claim.evidence.iter().filter_map(|name| made.get(name));
        let commands: Vec<_> = commands.map(|figure| figure.command.clone()).collect();
        claim.commands.splice(0..0, commands);
    }
    let figures = made.into_values().collect();
    Ok(Reproduction { claims, figures })
}

/// The claims on control by the return map.
fn of_return_maps(shop: &Workshop) -> Result<[Claim; 3], LetterError> {
    shop.step("control by the return map")?;
    let vicinity = return_map::Vicinity::found(shop)?;
    shop.step("the slow approach")?;
    let slowly = routes::Slowly::found(shop, &vicinity)?;
    shop.step("maps that drift")?;
    let drift = drift::Drift::found(shop)?;
    Ok([vicinity.claim(), slowly.claim(), drift.claim()])
}

impl Reproduction {
    /// Number of claims with a verdict.
    #[must_use]
    pub(crate) fn with(&self, verdict: Verdict) -> usize {
        let same = self.claims.iter().filter(|claim| claim.verdict == verdict);
        same.count()
    }
}
