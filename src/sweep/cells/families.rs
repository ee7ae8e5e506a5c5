//! The families of fields whose cells take long, each computed line by line.

use super::basin_columns::BasinColumns;
use super::buffers::TileBuffers;
use super::line::SlowLine;
use super::margin_columns::MarginColumns;
use super::slip_columns::SlipColumns;
use super::vc_columns::VcColumns;
use crate::setting::spec::SweepSpec;

/// The fields of one origin.
pub(super) enum FieldFamily<'p> {
    Margins(MarginColumns),
    Motions(SlipColumns<'p>),
    Basin(BasinColumns<'p>),
    Critical(VcColumns),
}

impl<'p> FieldFamily<'p> {
    /// The families of which a sweep has a field.
    pub(super) fn all(spec: &'p SweepSpec) -> Vec<Self> {
        let families = [
            MarginColumns::new(&spec.fields).map(Self::Margins),
            SlipColumns::new(spec).map(Self::Motions),
            BasinColumns::new(spec).map(Self::Basin),
            VcColumns::new(spec).map(Self::Critical),
        ];
        families.into_iter().flatten().collect()
    }

    /// Computes the cells of a line with known statuses.
    pub(super) fn fill(&mut self, line: &SlowLine, buffers: &mut TileBuffers) {
        match self {
            Self::Margins(columns) => columns.fill(line, buffers),
            Self::Motions(columns) => columns.fill(line, buffers),
            Self::Basin(columns) => columns.fill(line, buffers),
            Self::Critical(columns) => columns.fill(line, buffers),
        }
    }
}
