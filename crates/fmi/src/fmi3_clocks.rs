//! FMI 3.0: clocks and their intervals.

#![expect(unsafe_code, reason = "functions of C have the names of the standard")]

use std::ffi::c_int;

use crate::boundary::{Held, Results, Values};
use crate::instance::{Instance, InstanceMode, Outcome, call, no_pointer, refused};

/// Qualifier of an interval that is known.
const CHANGED: c_int = 2;
/// Resolution of intervals: femtoseconds in a second.
const RESOLUTION: u64 = 1_000_000_000_000_000;

/// Gets the ticks of clocks at the current event.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetClock(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut values: Results<bool>,
) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Initialization, InstanceMode::Event])?;
        let references = references.read(count).ok_or_else(no_pointer)?;
        let places = values.place(count).ok_or_else(no_pointer)?;
        for (reference, place) in references.iter().zip(places) {
            place.write(instance.run.clock(*reference)?);
        }
        Ok(())
    })
}

/// Accepts ticks of the periodic clocks. They change nothing: samples and decisions are events of the run itself.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetClock(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    _values: Values<bool>,
) -> c_int {
    call(instance, |instance| {
        instance.in_mode(&[InstanceMode::Event])?;
        let references = references.read(count).ok_or_else(no_pointer)?;
        references.iter().try_for_each(|reference| instance.run.interval(*reference).map(|_| ()))
    })
}

/// Gets the intervals of periodic clocks (s), and a qualifier for each.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetIntervalDecimal(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut intervals: Results<f64>,
    mut qualifiers: Results<c_int>,
) -> c_int {
    call(instance, |instance| {
        let references = references.read(count).ok_or_else(no_pointer)?;
        let places = intervals.place(count).ok_or_else(no_pointer)?;
        for (reference, place) in references.iter().zip(places) {
            place.write(instance.run.interval(*reference)?.seconds());
        }
        qualifiers.fill(count, CHANGED).ok_or_else(no_pointer)
    })
}

/// Gets the intervals of periodic clocks as fractions, exact to the femtosecond, and a qualifier for each.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetIntervalFraction(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut counters: Results<u64>,
    mut resolutions: Results<u64>,
    mut qualifiers: Results<c_int>,
) -> c_int {
    call(instance, |instance| {
        let references = references.read(count).ok_or_else(no_pointer)?;
        let places = counters.place(count).ok_or_else(no_pointer)?;
        for (reference, place) in references.iter().zip(places) {
            place.write(instance.run.interval(*reference)?.leading_femtoseconds() as u64);
        }
        resolutions.fill(count, RESOLUTION).ok_or_else(no_pointer)?;
        qualifiers.fill(count, CHANGED).ok_or_else(no_pointer)
    })
}

/// Gets the shifts of periodic clocks (s), which are 0.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetShiftDecimal(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut shifts: Results<f64>,
) -> c_int {
    call(instance, |instance| {
        periodic(instance, &references, count)?;
        shifts.fill(count, 0.0).ok_or_else(no_pointer)
    })
}

/// Gets the shifts of periodic clocks as fractions, which are 0.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetShiftFraction(
    instance: Held<Instance>,
    references: Values<u32>,
    count: usize,
    mut counters: Results<u64>,
    mut resolutions: Results<u64>,
) -> c_int {
    call(instance, |instance| {
        periodic(instance, &references, count)?;
        counters.fill(count, 0).ok_or_else(no_pointer)?;
        resolutions.fill(count, RESOLUTION).ok_or_else(no_pointer)
    })
}

/// Returns an error unless all references are those of periodic clocks.
fn periodic(instance: &Instance, references: &Values<u32>, count: usize) -> Outcome {
    let references = references.read(count).ok_or_else(no_pointer)?;
    references.iter().try_for_each(|reference| instance.run.interval(*reference).map(|_| ()))
}

/// Fails: the intervals follow from the scenario.
fn constant(count: usize) -> Outcome {
    if count == 0 { Ok(()) } else { Err(refused("the intervals and shifts of the clocks are constant")) }
}

/// Fails: intervals are constant.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetIntervalDecimal(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _intervals: Values<f64>,
) -> c_int {
    call(instance, |_| constant(count))
}

/// Fails: intervals are constant.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetIntervalFraction(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _counters: Values<u64>,
    _resolutions: Values<u64>,
) -> c_int {
    call(instance, |_| constant(count))
}

/// Fails: shifts are constant.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetShiftDecimal(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _shifts: Values<f64>,
) -> c_int {
    call(instance, |_| constant(count))
}

/// Fails: shifts are constant.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetShiftFraction(
    instance: Held<Instance>,
    _references: Values<u32>,
    count: usize,
    _counters: Values<u64>,
    _resolutions: Values<u64>,
) -> c_int {
    call(instance, |_| constant(count))
}
