//! Importer of an FMU that calls the C functions of FMI 3.0 or 2.0 as the lines of a text say, in any order and with any values.
//!
//! A line is a word and its values. `new VERSION EVENTS` creates an instance, `initialize STOP`, `step AT SIZE`,
//! `get KIND REFERENCE COUNT` and `set KIND REFERENCE VALUE` call the functions of these names, `save`, `load`, `free`, `write`
//! and `read` those of states, each with the number of one; `again` reads what a state wrote, and writes it again. `edit OLD NEW`
//! changes the written bytes, and `put MEMBER VALUE` the value behind a member in them. Other words are functions of the instance
//! alone. The pointers are right, or null.

#![expect(unsafe_code, reason = "the functions of the library are those of C")]

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;

use flexsc_cosim::FmuContent;
// The library has the functions below.
use flexsc_fmi as _;

type Handle = *mut c_void;

// SAFETY: the declarations are those of the standard. All pointers come from the importer below: they are null, or point to
// what lives until the function returns.
unsafe extern "C" {
    safe fn fmi3InstantiateCoSimulation(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        event_mode_used: bool,
        early_return_allowed: bool,
        intermediate: *const u32,
        intermediate_count: usize,
        environment: Handle,
        log: *const c_void,
        update: *const c_void,
    ) -> Handle;
    safe fn fmi3FreeInstance(instance: Handle);
    safe fn fmi3EnterInitializationMode(
        of: Handle,
        b: bool,
        x: f64,
        start: f64,
        has_stop: bool,
        stop: f64,
    ) -> c_int;
    safe fn fmi3ExitInitializationMode(of: Handle) -> c_int;
    safe fn fmi3EnterConfigurationMode(of: Handle) -> c_int;
    safe fn fmi3ExitConfigurationMode(of: Handle) -> c_int;
    safe fn fmi3EnterEventMode(of: Handle) -> c_int;
    safe fn fmi3EnterStepMode(of: Handle) -> c_int;
    safe fn fmi3EvaluateDiscreteStates(of: Handle) -> c_int;
    safe fn fmi3Terminate(of: Handle) -> c_int;
    safe fn fmi3Reset(of: Handle) -> c_int;
    safe fn fmi3UpdateDiscreteStates(
        of: Handle,
        a: *mut bool,
        b: *mut bool,
        c: *mut bool,
        d: *mut bool,
        e: *mut bool,
        time: *mut f64,
    ) -> c_int;
    safe fn fmi3DoStep(
        of: Handle,
        from: f64,
        size: f64,
        no_earlier: bool,
        event: *mut bool,
        terminate: *mut bool,
        early: *mut bool,
        reached: *mut f64,
    ) -> c_int;
    safe fn fmi3GetFloat64(of: Handle, r: *const u32, n: usize, to: *mut f64, m: usize) -> c_int;
    safe fn fmi3SetFloat64(of: Handle, r: *const u32, n: usize, from: *const f64, m: usize) -> c_int;
    safe fn fmi3GetInt64(of: Handle, r: *const u32, n: usize, to: *mut i64, m: usize) -> c_int;
    safe fn fmi3SetInt64(of: Handle, r: *const u32, n: usize, from: *const i64, m: usize) -> c_int;
    safe fn fmi3GetUInt64(of: Handle, r: *const u32, n: usize, to: *mut u64, m: usize) -> c_int;
    safe fn fmi3SetUInt64(of: Handle, r: *const u32, n: usize, from: *const u64, m: usize) -> c_int;
    safe fn fmi3GetClock(of: Handle, r: *const u32, n: usize, to: *mut bool) -> c_int;
    safe fn fmi3SetClock(of: Handle, r: *const u32, n: usize, from: *const bool) -> c_int;
    safe fn fmi3GetIntervalDecimal(of: Handle, r: *const u32, n: usize, to: *mut f64, q: *mut c_int)
    -> c_int;
    safe fn fmi3GetFMUState(of: Handle, state: *mut Handle) -> c_int;
    safe fn fmi3SetFMUState(of: Handle, state: Handle) -> c_int;
    safe fn fmi3FreeFMUState(of: Handle, state: *mut Handle) -> c_int;
    safe fn fmi3SerializedFMUStateSize(of: Handle, state: Handle, size: *mut usize) -> c_int;
    safe fn fmi3SerializeFMUState(of: Handle, state: Handle, to: *mut u8, size: usize) -> c_int;
    safe fn fmi3DeserializeFMUState(of: Handle, from: *const u8, size: usize, state: *mut Handle) -> c_int;

    safe fn fmi2Instantiate(
        name: *const c_char,
        kind: c_int,
        token: *const c_char,
        resources: *const c_char,
        functions: *const c_void,
        visible: c_int,
        logging: c_int,
    ) -> Handle;
    safe fn fmi2SetupExperiment(
        of: Handle,
        b: c_int,
        x: f64,
        start: f64,
        has_stop: c_int,
        stop: f64,
    ) -> c_int;
    safe fn fmi2EnterInitializationMode(of: Handle) -> c_int;
    safe fn fmi2ExitInitializationMode(of: Handle) -> c_int;
    safe fn fmi2Terminate(of: Handle) -> c_int;
    safe fn fmi2Reset(of: Handle) -> c_int;
    safe fn fmi2CancelStep(of: Handle) -> c_int;
    safe fn fmi2DoStep(of: Handle, from: f64, size: f64, no_earlier: c_int) -> c_int;
    safe fn fmi2GetReal(of: Handle, r: *const u32, n: usize, to: *mut f64) -> c_int;
    safe fn fmi2SetReal(of: Handle, r: *const u32, n: usize, from: *const f64) -> c_int;
    safe fn fmi2GetInteger(of: Handle, r: *const u32, n: usize, to: *mut c_int) -> c_int;
    safe fn fmi2SetInteger(of: Handle, r: *const u32, n: usize, from: *const c_int) -> c_int;
}

/// Number of states that an importer holds.
const STATES: usize = 4;
/// Largest number of values of a call.
const MOST_VALUES: usize = 4096;
/// Status of an instance that a panic has broken.
const FATAL: c_int = 4;

/// Importer with at most one instance.
struct Importer<'a> {
    resources: &'a Path,
    instance: Handle,
    is_version_2: bool,
    states: [Handle; STATES],
    /// Bytes that a state wrote, edited or not.
    written: Vec<u8>,
    /// True unless a state may be the result of edited bytes, or of a run that has failed.
    is_repeatable: bool,
    now: f64,
}

/// Calls the functions that the lines name, for the FMU with these resources; returns the first violation of the standard.
pub fn play(lines: &str, resources: &Path) -> Option<String> {
    let mut importer = Importer {
        resources,
        instance: ptr::null_mut(),
        is_version_2: false,
        states: [ptr::null_mut(); STATES],
        written: Vec::new(),
        is_repeatable: true,
        now: 0.0,
    };
    let wrong = lines.lines().find_map(|line| importer.call(line).err().map(|why| format!("{why}: {line}")));
    importer.free();
    wrong
}

impl Importer<'_> {
    fn call(&mut self, line: &str) -> Result<(), &'static str> {
        let mut words = line.splitn(4, ' ');
        let word = words.next().unwrap_or_default();
        let mut values: [&str; 3] = [""; 3];
        for (value, word) in values.iter_mut().zip(words) {
            *value = word;
        }
        let number = |text: &str| text.parse().unwrap_or(0.0);
        let slot = values[0].parse::<usize>().unwrap_or(0) % STATES;
        let status = match word {
            "new" => {
                self.create(values[0] == "2", values[1] != "0");
                0
            }
            "initialize" => self.initialize(values[0].parse().ok()),
            "step" => {
                let from = if values[0] == "now" { self.now } else { number(values[0]) };
                self.step(from, number(values[1]))
            }
            "get" => self.get(values[0], reference(values[1]), values[2]),
            "set" => self.set(values[0], reference(values[1]), values[2]),
            "save" => fmi3GetFMUState(self.instance, &raw mut self.states[slot]),
            "load" => fmi3SetFMUState(self.instance, self.states[slot]),
            "free" => fmi3FreeFMUState(self.instance, &raw mut self.states[slot]),
            "write" => self.write(slot),
            "read" => self.read(slot),
            "again" => return self.again(slot),
            "edit" => {
                self.edit(values[0], values[1]);
                0
            }
            "put" => {
                self.put(values[0], values[1]);
                0
            }
            _ => self.function(word),
        };
        if ["begin", "step", "event", "update", "stepping"].contains(&word) {
            self.is_repeatable &= status == 0;
        }
        if status == FATAL { Err("the library has panicked") } else { Ok(()) }
    }

    /// Creates an instance in place of the one that is there.
    fn create(&mut self, is_version_2: bool, uses_events: bool) {
        self.free();
        self.is_repeatable = true;
        self.is_version_2 = is_version_2;
        let token = FmuContent::read(self.resources).map(|content| content.token()).unwrap_or_default();
        let path = self.resources.display().to_string();
        let location = if is_version_2 { format!("file://{path}") } else { format!("{path}/") };
        let text = |text: String| CString::new(text).unwrap_or_default();
        let [name, token, location] = ["fmu".to_owned(), token, location].map(text);
        self.instance = if is_version_2 {
            fmi2Instantiate(name.as_ptr(), 1, token.as_ptr(), location.as_ptr(), ptr::null(), 0, 0)
        } else {
            let (none, unnamed) = (ptr::null(), ptr::null_mut());
            fmi3InstantiateCoSimulation(
                name.as_ptr(),
                token.as_ptr(),
                location.as_ptr(),
                false,
                false,
                uses_events,
                uses_events,
                ptr::null(),
                0,
                unnamed,
                none,
                none,
            )
        };
        self.now = 0.0;
    }

    fn free(&mut self) {
        for state in &mut self.states {
            fmi3FreeFMUState(self.instance, state);
            // Without an instance there is no state.
            *state = ptr::null_mut();
        }
        fmi3FreeInstance(self.instance);
        self.instance = ptr::null_mut();
    }

    fn initialize(&self, stop: Option<f64>) -> c_int {
        let (has_stop, stop) = (stop.is_some(), stop.unwrap_or(0.0));
        if self.is_version_2 {
            fmi2SetupExperiment(self.instance, 0, 0.0, 0.0, has_stop.into(), stop)
                .max(fmi2EnterInitializationMode(self.instance))
        } else {
            fmi3EnterInitializationMode(self.instance, false, 0.0, 0.0, has_stop, stop)
        }
    }

    fn step(&mut self, from: f64, size: f64) -> c_int {
        if self.is_version_2 {
            let status = fmi2DoStep(self.instance, from, size, 1);
            self.now = if status == 0 { from + size } else { self.now };
            return status;
        }
        let (mut event, mut ends, mut early, mut reached) = (false, false, false, self.now);
        let status = fmi3DoStep(
            self.instance,
            from,
            size,
            true,
            &raw mut event,
            &raw mut ends,
            &raw mut early,
            &raw mut reached,
        );
        self.now = reached;
        status
    }

    fn get(&self, kind: &str, reference: u32, count: &str) -> c_int {
        let count = count.parse::<usize>().unwrap_or(1).min(MOST_VALUES);
        let references = vec![reference; count];
        let (of, references) = (self.instance, references.as_ptr());
        match (kind, self.is_version_2) {
            ("f", false) => fmi3GetFloat64(of, references, count, vec![0.0; count].as_mut_ptr(), count),
            ("f", true) => fmi2GetReal(of, references, count, vec![0.0; count].as_mut_ptr()),
            ("i", true) => fmi2GetInteger(of, references, count, vec![0; count].as_mut_ptr()),
            ("i", false) => fmi3GetInt64(of, references, count, vec![0; count].as_mut_ptr(), count),
            ("c", false) => fmi3GetClock(of, references, count, vec![false; count].as_mut_ptr()),
            ("q", false) => {
                let (mut intervals, mut qualifiers) = (vec![0.0; count], vec![0; count]);
                fmi3GetIntervalDecimal(of, references, count, intervals.as_mut_ptr(), qualifiers.as_mut_ptr())
            }
            ("null", false) => fmi3GetFloat64(of, ptr::null(), count, ptr::null_mut(), count),
            (_, false) => fmi3GetUInt64(of, references, count, vec![0; count].as_mut_ptr(), count),
            _ => fmi2GetReal(of, ptr::null(), count, ptr::null_mut()),
        }
    }

    fn set(&self, kind: &str, reference: u32, value: &str) -> c_int {
        let (of, references, real) = (self.instance, &raw const reference, value.parse().unwrap_or(f64::NAN));
        // A number that is no integer becomes the nearest one.
        let whole = value.parse().unwrap_or(real as i64);
        let (count, short, tick) = (whole as u64, whole as c_int, true);
        match (kind, self.is_version_2) {
            ("f", false) => fmi3SetFloat64(of, references, 1, &raw const real, 1),
            ("f", true) => fmi2SetReal(of, references, 1, &raw const real),
            ("i", false) => fmi3SetInt64(of, references, 1, &raw const whole, 1),
            ("c", false) => fmi3SetClock(of, references, 1, &raw const tick),
            (_, false) => fmi3SetUInt64(of, references, 1, &raw const count, 1),
            (_, true) => fmi2SetInteger(of, references, 1, &raw const short),
        }
    }

    /// Takes the bytes of a state.
    fn write(&mut self, slot: usize) -> c_int {
        let (state, mut size) = (self.states[slot], 0);
        let status = fmi3SerializedFMUStateSize(self.instance, state, &raw mut size);
        if status != 0 {
            return status;
        }
        self.written = vec![0; size];
        fmi3SerializeFMUState(self.instance, state, self.written.as_mut_ptr(), size)
    }

    /// Puts the state of the written bytes into a place, which is freed before.
    fn read(&mut self, slot: usize) -> c_int {
        let freed = fmi3FreeFMUState(self.instance, &raw mut self.states[slot]);
        let (bytes, state) = (&self.written, &raw mut self.states[slot]);
        freed.max(fmi3DeserializeFMUState(self.instance, bytes.as_ptr(), bytes.len(), state))
    }

    /// Reads what a state wrote, and compares what the result writes.
    fn again(&mut self, slot: usize) -> Result<(), &'static str> {
        if self.states[slot].is_null() || !self.is_repeatable {
            return Ok(());
        }
        if self.write(slot) != 0 {
            return Err("a state cannot be written");
        }
        let before = self.written.clone();
        if self.read(slot) != 0 {
            return Err("a state cannot be read as it was written");
        }
        if self.write(slot) != 0 || self.written != before {
            return Err("a state is written otherwise after it was read");
        }
        Ok(())
    }

    /// Replaces a text in the written bytes, or cuts them where it begins.
    fn edit(&mut self, old: &str, new: &str) {
        self.is_repeatable = false;
        let text = String::from_utf8_lossy(&self.written).into_owned();
        self.written = if new.is_empty() {
            text.split_once(old).map_or(text.as_str(), |(before, _)| before).as_bytes().to_vec()
        } else {
            text.replacen(old, new, 1).into_bytes()
        };
    }

    /// Replaces the value behind the first occurrence of a member in the written bytes.
    fn put(&mut self, member: &str, value: &str) {
        self.is_repeatable = false;
        let text = String::from_utf8_lossy(&self.written).into_owned();
        if let Some((before, after)) = text.split_once(member) {
            let rest = after.find([',', ']', '}']).map_or("", |end| &after[end..]);
            self.written = format!("{before}{member}{value}{rest}").into_bytes();
        }
    }

    /// Calls a function of the instance alone.
    fn function(&self, name: &str) -> c_int {
        let of = self.instance;
        match (name, self.is_version_2) {
            ("begin", true) => fmi2ExitInitializationMode(of),
            ("begin", false) => fmi3ExitInitializationMode(of),
            ("configure", false) => fmi3EnterConfigurationMode(of),
            ("configured", false) => fmi3ExitConfigurationMode(of),
            ("event", false) => fmi3EnterEventMode(of),
            ("stepping", false) => fmi3EnterStepMode(of),
            ("evaluate", false) => fmi3EvaluateDiscreteStates(of),
            ("cancel", true) => fmi2CancelStep(of),
            ("terminate", true) => fmi2Terminate(of),
            ("terminate", false) => fmi3Terminate(of),
            ("reset", true) => fmi2Reset(of),
            ("reset", false) => fmi3Reset(of),
            ("update", false) => {
                let ([mut a, mut b, mut c, mut d, mut e], mut time) = ([false; 5], 0.0);
                fmi3UpdateDiscreteStates(
                    of,
                    &raw mut a,
                    &raw mut b,
                    &raw mut c,
                    &raw mut d,
                    &raw mut e,
                    &raw mut time,
                )
            }
            _ => 0,
        }
    }
}

fn reference(text: &str) -> u32 {
    text.parse().unwrap_or(u32::MAX)
}
