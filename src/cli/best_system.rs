//! `slipmap best --system`: the settings of fastest decay of a system from a file.

use std::io::Write;

use serde::Serialize;
use slipmap::explore::stability::Wanted;
use slipmap::explore::system_point::SystemPoint;
use slipmap::linear::best::{Best, Optimum, Region};
use slipmap::sweep::Parameter;
use slipmap::sweep::cells::best::Ranges;
use slipmap::sweep::cells::best_of_system::{
    Searched, best_of_system, default_ranges, searched_of,
};
use slipmap::sweep::input::nearest::did_you_mean;
use slipmap::sweep::input::system::{Evaluation, SystemModel};
use utoipa::ToSchema;

use super::best::{Args, range};
use super::best_answer::OptimumNumbers;
use super::best_text::{abscissa_of, frequency_of, nothing_decays, print_regions, short};
use super::cell::alone;
use super::failure::Failure;
use super::json::{self, Inputs};
use super::say::ForPeople;
use super::system_args::OTHERS;

/// The JSON of a search of a system from a file.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct SystemBest {
    /// The parameter that is searched beside the delay.
    search: String,
    searched: SystemRanges,
    best: SystemOptimum,
    regions: Vec<SystemRegion>,
    /// Regions that are not among these: not searched, or with decay within rounding.
    regions_left_out: usize,
    /// All about the best setting.
    point: SystemPoint,
}

#[derive(Debug, Serialize, ToSchema)]
struct SystemRanges {
    /// Of the parameter that is searched.
    #[schema(value_type = [f64; 2])]
    value: (f64, f64),
    #[schema(value_type = [f64; 2])]
    tau: (f64, f64),
}

#[derive(Debug, Serialize, ToSchema)]
struct SystemRegion {
    region: SystemRanges,
    #[serde(flatten)]
    best: SystemOptimum,
}

#[derive(Debug, Serialize, ToSchema)]
struct SystemOptimum {
    /// Of the parameter that is searched.
    value: f64,
    #[serde(flatten)]
    numbers: OptimumNumbers,
}

impl From<&Optimum> for SystemOptimum {
    fn from(found: &Optimum) -> Self {
        Self {
            value: found.gain,
            numbers: found.into(),
        }
    }
}

impl From<&Region> for SystemRegion {
    fn from(region: &Region) -> Self {
        Self {
            region: SystemRanges {
                value: region.gains,
                tau: region.delays,
            },
            best: (&region.best).into(),
        }
    }
}

/// What is searched, and within which ranges.
struct Asked {
    model: SystemModel,
    at: Evaluation,
    name: String,
    searched: Searched,
    ranges: Ranges,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let asked = args.asked_of_system()?;
    let found = best_of_system(&asked.model, &asked.at, asked.searched, &asked.ranges);
    let found = found.map_err(|why| Failure::bad_input(why.to_string()))?;
    let point = asked.point(&found.overall)?;
    if args.json {
        let answer = SystemBest {
            search: asked.name.clone(),
            searched: SystemRanges {
                value: asked.ranges.gain,
                tau: asked.ranges.tau,
            },
            best: (&found.overall).into(),
            regions: found.regions.iter().map(Into::into).collect(),
            regions_left_out: found.regions_left_out,
            point,
        };
        return json::print(&asked.inputs(args, &answer.point), &answer);
    }
    let out = &mut ForPeople::begin();
    Ok(asked.print(out, &found, &point)?)
}

impl Args {
    fn asked_of_system(&self) -> Result<Asked, Failure> {
        let flags = self.parameters.any_but(&OTHERS);
        alone("--system", flags || self.control.is_some())?;
        for (flag, given) in [
            ("--robust", self.robust.is_some()),
            ("--save", self.save.is_some()),
        ] {
            if given {
                return Err(Failure::bad_input_with_help(
                    format!("{flag} is not known of a system from a file"),
                    "leave it out: it is for a block on its spring",
                ));
            }
        }
        let flag = |parameter| self.parameters.given(parameter);
        let Some((model, at, delay)) = self.system.read_but_delay(flag)? else {
            return Err(Failure::bad_input("--system is not given"));
        };
        let (name, searched) = self.searched(&model)?;
        let known = Parameter::from_name(&name).and_then(flag).is_some();
        let fixed = [(delay, "tau"), (known || self.system.sets(&name), &*name)];
        if let Some((_, fixed)) = fixed.into_iter().find(|(given, _)| *given) {
            return Err(Failure::bad_input_with_help(
                format!("a value of {fixed} is given, which is searched"),
                "leave it out; --search-from, --search-to, --tau-from and --tau-to are the \
                 ranges of the search",
            ));
        }
        let ranges = self.ranges_of(&model, searched, &default_ranges(&model, &at, searched))?;
        Ok(Asked {
            model,
            at,
            name,
            searched,
            ranges,
        })
    }

    /// The parameter that `--search` names; where the system has one alone, that one.
    fn searched(&self, model: &SystemModel) -> Result<(String, Searched), Failure> {
        let own = model.parameters.iter().map(|own| &*own.name);
        let others: &[&str] = match model.is_feedback() {
            true => &["memory", "latency"],
            false => &[],
        };
        let all: Vec<&str> = own.chain(others.iter().copied()).collect();
        let name = match (&self.search, &*all) {
            (Some(name), _) => &**name,
            (None, [alone]) => *alone,
            (None, _) => {
                return Err(Failure::bad_input_with_help(
                    "--search is not given: which parameter is searched beside the delay",
                    format!("parameters of the system: {}", all.join(", ")),
                ));
            }
        };
        match searched_of(model, name) {
            Some(searched) => Ok((name.to_owned(), searched)),
            None => Err(Failure::bad_input_with_help(
                format!("--search: the system has no parameter {name}"),
                format!(
                    "{}its parameters: {}",
                    did_you_mean(name, all.iter().copied()),
                    all.join(", ")
                ),
            )),
        }
    }

    /// The ranges that the flags give, over those searched by default.
    fn ranges_of(
        &self,
        model: &SystemModel,
        searched: Searched,
        default: &Ranges,
    ) -> Result<Ranges, Failure> {
        let of = |parameter: Parameter, value: f64| {
            let checked = parameter.check(value);
            checked.map_err(|error| error.to_string())
        };
        let told = |flag: &str, checked: Result<f64, String>| match checked {
            Ok(_) => Ok(()),
            Err(why) => Err(Failure::bad_input(format!("{flag}: {why}"))),
        };
        let check = |value: f64| match searched {
            Searched::Own(index) => model.parameters[index].check(value),
            Searched::Memory => of(Parameter::Memory, value),
            Searched::Latency => of(Parameter::Latency, value),
        };
        Ok(Ranges {
            gain: range(
                [
                    ("--search-from", self.alpha_from),
                    ("--search-to", self.alpha_to),
                ],
                default.gain,
                |flag, value| told(flag, check(value)),
            )?,
            tau: range(
                [("--tau-from", self.tau_from), ("--tau-to", self.tau_to)],
                default.tau,
                |flag, value| told(flag, of(Parameter::Tau, value)),
            )?,
        })
    }
}

impl Asked {
    /// All about the best setting.
    fn point(&self, best: &Optimum) -> Result<SystemPoint, Failure> {
        let mut at = self.at.clone();
        self.searched.set(&mut at, best.gain);
        at.tau = best.tau;
        let wanted = Wanted {
            roots: 4,
            line: None,
        };
        let point = SystemPoint::at(&self.model, &mut at, wanted);
        point.map_err(|why| Failure::bad_input(why.to_string()))
    }

    fn inputs(&self, args: &Args, point: &SystemPoint) -> Inputs {
        let Ranges { gain, tau } = self.ranges;
        let mut set = point.parameters.clone();
        set.remove(&self.name);
        let mut inputs = Inputs::default()
            .and("system", &args.system.system)
            .and("set", set)
            .and("search", &self.name)
            .and("search_from", gain.0)
            .and("search_to", gain.1)
            .and("tau_from", tau.0)
            .and("tau_to", tau.1);
        let others = [
            (Searched::Memory, "memory", point.memory),
            (Searched::Latency, "latency", point.latency),
        ];
        for (of, name, value) in others {
            if let Some(value) = value.filter(|_| self.searched != of) {
                inputs = inputs.and(name, value);
            }
        }
        inputs
    }

    /// Prints what was found for people.
    fn print(
        &self,
        out: &mut impl Write,
        found: &Best,
        point: &SystemPoint,
    ) -> std::io::Result<()> {
        let best = &found.overall;
        let title = match &*self.model.title {
            "" => "the system",
            title => title,
        };
        match best.relaxation_time() {
            Some(time) => writeln!(
                out,
                "{title} relaxes fastest, with the relaxation time {}, at",
                short(time)
            )?,
            None => writeln!(
                out,
                "{title} has {}",
                nothing_decays(!found.regions.is_empty())
            )?,
        }
        let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
        row(&self.name, short(best.gain))?;
        row("tau", short(best.tau))?;
        row("abscissa", abscissa_of(best, ""))?;
        row("frequency", frequency_of(best, ""))?;
        row("kind", best.kind.name().into())?;
        let certified = if best.certified { "yes" } else { "no" };
        row("certified", certified.into())?;
        for (name, &value) in &point.parameters {
            if *name != self.name {
                row(name, short(value))?;
            }
        }
        for (name, value) in [("memory", point.memory), ("latency", point.latency)] {
            if let Some(value) = value.filter(|_| name != self.name) {
                row(name, short(value))?;
            }
        }
        if let Some(margin) = point.stability.delay_margin {
            row("delay_margin", short(margin))?;
        }
        if point.memory.is_some() {
            let margin = point.latency_margin.map(short);
            let margin = margin.unwrap_or_else(|| "infinite, or not known".into());
            row("latency_margin", margin)?;
        }
        let Ranges { gain, tau } = self.ranges;
        let searched = [(&*self.name, gain), ("tau", tau)]
            .map(|(name, (from, to))| format!("{name} {} to {}", short(from), short(to)));
        row("searched", searched.join(", "))?;
        let optima = found.regions.iter().map(|region| &region.best);
        print_regions(out, (&self.name, None), optima, found.regions_left_out)
    }
}
