//! Messages to the importer, by its callback of FMI 3.0 or FMI 2.0.

#![expect(unsafe_code, reason = "the callbacks are functions of the importer")]

use std::ffi::{CString, c_char, c_int, c_void};

/// Callback of FMI 3.0: environment, status, category and message.
pub type LogMessage = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// Callback of FMI 2.0: environment, name of the instance, status, category, and a format with its arguments.
pub type LogFormatted =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// Callbacks of FMI 2.0.
#[repr(C)]
#[derive(Copy, Clone)]
pub struct CallbackFunctions {
    /// Receiver of messages.
    pub logger: Option<LogFormatted>,
    allocate_memory: *const c_void,
    free_memory: *const c_void,
    step_finished: *const c_void,
    /// Value for the first argument of the callbacks.
    pub environment: *mut c_void,
}

/// Receiver of messages.
#[derive(Copy, Clone)]
pub enum Logger {
    /// Callback of FMI 3.0 with its environment.
    Fmi3(LogMessage, *mut c_void),
    /// Callback of FMI 2.0 with its environment.
    Fmi2(LogFormatted, *mut c_void),
    /// No receiver.
    Silent,
}

impl Logger {
    /// Sends a message about the instance of this name.
    pub fn send(self, name: &str, status: c_int, message: &str) {
        let text = |text: &str| CString::new(text.replace('\0', " ")).unwrap_or_default();
        let (name, category) = (text(name), c"logStatusError");
        // Some importers show the format of FMI 2.0 as it is: it has no arguments.
        let (message, format) = (text(message), text(&message.replace('%', "%%")));
        match self {
            // SAFETY: the importer gave the callback for this use; the texts live until it returns.
            Self::Fmi3(log, environment) => unsafe {
                log(environment, status, category.as_ptr(), message.as_ptr());
            },
            // SAFETY: as above; the format takes no arguments.
            Self::Fmi2(log, environment) => unsafe {
                log(environment, name.as_ptr(), status, category.as_ptr(), format.as_ptr());
            },
            Self::Silent => {}
        }
    }
}
