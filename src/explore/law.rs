//! A friction law as a curve.

use serde::Serialize;

use crate::model::{FrictionLaw, ModelError};
use crate::setting::Parameter;
use crate::setting::law_kind::LawKind;
use crate::setting::point_file::PointSpec;
use crate::text::finite;

/// Number of speeds on a curve.
const SPEEDS: u32 = 201;
/// The largest speed of a curve, in units of the law's own speed.
const SCALES: f64 = 6.0;

/// A friction law over speeds from 0 on, in the units of its setting.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct LawCurve {
    /// Its name.
    pub law: &'static str,
    /// Its formula; none for a table.
    #[cfg_attr(feature = "serve", schema(required))]
    pub formula: Option<String>,
    /// 201 speeds, evenly spaced.
    pub v: Vec<f64>,
    /// μ_K there, at speed 0 its limit.
    pub mu_k: Vec<f64>,
    /// μ_K′ there.
    pub slope: Vec<f64>,
    /// μ_S.
    pub mu_s: f64,
    /// The points of a table: speed and μ_K.
    pub points: Vec<[f64; 2]>,
    /// What was done with the rows from which the points were read, and assumed of them.
    pub remarks: Vec<String>,
    /// The unit of speeds; "1" where none is given.
    pub unit_v: String,
    /// Where the block is pulled, if the setting says.
    #[cfg_attr(feature = "serve", schema(required))]
    pub at: Option<LawPoint>,
}

/// A friction law at the velocity of the pull.
#[derive(Debug, Clone, Copy, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct LawPoint {
    /// v0.
    pub v0: f64,
    /// μ_K(v0).
    pub mu_k: f64,
    /// μ_K′(v0).
    pub mu_prime: f64,
}

impl LawCurve {
    /// The curve of a setting with a friction law.
    ///
    /// # Errors
    /// When it has none, or the law is ill-posed.
    pub fn of(spec: &PointSpec) -> Result<Self, ModelError> {
        let setting = &spec.setting;
        let none = ModelError::of_law("a law of the velocity alone");
        let (kind, law) = (setting.law(), setting.friction_law()?);
        let (Some(kind), Some(law)) = (kind, law) else {
            return Err(none);
        };
        let v0 = finite(setting.get(Parameter::V0));
        let last = last_speed(&law, v0);
        let v: Vec<f64> = (0..SPEEDS)
            .map(|i| last * f64::from(i) / f64::from(SPEEDS - 1))
            .collect();
        Ok(Self {
            law: kind.name(),
            formula: match kind {
                LawKind::Named(law) => Some(law.formula().into()),
                LawKind::Formula(formula) => Some(formula.text().into()),
                LawKind::Table(_) => None,
            },
            mu_k: v.iter().map(|v| law.mu_k(*v)).collect(),
            slope: v.iter().map(|v| law.mu_prime(*v)).collect(),
            v,
            mu_s: law.mu_s(),
            points: match kind {
                LawKind::Named(_) | LawKind::Formula(_) => Vec::new(),
                LawKind::Table(table) => {
                    let mu_k = table.mu_k().iter();
                    table
                        .speeds()
                        .iter()
                        .zip(mu_k)
                        .map(|(v, mu)| [*v, *mu])
                        .collect()
                }
            },
            remarks: Vec::new(),
            unit_v: spec.units.of_parameter(Parameter::V0),
            at: v0.map(|v0| LawPoint {
                v0,
                mu_k: law.mu_k(v0),
                mu_prime: law.mu_prime(v0),
            }),
        })
    }
}

/// The largest speed of a curve: beyond the law's own scale, and beyond v0.
fn last_speed(law: &FrictionLaw, v0: Option<f64>) -> f64 {
    let scale = law.speed_scale(0.0);
    let own = match law.last_speed() {
        Some(last) => 1.1 * last,
        None if scale.is_finite() => SCALES * scale,
        None => 0.0,
    };
    match own.max(2.0 * v0.unwrap_or(0.0)) {
        0.0 => 1.0,
        last => last,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::point_file::PointOf;

    fn curve(text: &str) -> LawCurve {
        LawCurve::of(&PointSpec::read(text, PointOf::Law).unwrap()).unwrap()
    }

    #[test]
    fn a_curve_goes_beyond_what_matters() {
        let text = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
        let found = curve(text);
        assert_eq!((found.v.len(), found.v[0], found.v[200]), (201, 0.0, 3.0));
        assert_eq!(
            (found.mu_k[0], found.slope[0], found.mu_s),
            (0.5, -1.0, 1.0)
        );
        assert!(found.at.is_none() && found.unit_v == "1");
        let units = "[units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n";
        let found = curve(&format!("{text}{units}[fixed]\nv0 = 4.5\ntau = 1\n"));
        let at = found.at.unwrap();
        assert_eq!((found.v[200], &*found.unit_v), (9.0, "mm s-1"));
        assert_eq!((at.v0, at.mu_k), (4.5, 0.05));
        assert_eq!(at.mu_k, found.mu_k[100]);
        assert_eq!(at.mu_prime, found.slope[100]);
    }

    #[test]
    fn every_law_has_a_curve() {
        for (law, last) in [
            ("law = \"coulomb\"\nmu0 = 0.4", 1.0),
            ("law = \"stribeck\"\nmu0 = 0.4\nv_s = 2", 12.0),
            (
                "law = \"table\"\nspeeds = [0, 1, 2]\nmu_k = [0.9, 0.6, 0.5]",
                2.2,
            ),
        ] {
            let found = curve(&format!("[friction]\n{law}\n"));
            assert!((found.v[200] - last).abs() < 1e-12, "{law}");
            assert_eq!(found.points.len(), if found.law == "table" { 3 } else { 0 });
            assert_eq!(found.formula.is_none(), found.law == "table");
        }
    }
}
