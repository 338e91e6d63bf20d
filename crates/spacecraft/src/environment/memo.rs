//! Last values of a function of time: a step of the integration asks for those at its nodes in every iteration.

use std::sync::Mutex;

/// Number of values that are kept.
const SLOTS: usize = 8;

/// Values of a function at the last times at which it was evaluated, each in the slot of its time; no slots before the
/// first.
#[derive(Debug)]
pub(super) struct Memo<T>(Mutex<Vec<Option<(u64, T)>>>);

impl<T> Default for Memo<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T> Clone for Memo<T> {
    /// Returns an empty memo: the copy may become that of another function.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<T> PartialEq for Memo<T> {
    /// Returns true: the function is compared in its place.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<T: Copy> Memo<T> {
    /// Returns the value at a time (s), and computes it if it is not kept, or while another thread reads.
    #[inline]
    pub fn get_or(&self, t: f64, compute: impl FnOnce() -> T) -> T {
        let Ok(mut kept) = self.0.try_lock() else { return compute() };
        if kept.is_empty() {
            kept.resize(SLOTS, None);
        }
        let key = t.to_bits();
        let slot = &mut kept[(key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 61) as usize];
        match slot {
            Some((known, value)) if *known == key => *value,
            _ => slot.insert((key, compute())).1,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn a_value_is_computed_once_and_copies_forget_it() {
        let (memo, count) = (Memo::default(), Cell::new(0));
        let square = |memo: &Memo<f64>, t: f64| {
            memo.get_or(t, || {
                count.set(count.get() + 1);
                t * t
            })
        };
        for _ in 0..3 {
            assert_eq!([1.5, -2.0].map(|t| square(&memo, t)), [2.25, 4.0]);
        }
        assert_eq!(count.get(), 2);
        assert_eq!(square(&memo.clone(), 1.5), 2.25);
        assert_eq!(count.get(), 3);
        // More times than there are slots.
        for t in (0..100).map(f64::from).chain((0..100).map(f64::from)) {
            assert_eq!(square(&memo, t), t * t);
        }
        // While another reads.
        let guard = memo.0.lock();
        assert_eq!(square(&memo, 1.5), 2.25);
        drop(guard);
    }
}
