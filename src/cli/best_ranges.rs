//! The flags of `slipmap best` for the ranges that are searched.

use crate::answers::best::Ranges;
use crate::answers::search_plane::SearchPlane;
use crate::setting::Parameter;
use crate::setting::amount::Amount;
use crate::setting::quantity::Quantity;
use crate::text::{Shown, words};

use super::asked::Asked;
use super::failure::Failure;
use super::parameter_values::{amount_of, on_one_line, parse_amount};
use super::sets::given_twice;

#[derive(Debug, clap::Args)]
pub(super) struct RangeArgs {
    /// Smallest gain to search, or smallest value of --search
    #[arg(
        long,
        visible_alias = "search-from",
        allow_hyphen_values = true,
        value_name = "A",
        value_parser = parse_amount
    )]
    alpha_from: Option<Amount>,
    /// Largest gain to search, or largest value of --search
    #[arg(
        long,
        visible_alias = "search-to",
        allow_hyphen_values = true,
        value_name = "A",
        value_parser = parse_amount
    )]
    alpha_to: Option<Amount>,
    /// Shortest delay to search
    #[arg(long, allow_hyphen_values = true, value_name = "T",
          value_parser = amount_of(Parameter::Tau))]
    tau_from: Option<Amount>,
    /// Longest delay to search
    #[arg(long, allow_hyphen_values = true, value_name = "T",
          value_parser = amount_of(Parameter::Tau))]
    tau_to: Option<Amount>,
    /// The range to search of a parameter by its name, in place of the four flags above; once for
    /// each
    #[arg(
        long,
        value_name = "NAME=FROM:TO",
        allow_hyphen_values = true,
        value_parser = parse_range
    )]
    range: Vec<NamedRange>,
}

/// The range of a parameter, as given by the flag.
#[derive(Debug, Clone, PartialEq)]
struct NamedRange {
    name: String,
    from: Amount,
    to: Amount,
}

fn parse_range(text: &str) -> Result<NamedRange, String> {
    let expected = || "expected NAME=FROM:TO, for example k_p=-1:5".to_owned();
    let (name, range) = text.split_once('=').ok_or_else(expected)?;
    let (from, to) = range.split_once(':').ok_or_else(expected)?;
    let amount = |text: &str| {
        let amount = Amount::read(text.trim()).ok_or_else(expected)?;
        let amount = amount.map_err(|error| on_one_line(&error))?;
        amount.is_finite().then_some(amount).ok_or_else(expected)
    };
    Ok(NamedRange {
        name: name.trim().to_owned(),
        from: amount(from)?,
        to: amount(to)?,
    })
}

/// A flag, and the value that it gives.
type Given = (&'static str, Option<f64>);

impl RangeArgs {
    /// The ranges that the flags give, over those searched by `default`.
    pub(super) fn of_plane(
        &self,
        asked: &Asked,
        plane: &SearchPlane,
        default: &Ranges,
    ) -> Result<Ranges, Failure> {
        let tau = plane.has_delay();
        self.check_names(|name| plane.has(name) || (!tau && words::same(name, "tau")))?;
        let of_first = match asked.named {
            None => ["--alpha-from", "--alpha-to"],
            Some(_) => ["--search-from", "--search-to"],
        };
        let first = [&self.alpha_from, &self.alpha_to];
        if let (Some(second), Some(i)) = (plane.second(), first.iter().position(|of| of.is_some()))
        {
            let (flag, one, other) = (of_first[i], plane.p.name(), second.name());
            return Err(Failure::bad_input_with_help(
                format!("{flag}: is it of {one} or of {other}?"),
                format!("--range {one}=FROM:TO --range {other}=FROM:TO"),
            ));
        }
        let p = self.range(asked, &plane.p, of_first, first, default.p)?;
        let q = match tau {
            true => self.of_delay(asked, default.q)?,
            false => self.range(asked, &plane.q, ["--range"; 2], [&None, &None], default.q)?,
        };
        Ok(Ranges { p, q })
    }

    /// The range of delays that the flags give, over that by `default`.
    pub(super) fn of_delay(
        &self,
        asked: &Asked,
        default: (f64, f64),
    ) -> Result<(f64, f64), Failure> {
        let flags = ["--tau-from", "--tau-to"];
        let ends = [&self.tau_from, &self.tau_to];
        self.range(asked, &Parameter::Tau.into(), flags, ends, default)
    }

    /// Whether a range of delays is given.
    pub(super) fn has_delay(&self) -> bool {
        let named = self.range.iter().any(|of| words::same(&of.name, "tau"));
        named || self.tau_from.is_some() || self.tau_to.is_some()
    }

    fn check_names(&self, searched: impl Fn(&str) -> bool) -> Result<(), Failure> {
        for (i, NamedRange { name, .. }) in self.range.iter().enumerate() {
            if self.range[..i]
                .iter()
                .any(|before| words::same(&before.name, name))
            {
                return Err(given_twice(&format!("--range {name}")));
            }
            if !searched(name) {
                return Err(Failure::bad_input_with_help(
                    format!("--range {name}: {name} is not searched"),
                    "--search names the parameters of a system that are searched",
                ));
            }
        }
        Ok(())
    }

    /// The range of a parameter that `--range` or one of two flags give, with the ends of `default`
    /// where they give none.
    fn range(
        &self,
        asked: &Asked,
        of: &Quantity,
        flags: [&'static str; 2],
        ends: [&Option<Amount>; 2],
        default: (f64, f64),
    ) -> Result<(f64, f64), Failure> {
        let value = |i: usize| {
            let given = ends[i].as_ref();
            let value = given.map(|end| asked.value(of, flags[i], end));
            Ok::<Given, Failure>((flags[i], value.transpose()?))
        };
        let named = |range: &&NamedRange| words::same(&range.name, of.name());
        let Some(named) = self.range.iter().find(named) else {
            return ordered([value(0)?, value(1)?], default);
        };
        if let Some(i) = ends.iter().position(|end| end.is_some()) {
            return Err(Failure::bad_input_with_help(
                format!("{} and --range {} give the same", flags[i], named.name),
                "give one of them",
            ));
        }
        let value = |end: &Amount| asked.value(of, "--range", end);
        let ends = [&named.from, &named.to].map(|end| Ok(("--range", Some(value(end)?))));
        let [from, to]: [Result<Given, Failure>; 2] = ends;
        ordered([from?, to?], default)
    }
}

/// The range between the ends that two flags give, or those of `default`.
fn ordered([from, to]: [Given; 2], default: (f64, f64)) -> Result<(f64, f64), Failure> {
    let ((from_flag, from), (to_flag, to)) = (from, to);
    let (low, high) = (from.unwrap_or(default.0), to.unwrap_or(default.1));
    if low <= high {
        return Ok((low, high));
    }
    if from_flag == to_flag {
        let (low, high) = (Shown(low), Shown(high));
        return Err(Failure::bad_input_with_help(
            format!("{from_flag} from {low} is above its end {high}"),
            format!("{from_flag} NAME={high}:{low}"),
        ));
    }
    let origin = |given: Option<f64>| given.map_or(", its default", |_| "");
    Err(Failure::bad_input_with_help(
        format!(
            "{from_flag} {}{} is above {to_flag} {}{}",
            Shown(low),
            origin(from),
            Shown(high),
            origin(to)
        ),
        format!("{from_flag} must be at most {to_flag}"),
    ))
}
