//! The critical velocity at a point of parameter space.
//!
//! What does not exist or is not known is NaN here, and null in JSON.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::answers::vc;
use crate::critical::limit::LimitCell;
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::setting::Setting;
use crate::setting::field::{Field, OUTCOMES, number_of_outcome};
use crate::setting::search::{LIMIT, Protocol};
use crate::setting::source::Source;
use crate::setting::units::Units;

/// How stick-slip ends, in units of the setting.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct CriticalVelocity {
    /// v_c; null where `outcome` says why there is none: stick-slip persists up to the largest v0
    /// that is tried, or the block lifts off.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub vc: f64,
    /// A lower bound of v_c, by a margin below the ends found by all searches; v_c itself where it
    /// is decided. Null where lift-off comes before any stick-slip.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub vc_lower: f64,
    /// The smallest v0 at which it was lost for good or ended by lift-off; v_c where that is
    /// decided. Null where neither was seen up to the end of the range, or where slow
    /// searches disagree whether it lifts off.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub vc_upper: f64,
    /// The protocol: `follow` or `switch-on`.
    pub protocol: &'static str,
    /// How stick-slip ends there.
    pub outcome: &'static str,
    /// Where it survives: v0 from and to.
    pub windows: Vec<[f64; 2]>,
    /// The smallest v0 at which N ≤ 0 occurs; null where that does not end stick-slip.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub v_liftoff: f64,
    /// Time stuck in a period at v_c; null where no orbit of stick-slip is known there.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub stick_time: f64,
    /// Time in slip in a period at v_c; null where no orbit of stick-slip is known there.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub slip_time: f64,
    /// The smallest load at v_c; null where no orbit of stick-slip is known there.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub n_min: f64,
    /// What gave the answer.
    pub method: &'static str,
    /// Whether it is known what becomes of the motion beyond v_c.
    pub decided: bool,
}

impl CriticalVelocity {
    /// The critical velocity of a setting; its v0 is ignored. Once `stop` is set, the answer comes
    /// soon but is meaningless.
    ///
    /// # Errors
    /// When the setting has no friction law, or a value is outside the model's range.
    pub fn of(setting: &Setting, protocol: Protocol, stop: &Stop) -> Result<Self, ModelError> {
        let found = vc::VcProblem::of(setting)?
            .until(stop.clone())
            .find(protocol);
        let critical = found.critical;
        Ok(Self {
            vc: critical.vc,
            vc_lower: critical.vc_lower,
            vc_upper: critical.vc_upper,
            protocol: protocol.name(),
            outcome: OUTCOMES[usize::from(number_of_outcome(&critical))],
            windows: found.windows,
            v_liftoff: critical.v_liftoff,
            stick_time: critical.stick_time,
            slip_time: critical.slip_time,
            n_min: critical.n_min,
            method: critical.method.name(),
            decided: critical.decided,
        })
    }

    /// A remark on a critical velocity of `setting`, or the bounds of one that is not decided, or a
    /// velocity of lift-off, beyond the points of its measured friction law.
    #[must_use]
    pub fn beyond_curve(&self, setting: &Setting, units: &Units) -> Option<String> {
        let (of, found) = match self.decided {
            true if self.vc.is_finite() => ("v_c", vec![self.vc]),
            true => ("v_liftoff", vec![self.v_liftoff]),
            false => ("a bound of v_c", vec![self.vc_lower, self.vc_upper]),
        };
        // 0 is no velocity at which it slides: stick-slip is never sustained.
        let found = found.into_iter().filter(|v| v.is_finite() && *v > 0.0);
        setting.found_beyond_curve(of, &found.collect::<Vec<_>>(), units)
    }
}

/// The limit of a short delay: its parameters, and the fields of its maps by their names.
#[derive(Debug, Clone, Serialize)]
pub struct ShortDelay {
    /// `limit`.
    pub protocol: &'static str,
    /// γ.
    pub gamma: f64,
    /// ζ + ζ_g of dashpots.
    pub damping_ratio: f64,
    /// μ_K/μ_S.
    pub mu_ratio: f64,
    /// The values of the fields.
    #[serde(flatten)]
    pub fields: BTreeMap<&'static str, f64>,
}

impl ShortDelay {
    /// At γ ≥ 0, a damping ratio ≥ 0, not both 0, and μ_K/μ_S in (0, 1].
    ///
    /// # Errors
    /// When one of them is outside its range.
    pub fn at(gamma: f64, damping_ratio: f64, mu_ratio: f64) -> Result<Self, ModelError> {
        let found = LimitCell::at(gamma, damping_ratio, mu_ratio)?;
        let fields = Field::ALL
            .into_iter()
            .filter_map(|field| match field.source() {
                Source::Limit(value) => Some((field.name(), value(&found))),
                _ => None,
            });
        Ok(Self {
            protocol: LIMIT,
            gamma,
            damping_ratio,
            mu_ratio,
            fields: fields.collect(),
        })
    }
}

/// The schema is written by hand, since the fields come from a table.
#[cfg(feature = "serve")]
mod schema {
    use utoipa::openapi::schema::{Object, ObjectBuilder, SchemaType, Type};
    use utoipa::openapi::{RefOr, Schema};
    use utoipa::{PartialSchema, ToSchema};

    use super::ShortDelay;
    use crate::setting::field::Field;

    impl ToSchema for ShortDelay {}

    impl PartialSchema for ShortDelay {
        fn schema() -> RefOr<Schema> {
            let object = |kind: SchemaType, about: &str| -> Object {
                let builder = ObjectBuilder::new().schema_type(kind);
                builder.description(Some(about)).build()
            };
            let number = || SchemaType::Type(Type::Number);
            let or_null = || SchemaType::from_iter([Type::Number, Type::Null]);
            let protocol = object(SchemaType::Type(Type::String), "`limit`");
            let mut whole = ObjectBuilder::new()
                .property("protocol", protocol)
                .property("gamma", object(number(), "γ"))
                .property("damping_ratio", object(number(), "ζ + ζ_g of dashpots"))
                .property("mu_ratio", object(number(), "μ_K/μ_S"));
            for name in ["protocol", "gamma", "damping_ratio", "mu_ratio"] {
                whole = whole.required(name);
            }
            for field in Field::ALL.into_iter().filter(|field| field.of_limit()) {
                let about = format!("{}; null where it has no finite value", field.long_name());
                let value = object(or_null(), &about);
                whole = whole.property(field.name(), value).required(field.name());
            }
            whole.into()
        }
    }
}
