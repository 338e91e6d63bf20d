//! Pointers from C as types whose methods check for null. All other modules use them, and dereference no pointer.

#![expect(unsafe_code, reason = "pointers of the importer are read and written here, under the rules of FMI")]

use std::ffi::{CStr, c_char};
use std::mem::MaybeUninit;

/// Values that the importer passes.
#[repr(transparent)]
pub struct Values<T>(*const T);

impl<T> Values<T> {
    /// Returns `count` values; `None` for a null pointer, unless `count` is 0.
    pub fn read(&self, count: usize) -> Option<&[T]> {
        if count == 0 {
            return Some(&[]);
        }
        // SAFETY: FMI requires that the importer passes `count` values, which live until the function returns.
        (!self.0.is_null()).then(|| unsafe { std::slice::from_raw_parts(self.0, count) })
    }

    /// Returns the single value; `None` for a null pointer.
    pub fn single(&self) -> Option<&T> {
        self.read(1).and_then(<[T]>::first)
    }
}

/// Place for values that the importer gets.
#[repr(transparent)]
pub struct Results<T>(*mut T);

impl<T> Results<T> {
    /// Returns the place for `count` values, which need not hold any; `None` for a null pointer, unless `count` is 0.
    pub fn place(&mut self, count: usize) -> Option<&mut [MaybeUninit<T>]> {
        if count == 0 {
            return Some(&mut []);
        }
        // SAFETY: FMI requires that the importer passes space for `count` values, which nothing else uses until the function
        // returns.
        (!self.0.is_null()).then(|| unsafe { std::slice::from_raw_parts_mut(self.0.cast(), count) })
    }

    /// Writes a value in each of `count` places; `None` for a null pointer, unless `count` is 0.
    pub fn fill(&mut self, count: usize, value: T) -> Option<()>
    where
        T: Copy,
    {
        self.place(count)?.fill(MaybeUninit::new(value));
        Some(())
    }

    /// Writes a single value, unless the pointer is null.
    pub fn write(&mut self, value: T) {
        if let Some([place]) = self.place(1) {
            place.write(value);
        }
    }
}

impl<T> Results<Held<T>> {
    /// Puts an object, or the null pointer, where the importer holds one, and frees that one; `None` for a null pointer.
    pub fn replace(&mut self, held: Held<T>) -> Option<()> {
        // SAFETY: FMI requires that the importer passes a pointer to a null pointer or to an object that it got from this library
        // and has not freed.
        let place = unsafe { self.0.as_mut() }?;
        std::mem::replace(place, held).free();
        Some(())
    }
}

/// Text that the importer passes.
#[repr(transparent)]
pub struct Text(*const c_char);

impl Text {
    /// Returns the text; empty for a null pointer.
    pub fn read(&self) -> String {
        if self.0.is_null() {
            return String::new();
        }
        // SAFETY: FMI requires that texts end with a null byte and live until the function returns.
        unsafe { CStr::from_ptr(self.0) }.to_string_lossy().into_owned()
    }
}

/// Object that the importer holds and that this library has made: an instance or a state.
#[repr(transparent)]
pub struct Held<T>(*mut T);

impl<T> Held<T> {
    /// Hands an object over to the importer.
    pub fn new(object: T) -> Self {
        Self(Box::into_raw(Box::new(object)))
    }

    /// Returns the null pointer.
    pub const fn null() -> Self {
        Self(std::ptr::null_mut())
    }

    /// Returns the object; `None` for a null pointer.
    pub fn get(&mut self) -> Option<&mut T> {
        // SAFETY: FMI requires that the importer passes a pointer that it got from this library and has not freed, and that it
        // calls no two functions with it at the same time.
        unsafe { self.0.as_mut() }
    }

    /// Frees the object, unless the pointer is null.
    pub fn free(self) {
        if !self.0.is_null() {
            // SAFETY: as for `get`; the pointer was made by `Box::into_raw`.
            drop(unsafe { Box::from_raw(self.0) });
        }
    }
}
