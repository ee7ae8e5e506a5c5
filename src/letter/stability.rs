//! Where sliding is stable: the letter's Fig. 2, and the areas in it.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::one_variable::{Integral, integral};
use super::workshop::{Source, Workshop, planes, source};
use crate::linear::Crossings;
use crate::model::Groups;
use crate::setting::Field;
use crate::store::MapFile;

const FIG2A: Source = source!("fig2a");
const FIG2B: Source = source!("fig2b");

/// The sources of the claims here.
pub(super) const SOURCES: [&Source; 2] = [&FIG2A, &FIG2B];

/// The stable region at one slope of the friction law, within a window of gains and delays.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Region {
    /// μ′.
    mu_prime: f64,
    /// Number of stable cells.
    cells: usize,
    /// Its area, in units of gain and delay.
    area: Integral,
    /// The smallest number of unstable roots without gain.
    uncontrolled: f64,
}

/// A panel of Fig. 2.
#[derive(Debug, Clone, PartialEq)]
struct Panel {
    regions: Vec<Region>,
}

/// The control of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Control {
    Velocity,
    Load,
}

impl Control {
    fn groups(self, b: f64, gain: f64) -> Groups {
        match self {
            Self::Velocity => Groups::new(b, gain, 0.0),
            Self::Load => Groups::new(b, 0.0, gain),
        }
    }
}

/// The area of the stable region in a window of gains and delays.
fn stable_area(groups: impl Fn(f64) -> Groups, [gains, delays]: [(f64, f64); 2]) -> Integral {
    let stable = |gain: f64| {
        let all = Crossings::of(groups(gain)).stable_delays();
        let inside = all.take_while(|one| one.from < delays.1);
        inside
            .map(|one| (one.to.min(delays.1) - one.from.max(delays.0)).max(0.0))
            .sum::<f64>()
    };
    integral(stable, gains, delays.1 - delays.0)
}

impl Panel {
    /// The panel of a map over the slope, the gain and the delay.
    fn of(map: &MapFile, control: Control) -> Result<Self, LetterError> {
        let mut regions = Vec::new();
        for (outer, plane) in planes(map, Field::NUnstable)? {
            let mu_prime = outer.first().map_or(f64::NAN, |(_, value)| *value);
            let cells = plane.cells.iter().filter(|n| **n == 0.0).count();
            let window = [&plane.rows, &plane.columns].map(|axis| (axis[0], axis[axis.len() - 1]));
            let area = stable_area(|gain| control.groups(mu_prime, gain), window);
            let weakest = (0..plane.rows.len())
                .min_by(|&i, &j| plane.rows[i].abs().total_cmp(&plane.rows[j].abs()));
            let row = weakest.unwrap_or(0) * plane.columns.len();
            let uncontrolled = plane.cells[row..row + plane.columns.len()].iter();
            regions.push(Region {
                mu_prime,
                cells,
                area,
                uncontrolled: uncontrolled.copied().fold(f64::INFINITY, f64::min),
            });
        }
        Ok(Self { regions })
    }

    /// Every region has stable cells, and sliding without gain is never stable.
    fn verdict(&self) -> Verdict {
        let worked = |region: &&Region| region.cells > 0 && region.uncontrolled > 0.0;
        let all = self.regions.iter().filter(worked).count();
        Verdict::of_parts(
            all == self.regions.len() && all > 0,
            2 * all > self.regions.len(),
        )
    }

    fn values(&self) -> impl Iterator<Item = ClaimValue> {
        self.regions.iter().map(|region| {
            let name = format!("area at {}", region.mu_prime);
            let meaning = "stable area of the window of the map, by the closed form of all stable \
                delays at a gain, integrated over the gain";
            ClaimValue::of(name, meaning, region.area.value).within(region.area.error)
        })
    }

    fn claim(
        &self,
        name: &'static str,
        at: (&'static str, &'static str),
        what: &str,
        evidence: &'static str,
    ) -> Claim {
        let cells = self.regions.iter().map(|region| region.cells);
        let without = self.regions.iter().map(|region| region.uncontrolled);
        let because = format!(
            "{what} makes sliding stable at all {} slopes of the friction law shown, in {} cells \
             or more; without it there are {} unstable roots at each.",
            self.regions.len(),
            cells.min().unwrap_or(0),
            without.fold(f64::INFINITY, f64::min),
        );
        let how = "The number of unstable roots of every cell, from the closed form of its \
            crossings, Eqs. (4) and (5): no root is searched for. The curves are those crossings \
            themselves.";
        Claim::new(name, at, self.verdict(), because, how)
            .by(self.values())
            .from(&[evidence])
    }
}

/// Areas of both panels at the slopes that they share.
#[derive(Debug, Clone, PartialEq)]
struct Areas {
    /// μ′ and the areas under velocity control and under load control.
    shared: Vec<(f64, Integral, Integral)>,
}

impl Areas {
    fn of(velocity: &Panel, load: &Panel) -> Self {
        let shared = velocity.regions.iter().filter_map(|one| {
            let other = load.regions.iter().find(|r| r.mu_prime == one.mu_prime)?;
            Some((one.mu_prime, one.area, other.area))
        });
        Self {
            shared: shared.collect(),
        }
    }

    fn smaller(&self) -> usize {
        let smaller = self
            .shared
            .iter()
            .filter(|(_, velocity, load)| velocity.value < load.value);
        smaller.count()
    }

    fn verdict(&self) -> Verdict {
        let of = self.shared.len();
        Verdict::of_parts(of > 0 && self.smaller() == of, 2 * self.smaller() > of)
    }

    fn claim(&self) -> Claim {
        let because = format!(
            "The stable area of velocity control is the smaller one at {} of {} slopes, in the \
             windows of Fig. 2.",
            self.smaller(),
            self.shared.len(),
        );
        let at = (
            "paragraph of Fig. 2",
            "less efficient than load control because the stability area is smaller",
        );
        let how = "Areas of the stable regions in the windows of both maps, in units of gain and \
            delay (M = κ = N0 = μ_K = 1): all stable delays at a gain, integrated over the gain.";
        let values = self.shared.iter().map(|(mu_prime, velocity, load)| {
            let name = format!("ratio at {mu_prime}");
            let meaning = "stable area of velocity control over that of load control";
            let ratio = velocity.value / load.value;
            let error = velocity.error / velocity.value + load.error / load.value;
            ClaimValue::of(name, meaning, ratio).within(ratio * error)
        });
        Claim::new("smaller_area", at, self.verdict(), because, how)
            .by(values)
            .from(&["fig2a", "fig2b"])
    }
}

/// The claims of Fig. 2 and those on its areas.
pub(super) fn claims(shop: &mut Workshop) -> Result<Vec<Claim>, LetterError> {
    let velocity = Panel::of(&shop.map(&FIG2A)?, Control::Velocity)?;
    let load = Panel::of(&shop.map(&FIG2B)?, Control::Load)?;
    let caption = "Boundaries of stable continuous sliding";
    Ok(vec![
        velocity.claim("fig2a", ("Fig. 2(a)", caption), "Velocity control", "fig2a"),
        load.claim("fig2b", ("Fig. 2(b)", caption), "Load control", "fig2b"),
        Areas::of(&velocity, &load).claim(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    const REGION: Region = Region {
        mu_prime: -0.1,
        cells: 3,
        area: Integral {
            value: 1.0,
            error: 0.0,
        },
        uncontrolled: 2.0,
    };

    #[test]
    fn a_panel_needs_stable_cells_that_control_made() {
        let mut panel = Panel {
            regions: vec![REGION; 3],
        };
        assert_eq!(panel.verdict(), Verdict::Confirmed);
        panel.regions[1].cells = 0;
        assert_eq!(panel.verdict(), Verdict::Refined);
        panel.regions[2].uncontrolled = 0.0;
        assert_eq!(panel.verdict(), Verdict::Contradicted);
        panel.regions.clear();
        assert_eq!(panel.verdict(), Verdict::Contradicted);
    }

    #[test]
    fn areas_are_compared_at_slopes_that_both_have() {
        let of = |areas: [f64; 3]| Panel {
            regions: std::iter::zip([-0.1, -0.2, -0.3], areas)
                .map(|(mu_prime, value)| Region {
                    mu_prime,
                    area: Integral { value, error: 0.0 },
                    ..REGION
                })
                .collect(),
        };
        let mut load = of([2.0; 3]);
        load.regions.remove(0);
        let verdict = |areas| Areas::of(&of(areas), &load).verdict();
        assert_eq!(verdict([9.0, 1.0, 1.0]), Verdict::Confirmed);
        assert_eq!(verdict([1.0, 1.0, 3.0]), Verdict::Contradicted);
        assert_eq!(verdict([1.0, 3.0, 3.0]), Verdict::Contradicted);
    }

    /// Areas in the windows of Fig. 2, from a program of its own: crossing frequencies from |B − A|
    /// = |A|, directions from the derivatives of D, Simpson's rule with panels at random places.
    #[test]
    fn areas_are_those_of_another_program() {
        let known = [
            (Control::Velocity, -0.05, 11.790_735_020),
            (Control::Velocity, -0.1, 8.151_695_663),
            (Control::Velocity, -0.3, 1.867_677_358),
            (Control::Velocity, -0.6, 0.042_674_895),
            (Control::Velocity, -0.7, 0.000_686_902),
            (Control::Load, -0.05, 10.074_822_018),
            (Control::Load, -0.5, 5.779_708_686),
            (Control::Load, -2.0, 1.028_202_851),
        ];
        for (control, b, area) in known {
            let gains = match control {
                Control::Velocity => (-1.6, 0.4),
                Control::Load => (-8.0, 1.0),
            };
            let found = stable_area(|gain| control.groups(b, gain), [gains, (0.0, 12.0)]);
            let off = (found.value - area).abs();
            assert!(
                off < 1e-9 && found.error < 1e-9,
                "{control:?} {b}: {found:?}"
            );
        }
    }
}
