//! Importer of FMUs for tests: the C functions of the library, called as another simulator would call them.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;

use flexsc_core::Scenario;
use flexsc_cosim::{FmuContent, FmuPart, FmuRun, VariableTable, find_library};
use tempfile::TempDir;

pub type Handle = *mut c_void;

/// Loaded library.
pub struct Library(*mut c_void);

impl Library {
    /// Returns the address of a function, if it is there.
    pub fn address(&self, name: &str) -> Option<*mut c_void> {
        let name = CString::new(name).expect("a name");
        // SAFETY: the handle is that of a loaded library, and the name a text.
        let address = unsafe { libc::dlsym(self.0, name.as_ptr()) };
        (!address.is_null()).then_some(address)
    }
}

/// Messages that the library has sent.
#[derive(Default)]
pub struct Messages(pub Vec<String>);

unsafe extern "C" fn log3(
    environment: *mut c_void,
    _status: c_int,
    _category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the environment is that of `Fmu3::instantiate`, and the message a text.
    let (messages, message) = unsafe { (&mut *environment.cast::<Messages>(), CStr::from_ptr(message)) };
    messages.0.push(message.to_string_lossy().into_owned());
}

/// Returns the library that cargo has built beside this test.
pub fn library() -> Library {
    let test = std::env::current_exe().expect("a path");
    let path = find_library(test.parent()).expect("cargo builds the library");
    let path = CString::new(path.to_string_lossy().as_bytes()).expect("a path");
    // SAFETY: the library has no initialization.
    let handle = unsafe { libc::dlopen(path.as_ptr(), libc::RTLD_NOW) };
    assert!(!handle.is_null());
    Library(handle)
}

/// Returns a shipped scenario with other values of some keys.
pub fn shipped(name: &str, keys: &[(&str, &str)]) -> Scenario {
    let path = format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut document = flexsc_core::Document::load(path.as_ref()).expect("a document");
    for (key, value) in keys {
        document.set_text(key, value).expect("a key");
    }
    Scenario::from_document(&document).expect("a scenario")
}

/// Returns the memory of this process (kB); 0 where the system does not state it.
pub fn memory_kb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}

/// Result of `fmi3DoStep`.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Stepped {
    pub status: c_int,
    pub is_event: bool,
    pub is_early: bool,
    pub reached: f64,
}

/// Unpacked FMU with an instance of FMI 3.0.
pub struct Fmu3 {
    pub library: Library,
    pub table: VariableTable,
    pub content: FmuContent,
    pub messages: Box<Messages>,
    instance: Handle,
    resources: TempDir,
}

/// Calls a function of the library by its name and types.
#[macro_export]
macro_rules! c_call {
    ($library:expr, $name:expr, ($($value:expr => $of:ty),*) -> $result:ty) => {{
        let address = $library.address($name).expect($name);
        // SAFETY: the types are those of the standard.
        unsafe {
            let function =
                std::mem::transmute::<*mut std::ffi::c_void, unsafe extern "C" fn($($of),*) -> $result>(address);
            function($($value),*)
        }
    }};
}

impl Fmu3 {
    /// Unpacks an FMU, and creates an instance, in event mode if `uses_events`.
    pub fn new(scenario: &Scenario, part: FmuPart, uses_events: bool) -> Self {
        let content = FmuContent::new(scenario, part).expect("content");
        let table = FmuRun::new(content.clone()).expect("a run").table().clone();
        let resources = TempDir::new().expect("a directory");
        std::fs::write(resources.path().join("scenario.toml"), &content.toml).expect("written");
        std::fs::write(resources.path().join("part.txt"), content.part.name()).expect("written");
        let mut fmu = Self {
            library: library(),
            table,
            content,
            messages: Box::default(),
            instance: ptr::null_mut(),
            resources,
        };
        fmu.instance = fmu.instantiate(&fmu.content.token(), uses_events);
        fmu
    }

    /// Returns the instance.
    pub fn handle(&self) -> Handle {
        self.instance
    }

    /// Returns the directory of the resources.
    pub fn resources(&self) -> &Path {
        self.resources.path()
    }

    /// Writes another text over one of the resources.
    pub fn damage(&self, name: &str, text: &[u8]) {
        std::fs::write(self.resources.path().join(name), text).expect("written");
    }

    /// Creates an instance with this token; null if that fails.
    pub fn instantiate(&mut self, token: &str, uses_events: bool) -> Handle {
        let resources = format!("{}/", self.resources.path().display());
        let [name, token, resources] =
            ["a", token, &resources].map(|text| CString::new(text).expect("a text"));
        let messages: *mut Messages = &raw mut *self.messages;
        c_call!(self.library, "fmi3InstantiateCoSimulation", (
            name.as_ptr() => *const c_char, token.as_ptr() => *const c_char, resources.as_ptr() => *const c_char,
            false => bool, false => bool, uses_events => bool, uses_events => bool,
            ptr::null() => *const u32, 0 => usize, messages.cast() => *mut c_void,
            log3 => unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char),
            ptr::null() => *const c_void
        ) -> Handle)
    }

    /// Initializes the instance, with this stop time.
    pub fn begin(&self, stop: Option<f64>) {
        assert_eq!(self.try_begin(stop), [0, 0], "{:?}", self.messages.0);
    }

    /// Initializes the instance, with this stop time; returns the status of the begin and of the end of the initialization.
    pub fn try_begin(&self, stop: Option<f64>) -> [c_int; 2] {
        let (defined, stop) = (stop.is_some(), stop.unwrap_or(0.0));
        let entered = c_call!(self.library, "fmi3EnterInitializationMode", (
            self.instance => Handle, false => bool, 0.0 => f64, 0.0 => f64, defined => bool, stop => f64
        ) -> c_int);
        [entered, self.mode("fmi3ExitInitializationMode")]
    }

    /// Calls a function that changes the mode.
    pub fn mode(&self, name: &str) -> c_int {
        c_call!(self.library, name, (self.instance => Handle) -> c_int)
    }

    /// Ends an event.
    pub fn update(&self) {
        let mut flags = [true; 5];
        let [a, b, c, d, e] = &mut flags;
        let mut next = 0.0;
        let status = c_call!(self.library, "fmi3UpdateDiscreteStates", (
            self.instance => Handle, a => *mut bool, b => *mut bool, c => *mut bool, d => *mut bool, e => *mut bool,
            &raw mut next => *mut f64
        ) -> c_int);
        assert_eq!((status, flags), (0, [false; 5]));
    }

    /// Steps from a communication point.
    pub fn step(&self, from: f64, size: f64) -> Stepped {
        let (mut is_event, mut ends, mut is_early, mut reached) = (false, true, false, f64::NAN);
        let status = c_call!(self.library, "fmi3DoStep", (
            self.instance => Handle, from => f64, size => f64, true => bool, &raw mut is_event => *mut bool,
            &raw mut ends => *mut bool, &raw mut is_early => *mut bool, &raw mut reached => *mut f64
        ) -> c_int);
        assert!(!ends);
        Stepped { status, is_event, is_early, reached }
    }

    /// Returns the reference of a variable.
    pub fn reference(&self, name: &str) -> u32 {
        self.table.find(name).unwrap_or_else(|| panic!("{name}")).reference
    }

    /// Returns floating-point values.
    pub fn reals<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        let references = names.map(|name| self.reference(name));
        let mut values = [0.0; N];
        let status = c_call!(self.library, "fmi3GetFloat64", (
            self.instance => Handle, references.as_ptr() => *const u32, N => usize, values.as_mut_ptr() => *mut f64, N => usize
        ) -> c_int);
        assert_eq!(status, 0, "{:?}", self.messages.0);
        values
    }

    /// Returns integers.
    pub fn integers<const N: usize>(&self, names: [&str; N]) -> [i64; N] {
        let references = names.map(|name| self.reference(name));
        let mut values = [0; N];
        let status = c_call!(self.library, "fmi3GetInt64", (
            self.instance => Handle, references.as_ptr() => *const u32, N => usize, values.as_mut_ptr() => *mut i64, N => usize
        ) -> c_int);
        assert_eq!(status, 0, "{:?}", self.messages.0);
        values
    }

    /// Sets a floating-point value; returns the status.
    pub fn set(&self, name: &str, value: f64) -> c_int {
        let reference = self.reference(name);
        c_call!(self.library, "fmi3SetFloat64", (
            self.instance => Handle, &raw const reference => *const u32, 1 => usize, &raw const value => *const f64, 1 => usize
        ) -> c_int)
    }

    /// Sets the grid of communication points.
    pub fn set_grid(&self, nanoseconds: u64) {
        let reference = self.reference("snap_ns");
        assert_eq!(self.mode("fmi3EnterConfigurationMode"), 0);
        let status = c_call!(self.library, "fmi3SetUInt64", (
            self.instance => Handle, &raw const reference => *const u32, 1 => usize, &raw const nanoseconds => *const u64,
            1 => usize
        ) -> c_int);
        assert_eq!((status, self.mode("fmi3ExitConfigurationMode")), (0, 0));
    }

    /// Returns true if a clock ticks.
    pub fn ticks(&self, name: &str) -> bool {
        let reference = self.reference(name);
        let mut value = false;
        let status = c_call!(self.library, "fmi3GetClock", (
            self.instance => Handle, &raw const reference => *const u32, 1 => usize, &raw mut value => *mut bool
        ) -> c_int);
        assert_eq!(status, 0, "{:?}", self.messages.0);
        value
    }

    /// Returns the interval of a clock as a fraction.
    pub fn interval(&self, name: &str) -> (u64, u64) {
        let reference = self.reference(name);
        let (mut counter, mut resolution, mut qualifier) = (0, 0, 0);
        let status = c_call!(self.library, "fmi3GetIntervalFraction", (
            self.instance => Handle, &raw const reference => *const u32, 1 => usize, &raw mut counter => *mut u64,
            &raw mut resolution => *mut u64, &raw mut qualifier => *mut c_int
        ) -> c_int);
        assert_eq!((status, qualifier), (0, 2));
        (counter, resolution)
    }

    /// Returns the state.
    pub fn state(&self) -> Handle {
        let mut state = ptr::null_mut();
        let status = c_call!(self.library, "fmi3GetFMUState", (
            self.instance => Handle, &raw mut state => *mut Handle
        ) -> c_int);
        assert_eq!(status, 0);
        state
    }

    /// Sets a state, and frees it.
    pub fn restore(&self, mut state: Handle) {
        let set =
            c_call!(self.library, "fmi3SetFMUState", (self.instance => Handle, state => Handle) -> c_int);
        let freed = c_call!(self.library, "fmi3FreeFMUState", (
            self.instance => Handle, &raw mut state => *mut Handle
        ) -> c_int);
        assert_eq!((set, freed, state), (0, 0, ptr::null_mut()));
    }

    /// Returns the bytes of a state, and frees it.
    pub fn bytes(&self, mut state: Handle) -> Vec<u8> {
        let mut size = 0_usize;
        c_call!(self.library, "fmi3SerializedFMUStateSize", (
            self.instance => Handle, state => Handle, &raw mut size => *mut usize
        ) -> c_int);
        let mut bytes = vec![0_u8; size];
        let status = c_call!(self.library, "fmi3SerializeFMUState", (
            self.instance => Handle, state => Handle, bytes.as_mut_ptr() => *mut u8, size => usize
        ) -> c_int);
        c_call!(self.library, "fmi3FreeFMUState", (self.instance => Handle, &raw mut state => *mut Handle) -> c_int);
        assert!(status == 0 && size > 0);
        bytes
    }

    /// Returns the state of these bytes; `None` if they are refused.
    pub fn deserialized(&self, bytes: &[u8]) -> Option<Handle> {
        self.deserialized_over(bytes, ptr::null_mut())
    }

    /// Returns the state of these bytes in the place of another one, which the library frees; `None` if they are refused.
    pub fn deserialized_over(&self, bytes: &[u8], mut state: Handle) -> Option<Handle> {
        let status = c_call!(self.library, "fmi3DeserializeFMUState", (
            self.instance => Handle, bytes.as_ptr() => *const u8, bytes.len() => usize, &raw mut state => *mut Handle
        ) -> c_int);
        (status == 0).then_some(state)
    }

    /// Steps from 0 to `end` in steps of `size`, through all events, and calls `look` with the number of each communication
    /// point, and with `None` at the events.
    pub fn run(&self, end: f64, size: f64, uses_events: bool, mut look: impl FnMut(&Self, Option<usize>)) {
        if uses_events {
            self.update();
            assert_eq!(self.mode("fmi3EnterStepMode"), 0);
        }
        let (mut time, mut points) = (0.0, 0);
        loop {
            let next = (points + 1) as f64 * size;
            if next > end * (1.0 + 1e-12) {
                return;
            }
            let stepped = self.step(time, next - time);
            assert_eq!(stepped.status, 0, "{:?}", self.messages.0);
            assert!(uses_events || !stepped.is_event);
            if stepped.is_event {
                assert_eq!(self.mode("fmi3EnterEventMode"), 0);
                look(self, None);
                self.update();
                assert_eq!(self.mode("fmi3EnterStepMode"), 0);
            }
            time = if stepped.is_early { stepped.reached } else { next };
            if !stepped.is_early {
                look(self, Some(points));
                points += 1;
            }
        }
    }
}

impl Drop for Fmu3 {
    fn drop(&mut self) {
        c_call!(self.library, "fmi3FreeInstance", (self.instance => Handle) -> ());
    }
}
