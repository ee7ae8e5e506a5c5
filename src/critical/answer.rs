//! What is told: the critical velocity, how stick-slip ends there, and what found it.

/// How stick-slip ends at v_c.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum End {
    /// The slip grazes ẋ = ẍ = 0 at its end.
    Grazing,
    /// The orbit vanishes or loses its stability while its stops are still crossings of ẋ = 0.
    Fold,
    /// The last stick-slip has more than one slip in a period: one period has doubled before.
    PeriodDoubling,
    /// The last stick-slip does not repeat.
    Irregular,
    /// N ≤ 0 on the way: the model ends at `v_liftoff`, and there is no v_c.
    LiftOff,
    /// It survives up to the largest v0 that was tried.
    Persists,
    /// No stick-slip is sustained at any v0 that was tried: v_c = 0.
    Never,
    /// It does not survive switching on above v_c, whatever it becomes: by the protocol
    /// [`super::switch_on`] no more is known.
    Lost,
}

impl End {
    /// Every end, in order.
    pub const ALL: [Self; 8] = [
        Self::Grazing,
        Self::Fold,
        Self::PeriodDoubling,
        Self::Irregular,
        Self::LiftOff,
        Self::Persists,
        Self::Never,
        Self::Lost,
    ];

    /// The name in maps and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grazing => "grazing",
            Self::Fold => "fold",
            Self::PeriodDoubling => "period-doubling",
            Self::Irregular => "irregular",
            Self::LiftOff => "lift-off",
            Self::Persists => "persists",
            Self::Never => "never",
            Self::Lost => "lost",
        }
    }
}

/// What gave a critical velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// One slip without memory, at its graze or at its lift-off.
    GrazeSlip,
    /// The orbit, at its graze, at its lift-off or where its stick vanishes.
    GrazeOrbit,
    /// Simulation, see [`super::follow`].
    Simulation,
}

impl Method {
    /// All, in the order of their numbers in a map.
    pub const ALL: [Self; 3] = [Self::GrazeSlip, Self::GrazeOrbit, Self::Simulation];

    /// The name in maps and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::GrazeSlip => "graze-slip",
            Self::GrazeOrbit => "graze-orbit",
            Self::Simulation => "simulation",
        }
    }
}

/// The critical velocity of a problem, in the units of [`crate::slip::motion`]; NaN for what there
/// is not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// The largest v0 at which stick-slip persists; 0 where it never does.
    pub vc: f64,
    /// How it ends there.
    pub end: End,
    /// What gave the answer.
    pub method: Method,
    /// The smallest v0 at which N ≤ 0 occurs, where that ends stick-slip.
    pub v_liftoff: f64,
    /// Time stuck in a period at v_c.
    pub stick_time: f64,
    /// Time in slip in a period at v_c.
    pub slip_time: f64,
    /// The smallest N at v_c.
    pub n_min: f64,
    /// Whether stick-slip was sustained at any v0 that was tried.
    pub sustained: bool,
    /// Whether it is known what becomes of the motion beyond v_c.
    pub decided: bool,
}

impl Critical {
    /// The v0 at which stick-slip ends, or the model with it; NaN where it persists.
    #[must_use]
    pub fn end_of_stick_slip(&self) -> f64 {
        match self.end {
            End::LiftOff => self.v_liftoff,
            _ => self.vc,
        }
    }

    /// Whether `other` says the same of the end of stick-slip: at v_c, or the velocity of lift-off,
    /// within [`GRAZE_PRECISION`].
    ///
    /// Both have to lift off, to persist or never to be stick-slip; by which of the other ends it
    /// is lost is told from the last v0 that holds it alone, whose cycles need not have come to
    /// repeat, so that is not compared.
    #[must_use]
    pub fn ends_like(&self, other: &Self) -> bool {
        let near =
            |a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= GRAZE_PRECISION * a.abs();
        let apart = |end: End| matches!(end, End::LiftOff | End::Persists | End::Never);
        let alike = self.end == other.end || !apart(self.end) && !apart(other.end);
        alike && near(self.vc, other.vc) && near(self.v_liftoff, other.v_liftoff)
    }

    /// The end at `vc`, of which nothing more is known.
    pub(super) fn nothing(vc: f64, end: End, method: Method) -> Self {
        Self {
            vc,
            end,
            method,
            v_liftoff: f64::NAN,
            stick_time: f64::NAN,
            slip_time: f64::NAN,
            n_min: f64::NAN,
            sustained: end != End::Never,
            decided: true,
        }
    }

    /// N ≤ 0 from `v0` on.
    pub(super) fn of_lift_off(v0: f64, method: Method) -> Self {
        Self {
            v_liftoff: v0,
            n_min: 0.0,
            ..Self::nothing(f64::NAN, End::LiftOff, method)
        }
    }
}

/// The critical velocity with all windows of v0 in which stick-slip survives.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalWindows {
    /// v_c and what there is at it.
    pub critical: Critical,
    /// Where stick-slip survives, up to the largest v0 at which it is looked for: v0 from and to,
    /// increasing. The last one may end at v_c, where N ≤ 0 occurs, or with the range.
    pub windows: Vec<[f64; 2]>,
}

/// v_c by a graze is known to about this, relative.
pub const GRAZE_PRECISION: f64 = 1e-4;
