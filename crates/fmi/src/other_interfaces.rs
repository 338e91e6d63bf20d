//! Functions of the interfaces that the FMUs do not offer, model exchange and scheduled execution: some importers look for all
//! functions of the standards.

#![expect(unsafe_code, reason = "functions of C have the names of the standard")]

use std::ffi::c_int;

use crate::boundary::{Held, Results, Values};
use crate::instance::{Instance, call, refused};

fn refuse(instance: Held<Instance>) -> c_int {
    call(instance, |_| Err(refused("the FMU offers co-simulation alone")))
}

/// Declares functions that fail.
macro_rules! refused {
    ($($name:ident($($argument:ident: $of:ty),*);)+) => {$(
        /// Fails: the FMU offers co-simulation alone.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(instance: Held<Instance>, $($argument: $of),*) -> c_int {
            refuse(instance)
        }
    )+};
}

refused! {
    fmi3ActivateModelPartition(_clock: u32, _time: f64);
    fmi3EnterContinuousTimeMode();
    fmi3CompletedIntegratorStep(_no_earlier_state: bool, _enter_event_mode: Results<bool>, _terminate: Results<bool>);
    fmi3SetTime(_time: f64);
    fmi3SetContinuousStates(_states: Values<f64>, _count: usize);
    fmi3GetContinuousStateDerivatives(_derivatives: Results<f64>, _count: usize);
    fmi3GetEventIndicators(_indicators: Results<f64>, _count: usize);
    fmi3GetContinuousStates(_states: Results<f64>, _count: usize);
    fmi3GetNominalsOfContinuousStates(_nominals: Results<f64>, _count: usize);
    fmi3GetNumberOfEventIndicators(_count: Results<usize>);
    fmi3GetNumberOfContinuousStates(_count: Results<usize>);
    fmi2EnterEventMode();
    fmi2NewDiscreteStates(_event_info: Results<[f64; 4]>);
    fmi2EnterContinuousTimeMode();
    fmi2CompletedIntegratorStep(_no_earlier_state: c_int, _enter_event_mode: Results<c_int>, _terminate: Results<c_int>);
    fmi2SetTime(_time: f64);
    fmi2SetContinuousStates(_states: Values<f64>, _count: usize);
    fmi2GetDerivatives(_derivatives: Results<f64>, _count: usize);
    fmi2GetEventIndicators(_indicators: Results<f64>, _count: usize);
    fmi2GetContinuousStates(_states: Results<f64>, _count: usize);
    fmi2GetNominalsOfContinuousStates(_nominals: Results<f64>, _count: usize);
}
