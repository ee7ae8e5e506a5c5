//! Remarks on a measured friction law: pulling velocities that lie beyond its points.

use super::law_kind::LawKind;
use super::parameter::Parameter;
use super::spec::SweepSpec;
use super::units::Units;
use super::values::Setting;
use crate::text::Shown;

impl Setting {
    /// A remark on a v0 beyond the points of a measured friction law.
    #[must_use]
    pub(crate) fn beyond_curve(&self, units: &Units) -> Option<String> {
        let v0 = Parameter::V0;
        remark(self.law()?, v0.name(), &[self.get(v0)], units)
    }

    /// A remark on a critical velocity beyond the points of a measured friction law.
    #[must_use]
    pub(crate) fn vc_beyond_curve(&self, vc: f64, units: &Units) -> Option<String> {
        remark(self.law()?, "v_c", &[vc], units)
    }
}

impl SweepSpec {
    /// A remark on values of v0, fixed or of an axis, beyond the points of a measured friction law.
    #[must_use]
    pub(crate) fn beyond_curve(&self) -> Option<String> {
        let axis = self.axes.iter().find(|a| a.parameter == Parameter::V0);
        let fixed = [self.fixed.get(Parameter::V0)];
        let speeds = axis.map_or(&fixed[..], |axis| &axis.values);
        remark(self.fixed.law()?, Parameter::V0.name(), speeds, &self.units)
    }
}

/// The remark on those of the speeds that lie beyond the points; none if none of them does.
fn remark(law: &LawKind, of: &str, speeds: &[f64], units: &Units) -> Option<String> {
    let LawKind::Table(table) = law else {
        return None;
    };
    let (first, last) = (table.speeds().first()?, table.speeds().last()?);
    let unit = match &*units.of_parameter(Parameter::V0) {
        "1" => String::new(),
        unit => format!(" {unit}"),
    };
    let (below, above) = (|v: &f64| v < first, |v: &f64| v > last);
    let parts = [part(speeds, below), part(speeds, above)];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| {
        format!(
            "{of} {}{unit} lies beyond the curve ({} to {}{unit}), where it is taken as constant: \
             the slope 0 is an assumption",
            parts.join(" and "),
            Shown(*first),
            Shown(*last),
        )
    })
}

/// "= 2" or "from 0.6 to 2": those of the speeds that lie `beyond`, none if none does.
fn part(speeds: &[f64], beyond: impl Fn(&f64) -> bool) -> Option<String> {
    let beyond = || speeds.iter().copied().filter(&beyond);
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
        spec.beyond_curve()
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

    #[test]
    fn other_laws_have_no_end() {
        let text = "[axes]\nv0 = [99]\ntau = [1]\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n";
        assert_eq!(text.parse::<SweepSpec>().unwrap().beyond_curve(), None);
    }
}
