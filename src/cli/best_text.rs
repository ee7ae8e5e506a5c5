//! What `slipmap best` prints for people.

use std::io::Write;

use crate::answers::robust_to_fit::MOST_ERRORS;
use crate::explore::best::{Control, Recommended};
use crate::explore::point::{BlockPoint, Point, SystemPoint};
use crate::explore::robust::MayBeOff;
use crate::linear::best::Optimum;
use crate::report::numbers::{counted, rounded, unit_behind};
use crate::setting::quantity::Quantity;
use crate::setting::{Field, Parameter};
use crate::text::finite;

use super::asked::{speed_at, subject};
use super::margins;
use super::margins::of_what_is_given;
use super::output::tell_dimensionless;
use super::vc_text::VcText;

/// A number with as many digits as a person can use.
fn short(value: f64) -> String {
    rounded(value, 8)
}

/// What is told where nothing is stable, or where it is not known how fast anything decays.
fn nothing_decays(stable: bool) -> &'static str {
    match stable {
        false => "no stable setting in the ranges; the least unstable one is",
        true => "stable settings, but it is not known how fast disturbances decay; one of them is",
    }
}

/// An abscissa in words.
fn abscissa_of(best: &Optimum, unit: &str) -> String {
    match best.abscissa.is_finite() {
        true => format!("{}{unit}", short(best.abscissa)),
        false => "not known".into(),
    }
}

/// The lowest frequency of an optimum in words; "none" where its roots have none, because they
/// accumulate.
fn frequency_of(best: &Optimum, unit: &str) -> String {
    match best.frequencies.is_empty() {
        true => "none".into(),
        false => format!("{}{unit}", short(best.frequency())),
    }
}

fn yes_or_no(certified: bool) -> &'static str {
    if certified { "yes" } else { "no" }
}

/// Prints what was found for people.
pub(super) fn print(out: &mut impl Write, told: &Recommended) -> std::io::Result<()> {
    let Recommended { units, found, .. } = told;
    if let Some(may_be_off) = told.may_be_off {
        print_robust(out, may_be_off, told)?;
    }
    let best = &found.overall;
    let time = unit_behind(&units.time());
    let subject = subject(&told.setting, "sliding");
    if let Some(relaxation) = best.relaxation_time().map(short) {
        let relaxes = "relaxes fastest, with the relaxation time";
        writeln!(out, "{subject} {relaxes} {relaxation}{time}, at")?;
    } else {
        let has = match &told.point {
            Point::Block(_) => String::new(),
            Point::System(_) => format!("{subject} has "),
        };
        writeln!(out, "{has}{}", nothing_decays(!found.regions.is_empty()))?;
    }
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    print_place(told, &mut row)?;
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
    row("certified", yes_or_no(best.certified).into())?;
    match &told.point {
        Point::Block(point) => print_block(point, told, &mut row)?,
        Point::System(point) => print_system(point, told, &mut row)?,
    }
    row("searched", ranges_of(told))?;
    let Point::Block(point) = &told.point else {
        return print_regions(out, told);
    };
    tell_dimensionless(out, units)?;
    print_regions(out, told)?;
    print_recommended(out, told, point)
}

/// What was searched, at its best.
fn print_place(
    told: &Recommended,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let (units, searched, best) = (&told.units, &told.searched, &told.found.overall);
    let with_unit = |of: &Quantity, value: f64| short(value) + &unit_behind(&of.unit(units));
    row(searched.p.name(), with_unit(&searched.p, best.p))?;
    if let Some(second) = searched.second() {
        row(second.name(), with_unit(second, best.q))?;
    }
    let tau = match searched.has_delay() {
        true => best.q,
        false => told.setting.get(Parameter::Tau),
    };
    row("tau", short(tau) + &unit_behind(&units.time()))?;
    match speed_at(&told.setting, units, tau) {
        Some((name, speed, unit)) => row(name, format!("{} {unit}", short(speed))),
        None => Ok(()),
    }
}

/// The ranges of the search in words.
fn ranges_of(told: &Recommended) -> String {
    let (searched, ranges) = (&told.searched, &told.ranges);
    let range = |of: &Quantity, (from, to): (f64, f64)| {
        let unit = unit_behind(&of.unit(&told.units));
        let (name, from, to) = (of.name(), short(from), short(to));
        format!("{name} {from}{unit} to {to}{unit}")
    };
    let plane = [range(&searched.p, ranges.p), range(&searched.q, ranges.q)];
    let delays = told
        .delays
        .map(|delays| range(&Parameter::Tau.into(), delays));
    let all: Vec<String> = plane.into_iter().chain(delays).collect();
    all.join(", ")
}

/// What is told of the block besides its optimum.
fn print_block(
    point: &BlockPoint,
    told: &Recommended,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let units = &told.units;
    let with = |parameter: Parameter, value: f64| {
        format!(
            "{}{}",
            short(value),
            unit_behind(&units.of_parameter(parameter))
        )
    };
    row("mu_prime", with(Parameter::MuPrime, point.mu_prime))?;
    row("mu_k", short(point.mu_k))?;
    let (other, value) = match Control::of(&told.searched.p) {
        Control::Velocity => (Parameter::AlphaN, point.alpha_n),
        Control::Load => (Parameter::AlphaV, point.alpha_v),
    };
    row(other.name(), with(other, value))
}

/// What is told of a system from a file besides its optimum.
fn print_system(
    point: &SystemPoint,
    told: &Recommended,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let units = &told.units;
    let time = unit_behind(&units.time());
    let searched = |name: &str| told.searched.has(name);
    for (own, value) in told.setting.own().filter(|(own, _)| !searched(&own.name)) {
        row(&own.name, short(value) + &unit_behind(&own.unit))?;
    }
    for (parameter, value) in [
        (Parameter::Memory, point.memory),
        (Parameter::Latency, point.latency),
    ] {
        if let Some(value) = value.filter(|_| !searched(parameter.name())) {
            let unit = unit_behind(&units.of_parameter(parameter));
            row(parameter.name(), short(value) + &unit)?;
        }
    }
    if let Some(margin) = finite(point.stability.delay_margin) {
        row("delay_margin", short(margin) + &time)?;
    }
    if point.memory.is_none() {
        return Ok(());
    }
    let margin = finite(point.latency_margin).map(|margin| short(margin) + &time);
    let margin = margin.unwrap_or_else(|| "infinite, or not known".into());
    row("latency_margin", margin)
}

/// The robust setting, beside what the best one is worth within the same spread.
fn print_robust(
    out: &mut impl Write,
    may_be_off: MayBeOff,
    told: &Recommended,
) -> std::io::Result<()> {
    let off = what_is_off(may_be_off);
    let Some(of) = &told.robust else {
        return writeln!(
            out,
            "no setting found in the ranges stays stable when {off}"
        );
    };
    let units = &told.units;
    let (rate, time) = (unit_behind(&units.rate()), unit_behind(&units.time()));
    let within = |worst: f64, abscissa: f64| {
        if worst.is_infinite() {
            return "not known within the spread".into();
        }
        let lost = match worst < 0.0 {
            true if abscissa.is_infinite() => String::new(),
            true => format!(", {:.1} % slower", 100.0 * (1.0 - worst / abscissa)),
            false => ", unstable".into(),
        };
        format!("{}{rate} within the spread{lost}", short(worst))
    };
    writeln!(out, "when {off}, sliding relaxes fastest at")?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    let found = &of.robust;
    row(
        told.searched.p.name(),
        short(found.gain) + &unit_behind(&told.searched.p.unit(&told.units)),
    )?;
    row("tau", short(found.tau) + &time)?;
    let abscissa = match found.abscissa.is_finite() {
        true => short(found.abscissa) + &rate,
        false => "not known".into(),
    };
    row("abscissa", abscissa)?;
    row(
        "worst_abscissa",
        within(found.worst_abscissa, found.abscissa),
    )?;
    let certified = match found.certified {
        true if told.setting.law().is_some() => {
            format!("yes, proved{}", of_what_is_given(&told.setting))
        }
        certified => yes_or_no(certified).to_owned(),
    };
    row("certified", certified)?;
    let (worst, _) = of.worst_of_best;
    row("best setting", within(worst, told.found.overall.abscissa))
}

/// What may be off at a robust setting, in words.
fn what_is_off(of: MayBeOff) -> String {
    let percent = |part: f64| format!("{} %", rounded(100.0 * part, 2));
    match of {
        MayBeOff::Part(part) => format!(
            "gain, delay and mu_prime may each be off by {} %",
            100.0 * part
        ),
        MayBeOff::Errors(errors, [gain, _, slope]) => {
            let mu_k = match gain > 0.0 {
                true => format!(" and mu_k by {}", percent(gain)),
                false => String::new(),
            };
            let most = match errors < MOST_ERRORS {
                true => ", the most that a setting stands",
                false => "",
            };
            format!(
                "mu_prime may be off by {}{mu_k}, {} standard errors of the fit{most}",
                percent(slope),
                rounded(errors, 2),
            )
        }
    }
}

/// Margins of the setting that is recommended, and v_c where there is a friction law.
fn print_recommended(
    out: &mut impl Write,
    told: &Recommended,
    point: &BlockPoint,
) -> std::io::Result<()> {
    let which = if told.robust.is_some() {
        "robust"
    } else {
        "best"
    };
    writeln!(out, "at the {which} setting")?;
    let Recommended { setting, units, .. } = told;
    let violations = margins::violations(&point.stability);
    margins::print(out, &point.margins, violations, setting, units)?;
    match &told.vc {
        Some(found) => VcText::of(found, units).print_short(out),
        None => Ok(()),
    }
}

/// One line for each stable region, with its best setting; nothing without regions. The columns
/// have units where there are any.
fn print_regions(out: &mut impl Write, told: &Recommended) -> std::io::Result<()> {
    let (units, found) = (&told.units, &told.found);
    let optima = found.regions.iter().map(|region| &region.best);
    let mut optima = optima.peekable();
    if optima.peek().is_none() {
        return Ok(());
    }
    let (p, q) = (&told.searched.p, &told.searched.q);
    let by = match told.searched.has_delay() {
        true => "delay",
        false => q.name(),
    };
    writeln!(out, "the best setting of every stable region, by {by}")?;
    let mut line = |cells: [&str; 6]| {
        let [value, tau, time, frequency, certified, kind] = cells;
        let text =
            format!("  {value:>14} {tau:>14} {time:>15} {frequency:>14} {certified:>9}  {kind}");
        writeln!(out, "{}", text.trim_end())
    };
    line([
        p.name(),
        q.name(),
        "relaxation_time",
        "frequency",
        "certified",
        "kind",
    ])?;
    if !units.dimensionless() {
        let [of_p, of_q] = [p, q].map(|of| unit_behind(&of.unit(units)));
        let (time, frequency) = (units.time(), units.angular_frequency());
        line([of_p.trim(), of_q.trim(), &time, &frequency, "", ""])?;
    }
    for best in optima {
        let time = best.relaxation_time().map_or("none".into(), short);
        line([
            &short(best.p),
            &short(best.q),
            &time,
            &frequency_of(best, ""),
            yes_or_no(best.certified),
            best.kind.name(),
        ])?;
    }
    match found.regions_left_out {
        0 => Ok(()),
        more => writeln!(
            out,
            "  and {} more, not searched or with decay within rounding",
            counted(more as u64, "region")
        ),
    }
}
