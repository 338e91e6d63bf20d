//! Parts written in Python: objects with a role's methods, called at events and samples alone.

mod actuator;
mod adaptation;
mod attitude;
mod bring;
mod compiled;
mod draws;
mod estimator;
mod hold;
mod instant;
mod law;
mod object;
mod reading;
mod sensor;

use std::any::Any;
use std::sync::Arc;

use flexsc_core::control::custom::Custom;
use flexsc_core::scenario::CustomParts;
use pyo3::prelude::*;

pub use actuator::{Demanded, Effort, Setting};
pub use bring::{beside_parts, parts_of, text_beside_parts, with_parts};
pub use draws::{Draws, Stream};
pub use estimator::{Known, Taken};
pub use hold::Hold;
pub use instant::Instant;
pub use law::{Authority, Event};
pub use reading::{Reading, Truth};

/// A part of each role by its key; sensors have their place behind it, `sensor 0`, and actuators after the first.
pub type Named = (String, Py<PyAny>);

/// The engine's parts of Python's objects.
pub fn own_parts(py: Python<'_>, named: Vec<Named>) -> PyResult<CustomParts> {
    let mut own = CustomParts::default();
    for (role, part) in named {
        // The caller may change his object: a scenario does not.
        let part = part.bind(py).call_method0("copy")?;
        match role.split_once(' ') {
            Some(("actuator", place)) => {
                own.actuators.push((
                    place.parse()?,
                    Custom::new(Arc::new(actuator::PythonActuator::from_python(&part)?)),
                ));
            }
            Some((_, place)) => {
                own.sensors
                    .push((place.parse()?, Custom::new(Arc::new(sensor::PythonSensor::from_python(&part)?))));
            }
            None if role == "law" && part.hasattr("address")? => {
                own.law = Some(Custom::new(Arc::new(compiled::CompiledLaw::from_python(&part)?)));
            }
            None if role == "law" => {
                own.law = Some(Custom::new(Arc::new(law::PythonLaw::from_python(&part)?)));
            }
            None if role == "estimator" => {
                own.estimator = Some(Custom::new(Arc::new(estimator::PythonEstimator::from_python(&part)?)));
            }
            None if role == "adaptation" => {
                own.adaptation =
                    Some(Custom::new(Arc::new(adaptation::PythonAdaptation::from_python(&part)?)));
            }
            None => {
                own.actuators.push((0, Custom::new(Arc::new(actuator::PythonActuator::from_python(&part)?))));
            }
        }
    }
    Ok(own)
}

/// Python's objects of a scenario's parts.
pub fn named(py: Python<'_>, own: &CustomParts) -> Vec<Named> {
    let object = |any: Option<&dyn Any>| -> Option<Py<PyAny>> {
        Some(any?.downcast_ref::<object::Object>()?.clone_ref(py))
    };
    let roles = [
        ("law", own.law.as_ref().and_then(|law| object(law.any()))),
        ("estimator", own.estimator.as_ref().and_then(|estimator| object(estimator.any()))),
        ("adaptation", own.adaptation.as_ref().and_then(|adaptation| object(adaptation.any()))),
    ];
    let roles = roles.into_iter().filter_map(|(role, part)| Some((role.to_owned(), part?)));
    let sensors = own.sensors.iter();
    let sensors =
        sensors.filter_map(|(place, sensor)| Some((format!("sensor {place}"), object(sensor.any())?)));
    let actuators = own.actuators.iter();
    let actuators = actuators.filter_map(|(place, actuator)| {
        let role = if *place == 0 { "actuator".to_owned() } else { format!("actuator {place}") };
        Some((role, object(actuator.any())?))
    });
    roles.chain(sensors).chain(actuators).collect()
}

/// Work with parts written in Python, without the interpreter's lock: a thread that is known to it gets the lock back faster.
pub fn known_thread<T: Send>(is_own: bool, work: impl FnOnce() -> T + Send) -> T {
    if is_own { Python::attach(|py| py.detach(work)) } else { work() }
}
