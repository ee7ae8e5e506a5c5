//! A system as text: a file of its own, or a table on one line.

use super::parameter::OwnParameter;
use super::{Form, IGNORED_ROOTS, SpeedAxis, SystemModel};
use crate::text::toml_reader::{key, quoted};

impl OwnParameter {
    /// Everything but the name, as an inline table.
    fn to_toml(&self) -> String {
        format!(
            "{{ long_name = {}, default = {:?}, minimum = {:?}, maximum = {:?}, unit = {} }}",
            quoted(&self.long_name),
            self.default,
            self.minimum,
            self.maximum,
            quoted(&self.unit)
        )
    }
}

impl SpeedAxis {
    fn to_toml(&self) -> String {
        let (name, unit) = (quoted(&self.name), quoted(self.unit.name()));
        format!("{{ name = {name}, period = \"tau\", unit = {unit} }}")
    }
}

impl SystemModel {
    /// The title with the polynomials, for people.
    #[must_use]
    pub(crate) fn in_one_line(&self) -> String {
        let title = Some(&self.title).filter(|title| !title.is_empty());
        let texts = self.expressions().into_iter().map(|(name, text)| {
            let words: Vec<&str> = text.split_whitespace().collect();
            format!("{name} = {}", words.join(" "))
        });
        let texts = texts.collect::<Vec<_>>().join(", ");
        title.map_or(texts.clone(), |title| format!("{title}: {texts}"))
    }

    /// The keys with their values as text.
    fn pairs(&self) -> Vec<(&'static str, String)> {
        let mut pairs = Vec::new();
        if !self.title.is_empty() {
            pairs.push(("title", quoted(&self.title)));
        }
        match &self.form {
            Form::Matrices(of) => pairs.extend(of.pairs()),
            Form::Loop(of) => pairs.extend(of.pairs()),
            Form::Powers(powers) => {
                let each: Vec<String> = powers.iter().map(|of| quoted(&of.text)).collect();
                pairs.push(("D", format!("[{}]", each.join(", "))));
            }
            _ => pairs.extend(
                self.polynomials()
                    .map(|(name, of)| (name, quoted(&of.text))),
            ),
        }
        if self.ignored_roots > 0 {
            pairs.push((IGNORED_ROOTS, self.ignored_roots.to_string()));
        }
        if let Some(speed) = &self.speed_axis {
            pairs.push(("speed_axis", speed.to_toml()));
        }
        pairs
    }

    /// The text of a system file for the same system.
    #[must_use]
    pub(crate) fn to_toml(&self) -> String {
        let pairs = self.pairs().into_iter();
        let mut text: String = pairs
            .map(|(key, value)| format!("{key} = {value}\n"))
            .collect();
        if !self.parameters.is_empty() {
            text += "\n[parameters]\n";
        }
        for own in &self.parameters {
            text += &format!("{} = {}\n", key(&own.name), own.to_toml());
        }
        text
    }

    /// The system on one line, as the value of a key.
    #[must_use]
    pub(crate) fn to_inline_table(&self) -> String {
        let mut pairs = self.pairs();
        let own = self.parameters.iter();
        let own: Vec<String> = own
            .map(|own| format!("{} = {}", key(&own.name), own.to_toml()))
            .collect();
        if !own.is_empty() {
            pairs.push(("parameters", format!("{{ {} }}", own.join(", "))));
        }
        let pairs: Vec<String> = pairs
            .iter()
            .map(|(key, value)| format!("{key} = {value}"))
            .collect();
        format!("{{ {} }}", pairs.join(", "))
    }
}
