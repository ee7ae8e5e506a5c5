//! The key of a heat map: the colour of every value of a field, and the bar or list that explains
//! it.

use super::error::PictureError;
use super::legend::{Bar, Legend, Swatch};
use super::options::PictureOptions;
use super::page::{Area, SMALL};
use super::scene::Scene;
use super::text::{Rich, field_name, suffix};
use crate::meaning::colour::{INK, Rgb};
use crate::meaning::gap::Gap;
use crate::meaning::legend::{self as meaning, Entry, Mark};
use crate::meaning::paint::{Paint, Shades};
use crate::report::known::Known;
use crate::setting::Field;

/// Width of boundary lines.
pub(super) const BOUNDARY_WIDTH: f64 = 1.8;
/// The height below which a bar with its heading is short, relative to the font of its numbers.
const SHORT: f64 = 11.0;

/// The meaning of a field's colours, in the panels and beside them.
pub(super) struct Key {
    paint: Paint,
    shades: Shades,
    /// Lines above the bar.
    heading: Vec<Rich>,
    /// The list below the bar, or alone where there is no bar.
    legend: Legend,
}

impl Key {
    /// The key for all cells of `planes`; `curves`: whether boundaries are drawn as well.
    ///
    /// # Errors
    /// When the options do not suit the field or its values.
    pub(super) fn new(
        field: Field,
        unit: &str,
        planes: &[Known],
        curves: bool,
        options: &PictureOptions,
    ) -> Result<Self, PictureError> {
        let values: Vec<f64> = planes.iter().flat_map(Known::values).collect();
        let paint = Paint::asked(field, &values, options)?;
        let list = meaning::list_heading(field, &paint);
        let mut legend = Legend {
            heading: list.map(Rich::prose).into_iter().collect(),
            entries: drawn(meaning::entries(field, &paint, &values)),
        };
        legend.entries.extend(of_gaps(field, planes));
        if curves {
            let swatch = Swatch::Line(INK, BOUNDARY_WIDTH, None);
            legend.entries.push((swatch, Rich::plain("boundary")));
        }
        Ok(Self {
            shades: paint.shades(),
            paint,
            heading: heading(field, unit),
            legend,
        })
    }

    /// The key with more entries at the end of its list.
    pub(super) fn with(mut self, more: Vec<(Swatch, Rich)>) -> Self {
        self.legend.entries.extend(more);
        self
    }

    /// The colour of a value.
    pub(super) fn colour(&self, value: f64) -> Rgb {
        self.shades.colour(value)
    }

    /// Width in pixels.
    pub(super) fn width(&self, u: f64) -> f64 {
        let colour = |value| self.colour(value);
        let bar = self.bar(&colour).map_or(0.0, |bar| bar.width(u));
        bar.max(self.legend.width(u))
    }

    /// Draws the key into `area`, down to `lowest` where its bar would be short.
    ///
    /// # Errors
    /// When its bar has no room there.
    pub(super) fn draw(
        &self,
        scene: &mut Scene,
        area: Area,
        lowest: f64,
    ) -> Result<(), PictureError> {
        let colour = |value| self.colour(value);
        let Some(bar) = self.bar(&colour) else {
            self.legend.draw(scene, area);
            return Ok(());
        };
        let u = scene.unit();
        let below = self.legend.height(u);
        let short = area.height() - below < SHORT * SMALL * u;
        let split = if short { lowest } else { area.bottom } - below;
        let upper = Area {
            bottom: split,
            ..area
        };
        bar.draw(scene, upper)?;
        self.legend.draw(scene, Area { top: split, ..area });
        Ok(())
    }

    fn bar<'a>(&self, colour: &'a dyn Fn(f64) -> Rgb) -> Option<Bar<'a>> {
        Some(Bar {
            heading: self.heading.clone(),
            scale: self.paint.scale()?,
            colour,
        })
    }
}

/// Entries for the kinds of missing values in some planes.
pub(super) fn of_gaps(field: Field, planes: &[Known]) -> Vec<(Swatch, Rich)> {
    let there = |gap: Gap| planes.iter().any(|plane| plane.gaps.contains(&Some(gap)));
    drawn(meaning::of_gaps(field, there))
}

/// Entries as they are drawn.
fn drawn(entries: Vec<Entry>) -> Vec<(Swatch, Rich)> {
    let entry = |entry: Entry| {
        let swatch = match entry.mark {
            Mark::Colour(colour) => Swatch::Box(colour),
            Mark::Gap(gap) => Swatch::Gap(gap),
        };
        let text = match entry.formula {
            true => Rich::default().and_formula(&entry.text),
            false => Rich::prose(&entry.text),
        };
        (swatch, text)
    };
    entries.into_iter().map(entry).collect()
}

/// The field's name and, if it has two sides, which of them is stable.
fn heading(field: Field, unit: &str) -> Vec<Rich> {
    let name = field_name(field).and(&suffix(unit, " (", ")"));
    let side = meaning::side(field).map(Rich::plain);
    [name].into_iter().chain(side).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::meaning::colour;
    use crate::meaning::gradient::ColourMap;
    use crate::setting::field::Storage;
    use crate::setting::regime_at_v0::RegimeAtV0;
    use crate::slip::outcome::Outcome;
    use crate::store::map_file::Plane;

    fn plane(cells: &[f64]) -> Known {
        let gap = |value: &f64| value.is_nan().then_some(Gap::NoValue);
        Known {
            plane: Plane {
                rows: vec![0.0],
                columns: (0..cells.len()).map(|i| i as f64).collect(),
                cells: cells.to_vec(),
            },
            gaps: cells.iter().map(gap).collect(),
        }
    }

    fn of(field: Field, cells: &[f64], curves: bool) -> Key {
        Key::new(
            field,
            "1",
            &[plane(cells)],
            curves,
            &PictureOptions::default(),
        )
        .unwrap()
    }

    fn of_plane(field: Field, plane: Known) -> Key {
        Key::new(field, "1", &[plane], false, &PictureOptions::default()).unwrap()
    }

    fn texts(key: Key) -> Vec<Rich> {
        key.legend.entries.into_iter().map(|e| e.1).collect()
    }

    #[test]
    fn the_legend_lists_what_is_there() {
        let key = of(Field::NUnstable, &[0.0, 4.0, f64::NAN], true);
        let expected = ["0, stable", "4", "no value", "boundary"];
        assert_eq!(texts(key), expected.map(Rich::plain));
        let key = of(Field::NUnstable, &[3.0, 1.0, 2.0, 9.0, 3.0], false);
        assert_eq!(texts(key), ["1", "2", "3", "8 or more"].map(Rich::plain));
        let key = of(Field::NUnstable, &[8.0, 7.0], false);
        assert_eq!(texts(key), ["7", "8"].map(Rich::plain));
        let cells = [-0.1, 0.9, f64::NEG_INFINITY];
        let key = of(Field::Abscissa, &cells, false);
        assert_eq!(texts(key), ["above 0.45", "−∞"].map(Rich::plain));
        let cells = [2.0, 900.0, f64::INFINITY];
        let key = of(Field::RelaxationTime, &cells, false);
        assert_eq!(texts(key), ["above 200", "∞, unstable"].map(Rich::plain));
        let cells = [1.0, 3.0, 1.0, f64::NAN];
        let key = of(Field::Outcome, &cells, false);
        assert_eq!(
            texts(key),
            ["stick-slip", "lift-off", "no value"].map(Rich::plain)
        );
    }

    /// No two meanings share a colour, and none shares one with the bar.
    #[test]
    fn every_meaning_has_a_colour_of_its_own() {
        let far = [0.0, 0.01, 1.0, 2.0, 3.0, 1e6, f64::INFINITY];
        let wide = far.iter().copied().chain([-1e6, f64::NEG_INFINITY]);
        let mut cells: Vec<f64> = (0..400).map(|i| 1.0 + f64::from(i) * 0.01).collect();
        cells.extend(wide);
        for field in Field::ALL {
            let kinds = field.kinds().map_or(7, |kinds| kinds.len());
            // Undecided ones are hatched.
            let undecided = match field {
                Field::Outcome => Some(Outcome::Undecided as usize),
                Field::Regime => Some(RegimeAtV0::Undecided as usize),
                _ => None,
            };
            let kinds = || (0..kinds).filter(|n| Some(*n) != undecided);
            let numbers = || kinds().map(|n| n as f64).collect::<Vec<_>>();
            let cells = match field.storage() {
                Storage::Real => cells.clone(),
                Storage::Kind | Storage::Few => numbers(),
                Storage::Count => (0..20).map(f64::from).collect(),
            };
            let mut known = plane(&cells);
            for gap in Gap::ALL.into_iter().filter(|gap| !gap.is_unknown()) {
                known.plane.cells.push(f64::NAN);
                known.gaps.push(Some(gap));
            }
            let key = of_plane(field, known);
            let colour = |swatch: &Swatch| match swatch {
                Swatch::Box(colour) => *colour,
                Swatch::Gap(gap) => gap.ground(),
                other => panic!("{other:?}"),
            };
            let mut said: Vec<Rgb> = key.legend.entries.iter().map(|e| colour(&e.0)).collect();
            if let Some(scale) = key.paint.scale() {
                // Colours of two-sided scales go with the square root.
                let parts = (-128..=128).map(|i| f64::from(i) / 128.0);
                let parts = parts.flat_map(|t| [0.5 + 0.5 * t, 0.5 + 0.5 * t * t.abs()]);
                let bar = parts.map(|part| key.colour(scale.value(part)));
                let mut bar: Vec<Rgb> = bar.filter(|colour| *colour != colour::ZERO).collect();
                bar.sort_unstable();
                bar.dedup();
                said.extend(bar);
            }
            let all = said.len();
            said.sort_unstable();
            said.dedup();
            assert_eq!(said.len(), all, "{}", field.name());
            let told = |v: &f64| said.contains(&key.colour(*v));
            assert!(cells.iter().all(told), "{}", field.name());
        }
    }

    #[test]
    fn zero_is_no_small_velocity() {
        let key = of(Field::Vc, &[0.0, 0.5, 2.0], false);
        let said: Vec<_> = key.legend.entries.iter().collect();
        assert_eq!(said.len(), 1);
        assert_eq!(said[0].0, Swatch::Box(colour::ZERO));
        assert_eq!(said[0].1, Rich::plain("0: stick-slip never lasts"));
        assert_ne!(key.colour(0.0), key.colour(1e-9));
    }

    /// Unknown values do not count for the scale, and are named in words.
    #[test]
    fn the_unknown_is_no_data() {
        let mut known = plane(&[1.0, 2.0, 1e9]);
        known.gaps[2] = Some(Gap::NotConverged);
        let key = of_plane(Field::VSmooth, known);
        assert!(
            key.paint
                .scale()
                .is_some_and(|scale| scale.value(1.0) < 3.0)
        );
        let said = &key.legend.entries[..];
        let expected = (Swatch::Gap(Gap::NotConverged), Rich::plain("not converged"));
        assert_eq!(said, [expected]);
    }

    /// Teal is stable, whatever its sign.
    #[test]
    fn every_field_has_its_stable_colour() {
        let stable = colour::two_sided(ColourMap::BrBG, 1.0, 1.0);
        for (field, value) in [(Field::DelayMargin, 1.0), (Field::Abscissa, -1.0)] {
            let key = of(field, &[value], false);
            assert_eq!(key.colour(value), stable);
            assert_ne!(key.colour(-value), stable);
        }
    }

    /// Every field makes a key, even of cells without values.
    #[test]
    fn every_field_has_a_key() {
        for field in Field::ALL {
            for cells in [&[f64::NAN][..], &[0.0], &[f64::INFINITY], &[1.0, 2.0]] {
                let key = of(field, cells, false);
                assert!(key.width(1.0) > 0.0, "{field:?} {cells:?}");
                key.colour(cells[0]);
            }
        }
    }
}
