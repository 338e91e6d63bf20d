//! FMI 3.0: versions, instances and modes.

#![expect(unsafe_code, reason = "functions of C have the names of the standard")]

use std::ffi::{c_char, c_int, c_void};
use std::path::PathBuf;

use flexsc_cosim::ValueKind;

use crate::boundary::{Held, Results, Text, Values};
use crate::instance::{Instance, InstanceMode, InstanceOptions, call};
use crate::logger::{LogMessage, Logger};

/// Returns the version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Accepts every choice of messages: only errors are sent.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetDebugLogging(
    instance: Held<Instance>,
    _logging_on: bool,
    _count: usize,
    _categories: Values<*const c_char>,
) -> c_int {
    call(instance, |_| Ok(()))
}

/// Returns null: there is no model exchange.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    name: Text,
    _token: Text,
    _resources: Text,
    _visible: bool,
    _logging_on: bool,
    environment: *mut c_void,
    log: Option<LogMessage>,
) -> Held<Instance> {
    let logger = log.map_or(Logger::Silent, |log| Logger::Fmi3(log, environment));
    logger.send(&name.read(), crate::instance::ERROR, "the FMU offers co-simulation, and no model exchange");
    Held::null()
}

/// Returns null: there is no scheduled execution.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    name: Text,
    _token: Text,
    _resources: Text,
    _visible: bool,
    _logging_on: bool,
    environment: *mut c_void,
    log: Option<LogMessage>,
    _clock_update: *const c_void,
    _lock_preemption: *const c_void,
    _unlock_preemption: *const c_void,
) -> Held<Instance> {
    let logger = log.map_or(Logger::Silent, |log| Logger::Fmi3(log, environment));
    logger.send(
        &name.read(),
        crate::instance::ERROR,
        "the FMU offers co-simulation, and no scheduled execution",
    );
    Held::null()
}

/// Creates an instance for co-simulation; returns null if that fails.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateCoSimulation(
    name: Text,
    token: Text,
    resources: Text,
    _visible: bool,
    _logging_on: bool,
    event_mode_used: bool,
    early_return_allowed: bool,
    _intermediate_variables: Values<u32>,
    _intermediate_count: usize,
    environment: *mut c_void,
    log: Option<LogMessage>,
    _intermediate_update: *const c_void,
) -> Held<Instance> {
    let options = InstanceOptions {
        name: name.read(),
        token: token.read(),
        stops_at_events: event_mode_used && early_return_allowed,
        uses_event_mode: event_mode_used,
        logger: log.map_or(Logger::Silent, |log| Logger::Fmi3(log, environment)),
    };
    Instance::create(&PathBuf::from(resources.read()), options)
}

/// Frees an instance.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(instance: Held<Instance>) {
    instance.free();
}

/// Begins the initialization. The tolerance has no effect: the run is exact.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    instance: Held<Instance>,
    _tolerance_defined: bool,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: bool,
    stop_time: f64,
) -> c_int {
    call(instance, |instance| instance.initialize(start_time, stop_time_defined.then_some(stop_time)))
}

/// Ends the initialization: the run begins.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitInitializationMode(instance: Held<Instance>) -> c_int {
    call(instance, Instance::begin)
}

/// Allows structural parameters to be set.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterConfigurationMode(instance: Held<Instance>) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Instantiated])?;
        instance.mode = InstanceMode::Configuration;
        Ok(())
    })
}

/// Ends the mode in which structural parameters are set.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitConfigurationMode(instance: Held<Instance>) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Configuration])?;
        instance.mode = InstanceMode::Instantiated;
        Ok(())
    })
}

/// Ends the run.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3Terminate(instance: Held<Instance>) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Event, InstanceMode::Step])?;
        instance.mode = InstanceMode::Terminated;
        Ok(())
    })
}

/// Resets an instance to its state after the creation.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(instance: Held<Instance>) -> c_int {
    call(instance, Instance::reset)
}

/// Writes 0 as the number of dependencies: the model description states none.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetNumberOfVariableDependencies(
    instance: Held<Instance>,
    reference: u32,
    mut count: Results<usize>,
) -> c_int {
    call(instance, |instance| {
        let is_there = instance.run.table().get(reference).is_some_and(|of| of.kind == ValueKind::Float);
        count.write(0);
        if is_there { Ok(()) } else { Err(crate::instance::refused("there is no such variable")) }
    })
}

/// Fails: the model description states no dependencies of elements.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVariableDependencies(
    instance: Held<Instance>,
    _dependent: u32,
    _element_indices: Results<usize>,
    _independents: Results<u32>,
    _independent_indices: Results<usize>,
    _kinds: Results<c_int>,
    _count: usize,
) -> c_int {
    call(instance, |_| Err(crate::instance::refused("there are no dependencies of elements")))
}
