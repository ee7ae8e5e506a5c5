//! Margins of a setting in the units in which it is given.

use crate::linear::margins::{
    self, Limits, LoopMargins, MOST_VELOCITIES, Margins, Radius, Reach, SlidingLaw,
};
use crate::model::{Control, FrictionLaw, ModelError, Oscillator};
use crate::sweep::input::parameter::Parameter;
use crate::sweep::input::setting::Setting;

/// A setting whose margins are asked for.
#[derive(Debug, Clone)]
pub struct Around {
    of: margins::Setting,
    oscillator: Oscillator,
    control: Control,
    /// The friction law and v0, where there is a law.
    law: Option<(FrictionLaw, f64)>,
}

impl Around {
    /// All roots have to decay at least at the rate `decay` ≥ 0, in 1/time.
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

    /// The factors of both gains at which that is lost.
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

    /// The slopes μ′ at which it is lost, or, with a friction law, the sliding velocities.
    pub fn third(&self, search: &mut Margins) -> (Parameter, Limits) {
        if let Some((law, v0)) = self.sliding() {
            return (Parameter::V0, margins::velocity(&self.of, &law, v0));
        }
        // √(κM)/N0.
        let damping = self.oscillator.mass() / self.oscillator.time_unit();
        let slope = damping / self.oscillator.normal_load();
        (Parameter::MuPrime, scaled(search.slope(&self.of), slope))
    }

    /// Up to where upper limits are looked for that are told as infinite.
    #[must_use]
    pub fn reach(&self) -> Reach {
        let (reach, unit) = (self.of.reach(), self.oscillator.time_unit());
        Reach {
            gain: reach.gain,
            delay: reach.delay * unit,
            latency: reach.latency * unit,
        }
    }

    /// Up to which v0 limits are looked for; none where there is no friction law.
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
