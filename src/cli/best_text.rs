//! What `slipmap best` prints for people.

use std::io::Write;

use slipmap::linear::best::Optimum;
use slipmap::report::numbers::{counted, rounded, unit_behind};
use slipmap::sweep::cells::best::BestSettings;
use slipmap::sweep::input::units::Units;
use slipmap::sweep::{Field, Parameter};

use super::failure::Failure;
use super::output::tell_dimensionless;
use super::recommended::{Control, Recommended};
use super::{margins, vc};

/// A number with as many digits as a person can use.
pub(super) fn short(value: f64) -> String {
    rounded(value, 8)
}

/// What is told where nothing is stable, or where it is not known how fast anything decays.
pub(super) fn nothing_decays(stable: bool) -> &'static str {
    match stable {
        false => "no stable setting in the ranges; the least unstable one is",
        true => "stable settings, but it is not known how fast disturbances decay; one of them is",
    }
}

/// An abscissa in words.
pub(super) fn abscissa_of(best: &Optimum, unit: &str) -> String {
    match best.abscissa.is_finite() {
        true => format!("{}{unit}", short(best.abscissa)),
        false => "not known".into(),
    }
}

/// The lowest frequency of an optimum in words; "none" where its roots have none, because they
/// accumulate.
pub(super) fn frequency_of(best: &Optimum, unit: &str) -> String {
    match best.frequencies.is_empty() {
        true => "none".into(),
        false => format!("{}{unit}", short(best.frequency())),
    }
}

pub(super) fn print(
    out: &mut impl Write,
    told: &Recommended,
    units: &Units,
) -> Result<(), Failure> {
    let (setting, found, ranges) = (&told.setting, &told.found, &told.ranges);
    if let Some(spread) = told.spread {
        print_robust(out, spread, told, units)?;
    }
    let best = &found.overall;
    let time = unit_behind(&units.time());
    match best.relaxation_time() {
        Some(relaxation) => writeln!(
            out,
            "sliding relaxes fastest, with the relaxation time {}{time}, at",
            short(relaxation)
        )?,
        None => writeln!(out, "{}", nothing_decays(!found.regions.is_empty()))?,
    }
    let (searched, other) = match told.control {
        Control::Velocity => (Parameter::AlphaV, Parameter::AlphaN),
        Control::Load => (Parameter::AlphaN, Parameter::AlphaV),
    };
    let sliding = setting.sliding_point()?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    let of = |parameter: Parameter| unit_behind(&units.of_parameter(parameter));
    let with = |parameter: Parameter, value: f64| format!("{}{}", short(value), of(parameter));
    row(searched.name(), with(searched, best.gain))?;
    row("tau", with(Parameter::Tau, best.tau))?;
    let unit = |field: Field| unit_behind(&field.unit(units));
    row(
        Field::Abscissa.name(),
        abscissa_of(best, &unit(Field::Abscissa)),
    )?;
    row(
        Field::Frequency.name(),
        frequency_of(best, &unit(Field::Frequency)),
    )?;
    row("kind", best.kind.name().into())?;
    row(
        "certified",
        if best.certified { "yes" } else { "no" }.into(),
    )?;
    row("mu_prime", with(Parameter::MuPrime, sliding.mu_prime))?;
    row("mu_k", short(sliding.mu_k))?;
    row(other.name(), with(other, setting.get(other)))?;
    let range = |(from, to): (f64, f64), unit: &str| {
        format!("{}{unit} to {}{unit}", short(from), short(to))
    };
    row(
        "searched",
        format!(
            "{} {}, tau {}",
            searched.name(),
            range(ranges.gain, &of(searched)),
            range(ranges.tau, &time)
        ),
    )?;
    tell_dimensionless(out, units)?;
    print_regions_of(out, searched, found, units)?;
    print_recommended(out, told, units)
}

/// The robust setting, beside what the best one is worth within the same spread.
fn print_robust(
    out: &mut impl Write,
    spread: f64,
    told: &Recommended,
    units: &Units,
) -> Result<(), Failure> {
    let percent = 100.0 * spread;
    let Some(of) = &told.robust else {
        let none = "no setting found in the ranges stays stable when gain, delay and mu_prime may \
                    each be off by";
        return Ok(writeln!(out, "{none} {percent} %")?);
    };
    let unit = |parameter: Parameter| unit_behind(&units.of_parameter(parameter));
    let rate = unit_behind(&units.rate());
    let searched = told.control.parameter();
    let lost = |worst: f64, abscissa: f64| match worst < 0.0 {
        true => format!("{:.1} % slower", 100.0 * (1.0 - worst / abscissa)),
        false => "unstable".into(),
    };
    writeln!(
        out,
        "when gain, delay and mu_prime may each be off by {percent} %, sliding relaxes fastest at"
    )?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    let found = &of.robust;
    row(
        searched.name(),
        format!("{}{}", short(found.gain), unit(searched)),
    )?;
    row(
        "tau",
        format!("{}{}", short(found.tau), unit(Parameter::Tau)),
    )?;
    row("abscissa", format!("{}{rate}", short(found.abscissa)))?;
    let worst = format!(
        "{}{rate} within the spread, {}",
        short(found.worst_abscissa),
        lost(found.worst_abscissa, found.abscissa)
    );
    row("worst_abscissa", worst)?;
    row(
        "certified",
        if found.certified { "yes" } else { "no" }.into(),
    )?;
    let (worst, _) = of.worst_of_best;
    let of_best = format!(
        "{}{rate} within the spread, {}",
        short(worst),
        lost(worst, told.found.overall.abscissa)
    );
    row("best setting", of_best)?;
    Ok(())
}

/// Margins of the setting that is recommended, and v_c where there is a friction law.
fn print_recommended(
    out: &mut impl Write,
    told: &Recommended,
    units: &Units,
) -> Result<(), Failure> {
    let which = if told.robust.is_some() {
        "robust"
    } else {
        "best"
    };
    writeln!(out, "at the {which} setting")?;
    let found = (&told.margins, told.unstable_roots);
    margins::print(out, found, &told.setting, units)?;
    match &told.vc {
        Some(found) => vc::print_short(out, found, units),
        None => Ok(()),
    }
}

/// One line for each stable region of the block on its spring, with units where there are any.
fn print_regions_of(
    out: &mut impl Write,
    searched: Parameter,
    found: &BestSettings,
    units: &Units,
) -> std::io::Result<()> {
    let optima = found.regions.iter().map(|region| &region.best);
    let (gain, tau) = (units.of_parameter(searched), units.time());
    let columns = [&*gain, &*tau, &*tau, &*units.angular_frequency(), "", ""];
    let columns = (!units.dimensionless()).then_some(columns);
    print_regions(
        out,
        (searched.name(), columns),
        optima,
        found.regions_left_out,
    )
}

/// One line for each stable region, with its best setting; nothing without regions. What is
/// searched beside the delay has a name, and the columns have units where there are any.
pub(super) fn print_regions<'o>(
    out: &mut impl Write,
    (name, units): (&str, Option<[&str; 6]>),
    optima: impl Iterator<Item = &'o Optimum>,
    left_out: usize,
) -> std::io::Result<()> {
    let mut optima = optima.peekable();
    if optima.peek().is_none() {
        return Ok(());
    }
    writeln!(out, "the best setting of every stable region, by delay")?;
    let mut line = |cells: [&str; 6]| {
        let [value, tau, time, frequency, certified, kind] = cells;
        let text =
            format!("  {value:>14} {tau:>14} {time:>15} {frequency:>14} {certified:>9}  {kind}");
        writeln!(out, "{}", text.trim_end())
    };
    line([
        name,
        "tau",
        "relaxation_time",
        "frequency",
        "certified",
        "kind",
    ])?;
    units.map_or(Ok(()), &mut line)?;
    for best in optima {
        let time = best.relaxation_time().map_or("none".into(), short);
        line([
            &short(best.gain),
            &short(best.tau),
            &time,
            &frequency_of(best, ""),
            if best.certified { "yes" } else { "no" },
            best.kind.name(),
        ])?;
    }
    match left_out {
        0 => Ok(()),
        more => writeln!(
            out,
            "  and {} more, not searched or with decay within rounding",
            counted(more as u64, "region")
        ),
    }
}
