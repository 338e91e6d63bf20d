//! FMI 2.0: equal to FMI 3.0 at communication points, and its error against the exact path.

use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr;

use flexsc_core::Simulation;
use flexsc_core::control::quantity::total_width;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_cosim::FmuPart;

use crate::c_call;
use crate::importer::{Fmu3, shipped};

type Handle = *mut c_void;

#[repr(C)]
struct Callbacks([*const c_void; 5]);

/// Runs an instance of FMI 2.0 with the resources of another; returns the bits of a variable at each point.
fn points(fmu: &Fmu3, name: &str, grid: f64, count: u32, size: f64) -> Vec<u64> {
    let library = &fmu.library;
    let location = format!("file://{}", fmu.resources().display());
    let [own, token, location] =
        ["a", &fmu.content.token(), &location].map(|text| CString::new(text).expect("a text"));
    let callbacks = Callbacks([ptr::null(); 5]);
    let instance = c_call!(library, "fmi2Instantiate", (
        own.as_ptr() => *const c_char, 1 => c_int, token.as_ptr() => *const c_char, location.as_ptr() => *const c_char,
        &raw const callbacks => *const Callbacks, 0 => c_int, 0 => c_int
    ) -> Handle);
    assert!(!instance.is_null());
    let reference = fmu.reference("snap_ns");
    c_call!(library, "fmi2SetReal", (
        instance => Handle, &raw const reference => *const u32, 1 => usize, &raw const grid => *const f64
    ) -> c_int);
    let set = c_call!(library, "fmi2SetupExperiment", (
        instance => Handle, 0 => c_int, 0.0 => f64, 0.0 => f64, 0 => c_int, 0.0 => f64
    ) -> c_int);
    let entered = c_call!(library, "fmi2EnterInitializationMode", (instance => Handle) -> c_int);
    let left = c_call!(library, "fmi2ExitInitializationMode", (instance => Handle) -> c_int);
    assert_eq!((set, entered, left), (0, 0, 0));
    let reference = fmu.reference(name);
    let mut seen = Vec::new();
    for point in 0..count {
        let (from, next) = (f64::from(point) * size, f64::from(point + 1) * size);
        let status = c_call!(library, "fmi2DoStep", (
            instance => Handle, from => f64, next - from => f64, 1 => c_int
        ) -> c_int);
        let mut value = 0.0;
        let got = c_call!(library, "fmi2GetReal", (
            instance => Handle, &raw const reference => *const u32, 1 => usize, &raw mut value => *mut f64
        ) -> c_int);
        assert_eq!((status, got), (0, 0));
        seen.push(value.to_bits());
    }
    c_call!(library, "fmi2FreeInstance", (instance => Handle) -> ());
    seen
}

#[test]
fn both_versions_have_equal_bits_at_points() {
    for (name, variable) in [
        ("relay-fixed", "state.angle"),
        ("relay-fixed", "event_fs"),
        ("wheel-fixed-gain", "measured.angle"),
        ("earth-observer", "state.rate[1]"),
        ("station-keeping", "state.error[3]"),
    ] {
        let scenario = shipped(name, &[("duration", "50.0")]);
        let fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
        fmu.begin(None);
        let mut expected = Vec::new();
        fmu.run(49.9, 0.1, false, |fmu, _| {
            let is_count = variable.starts_with("event");
            let value = if is_count { fmu.integers([variable])[0] as f64 } else { fmu.reals([variable])[0] };
            expected.push(value.to_bits());
        });
        assert_eq!(points(&fmu, variable, 0.0, expected.len() as u32, 0.1), expected, "{name}");
    }
}

/// The motion at a point is exact; only the time of the point is rounded to a double. `docs/fmi.md` states the figures.
#[test]
fn the_error_of_a_point_is_the_rounding_of_its_time() {
    let scenario = shipped("relay-fixed", &[("duration", "1000.0")]);
    let mut run = Simulation::new(&scenario, 0);
    let mut row = vec![0.0; total_width(&run.observation_fields(&scenario))];
    let mut expected = Vec::new();
    for point in 1..=10_000_i64 {
        let at = Instant::START + Span::from_femtoseconds(point * 100_000_000_000_000);
        run.run_until(at, &mut ()).expect("a run");
        run.observe(&mut row).expect("a state");
        expected.push(row[0]);
    }
    let fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
    let error = |grid: f64| {
        let found = points(&fmu, "state.angle", grid, 10_000, 0.1);
        let differences =
            found.iter().zip(&expected).map(|(bits, exact)| (f64::from_bits(*bits) - exact).abs());
        (differences.clone().filter(|error| *error > 0.0).count(), differences.fold(0.0, f64::max))
    };
    let (count, largest) = error(0.0);
    assert!(count > 100 && largest < 2e-17, "{count} {largest:e}");
    assert_eq!(error(1.0), (0, 0.0));
}
