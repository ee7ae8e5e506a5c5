//! Sweeps as texts that were sent. A text names no files: none is opened for it.

use crate::serve::problem::Problem;
use crate::setting::SweepSpec;
use crate::setting::table_file::{Inlined, Named, NotInlined};
use crate::sweep::Plan;
use crate::text::SpecError;

/// The most points of an axis: what is sent at the same time is to take little memory.
const MOST_POINTS: u64 = 1 << 17;

/// A sweep that was sent.
#[derive(Debug)]
pub(super) struct Posted {
    /// Its plan.
    pub plan: Plan,
    /// What is to be known of its friction law.
    pub remarks: Vec<String>,
}

impl Posted {
    /// Reads a text.
    pub(super) fn read(text: &str) -> Result<Self, Problem> {
        let inlined = Inlined::new(text, |_, named| Err(refused(named).into()));
        let inlined = inlined.map_err(|not| match not {
            NotInlined::Here(error) | NotInlined::There { error, .. } => error,
        })?;
        let spec = SweepSpec::read(&inlined.text, MOST_POINTS);
        let plan = spec
            .and_then(Plan::new)
            .map_err(|error: SpecError| inlined.in_original(error))?;
        let mut remarks = inlined.remarks;
        remarks.extend(plan.spec.curve_remark());
        Ok(Self { plan, remarks })
    }
}

/// Why a named file is not read.
fn refused(named: Named) -> &'static str {
    match named {
        Named::System => "a sweep that is handed in names no files: put the table [system] here",
        Named::Table => "a sweep that is handed in names no files: put the points here",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_file_is_opened_for_a_text() {
        let axes = "[axes]\nv0 = [0.1]\ntau = [1]\n";
        for (named, at) in [
            (
                "[friction]\nlaw = \"table\"\ntable = \"/etc/passwd\"\n",
                "\"/etc/passwd\"",
            ),
            ("friction.table = { file = \"../x\" }\n", "{ file"),
            ("system = \"/etc/hostname\"\n", "\"/etc/hostname\""),
            ("system = \"sweeps/systems/turning.toml\"\n", "\"sweeps"),
        ] {
            let text = format!("{named}{axes}");
            let problem = Posted::read(&text).unwrap_err();
            let detail = problem.detail.unwrap();
            assert!(detail.contains("names no files"), "{detail}");
            assert!(text[problem.span.unwrap()[0]..].starts_with(at), "{named}");
        }
        let text =
            format!("[friction]\nlaw = \"table\"\ntable = {{ text = '0 0.5\n1 0.4' }}\n{axes}");
        let text = text.replace('\'', "'''");
        assert!(Posted::read(&text).unwrap().plan.cells() == 1);
    }
}
