//! The bits of a cell's status in words.

use crate::linear::status::{
    CERTIFIED, DISAGREE, FLAGS, MARGINAL, NOT_CONVERGED, OUTSIDE_MODEL, SAMPLED, SATURATED,
};

/// Every bit with its name and its words, in the order of the bits.
pub(crate) fn flags() -> [(u8, &'static str, &'static str); FLAGS.len()] {
    FLAGS.map(|(mask, name)| (mask, name, words(mask)))
}

const fn words(mask: u8) -> &'static str {
    match mask {
        CERTIFIED => "certified",
        MARGINAL => "marginal",
        NOT_CONVERGED => "not converged",
        DISAGREE => "methods disagree",
        SATURATED => "more than can be counted",
        SAMPLED => "recomputed by a second method",
        OUTSIDE_MODEL => "outside the model",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_has_words_of_its_own() {
        let found = flags();
        for (i, (_, name, words)) in found.iter().enumerate() {
            assert!(!words.is_empty(), "{name}");
            assert!(found[..i].iter().all(|(.., other)| other != words));
        }
    }
}
