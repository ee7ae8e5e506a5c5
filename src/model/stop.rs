//! A flag that ends computations nobody waits for any more.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that ends computations: each then comes to its end soon, and its answer means nothing. A
/// motion takes no further step, and its state is NaN. By default nothing ends them.
#[derive(Debug, Clone, Default)]
pub struct Stop(Option<Arc<AtomicBool>>);

impl Stop {
    /// Ends computations once `flag` is set.
    #[must_use]
    pub fn when(flag: &Arc<AtomicBool>) -> Self {
        Self(Some(Arc::clone(flag)))
    }

    /// Whether it is set.
    #[inline]
    #[must_use]
    pub fn is_set(&self) -> bool {
        match &self.0 {
            Some(flag) => flag.load(Ordering::Relaxed),
            None => false,
        }
    }
}

/// Computations are compared without regard to who waits for them.
impl PartialEq for Stop {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
