//! FMI 2.0 for co-simulation: versions, instances, steps and states.

#![expect(unsafe_code, reason = "functions of C have the names of the standard")]

use std::ffi::{c_char, c_int};

use crate::boundary::{Held, Results, Text, Values};
use crate::fmi3_states::{deserialize, free_state, get_state, serialize, serialized_size, set_state};
use crate::instance::{
    DISCARD, ERROR, Instance, InstanceMode, InstanceOptions, InstanceState, call, refused,
};
use crate::logger::{CallbackFunctions, Logger};
use crate::resource_location::directory;

/// Kind of FMU: co-simulation.
const CO_SIMULATION: c_int = 1;
/// Kind of status: time of the last successful step.
const LAST_SUCCESSFUL_TIME: c_int = 2;
/// Kind of status: whether the FMU asks to end the simulation.
const TERMINATED: c_int = 3;

/// Returns the name of the types.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// Returns the version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Accepts every choice of messages: only errors are sent.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetDebugLogging(
    instance: Held<Instance>,
    _logging_on: c_int,
    _count: usize,
    _categories: Values<*const c_char>,
) -> c_int {
    call(instance, |_| Ok(()))
}

/// Creates an instance for co-simulation; returns null if that fails.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Instantiate(
    name: Text,
    kind: c_int,
    token: Text,
    resources: Text,
    functions: Values<CallbackFunctions>,
    _visible: c_int,
    _logging_on: c_int,
) -> Held<Instance> {
    let callbacks = functions.single();
    let logger = callbacks.and_then(|of| Some(Logger::Fmi2(of.logger?, of.environment)));
    let logger = logger.unwrap_or(Logger::Silent);
    let name = name.read();
    if kind != CO_SIMULATION {
        logger.send(&name, ERROR, "the FMU offers co-simulation, and no model exchange");
        return Held::null();
    }
    let token = token.read();
    let options = InstanceOptions { name, token, stops_at_events: false, uses_event_mode: false, logger };
    Instance::create(&directory(&resources.read()), options)
}

/// Frees an instance.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(instance: Held<Instance>) {
    instance.free();
}

/// Takes the times of the experiment. The tolerance has no effect: the run is exact.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    instance: Held<Instance>,
    _tolerance_defined: c_int,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: c_int,
    stop_time: f64,
) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Instantiated])?;
        if start_time != 0.0 {
            return Err(refused("the run starts at 0 s, and the start time is another"));
        }
        instance.stop_time = (stop_time_defined != 0).then_some(stop_time);
        Ok(())
    })
}

/// Begins the initialization.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(instance: Held<Instance>) -> c_int {
    call(instance, |instance| instance.initialize(0.0, instance.stop_time))
}

/// Ends the initialization: the run begins.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(instance: Held<Instance>) -> c_int {
    call(instance, Instance::begin)
}

/// Ends the run.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(instance: Held<Instance>) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Step])?;
        instance.mode = InstanceMode::Terminated;
        Ok(())
    })
}

/// Resets an instance to its state after the creation.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(instance: Held<Instance>) -> c_int {
    call(instance, Instance::reset)
}

/// Advances the run by a step.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(
    instance: Held<Instance>,
    from: f64,
    size: f64,
    _no_earlier_state: c_int,
) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Step])?;
        instance.run.step(from, size, false).map(|_| ())
    })
}

/// Fails: a step is complete when its function returns.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(instance: Held<Instance>) -> c_int {
    call(instance, |_| Err(refused("no step is pending")))
}

/// Discards the question: a step is complete when its function returns.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStatus(_: Held<Instance>, _kind: c_int, _value: Results<c_int>) -> c_int {
    DISCARD
}

/// Gets the time of the last successful step.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetRealStatus(instance: Held<Instance>, kind: c_int, mut value: Results<f64>) -> c_int {
    if kind != LAST_SUCCESSFUL_TIME {
        return DISCARD;
    }
    call(instance, |instance| {
        value.write(instance.run.time());
        Ok(())
    })
}

/// Discards the question: there is no such status.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetIntegerStatus(_: Held<Instance>, _kind: c_int, _value: Results<c_int>) -> c_int {
    DISCARD
}

/// Gets whether the FMU asks to end the simulation: never.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetBooleanStatus(
    instance: Held<Instance>,
    kind: c_int,
    mut value: Results<c_int>,
) -> c_int {
    if kind != TERMINATED {
        return DISCARD;
    }
    call(instance, |_| {
        value.write(0);
        Ok(())
    })
}

/// Discards the question: there is no such status.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStringStatus(
    _: Held<Instance>,
    _kind: c_int,
    _value: Results<*const c_char>,
) -> c_int {
    DISCARD
}

/// Gets the state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetFMUstate(
    instance: Held<Instance>,
    mut state: Results<Held<InstanceState>>,
) -> c_int {
    call(instance, |instance| get_state(instance, &mut state))
}

/// Sets the state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(instance: Held<Instance>, state: Held<InstanceState>) -> c_int {
    call(instance, |instance| set_state(instance, state))
}

/// Frees a state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeFMUstate(
    instance: Held<Instance>,
    mut state: Results<Held<InstanceState>>,
) -> c_int {
    call(instance, |_| free_state(&mut state))
}

/// Gets the number of bytes of a state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SerializedFMUstateSize(
    instance: Held<Instance>,
    state: Held<InstanceState>,
    mut size: Results<usize>,
) -> c_int {
    call(instance, |_| serialized_size(state, &mut size))
}

/// Gets the bytes of a state: everything that the importer has set, from which the run can be repeated.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SerializeFMUstate(
    instance: Held<Instance>,
    state: Held<InstanceState>,
    mut bytes: Results<u8>,
    size: usize,
) -> c_int {
    call(instance, |_| serialize(state, &mut bytes, size))
}

/// Creates a state from its bytes: the run is repeated.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2DeSerializeFMUstate(
    instance: Held<Instance>,
    bytes: Values<u8>,
    size: usize,
    mut state: Results<Held<InstanceState>>,
) -> c_int {
    call(instance, |instance| deserialize(instance, &bytes, size, &mut state))
}
