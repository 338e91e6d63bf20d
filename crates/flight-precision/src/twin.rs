//! Values of flight code in double precision and their twins in single precision.

/// Value in double precision with a twin in single precision.
pub trait Twin {
    /// Twin in single precision.
    type Single;

    /// Returns the twin, with each number rounded to single precision.
    fn single(&self) -> Self::Single;

    /// Returns the value of a twin, without rounding.
    fn double(single: &Self::Single) -> Self;
}

// Conversions are inlined where whole states are converted.
impl Twin for f64 {
    type Single = f32;

    #[inline]
    fn single(&self) -> f32 {
        *self as f32
    }

    #[inline]
    fn double(single: &f32) -> Self {
        Self::from(*single)
    }
}

/// Defines the twin of types that are the same in both precisions.
macro_rules! same {
    ($($kind:ty),*) => {
        $(impl Twin for $kind {
            type Single = Self;

            #[inline]
            fn single(&self) -> Self {
                *self
            }

            #[inline]
            fn double(single: &Self) -> Self {
                *single
            }
        })*
    };
}

same!(bool, i32, i64, u32, u64, usize);

impl<T: Twin, const N: usize> Twin for [T; N] {
    type Single = [T::Single; N];

    #[inline]
    fn single(&self) -> Self::Single {
        self.each_ref().map(T::single)
    }

    #[inline]
    fn double(single: &Self::Single) -> Self {
        single.each_ref().map(T::double)
    }
}

/// Returns the twins of a list.
pub fn list<T: Twin>(values: &[T]) -> Vec<T::Single> {
    values.iter().map(T::single).collect()
}

/// Calls a function with the twin of a value, which it may change.
pub fn changed<T: Twin, R>(value: &mut T, call: impl FnOnce(&mut T::Single) -> R) -> R {
    let mut twin = value.single();
    let result = call(&mut twin);
    *value = T::double(&twin);
    result
}

/// Calls a function with the twins of a list, which it may change.
pub fn changed_list<T: Twin, R>(values: &mut [T], call: impl FnOnce(&mut [T::Single]) -> R) -> R {
    let mut twins = list(values);
    let result = call(&mut twins);
    values.iter_mut().zip(&twins).for_each(|(value, twin)| *value = T::double(twin));
    result
}
