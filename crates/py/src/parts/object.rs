//! An object of Python as the engine holds it: copied for each run, with the error that it raised.

use std::fmt;
use std::sync::OnceLock;

use flexsc_core::control::custom::PartError;
use pyo3::prelude::*;
use pyo3::types::{PySequence, PyString, PyTuple};

/// An object with a role's methods.
pub struct Object(Py<PyAny>);

impl fmt::Debug for Object {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("Object")
    }
}

impl Object {
    pub fn new(object: &Bound<'_, PyAny>) -> Self {
        Self(object.clone().unbind())
    }

    pub fn clone_ref(&self, py: Python<'_>) -> Py<PyAny> {
        self.0.clone_ref(py)
    }

    /// A copy of it.
    pub fn copy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.bind(py).call_method0(pyo3::intern!(py, "copy"))
    }

    /// A copy of it, begun with an argument.
    pub fn started_copy<'py, A>(&self, py: Python<'py>, with: A) -> PyResult<Bound<'py, PyAny>>
    where
        A: IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>
            + pyo3::call::PyCallArgs<'py>,
    {
        let copy = self.copy(py)?;
        copy.call_method1(pyo3::intern!(py, "start"), with)?;
        Ok(copy)
    }
}

/// Method of a part during a run, or the error that ended it.
#[derive(Debug)]
pub struct Method {
    /// The part, and its method.
    at_work: Option<(Object, Py<PyAny>)>,
    halted: OnceLock<PartError>,
}

impl Method {
    /// This method of a part that has begun.
    pub fn new(part: PyResult<Bound<'_, PyAny>>, name: &str) -> Self {
        let both = part.and_then(|part| Ok((Object::new(&part), part.getattr(name)?.unbind())));
        let method = Self { at_work: None, halted: OnceLock::new() };
        match method.ok_or_halt(both) {
            Some(both) => Self { at_work: Some(both), ..method },
            None => method,
        }
    }

    /// The part and its method, unless it cannot go on.
    fn at_work(&self) -> Option<&(Object, Py<PyAny>)> {
        self.at_work.as_ref().filter(|_| self.halted.get().is_none())
    }

    /// Calls the method with what `argument` makes, and reads what it gives; nothing of a part that cannot go on.
    pub fn call<'py, T>(
        &self,
        py: Python<'py>,
        argument: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
        read: impl FnOnce(&Bound<'py, PyAny>) -> PyResult<T>,
    ) -> Option<T> {
        let (_, method) = self.at_work()?;
        let reported = argument().and_then(|argument| method.bind(py).call1((argument,)));
        self.ok_or_halt(reported.and_then(|returned| read(&returned)))
    }

    /// Calls another of the part's methods.
    pub fn other<'py, T>(
        &self,
        py: Python<'py>,
        call: impl FnOnce(&Bound<'py, PyAny>) -> PyResult<T>,
    ) -> Option<T> {
        self.ok_or_halt(call(self.at_work()?.0.0.bind(py)))
    }

    /// Returns the value of a call; an error is kept.
    fn ok_or_halt<T>(&self, returned: PyResult<T>) -> Option<T> {
        returned.map_err(|error| self.halted.set(PartError::new(error))).ok()
    }

    pub fn halted(&self) -> Option<PartError> {
        self.halted.get().cloned()
    }

    /// This method of a copy of the part.
    pub fn copy(&self, name: &str) -> Self {
        match self.at_work() {
            None => Self { at_work: None, halted: self.halted.clone() },
            Some((part, _)) => Python::attach(|py| Self::new(part.copy(py), name)),
        }
    }
}

/// Whether the class of a part has a method of its own in the place of that of the role.
pub fn overrides(part: &Bound<'_, PyAny>, role: &str, method: &str) -> PyResult<bool> {
    let role = part.py().import("flexsc.parts")?.getattr(role)?;
    Ok(!part.get_type().getattr(method)?.is(role.getattr(method)?))
}

/// Returns the shape of an array or of nested sequences, `(3, 2)`, or the type of another object.
pub fn shape(object: &Bound<'_, PyAny>) -> String {
    fn sizes(object: &Bound<'_, PyAny>, found: &mut Vec<usize>) {
        if let Ok(sequence) = object.cast::<PySequence>()
            && object.cast::<PyString>().is_err()
            && let Ok(size) = sequence.len()
        {
            found.push(size);
            if let Ok(first) = sequence.get_item(0) {
                sizes(&first, found);
            }
        }
    }
    if let Ok(shape) = object.getattr("shape") {
        return format!("shape {shape}");
    }
    let mut found = Vec::new();
    sizes(object, &mut found);
    match &found[..] {
        [] => object.get_type().name().map_or_else(|_| "another object".to_owned(), |name| name.to_string()),
        [size] => format!("shape ({size},)"),
        _ => format!("shape ({})", found.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Numbers of anything that can be iterated over.
pub fn numbers(object: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    object.try_iter()?.map(|number| number?.extract()).collect()
}

/// Returns the numbers of a sequence, which must be exactly `N`.
pub fn exactly<const N: usize>(object: &Bound<'_, PyAny>, name: &str) -> PyResult<[f64; N]> {
    let all = numbers(object)?;
    let count = all.len();
    let wrong = || format!("{name} must be {N} numbers, got {count}");
    all.try_into().map_err(|_| pyo3::exceptions::PyValueError::new_err(wrong()))
}
