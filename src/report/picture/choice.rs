//! Chooses the field of a picture and its title.

use super::error::PictureError;
use super::options::{Named, PictureOptions};
use super::text::{self, Rich};
use crate::meaning::first;
use crate::report::visible::visible_line;
use crate::setting::Field;
use crate::store::MapFile;
use crate::sweep::described::schema::root;

/// The field that a picture shows.
pub(super) struct Choice {
    pub field: Field,
    /// Whether it was neither requested nor named by the sweep.
    by_default: bool,
}

impl Choice {
    pub(super) fn of(map: &MapFile, options: &PictureOptions) -> Result<Self, PictureError> {
        let chosen = options.field.or_else(|| named(map, options));
        let field = chosen.unwrap_or_else(|| first::field(None, map.fields()));
        if !map.fields().contains(&field) {
            let held: Vec<&str> = map.fields().iter().map(|f| f.name()).collect();
            return Err(PictureError::NoSuchField {
                field: field.name(),
                held: held.join(", "),
            });
        }
        Ok(Self {
            field,
            by_default: chosen.is_none(),
        })
    }

    /// Whether curves of the map show as much as its cells.
    pub(super) fn leaves_curves(&self, map: &MapFile) -> bool {
        self.by_default && first::says_more(map.fields()).is_none()
    }

    /// The fields of one line picture: this one and, if it is shown by default and without
    /// `several` values of an axis, those that it is compared with.
    pub(super) fn shown_together(&self, map: &MapFile, several: bool) -> Vec<Field> {
        if !self.by_default || several || !self.field.of_limit() {
            return vec![self.field];
        }
        let velocities = Field::LIMIT_VELOCITIES.into_iter();
        let held: Vec<Field> = velocities.filter(|f| map.fields().contains(f)).collect();
        if held.is_empty() {
            vec![self.field]
        } else {
            held
        }
    }
}

/// The field named for pictures by the sweep file at hand, else by the map's own sweep.
pub(super) fn named(map: &MapFile, options: &PictureOptions) -> Option<Field> {
    let named = match options.named {
        Named::InMap => map.sweep().ok()?.picture,
        Named::As(field) => Some(field),
        Named::Nothing => None,
    };
    named.filter(|field| map.fields().contains(field))
}

/// The most characters of a title.
const LONGEST_TITLE: usize = 400;

/// The title of a picture of `field` if the sweep has none.
fn usual_title(map: &MapFile, field: Field) -> &'static str {
    // Beside critical velocities, the outcome is the end of stick-slip.
    let beside_vc = || map.fields().iter().any(|field| field.of_vc());
    if field.of_limit() {
        "Critical velocity as the delay vanishes"
    } else if field.of_vc() || (field == Field::Outcome && beside_vc()) {
        "The critical velocity"
    } else if field.of_basin() {
        "The basin of attraction of sliding"
    } else if field.of_motion() {
        "Motions of the block"
    } else {
        "Stability of sliding"
    }
}

/// The requested title, empty for none, or that of the map's sweep.
pub(super) fn title(map: &MapFile, options: &PictureOptions) -> Option<String> {
    if options.untitled() {
        return Some(String::new());
    }
    let of_sweep = options.title.clone().or_else(|| map.root_text(root::TITLE));
    let of_system = || Some(map.system()?.title.clone());
    let said = |title: &String| !title.trim().is_empty();
    let title = of_sweep.filter(said).or_else(|| of_system().filter(said))?;
    Some(shortened(&title))
}

/// Shortens a text of a map, which may come from anywhere.
fn shortened(text: &str) -> String {
    let cut: String = text.chars().take(LONGEST_TITLE).collect();
    visible_line(&cut)
}

/// The title of a picture of `field`, and notes that name the field. The title of a sweep is about
/// the field that it shows by default. A picture of another field is headed by that field, whether
/// the sweep has a title or not.
pub(super) fn head(map: &MapFile, field: Field, options: &PictureOptions) -> (String, Vec<Rich>) {
    let unit = map.field_unit(field);
    let shown = first::field(named(map, options), map.fields());
    let about = shortened(&map.long_name(field));
    match title(map, options) {
        title if field != shown && options.title.is_none() => {
            let of = title.map(|title| Rich::prose(&format!("from: {title}")));
            let about = about + &text::suffix(&unit, "  (", ")");
            (capitalised(&about), of.into_iter().collect())
        }
        title => {
            let title = title.unwrap_or_else(|| usual_title(map, field).into());
            (title, vec![text::field_note(&about, &unit)])
        }
    }
}

fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    let first = characters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(characters).collect()
}
