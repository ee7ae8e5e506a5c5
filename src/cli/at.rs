//! A place on an axis of a map: `--at AXIS=VALUE`.

use std::fmt;

use crate::report::numbers::unit_behind;
use crate::setting::Parameter;
use crate::setting::amount::Amount;
use crate::setting::axis::nearest;
use crate::setting::quantity::Quantity;
use crate::setting::system::{NO_SPEED, SpeedUnit, SystemModel};
use crate::setting::units::Units;
use crate::store::MapFile;
use crate::sweep::Plan;
use crate::text::nearest::did_you_mean;
use crate::text::{Shown, SpecError, words};

use super::failure::Failure;
use super::parameter_values::{named_amount, quantity_in_units};

/// A place on an axis, as given by a flag.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct At {
    name: String,
    value: Amount,
}

/// Reads a name and a value. Whether the axis exists depends on the map.
pub(super) fn parse_at(text: &str) -> Result<At, String> {
    let (name, value) = named_amount(text, "AXIS=VALUE, for example mu_prime=-0.3")?;
    let name = name.replace('-', "_");
    Ok(At { name, value })
}

/// The axes of a map, with what it takes to read a place on them.
pub(super) struct Axes<'m> {
    all: Vec<(&'m Quantity, &'m [f64])>,
    system: Option<&'m SystemModel>,
    units: Units,
}

impl<'m> From<&'m MapFile> for Axes<'m> {
    fn from(map: &'m MapFile) -> Self {
        let axes = map.axes().iter();
        Self {
            all: axes.map(|axis| (&axis.parameter, &*axis.values)).collect(),
            system: map.system(),
            units: map.units(),
        }
    }
}

impl<'m> From<&'m Plan> for Axes<'m> {
    fn from(Plan { spec, .. }: &'m Plan) -> Self {
        let axes = spec.axes.iter();
        Self {
            all: axes.map(|axis| (&axis.parameter, &*axis.values)).collect(),
            system: spec.fixed.system(),
            units: spec.units.clone(),
        }
    }
}

impl Axes<'_> {
    /// The number of an axis.
    fn named(&self, name: &str) -> Option<usize> {
        let mut axes = self.all.iter();
        axes.position(|(axis, _)| words::same(axis.name(), name))
    }

    /// For every axis, the place at which `at` holds it; none where it is free.
    pub(super) fn held(&self, at: &[At]) -> Result<Vec<Option<usize>>, Failure> {
        let mut held = vec![None; self.all.len()];
        for at in at {
            let (axis, value) = at.on(self)?;
            let place = at.place(self, (axis, value))?;
            if held[axis].replace(place).is_some() {
                let name = self.of(axis).name();
                let message = match name == at.name {
                    true => format!("--at {name} is given twice"),
                    false => format!("--at {at}: {name} is given twice"),
                };
                return Err(Failure::bad_input(message));
            }
        }
        Ok(held)
    }

    /// The parameter of an axis.
    pub(super) fn of(&self, axis: usize) -> &Quantity {
        self.all[axis].0
    }
}

impl At {
    /// The number of the axis, and the value on it in the units of the map. The name may be the
    /// unit of the speed whose period the delay is: then it is the value of the nearest speed.
    pub(super) fn on(&self, axes: &Axes) -> Result<(usize, f64), Failure> {
        let Self { name, value } = self;
        if let Some(axis) = axes.named(name) {
            let flag = format!("--at {name}");
            let value = quantity_in_units(&flag, value, axes.of(axis), &axes.units)?;
            return Ok((axis, value));
        }
        let speed = axes.system.and_then(|system| system.takes_speed(name));
        let delay = axes.named(Parameter::Tau.name());
        if let (Some(unit), Some(delay)) = (speed, delay) {
            let period = self.period(unit, &axes.units)?;
            return Ok((delay, self.of_nearest_speed(axes, (delay, period))?));
        }
        let names = || axes.all.iter().map(|(axis, _)| axis.name());
        let meant = did_you_mean(name, names());
        let no_speed = match (SpeedUnit::named(name), speed) {
            (Some(_), None) => format!("; {NO_SPEED}"),
            (Some(_), Some(_)) => "; tau, whose speed it would be, is none of them".into(),
            (None, _) => String::new(),
        };
        let names: Vec<_> = names().collect();
        Err(Failure::bad_input_with_help(
            format!("--at: {name} is no axis of this map"),
            format!("{meant}its axes: {}{no_speed}", names.join(", ")),
        ))
    }

    /// The period of the speed that is given in `unit`.
    fn period(&self, unit: SpeedUnit, units: &Units) -> Result<f64, Failure> {
        let Self { name, value } = self;
        let text = format!("{name}={value}");
        let of_name = |error: SpecError| SpecError {
            span: Some(0..name.len()),
            help: Some("type the delay: --at tau=VALUE".into()),
            ..error
        };
        let of_value = |error: SpecError| SpecError {
            span: Some(name.len() + 1..text.len()),
            ..error
        };
        let turn = unit.turn(units).map_err(of_name);
        let period = turn.and_then(|turn| {
            let number = value.check([0; 3]).and_then(|()| value.value(units));
            let speed = number.and_then(|speed| unit.checked(speed));
            Ok(turn.over(speed.map_err(of_value)?))
        });
        period.map_err(|error| Failure::in_file(error, "--at", &text))
    }

    /// The delay on its axis whose speed is nearest to that of `period`, which must be within the
    /// axis.
    fn of_nearest_speed(&self, axes: &Axes, (axis, period): (usize, f64)) -> Result<f64, Failure> {
        self.place(axes, (axis, period))?;
        let delays = axes.all[axis].1;
        let apart = |delay: &f64| (1.0 / delay - 1.0 / period).abs();
        let nearest = delays.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        Ok(nearest.copied().unwrap_or(period))
    }

    /// The place on its axis of the value nearest to `value`, which must be within the axis.
    pub(super) fn place(&self, axes: &Axes, (axis, value): (usize, f64)) -> Result<usize, Failure> {
        let (of, values) = axes.all[axis];
        nearest(values, value).map_err(|[low, high]| {
            let unit = unit_behind(&of.unit(&axes.units));
            let [value, low, high] = [value, low, high].map(Shown);
            let of_speed = match of.name() == self.name {
                true => String::new(),
                false => format!(" {self}:"),
            };
            Failure::bad_input_with_help(
                format!("--at{of_speed} {}={value} is outside the axis", of.name()),
                format!("it goes from {low}{unit} to {high}{unit}"),
            )
        })
    }

    /// The word for it in the name of a file.
    pub(super) fn in_file_name(&self) -> String {
        let text = format!("{}={}", self.name, self.value);
        text.replace('/', " per ").replace(' ', "_")
    }
}

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{}={}", self.name, self.value);
        match text.contains(' ') {
            true => write!(f, "\"{text}\""),
            false => f.write_str(&text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_on_axes_are_read() {
        for (text, value) in [("mu_prime=-0.3", -0.3), ("mu-prime = 1e-2", 0.01)] {
            let at = parse_at(text).unwrap();
            let parameters = [Parameter::Tau, Parameter::MuPrime].map(Quantity::from);
            let mut axes = Axes {
                all: parameters.iter().map(|of| (of, &[-1.0][..])).collect(),
                system: None,
                units: Units::default(),
            };
            assert!(matches!(at.on(&axes), Ok(found) if found == (1, value)));
            axes.all.pop();
            assert!(at.on(&axes).is_err());
        }
        for (text, says) in [
            ("tau", "AXIS=VALUE"),
            ("tau=", "finite number"),
            ("tau=inf", "finite number"),
        ] {
            let error = parse_at(text).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
    }
}
