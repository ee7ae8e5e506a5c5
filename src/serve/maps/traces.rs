//! Answers about a trace, made in the process that reads it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::described::{MapScalar, MapSummary, TraceSummary, TraceTold};
use super::description::scalar;
use super::frames::Refused;
use crate::explore::motion::{Followed, Limits};
use crate::explore::motion_bytes;
use crate::setting::Parameter;
use crate::setting::quantity::Quantity;
use crate::store::stamp::Stamp;
use crate::store::trace_reader::TraceHead;
use crate::store::{StoreError, TraceFile};

/// A trace, whose samples are read when they are asked for.
pub(super) struct Opened {
    path: PathBuf,
    stamp: Option<Stamp>,
    head: TraceHead,
}

impl Opened {
    /// Opens the trace at `path`.
    ///
    /// # Errors
    /// When there is none, or it is damaged.
    pub(super) fn of(path: &Path) -> Result<Self, StoreError> {
        Ok(Self {
            path: path.to_owned(),
            stamp: Stamp::of(path),
            head: TraceHead::read(path)?,
        })
    }

    /// Whether the file is the one that was opened.
    pub(super) fn is_there(&self) -> bool {
        Stamp::of(&self.path) == self.stamp
    }

    fn about(&self) -> TraceSummary {
        TraceSummary {
            samples: self.head.samples,
            until: self.head.until,
            unit: self.head.spec.units.time(),
            outcome: self.head.outcome.name().into(),
        }
    }

    /// The description for the list.
    pub(super) fn summary(&self) -> MapSummary {
        MapSummary {
            title: Some(self.head.spec.title.clone()),
            trace: Some(self.about()),
            ..MapSummary::default()
        }
    }

    /// The full description, besides its samples.
    pub(super) fn description(&self) -> TraceTold {
        TraceTold {
            title: self.head.spec.title.clone(),
            trace: self.about(),
            scalars: self.scalars(),
            program_version: self.head.program_version.clone(),
            case: self.case(),
        }
    }

    fn scalars(&self) -> Vec<MapScalar> {
        let (setting, units) = (&self.head.spec.setting, &self.head.spec.units);
        let known = Parameter::ALL.into_iter().filter(|&p| setting.uses(p));
        let known = known.map(|parameter| (Quantity::from(parameter), setting.get(parameter)));
        let own = setting.own();
        let own = own.map(|(own, value)| (Quantity::Own(Arc::clone(own)), value));
        let given = known.chain(own).filter(|(_, value)| !value.is_nan());
        given
            .map(|(of, value)| scalar(&of, value, Some(units)))
            .collect()
    }

    /// The case file's text.
    pub(super) fn case(&self) -> String {
        self.head.spec.text.clone()
    }

    /// The motion, its samples thinned.
    pub(super) fn motion(&self) -> Result<Vec<u8>, Refused> {
        let file = TraceFile::open(&self.path).map_err(Refused::damaged)?;
        let TraceFile { spec, trace, .. } = file;
        let motion = Followed::stored(spec, trace, Limits::default());
        motion_bytes::encoded(&motion).map_err(Refused::damaged)
    }
}
