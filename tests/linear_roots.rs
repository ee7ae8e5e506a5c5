//! Roots, tracking and certificate against independent methods and reference values.

mod common;

use common::winding;
use proptest::prelude::*;
use slipmap::linear::certificate::roots_right_of;
use slipmap::model::Groups;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50_000))]

    /// The closed form of the argument principle agrees with following the argument step by step.
    #[test]
    fn the_certificate_is_a_winding_number(
        b in prop_oneof![4 => -2.5..1.0_f64, 1 => Just(0.0)],
        a_v in prop_oneof![4 => -3.0..3.0_f64, 1 => Just(0.0)],
        a_n in prop_oneof![4 => -15.0..5.0_f64, 1 => Just(0.0)],
        tau in prop_oneof![4 => 0.001..12.0_f64, 1 => Just(0.0)],
        line in -2.0..2.5_f64,
    ) {
        // Far left of the axis D is too large to be followed in small steps.
        let line = line.max(-4.0 / tau);
        if let Some(expected) = winding::roots_right_of(b, a_v, a_n, tau, line) {
            let found = roots_right_of(Groups::new(b, a_v, a_n), tau, line);
            prop_assert_eq!(found, Some(expected));
        }
    }
}
