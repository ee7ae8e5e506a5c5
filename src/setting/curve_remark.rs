//! Remarks on a measured friction law: velocities that lie beyond its points, and slopes that its
//! points contradict.

use super::law_kind::LawKind;
use super::noisy_slope::Noisy;
use super::parameter::Parameter;
use super::spec::SweepSpec;
use super::units::Units;
use super::values::Setting;
use crate::slip::speeds::Speeds;
use crate::text::{Shown, to_digits};

/// Digits after the first one of velocities that are computed.
const DIGITS: usize = 5;
/// The relative difference up to which a computed velocity is one of the curve.
const NEAR: f64 = 1e-9;

impl Setting {
    /// A remark on a v0 beyond the points of a measured friction law.
    #[must_use]
    pub(crate) fn beyond_curve(&self, units: &Units) -> Option<String> {
        Curve::of(self.law()?, units)?.remark_on(Parameter::V0.name(), &[self.get(Parameter::V0)])
    }

    /// A remark on a v0 beyond the points of a measured friction law, or at which its slope is not
    /// sure.
    #[must_use]
    pub fn curve_remark(&self, units: &Units) -> Option<String> {
        self.remark_at(&[self.get(Parameter::V0)], units)
    }

    fn remark_at(&self, speeds: &[f64], units: &Units) -> Option<String> {
        let beyond = Curve::of(self.law()?, units)?.remark_on(Parameter::V0.name(), speeds);
        let raw = self.fit_errors().is_none();
        beyond.or_else(|| {
            raw.then(|| noisy_slope(self.law()?, speeds, units))
                .flatten()
        })
    }

    /// A remark on velocities that were computed, called `of`, beyond the points of a measured
    /// friction law.
    #[must_use]
    pub(crate) fn found_beyond_curve(
        &self,
        of: &str,
        found: &[f64],
        units: &Units,
    ) -> Option<String> {
        let found: Vec<f64> = found.iter().map(|v| to_digits(*v, DIGITS)).collect();
        Curve::of(self.law()?, units)?.remark_on(of, &found)
    }

    /// A remark on a block whose speeds went beyond the points of a measured friction law.
    #[must_use]
    pub(crate) fn motion_beyond_curve(&self, speeds: Speeds, units: &Units) -> Option<String> {
        let curve = Curve::of(self.law()?, units)?;
        let told = |way: &str, v: f64| format!("{way} {}", Shown(to_digits(v, DIGITS)));
        let below = speeds.least < curve.first * (1.0 - NEAR);
        let above = speeds.most > curve.last * (1.0 + NEAR);
        let below = below.then(|| told("down to", speeds.least));
        let above = above.then(|| told("up to", speeds.most));
        curve.remark("the speed of the block", [below, above])
    }
}

impl SweepSpec {
    /// A remark on values of v0, fixed or of an axis, beyond the points of a measured friction law,
    /// or at which its slope is not sure.
    #[must_use]
    pub fn curve_remark(&self) -> Option<String> {
        let axis = self.axes.iter().find(|a| a.parameter == Parameter::V0);
        let fixed = [self.fixed.get(Parameter::V0)];
        let speeds = axis.map_or(&fixed[..], |axis| &axis.values);
        self.fixed.remark_at(speeds, &self.units)
    }
}

/// A remark on the first of some v0 at which the points of a measured curve contradict its slope.
fn noisy_slope(law: &LawKind, speeds: &[f64], units: &Units) -> Option<String> {
    let LawKind::Table(table) = law else {
        return None;
    };
    let mut noisy = speeds
        .iter()
        .filter_map(|v0| Some((*v0, Noisy::at(table, *v0)?)));
    let (v0, found) = noisy.next()?;
    let unit = |parameter| match &*units.of_parameter(parameter) {
        "1" => String::new(),
        unit => format!(" {unit}"),
    };
    let short = |value: f64| Shown(to_digits(value, 2)).to_string();
    let slopes = found.slopes.map(short);
    let noise = found.noise.map_or_else(String::new, |noise| {
        let percent = short(100.0 * noise / table.value(v0));
        let size = short(noise);
        format!("; the noise of the points is about {size} ({percent} % of mu_k there)")
    });
    Some(format!(
        "the slope of the measured curve at v0 = {}{} is not sure: between neighbouring points it \
         is {} and {}{}{noise}: `slipmap fit` tells the slope with its error",
        Shown(v0),
        unit(Parameter::V0),
        slopes[0],
        slopes[1],
        unit(Parameter::MuPrime),
    ))
}

/// The ends of a measured curve.
struct Curve {
    first: f64,
    last: f64,
    /// The unit of velocities, with a space before it.
    unit: String,
}

impl Curve {
    /// That of a law; none of a law that is not measured.
    fn of(law: &LawKind, units: &Units) -> Option<Self> {
        let LawKind::Table(table) = law else {
            return None;
        };
        Some(Self {
            first: *table.speeds().first()?,
            last: *table.speeds().last()?,
            unit: match &*units.of_parameter(Parameter::V0) {
                "1" => String::new(),
                unit => format!(" {unit}"),
            },
        })
    }

    /// The remark on those of the velocities, called `of`, that lie beyond the curve.
    fn remark_on(&self, of: &str, velocities: &[f64]) -> Option<String> {
        let below = part(velocities, |v| *v < self.first);
        self.remark(of, [below, part(velocities, |v| *v > self.last)])
    }

    /// The remark on what lies below and above the curve; none if nothing does.
    fn remark(&self, of: &str, beyond: [Option<String>; 2]) -> Option<String> {
        let Self { first, last, unit } = self;
        let parts: Vec<String> = beyond.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| {
            format!(
                "{of} {}{unit} lies beyond the curve ({} to {}{unit}), where it is taken as \
                 constant: the slope 0 is an assumption",
                parts.join(" and "),
                Shown(*first),
                Shown(*last),
            )
        })
    }
}

/// "= 2" or "from 0.6 to 2": those of the velocities that lie `beyond`, none if none does.
fn part(velocities: &[f64], beyond: impl Fn(&f64) -> bool) -> Option<String> {
    let beyond = || velocities.iter().copied().filter(&beyond);
    let (from, to) = (beyond().reduce(f64::min)?, beyond().reduce(f64::max)?);
    Some(match from == to {
        true => format!("= {}", Shown(from)),
        false => format!("from {} to {}", Shown(from), Shown(to)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: &str = "[friction]\nlaw = \"table\"\nspeeds = [0.001, 0.5]\nmu_k = [0.5, 0.4]\n";

    fn told(v0: &str, units: &str) -> Option<String> {
        let rest = format!("tau = [1]\n[fixed]\nalpha_v = 1\n{LAW}{units}");
        let spec: SweepSpec = format!("[axes]\nv0 = {v0}\n{rest}").parse().unwrap();
        spec.curve_remark()
    }

    #[test]
    fn the_part_of_an_axis_beyond_the_points_is_named() {
        let says = |v0: &str, part: &str| {
            let whole = "lies beyond the curve (0.001 to 0.5), where it is taken as constant: the \
                         slope 0 is an assumption";
            assert_eq!(told(v0, "").unwrap(), format!("v0 {part} {whole}"));
        };
        says("[2]", "= 2");
        says("[0.1, 0.6, 2]", "from 0.6 to 2");
        says("[0.6, 0.2, 1e-7]", "= 1e-7 and = 0.6");
        assert_eq!(told("[0.001, 0.5]", ""), None);
        let metres = told(
            "[2]",
            "[units]\nforce = \"N\"\nlength = \"m\"\ntime = \"s\"\n",
        );
        let metres = metres.unwrap();
        assert!(
            metres.starts_with("v0 = 2 m s-1 lies beyond the curve (0.001 to 0.5 m s-1),"),
            "{metres}"
        );
    }

    /// Of a motion its smallest and its largest speed are told, unless they are the ends of the
    /// curve within rounding.
    #[test]
    fn the_speeds_of_a_motion_beyond_the_points_are_named() {
        let spec: SweepSpec = format!("[axes]\nv0 = [0.1]\ntau = [1]\n{LAW}")
            .parse()
            .unwrap();
        let told = |least, most| {
            let speeds = Speeds { least, most };
            let told = spec.fixed.motion_beyond_curve(speeds, &Units::default());
            told.map(|told| told.split_once(" lies beyond").unwrap().0.to_owned())
        };
        let says = |what: &str| Some(format!("the speed of the block {what}"));
        assert_eq!(told(0.0, 0.4), says("down to 0"));
        assert_eq!(told(0.001, 1.0 / 1.5), says("up to 0.666667"));
        assert_eq!(told(5e-4, 2.0), says("down to 0.0005 and up to 2"));
        assert_eq!(told(0.001 * (1.0 - 1e-15), 0.5 * (1.0 + 1e-15)), None);
        let Speeds { least, most } = Speeds::default();
        assert_eq!(told(least, most), None);
    }

    #[test]
    fn other_laws_have_no_end() {
        let text = "[axes]\nv0 = [99]\ntau = [1]\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n";
        assert_eq!(text.parse::<SweepSpec>().unwrap().curve_remark(), None);
    }
}
