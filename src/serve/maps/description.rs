//! The description of a map, besides its cells.

use super::described::{self, MapAxisEnds, MapField, MapFlag, MapScalar, MapSummary, MapTold};
use crate::explore::known::KnownField;
use crate::linear::status::FLAGS;
use crate::maps::look::Look;
use crate::setting::Field;
use crate::setting::quantity::Quantity;
use crate::setting::search::LIMIT;
use crate::store::MapFile;
use crate::store::map_file::MapAxis;
use crate::store::tiles::GrowingMap;
use crate::sweep::described::schema::root;

/// The most values of an axis that are listed.
const MOST_VALUES: usize = 4096;

fn ends(axis: &MapAxis) -> MapAxisEnds {
    MapAxisEnds {
        name: axis.parameter.name().into(),
        symbol: axis.parameter.symbol().into(),
        unit: axis.unit.clone(),
        from: axis.values[0],
        to: axis.values[axis.values.len() - 1],
        points: axis.values.len(),
    }
}

fn axis(axis: &MapAxis) -> described::MapAxis {
    let listed = axis.values.len() <= MOST_VALUES;
    described::MapAxis {
        ends: ends(axis),
        long_name: axis.parameter.long_name().into(),
        values: listed.then(|| axis.values.clone()),
    }
}

fn title(look: &Look) -> String {
    look.told(
        |map| map.root_text(root::TITLE).unwrap_or_default(),
        |growing| growing.plan().spec.title.clone(),
    )
}

/// The description of a map for the list.
pub(super) fn summary(look: &Look) -> MapSummary {
    let facts = look.facts();
    let fields = facts.fields.iter().map(|field| field.name().into());
    MapSummary {
        title: Some(title(look)),
        cells: Some(facts.cells()),
        cells_done: Some(look.version().1),
        axes: facts.axes.iter().map(ends).collect(),
        fields: fields.collect(),
        plan_hash: look.told(
            |map| map.root_text(root::PLAN_HASH),
            |growing| Some(growing.manifest().plan_hash.clone()),
        ),
    }
}

/// The full description of a map, besides its cells.
pub(super) fn description(look: &Look) -> MapTold {
    let facts = look.facts();
    let (version, cells_done) = look.version();
    let critical = facts.plan.as_ref().and_then(|plan| plan.spec.critical);
    let limit = facts.plan.as_ref().is_some_and(|plan| plan.spec.limit);
    let protocol = match limit {
        true => Some(LIMIT),
        false => critical.map(|search| search.protocol.name()),
    };
    let plane = look.curves_plane();
    let field = |&field: &Field| {
        let (long_name, comment) = match critical {
            Some(_) => field.described_at_vc(),
            None => (field.long_name(), field.comment()),
        };
        let of_tiles = |growing: &GrowingMap| field.unit(&growing.plan().spec.units);
        MapField {
            known: KnownField {
                long_name,
                comment,
                ..KnownField::of(field)
            },
            unit: look.told(|map| map.field_unit(field), of_tiles),
        }
    };
    MapTold {
        title: title(look),
        cells: facts.cells(),
        cells_done,
        version,
        axes: facts.axes.iter().map(axis).collect(),
        fields: facts.fields.iter().map(field).collect(),
        scalars: scalars(look),
        flags: FLAGS.map(|(mask, name)| MapFlag { mask, name }).into(),
        curves_plane: plane
            .map(|(p, tau)| [p, tau].map(|axis| facts.axes[axis].parameter.name().to_owned())),
        protocol,
        program_version: look.told(
            |map| map.root_text(root::PROGRAM_VERSION),
            |growing| Some(growing.manifest().program_version.clone()),
        ),
        sweep: sweep(look),
    }
}

/// The sweep file's text.
pub(super) fn sweep(look: &Look) -> String {
    look.told(
        |map| map.root_text(root::SWEEP).unwrap_or_default(),
        |growing| growing.plan().spec.text.clone(),
    )
}

/// The parameters that are no axes.
fn scalars(look: &Look) -> Vec<MapScalar> {
    let facts = look.facts();
    let found = look.told(MapFile::scalars, |growing| growing.plan().spec.scalars());
    let units = facts.plan.as_ref().map(|plan| &plan.spec.units);
    let told = |(of, value): (Quantity, f64)| MapScalar {
        name: of.name().to_owned(),
        symbol: of.symbol().to_owned(),
        long_name: of.long_name().to_owned(),
        unit: units.map_or("1".into(), |units| of.unit(units)),
        value,
    };
    found.into_iter().map(told).collect()
}
