//! An experiment that measures friction through control, at all of its v0.

use std::convert::Infallible;

use serde::Serialize;

use crate::answers::measure::{Experiment, Foreseen, Mean, MeasuredPoint, Unsettled};
use crate::setting::experiment::ExperimentSpec;
use crate::setting::{Parameter, Setting};
use crate::sweep::engine::{RunError, each_attended};
use crate::sweep::events::Attended;

/// An experiment with what is known before it begins.
#[derive(Debug)]
pub struct Foretold {
    experiment: Experiment,
    foreseen: Vec<Foreseen>,
}

impl Foretold {
    /// Chooses the setting of every v0, on `threads` threads, and looks what it promises.
    ///
    /// # Errors
    /// When a parameter is outside the model's range, it is stopped, or threads cannot be started.
    pub fn of(
        spec: ExperimentSpec,
        threads: usize,
        attended: Attended,
    ) -> Result<Self, RunError<Infallible>> {
        let experiment = Experiment::new(spec);
        let v0 = &experiment.spec.v0;
        let found = each_attended(
            v0,
            threads,
            attended,
            |_| 1,
            |v0, stop| {
                let found = experiment.foreseen(*v0, stop);
                (!stop.is_set()).then_some(found)
            },
        );
        let foreseen: Result<_, _> = found?.into_iter().collect();
        let foreseen = foreseen.map_err(|why| RunError::Model(why.into()))?;
        Ok(Self {
            experiment,
            foreseen,
        })
    }

    /// What is asked.
    #[must_use]
    pub fn spec(&self) -> &ExperimentSpec {
        &self.experiment.spec
    }

    /// What is known of every v0.
    #[must_use]
    pub fn foreseen(&self) -> &[Foreseen] {
        &self.foreseen
    }

    /// Measures every v0, on `threads` threads. The result does not depend on their number.
    ///
    /// # Errors
    /// As [`Foretold::of`].
    pub fn measured(
        &self,
        threads: usize,
        attended: Attended,
    ) -> Result<Measurement, RunError<Infallible>> {
        let places: Vec<usize> = (0..self.foreseen.len()).collect();
        let found = each_attended(
            &places,
            threads,
            attended,
            |_| 1,
            |place, stop| {
                let found = self.experiment.measured(&self.foreseen, *place, stop);
                (!stop.is_set()).then_some(found)
            },
        );
        let found: Result<Vec<_>, _> = found?.into_iter().collect();
        let found = found.map_err(RunError::Model)?;
        let points = self.foreseen.iter().zip(&found);
        let points: Vec<_> = points
            .map(|(of, found)| MeasuredV0::of(of, found))
            .collect();
        let spec = self.spec();
        Ok(Measurement {
            setting: spec.chosen.name(),
            start: spec.begin.name(),
            repeats: spec.repeats,
            settled: points.iter().filter(|point| point.settled).count(),
            points,
        })
    }
}

/// Friction measured through control, in units of the experiment.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Measurement {
    /// Where gain and delay come from: `best` or `given`.
    pub setting: &'static str,
    /// How each v0 begins: `sliding`, `step` or `stick-slip`.
    pub start: &'static str,
    /// How often each v0 is measured.
    pub repeats: u32,
    /// How many v0 settled.
    pub settled: usize,
    /// Every v0, in the order of the experiment.
    pub points: Vec<MeasuredV0>,
}

/// What was foreseen and found at one v0.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct MeasuredV0 {
    /// The pulling velocity.
    pub v0: f64,
    /// What was averaged, as mu_k; null where nothing was: there is no setting, or the mean was cut
    /// short, as where N reached 0.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub mu_k: f64,
    /// The standard error that is predicted of it: the random one of `predicted.error`, and
    /// `predicted.rounding`, which is the same in all repeats; 0 where readings are exact, null
    /// where sliding is not stable.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub mu_k_error: f64,
    /// Whether the block slid at v0 while it was averaged, in every repeat.
    pub settled: bool,
    /// Why not: `no-setting`, `stops`, `off`, `at-limit`, `lift-off`, `steps`, `lost` or `drift`;
    /// null where it settled.
    #[cfg_attr(feature = "serve", schema(required))]
    pub unsettled: Option<&'static str>,
    /// How many repeats settled.
    pub settled_repeats: u32,
    /// mu_k of the law that was put in.
    pub law: f64,
    /// mu_k less that of the law; null where mu_k is.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub off: f64,
    /// The standard deviation between repeats; null with fewer than two.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub scatter: f64,
    /// What linear theory predicts; null where sliding is not stable.
    #[cfg_attr(feature = "serve", schema(required))]
    pub predicted: Option<PredictedErrors>,
    /// The mean without control, as mu_k; null where nothing was averaged.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub uncontrolled: f64,
    /// Whether the block slid at v0 without control.
    pub uncontrolled_settled: bool,
    /// What was foreseen: `safe`, `below-vc`, `lift-off`, `unknown`, `unstable` or `no-setting`.
    pub prospect: &'static str,
    /// α_v; null without a setting.
    #[cfg_attr(feature = "serve", schema(required))]
    pub alpha_v: Option<f64>,
    /// α_N; null without a setting.
    #[cfg_attr(feature = "serve", schema(required))]
    pub alpha_n: Option<f64>,
    /// The delay; null without a setting.
    #[cfg_attr(feature = "serve", schema(required))]
    pub tau: Option<f64>,
    /// The part by which gain, delay and μ′ may be off; null where the setting is given, or that of
    /// fastest decay.
    #[cfg_attr(feature = "serve", schema(required))]
    pub spread: Option<f64>,
    /// The abscissa of sliding; null where it is not stable.
    #[cfg_attr(feature = "serve", schema(required))]
    pub abscissa: Option<f64>,
    /// v_c of the setting; null where it is not known.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub vc: f64,
    /// How long v0 was held before the mean began.
    pub wait: f64,
    /// How long the elongation was averaged.
    pub average: f64,
}

/// What linear theory predicts of one mean, as of mu_k.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct PredictedErrors {
    /// The standard error of one repeat from noise, and from rounding where noise makes it random;
    /// 0 without noise, null where the loop remembers too many readings.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub error: f64,
    /// The standard error from rounding that noise does not make random, the same in all repeats:
    /// a bias, of which this is the root mean square over all elongations.
    pub rounding: f64,
    /// The most that this bias can be where there is no noise, half a step; null with noise, or
    /// without rounding.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub rounding_bound: f64,
    /// The bias from noise and rounding, of second order; null where `error` is.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub bias_of_noise: f64,
    /// The bias from the drift of v0.
    pub bias_of_drift: f64,
}

impl MeasuredV0 {
    fn of(foreseen: &Foreseen, found: &MeasuredPoint) -> Self {
        let Mean { mu_k, unsettled } = found.mean;
        let predicted = foreseen.predicted;
        let of = |parameter: Parameter| {
            let setting: Option<&Setting> = foreseen.setting.as_ref();
            setting.map(|setting| setting.get(parameter))
        };
        Self {
            v0: foreseen.v0,
            mu_k,
            mu_k_error: found.error,
            settled: unsettled.is_none(),
            unsettled: unsettled.map(Unsettled::name),
            settled_repeats: found.settled,
            law: found.law,
            off: mu_k - found.law,
            scatter: found.scatter,
            predicted: foreseen.is_stable().then_some(PredictedErrors {
                error: predicted.error,
                rounding: predicted.rounding,
                rounding_bound: predicted.rounding_bound,
                bias_of_noise: predicted.bias_of_noise,
                bias_of_drift: predicted.bias_of_drift,
            }),
            uncontrolled: found.uncontrolled.mu_k,
            uncontrolled_settled: found.uncontrolled.unsettled.is_none(),
            prospect: foreseen.prospect.name(),
            alpha_v: of(Parameter::AlphaV),
            alpha_n: of(Parameter::AlphaN),
            tau: of(Parameter::Tau),
            spread: foreseen.spread,
            abscissa: foreseen.abscissa,
            vc: foreseen.vc,
            wait: foreseen.wait,
            average: foreseen.average,
        }
    }

    /// The bias that is predicted; NaN where none is.
    #[must_use]
    pub fn bias(&self) -> f64 {
        let predicted = self.predicted.as_ref();
        predicted.map_or(f64::NAN, |of| of.bias_of_noise + of.bias_of_drift)
    }
}
