//! FMI 3.0: states of an instance, in memory and as bytes.

#![expect(unsafe_code, reason = "functions of C have the names of the standard")]

use std::ffi::c_int;

use crate::boundary::{Held, Results, Values};
use crate::instance::{Instance, InstanceState, Outcome, call, no_pointer, refused};

/// Writes a snapshot into the importer's pointer, and frees the one that is there.
pub fn get_state(instance: &mut Instance, state: &mut Results<Held<InstanceState>>) -> Outcome {
    state.replace(Held::new(instance.snapshot())).ok_or_else(no_pointer)
}

/// Restores a snapshot.
pub fn set_state(instance: &mut Instance, mut state: Held<InstanceState>) -> Outcome {
    instance.restore(state.get().ok_or_else(no_pointer)?);
    Ok(())
}

/// Frees a snapshot, and sets the importer's pointer to null.
pub fn free_state(state: &mut Results<Held<InstanceState>>) -> Outcome {
    state.replace(Held::null()).ok_or_else(no_pointer)
}

/// Writes the number of bytes of a snapshot.
pub fn serialized_size(mut state: Held<InstanceState>, size: &mut Results<usize>) -> Outcome {
    size.write(Instance::to_bytes(state.get().ok_or_else(no_pointer)?).len());
    Ok(())
}

/// Writes the bytes of a snapshot.
pub fn serialize(mut state: Held<InstanceState>, bytes: &mut Results<u8>, size: usize) -> Outcome {
    let own = Instance::to_bytes(state.get().ok_or_else(no_pointer)?);
    let place = bytes.place(size).ok_or_else(no_pointer)?;
    let Some(place) = place.get_mut(..own.len()) else {
        return Err(refused("there is less space than the state needs"));
    };
    for (place, byte) in place.iter_mut().zip(own) {
        place.write(byte);
    }
    Ok(())
}

/// Writes the snapshot of these bytes into the importer's pointer, and frees the one that is there.
pub fn deserialize(
    instance: &mut Instance,
    bytes: &Values<u8>,
    size: usize,
    state: &mut Results<Held<InstanceState>>,
) -> Outcome {
    let snapshot = instance.snapshot_from_bytes(bytes.read(size).ok_or_else(no_pointer)?)?;
    state.replace(Held::new(snapshot)).ok_or_else(no_pointer)
}

/// Gets the state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetFMUState(
    instance: Held<Instance>,
    mut state: Results<Held<InstanceState>>,
) -> c_int {
    call(instance, |instance| get_state(instance, &mut state))
}

/// Sets the state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(instance: Held<Instance>, state: Held<InstanceState>) -> c_int {
    call(instance, |instance| set_state(instance, state))
}

/// Frees a state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeFMUState(
    instance: Held<Instance>,
    mut state: Results<Held<InstanceState>>,
) -> c_int {
    call(instance, |_| free_state(&mut state))
}

/// Gets the number of bytes of a state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SerializedFMUStateSize(
    instance: Held<Instance>,
    state: Held<InstanceState>,
    mut size: Results<usize>,
) -> c_int {
    call(instance, |_| serialized_size(state, &mut size))
}

/// Gets the bytes of a state: everything that the importer has set, from which the run can be repeated.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SerializeFMUState(
    instance: Held<Instance>,
    state: Held<InstanceState>,
    mut bytes: Results<u8>,
    size: usize,
) -> c_int {
    call(instance, |_| serialize(state, &mut bytes, size))
}

/// Creates a state from its bytes: the run is repeated.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3DeserializeFMUState(
    instance: Held<Instance>,
    bytes: Values<u8>,
    size: usize,
    mut state: Results<Held<InstanceState>>,
) -> c_int {
    call(instance, |instance| deserialize(instance, &bytes, size, &mut state))
}
