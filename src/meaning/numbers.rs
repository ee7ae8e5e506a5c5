//! Numbers and units as read in pictures and on the page.

use crate::model::elementary::power;

/// The unit in brackets; empty for dimensionless quantities.
pub(crate) fn suffix(unit: &str, open: &str, close: &str) -> String {
    if unit == "1" || unit.is_empty() {
        return String::new();
    }
    format!("{open}{}{close}", typeset_unit(unit))
}

/// "kg m2 s-1" as "kg m² s⁻¹".
fn typeset_unit(unit: &str) -> String {
    let raise = |c: char| match c {
        '-' => '⁻',
        c => superscript(c),
    };
    unit.chars().map(raise).collect()
}

fn superscript(digit: char) -> char {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let value = digit.to_digit(10).and_then(|d| RAISED.get(d as usize));
    value.copied().unwrap_or(digit)
}

/// A number with at most six digits and a real minus sign.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        let sign = if value < 0.0 { "−" } else { "" };
        return if value.is_nan() {
            "no value".into()
        } else {
            format!("{sign}∞")
        };
    }
    let exponent = decimal_exponent(value);
    if (-4..6).contains(&exponent) {
        let decimals = usize::try_from(5 - exponent).unwrap_or(0);
        return with_minus(trimmed(&format!("{value:.decimals$}")));
    }
    let text = format!("{value:.5e}");
    let mantissa = text.split('e').next().unwrap_or_default();
    with_power(trimmed(mantissa), exponent)
}

/// A number with `decimals` digits after the point, divided by a power of ten that follows it.
pub(crate) fn tick_number(value: f64, decimals: usize, exponent: Option<i32>) -> String {
    match exponent {
        None => with_minus(&format!("{value:.decimals$}")),
        Some(_) if value == 0.0 => "0".into(),
        Some(exponent) => with_power(
            &format!("{:.decimals$}", value / power(10.0, exponent)),
            exponent,
        ),
    }
}

/// The power of ten of the first digit, after rounding to six digits.
pub(crate) fn decimal_exponent(value: f64) -> i32 {
    let text = format!("{value:.5e}");
    let exponent = text.split_once('e').and_then(|(_, e)| e.parse().ok());
    exponent.unwrap_or(0)
}

/// 10⁻³, with a factor where it is not 1.
fn with_power(mantissa: &str, exponent: i32) -> String {
    let power = typeset_unit(&exponent.to_string());
    match mantissa {
        "1" => format!("10{power}"),
        _ => format!("{} × 10{power}", with_minus(mantissa)),
    }
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

/// The text of a number with a minus sign in the place of hyphens; zero has none.
pub(crate) fn with_minus(text: &str) -> String {
    let zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if zero {
        text.trim_start_matches('-').to_owned()
    } else {
        text.replace('-', "−")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_have_a_minus_sign() {
        for (value, text) in [
            (-0.3, "−0.3"),
            (0.1 + 0.2, "0.3"),
            (12.0, "12"),
            (123_456.0, "123456"),
            (1e-9, "10⁻⁹"),
            (-2.5e12, "−2.5 × 10¹²"),
            (999_999.9, "10⁶"),
            (0.0, "0"),
            (f64::NEG_INFINITY, "−∞"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!(tick_number(-0.0, 1, None), "0.0");
        assert_eq!(tick_number(-2e-7, 0, Some(-7)), "−2 × 10⁻⁷");
    }

    #[test]
    fn units_are_typeset_and_left_out_where_there_is_none() {
        assert_eq!(suffix("N m-1", " (", ")"), " (N m⁻¹)");
        assert_eq!(suffix("1", " (", ")"), "");
    }
}
