//! FMI 2.0: values of variables. All are reals, because the integers of this version have 32 bits.

#![expect(unsafe_code, reason = "functions of C have the names of the standard")]

use std::ffi::{c_char, c_int};

use flexsc_cosim::{CoSimulationError, ValueKind};

use crate::boundary::{Held, Results, Values};
use crate::instance::{Instance, InstanceMode, Outcome, call, no_pointer, refused};

/// Declares the functions that get and set values of a type that no variable has.
macro_rules! absent {
    ($($get:ident $set:ident $of:ty;)+) => {$(
        /// Fails if a variable is named: none has this type.
        #[unsafe(no_mangle)]
        pub extern "C" fn $get(
            instance: Held<Instance>,
            _references: Values<u32>,
            count: usize,
            _values: Results<$of>,
        ) -> c_int {
            call(instance, |_| absent(count))
        }

        /// Fails if a variable is named: none has this type.
        #[unsafe(no_mangle)]
        pub extern "C" fn $set(
            instance: Held<Instance>,
            _references: Values<u32>,
            count: usize,
            _values: Values<$of>,
        ) -> c_int {
            call(instance, |_| absent(count))
        }
    )+};
}

absent! {
    fmi2GetInteger fmi2SetInteger c_int;
    fmi2GetBoolean fmi2SetBoolean c_int;
    fmi2GetString fmi2SetString *const c_char;
}

fn absent(count: usize) -> Outcome {
    if count == 0 { Ok(()) } else { Err(refused("all variables are reals")) }
}

/// Gets numbers.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetReal(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut values: Results<f64>,
) -> c_int {
    call(instance, |instance| {
        let references = references.read(count).ok_or_else(no_pointer)?;
        let places = values.place(count).ok_or_else(no_pointer)?;
        for (reference, place) in references.iter().zip(places) {
            place.write(if is_float(instance, *reference) {
                instance.run.get(*reference)?
            } else {
                instance.run.get_integer(*reference)? as f64
            });
        }
        Ok(())
    })
}

/// Sets numbers.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetReal(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    values: Values<f64>,
) -> c_int {
    call(instance, |instance| {
        let accepted = [InstanceMode::Instantiated, InstanceMode::Initialization, InstanceMode::Step];
        instance.in_mode(&accepted)?;
        let references = references.read(count).ok_or_else(no_pointer)?;
        let values = values.read(count).ok_or_else(no_pointer)?;
        references.iter().zip(values).try_for_each(|(reference, value)| set(instance, *reference, *value))
    })
}

/// Sets a number.
fn set(instance: &mut Instance, reference: u32, value: f64) -> Outcome {
    if is_float(instance, reference) {
        return instance.run.set(reference, value);
    }
    if value != value.trunc() || !(0.0..=9_007_199_254_740_992.0).contains(&value) {
        let why = format!("must be a whole number from 0 to 2^53, got {value:?}");
        return Err(CoSimulationError::Refused(why));
    }
    instance.run.set_integer(reference, value as i64)
}

fn is_float(instance: &Instance, reference: u32) -> bool {
    instance.run.table().get(reference).is_none_or(|variable| variable.kind == ValueKind::Float)
}

/// Fails: inputs are constant during a step.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetRealInputDerivatives(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _orders: Values<c_int>,
    _values: Values<f64>,
) -> c_int {
    call(instance, |_| if count == 0 { Ok(()) } else { Err(refused("inputs are constant during a step")) })
}

/// Fails: outputs have no derivatives.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetRealOutputDerivatives(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _orders: Values<c_int>,
    _values: Results<f64>,
) -> c_int {
    call(instance, |_| if count == 0 { Ok(()) } else { Err(refused("outputs have no derivatives")) })
}

/// Fails: there are no directional derivatives.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetDirectionalDerivative(
    instance: Held<Instance>,
    _unknowns: Values<u32>,
    _unknown_count: usize,
    _knowns: Values<u32>,
    _known_count: usize,
    _seed: Values<f64>,
    _sensitivity: Results<f64>,
) -> c_int {
    call(instance, |_| Err(refused("there are no directional derivatives")))
}
