//! Margins of a setting, in its own units.

use crate::linear::margins::{
    self, Limits, LoopMargins, MOST_VELOCITIES, Margins, Radius, Reach, SlidingLaw,
};
use crate::model::{Control, FrictionLaw, ModelError, Oscillator};
use crate::sweep::input::parameter::Parameter;
use crate::sweep::input::setting::Setting;

/// A setting and the decay required of it.
#[derive(Debug, Clone)]
pub struct Around {
    of: margins::Setting,
    oscillator: Oscillator,
    control: Control,
    /// The friction law and v0, where there is a law.
    law: Option<(FrictionLaw, f64)>,
}

impl Around {
    /// All roots must decay at least at the rate `decay` ≥ 0, in 1/time.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn of(setting: &Setting, decay: f64) -> Result<Self, ModelError> {
        let (groups, time_unit) = setting.groups()?;
        Ok(Self {
            of: margins::Setting {
                groups,
                tau: setting.get(Parameter::Tau) / time_unit,
                decay: decay * time_unit,
            },
            oscillator: setting.oscillator()?,
            control: setting.control(),
            law: setting
                .friction_law()?
                .map(|law| (law, setting.get(Parameter::V0))),
        })
    }

    /// Whether the setting is stable, or decays as required, beyond doubt.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.of.stable()
    }

    /// The factors of both gains at which stability, or the required decay, is lost.
    pub fn gain(&self, search: &mut Margins) -> Limits {
        search.gain(&self.of)
    }

    /// The phase margin in radians, the latency margin in units of time.
    pub fn of_loop(&self, search: &mut Margins) -> LoopMargins {
        let found = search.of_loop(&self.of);
        LoopMargins {
            latency: found.latency * self.oscillator.time_unit(),
            ..found
        }
    }

    /// The delays at which stability is lost.
    #[must_use]
    pub fn delay(&self) -> Limits {
        scaled(margins::delay(&self.of), self.oscillator.time_unit())
    }

    /// The limits of the sliding velocity with a friction law, else those of the slope μ′.
    pub fn third(&self, search: &mut Margins) -> (Parameter, Limits) {
        if let Some((law, v0)) = self.sliding() {
            return (Parameter::V0, margins::velocity(&self.of, &law, v0));
        }
        // √(κM)/N0.
        let damping = self.oscillator.mass() / self.oscillator.time_unit();
        let slope = damping / self.oscillator.normal_load();
        (Parameter::MuPrime, scaled(search.slope(&self.of), slope))
    }

    /// The ends of the searches for upper limits; a limit beyond is given as infinite.
    #[must_use]
    pub fn reach(&self) -> Reach {
        let (reach, unit) = (self.of.reach(), self.oscillator.time_unit());
        Reach {
            gain: reach.gain,
            delay: reach.delay * unit,
            latency: reach.latency * unit,
        }
    }

    /// The largest v0 of the search for limits; none without a friction law.
    #[must_use]
    pub fn highest_v0(&self) -> Option<f64> {
        self.law.as_ref().map(|(_, v0)| v0 * MOST_VELOCITIES)
    }

    /// The stability radius.
    #[must_use]
    pub fn radius(&self) -> Radius {
        match self.sliding() {
            Some((law, v0)) => margins::radius_with_law(&self.of, &law, v0),
            None => margins::radius(&self.of),
        }
    }

    fn sliding(&self) -> Option<(SlidingLaw<'_>, f64)> {
        let (law, v0) = self.law.as_ref()?;
        let sliding = SlidingLaw {
            law,
            oscillator: &self.oscillator,
            control: self.control,
        };
        Some((sliding, *v0))
    }
}

fn scaled(limits: Limits, by: f64) -> Limits {
    Limits {
        lower: limits.lower * by,
        upper: limits.upper * by,
    }
}
