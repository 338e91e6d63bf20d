//! Library calls on untrusted bytes: a panic of the library becomes an error.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// True while a panic of this thread is expected.
    static CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// Calls a closure; returns `None` if it panics, without printing the panic.
pub fn contained<T>(work: impl FnOnce() -> T) -> Option<T> {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| {
        let others = take_hook();
        set_hook(Box::new(move |panic| {
            if !CONTAINED.get() {
                others(panic);
            }
        }));
    });
    CONTAINED.set(true);
    let done = catch_unwind(AssertUnwindSafe(work));
    CONTAINED.set(false);
    done.ok()
}

#[cfg(test)]
mod tests {
    use super::contained;

    #[test]
    fn a_panic_is_no_result() {
        assert_eq!(contained(|| 1), Some(1));
        assert_eq!(contained(|| [1, 2].iter().position(|n| *n > 7).expect("none")), None);
        assert!(std::panic::catch_unwind(|| contained(|| panic!("of another kind"))).is_ok());
    }
}
