//! Systems that are part of the program, by name: the files of `sweeps/systems`.

use super::SystemModel;
use crate::text::nearest::did_you_mean;

/// All names, with their files.
pub const SHIPPED: [(&str, &str); 11] = [
    (
        "letter",
        include_str!("../../../sweeps/systems/letter.toml"),
    ),
    ("lags", include_str!("../../../sweeps/systems/lags.toml")),
    (
        "rate_state",
        include_str!("../../../sweeps/systems/rate_state.toml"),
    ),
    (
        "turning",
        include_str!("../../../sweeps/systems/turning.toml"),
    ),
    (
        "turning_two_modes",
        include_str!("../../../sweeps/systems/turning_two_modes.toml"),
    ),
    ("pd", include_str!("../../../sweeps/systems/pd.toml")),
    (
        "delayed_oscillator",
        include_str!("../../../sweeps/systems/delayed_oscillator.toml"),
    ),
    (
        "pyragas_focus",
        include_str!("../../../sweeps/systems/pyragas_focus.toml"),
    ),
    (
        "ring_road",
        include_str!("../../../sweeps/systems/ring_road.toml"),
    ),
    (
        "pi_loop",
        include_str!("../../../sweeps/systems/pi_loop.toml"),
    ),
    (
        "smith_predictor",
        include_str!("../../../sweeps/systems/smith_predictor.toml"),
    ),
];

/// The file of the system with this name.
#[must_use]
pub(crate) fn text_of(name: &str) -> Option<&'static str> {
    let found = SHIPPED.into_iter().find(|(known, _)| *known == name);
    found.map(|(_, text)| text)
}

/// The system with this name.
#[must_use]
pub fn system(name: &str) -> Option<SystemModel> {
    text_of(name)?.parse().ok()
}

/// All names, for messages.
#[must_use]
pub fn names() -> String {
    SHIPPED.map(|(name, _)| name).join(", ")
}

/// A message about an unknown name: what may have been meant, and which names exist.
#[must_use]
pub(crate) fn meant(name: &str) -> String {
    let meant = did_you_mean(name, SHIPPED.map(|(known, _)| known));
    format!("{meant}known by name: {}; others by their file", names())
}
