//! The macro that makes options from a table: a row for each, with its reason, default and range.

use std::ops::RangeInclusive;

/// The value of an option: a number, some numbers or a switch.
pub(in crate::critical) trait OptionValue: Copy {
    /// The type of the bounds of its range.
    type Bound: PartialOrd;

    /// The value, or each of its numbers, times `factor`, within `range`; a switch does not change.
    fn scaled(self, factor: f64, range: &RangeInclusive<Self::Bound>) -> Self;

    /// Whether the value, or each of its numbers, lies in `range`.
    fn within(self, range: &RangeInclusive<Self::Bound>) -> bool;
}

impl OptionValue for f64 {
    type Bound = Self;

    fn scaled(self, factor: f64, range: &RangeInclusive<Self>) -> Self {
        (self * factor).clamp(*range.start(), *range.end())
    }

    fn within(self, range: &RangeInclusive<Self>) -> bool {
        range.contains(&self)
    }
}

/// Counts are rounded up.
macro_rules! count {
    ($kind:ty, $number:expr) => {
        impl OptionValue for $kind {
            type Bound = Self;

            fn scaled(self, factor: f64, range: &RangeInclusive<Self>) -> Self {
                let scaled = ($number(self) * factor).ceil() as $kind;
                scaled.clamp(*range.start(), *range.end())
            }

            fn within(self, range: &RangeInclusive<Self>) -> bool {
                range.contains(&self)
            }
        }
    };
}

count!(u32, f64::from);
count!(u64, |count: u64| count as f64);
count!(usize, |count: usize| count as f64);

impl<const N: usize> OptionValue for [f64; N] {
    type Bound = f64;

    fn scaled(self, factor: f64, range: &RangeInclusive<f64>) -> Self {
        self.map(|number| number.scaled(factor, range))
    }

    fn within(self, range: &RangeInclusive<f64>) -> bool {
        self.iter().all(|number| range.contains(number))
    }
}

impl OptionValue for bool {
    type Bound = Self;

    fn scaled(self, _: f64, _: &RangeInclusive<Self>) -> Self {
        self
    }

    fn within(self, range: &RangeInclusive<Self>) -> bool {
        range.contains(&self)
    }
}

/// A struct of options from a table of their names, defaults and ranges. It is `Copy`, its default
/// has all defaults, and options can be named in tests and benches.
macro_rules! options {
    (
        $(#[$about:meta])*
        $name:ident {
            $($(#[$doc:meta])* $field:ident: $kind:ty = $default:expr, in $range:expr;)+
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, PartialEq)]
        pub struct $name {
            $(
                $(#[$doc])*
                #[doc = concat!(
                    "\n\nDefault ", stringify!($default), ", in ", stringify!($range), "."
                )]
                pub $field: $kind,
            )+
        }

        /// Shows the options that differ from their defaults.
        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let usual = Self::default();
                let mut told = f.debug_struct(stringify!($name));
                $(if self.$field != usual.$field {
                    told.field(stringify!($field), &self.$field);
                })+
                told.finish_non_exhaustive()
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }

        impl $name {
            /// The names of the options, in the order of the table.
            pub(crate) const NAMES: &'static [&'static str] = &[$(stringify!($field)),+];

            /// Multiplies the option of this name, or each of its numbers, by `factor`, within its
            /// range; counts are rounded up. False where that changes nothing.
            pub(crate) fn scale(&mut self, name: &str, factor: f64) -> bool {
                use $crate::critical::options::table::OptionValue;
                match name {
                    $(stringify!($field) => {
                        let before = self.$field;
                        self.$field = before.scaled(factor, &($range));
                        self.$field != before
                    })+
                    _ => false,
                }
            }

            /// Whether every option lies in its range.
            #[must_use]
            pub fn within_ranges(&self) -> bool {
                use $crate::critical::options::table::OptionValue;
                true $(&& self.$field.within(&($range)))+
            }
        }
    };
}
