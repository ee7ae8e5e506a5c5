//! The fields of maps of the limit of a short delay.

/// A field of the limit, dimensionless; velocities in units of ṽ = (μ_S−μ_K)N0/√(κM).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LimitField {
    /// v_c/ṽ.
    VcOverVtilde,
    /// ω0 T, the duration of the slip that just grazes, ω0 = √(κ/M).
    Omega0T,
    /// The pulling velocity from which the block lifts off.
    LiftoffOverVtilde,
    /// The approximation of v_c/ṽ for γ → 0.
    VcWeakControl,
    /// The approximation of v_c/ṽ for γ → 1.
    VcStrongControl,
    /// Relative error of [`LimitField::VcWeakControl`].
    WeakControlError,
    /// Relative error of [`LimitField::VcStrongControl`].
    StrongControlError,
}

impl LimitField {
    /// All of them, in order.
    pub const ALL: [Self; 7] = [
        Self::VcOverVtilde,
        Self::Omega0T,
        Self::LiftoffOverVtilde,
        Self::VcWeakControl,
        Self::VcStrongControl,
        Self::WeakControlError,
        Self::StrongControlError,
    ];

    /// The velocities, which one picture shows together.
    pub const VELOCITIES: [Self; 4] = [
        Self::VcOverVtilde,
        Self::VcWeakControl,
        Self::VcStrongControl,
        Self::LiftoffOverVtilde,
    ];

    /// The name in sweep files, maps and JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::VcOverVtilde => "vc_over_vtilde",
            Self::Omega0T => "omega0_T",
            Self::LiftoffOverVtilde => "liftoff_over_vtilde",
            Self::VcWeakControl => "vc_weak_control",
            Self::VcStrongControl => "vc_strong_control",
            Self::WeakControlError => "weak_control_error",
            Self::StrongControlError => "strong_control_error",
        }
    }

    /// What it is, in full.
    #[must_use]
    pub const fn long_name(self) -> &'static str {
        match self {
            Self::VcOverVtilde => "critical velocity over vtilde: below it stick-slip survives",
            Self::Omega0T => "duration of the slip that just grazes, over sqrt(mass/stiffness)",
            Self::LiftoffOverVtilde => {
                "pulling velocity over vtilde from which the block lifts off while it sticks"
            }
            Self::VcWeakControl => "the letter's approximation of v_c/vtilde as gamma goes to 0",
            Self::VcStrongControl => "the letter's approximation of v_c/vtilde as gamma goes to 1",
            Self::WeakControlError => "relative error of vc_weak_control",
            Self::StrongControlError => "relative error of vc_strong_control",
        }
    }

    /// What it is in a few words, with symbols.
    #[must_use]
    pub const fn short_name(self) -> &'static str {
        match self {
            Self::VcOverVtilde => "v_c/ṽ",
            Self::Omega0T => "duration of the slip ω_0T",
            Self::LiftoffOverVtilde => "lift-off",
            Self::VcWeakControl => "v_c/ṽ for γ → 0",
            Self::VcStrongControl => "v_c/ṽ for γ → 1",
            Self::WeakControlError => "error of v_c for γ → 0",
            Self::StrongControlError => "error of v_c for γ → 1",
        }
    }

    /// What a reader of the map should know besides.
    #[must_use]
    pub const fn comment(self) -> Option<&'static str> {
        match self {
            Self::VcOverVtilde => Some(
                "vtilde = (mu_s - mu_k) normal_load / sqrt(stiffness mass), gamma = -mu_k alpha_n \
                tau / (2 sqrt(stiffness mass)), \
                 mu_ratio = mu_k/mu_s; 0 from gamma = 1 on",
            ),
            Self::Omega0T => Some("infinity from gamma = 1 on"),
            Self::LiftoffOverVtilde => Some("infinity at mu_ratio = 1"),
            Self::VcWeakControl => Some("1/(2 sqrt(pi gamma))"),
            Self::VcStrongControl => {
                Some("exp(-1 - pi gamma/sqrt(1 - gamma^2))/gamma; 0 from gamma = 1 on")
            }
            Self::WeakControlError | Self::StrongControlError => {
                Some("approximation over vc_over_vtilde, less 1; no value where that is 0")
            }
        }
    }

    /// True for [`LimitField::VELOCITIES`].
    #[must_use]
    pub const fn is_velocity(self) -> bool {
        !matches!(self, Self::Omega0T) && !self.is_error()
    }

    /// True for the letter's approximations.
    #[must_use]
    pub const fn approximates(self) -> bool {
        matches!(self, Self::VcWeakControl | Self::VcStrongControl)
    }

    /// True for relative errors, which have a sign.
    #[must_use]
    pub const fn is_error(self) -> bool {
        matches!(self, Self::WeakControlError | Self::StrongControlError)
    }
}
