//! Checks that a sweep of a system is consistent.

use super::Draft;
use crate::setting::parameter::Parameter;
use crate::setting::system_draft::{SystemDraft, refused};
use crate::setting::values::Setting;
use crate::text::SpecError;

impl Draft {
    /// Checks a sweep of a system. Returns the parameters that are no axes.
    pub(super) fn check_system(&self, system: &SystemDraft) -> Result<Setting, SpecError> {
        self.check_degrees()?;
        let tau = Parameter::Tau;
        if !system.given.iter().any(|(of, _)| *of == tau) {
            return Err(SpecError {
                span: self.axes_place.clone(),
                ..SpecError::whole("tau is not given").help(format!(
                    "tau: {}, {}",
                    tau.long_name(),
                    tau.allowed()
                ))
            });
        }
        for (field, place) in self.limit.fields() {
            if let Some((why, help)) = refused(*field, &system.model) {
                let message = format!("{}: {why}", field.name());
                return Err(SpecError::at(place.clone(), message).help(help));
            }
        }
        Ok(system.setting.clone())
    }
}
