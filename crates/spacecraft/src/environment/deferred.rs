//! Values that take time to compute and follow from others: computed where they are first needed, and shared by copies.

use std::sync::{Arc, OnceLock};

/// Value that follows from the other fields of its owner.
#[derive(Clone, Debug)]
pub(super) struct Deferred<T>(Arc<OnceLock<T>>);

impl<T> Default for Deferred<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> PartialEq for Deferred<T> {
    /// Returns true: the fields from which the value follows are compared in its place.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<T> Deferred<T> {
    /// Returns the value, and computes it where it is not known yet.
    pub fn get_or(&self, compute: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(compute)
    }

    /// Returns true if the value has been computed.
    #[cfg(test)]
    pub fn is_known(&self) -> bool {
        self.0.get().is_some()
    }
}
