//! Functions of the standards for what the FMUs do not have: each fails with one message, and succeeds where it is asked for no
//! value.

use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr;

use flexsc_cosim::FmuPart;

use crate::c_call;
use crate::importer::{Fmu3, Handle, shipped};

/// Statuses of the functions: done, not known, failed.
const OK: c_int = 0;
const DISCARD: c_int = 2;
const ERROR: c_int = 3;

/// Returns an instance of FMI 2.0 with the resources of another, after its start.
fn begun_2(fmu: &Fmu3) -> Handle {
    let location = format!("file://{}", fmu.resources().display());
    let [name, token, location] =
        ["a", &fmu.content.token(), &location].map(|text| CString::new(text).expect("a text"));
    let instance = c_call!(fmu.library, "fmi2Instantiate", (
        name.as_ptr() => *const c_char, 1 => c_int, token.as_ptr() => *const c_char, location.as_ptr() => *const c_char,
        ptr::null() => *const c_void, 0 => c_int, 0 => c_int
    ) -> Handle);
    assert!(!instance.is_null());
    for name in ["fmi2EnterInitializationMode", "fmi2ExitInitializationMode"] {
        assert_eq!(c_call!(fmu.library, name, (instance => Handle) -> c_int), OK, "{name}");
    }
    instance
}

#[test]
fn values_of_other_types_are_refused() {
    let fmu = Fmu3::new(&shipped("relay-fixed", &[("duration", "100.0")]), FmuPart::Loop, false);
    fmu.begin(None);
    let (reference, mut value) = (0_u32, [0_u64; 2]);
    for kind in ["Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Boolean", "String"] {
        for action in ["Get", "Set"] {
            for (count, expected) in [(0_usize, OK), (1, ERROR)] {
                let name = format!("fmi3{action}{kind}");
                let status = c_call!(fmu.library, &name, (
                    fmu.handle() => Handle, &raw const reference => *const u32, count => usize,
                    value.as_mut_ptr().cast() => *mut c_void, count => usize
                ) -> c_int);
                assert_eq!(status, expected, "{name} {count}");
            }
        }
    }
    let instance = begun_2(&fmu);
    for kind in ["Integer", "Boolean", "String"] {
        for action in ["Get", "Set"] {
            for (count, expected) in [(0_usize, OK), (1, ERROR)] {
                let name = format!("fmi2{action}{kind}");
                let status = c_call!(fmu.library, &name, (
                    instance => Handle, &raw const reference => *const u32, count => usize,
                    value.as_mut_ptr().cast() => *mut c_void
                ) -> c_int);
                assert_eq!(status, expected, "{name} {count}");
            }
        }
    }
    c_call!(fmu.library, "fmi2FreeInstance", (instance => Handle) -> ());
}

#[test]
fn intervals_and_derivatives_are_not_set() {
    let fmu = Fmu3::new(&shipped("wheel-fixed-gain", &[("duration", "20.0")]), FmuPart::Loop, false);
    fmu.begin(None);
    let (reference, mut values) = (fmu.reference("state.angle"), [0.0; 2]);
    for name in ["fmi3SetIntervalDecimal", "fmi3SetShiftDecimal"] {
        for (count, expected) in [(0_usize, OK), (1, ERROR)] {
            let status = c_call!(fmu.library, name, (
                fmu.handle() => Handle, &raw const reference => *const u32, count => usize, values.as_ptr() => *const f64
            ) -> c_int);
            assert_eq!(status, expected, "{name} {count}");
        }
    }
    for (count, expected) in [(0_usize, OK), (1, ERROR)] {
        let orders = [1_i32];
        let status = c_call!(fmu.library, "fmi3GetOutputDerivatives", (
            fmu.handle() => Handle, &raw const reference => *const u32, count => usize, orders.as_ptr() => *const i32,
            values.as_mut_ptr() => *mut f64, count => usize
        ) -> c_int);
        assert_eq!(status, expected);
    }
    for name in ["fmi3GetDirectionalDerivative", "fmi3GetAdjointDerivative"] {
        let status = c_call!(fmu.library, name, (
            fmu.handle() => Handle, &raw const reference => *const u32, 1 => usize, &raw const reference => *const u32,
            1 => usize, values.as_ptr() => *const f64, 1 => usize, values.as_mut_ptr() => *mut f64, 1 => usize
        ) -> c_int);
        assert_eq!(status, ERROR, "{name}");
    }
}

#[test]
fn states_and_statuses_of_version_2_are_those_of_version_3() {
    let fmu = Fmu3::new(&shipped("relay-fixed", &[("duration", "100.0")]), FmuPart::Loop, false);
    let instance = begun_2(&fmu);
    let step = |from: f64| {
        let status = c_call!(fmu.library, "fmi2DoStep", (
            instance => Handle, from => f64, 10.0 => f64, 1 => c_int
        ) -> c_int);
        assert_eq!(status, OK, "{from}");
    };
    let angle = || {
        let (reference, mut value) = (fmu.reference("state.angle"), 0.0_f64);
        let status = c_call!(fmu.library, "fmi2GetReal", (
            instance => Handle, &raw const reference => *const u32, 1 => usize, &raw mut value => *mut f64
        ) -> c_int);
        assert_eq!(status, OK);
        value.to_bits()
    };
    let mut state: Handle = ptr::null_mut();
    let call = |name: &str, state: *mut Handle| c_call!(fmu.library, name, (instance => Handle, state => *mut Handle) -> c_int);
    step(0.0);
    assert_eq!(call("fmi2GetFMUstate", &raw mut state), OK);
    let mut size = 0_usize;
    let sized = c_call!(fmu.library, "fmi2SerializedFMUstateSize", (
        instance => Handle, state => Handle, &raw mut size => *mut usize
    ) -> c_int);
    assert!(sized == OK && size > 0);
    let mut bytes = vec![0_u8; size];
    let write = |bytes: &mut [u8], size: usize| {
        c_call!(fmu.library, "fmi2SerializeFMUstate", (
            instance => Handle, state => Handle, bytes.as_mut_ptr() => *mut u8, size => usize
        ) -> c_int)
    };
    assert_eq!((write(&mut bytes, size - 1), write(&mut bytes, size)), (ERROR, OK));
    step(10.0);
    let expected = angle();
    // From the snapshot, and from its bytes.
    for read_bytes in [false, true] {
        if read_bytes {
            assert_eq!(call("fmi2FreeFMUstate", &raw mut state), OK);
            assert!(state.is_null());
            let read = c_call!(fmu.library, "fmi2DeSerializeFMUstate", (
                instance => Handle, bytes.as_ptr() => *const u8, size => usize, &raw mut state => *mut Handle
            ) -> c_int);
            assert_eq!(read, OK);
        }
        let set = c_call!(fmu.library, "fmi2SetFMUstate", (instance => Handle, state => Handle) -> c_int);
        assert_eq!(set, OK);
        assert_ne!(angle(), expected);
        step(10.0);
        assert_eq!(angle(), expected, "{read_bytes}");
    }
    assert_eq!(call("fmi2FreeFMUstate", &raw mut state), OK);
    let (mut time, mut flag) = (0.0_f64, 1 as c_int);
    let mut status = |kind: c_int| {
        c_call!(fmu.library, "fmi2GetRealStatus", (
            instance => Handle, kind => c_int, &raw mut time => *mut f64
        ) -> c_int)
    };
    assert_eq!([status(2), status(0)], [OK, DISCARD]);
    assert_eq!(time.to_bits(), 20.0_f64.to_bits());
    let mut status = |kind: c_int| {
        c_call!(fmu.library, "fmi2GetBooleanStatus", (
            instance => Handle, kind => c_int, &raw mut flag => *mut c_int
        ) -> c_int)
    };
    assert_eq!(([status(3), status(0)], flag), ([OK, DISCARD], 0));
    let last = |name: &str| c_call!(fmu.library, name, (instance => Handle) -> c_int);
    assert_eq!(last("fmi2CancelStep"), ERROR);
    assert_eq!([last("fmi2Terminate"), last("fmi2Terminate")], [OK, ERROR]);
    assert_eq!([last("fmi2Reset"), last("fmi2EnterInitializationMode")], [OK, OK]);
    c_call!(fmu.library, "fmi2FreeInstance", (instance => Handle) -> ());
}
