//! Every parameter of a sweep: its one name in flags, sweep files and maps, its meaning, unit and
//! range.
//!
//! Longer than most files: it is a table, with a row for each parameter.

use super::catalogue::catalogue;
use crate::model::ModelError;

/// The largest magnitude of any parameter; its inverse is the smallest positive one. It is far
/// beyond any experiment, and small enough that no dimensionless group overflows.
pub(crate) const LARGEST: f64 = 1e12;

/// Allowed ranges of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Range {
    Any,
    NotNegative,
    Positive,
    Part,
    /// Between −1 and 1, both excluded.
    WithinOne,
    Negative,
}

/// What a parameter belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// The block, its spring and load, and their control.
    Model,
    /// Sliding: determined by the friction law, where there is one.
    Sliding,
    /// The pull, which has no meaning without a friction law.
    Pull,
    /// A friction law.
    Law,
    /// The start of a motion; by default the block slides at v0.
    Start,
    /// The limit of a short delay.
    Limit,
}

impl Group {
    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::Sliding => "sliding",
            Self::Pull => "pull",
            Self::Law => "law",
            Self::Start => "start",
            Self::Limit => "limit",
        }
    }
}

/// The flag for a parameter of a single point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Flag {
    /// The placeholder for the value in the help.
    pub value: &'static str,
    /// The text of the help.
    pub help: &'static str,
}

/// The boxes of the page in which sliders are folded away: most often they are at their defaults.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Folded {
    /// The feedback beyond the letter's.
    Feedback,
    /// The block, its spring and its load.
    Model,
    /// Limits of the actuators, which matter to motions alone and are off at first.
    Limits,
}

impl Folded {
    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Feedback => "feedback",
            Self::Model => "model",
            Self::Limits => "limits",
        }
    }
}

/// How the page in the browser offers a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Page {
    /// The value at first, of a limit once it is on; that by default if there is none.
    pub first: Option<f64>,
    /// The ends of its slider.
    pub slider: [f64; 2],
    /// The ends of its axis at first.
    pub axis: [f64; 2],
    /// The box of its slider; none where it is always in sight.
    pub folded: Option<Folded>,
}

impl Page {
    /// A slider and an axis between these ends, in sight, with the value by default at first.
    const fn new(slider: [f64; 2], axis: [f64; 2]) -> Self {
        Self {
            first: None,
            slider,
            axis,
            folded: None,
        }
    }

    /// Another value at first.
    const fn first(self, value: f64) -> Self {
        Self {
            first: Some(value),
            ..self
        }
    }

    /// Its slider folded away in a box.
    const fn folded(self, folded: Folded) -> Self {
        Self {
            folded: Some(folded),
            ..self
        }
    }
}

/// The facts about a parameter.
struct Row {
    /// The name, the same word everywhere; flags write `-` for `_`.
    name: &'static str,
    /// The symbol of the letter.
    symbol: &'static str,
    /// Its meaning, for `long_name` in maps and labels in pictures.
    long_name: &'static str,
    /// Powers of force, length and time in its unit.
    dimension: [i32; 3],
    range: Range,
    /// The default value; none for a required parameter, and for those of a start.
    default: Option<f64>,
    group: Group,
    flag: Option<Flag>,
    /// How the page offers it; none where it does not.
    page: Option<Page>,
}

/// The facts that most rows share.
const ROW: Row = Row {
    name: "",
    symbol: "",
    long_name: "",
    dimension: [0, 0, 0],
    range: Range::Positive,
    default: None,
    group: Group::Model,
    flag: None,
    page: None,
};

const SLOPE: [i32; 3] = [0, -1, 1];
const STIFFNESS: [i32; 3] = [1, -1, 0];
const TIME: [i32; 3] = [0, 0, 1];
const VELOCITY: [i32; 3] = [0, 1, -1];

/// A lag of first order.
const LAG: Row = Row {
    dimension: TIME,
    range: Range::NotNegative,
    default: Some(0.0),
    ..ROW
};

/// A dashpot.
const DASHPOT: Row = Row {
    dimension: [1, -1, 1],
    range: Range::NotNegative,
    default: Some(0.0),
    ..ROW
};

/// What a sensor does to a reading.
const READING: Row = Row {
    dimension: [0, 1, 0],
    range: Range::NotNegative,
    default: Some(0.0),
    ..ROW
};

/// The largest number below 1.
const BELOW_ONE: f64 = 1.0 - 0.5 * f64::EPSILON;

catalogue! {
    /// A parameter of the model, of the friction law or of the control.
    pub enum Parameter: Row {
        /// μ_K′(v0), the slope of the friction law at the sliding velocity.
        MuPrime = Row {
            name: "mu_prime",
            symbol: "μ′",
            long_name: "slope of the kinetic friction coefficient at the sliding velocity",
            dimension: SLOPE,
            range: Range::Any,
            group: Group::Sliding,
            flag: Some(Flag {
                value: "B",
                help: "μ_K′(v0), slope of the friction coefficient at the sliding velocity",
            }),
            page: Some(Page::new([-0.95, 0.5], [-0.95, 0.2]).first(-0.3)),
            ..ROW
        };
        /// α_v, the gain of velocity control.
        AlphaV = Row {
            name: "alpha_v",
            symbol: "α_v",
            long_name: "gain of velocity control",
            dimension: [0, 0, -1],
            range: Range::Any,
            default: Some(0.0),
            flag: Some(Flag {
                value: "A",
                help: "α_v, gain of velocity control [default: 0]",
            }),
            page: Some(Page::new([-3.0, 3.0], [-1.6, 0.4]).first(-0.33)),
            ..ROW
        };
        /// α_N, the gain of load control.
        AlphaN = Row {
            name: "alpha_n",
            symbol: "α_N",
            long_name: "gain of load control",
            dimension: STIFFNESS,
            range: Range::Any,
            default: Some(0.0),
            flag: Some(Flag {
                value: "A",
                help: "α_N, gain of load control [default: 0]",
            }),
            page: Some(Page::new([-10.0, 10.0], [-3.0, 1.0]).first(-2.0)),
            ..ROW
        };
        /// τ, the delay.
        Tau = Row {
            name: "tau",
            symbol: "τ",
            long_name: "delay of the feedback",
            dimension: TIME,
            range: Range::NotNegative,
            flag: Some(Flag {
                value: "T",
                help: "τ, delay of the feedback",
            }),
            page: Some(Page::new([0.0, 25.0], [0.0, 12.0]).first(4.15)),
            ..ROW
        };
        /// v0, the unperturbed pulling velocity.
        V0 = Row {
            name: "v0",
            symbol: "v0",
            long_name: "unperturbed pulling velocity",
            dimension: VELOCITY,
            group: Group::Pull,
            flag: Some(Flag {
                value: "V0",
                help: "v0, pulling velocity (with --friction)",
            }),
            page: Some(Page::new([0.01, 3.0], [0.02, 2.0]).first(0.35)),
            ..ROW
        };
        /// μ_K(v0), the kinetic friction coefficient at the sliding velocity.
        MuK = Row {
            name: "mu_k",
            symbol: "μ_K",
            long_name: "kinetic friction coefficient at the sliding velocity",
            default: Some(1.0),
            group: Group::Sliding,
            flag: Some(Flag {
                value: "M",
                help: "μ_K(v0), kinetic friction coefficient at the sliding velocity [default: 1]; \
                    with --friction formula an expression in the speed v",
            }),
            page: Some(Page::new([0.05, 2.0], [0.05, 2.0]).folded(Folded::Model)),
            ..ROW
        };
        /// M, the mass of the block.
        Mass = Row {
            name: "mass",
            symbol: "M",
            long_name: "mass of the block",
            dimension: [1, -1, 2],
            default: Some(1.0),
            flag: Some(Flag {
                value: "MASS",
                help: "M, mass [default: 1]",
            }),
            page: Some(Page::new([0.1, 10.0], [0.2, 5.0]).folded(Folded::Model)),
            ..ROW
        };
        /// κ, the stiffness of the spring.
        Stiffness = Row {
            name: "stiffness",
            symbol: "κ",
            long_name: "stiffness of the spring",
            dimension: STIFFNESS,
            default: Some(1.0),
            flag: Some(Flag {
                value: "STIFFNESS",
                help: "κ, stiffness [default: 1]",
            }),
            page: Some(Page::new([0.1, 10.0], [0.2, 5.0]).folded(Folded::Model)),
            ..ROW
        };
        /// N0, the unperturbed normal load.
        NormalLoad = Row {
            name: "normal_load",
            symbol: "N0",
            long_name: "unperturbed normal load",
            dimension: [1, 0, 0],
            default: Some(1.0),
            flag: Some(Flag {
                value: "NORMAL_LOAD",
                help: "N0, normal load [default: 1]",
            }),
            page: Some(Page::new([0.1, 10.0], [0.2, 5.0]).folded(Folded::Model)),
            ..ROW
        };
        /// c, the dashpot beside the spring.
        Damping = Row {
            name: "damping",
            symbol: "c",
            long_name: "damping by the dashpot beside the spring",
            flag: Some(Flag {
                value: "C",
                help: "c, dashpot beside the spring, mass/time [default: 0]",
            }),
            page: Some(Page::new([0.0, 2.0], [0.0, 1.0]).folded(Folded::Model)),
            ..DASHPOT
        };
        /// c_g, the dashpot to the ground.
        Viscous = Row {
            name: "viscous",
            symbol: "c_g",
            long_name: "viscous friction by the dashpot to the ground",
            flag: Some(Flag {
                value: "C",
                help: "c_g, dashpot to the ground, whatever the load, mass/time [default: 0]",
            }),
            page: Some(Page::new([0.0, 2.0], [0.0, 1.0]).folded(Folded::Model)),
            ..DASHPOT
        };
        /// The smallest pulling velocity of the actuator.
        VMin = Row {
            name: "v_min",
            symbol: "v_min",
            long_name: "smallest pulling velocity that the actuator has, whatever is commanded",
            dimension: VELOCITY,
            range: Range::Any,
            default: Some(f64::NEG_INFINITY),
            flag: Some(Flag {
                value: "V",
                help: "v_min, smallest velocity of the actuator, in motions [default: no limit]",
            }),
            page: Some(Page::new([-1.0, 1.0], [-1.0, 1.0]).first(0.0).folded(Folded::Limits)),
            ..ROW
        };
        /// The largest pulling velocity of the actuator.
        VMax = Row {
            name: "v_max",
            symbol: "v_max",
            long_name: "largest pulling velocity that the actuator has, whatever is commanded",
            dimension: VELOCITY,
            default: Some(f64::INFINITY),
            flag: Some(Flag {
                value: "V",
                help: "v_max, largest velocity of the actuator, in motions [default: no limit]",
            }),
            page: Some(Page::new([0.05, 3.0], [0.1, 2.0]).first(1.0).folded(Folded::Limits)),
            ..ROW
        };
        /// The smallest load of the actuator.
        LoadMin = Row {
            name: "load_min",
            symbol: "N_min",
            long_name: "smallest normal load that the actuator has, whatever is commanded",
            dimension: [1, 0, 0],
            range: Range::NotNegative,
            default: Some(0.0),
            flag: Some(Flag {
                value: "LOAD",
                help: "Smallest load of the actuator, in motions; above 0 nothing lifts off \
                    [default: 0]",
            }),
            page: Some(Page::new([0.0, 1.0], [0.0, 1.0]).first(0.1).folded(Folded::Limits)),
            ..ROW
        };
        /// The largest load of the actuator.
        LoadMax = Row {
            name: "load_max",
            symbol: "N_max",
            long_name: "largest normal load that the actuator has, whatever is commanded",
            dimension: [1, 0, 0],
            default: Some(f64::INFINITY),
            flag: Some(Flag {
                value: "LOAD",
                help: "Largest load of the actuator, in motions [default: no limit]",
            }),
            page: Some(Page::new([0.1, 5.0], [0.2, 5.0]).first(2.0).folded(Folded::Limits)),
            ..ROW
        };
        /// R, the memory of the feedback.
        Memory = Row {
            name: "memory",
            symbol: "R",
            long_name: "share of the feedback that is fed back again one delay later",
            range: Range::WithinOne,
            default: Some(0.0),
            flag: Some(Flag {
                value: "R",
                help: "R, share of the feedback fed back again one delay later [default: 0]",
            }),
            page: Some(Page::new([-0.95, 0.95], [-0.9, 0.9]).folded(Folded::Feedback)),
            ..ROW
        };
        /// δ, the latency of the feedback.
        Latency = Row {
            symbol: "δ",
            name: "latency",
            long_name: "latency of the feedback",
            flag: Some(Flag {
                value: "T",
                help: "δ, latency: time until the feedback acts [default: 0]",
            }),
            page: Some(Page::new([0.0, 5.0], [0.0, 2.0]).folded(Folded::Feedback)),
            ..LAG
        };
        /// T_a, the lag of the load behind its command.
        LoadLag = Row {
            symbol: "T_a",
            name: "load_lag",
            long_name: "time constant with which the load follows its command",
            flag: Some(Flag {
                value: "T",
                help: "T_a, time constant with which the load follows its command [default: 0]",
            }),
            page: Some(Page::new([0.0, 2.0], [0.0, 1.0]).folded(Folded::Feedback)),
            ..LAG
        };
        /// T_v, the lag of the pulling velocity behind its command.
        VelocityLag = Row {
            symbol: "T_v",
            name: "velocity_lag",
            long_name: "time constant with which the pulling velocity follows its command",
            flag: Some(Flag {
                value: "T",
                help: "T_v, time constant with which the velocity follows its command [default: 0]",
            }),
            page: Some(Page::new([0.0, 2.0], [0.0, 1.0]).folded(Folded::Feedback)),
            ..LAG
        };
        /// T_s, the lag of the sensor behind the elongation.
        SensorLag = Row {
            symbol: "T_s",
            name: "sensor_lag",
            long_name: "time constant with which the sensor follows the elongation",
            flag: Some(Flag {
                value: "T",
                help: "T_s, time constant with which the sensor follows elongation [default: 0]",
            }),
            page: Some(Page::new([0.0, 2.0], [0.0, 1.0]).folded(Folded::Feedback)),
            ..LAG
        };
        /// h, the time from one reading to the next.
        SampleTime = Row {
            symbol: "h",
            name: "sample_time",
            long_name: "time from one reading of the elongation to the next, held in between",
            flag: Some(Flag {
                value: "T",
                help: "h, time from reading to reading, held in between; 0: no digital loop \
                    [default: 0]",
            }),
            ..LAG
        };
        /// The standard deviation of the noise of a reading.
        Noise = Row {
            name: "noise",
            symbol: "σ_a",
            long_name: "standard deviation of the noise of a reading of the elongation",
            flag: Some(Flag {
                value: "A",
                help: "Standard deviation of the noise of a reading, in motions [default: 0]",
            }),
            ..READING
        };
        /// The step of the sensor.
        Resolution = Row {
            name: "resolution",
            symbol: "q_a",
            long_name: "step to whose multiples readings of the elongation are rounded",
            flag: Some(Flag {
                value: "A",
                help: "Step to whose multiples readings are rounded, in motions [default: 0]",
            }),
            ..READING
        };
        /// μ0 of a friction law.
        Mu0 = Row {
            name: "mu0",
            symbol: "μ0",
            long_name: "kinetic friction coefficient mu0 of the friction law",
            group: Group::Law,
            flag: Some(Flag {
                value: "MU0",
                help: "μ0 of the friction law",
            }),
            page: Some(Page::new([0.05, 1.0], [0.05, 1.0]).first(0.5)),
            ..ROW
        };
        /// v_s of a friction law.
        VS = Row {
            name: "v_s",
            symbol: "v_s",
            long_name: "velocity scale of the friction law",
            dimension: VELOCITY,
            group: Group::Law,
            flag: Some(Flag {
                value: "V_S",
                help: "v_s of the friction law",
            }),
            page: Some(Page::new([0.02, 4.0], [0.05, 2.0]).first(0.5)),
            ..ROW
        };
        /// δ, the exponent of Stribeck's transition.
        Exponent = Row {
            name: "exponent",
            symbol: "δ_s",
            long_name: "exponent of the transition of the friction law",
            default: Some(2.0),
            group: Group::Law,
            flag: Some(Flag {
                value: "D",
                help: "Exponent of the stribeck law [default: 2]",
            }),
            page: Some(Page::new([0.4, 3.0], [0.5, 2.5])),
            ..ROW
        };
        /// σ, the viscous part of a friction law.
        ViscousCoefficient = Row {
            name: "viscous_coefficient",
            symbol: "σ",
            long_name: "growth of the friction coefficient with the velocity",
            dimension: SLOPE,
            range: Range::NotNegative,
            default: Some(0.0),
            group: Group::Law,
            flag: Some(Flag {
                value: "SIGMA",
                help: "σ, viscous part of the friction law, time/length [default: 0]",
            }),
            page: Some(Page::new([0.0, 1.0], [0.0, 0.5])),
        };
        /// μ_K′(0⁺), the slope of the weakening law at rest: −μ0/v_s.
        MuPrimeRest = Row {
            name: "mu_prime_rest",
            symbol: "μ′(0)",
            long_name: "slope of the kinetic friction coefficient at rest",
            dimension: SLOPE,
            range: Range::Negative,
            group: Group::Law,
            flag: Some(Flag {
                value: "B",
                help: "Slope of the weakening law at rest, −μ0/v_s, instead of --mu0 or --v-s",
            }),
            ..ROW
        };
        /// v* of rate-and-state friction.
        VStar = Row {
            name: "v_star",
            symbol: "v*",
            long_name: "velocity at which steady sliding has the friction coefficient mu0",
            dimension: VELOCITY,
            group: Group::Law,
            flag: Some(Flag {
                value: "V_STAR",
                help: "v* of rate-and-state friction, where steady sliding has μ0",
            }),
            page: Some(Page::new([0.01, 3.0], [0.05, 2.0]).first(1.0)),
            ..ROW
        };
        /// A_f, the direct effect.
        DirectEffect = Row {
            name: "direct_effect",
            symbol: "A_f",
            long_name: "direct effect of the velocity on the friction coefficient",
            group: Group::Law,
            flag: Some(Flag {
                value: "A",
                help: "A_f of rate-and-state friction, the direct effect",
            }),
            page: Some(Page::new([0.005, 1.0], [0.01, 0.5]).first(0.1)),
            ..ROW
        };
        /// B_f, the effect of evolution.
        EvolutionEffect = Row {
            name: "evolution_effect",
            symbol: "B_f",
            long_name: "effect of the evolving state on the friction coefficient",
            group: Group::Law,
            flag: Some(Flag {
                value: "B",
                help: "B_f of rate-and-state friction, the effect of evolution",
            }),
            page: Some(Page::new([0.005, 1.0], [0.01, 1.0]).first(0.4)),
            ..ROW
        };
        /// D_c, the distance in which the state evolves.
        SlipDistance = Row {
            name: "slip_distance",
            symbol: "D_c",
            long_name: "slip distance in which the state of friction evolves",
            dimension: [0, 1, 0],
            group: Group::Law,
            flag: Some(Flag {
                value: "D_C",
                help: "D_c of rate-and-state friction, the distance in which the state evolves",
            }),
            page: Some(Page::new([0.02, 5.0], [0.05, 3.0]).first(1.0)),
            ..ROW
        };
        /// c: the share of a change of the load that the state takes up at once.
        LoadMemory = Row {
            name: "load_memory",
            symbol: "c",
            long_name: "share of a change of the load that the state of friction takes up at once",
            range: Range::NotNegative,
            default: Some(0.0),
            group: Group::Law,
            flag: Some(Flag {
                value: "C",
                help: "c of rate-and-state friction: how much the state takes up of a change of \
                    the load [default: 0]",
            }),
            page: Some(Page::new([0.0, 1.0], [0.0, 1.0])),
            ..ROW
        };
        /// μ_S, the static friction coefficient.
        MuS = Row {
            name: "mu_s",
            symbol: "μ_S",
            long_name: "static friction coefficient",
            default: Some(1.0),
            group: Group::Law,
            flag: Some(Flag {
                value: "MU_S",
                help: "μ_S, static friction coefficient [default: 1]",
            }),
            page: Some(Page::new([0.1, 2.0], [0.2, 2.0])),
            ..ROW
        };
        /// ẋ at t = 0.
        XDot0 = Row {
            name: "x_dot0",
            symbol: "ẋ0",
            long_name: "velocity of the block at t = 0",
            dimension: VELOCITY,
            range: Range::Any,
            group: Group::Start,
            flag: Some(Flag {
                value: "V",
                help: "ẋ at t = 0 [default: 1 % faster than v0, or v0 with --a0]",
            }),
            ..ROW
        };
        /// Elongation at t = 0 and before.
        A0 = Row {
            name: "a0",
            symbol: "a0",
            long_name: "elongation of the spring at t = 0 and before",
            dimension: [0, 1, 0],
            range: Range::Any,
            group: Group::Start,
            flag: Some(Flag {
                value: "A",
                help: "Elongation of the spring at t = 0 and before [default: that of sliding]",
            }),
            ..ROW
        };
        /// Time from a release of uncontrolled stick-slip to switch-on.
        SwitchOnPhase = Row {
            name: "switch_on_phase",
            symbol: "φ",
            long_name: "time from release to switch-on",
            dimension: TIME,
            range: Range::NotNegative,
            group: Group::Start,
            ..ROW
        };
        /// γ = −μ_K α_N τ/(2√(κM)) of the limit of a short delay.
        Gamma = Row {
            name: "gamma",
            symbol: "γ",
            long_name: "strength of load control",
            range: Range::NotNegative,
            group: Group::Limit,
            flag: Some(Flag {
                value: "GAMMA",
                help: "γ = −μ_K α_N τ/(2√(κM)) (with --protocol limit)",
            }),
            ..ROW
        };
        /// ζ + ζ_g of the dashpots in that limit.
        DampingRatio = Row {
            name: "damping_ratio",
            symbol: "ζ",
            long_name: "damping ratio of both dashpots together, (damping + viscous)/(2√(κM))",
            range: Range::NotNegative,
            default: Some(0.0),
            group: Group::Limit,
            flag: Some(Flag {
                value: "ZETA",
                help: "ζ = (c + c_g)/(2√(κM)) of dashpots (with --protocol limit) [default: 0]",
            }),
            ..ROW
        };
        /// μ_K/μ_S in that limit.
        MuRatio = Row {
            name: "mu_ratio",
            symbol: "μ_K/μ_S",
            long_name: "kinetic over static friction coefficient",
            range: Range::Part,
            group: Group::Limit,
            flag: Some(Flag {
                value: "MU_RATIO",
                help: "μ_K/μ_S (with --protocol limit)",
            }),
            ..ROW
        };
    }
}

impl Parameter {
    /// The name as the key in a file.
    #[must_use]
    pub fn key(self) -> String {
        self.name().into()
    }

    /// The name, the same word everywhere (flags write `-` for `_`).
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// The parameter of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|p| p.name() == name)
    }

    /// Its meaning, for `long_name` in maps and labels in pictures.
    #[must_use]
    pub const fn long_name(self) -> &'static str {
        self.row().long_name
    }

    /// The symbol of the letter.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        self.row().symbol
    }

    /// Powers of force, length and time in its unit.
    #[must_use]
    pub const fn dimension(self) -> [i32; 3] {
        self.row().dimension
    }

    /// The default value; none for a required parameter, and for those of `Group::Start`.
    #[must_use]
    pub const fn default_value(self) -> Option<f64> {
        self.row().default
    }

    /// What it belongs to.
    #[must_use]
    pub const fn group(self) -> Group {
        self.row().group
    }

    /// Its flag in commands for a single point, if there is one.
    #[must_use]
    pub const fn flag(self) -> Option<Flag> {
        self.row().flag
    }

    /// How the page offers it; none where it does not.
    #[must_use]
    pub const fn page(self) -> Option<Page> {
        self.row().page
    }

    /// The name of that flag, without its dashes.
    #[must_use]
    pub fn long_flag(self) -> Option<String> {
        self.flag().map(|_| self.name().replace('_', "-"))
    }

    /// The smallest and the largest value.
    #[must_use]
    pub const fn range(self) -> [f64; 2] {
        match self.row().range {
            Range::Any => [-LARGEST, LARGEST],
            Range::NotNegative => [0.0, LARGEST],
            Range::Positive => [1.0 / LARGEST, LARGEST],
            Range::Part => [1.0 / LARGEST, 1.0],
            Range::WithinOne => [-BELOW_ONE, BELOW_ONE],
            Range::Negative => [-LARGEST, -1.0 / LARGEST],
        }
    }

    /// True for the parameters that only a friction law has.
    #[must_use]
    pub const fn of_friction_law(self) -> bool {
        matches!(self.group(), Group::Law)
    }

    /// Memory, latency, sampling and lags, which the letter's feedback lacks. At 0, their default,
    /// they are absent and not mentioned.
    pub const BEYOND_LETTER: [Self; 6] = [
        Self::SampleTime,
        Self::Memory,
        Self::Latency,
        Self::LoadLag,
        Self::VelocityLag,
        Self::SensorLag,
    ];

    /// The dashpots beside the spring and to the ground.
    pub(crate) const DASHPOTS: [Self; 2] = [Self::Damping, Self::Viscous];

    /// The limits of the actuators: those of the velocity, then those of the load.
    pub(crate) const LIMITS: [Self; 4] = [Self::VMin, Self::VMax, Self::LoadMin, Self::LoadMax];

    /// What a sensor does to each reading; absent at 0, and known to motions alone.
    pub(crate) const OF_READINGS: [Self; 2] = [Self::Noise, Self::Resolution];

    /// The parameters of the limit of a short delay.
    pub(crate) const OF_LIMIT: [Self; 3] = [Self::Gamma, Self::DampingRatio, Self::MuRatio];

    /// The lags of load, velocity and sensor.
    pub const LAGS: [Self; 3] = [Self::LoadLag, Self::VelocityLag, Self::SensorLag];

    /// The parameters of every system from a file besides its own: the delay and, in feedback form,
    /// memory and latency.
    #[must_use]
    pub const fn of_systems(feedback: bool) -> &'static [Self] {
        match feedback {
            true => &[Self::Tau, Self::Memory, Self::Latency],
            false => &[Self::Tau],
        }
    }

    /// True for what is absent and not mentioned at its default: [`Parameter::BEYOND_LETTER`],
    /// dashpots and limits of actuators.
    #[must_use]
    pub(crate) fn absent_by_default(self) -> bool {
        let rows: [&[Self]; 4] = [
            &Self::DASHPOTS,
            &Self::LIMITS,
            &Self::BEYOND_LETTER,
            &Self::OF_READINGS,
        ];
        let mut absent = rows.into_iter();
        self == Self::DampingRatio || absent.any(|absent| absent.contains(&self))
    }

    /// True for the parameters of the start of a motion.
    #[must_use]
    pub const fn of_start(self) -> bool {
        matches!(self.group(), Group::Start)
    }

    /// True for the parameters of the limit of a short delay.
    #[must_use]
    pub const fn of_limit(self) -> bool {
        matches!(self.group(), Group::Limit)
    }

    /// The allowed range, in words.
    #[must_use]
    pub const fn allowed(self) -> &'static str {
        match self.row().range {
            Range::Any => "a finite number of size at most 1e12",
            Range::NotNegative => "0 or more, at most 1e12",
            Range::Positive => "greater than 0, between 1e-12 and 1e12",
            Range::Part => "greater than 0, between 1e-12 and 1",
            Range::WithinOne => "greater than -1 and less than 1",
            Range::Negative => "less than 0, between -1e12 and -1e-12",
        }
    }

    /// `value` if it is in range.
    ///
    /// # Errors
    /// Names the parameter, the value and the allowed range.
    pub fn check(self, value: f64) -> Result<f64, ModelError> {
        let [from, to] = self.range();
        if (from..=to).contains(&value) {
            Ok(value)
        } else {
            Err(ModelError {
                parameter: self.name(),
                value,
                allowed: self.allowed(),
                at_speed: None,
            })
        }
    }
}
