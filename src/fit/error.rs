//! Why points determine no law.

/// Why no friction law was fitted.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FitError {
    /// All points are at one velocity.
    #[error("all points are at one velocity, which tells no slope")]
    OneVelocity,
    /// Fewer velocities than parameters, or as many.
    #[error(
        "{velocities} velocities do not determine the {parameters} parameters of the {law} law \
         and their errors"
    )]
    TooFew {
        /// The law with the fewest parameters of those that were to be fitted.
        law: &'static str,
        /// Its number of parameters.
        parameters: usize,
        /// How many velocities there are.
        velocities: usize,
    },
    /// The points fall nowhere with the velocity, beyond their noise.
    #[error("no fall of friction with the velocity is seen beyond the noise of the points")]
    NoDescent,
    /// The minimum was not found, or does not determine all parameters.
    #[error("the points do not determine the parameters of the {law} law")]
    NotDetermined {
        /// The law.
        law: &'static str,
    },
}

impl FitError {
    /// What to do.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            Self::OneVelocity => "measure at several velocities, below and above v0",
            Self::TooFew { .. } => "measure at more velocities, below and above v0",
            Self::NoDescent => {
                "measure more points; where friction does not fall there is no stick-slip to be \
                 controlled. Are speed and friction in the columns that were read (--columns)?"
            }
            Self::NotDetermined { .. } => {
                "measure at more velocities near v0, or ask for another law: --law weakening has \
                 the fewest parameters"
            }
        }
    }
}
