//! The description of a map, besides its cells.

use std::path::Path;

use super::described::{
    self, MapAxisEnds, MapField, MapFirst, MapScalar, MapSpeed, MapSummary, MapTold,
};
use crate::explore::known::{KnownField, KnownFlag};
use crate::maps::look::Look;
use crate::meaning::first;
use crate::meaning::scale::has_speeds;
use crate::queue::progress::Watched;
use crate::setting::quantity::Quantity;
use crate::setting::search::LIMIT;
use crate::setting::units::Units;
use crate::setting::{Field, Parameter};
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

/// The speed along an axis of delays, where the system of the map has one.
fn speed(look: &Look, axis: &MapAxis) -> Option<MapSpeed> {
    let spec = &look.facts().plan.as_ref()?.spec;
    let system = spec
        .fixed
        .system()
        .filter(|_| axis.parameter == Parameter::Tau);
    let (speed, turn) = system?.speed(&spec.units)?;
    Some(MapSpeed {
        name: speed.name.clone(),
        unit: speed.unit.name(),
        turn: turn.over(1.0),
    })
}

fn axis(look: &Look, axis: &MapAxis) -> described::MapAxis {
    let listed = axis.values.len() <= MOST_VALUES;
    described::MapAxis {
        ends: ends(axis),
        long_name: axis.parameter.long_name().into(),
        values: listed.then(|| axis.values.clone()),
        speed: speed(look, axis),
    }
}

fn title(look: &Look) -> String {
    look.told(
        |map| map.root_text(root::TITLE).unwrap_or_default(),
        |growing| growing.plan().spec.title.clone(),
    )
}

/// The description of the map at `path` for the list.
pub(super) fn summary(look: &Look, path: &Path) -> MapSummary {
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
        seconds_left: look.told(
            |_| None,
            |_| {
                let progress = Watched::tiles_of(path).look().ok().flatten();
                progress.and_then(|progress| progress.seconds_left())
            },
        ),
        trace: None,
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
        MapField {
            known: KnownField {
                long_name,
                comment,
                ..KnownField::of(field)
            },
            unit: unit(look, field),
        }
    };
    MapTold {
        title: title(look),
        cells: facts.cells(),
        cells_done,
        version,
        axes: facts.axes.iter().map(|of| axis(look, of)).collect(),
        fields: facts.fields.iter().map(field).collect(),
        scalars: scalars(look),
        flags: KnownFlag::all(),
        curves_plane: plane
            .map(|(p, tau)| [p, tau].map(|axis| facts.axes[axis].parameter.name().to_owned())),
        first: first(look, plane),
        protocol,
        program_version: look.told(
            |map| map.root_text(root::PROGRAM_VERSION),
            |growing| Some(growing.manifest().program_version.clone()),
        ),
        sweep: sweep(look),
    }
}

/// What a picture of a map shows first; `boundary` is the plane of its curves.
fn first(look: &Look, boundary: Option<(usize, usize)>) -> MapFirst {
    let facts = look.facts();
    let spec = facts.plan.as_ref().map(|plan| &plan.spec);
    let system = spec.and_then(|spec| spec.fixed.system());
    let periods = system.is_some_and(|system| system.speed_axis.is_some());
    let is_delay = |axis: usize| facts.axes[axis].parameter == Parameter::Tau;
    let long = |axis: &usize| facts.axes[*axis].values.len() > 1;
    let free: Vec<usize> = (0..facts.axes.len()).filter(long).collect();
    let axes = first::Axes {
        free: &free,
        boundary,
        is_delay: &is_delay,
        is_speed: &|axis| periods && is_delay(axis) && has_speeds(&facts.axes[axis].values),
    };
    let (x, y) = axes.plane().unwrap_or((0, None));
    let name = |axis: usize| facts.axes[axis].parameter.name().to_owned();
    let named = spec.and_then(|spec| spec.picture);
    MapFirst {
        field: first::field(named, &facts.fields).name(),
        x: name(x),
        y: y.map(name),
    }
}

/// The unit of a field; "1" where there is none.
pub(super) fn unit(look: &Look, field: Field) -> String {
    let of_tiles = |growing: &GrowingMap| field.unit(&growing.plan().spec.units);
    look.told(|map| map.field_unit(field), of_tiles)
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
    let told = |(of, value): (Quantity, f64)| scalar(&of, value, units);
    found.into_iter().map(told).collect()
}

/// What is told of a parameter with this value.
pub(super) fn scalar(of: &Quantity, value: f64, units: Option<&Units>) -> MapScalar {
    MapScalar {
        name: of.name().to_owned(),
        symbol: of.symbol().to_owned(),
        long_name: of.long_name().to_owned(),
        unit: units.map_or("1".into(), |units| of.unit(units)),
        told: first::is_told(of, value),
        value,
    }
}
