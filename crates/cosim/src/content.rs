//! Content of an FMU: the scenario without references to files, the part of it that the FMU simulates, and the token that
//! joins both to the model description.

use std::fmt::{Display, Write as _};
use std::fs::File;
use std::io::Read;
use std::path::Path;

use flexsc_core::numerics::random::fnv1a_of;
use flexsc_core::{LONGEST, Scenario};

use crate::error::CoSimulationError;
use crate::flight_laws::laws_alone;

/// Name of the scenario among the resources of an FMU.
pub const SCENARIO: &str = "scenario.toml";
/// Name of the file with the simulated part among the resources of an FMU.
pub const PART: &str = "part.txt";

/// Part of a scenario that an FMU simulates.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum FmuPart {
    /// The closed loop: spacecraft, sensors, estimator, laws and actuators.
    Loop,
    /// The spacecraft with its sensors and actuators; the importer commands the torque.
    Plant,
    /// The laws, which decide on estimates and references of the importer.
    Controller,
}

impl FmuPart {
    /// All parts with their names.
    pub const ALL: [(&'static str, Self); 3] =
        [("loop", Self::Loop), ("plant", Self::Plant), ("controller", Self::Controller)];

    /// Returns the name of the part.
    pub fn name(self) -> &'static str {
        match self {
            Self::Loop => "loop",
            Self::Plant => "plant",
            Self::Controller => "controller",
        }
    }

    /// Returns the part of a name.
    ///
    /// # Errors
    /// Fails for any other name.
    pub fn from_name(name: &str) -> Result<Self, CoSimulationError> {
        let found = Self::ALL.into_iter().find(|(own, _)| *own == name);
        found.map(|(_, part)| part).ok_or_else(|| {
            CoSimulationError::refused(format!("part must be `loop`, `plant` or `controller`, got `{name}`"))
        })
    }
}

/// Returns the token of a part of a scenario, as TOML.
pub(crate) fn token_of(part: &str, toml: &str) -> String {
    let part = [env!("CARGO_PKG_VERSION"), part].map(str::as_bytes);
    let mut token = String::from("{");
    for half in ["head", "tail"] {
        let sum = fnv1a_of(&[half.as_bytes(), part[0], part[1], toml.as_bytes()]);
        // Writing to a string cannot fail.
        let _ = write!(token, "{sum:016x}");
    }
    token.push('}');
    token
}

/// Content of an FMU beside the library and the model description.
#[derive(Clone, Debug, PartialEq)]
pub struct FmuContent {
    /// Scenario as TOML, without references to files.
    pub toml: String,
    /// Simulated part.
    pub part: FmuPart,
}

impl FmuContent {
    /// Creates the content for a part of a scenario.
    ///
    /// # Errors
    /// Fails for a scenario with custom parts, which no file can contain, and for laws that cannot run alone.
    pub fn new(scenario: &Scenario, part: FmuPart) -> Result<Self, CoSimulationError> {
        if scenario.has_custom_parts() {
            let roles = scenario.custom_parts().each().join(", ");
            let why = format!("{}: has custom parts ({roles}), which no FMU can contain", scenario.name);
            return Err(CoSimulationError::refused(why));
        }
        if part == FmuPart::Controller {
            laws_alone(scenario)?;
        }
        Ok(Self { toml: scenario.self_contained().to_toml(), part })
    }

    /// Reads the content from the resources of an unpacked FMU.
    ///
    /// # Errors
    /// Fails if a file is missing, too long or no text, and for an unknown part.
    pub fn read(resources: &Path) -> Result<Self, CoSimulationError> {
        let text = |name: &str| {
            let path = resources.join(name);
            let unread = |why: &dyn Display| {
                CoSimulationError::refused(format!("cannot read {}: {why}", path.display()))
            };
            let mut bytes = Vec::new();
            let file = File::open(&path).map_err(|error| unread(&error))?;
            file.take(LONGEST + 1).read_to_end(&mut bytes).map_err(|error| unread(&error))?;
            if bytes.len() as u64 > LONGEST {
                return Err(unread(&"the file is too long"));
            }
            String::from_utf8(bytes).map_err(|error| unread(&error))
        };
        let part = FmuPart::from_name(text(PART)?.trim())?;
        Ok(Self { toml: text(SCENARIO)?, part })
    }

    /// Returns the token of the content, with which an importer instantiates the FMU. It changes with the scenario, the
    /// part and the version of flexsc.
    pub fn token(&self) -> String {
        token_of(self.part.name(), &self.toml)
    }

    /// Returns the scenario.
    ///
    /// # Errors
    /// Fails if the text is no valid scenario.
    pub fn scenario(&self) -> Result<Scenario, CoSimulationError> {
        Ok(Scenario::parse(SCENARIO, &self.toml)?)
    }
}
