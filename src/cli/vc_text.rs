//! What `slipmap vc` prints for people: how stick-slip ends, then the numbers.

use std::io::Write;

use crate::explore::vc::{CriticalVelocity, ShortDelay};
use crate::report::numbers::{rounded, unit_behind};
use crate::setting::units::Units;
use crate::setting::{Field, Parameter};
use crate::text::finite;

use super::digits::Digits;

/// The answer where v_c is 0.
const NEVER: &str = "no stick-slip survives at any velocity";
/// Significant digits of a ratio that is told in a sentence.
const RATIO: usize = 2;
/// Room for the names of the fields of the limit.
const WIDE: usize = 20;

/// A critical velocity with its units, and how it is to be written.
pub(super) struct VcText<'f> {
    pub(super) found: &'f CriticalVelocity,
    pub(super) units: &'f Units,
    pub(super) digits: Digits,
}

impl<'f> VcText<'f> {
    /// With the usual digits.
    pub(super) fn of(found: &'f CriticalVelocity, units: &'f Units) -> Self {
        Self {
            found,
            units,
            digits: Digits::default(),
        }
    }

    /// A velocity with its unit.
    fn velocity(&self, value: f64) -> String {
        self.digits.of(value) + &unit_behind(&Field::Vc.unit(self.units))
    }

    fn bound(&self, value: f64, up: bool) -> String {
        self.digits.of_bound(value, up) + &unit_behind(&Field::Vc.unit(self.units))
    }

    /// Where an undecided v_c lies, after the words that say it is not known.
    fn between(&self) -> String {
        let lower = finite(self.found.vc_lower).map(|v| self.bound(v, false));
        let upper = finite(self.found.vc_upper).map(|v| self.bound(v, true));
        match (lower, upper) {
            (None, None) => String::new(),
            (None, Some(upper)) => format!(", below {upper}"),
            (Some(lower), None) => format!(", above {lower}"),
            (Some(lower), Some(upper)) => format!(", between {lower} and {upper}"),
        }
    }

    /// The answer as a sentence, with where `v0` stands if there is one.
    pub(super) fn sentence(&self, v0: Option<f64>) -> String {
        let placed = v0.map_or_else(String::new, |v0| self.placed(v0));
        let found = self.found;
        let answer = match (found.decided, finite(found.vc)) {
            (false, _) => format!(
                "it is not known above which velocity no stick-slip survives{}",
                self.between()
            ),
            (true, Some(0.0)) => return NEVER.into(),
            (true, Some(vc)) => format!("above {} no stick-slip survives", self.velocity(vc)),
            (true, None) => self.without(),
        };
        answer + &placed
    }

    /// Where `v0` stands to v_c, its bounds or a lift-off.
    fn placed(&self, v0: f64) -> String {
        let found = self.found;
        let told = self.velocity(v0);
        if let (true, Some(vc)) = (found.decided, finite(found.vc)) {
            return format!(
                "; v0 = {told} is {} times that",
                rounded(v0 / vc, RATIO - 1)
            );
        }
        let (lower, upper) = match found.decided {
            true => (found.v_liftoff, found.v_liftoff),
            false => (found.vc_lower, found.vc_upper),
        };
        let (below, above) = (v0 <= lower, v0 > upper);
        let place = match (below, above) {
            (true, _) => "lies below",
            (_, true) => "lies above",
            _ if found.decided => "is left aside",
            _ => "may lie on either side",
        };
        format!("; v0 = {told} {place}")
    }

    /// Why there is no critical velocity.
    fn without(&self) -> String {
        match (self.found.outcome, finite(self.found.v_liftoff)) {
            ("persists", _) => "stick-slip survives at every velocity that was tried".into(),
            ("lift-off", Some(v)) => format!(
                "the load reaches 0 from {} on, before stick-slip ends: the model ends there",
                self.velocity(v)
            ),
            (outcome, _) => format!("there is no critical velocity: {outcome}"),
        }
    }

    /// v_c in short, for a row.
    fn vc(&self) -> String {
        match (self.found.decided, finite(self.found.vc)) {
            (false, _) => format!("not known{}", self.between()),
            (true, Some(vc)) => self.velocity(vc),
            (true, None) => format!("none: {}", self.found.outcome),
        }
    }

    /// The rows about velocities: v_c and the velocity of lift-off.
    fn velocities(&self) -> impl Iterator<Item = (&'static str, String)> {
        let liftoff = finite(self.found.v_liftoff).filter(|_| self.found.decided);
        let liftoff = liftoff.map(|v| (Field::VLiftoff.name(), self.velocity(v)));
        [(Field::Vc.name(), self.vc())].into_iter().chain(liftoff)
    }

    /// Writes v_c, and the velocity of lift-off if there is one.
    pub(super) fn print_short(&self, out: &mut impl Write) -> std::io::Result<()> {
        rows(out, self.velocities())
    }

    /// Writes the numbers.
    pub(super) fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        let found = self.found;
        let windows = found.windows.iter();
        let windows = windows.map(|[from, to]| {
            let from = match *from {
                // A block that is not pulled does not slip.
                0.0 => "0 <".to_owned(),
                from => format!("{} <=", self.digits.of(from)),
            };
            ("windows", format!("{from} v0 <= {}", self.velocity(*to)))
        });
        let at_vc = [
            (Field::StickTime, found.stick_time),
            (Field::SlipTime, found.slip_time),
            (Field::NMin, found.n_min),
        ];
        let at_vc = at_vc.into_iter().filter(|(_, value)| value.is_finite());
        let at_vc = at_vc.map(|(field, value)| {
            let unit = unit_behind(&field.unit(self.units));
            (field.name(), self.digits.of(value) + &unit)
        });
        let found_by = [
            (Field::Outcome.name(), found.outcome),
            ("protocol", found.protocol),
            ("method", found.method),
        ];
        rows(out, self.velocities())?;
        rows(out, windows.filter(|_| found.decided))?;
        rows(out, at_vc)?;
        rows(out, found_by.map(|(name, text)| (name, text.to_owned())))
    }
}

/// Writes the answer in the limit of a short delay: a sentence, then its numbers.
pub(super) fn print_limit(
    out: &mut impl Write,
    found: &ShortDelay,
    digits: Digits,
) -> std::io::Result<()> {
    let value = |field: Field| found.fields.get(field.name()).copied();
    if let Some(vc) = value(Field::VcOverVtilde) {
        let vtilde = "(mu_s - mu_k) normal_load / sqrt(stiffness mass)";
        // Without a jump of friction vtilde is 0.
        if vc == 0.0 || found.mu_ratio == 1.0 {
            writeln!(out, "{NEVER}; vtilde = {vtilde}")?;
        } else {
            let vc = digits.of(vc);
            writeln!(
                out,
                "above {vc} vtilde no stick-slip survives; vtilde = {vtilde}"
            )?;
        }
    }
    let inputs = [
        (Parameter::Gamma, found.gamma),
        (Parameter::DampingRatio, found.damping_ratio),
        (Parameter::MuRatio, found.mu_ratio),
    ];
    let inputs = inputs.map(|(parameter, value)| (parameter.name(), digits.of(value)));
    rows_of(WIDE, out, inputs)?;
    let fields = Field::ALL.into_iter();
    let fields = fields.filter_map(|field| Some((field.name(), digits.of(value(field)?))));
    rows_of(WIDE, out, fields)?;
    rows_of(WIDE, out, [("protocol", found.protocol.to_owned())])
}

fn rows<'n>(
    out: &mut impl Write,
    of: impl IntoIterator<Item = (&'n str, String)>,
) -> std::io::Result<()> {
    rows_of(16, out, of)
}

/// Rows whose names take so much room.
fn rows_of<'n>(
    width: usize,
    out: &mut impl Write,
    of: impl IntoIterator<Item = (&'n str, String)>,
) -> std::io::Result<()> {
    let mut of = of.into_iter();
    of.try_for_each(|(name, text)| writeln!(out, "  {name:<width$} {text}"))
}
