//! Damaged resources and wrong calls: one message each, and no crash.

use std::ffi::c_int;

use flexsc_core::control::quantity::total_width;
use flexsc_cosim::FmuPart;

use crate::c_call;
use crate::importer::{Fmu3, library, shipped};

type Handle = *mut std::ffi::c_void;

#[test]
fn damaged_resources_give_one_error() {
    let scenario = shipped("relay-fixed", &[("duration", "100.0")]);
    let toml = scenario.self_contained().to_toml();
    for (name, text, words) in [
        ("scenario.toml", &toml.as_bytes()[..toml.len() / 2], ""),
        ("scenario.toml", b"".as_slice(), "token"),
        ("scenario.toml", b"\xff\xfe", "scenario.toml"),
        ("part.txt", b"half", "`half`"),
        ("part.txt", b"controller", "token"),
        ("part.txt", b"plant", "token"),
    ] {
        let mut fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
        fmu.damage(name, text);
        let token = fmu.content.token();
        assert!(fmu.instantiate(&token, false).is_null(), "{name}");
        assert!(fmu.messages.0.len() == 1 && fmu.messages.0[0].contains(words), "{:?}", fmu.messages.0);
    }
    let mut fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
    assert!(fmu.instantiate("{another}", false).is_null());
    assert!(fmu.messages.0[0].contains("token") && fmu.messages.0.len() == 1);
}

#[test]
fn wrong_calls_fail_with_one_message() {
    let scenario = shipped("wheel-fixed-gain", &[("duration", "20.0")]);
    let fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
    let fails = |words: &str, call: &dyn Fn() -> c_int| {
        let before = fmu.messages.0.len();
        assert_eq!(call(), 3, "{words}");
        assert_eq!(fmu.messages.0.len() - before, 1, "{words}");
        assert!(fmu.messages.0[before].contains(words), "{}", fmu.messages.0[before]);
    };
    fails("mode", &|| fmu.step(0.0, 1.0).status);
    fails("finite", &|| fmu.set("disturbance_torque", f64::NAN));
    fails("not an input", &|| fmu.set("state.angle", 1.0));
    fails("mode", &|| fmu.mode("fmi3ExitInitializationMode"));
    fmu.begin(None);
    fails("after the start", &|| fmu.set("parameter.body.planar.inertia", 1.0));
    fails("the run is at 0", &|| fmu.step(1.0, 1.0).status);
    fails("a step must be", &|| fmu.step(0.0, -1.0).status);
    fails("a step must be", &|| fmu.step(0.0, f64::NAN).status);
    fails("after the end", &|| fmu.step(0.0, 21.0).status);
    fails("event mode", &|| fmu.mode("fmi3EnterEventMode"));
    // A refused call changes nothing.
    assert_eq!(fmu.step(0.0, 20.0).status, 0);
    assert_eq!(fmu.mode("fmi3Terminate"), 0);
    fails("mode", &|| fmu.step(20.0, 1.0).status);
    assert_eq!(fmu.mode("fmi3Reset"), 0);
    assert_eq!(fmu.set("parameter.body.planar.inertia", -1.0), 0);
    let entered = c_call!(fmu.library, "fmi3EnterInitializationMode", (
        std::ptr::null_mut() => Handle, false => bool, 0.0 => f64, 0.0 => f64, false => bool, 0.0 => f64
    ) -> c_int);
    assert_eq!(entered, 3);
}

#[test]
fn parameters_change_the_run() {
    let scenario = shipped("relay-fixed", &[("duration", "200.0")]);
    let end = |keys: &[(&str, f64)]| {
        let fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
        for (key, value) in keys {
            assert_eq!(fmu.set(&format!("parameter.{key}"), *value), 0);
        }
        fmu.begin(None);
        assert_eq!(fmu.step(0.0, 200.0).status, 0);
        fmu.reals(["state.angle"])[0].to_bits()
    };
    let other = shipped("relay-fixed", &[("duration", "200.0"), ("law.relay.k_t", "0.35")]);
    let mut run = flexsc_core::Simulation::new(&other, 0);
    run.run(&mut ()).expect("a run");
    let mut row = vec![0.0; 64];
    let width = total_width(&run.observation_fields(&other));
    row.truncate(width);
    run.observe(&mut row).expect("a state");
    assert_eq!(end(&[("law.relay.k_t", 0.35)]), row[0].to_bits());
    assert_ne!(end(&[]), row[0].to_bits());
}

#[test]
fn every_function_of_the_standards_is_there() {
    let library = library();
    let values =
        "Float32 Float64 Int8 UInt8 Int16 UInt16 Int32 UInt32 Int64 UInt64 Boolean String Binary Clock";
    let mut names: Vec<String> =
        values.split(' ').flat_map(|of| [format!("fmi3Get{of}"), format!("fmi3Set{of}")]).collect();
    let others = "fmi3: GetVersion SetDebugLogging InstantiateModelExchange InstantiateCoSimulation \
        InstantiateScheduledExecution FreeInstance EnterInitializationMode ExitInitializationMode EnterEventMode Terminate Reset \
        GetNumberOfVariableDependencies GetVariableDependencies GetFMUState SetFMUState FreeFMUState SerializedFMUStateSize \
        SerializeFMUState DeserializeFMUState GetDirectionalDerivative GetAdjointDerivative EnterConfigurationMode \
        ExitConfigurationMode GetIntervalDecimal GetIntervalFraction GetShiftDecimal GetShiftFraction SetIntervalDecimal \
        SetIntervalFraction SetShiftDecimal SetShiftFraction EvaluateDiscreteStates UpdateDiscreteStates EnterStepMode \
        GetOutputDerivatives DoStep ActivateModelPartition EnterContinuousTimeMode CompletedIntegratorStep SetTime \
        SetContinuousStates GetContinuousStateDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates \
        GetNumberOfEventIndicators GetNumberOfContinuousStates \
        fmi2: GetTypesPlatform GetVersion SetDebugLogging Instantiate FreeInstance SetupExperiment EnterInitializationMode \
        ExitInitializationMode Terminate Reset GetReal GetInteger GetBoolean GetString SetReal SetInteger SetBoolean SetString \
        GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate \
        GetDirectionalDerivative SetRealInputDerivatives GetRealOutputDerivatives DoStep CancelStep GetStatus GetRealStatus \
        GetIntegerStatus GetBooleanStatus GetStringStatus EnterEventMode NewDiscreteStates EnterContinuousTimeMode \
        CompletedIntegratorStep SetTime SetContinuousStates GetDerivatives GetEventIndicators GetContinuousStates \
        GetNominalsOfContinuousStates";
    let mut version = "";
    for word in others.split_whitespace() {
        match word.strip_suffix(':') {
            Some(prefix) => version = prefix,
            None => names.push(format!("{version}{word}")),
        }
    }
    assert_eq!(names.len(), 119);
    for name in names {
        assert!(library.address(&name).is_some(), "{name}");
    }
}
