//! The flags of a friction law besides its parameters, and of units.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};

use crate::setting::law_kind::{LawKind, NamedLaw};
use crate::setting::measured::{Columns, SpeedUnit};
use crate::setting::units::Units;

use super::sets::SetArgs;

/// The flags of a friction law besides its parameters, and of units.
#[derive(Debug, Args)]
pub(super) struct LawArgs {
    /// Friction law, instead of --mu-prime and --mu-k
    #[arg(long, value_parser = law_names(false))]
    pub(super) friction: Option<String>,
    /// Points of a measured friction law, for --friction table: columns of the speed, and of μ_K
    /// or a force, which is divided by --normal-load
    #[arg(long, value_name = "FILE.csv")]
    pub(super) table: Option<PathBuf>,
    /// Columns of --table by title or number: speed, and mu or force, and load where a column has
    /// it, as in speed=2,force=4 [default: by titles]
    #[arg(long, value_name = "LIST", value_parser = Columns::read, requires = "table")]
    pub(super) columns: Option<Columns>,
    /// Unit of the speeds in --table, as in mm/s [default: that of their title, else of --units]
    #[arg(long, value_name = "UNIT", value_parser = SpeedUnit::read, requires = "table")]
    pub(super) speed_unit: Option<SpeedUnit>,
    /// Units of the numbers given and told: SI, or those of force, length and time, as in N,mm,s
    /// [default: SI if a number has a unit, as in 2.4kg or 3mm/s, else dimensionless]
    #[arg(long, value_name = "UNITS", value_parser = Units::read)]
    pub(super) units: Option<Units>,
    #[command(flatten)]
    pub(super) sets: SetArgs,
}

/// Friction laws by name, with their formulas; those without motions are hidden where motions are
/// followed.
pub(super) fn law_names(of_motions: bool) -> PossibleValuesParser {
    let formulas = NamedLaw::all().iter().map(move |law| {
        let hidden = of_motions && LawKind::Named(law).has_state();
        let value = PossibleValue::new(law.name()).help(law.formula());
        value.hide(hidden)
    });
    let table = PossibleValue::new(LawKind::TABLE)
        .help("The points in the file --table, joined by monotone cubics");
    let formula = PossibleValue::new(LawKind::FORMULA)
        .help("The expression --mu-k in the speed v, with parameters of its own");
    PossibleValuesParser::new(formulas.chain([table, formula]))
}
