//! How low v0 may become, where a motion begins in stable sliding and v0 falls slowly: the route by
//! which control by the return map works, says the letter.

use serde::Serialize;

use super::comparison::{At, Method, Question};
use crate::answers::reached::{Fate, fate};
use crate::model::stop::Stop;
use crate::slip::case::{Case, CaseError};

/// Where a method loses sliding.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Held {
    /// `none`, `delayed-feedback` or `return-map`.
    pub method: &'static str,
    /// The time from reading to reading; null where nothing is read.
    #[cfg_attr(feature = "serve", schema(required))]
    pub sample_time: Option<f64>,
    /// The largest change of the load; null without control.
    #[cfg_attr(feature = "serve", schema(required))]
    pub amplitude: Option<f64>,
    /// The v0 at which the block first stops; null where it slides to the end, or that is not
    /// known.
    #[cfg_attr(feature = "serve", schema(required))]
    pub lost_at: Option<f64>,
    /// Whether it slides to the end; null where the steps ran out before.
    #[cfg_attr(feature = "serve", schema(required))]
    pub held: Option<bool>,
}

/// How low v0 may become under each method.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Route {
    /// v0 at first, and in the end.
    pub v0: [f64; 2],
    /// When it is there.
    pub until: f64,
    /// Where the return map comes from: `exact`, at the v0 of each reading, or `reconstructed`, at
    /// the first one.
    pub model: &'static str,
    /// By which share the model's slope of friction is wrong.
    pub slope: f64,
    /// The noise of readings.
    pub noise: f64,
    /// The methods, none first.
    pub methods: Vec<Held>,
}

impl Question {
    /// Follows the programme of the case under each method; none once `stop` is set.
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn route(&self, stop: &Stop) -> Result<Option<Route>, CaseError> {
        let last = self.case.programme.last();
        let (until, end) = last.map_or((0.0, self.case.v0), |corner| {
            // After a jump the last v0 has to last.
            let until = match corner.ramp {
                true => corner.at,
                false => corner.at.max(self.case.horizon),
            };
            (until, corner.v0)
        });
        let mut methods = Vec::new();
        for method in std::iter::once(None).chain(self.methods().map(Some)) {
            let places = match method {
                None => &self.at[..1],
                Some(_) => &self.at,
            };
            for at in places {
                if stop.is_set() {
                    return Ok(None);
                }
                methods.push(self.held(method, *at, until, stop)?);
            }
        }
        Ok((!stop.is_set()).then(|| Route {
            v0: [self.case.v0, end],
            until,
            model: self.model_name(),
            slope: self.at.first().map_or(0.0, |at| at.slope),
            noise: self.at.first().map_or(0.0, |at| at.noise),
            methods,
        }))
    }

    fn held(
        &self,
        method: Option<Method>,
        at: At,
        until: f64,
        stop: &Stop,
    ) -> Result<Held, CaseError> {
        let case = match method {
            None => Case {
                switch_on: f64::INFINITY,
                ..self.case.clone()
            },
            Some(method) => Case {
                programme: self.case.programme.clone(),
                horizon: self.case.horizon,
                ..self.case(method, at)
            },
        };
        let units = case.units();
        let mut motion = case.motion()?.heeding(stop.clone());
        let found = fate(&mut motion, until / units.time);
        let (lost, held) = match found {
            Fate::Held => (None, Some(true)),
            Fate::Lost(v0) => (Some(v0), Some(false)),
            Fate::Unknown => (None, None),
        };
        let (name, sample_time) = method.map_or(("none", None), |of| self.named(of));
        Ok(Held {
            method: name,
            sample_time,
            amplitude: method.map(|_| at.amplitude),
            lost_at: lost.map(|v0| v0 * units.velocity),
            held,
        })
    }
}
