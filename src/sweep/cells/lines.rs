//! The linear models of lines of cells, one line after the other.

use crate::linear::line::Linear;
use crate::model::{Groups, ModelError, Oscillator, SlidingPoint};
use crate::setting::no_answer::NoAnswer;
use crate::setting::parameter::Parameter;
use crate::setting::quantity::Quantity;
use crate::setting::system::Evaluation;
use crate::setting::values::Setting;
use crate::sweep::plan::Plan;

/// The groups of one line after the other. What does not change between lines is not computed
/// again.
pub(super) struct Lines<'p> {
    plan: &'p Plan,
    pub(super) setting: Setting,
    /// Index of the setting along each axis.
    index: Vec<usize>,
    /// Whether every line is of the letter's own model.
    of_letter: bool,
    /// Scratch space for the expressions of a system from a file.
    evaluation: Evaluation,
    /// The part of the model that the gains do not change.
    uncontrolled: Option<Result<(Oscillator, SlidingPoint), ModelError>>,
}

impl<'p> Lines<'p> {
    pub(super) fn new(plan: &'p Plan) -> Self {
        let index = vec![0; plan.spec.axes.len()];
        Self {
            plan,
            setting: plan.setting(&index),
            index,
            of_letter: plan.spec.is_of_letter(),
            evaluation: Evaluation::default(),
            uncontrolled: None,
        }
    }

    /// Goes to the line at `offset` + `inside`.
    #[inline(always)]
    pub(super) fn move_to(&mut self, offset: &[usize], inside: &[usize]) {
        for (axis, known) in self.index.iter_mut().enumerate() {
            let index = offset[axis] + inside[axis];
            if *known != index {
                *known = index;
                let axis = &self.plan.spec.axes[axis];
                self.setting.vary(&axis.parameter, axis.values[index]);
                if !matches!(
                    axis.parameter,
                    Quantity::Known(Parameter::AlphaV | Parameter::AlphaN | Parameter::Tau)
                ) {
                    self.uncontrolled = None;
                }
            }
        }
    }

    /// The linear model of the line, and its unit of time.
    #[inline(always)]
    pub(super) fn model(&mut self) -> Result<(Linear, f64), NoAnswer> {
        if !self.of_letter {
            let model = self.setting.linear_in(&mut self.evaluation)?;
            // The rates of its parameters are needed nevertheless.
            if self.setting.system().is_none() {
                self.groups()?;
            }
            return Ok((model.0.settled(), model.1));
        }
        let (groups, time_unit) = self.groups()?;
        Ok((Linear::Letter(groups), time_unit))
    }

    /// The groups of the line, and its unit of time.
    #[inline(always)]
    pub(super) fn groups(&mut self) -> Result<(Groups, f64), ModelError> {
        let setting = &self.setting;
        let uncontrolled = self
            .uncontrolled
            .get_or_insert_with(|| Ok((setting.oscillator()?, setting.sliding_point()?)));
        let (oscillator, sliding) = uncontrolled.as_ref().map_err(Clone::clone)?;
        let groups = oscillator.groups(*sliding, setting.control());
        Ok((groups, oscillator.time_unit()))
    }

    /// The derivative of each group with respect to its parameter on the current line: b per μ_K′,
    /// a_v per α_v, a_n per α_N; what a dashpot takes off a_n is left aside.
    pub(super) fn groups_per_parameter(&self) -> Groups {
        match &self.uncontrolled {
            Some(Ok((oscillator, sliding))) => oscillator.groups_per_parameter(*sliding),
            _ => Groups::new(f64::NAN, f64::NAN, f64::NAN),
        }
    }

    /// d, the dashpot beside the spring of the current line, dimensionless.
    pub(super) fn damping(&self) -> f64 {
        match &self.uncontrolled {
            Some(Ok((oscillator, _))) => oscillator.dashpot_ratios().damping,
            _ => 0.0,
        }
    }
}
