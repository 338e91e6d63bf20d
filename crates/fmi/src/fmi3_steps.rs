//! FMI 3.0: steps and events.

#![expect(unsafe_code, reason = "functions of C have the names of the standard")]

use std::ffi::c_int;

use crate::boundary::{Held, Results, Values};
use crate::instance::{Instance, InstanceMode, call, refused};

/// Advances the run by a step, or to the first event on the way.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3DoStep(
    instance: Held<Instance>,
    from: f64,
    size: f64,
    _no_earlier_state: bool,
    mut event_handling_needed: Results<bool>,
    mut terminate: Results<bool>,
    mut early_return: Results<bool>,
    mut last_successful_time: Results<f64>,
) -> c_int {
    call(instance, |instance| {
        terminate.write(false);
        event_handling_needed.write(false);
        early_return.write(false);
        last_successful_time.write(instance.run.time());
        instance.in_mode(&[InstanceMode::Step])?;
        let result = instance.run.step(from, size, instance.options.stops_at_events)?;
        event_handling_needed.write(result.is_event);
        early_return.write(result.is_early);
        last_successful_time.write(result.reached);
        Ok(())
    })
}

/// Enters the event at which a step has stopped, or an event of the importer.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterEventMode(instance: Held<Instance>) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Step])?;
        if !instance.options.uses_event_mode {
            return Err(refused("the instance was created without the event mode"));
        }
        instance.run.enter_event()?;
        instance.mode = InstanceMode::Event;
        Ok(())
    })
}

/// Ends an iteration of an event: inputs that have changed act from now on. No further iteration is needed.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3UpdateDiscreteStates(
    instance: Held<Instance>,
    mut needs_update: Results<bool>,
    mut terminate: Results<bool>,
    mut nominals_changed: Results<bool>,
    mut values_changed: Results<bool>,
    mut next_event_defined: Results<bool>,
    mut next_event_time: Results<f64>,
) -> c_int {
    call(instance, |instance| {
        for flag in [
            &mut needs_update,
            &mut terminate,
            &mut nominals_changed,
            &mut values_changed,
            &mut next_event_defined,
        ] {
            flag.write(false);
        }
        next_event_time.write(0.0);
        instance.in_mode(&[InstanceMode::Event])?;
        instance.run.end_event()
    })
}

/// Does nothing: discrete states are evaluated when an event is entered.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EvaluateDiscreteStates(instance: Held<Instance>) -> c_int {
    call(instance, |instance| instance.in_mode(&[InstanceMode::Initialization, InstanceMode::Event]))
}

/// Leaves the event mode.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterStepMode(instance: Held<Instance>) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Event])?;
        instance.run.end_event()?;
        instance.mode = InstanceMode::Step;
        Ok(())
    })
}

/// Fails: outputs have no derivatives.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetOutputDerivatives(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _orders: Values<i32>,
    _values: Results<f64>,
    _value_count: usize,
) -> c_int {
    call(instance, |_| if count == 0 { Ok(()) } else { Err(refused("outputs have no derivatives")) })
}

/// Fails: there are no directional derivatives.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetDirectionalDerivative(
    instance: Held<Instance>,
    _unknowns: Values<u32>,
    _unknown_count: usize,
    _knowns: Values<u32>,
    _known_count: usize,
    _seed: Values<f64>,
    _seed_count: usize,
    _sensitivity: Results<f64>,
    _sensitivity_count: usize,
) -> c_int {
    call(instance, |_| Err(refused("there are no directional derivatives")))
}

/// Fails: there are no adjoint derivatives.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetAdjointDerivative(
    instance: Held<Instance>,
    _unknowns: Values<u32>,
    _unknown_count: usize,
    _knowns: Values<u32>,
    _known_count: usize,
    _seed: Values<f64>,
    _seed_count: usize,
    _sensitivity: Results<f64>,
    _sensitivity_count: usize,
) -> c_int {
    call(instance, |_| Err(refused("there are no adjoint derivatives")))
}
