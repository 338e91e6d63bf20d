//! FMI 3.0: values of variables.

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
            _value_count: usize,
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
            _value_count: usize,
        ) -> c_int {
            call(instance, |_| absent(count))
        }
    )+};
}

absent! {
    fmi3GetFloat32 fmi3SetFloat32 f32;
    fmi3GetInt8 fmi3SetInt8 i8;
    fmi3GetUInt8 fmi3SetUInt8 u8;
    fmi3GetInt16 fmi3SetInt16 i16;
    fmi3GetUInt16 fmi3SetUInt16 u16;
    fmi3GetInt32 fmi3SetInt32 i32;
    fmi3GetUInt32 fmi3SetUInt32 u32;
    fmi3GetBoolean fmi3SetBoolean bool;
    fmi3GetString fmi3SetString *const c_char;
}

fn absent(count: usize) -> Outcome {
    if count == 0 { Ok(()) } else { Err(refused("no variable has this type")) }
}

/// Fails if a variable is named: none has this type.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetBinary(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _sizes: Results<usize>,
    _values: Results<*const u8>,
    _value_count: usize,
) -> c_int {
    call(instance, |_| absent(count))
}

/// Fails if a variable is named: none has this type.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetBinary(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _sizes: Values<usize>,
    _values: Values<*const u8>,
    _value_count: usize,
) -> c_int {
    call(instance, |_| absent(count))
}

/// Writes the value of each reference.
fn get_each<T>(
    references: &Values<u32>,
    count: usize,
    values: &mut Results<T>,
    value_count: usize,
    mut get: impl FnMut(u32) -> Result<T, CoSimulationError>,
) -> Outcome {
    let references = references.read(count).ok_or_else(no_pointer)?;
    let places = values.place(value_count).ok_or_else(no_pointer)?;
    if places.len() != references.len() {
        return Err(refused("every variable has one value"));
    }
    for (reference, place) in references.iter().zip(places) {
        place.write(get(*reference)?);
    }
    Ok(())
}

/// Sets the value of each reference.
fn set_each<T: Copy>(
    references: &Values<u32>,
    count: usize,
    values: &Values<T>,
    value_count: usize,
    mut set: impl FnMut(u32, T) -> Outcome,
) -> Outcome {
    let references = references.read(count).ok_or_else(no_pointer)?;
    let values = values.read(value_count).ok_or_else(no_pointer)?;
    if values.len() != references.len() {
        return Err(refused("every variable has one value"));
    }
    references.iter().zip(values).try_for_each(|(reference, value)| set(*reference, *value))
}

/// Returns an error if a variable is not of this kind.
fn is_kind(instance: &Instance, reference: u32, kind: ValueKind) -> Outcome {
    let found = instance.run.table().get(reference);
    if found.is_some_and(|variable| variable.kind == kind) {
        return Ok(());
    }
    Err(CoSimulationError::Refused(format!("no variable of this type has the value reference {reference}")))
}

/// Returns an error in a mode in which no variable is set.
fn is_settable(instance: &Instance) -> Outcome {
    instance.in_mode(&[
        InstanceMode::Instantiated,
        InstanceMode::Initialization,
        InstanceMode::Event,
        InstanceMode::Step,
    ])
}

/// Gets floating-point numbers.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetFloat64(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut values: Results<f64>,
    value_count: usize,
) -> c_int {
    call(instance, |instance| {
        get_each(&references, count, &mut values, value_count, |reference| instance.run.get(reference))
    })
}

/// Sets floating-point numbers.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFloat64(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    values: Values<f64>,
    value_count: usize,
) -> c_int {
    call(instance, |instance| {
        is_settable(instance)?;
        set_each(&references, count, &values, value_count, |reference, value| {
            instance.run.set(reference, value)
        })
    })
}

/// Gets signed integers.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetInt64(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut values: Results<i64>,
    value_count: usize,
) -> c_int {
    call(instance, |instance| {
        get_each(&references, count, &mut values, value_count, |reference| {
            is_kind(instance, reference, ValueKind::Integer)?;
            instance.run.get_integer(reference)
        })
    })
}

/// Sets signed integers.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetInt64(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    values: Values<i64>,
    value_count: usize,
) -> c_int {
    call(instance, |instance| {
        is_settable(instance)?;
        set_each(&references, count, &values, value_count, |reference, value| {
            is_kind(instance, reference, ValueKind::Integer)?;
            instance.run.set_integer(reference, value)
        })
    })
}

/// Gets unsigned integers: structural parameters.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetUInt64(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut values: Results<u64>,
    value_count: usize,
) -> c_int {
    call(instance, |instance| {
        get_each(&references, count, &mut values, value_count, |reference| {
            is_kind(instance, reference, ValueKind::Structural)?;
            instance.run.get_integer(reference).map(|value| value as u64)
        })
    })
}

/// Sets unsigned integers: structural parameters.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetUInt64(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    values: Values<u64>,
    value_count: usize,
) -> c_int {
    call(instance, |instance| {
        if count > 0 {
            instance.in_mode(&[InstanceMode::Configuration])?;
        }
        set_each(&references, count, &values, value_count, |reference, value| {
            is_kind(instance, reference, ValueKind::Structural)?;
            instance.run.set_integer(reference, i64::try_from(value).unwrap_or(i64::MAX))
        })
    })
}
