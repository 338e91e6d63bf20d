//! Parts written in Python: objects with a role's methods, called at events and samples alone.

#[macro_use]
mod attributes;

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
use flexsc_core::scenario::{CustomLaw, CustomParts};
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

/// A part of each role by its key; sensors have their place behind it, `sensor 0`, and actuators after the first; laws of
/// modes of operation their name, and of stages their number.
pub type Named = (String, Py<PyAny>);

/// The engine's parts of Python's objects.
pub fn own_parts(py: Python<'_>, named: Vec<Named>) -> PyResult<CustomParts> {
    let mut own = CustomParts::default();
    for (role, part) in named {
        // The caller may change his object: a scenario does not.
        let part = part.bind(py).call_method0("copy")?;
        match role.split_once(' ') {
            Some(("law", stage)) => own.stage_laws.push((stage.to_owned(), law(&part, &stage_role(stage))?)),
            Some(("actuator", place)) => own.actuators.push((place.parse()?, actuator(&part, place)?)),
            Some((_, place)) => {
                let role = if place == "0" { "sensor".to_owned() } else { format!("sensor{place}") };
                let sensor = sensor::PythonSensor::from_python(&part, &role)?;
                let signals = sensor.signals.clone();
                own.sensors.push((place.parse()?, custom(Arc::new(sensor), signals.as_ref(), &part)));
            }
            None if role == "law" => own.law = Some(law(&part, "law")?),
            None if role == "estimator" => {
                let estimator = estimator::PythonEstimator::from_python(&part)?;
                let signals = estimator.signals.clone();
                own.estimator = Some(custom(Arc::new(estimator), signals.as_ref(), &part));
            }
            None if role == "adaptation" => {
                let adaptation = adaptation::PythonAdaptation::from_python(&part)?;
                let signals = adaptation.signals.clone();
                own.adaptation = Some(custom(Arc::new(adaptation), signals.as_ref(), &part));
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

/// Returns the engine's part of a Python object, with the topics of its signals.
fn custom<T: ?Sized>(part: Arc<T>, signals: Option<&Signals>, object: &Bound<'_, PyAny>) -> Custom<T> {
    Custom::with_topics(part, Signals::topics(signals)).with_origin(object::Object::new(object))
}

/// Returns the role of the law of a mode of operation or of a stage in the name of its topic: `law_point`, or `law1` for the
/// second stage.
fn stage_role(stage: &str) -> String {
    match stage.parse() {
        Ok(0_usize) => "law".to_owned(),
        Ok(index) => format!("law{index}"),
        Err(_) => format!("law_{}", stage.to_lowercase().replace('-', "_")),
    }
}

/// Returns the engine's law of a Python object: compiled, about three axes together, or about each axis.
fn law(part: &Bound<'_, PyAny>, role: &str) -> PyResult<CustomLaw> {
    if part.hasattr("address")? {
        return Ok(custom(Arc::new(compiled::CompiledLaw::from_python(part)?), None, part));
    }
    if is_of(part, "ThreeAxisLaw")? {
        let law = three_axis_law::PythonThreeAxisLaw::from_python(part, role)?;
        let signals = law.signals.clone();
        return Ok(custom(Arc::new(law), signals.as_ref(), part));
    }
    let law = law::PythonLaw::from_python(part, role)?;
    let signals = law.signals.clone();
    Ok(custom(Arc::new(law), signals.as_ref(), part))
}

/// Returns the engine's actuator of a Python object at a place in a list.
fn actuator(part: &Bound<'_, PyAny>, place: &str) -> PyResult<Custom<dyn ActuatorSpec>> {
    let role = if place == "0" { "actuator".to_owned() } else { format!("actuator{place}") };
    let actuator = actuator::PythonActuator::from_python(part, &role)?;
    let signals = actuator.signals.clone();
    Ok(custom(Arc::new(actuator), signals.as_ref(), part))
}

/// Python's objects of a scenario's parts.
pub fn named(py: Python<'_>, own: &CustomParts) -> Vec<Named> {
    let mut named = Vec::new();
    let mut add = |role: String, origin: Option<&(dyn Any + Send + Sync)>| {
        if let Some(object) = origin.and_then(|origin| origin.downcast_ref::<object::Object>()) {
            named.push((role, object.clone_ref(py)));
        }
    };
    add("law".to_owned(), own.law.as_ref().and_then(Custom::origin));
    for (stage, law) in &own.stage_laws {
        add(format!("law {stage}"), law.origin());
    }
    add("estimator".to_owned(), own.estimator.as_ref().and_then(Custom::origin));
    add("adaptation".to_owned(), own.adaptation.as_ref().and_then(Custom::origin));
    for (place, sensor) in &own.sensors {
        add(format!("sensor {place}"), sensor.origin());
    }
    for (place, actuator) in &own.actuators {
        let role = if *place == 0 { "actuator".to_owned() } else { format!("actuator {place}") };
        add(role, actuator.origin());
    }
    named
}

/// Work with parts written in Python, without the interpreter's lock: a thread that is known to it gets the lock back faster.
pub fn known_thread<T: Send>(is_own: bool, work: impl FnOnce() -> T + Send) -> T {
    if is_own { Python::attach(|py| py.detach(work)) } else { work() }
}
