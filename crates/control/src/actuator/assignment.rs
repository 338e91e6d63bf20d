//! Actuator entries of a scenario, `[actuator.KIND]` or entries of `[[actuator]]`, with their tasks.

use std::fmt;

use flexsc_spacecraft::axes::Axis;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde::ser::{Serialize, Serializer};

use super::{ActuatorEntry, ActuatorKind, Share, UnloadingTask, WheelUnloading};

/// Name of the kind that needs no keys.
const IDEAL: &str = "ideal";

/// Actuator with its task: its part of the demand, or the unloading of wheels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AssignedActuator {
    /// Kind of the actuator.
    pub kind: ActuatorKind,
    /// Axes whose demand the actuator executes; `None` for all.
    pub axes: Option<Vec<Axis>>,
    /// Share of the demand about these axes; `None` for all of it.
    pub share: Option<Share>,
    /// Settings for unloading the wheels of the list, instead of executing a part of the demand.
    pub unloads: Option<Box<UnloadingTask>>,
}

impl From<ActuatorKind> for AssignedActuator {
    fn from(kind: ActuatorKind) -> Self {
        Self { kind, ..Self::default() }
    }
}

/// Declares the names of the kinds, and the keys of an actuator in a list: those of the kinds and of the task.
macro_rules! entries {
    ($($(#[$doc:meta])* $key:literal $kind:ident($settings:ty),)*) => {
        /// Name of a kind of actuator, as in a scenario.
        #[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum ActuatorName {
            $($(#[$doc])* #[serde(rename = $key)] $kind,)*
            /// An actuator of another crate, or of Python.
            Own,
        }

        impl ActuatorName {
            /// Returns the name as in a scenario.
            pub fn as_str(self) -> &'static str {
                match self {
                    $(Self::$kind => $key,)*
                    Self::Own => "own",
                }
            }
        }

        /// An actuator of a list: exactly one of the kinds, and which part of the demand it executes.
        #[derive(Default, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        #[schemars(rename = "Assigned")]
        #[expect(non_snake_case, reason = "a kind has the field of its name")]
        struct ActuatorEntry {
            $($(#[$doc])* #[serde(rename = $key, default, skip_serializing_if = "Option::is_none")] $kind: Option<$settings>,)*
            /// Axes about which it executes the demand, on a body with three; default: all.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            axes: Option<Vec<flexsc_spacecraft::axes::Axis>>,
            /// Share of the demand about these axes; default: 1. The shares of all actuators about an axis must sum to 1.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            share: Option<Share>,
            /// For `jets` or `magnetorquers`: how they unload the `wheels` or `control_moment_gyros` of the list. They then execute no demand.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            unloads: Option<Box<UnloadingTask>>,
        }

        impl ActuatorEntry {
            /// Moves out the kinds that are given.
            fn kinds(&mut self) -> Vec<ActuatorKind> {
                [$(self.$kind.take().map(ActuatorKind::$kind)),*].into_iter().flatten().collect()
            }

            fn from_assignment(assigned: &AssignedActuator) -> Self {
                let AssignedActuator { kind, axes, share, unloads } = assigned.clone();
                let mut keys = Self { axes, share, unloads, ..Self::default() };
                match kind {
                    $(ActuatorKind::$kind(kind) => keys.$kind = Some(kind),)*
                    ActuatorKind::Own(_) => keys.Ideal = Some(Ideal::default()),
                }
                keys
            }

            const NAMES: &str = concat!($("`", $key, "`, "),*);
        }
    };
}

impl AssignedActuator {
    /// Returns the unloading that is given within wheels.
    pub(super) fn unloading(&self) -> Option<&WheelUnloading> {
        if let ActuatorKind::Wheels(wheels) = &self.kind { wheels.unloading.as_deref() } else { None }
    }

    /// Returns true if the entry has keys of a task.
    pub(super) fn has_task(&self) -> bool {
        self.axes.is_some() || self.share.is_some() || self.unloads.is_some()
    }
}

struct ActuatorSpecFile;

impl<'de> Visitor<'de> for ActuatorSpecFile {
    type Value = AssignedActuator;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an actuator")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<AssignedActuator, E> {
        if name == IDEAL {
            return Ok(AssignedActuator::default());
        }
        ActuatorKind::deserialize(StrDeserializer::new(name)).map(AssignedActuator::from)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<AssignedActuator, A::Error> {
        let mut keys = ActuatorEntry::deserialize(MapAccessDeserializer::new(map))?;
        let mut kinds = keys.kinds();
        let accepted: Vec<_> = kinds.iter().map(|kind| format!("`{}`", kind.kind())).collect();
        let why = match (kinds.pop(), kinds.is_empty()) {
            (Some(kind), true) => {
                return Ok(AssignedActuator {
                    kind,
                    axes: keys.axes,
                    share: keys.share,
                    unloads: keys.unloads,
                });
            }
            (None, _) => {
                format!("needed here, and none is given: {}", ActuatorEntry::NAMES.trim_end_matches(", "))
            }
            (Some(_), false) => {
                let accepted = accepted.join(", ");
                format!(
                    "accepted here, and more than one is given: {accepted}; several are a list, [[actuator]]"
                )
            }
        };
        Err(A::Error::custom(format!("exactly one kind is {why}")))
    }
}

impl<'de> Deserialize<'de> for AssignedActuator {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ActuatorSpecFile)
    }
}

impl Serialize for AssignedActuator {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.kind {
            _ if self.has_task() => ActuatorEntry::from_assignment(self).serialize(serializer),
            ActuatorKind::Ideal(ideal) if ideal.faults.is_empty() => serializer.serialize_str(IDEAL),
            kind => kind.serialize(serializer),
        }
    }
}

impl JsonSchema for AssignedActuator {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "AssignedActuator".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let kind = generator.subschema_for::<ActuatorKind>();
        let keys = generator.subschema_for::<ActuatorEntry>();
        let word = json_schema!({ "const": IDEAL, "description": "The command itself, at every instant." });
        json_schema!({ "anyOf": [kind, keys, word] })
    }
}
