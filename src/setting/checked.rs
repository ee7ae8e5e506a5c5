//! A setting of named numbers, checked as a file is.

use super::given::GivenParameters;
use super::law_kind::LawKind;
use super::parameter::Parameter;
use super::values::Setting;
use crate::text::SpecError;

impl Setting {
    /// A setting of named numbers, with the checks of a sweep file. What is not given has its
    /// default value; parameters in `varied` need no value, as if they were axes.
    ///
    /// ```
    /// use slipmap::setting::{Parameter, Setting};
    ///
    /// let of = |name, value| Setting::checked([("mu_prime", -0.3), (name, value)], None, &[]);
    /// assert_eq!(of("tau", 4.15).unwrap().get(Parameter::Tau), 4.15);
    /// assert_eq!(of("taw", 4.15).unwrap_err().message, "unknown key `taw`");
    /// ```
    ///
    /// # Errors
    /// In the words of sweep files, without a place: names that are unknown or have no meaning with
    /// the law, numbers out of range, and parameters that are missing.
    pub fn checked<'n>(
        numbers: impl IntoIterator<Item = (&'n str, f64)>,
        law: Option<LawKind>,
        varied: &[Parameter],
    ) -> Result<Self, SpecError> {
        let mut given = GivenParameters::of_law(law);
        let taken = numbers
            .into_iter()
            .try_for_each(|(name, value)| given.take_named(name, value));
        let checked = taken
            .and_then(|()| given.check_start())
            .and_then(|()| given.sliding(varied));
        checked.map_err(|error| SpecError {
            span: None,
            ..error
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::point_file::{PointOf, PointSpec};

    /// Every refusal has the words of the same setting in a file, whose places are left out.
    #[test]
    fn named_numbers_are_refused_in_the_words_of_files() {
        let weakening = || Some(LawKind::named("weakening").unwrap());
        let law = "[friction]\nlaw = \"weakening\"\n";
        for (numbers, law, text) in [
            (
                vec![("tau", -1.0), ("mu_prime", 0.1)],
                None,
                "[fixed]\ntau = -1\nmu_prime = 0.1\n",
            ),
            (vec![("mu_prime", 0.1)], None, "[fixed]\nmu_prime = 0.1\n"),
            (vec![("tau", 1.0)], None, "[fixed]\ntau = 1\n"),
            (
                vec![("tau", 1.0), ("mu_prime", 0.1), ("v0", 1.0)],
                None,
                "[fixed]\ntau = 1\nmu_prime = 0.1\nv0 = 1\n",
            ),
            (
                vec![("tau", 1.0), ("v0", 1.0), ("mu0", 0.5)],
                weakening(),
                &*format!("[fixed]\ntau = 1\nv0 = 1\n{law}mu0 = 0.5\n"),
            ),
            (
                vec![("tau", 1.0), ("v0", 1.0), ("mu0", 2.0), ("v_s", 0.5)],
                weakening(),
                &*format!("[fixed]\ntau = 1\nv0 = 1\n{law}mu0 = 2\nv_s = 0.5\n"),
            ),
        ] {
            let told = Setting::checked(numbers, law, &[]).unwrap_err();
            let expected = PointSpec::read(text, PointOf::Sliding).unwrap_err();
            let expected = SpecError {
                span: None,
                ..expected
            };
            assert_eq!(told, expected, "{text}");
        }
        let twice = [("tau", 1.0), ("tau", 2.0)];
        let told = Setting::checked(twice, None, &[]).unwrap_err();
        assert_eq!(told.message, "tau is given twice");
        let unknown = Setting::checked([("alpha_w", 1.0)], None, &[]).unwrap_err();
        assert!(unknown.help.unwrap().starts_with("did you mean `alpha_v`?"));
        let not_finite = [("tau", f64::NAN), ("mu_prime", 0.1)];
        assert!(Setting::checked(not_finite, None, &[]).is_err());
    }

    #[test]
    fn what_varies_needs_no_value() {
        let law = Some(LawKind::named("coulomb").unwrap());
        let numbers = [("mu0", 0.5), ("alpha_n", -2.0)];
        let varied = [Parameter::Tau, Parameter::V0];
        let setting = Setting::checked(numbers, law.clone(), &varied).unwrap();
        assert_eq!(setting.get(Parameter::AlphaN), -2.0);
        assert!(setting.get(Parameter::V0).is_nan());
        assert!(Setting::checked(numbers, law, &varied[..1]).is_err());
    }
}
