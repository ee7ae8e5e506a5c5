//! The manifest of a folder of tiles, as JSON with a checksum: which sweep, plan and program the
//! tiles belong to, and how they differ from those asked for.
//!
//! The file is the object of [`Manifest`] with one more field in front, `sha256`: the checksum of
//! the text without that field.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::super::error::StoreError;
use super::super::regular::{self, NotRead};
use super::record::{Digest, digest};
use crate::setting::SweepSpec;
use crate::sweep::Shard;
use crate::sweep::described::root::Provenance;
use crate::sweep::described::schema;
use crate::sweep::plan::Plan;
use crate::text::SpecError;
use crate::text::in_hexadecimal;

/// Name of the file.
pub(crate) const NAME: &str = "manifest.json";

/// Version of the layout of tile files and their folder.
pub(crate) const TILES_FORMAT_VERSION: u32 = 2;

/// The most bytes of a manifest.
const MOST_BYTES: u64 = 64 << 20;

/// How the text begins without the checksum.
const OPENING: &str = "{\n";
/// The text before the checksum.
const SEAL: &str = "{\n  \"sha256\": \"";
/// The text after the checksum.
const SEALED: &str = "\",\n";

fn checksum(text: &str) -> String {
    in_hexadecimal(&digest(text.as_bytes()))
}

/// What the tiles of a folder belong to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// The version of the format of tiles.
    pub tiles_format_version: u32,
    /// The version of the format of maps.
    pub map_format_version: i32,
    /// Version of the program.
    pub program_version: String,
    /// Its git revision.
    pub git_revision: String,
    /// [`Plan::hash`].
    pub plan_hash: String,
    /// The shard, I/N.
    pub shard: String,
    /// Cells of a tile along each axis.
    pub tile_shape: Vec<usize>,
    /// [`Plan::description`].
    pub plan: Vec<(String, String)>,
    /// The sweep file's text.
    pub sweep: String,
}

impl Manifest {
    /// The manifest of a shard of a plan, computed by this program.
    #[must_use]
    pub fn of(plan: &Plan, shard: Shard, program: &Provenance) -> Self {
        Self {
            tiles_format_version: TILES_FORMAT_VERSION,
            map_format_version: schema::FORMAT_VERSION,
            program_version: program.program_version.clone(),
            git_revision: program.git_revision.clone(),
            plan_hash: plan.hash(),
            shard: shard.to_string(),
            tile_shape: plan.tiles.tile_shape().to_vec(),
            plan: plan.description(),
            sweep: plan.spec.text.clone(),
        }
    }

    /// The same manifest for another shard.
    pub(super) fn of_shard(&self, shard: &str) -> Self {
        Self {
            shard: shard.to_owned(),
            ..self.clone()
        }
    }

    /// An error where the tiles of `self`, in `folder`, do not belong to those asked for.
    pub(super) fn refuse_unlike(&self, asked: &Self, folder: &Path) -> Result<(), StoreError> {
        match self.difference(asked) {
            None => Ok(()),
            Some(difference) => Err(StoreError::OtherTiles {
                path: folder.to_owned(),
                difference,
            }),
        }
    }

    /// Reads a manifest from the text of its file.
    ///
    /// # Errors
    /// A description of the fault when the checksum is missing or wrong, or the text is no
    /// manifest.
    pub fn unseal(text: &str) -> Result<Self, String> {
        let sealed = text
            .strip_prefix(SEAL)
            .and_then(|rest| rest.split_once(SEALED));
        let (sum, rest) = sealed.ok_or("it has no checksum")?;
        let body = format!("{OPENING}{rest}");
        if checksum(&body) != sum {
            return Err("its checksum does not fit".to_owned());
        }
        Self::parse(&body)
    }

    /// The text of the manifest file.
    #[must_use]
    pub fn sealed(&self) -> String {
        // The struct has only numbers and strings, so this cannot fail.
        let body = serde_json::to_string_pretty(self).unwrap_or_default() + "\n";
        let rest = body.strip_prefix(OPENING).unwrap_or_default();
        format!("{SEAL}{}{SEALED}{rest}", checksum(&body))
    }

    /// Reads the object without the checksum.
    ///
    /// # Errors
    /// A description of the fault and its place when the text is no manifest.
    pub fn parse(text: &str) -> Result<Self, String> {
        serde_json::from_str(text).map_err(|error| error.to_string())
    }

    pub(super) fn read(path: &Path) -> Result<Self, StoreError> {
        let damaged = |why: String| StoreError::Manifest {
            path: path.to_owned(),
            why,
        };
        let bytes = regular::read(path, MOST_BYTES).map_err(|why| match why {
            NotRead::Refused(error) => StoreError::io("read", path)(error),
            NotRead::Foreign => StoreError::Foreign {
                path: path.to_owned(),
            },
            NotRead::Large(size) => damaged(format!("it has {size} bytes")),
        })?;
        let text = String::from_utf8(bytes).map_err(|error| damaged(error.to_string()))?;
        Self::unseal(&text).map_err(damaged)
    }

    /// A hash of everything that tiles which belong together have in common: all but the shard and
    /// the wording of the sweep.
    #[must_use]
    pub fn layout(&self) -> Digest {
        let all = (
            (self.tiles_format_version, self.map_format_version),
            (&self.program_version, &self.git_revision),
            (&self.plan_hash, &self.tile_shape),
        );
        digest(serde_json::to_string(&all).unwrap_or_default().as_bytes())
    }

    /// The plan of the tiles.
    ///
    /// # Errors
    /// When the sweep's text is no sweep, or gives another plan than it did.
    pub fn read_plan(&self) -> Result<Plan, SpecError> {
        let plan = Plan::new(self.sweep.parse::<SweepSpec>()?)?;
        if plan.hash() != self.plan_hash {
            let message = "its sweep and its plan_hash do not fit together".to_owned();
            return Err(SpecError::whole(message));
        }
        Ok(plan)
    }

    /// The first difference between these tiles and those asked for, in words; none where they
    /// belong together.
    #[must_use]
    pub fn difference(&self, asked: &Self) -> Option<String> {
        let versions = |m: &Self| (m.tiles_format_version, m.map_format_version);
        if versions(self) != versions(asked) {
            let ((t, m), (tiles, map)) = (versions(self), versions(asked));
            return Some(format!(
                "the tiles have format version {t} (maps {m}), this program writes {tiles} (maps \
                {map})"
            ));
        }
        let program = |m: &Self| format!("slipmap {} ({})", m.program_version, m.git_revision);
        if program(self) != program(asked) {
            let (there, here) = (program(self), program(asked));
            return Some(format!("the tiles are by {there}, this is {here}"));
        }
        if self.shard != asked.shard {
            return Some(format!(
                "the tiles are of shard {}, asked for is {}",
                self.shard, asked.shard
            ));
        }
        if self.plan_hash == asked.plan_hash && self.tile_shape == asked.tile_shape {
            return None;
        }
        let only = |these: &Self, those: &Self| {
            let mut facts = these.plan.iter();
            facts.find(|fact| !those.plan.contains(fact)).cloned()
        };
        let found = |facts: &[(String, String)], name: &str| {
            let fact = facts.iter().find(|(n, _)| n == name);
            fact.map_or("none".to_owned(), |(_, value)| value.clone())
        };
        Some(match only(asked, self).or_else(|| only(self, asked)) {
            Some((name, _)) => format!(
                "{name}: {} in the tiles, {} in the sweep",
                found(&self.plan, &name),
                found(&asked.plan, &name),
            ),
            None => "the manifest was changed".to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_flipped_bit_and_cut_of_a_manifest_is_seen() {
        let plan = Plan::new("[axes]\nmu_prime = [-0.3]\ntau = [1.0]".parse().unwrap()).unwrap();
        let manifest = Manifest::of(&plan, Shard::WHOLE, &Provenance::default());
        let text = manifest.sealed();
        assert_eq!(Manifest::unseal(&text), Ok(manifest));
        for bit in 0..text.len() * 8 {
            let mut bytes = text.clone().into_bytes();
            bytes[bit / 8] ^= 1 << (bit % 8);
            // Text that is not UTF-8 is refused earlier.
            if let Ok(text) = String::from_utf8(bytes) {
                assert!(Manifest::unseal(&text).is_err(), "bit {bit}");
            }
        }
        for length in 0..text.len() {
            assert!(Manifest::unseal(&text[..length]).is_err(), "{length}");
        }
    }
}
