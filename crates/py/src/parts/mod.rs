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
mod signals;
mod three_axis_law;

use std::any::Any;
use std::sync::Arc;

use flexsc_core::control::actuator::ActuatorSpec;
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
pub use three_axis_law::{ThreeAxisEvent, ThreeAxisHold};

use signals::Signals;

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
                own.actuators.push((place.parse()?, actuator(&part, place)?));
            }
            Some((_, place)) => {
                let role = if place == "0" { "sensor".to_owned() } else { format!("sensor{place}") };
                let sensor = sensor::PythonSensor::from_python(&part, &role)?;
                let topics = Signals::topics(sensor.signals.as_ref());
                own.sensors.push((place.parse()?, Custom::with_topics(Arc::new(sensor), topics)));
            }
            None if role == "law" && part.hasattr("address")? => {
                own.law = Some(Custom::new(Arc::new(compiled::CompiledLaw::from_python(&part)?)));
            }
            None if role == "law" && is_of(&part, "ThreeAxisLaw")? => {
                let law = three_axis_law::PythonThreeAxisLaw::from_python(&part)?;
                let topics = Signals::topics(law.signals.as_ref());
                own.law = Some(Custom::with_topics(Arc::new(law), topics));
            }
            None if role == "law" => {
                let law = law::PythonLaw::from_python(&part)?;
                let topics = Signals::topics(law.signals.as_ref());
                own.law = Some(Custom::with_topics(Arc::new(law), topics));
            }
            None if role == "estimator" => {
                let estimator = estimator::PythonEstimator::from_python(&part)?;
                let topics = Signals::topics(estimator.signals.as_ref());
                own.estimator = Some(Custom::with_topics(Arc::new(estimator), topics));
            }
            None if role == "adaptation" => {
                let adaptation = adaptation::PythonAdaptation::from_python(&part)?;
                let topics = Signals::topics(adaptation.signals.as_ref());
                own.adaptation = Some(Custom::with_topics(Arc::new(adaptation), topics));
            }
            None => own.actuators.push((0, actuator(&part, "0")?)),
        }
    }
    Ok(own)
}

/// Returns true if a part is of a class of `flexsc.parts`.
fn is_of(part: &Bound<'_, PyAny>, class: &str) -> PyResult<bool> {
    part.is_instance(&part.py().import("flexsc.parts")?.getattr(class)?)
}

/// The engine's actuator of a Python object at a place in a list.
fn actuator(part: &Bound<'_, PyAny>, place: &str) -> PyResult<Custom<dyn ActuatorSpec>> {
    let role = if place == "0" { "actuator".to_owned() } else { format!("actuator{place}") };
    let actuator = actuator::PythonActuator::from_python(part, &role)?;
    let topics = Signals::topics(actuator.signals.as_ref());
    Ok(Custom::with_topics(Arc::new(actuator), topics))
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
