//! Functions that a page calls: requests and results cross through the memory of WebAssembly.
//!
//! A page puts a request at the address that [`flexsc_allocate`] returns, calls [`flexsc_answer`], and reads the result at
//! [`flexsc_result`].

#![expect(unsafe_code, reason = "addresses and lengths are the only types that both sides have")]

use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use flexsc_web::Workbench;

/// Workbench of the page, and the result of the last request.
static STATE: LazyLock<Mutex<(Workbench, Vec<u8>)>> = LazyLock::new(|| {
    // A panic ends the module; its words are all that is left of it.
    std::panic::set_hook(Box::new(|panic| {
        let text = panic.to_string();
        page::failed(text.as_ptr(), text.len());
    }));
    Mutex::new((Workbench::new(|part| page::progress(part)), Vec::new()))
});

/// Functions of the page.
mod page {
    #[link(wasm_import_module = "flexsc")]
    unsafe extern "C" {
        /// Takes the part of a run that is done, from 0 to 1.
        pub safe fn progress(part: f64);
        /// Takes the words of a panic.
        pub safe fn failed(address: *const u8, length: usize);
    }
}

fn state() -> MutexGuard<'static, (Workbench, Vec<u8>)> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the address of `length` bytes for a request.
#[unsafe(no_mangle)]
pub extern "C" fn flexsc_allocate(length: usize) -> *mut u8 {
    Box::into_raw(vec![0_u8; length].into_boxed_slice()).cast()
}

/// Answers the request at an address that [`flexsc_allocate`] returned with this length, and frees it; returns the length of
/// the result.
///
/// # Safety
/// The address and the length must be those of one call of [`flexsc_allocate`], and of no earlier request.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn flexsc_answer(request: *mut u8, length: usize) -> usize {
    // SAFETY: the caller promises that this is the boxed slice of `flexsc_allocate`, which nothing else frees.
    let request = unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(request, length)) };
    let mut state = state();
    let result = state.0.answer(&request);
    state.1 = result;
    state.1.len()
}

/// Returns the address of the result of the last request.
#[unsafe(no_mangle)]
pub extern "C" fn flexsc_result() -> *const u8 {
    state().1.as_ptr()
}

fn main() {}
