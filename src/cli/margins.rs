//! `slipmap margins`: how far a setting is from the boundary of stability.

use std::io::Write;

use crate::explore::margins::{Margins, StabilityBox, StableShare};
use crate::explore::point::Point;
use crate::explore::stability::{Stability, Wanted};
use crate::model::stop::Stop;
use crate::report::numbers::{counted, rounded, unit_behind};
use crate::setting::amount::Amount;
use crate::setting::law_kind::LawKind;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::{Shown, finite};

use super::asked::{Asked, subject};
use super::failure::Failure;
use super::inputs_line;
use super::json::{self, AnswerSchema};
use super::loop_args::LoopArgs;
use super::margin_words::{Crossings, along, between, known, up_to};
use super::output::tell_dimensionless;
use super::parameter_values::{amount_of, in_units};
use super::point_args::PointArgs;
use super::say::ForPeople;
use super::system_args::{OTHERS, SystemArgs};

#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: slipmap margins --mu-prime -0.3 --alpha-n -3.65 --tau 0.465 --decay 0.1"
)]
pub(super) struct Args {
    #[command(flatten)]
    point: PointArgs,
    #[command(flatten)]
    system: SystemArgs,
    /// The decay rate that all roots have to have, 1/time; 0 asks for stability
    #[arg(long, value_name = "RATE", default_value = "0", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::AlphaV))]
    decay: Amount,
    #[command(flatten)]
    pictures: LoopArgs,
    /// One JSON object on standard output; infinities are null
    #[arg(long)]
    json: bool,
}

/// The largest decay rate that can be asked for.
const LARGEST_DECAY: f64 = 1e12;

/// What its JSON looks like.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("margins").or::<Margins>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    args.pictures.check(args.point.map())?;
    let asked = args.asked()?;
    let setting = &asked.setting;
    let decay = args.decay(&asked.units)?;
    if setting.system().is_some() && decay > 0.0 {
        return Err(Failure::bad_input_with_help(
            "--decay: margins of a system from a file are those of stability alone",
            "leave --decay out; slipmap point --line counts the roots right of a line",
        ));
    }
    let Some(margins) = Margins::at(setting, decay, &Stop::default())? else {
        let of = setting.law().map_or("friction", LawKind::name);
        return Err(Failure::bad_input_with_help(
            format!("margins of the {of} law are not known: a law of the velocity alone is needed"),
            "slipmap point gives its delay margin and, with --json, its latency margin",
        ));
    };
    if args.json {
        let inputs = asked.inputs(|_| true).and("decay", decay);
        json::print(&inputs, &margins)?;
        return args.pictures.draw(&asked, &margins, args.json);
    }
    let wanted = Wanted {
        roots: 1,
        line: Some(-decay).filter(|line| *line < 0.0),
    };
    let violations = match margins.decays {
        true => None,
        false => violations(Point::at(setting, wanted, &Stop::default())?.stability()),
    };
    let mut out = ForPeople::begin();
    inputs_line::print(&mut out, setting, &asked.units, &[])?;
    print(&mut out, &margins, violations, setting, &asked.units)?;
    args.pictures.draw(&asked, &margins, args.json)
}

impl Args {
    /// The setting of the block, or of a system from a file.
    fn asked(&self) -> Result<Asked, Failure> {
        let of_system = match &self.system.system {
            Some(_) => {
                self.point.check_alone("--system", &OTHERS)?;
                let (sets, units) = (self.point.sets(), self.point.units());
                self.system
                    .read(sets, &units, None, |p| self.point.given(p))?
            }
            None => self.point.cell_of_system()?,
        };
        match of_system {
            Some(asked) => Ok(asked),
            None => self.point.read(),
        }
    }

    /// The required decay rate in `units`.
    fn decay(&self, units: &Units) -> Result<f64, Failure> {
        let decay = in_units("--decay", &self.decay, units)?;
        if (0.0..=LARGEST_DECAY).contains(&decay) {
            return Ok(decay);
        }
        let message = format!("--decay {} is outside its range", Shown(decay));
        Err(Failure::bad_input_with_help(
            message,
            "a decay rate, from 0 to 1e12",
        ))
    }
}

/// The number of roots on the wrong side: of the line, where one is asked for, else of the
/// imaginary axis. None where that is not known, or within rounding of a boundary.
pub(super) fn violations(stability: &Stability) -> Option<u64> {
    let known = match stability.line {
        Some(_) => stability.n_right_of_line,
        None => stability.n_unstable.filter(|_| !stability.marginal),
    };
    known.filter(|count| *count > 0)
}

/// Why there are no margins: the number of roots on the wrong side, if it is known.
fn without_margins((margins, of): (&Margins, &str), violations: Option<u64>, rate: &str) -> String {
    let required = margins.required_decay;
    let decay = Shown(required);
    let why = match violations.map(|n| counted(n, "root")) {
        Some(roots) if required == 0.0 => format!("unstable ({roots})"),
        Some(roots) => {
            format!("not left of -{decay}{rate} with all its roots ({roots} right of it)")
        }
        None if required == 0.0 => "not known to be stable".to_owned(),
        None => format!("not known to be left of -{decay}{rate} with all its roots"),
    };
    format!("{of} is {why}: no margins")
}

/// The margins in lines of words and numbers; without margins the number of roots that forbid them.
pub(super) fn print(
    out: &mut impl Write,
    margins: &Margins,
    violations: Option<u64>,
    setting: &Setting,
    units: &Units,
) -> std::io::Result<()> {
    let rate = unit_behind(&units.rate());
    let of = subject(setting, "continuous sliding");
    if !margins.decays {
        writeln!(out, "{}", without_margins((margins, of), violations, &rate))?;
        return match &margins.fit {
            Some(fit) => writeln!(out, "  {:<16} {}", "fit", of_fit(fit, margins, units)),
            None => Ok(()),
        };
    }
    let wanted = match margins.required_decay {
        0.0 => "stable".to_owned(),
        decay => format!("left of -{}{rate} with all its roots", Shown(decay)),
    };
    writeln!(out, "{of} is {wanted}; it stays so")?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    let unknown = not_known_of(setting);
    print_gain(&mut row, margins, units, unknown)?;
    print_along(&mut row, margins, setting, units)?;
    print_loop(&mut row, margins, units, unknown)?;
    if let Some(found) = &margins.stability_box {
        let of = of_what_is_given(setting);
        let told = match margins.stability_radius.is_nan() {
            true => "not decided".into(),
            false => radius(margins.stability_radius, found, of),
        };
        row("stability_radius", told)?;
    }
    if let Some(fit) = &margins.fit {
        row("fit", of_fit(fit, margins, units))?;
    }
    match setting.system() {
        Some(_) => Ok(()),
        None => tell_dimensionless(out, units),
    }
}

/// The gain margin, `unknown` being what it is not known of.
fn print_gain(
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
    margins: &Margins,
    units: &Units,
    unknown: Option<&str>,
) -> std::io::Result<()> {
    const NAME: &str = "gain_margin";
    let Some(gain) = margins.gain_margin else {
        return match unknown {
            Some(of) => row(NAME, format!("not known of {of}")),
            None if margins.undecided.contains(&NAME) => row(NAME, "not decided".to_owned()),
            None => Ok(()),
        };
    };
    let lower = match gain.lower > 0.0 {
        true => gain.lower,
        false => f64::NAN,
    };
    let text = match (lower, gain.upper) {
        ends if margins.undecided.contains(&NAME) => known(ends, " times as large"),
        (lower, upper) => between(lower, upper, " times as large"),
    };
    let text = text + &Crossings(units).both(margins.crossing_frequencies.gain_margin);
    row(
        NAME,
        text + &up_to(margins.looked_up_to.gain_margin, " times"),
    )
}

/// The margins of the delay, and of the slope or the velocity.
fn print_along(
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
    margins: &Margins,
    setting: &Setting,
    units: &Units,
) -> std::io::Result<()> {
    if setting.system().is_some() && margins.tau_margin.is_none() {
        let why = match setting.has_lines() {
            true => "not decided",
            false => "not known: the system is another one at other delays",
        };
        row("tau_margin", why.to_owned())?;
    }
    let (last, omegas) = (&margins.looked_up_to, &margins.crossing_frequencies);
    let slope = margins.mu_prime_margin;
    for (parameter, margin, last, omegas) in [
        (
            Parameter::Tau,
            margins.tau_margin,
            last.tau_margin,
            omegas.tau_margin,
        ),
        (Parameter::MuPrime, slope, f64::NAN, omegas.mu_prime_margin),
        (
            Parameter::V0,
            margins.v0_margin,
            last.v0_margin,
            omegas.v0_margin,
        ),
    ] {
        let Some(margin) = margin else { continue };
        let name = format!("{}_margin", parameter.name());
        let unit = unit_behind(&units.of_parameter(parameter));
        let text = match margins.undecided.contains(&&*name) {
            true => known((margin.from, margin.to), &unit),
            false => along(&margin, setting.get(parameter), &unit) + &Crossings(units).both(omegas),
        };
        row(&name, text + &up_to(last, &unit))?;
    }
    Ok(())
}

/// What a setting is of which some margins are not known; none of all others.
fn not_known_of(setting: &Setting) -> Option<&'static str> {
    match setting.system() {
        Some(_) => setting.without_curves(),
        None => setting.feedback().is_sampled().then_some("a digital loop"),
    }
}

/// The phase margin, the latency margin and the modulus margin, `unknown` being what they are not
/// known of.
fn print_loop(
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
    margins: &Margins,
    units: &Units,
    unknown: Option<&str>,
) -> std::io::Result<()> {
    let time = unit_behind(&units.time());
    let last = margins.looked_up_to.latency_margin;
    let (at, omegas) = (Crossings(units), &margins.crossing_frequencies);
    for (name, value, omega, unit, endless) in [
        (
            "phase_margin",
            margins.phase_margin,
            omegas.phase_margin,
            " rad",
            "infinite: the loop is nowhere as large as 1",
        ),
        (
            "latency_margin",
            margins.latency_margin,
            omegas.latency_margin,
            &*time,
            "infinite: no latency matters",
        ),
        (
            "modulus_margin",
            margins.modulus_margin,
            omegas.modulus_margin,
            "",
            "not known",
        ),
    ] {
        let text = match (finite(value), unknown) {
            (None, Some(of)) if margins.undecided.contains(&name) => format!("not known of {of}"),
            _ if margins.undecided.contains(&name) => "not decided".into(),
            (Some(value), _) => format!("{}{unit}{}", rounded(value, 8), at.one(omega)),
            (None, _) if name == "latency_margin" && last.is_finite() => {
                format!("no latency matters{}", up_to(last, unit))
            }
            (None, _) => endless.to_owned(),
        };
        row(name, text)?;
    }
    Ok(())
}

/// What the errors of a fitted law leave open.
pub(super) fn of_fit(fit: &StableShare, margins: &Margins, units: &Units) -> String {
    let has = match margins.required_decay {
        0.0 => "stable",
        _ => "so",
    };
    let (rate, slope) = (units.rate(), units.of_parameter(Parameter::MuPrime));
    let mut text = format!(
        "{has} for {} % of {} friction laws that the points allow; the worst, with mu_prime = \
         {}{}, has abscissa {}{}",
        rounded(100.0 * fit.share, 3),
        fit.draws,
        rounded(fit.worst_mu_prime, 4),
        unit_behind(&slope),
        rounded(fit.worst_abscissa, 4),
        unit_behind(&rate),
    );
    if fit.unknown > 0 {
        text += &format!("; of {} it is not known", fit.unknown);
    }
    text
}

/// Of what friction something is proved, behind that.
pub(super) fn of_what_is_given(setting: &Setting) -> &'static str {
    match setting.law() {
        None => "",
        Some(LawKind::Table(_)) => " of the curve that was given",
        Some(_) => " of the friction law that was given",
    }
}

fn radius(proved: f64, found: &StabilityBox, of: &str) -> String {
    let names = found.of.join(", ");
    let together = if found.of.len() > 1 { " together" } else { "" };
    // Rounded down: more is not proved.
    let percent = (1.0 - 5e-4) * 100.0 * proved;
    let mut text = format!("{} %: {names}{together}, proved{of}", rounded(percent, 3));
    if !found.tight {
        text += "; there may be more";
    }
    if !found.fixed.is_empty() {
        text += &format!("; 0 stays 0: {}", found.fixed.join(", "));
    }
    text
}
