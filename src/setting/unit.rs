//! A unit of measurement, from the words that people write: `mm/s`, `N s2/m`, `kg`.

use std::fmt;

use super::units::Units;
use crate::text::SpecError;
use crate::text::nearest::did_you_mean;

/// A factor without rounding: a quotient of whole numbers times a power of ten.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scale {
    above: u128,
    below: u128,
    tens: i32,
}

impl Scale {
    /// The factor 1.
    pub(super) const ONE: Self = Self::new(1, 0);

    const fn new(above: u128, tens: i32) -> Self {
        Self {
            above,
            below: 1,
            tens,
        }
    }

    /// The product; none where it has too many digits.
    fn times(self, other: Self) -> Option<Self> {
        let above = self.above.checked_mul(other.above)?;
        let below = self.below.checked_mul(other.below)?;
        let common = common_divisor(above, below);
        Some(Self {
            above: above / common,
            below: below / common,
            tens: self.tens + other.tens,
        })
    }

    fn power(self, power: i32) -> Option<Self> {
        let inverse = Self {
            above: self.below,
            below: self.above,
            tens: -self.tens,
        };
        let factor = if power < 0 { inverse } else { self };
        (0..power.unsigned_abs()).try_fold(Self::ONE, |product, _| product.times(factor))
    }

    /// A decimal number times the factor. Its digits are multiplied as a whole number and its
    /// decimal point is shifted: 2.4 thousandths are the number 0.0024, 12 inches 0.3048 m. None
    /// for an exponent beyond all numbers.
    pub(super) fn of(self, decimal: &str) -> Option<f64> {
        let (digits, exponent) = match decimal.split_once(['e', 'E']) {
            Some((digits, exponent)) => (digits, exponent.parse().ok()?),
            None => (decimal, 0_i32),
        };
        let tens = exponent.checked_add(self.tens)?;
        let above = i128::try_from(self.above).ok()?;
        let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
        let all = format!("{whole}{part}").parse::<i128>().ok();
        let product: f64 = match all.and_then(|all| all.checked_mul(above)) {
            Some(product) => {
                let tens = i64::from(tens) - i64::try_from(part.len()).ok()?;
                format!("{product}e{tens}").parse().ok()?
            }
            None => format!("{digits}e{tens}").parse::<f64>().ok()? * self.above as f64,
        };
        Some(product / self.below as f64)
    }
}

fn common_divisor(a: u128, b: u128) -> u128 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// The facts about a known unit.
struct Known {
    word: &'static str,
    /// Powers of force, length and time.
    dimension: [i32; 3],
    /// What it is in N, m and s.
    scale: Scale,
    /// The prefixes that are usual before it.
    prefixes: &'static [&'static str],
}

const fn known(
    word: &'static str,
    dimension: [i32; 3],
    scale: Scale,
    prefixes: &'static [&'static str],
) -> Known {
    Known {
        word,
        dimension,
        scale,
        prefixes,
    }
}

/// The known units. Inch, foot, pound and pound-force are these numbers by definition.
const KNOWN: [Known; 15] = [
    known("N", [1, 0, 0], Scale::ONE, &["n", "u", "m", "k", "M"]),
    known("m", [0, 1, 0], Scale::ONE, &["n", "u", "m", "c", "d", "k"]),
    known("s", [0, 0, 1], Scale::ONE, &["n", "u", "m"]),
    known("kg", [1, -1, 2], Scale::ONE, &[]),
    known("g", [1, -1, 2], Scale::new(1, -3), &["m"]),
    known("t", [1, -1, 2], Scale::new(1, 3), &[]),
    known("sec", [0, 0, 1], Scale::ONE, &[]),
    known("min", [0, 0, 1], Scale::new(6, 1), &[]),
    known("h", [0, 0, 1], Scale::new(36, 2), &[]),
    known("Hz", [0, 0, -1], Scale::ONE, &["k"]),
    known("in", [0, 1, 0], Scale::new(254, -4), &[]),
    known("ft", [0, 1, 0], Scale::new(3048, -4), &[]),
    known("lbf", [1, 0, 0], Scale::new(44_482_216_152_605, -13), &[]),
    known("lb", [1, -1, 2], Scale::new(45_359_237, -8), &[]),
    known("rad", [0, 0, 0], Scale::ONE, &["m"]),
];

/// Prefixes with their powers of ten.
const PREFIXES: [(&str, i32); 7] = [
    ("n", -9),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("k", 3),
    ("M", 6),
];

/// The largest power of a unit.
const LARGEST_POWER: i32 = 9;

/// Names of dimensions: what has them, what they are, and a unit of them.
const NAMED: [([i32; 3], &str, &str, &str); 9] = [
    ([1, 0, 0], "force", "", "N"),
    ([0, 1, 0], "length", "", "mm"),
    ([0, 0, 1], "time", "", "ms"),
    ([1, -1, 2], "mass", "", "kg"),
    ([0, 1, -1], "velocity", "length/time", "mm/s"),
    ([1, -1, 0], "stiffness", "force/length", "N/mm"),
    ([1, -1, 1], "damping", "mass/time", "kg/s"),
    ([0, 0, -1], "rate", "1/time", "1/s"),
    ([0, -1, 1], "slope by velocity", "time/length", "s/m"),
];

/// A unit: powers of force, length and time, and a factor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Unit {
    text: String,
    dimension: [i32; 3],
    scale: Scale,
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Unit {
    /// Reads a unit: known words with powers, such as `s2`, `s^2`, `s-1` or `s⁻¹`, multiplied by a
    /// blank, `*` or `·` and divided by `/`.
    ///
    /// # Errors
    /// Says what is not understood, and what is known.
    pub(crate) fn read(text: &str) -> Result<Self, SpecError> {
        let text = text.trim();
        let mut unit = Self {
            text: text.to_owned(),
            dimension: [0; 3],
            scale: Scale::ONE,
        };
        let mut rest = text;
        let mut sign = 1;
        loop {
            let (dimension, scale, behind) = unit.factor(rest)?;
            unit.multiply(dimension, scale, sign)?;
            rest = behind.trim_start();
            if rest.is_empty() {
                return Ok(unit);
            }
            let divided = rest.strip_prefix('/');
            if sign < 0 && divided.is_none() {
                return Err(unit.two_ways());
            }
            sign = if divided.is_some() { -1 } else { 1 };
            let times = ['*', '·', '⋅'];
            rest = divided
                .or(rest.strip_prefix(times))
                .unwrap_or(rest)
                .trim_start();
        }
    }

    /// Powers of force, length and time.
    pub(crate) fn dimension(&self) -> [i32; 3] {
        self.dimension
    }

    /// A decimal number in this unit as a number in `units`.
    ///
    /// # Errors
    /// When `units` has no known units to turn it into, or the number is too large.
    pub(super) fn value(&self, decimal: &str, units: &Units) -> Result<f64, SpecError> {
        if self.dimension != [0; 3] {
            units.check_known()?;
        }
        let value = self.scale_in(units)?.of(decimal);
        value
            .filter(|value| value.is_finite())
            .ok_or_else(|| SpecError::whole(format!("{decimal} {self} is too large a number")))
    }

    /// The factor from this unit to that of `units`.
    ///
    /// # Errors
    /// When one of `units` that it needs is not known.
    pub(super) fn scale_in(&self, units: &Units) -> Result<Scale, SpecError> {
        let mut scale = Some(self.scale);
        let powers = self.dimension.into_iter().enumerate();
        for (axis, power) in powers.filter(|(_, power)| *power != 0) {
            let base = units.base(axis)?.scale.power(-power);
            scale = scale.zip(base).and_then(|(scale, base)| scale.times(base));
        }
        scale.ok_or_else(|| SpecError::whole(format!("{self} is too large or too small a unit")))
    }

    /// The factor from this unit to another; none where both are not of one dimension.
    pub(super) fn scale_to(&self, other: &Self) -> Option<Scale> {
        let same = self.dimension == other.dimension;
        let back = other.scale.power(-1).filter(|_| same)?;
        self.scale.times(back)
    }

    /// The known word, with its power, at the beginning of `rest`, and what stands behind it.
    fn factor<'r>(&self, rest: &'r str) -> Result<([i32; 3], Scale, &'r str), SpecError> {
        let of_word = |c: char| c.is_alphabetic() || c == '%';
        let end = rest.find(|c| !of_word(c)).unwrap_or(rest.len());
        let (word, behind) = rest.split_at(end);
        if word.is_empty() {
            // A quotient may begin with the number 1, as in 1/s.
            return match rest.strip_prefix('1').filter(|_| rest == self.text) {
                Some(behind) => Ok(([0; 3], Scale::ONE, behind)),
                None => Err(self.not_understood()),
            };
        }
        let (dimension, scale) = find(word).ok_or_else(|| unknown(word))?;
        let (power, behind) = power(behind).ok_or_else(|| self.not_understood())?;
        let scale = scale.power(power).ok_or_else(|| self.not_understood())?;
        Ok((dimension.map(|of| of * power), scale, behind))
    }

    fn multiply(&mut self, dimension: [i32; 3], scale: Scale, sign: i32) -> Result<(), SpecError> {
        for (power, of) in self.dimension.iter_mut().zip(dimension) {
            *power += sign * of;
        }
        let product = scale.power(sign).and_then(|scale| self.scale.times(scale));
        self.scale = product.ok_or_else(|| self.not_understood())?;
        Ok(())
    }

    fn not_understood(&self) -> SpecError {
        SpecError::whole(format!("\"{self}\" is not understood as a unit"))
            .help("a unit is written like mm/s, N s2/m or kg")
    }

    fn two_ways(&self) -> SpecError {
        SpecError::whole(format!("\"{self}\" can be read in two ways")).help(
            "write / before every unit below the line, and those above it first: N s/m, 1/m/s",
        )
    }
}

/// The known unit that a word names, with its prefix.
fn find(word: &str) -> Option<([i32; 3], Scale)> {
    if word == "%" {
        return Some(([0; 3], Scale::new(1, -2)));
    }
    // Both signs for a millionth, that of its own and the Greek letter.
    let word = word.replace(['µ', 'μ'], "u");
    let alone = KNOWN.iter().find(|known| known.word == word);
    if let Some(known) = alone {
        return Some((known.dimension, known.scale));
    }
    PREFIXES.iter().find_map(|(prefix, tens)| {
        let word = word.strip_prefix(prefix)?;
        let mut known = KNOWN.iter();
        let known = known.find(|known| known.word == word && known.prefixes.contains(prefix))?;
        Some((known.dimension, known.scale.times(Scale::new(1, *tens))?))
    })
}

/// The power at the beginning of a text, 1 where there is none, and what stands behind it; none for
/// a power that is not understood.
fn power(text: &str) -> Option<(i32, &str)> {
    let marked = text.strip_prefix('^');
    let raised = |c: char| "⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹".contains(c);
    let plain = |c: char| c.is_ascii_digit() || c == '-' || c == '+';
    let of_power: &dyn Fn(char) -> bool = match text.starts_with(raised) {
        true => &raised,
        false => &plain,
    };
    let text = marked.unwrap_or(text);
    let end = text.find(|c| !of_power(c)).unwrap_or(text.len());
    let (digits, behind) = text.split_at(end);
    if digits.is_empty() {
        return marked.is_none().then_some((1, behind));
    }
    let lowered: String = digits.chars().map(lowered).collect();
    let power: i32 = lowered.parse().ok()?;
    let fits = power != 0 && power.abs() <= LARGEST_POWER;
    fits.then_some((power, behind))
}

/// The sign or digit that a raised one stands for.
fn lowered(raised: char) -> char {
    let pairs = "⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹".chars().zip("-+0123456789".chars());
    let found = pairs.into_iter().find(|(of, _)| *of == raised);
    found.map_or(raised, |(_, plain)| plain)
}

/// The words of all known units, with their prefixes.
fn words() -> Vec<String> {
    let of = |known: &Known| {
        let prefixed = known
            .prefixes
            .iter()
            .map(|prefix| format!("{prefix}{}", known.word));
        let alone = std::iter::once(known.word.to_owned());
        alone.chain(prefixed).collect::<Vec<_>>()
    };
    KNOWN.iter().flat_map(of).chain(["%".into()]).collect()
}

fn unknown(word: &str) -> SpecError {
    let words = words();
    let meant = did_you_mean(word, words.iter().map(String::as_str));
    SpecError::whole(format!("no unit \"{word}\" is known here"))
        .help(format!("{meant}known: {}", words.join(", ")))
}

/// What has this dimension, in words: "velocity (length/time)".
pub(super) fn described(dimension: [i32; 3]) -> String {
    let mut named = NAMED.iter();
    match named.find(|(of, ..)| *of == dimension) {
        Some((_, name, "", _)) => (*name).into(),
        Some((_, name, of, _)) => format!("{name} ({of})"),
        None => Units::symbolic().of(dimension),
    }
}

/// A unit of this dimension, as an example.
pub(super) fn example(dimension: [i32; 3]) -> String {
    let mut named = NAMED.iter();
    match named.find(|(of, ..)| *of == dimension) {
        Some((.., unit)) => (*unit).into(),
        None => Units::si().of(dimension),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::setting::Parameter;

    fn in_si(number: &str, unit: &str) -> f64 {
        let unit = Unit::read(unit).unwrap();
        unit.value(number, &Units::si()).unwrap()
    }

    #[test]
    fn units_are_read_in_all_spellings() {
        for (texts, dimension, value) in [
            (
                &["mm/s", "mm s-1", "mm s^-1", "mm·s⁻¹", "mm * s-1"][..],
                [0, 1, -1],
                0.001,
            ),
            (&["N s2/m", "N*s^2/m", "N s²/m", "kg"], [1, -1, 2], 1.0),
            (&["N/mm", "kN/m"], [1, -1, 0], 1e3),
            (&["kg/s", "N s m-1", "N s/m"], [1, -1, 1], 1.0),
            (&["1/ms", "kHz", "ms-1"], [0, 0, -1], 1e3),
            (&["um", "µm", "μm"], [0, 1, 0], 1e-6),
            (&["N/m/s"], [1, -1, -1], 1.0),
            (&["%"], [0, 0, 0], 0.01),
            (&["min/h"], [0, 0, 0], 1.0 / 60.0),
            (&["km/h"], [0, 1, -1], 1.0 / 3.6),
        ] {
            for text in texts {
                assert_eq!(Unit::read(text).unwrap().dimension(), dimension, "{text}");
                assert_eq!(in_si("1", text), value, "{text}");
            }
        }
    }

    #[test]
    fn powers_of_ten_are_exact() {
        for (number, unit, value) in [
            ("1", "mm/s", 0.001),
            ("2.4", "mm", 0.0024),
            ("-5.5", "N/mm", -5500.0),
            ("4.1e2", "g", 0.41),
            ("0.3", "ms", 0.0003),
            ("90", "km/h", 25.0),
            ("0.1", "min", 6.0),
            ("7", "dm", 0.7),
            ("3", "sec", 3.0),
            ("12", "in", 0.3048),
            ("1", "lb", 0.453_592_37),
            ("-.5", "min", -30.0),
            ("+7.e-1", "m", 0.7),
            ("0.1000000000000000000000000000000000000000000001", "m", 0.1),
        ] {
            assert_eq!(in_si(number, unit), value, "{number} {unit}");
        }
        let of_stiffness = in_si("1", "lbf/in") * 0.0254;
        assert!((of_stiffness / 4.448_221_615_260_5 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn numbers_are_turned_into_the_declared_units() {
        let mm = Units::read("N,mm,s").unwrap();
        for (number, unit, value) in [
            ("2.4", "kg", 0.0024),
            ("3", "m/s", 3000.0),
            ("7", "N/mm", 7.0),
            ("7", "kN/m", 7.0),
        ] {
            assert_eq!(Unit::read(unit).unwrap().value(number, &mm).unwrap(), value);
        }
        let metre = Unit::read("m").unwrap();
        for units in ["dimensionless", "bar,m,s", "m,N,s"] {
            let units = Units::read(units).unwrap();
            assert!(metre.value("1", &units).is_err());
            assert_eq!(Unit::read("%").unwrap().value("5", &units), Ok(0.05));
        }
    }

    #[test]
    fn what_is_no_unit_is_told() {
        for (text, says) in [
            ("kgg", "did you mean `kg`?"),
            ("second", "known: N, nN,"),
            ("kg/m s", "above it first"),
            ("m^", "written like"),
            ("m^x", "written like"),
            ("m0", "written like"),
            ("m12", "written like"),
            ("m--2", "written like"),
            ("/s", "written like"),
            ("m/", "written like"),
            ("m//s", "written like"),
            ("m/1", "written like"),
            ("(m)", "written like"),
            ("lbf9", "written like"),
            ("", "written like"),
        ] {
            let help = Unit::read(text).unwrap_err().help.unwrap();
            assert!(help.contains(says), "{text}: {help}");
        }
        let huge = Unit::read("km").unwrap().value("1e307", &Units::si());
        assert!(huge.unwrap_err().message.contains("too large"));
    }

    #[test]
    fn units_of_one_dimension_are_turned_into_one_another() {
        let turned = |number: &str, from: &str, to: &str| {
            let [from, to] = [from, to].map(|unit| Unit::read(unit).unwrap());
            from.scale_to(&to)?.of(number)
        };
        assert_eq!(turned("70", "mN", "N"), Some(0.07));
        assert_eq!(turned("2.5", "lbf", "lbf"), Some(2.5));
        assert_eq!(turned("1", "ft", "in"), Some(12.0));
        assert_eq!(turned("1", "kg", "N"), None);
    }

    proptest! {
        /// A quantity is the same in whatever unit it is written, to the last bit where units
        /// differ by a power of ten.
        #[test]
        fn a_quantity_is_the_same_in_every_unit(
            digits in -1_000_000_i64..1_000_000,
            power in -12_i32..12,
            shift in -12_i32..12,
            system in prop::sample::select(vec!["SI", "N,mm,s", "kN,um,ms", "lbf,in,s"]),
        ) {
            let units = Units::read(system).unwrap();
            let value = |number: &str, unit: &str| {
                Unit::read(unit).unwrap().value(number, &units).unwrap()
            };
            let shifted = |by: i32| format!("{digits}e{}", power + by);
            for (unit, other, tens) in [
                ("m/s", "mm/s", 3),
                ("N/mm", "kN/m", 0),
                ("kg", "t", -3),
                ("kg/s", "N s/um", -6),
                ("1/s", "1/ms", -3),
            ] {
                let [here, there] = [value(&shifted(0), unit), value(&shifted(tens), other)];
                prop_assert_eq!(here, there, "{} {}", unit, other);
            }
            let [minutes, seconds] = [("min", "1"), ("s", "60")].map(|(unit, times)| {
                value(&shifted(shift), unit) * value(times, "1")
            });
            prop_assert!((minutes - seconds).abs() <= 4.0 * f64::EPSILON * minutes.abs());
        }
    }

    /// The unit that is told of each parameter can be typed.
    #[test]
    fn units_of_parameters_are_read_back() {
        for units in ["SI", "N,mm,s", "kN,um,ms"] {
            let units = Units::read(units).unwrap();
            for parameter in Parameter::ALL
                .into_iter()
                .filter(|p| p.dimension() != [0; 3])
            {
                let dimension = parameter.dimension();
                let unit = Unit::read(&units.of_parameter(parameter)).unwrap();
                assert_eq!(unit.dimension(), dimension, "{}", parameter.name());
                assert_eq!(unit.value("2.4", &units), Ok(2.4), "{}", parameter.name());
                let example = Unit::read(&example(dimension)).unwrap();
                assert_eq!(example.dimension(), dimension, "{}", parameter.name());
            }
        }
    }
}
