//! Parts written in Python: objects with a role's methods, called at events and samples alone.

#[macro_use]
mod attributes;

mod actuator;
mod adaptation;
mod attitude;
mod bring;
mod compiled;
mod compiled_arrays;
mod disturbance;
mod draws;
mod estimator;
mod guidance;
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
use flexsc_core::control::disturbance::DisturbanceSpec;
use flexsc_core::control::guidance::GuidanceSpec;
use flexsc_core::scenario::{CustomLaw, CustomParts};
use pyo3::prelude::*;

pub use actuator::{Demanded, Effort, Setting};
pub use bring::{beside_parts, parts_of, text_beside_parts, with_parts};
pub use disturbance::Load;
pub use draws::{Draws, Stream};
pub use estimator::{Known, Taken};
pub use guidance::{Aim, Sky};
pub use hold::Hold;
pub use instant::Instant;
pub use law::{Authority, Event};
pub use reading::{Reading, Truth};
pub use three_axis_law::{ThreeAxisEvent, ThreeAxisHold};

use signals::Signals;

/// A part of each role by its key; sensors have their place behind it, `sensor 0`, and actuators after the first; laws of
/// modes of operation their name, and of stages their number; disturbances their place, and guidance of modes their name.
pub type Named = (String, Py<PyAny>);

/// The engine's parts of Python's objects.
pub fn own_parts(py: Python<'_>, named: Vec<Named>) -> PyResult<CustomParts> {
    let mut own = CustomParts::default();
    for (role, part) in named {
        // The caller may change his object: a scenario does not.
        let part = part.bind(py).call_method0("copy")?;
        match role.split_once(' ') {
            Some(("law", stage)) => own.stage_laws.push((stage.to_owned(), law(&part, &stage_role(stage))?)),
            Some(("disturbance", place)) => {
                own.disturbances.push((place.parse()?, disturbance(&part, place)?));
            }
            Some(("guidance", mode)) => own.guidance.push((mode.to_owned(), guidance(&part, mode)?)),
            Some(("actuator", place)) => own.actuators.push((place.parse()?, actuator(&part, place)?)),
            Some((_, place)) => {
                let sensor = sensor::PythonSensor::from_python(&part, &placed("sensor", place))?;
                let signals = sensor.signals.clone();
                own.sensors.push((place.parse()?, custom(Arc::new(sensor), signals.as_ref(), &part)));
            }
            None if role == "guidance" => own.guidance.push((String::new(), guidance(&part, "")?)),
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
    if stage.parse::<usize>().is_ok() { placed("law", stage) } else { mode_role("law", stage) }
}

/// Returns the role of a part of a mode of operation in the name of its topic.
fn mode_role(role: &str, mode: &str) -> String {
    format!("{role}_{}", mode.to_lowercase().replace('-', "_"))
}

/// Returns a role with its place in a list, which the first does not have, in the name of its topic.
fn placed(role: &str, place: &str) -> String {
    if place == "0" { role.to_owned() } else { format!("{role}{place}") }
}

/// Returns the engine's law of a Python object: compiled, about three axes together, or about each axis.
fn law(part: &Bound<'_, PyAny>, role: &str) -> PyResult<CustomLaw> {
    if is_of(part, "CompiledThreeAxisLaw")? {
        return Ok(custom(Arc::new(compiled_arrays::CompiledThreeAxisLaw::from_python(part)?), None, part));
    }
    if is_of(part, "CompiledLaw")? {
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
    let actuator = actuator::PythonActuator::from_python(part, &placed("actuator", place))?;
    let signals = actuator.signals.clone();
    Ok(custom(Arc::new(actuator), signals.as_ref(), part))
}

/// Returns the engine's disturbance of a Python object at a place in a list.
fn disturbance(part: &Bound<'_, PyAny>, place: &str) -> PyResult<Custom<dyn DisturbanceSpec>> {
    if is_of(part, "CompiledDisturbance")? {
        let disturbance = compiled_arrays::CompiledDisturbance::from_python(part)?;
        return Ok(custom(Arc::new(disturbance), None, part));
    }
    let role = placed("disturbance", place);
    let disturbance = disturbance::PythonDisturbance::from_python(part, &role)?;
    let signals = disturbance.signals.clone();
    Ok(custom(Arc::new(disturbance), signals.as_ref(), part))
}

/// Returns the engine's guidance of a Python object, for a mode of operation or for the whole run.
fn guidance(part: &Bound<'_, PyAny>, mode: &str) -> PyResult<Custom<dyn GuidanceSpec>> {
    if is_of(part, "CompiledGuidance")? {
        return Ok(custom(Arc::new(compiled_arrays::CompiledGuidance::from_python(part)?), None, part));
    }
    let role = if mode.is_empty() { "guidance".to_owned() } else { mode_role("guidance", mode) };
    let guidance = guidance::PythonGuidance::from_python(part, &role)?;
    let signals = guidance.signals.clone();
    Ok(custom(Arc::new(guidance), signals.as_ref(), part))
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
    for (place, disturbance) in &own.disturbances {
        add(format!("disturbance {place}"), disturbance.origin());
    }
    for (mode, guidance) in &own.guidance {
        let role = if mode.is_empty() { "guidance".to_owned() } else { format!("guidance {mode}") };
        add(role, guidance.origin());
    }
    named
}

/// Work with parts written in Python, without the interpreter's lock: a thread that is known to it gets the lock back faster.
pub fn known_thread<T: Send>(is_own: bool, work: impl FnOnce() -> T + Send) -> T {
    if is_own { Python::attach(|py| py.detach(work)) } else { work() }
}
