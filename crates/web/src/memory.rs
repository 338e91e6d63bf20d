//! Functions that a page calls: text and bytes cross through the memory of WebAssembly.

#![expect(unsafe_code, reason = "addresses and lengths are the only types that both sides have")]

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::workbench::Workbench;

/// Workbench of the page, and the result of the last request.
static STATE: Mutex<(Option<Workbench>, Vec<u8>)> = Mutex::new((None, Vec::new()));

fn state() -> MutexGuard<'static, (Option<Workbench>, Vec<u8>)> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the address of `length` bytes for a request.
#[unsafe(no_mangle)]
pub extern "C" fn flexsc_allocate(length: usize) -> *mut u8 {
    Box::into_raw(vec![0; length].into_boxed_slice()).cast()
}

/// Answers the request at an address that [`flexsc_allocate`] returned with this length, and frees it; returns the length of the
/// result.
///
/// # Safety
/// The address and the length must be those of one call of [`flexsc_allocate`], and of no earlier request.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn flexsc_answer(request: *mut u8, length: usize) -> usize {
    // SAFETY: the caller promises that this is the boxed slice of `flexsc_allocate`, which nothing else frees.
    let request = unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(request, length)) };
    let mut state = state();
    let result = state.0.get_or_insert_default().answer(&request);
    state.1 = result;
    state.1.len()
}

/// Returns the address of the result of the last request.
#[unsafe(no_mangle)]
pub extern "C" fn flexsc_result() -> *const u8 {
    state().1.as_ptr()
}
