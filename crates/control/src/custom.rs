//! Custom parts: kinds of a role that another crate provides, and that a scenario file cannot name.

use std::any::Any;
use std::borrow::Cow;
use std::error::Error;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use flexsc_record::CustomTopic;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Custom part provided by a program, shared by all runs of a scenario.
pub struct Custom<T: ?Sized> {
    part: Arc<T>,
    topics: Arc<[Arc<CustomTopic>]>,
    /// Object of the program from which the part was made.
    origin: Option<Arc<dyn Any + Send + Sync>>,
}

impl<T: ?Sized> Custom<T> {
    /// Wraps a custom part that logs no rows of its own.
    pub fn new(part: Arc<T>) -> Self {
        Self::with_topics(part, Vec::new())
    }

    /// Wraps a custom part with the topics of the rows that it reports.
    pub fn with_topics(part: Arc<T>, topics: Vec<Arc<CustomTopic>>) -> Self {
        Self { part, topics: topics.into(), origin: None }
    }

    /// Returns the part with the object of the program from which it was made.
    #[must_use]
    pub fn with_origin(self, origin: impl Any + Send + Sync) -> Self {
        Self { origin: Some(Arc::new(origin)), ..self }
    }

    /// Returns the object of the program from which the part was made; `None` if none was given.
    pub fn origin(&self) -> Option<&(dyn Any + Send + Sync)> {
        self.origin.as_deref()
    }

    /// Returns the topics of the rows that the part reports.
    pub fn topics(&self) -> &[Arc<CustomTopic>] {
        &self.topics
    }
}

impl<T: ?Sized> Deref for Custom<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.part
    }
}

impl<T: ?Sized> Clone for Custom<T> {
    fn clone(&self) -> Self {
        Self { part: Arc::clone(&self.part), topics: Arc::clone(&self.topics), origin: self.origin.clone() }
    }
}

impl<T: ?Sized> fmt::Debug for Custom<T> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("Own")
    }
}

impl<T: ?Sized> PartialEq for Custom<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.part, &other.part)
    }
}

/// Serialises the part as an empty table.
impl<T: ?Sized> Serialize for Custom<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(std::iter::empty::<(&str, &str)>())
    }
}

impl<'de, T: ?Sized> Deserialize<'de> for Custom<T> {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(serde::de::Error::custom("is a part defined by a program, which a scenario file cannot name"))
    }
}

/// Error of a custom part, which ends the run.
#[derive(Clone, Debug)]
pub struct PartError(Arc<dyn Error + Send + Sync>);

impl PartError {
    /// Creates the error of a custom part from its cause.
    pub fn new(error: impl Error + Send + Sync + 'static) -> Self {
        Self(Arc::new(error))
    }

    /// Returns the cause, if it is of this type.
    pub fn downcast<E: Error + 'static>(&self) -> Option<&E> {
        self.0.downcast_ref()
    }
}

impl fmt::Display for PartError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(out)
    }
}

impl Error for PartError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.0.source()
    }
}

impl<T: ?Sized> JsonSchema for Custom<T> {
    fn schema_name() -> Cow<'static, str> {
        "Own".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        false.into()
    }
}
