//! What a map tells of itself besides its cells.

use serde_json::{Value, json};

use crate::linear::status::FLAGS;
use crate::maps::look::Look;
use crate::store::MapFile;
use crate::store::map_file::MapAxis;
use crate::store::schema::root;
use crate::store::tiles::GrowingMap;
use crate::sweep::input::search::LIMIT;
use crate::sweep::{Field, Parameter};

/// The most values of an axis that are listed.
const MOST_VALUES: usize = 4096;

fn axis_json(axis: &MapAxis) -> Value {
    json!({
        "name": axis.parameter.name(),
        "symbol": axis.parameter.symbol(),
        "unit": axis.unit,
        "from": axis.values.first(),
        "to": axis.values.last(),
        "points": axis.values.len(),
    })
}

fn title(look: &Look) -> String {
    look.told(
        |map| map.root_text(root::TITLE).unwrap_or_default(),
        |growing| growing.plan().spec.title.clone(),
    )
}

/// What a list tells of it.
pub(super) fn summary(look: &Look) -> Value {
    let facts = look.facts();
    json!({
        "title": title(look),
        "cells": facts.cells(),
        "cells_done": look.version().1,
        "axes": facts.axes.iter().map(axis_json).collect::<Vec<_>>(),
        "fields": facts.fields.iter().map(|field| field.name()).collect::<Vec<_>>(),
    })
}

/// What there is to know of it besides its cells.
pub(super) fn description(look: &Look) -> Value {
    let facts = look.facts();
    let (version, cells_done) = look.version();
    let axis = |axis: &MapAxis| {
        let mut told = axis_json(axis);
        told["long_name"] = axis.parameter.long_name().into();
        let listed = (axis.values.len() <= MOST_VALUES).then_some(&axis.values);
        told["values"] = json!(listed);
        told
    };
    let critical = facts.plan.as_ref().and_then(|plan| plan.spec.critical);
    let limit = facts.plan.as_ref().is_some_and(|plan| plan.spec.limit);
    let protocol = match limit {
        true => Some(LIMIT),
        false => critical.map(|search| search.protocol.name()),
    };
    let plane = look.curves_plane();
    let plane = plane.map(|(p, tau)| [p, tau].map(|axis| facts.axes[axis].parameter.name()));
    let unit = |field: Field| {
        let of_tiles = |growing: &GrowingMap| field.unit(&growing.plan().spec.units);
        look.told(|map| map.field_unit(field), of_tiles)
    };
    let field = |&field: &Field| {
        let (long_name, comment) = match critical {
            Some(_) => field.described_at_vc(),
            None => (field.long_name(), field.comment()),
        };
        json!({
            "name": field.name(), "long_name": long_name, "short_name": field.short_name(),
            "unit": unit(field), "storage": field.storage().name(), "kinds": field.kinds(),
            "spread": field.spread().name(), "stable_sign": field.spread().stable_sign(),
            "comment": comment,
        })
    };
    json!({
        "title": title(look), "cells": facts.cells(), "cells_done": cells_done,
        "version": version,
        "axes": facts.axes.iter().map(axis).collect::<Vec<_>>(),
        "fields": facts.fields.iter().map(field).collect::<Vec<_>>(),
        "scalars": scalars(look),
        "flags": FLAGS.map(|(mask, name)| json!({ "mask": mask, "name": name })),
        "curves_plane": plane, "protocol": protocol,
        "program_version": look.told(
            |map| map.root_text(root::PROGRAM_VERSION),
            |growing| Some(growing.manifest().program_version.clone()),
        ),
        "sweep": sweep(look),
    })
}

/// The sweep file's text.
pub(super) fn sweep(look: &Look) -> String {
    look.told(
        |map| map.root_text(root::SWEEP).unwrap_or_default(),
        |growing| growing.plan().spec.text.clone(),
    )
}

/// The parameters that are no axes.
fn scalars(look: &Look) -> Vec<Value> {
    let facts = look.facts();
    let found: Vec<(Parameter, f64)> = look.told(MapFile::scalars, |growing| {
        let spec = &growing.plan().spec;
        let on_axis = |p: Parameter| spec.axes.iter().any(|axis| axis.parameter == p);
        let held = Parameter::ALL.into_iter();
        let held = held.filter(|&p| spec.uses(p) && !on_axis(p));
        held.map(|p| (p, spec.fixed.get(p))).collect()
    });
    let units = facts.plan.as_ref().map(|plan| &plan.spec.units);
    let unit = |p: Parameter| units.map_or("1".into(), |units| units.of_parameter(p));
    let told = |(p, value): (Parameter, f64)| {
        json!({
            "name": p.name(), "symbol": p.symbol(), "long_name": p.long_name(),
            "unit": unit(p), "value": value,
        })
    };
    found.into_iter().map(told).collect()
}
