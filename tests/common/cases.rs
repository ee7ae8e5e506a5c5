//! How many cases proptest tries, and where it keeps those that failed: in the folder that those of
//! `src` are kept in.

use proptest::prelude::ProptestConfig;
use proptest::test_runner::FileFailurePersistence;

/// Configures `cases` cases; those that fail are kept in the file `kept`, from the package's folder
/// on.
pub(crate) fn cases(cases: u32, kept: &'static str) -> ProptestConfig {
    ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(kept))),
        ..ProptestConfig::with_cases(cases)
    }
}
