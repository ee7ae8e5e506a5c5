//! Margins of the letter's control with memory, latency, lags and a dashpot d beside the spring.
//!
//! ```text
//! D = B(1 − R E) − A e^(−λδ)(1 − E),   E = e^(−λτ),   λ = −σ + iω                            (1)
//! B = (λ² + bλ + 1) L_a L_v L_s,   L = 1 + Tλ                                                (2)
//! A = (a_n + d a_v) L_v + a_v (b − d + λ) L_a
//! ```
//!
//! - `feedback`: what such feedback has, (1) and (2), and which settings of it are stable
//! - `equations`: where a root lies on the line, as one real equation in ω for each way in which a
//!   setting can change
//! - `highest`: frequencies beyond which no root lies on the line

mod equations;
mod feedback;
mod highest;

pub use self::equations::Equations;
pub use self::feedback::Beyond;
