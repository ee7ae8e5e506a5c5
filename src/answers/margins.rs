//! Margins of a setting, in its own units.

use crate::linear::general::{DelayLine, System};
use crate::linear::line::Linear;
use crate::linear::margins::{
    self, AsCase, Beyond, Case, Limits, LoopMargins, MOST_VELOCITIES, MarginSearch, Modulus,
    Radius, Reach, SlidingLaw, SystemLoop,
};
use crate::linear::sampled::{SampledLoop, multiple};
use crate::model::stop::Stop;
use crate::model::{Control, Feedback, FrictionLaw, ModelError, Oscillator};
use crate::setting::parameter::Parameter;
use crate::setting::values::Setting;

/// A setting of the letter's own feedback, of one with more, or of a digital loop.
#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "made once a cell")]
enum AnyCase {
    Letter(Case<margins::Setting>),
    Beyond(Case),
    /// The loop, and its delay in samples.
    Sampled(SampledLoop, u64),
}

/// An answer about the case of an [`AnyCase`], whichever it is, or about its digital loop.
macro_rules! on_case {
    ($any:expr, $case:ident => $answer:expr, $sampled:pat => $of_sampled:expr) => {
        match $any {
            AnyCase::Letter($case) => $answer,
            AnyCase::Beyond($case) => $answer,
            $sampled => $of_sampled,
        }
    };
}

/// A setting and the decay required of it.
///
/// ```
/// use slipmap::answers::margins::SettingMargins;
/// use slipmap::setting::Setting;
///
/// let numbers = [("mu_prime", -0.3), ("alpha_v", -0.33), ("tau", 4.15)];
/// let setting = Setting::checked(numbers, None, &[])?;
/// let around = SettingMargins::of(&setting, 0.0)?.expect("it is the block");
/// assert!(around.stable());
/// // The delays between which it stays stable.
/// let delays = around.delay();
/// assert!(delays.lower < 4.15 && 4.15 < delays.upper);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct SettingMargins {
    case: AnyCase,
    /// The system and the delay, physical, where the delay alone decides on stability beyond the
    /// letter.
    line: Option<(System, f64)>,
    oscillator: Oscillator,
    control: Control,
    /// The friction law and v0, where there is a law.
    law: Option<(FrictionLaw, f64)>,
}

impl SettingMargins {
    /// All roots must decay at least at the rate `decay` ≥ 0, in 1/time. None of systems from
    /// files, and of friction with a state, of which the slope does not say all.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn of(setting: &Setting, decay: f64) -> Result<Option<Self>, ModelError> {
        if setting.check_of_letter(&[], "").is_err() {
            return Ok(None);
        }
        let oscillator = setting.oscillator()?;
        let control = setting.control();
        let groups = oscillator.groups(setting.sliding_point()?, control);
        let of = margins::Setting {
            groups,
            tau: setting.feedback().dimensionless(&oscillator).tau,
            decay: decay * oscillator.time_unit(),
        };
        let law = setting
            .friction_law()?
            .map(|law| (law, setting.get(Parameter::V0)));
        if let Linear::Sampled(of) = setting.linear().map_err(ModelError::from)?.0 {
            return Ok(Some(Self {
                case: AnyCase::Sampled(of, samples(setting, decay)?),
                line: None,
                oscillator,
                control,
                law,
            }));
        }
        let beyond = beyond_letter(setting, &oscillator);
        let on_axis = beyond.filter(|_| decay == 0.0);
        Ok(Some(Self {
            case: beyond.map_or_else(
                || AnyCase::Letter(of.case()),
                |beyond| AnyCase::Beyond(Case::beyond(of, beyond)),
            ),
            line: on_axis.map(|beyond| {
                (
                    beyond.of_groups(groups).system(),
                    setting.get(Parameter::Tau),
                )
            }),
            oscillator,
            control,
            law,
        }))
    }

    /// The same, but once `stop` is set margins are told soon, and mean nothing.
    #[must_use]
    pub fn heeding(mut self, stop: &Stop) -> Self {
        on_case!(&mut self.case, case => case.heed(stop), AnyCase::Sampled(..) => ());
        self
    }

    /// Whether the setting is stable, or decays as required, beyond doubt.
    #[must_use]
    pub fn stable(&self) -> bool {
        on_case!(
            &self.case,
            case => case.stable(),
            AnyCase::Sampled(of, multiple) => of.is_stable(*multiple)
        )
    }

    /// The factors of both gains at which stability, or the required decay, is lost.
    pub fn gain(&self, search: &mut MarginSearch) -> Limits {
        on_case!(
            &self.case,
            case => search.gain(case),
            AnyCase::Sampled(of, multiple) => of.gain_margin(*multiple)
        )
    }

    /// The phase margin in radians, the latency margin in units of time.
    pub fn of_loop(&self, search: &mut MarginSearch) -> LoopMargins {
        let found = on_case!(
            &self.case,
            case => search.of_loop(case),
            AnyCase::Sampled(of, multiple) => of.loop_margins(*multiple)
        );
        let unit = self.oscillator.time_unit();
        LoopMargins {
            latency: found.latency * unit,
            phase_omega: found.phase_omega / unit,
            ..found
        }
    }

    /// How near the loop comes to −1, on the line Re λ = −σ; not known of digital loops.
    #[must_use]
    pub fn modulus(&self) -> Modulus {
        let found = on_case!(
            &self.case,
            case => case.modulus(),
            AnyCase::Sampled(..) => Modulus::UNKNOWN
        );
        Modulus {
            omega: found.omega / self.oscillator.time_unit(),
            ..found
        }
    }

    /// Whether feedback has more than the letter's own.
    #[must_use]
    pub fn is_beyond(&self) -> bool {
        !matches!(self.case, AnyCase::Letter(_))
    }

    /// The latency margin alone, in units of time.
    pub fn latency(&self, search: &mut MarginSearch) -> f64 {
        let latency = on_case!(
            &self.case,
            case => search.latency(case),
            AnyCase::Sampled(of, multiple) => of.loop_margins(*multiple).latency
        );
        latency * self.oscillator.time_unit()
    }

    /// The phase margin alone.
    pub fn phase(&self, search: &mut MarginSearch) -> f64 {
        on_case!(
            &self.case,
            case => search.phase(case),
            AnyCase::Sampled(of, multiple) => of.phase_margin(*multiple)
        )
    }

    /// The delays at which stability is lost.
    #[must_use]
    pub fn delay(&self) -> Limits {
        let unit = self.oscillator.time_unit();
        let Some((system, tau)) = &self.line else {
            let limits = on_case!(
                &self.case,
                case => margins::delay(case),
                AnyCase::Sampled(of, multiple) => of.stable_delays_around(*multiple)
            );
            return scaled(limits, unit);
        };
        let line = DelayLine::of(system).in_physical_time(unit);
        line.stable_interval_at(*tau)
            .map_or(Limits::UNDECIDED, |found| Limits {
                lower: found.from,
                upper: found.to,
            })
    }

    /// The limits of the sliding velocity with a friction law, else those of the slope μ′.
    pub fn third(&self, search: &mut MarginSearch) -> (Parameter, Limits) {
        if let Some((law, v0)) = self.sliding() {
            let limits = on_case!(
                &self.case,
                case => margins::velocity(case, &law, v0),
                AnyCase::Sampled(..) => Limits::UNDECIDED
            );
            return (Parameter::V0, limits);
        }
        // √(κM)/N0.
        let damping = self.oscillator.mass() / self.oscillator.time_unit();
        let slope = damping / self.oscillator.normal_load();
        let Limits { lower, upper } = on_case!(
            &self.case,
            case => search.slope(case),
            AnyCase::Sampled(..) => Limits::UNDECIDED
        );
        let still = self.oscillator.dashpot_ratios().sum();
        let limits = Limits {
            lower: lower - still,
            upper: upper - still,
        };
        (Parameter::MuPrime, scaled(limits, slope))
    }

    /// The ends of the searches for upper limits; a limit beyond is given as infinite.
    #[must_use]
    pub fn reach(&self) -> Reach {
        let unit = self.oscillator.time_unit();
        let reach = on_case!(
            &self.case,
            case => case.reach(),
            AnyCase::Sampled(of, multiple) => of.reach(*multiple)
        );
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
        if let Some((law, v0)) = self.sliding() {
            return on_case!(
                &self.case,
                case => margins::radius_with_law(case, &law, v0),
                AnyCase::Sampled(..) => Radius::UNKNOWN
            );
        }
        let still = self.oscillator.dashpot_ratios().sum();
        on_case!(
            &self.case,
            case => margins::radius_within(case, [1.0; 3], still),
            AnyCase::Sampled(..) => Radius::UNKNOWN
        )
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

/// ω of the root on the line Re λ = −σ, σ = `decay`, of a setting that is on the boundary of
/// stability or of the decay rate; NaN where there is none within rounding.
#[must_use]
pub fn crossing_of(setting: &Setting, decay: f64) -> f64 {
    let crossing = || {
        let (linear, unit) = setting.linear().ok()?;
        let tau = setting.get(Parameter::Tau) / unit;
        let of = SystemLoop::on_line(&linear.system()?, tau, -decay * unit)?;
        Some(of.crossing()? / unit)
    };
    crossing().unwrap_or(f64::NAN)
}

/// The delay of a digital loop in samples.
fn samples(setting: &Setting, decay: f64) -> Result<u64, ModelError> {
    if decay > 0.0 {
        setting.check_continuous("0 where a decay rate is required")?;
    }
    let [sample_time, tau] = [Parameter::SampleTime, Parameter::Tau].map(|p| setting.get(p));
    multiple(tau, sample_time).ok_or(ModelError {
        parameter: Parameter::Tau.name(),
        value: tau,
        allowed: "a whole multiple of sample_time",
        at_speed: None,
    })
}

/// What the feedback of a block has beyond the letter's own, dimensionless; none where that is
/// nothing.
pub(super) fn beyond_letter(setting: &Setting, oscillator: &Oscillator) -> Option<Beyond> {
    let Feedback { channel, lags, .. } = setting.feedback().dimensionless(oscillator);
    (!setting.is_of_letter()).then_some(Beyond {
        channel,
        lags,
        damping: oscillator.dashpot_ratios().damping,
    })
}

fn scaled(limits: Limits, by: f64) -> Limits {
    Limits {
        lower: limits.lower * by,
        upper: limits.upper * by,
    }
}
