//! Figures by the names that `--what` accepts: the kinds of figures, and topics of a log.

use std::ffi::OsStr;

use clap::builder::{EnumValueParser, PossibleValue, TypedValueParser};

use super::{FigureKind, requirement};

/// Figure by its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FigureName {
    /// Kind of figure.
    Kind(FigureKind),
    /// Topic of a log, with its leading slash.
    Topic(String),
    /// Figure of one requirement over time, by its identifier or name.
    Requirement(String),
}

/// Prefix of the figure of one requirement.
const OF_REQUIREMENT: &str = "requirement:";

impl FigureName {
    /// Parses a name.
    ///
    /// # Errors
    /// A name that is neither a topic nor a kind.
    pub fn parse(name: &str) -> Result<Self, String> {
        Self::unlisted(name).map_or_else(|| clap::ValueEnum::from_str(name, false).map(Self::Kind), Ok)
    }

    /// Returns the figure of a topic or of one requirement; `None` for the name of a kind.
    fn unlisted(name: &str) -> Option<Self> {
        if name.starts_with('/') {
            return Some(Self::Topic(name.to_owned()));
        }
        name.strip_prefix(OF_REQUIREMENT).map(|own| Self::Requirement(own.to_owned()))
    }

    /// Splits names into kinds and topics.
    pub fn split(names: &[Self]) -> (Vec<FigureKind>, Vec<&str>) {
        let mut kinds = Vec::new();
        let mut topics = Vec::new();
        for name in names {
            match name {
                Self::Kind(kind) => kinds.push(*kind),
                Self::Topic(topic) if !topics.contains(&topic.as_str()) => topics.push(topic.as_str()),
                Self::Topic(_) => {}
                Self::Requirement(_) => kinds.push(FigureKind::Log(&requirement::SPEC)),
            }
        }
        (kinds, topics)
    }
}

/// Parser of figure names, which lists the kinds.
#[derive(Copy, Clone, Debug)]
pub struct FigureNameParser;

impl TypedValueParser for FigureNameParser {
    type Value = FigureName;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<FigureName, clap::Error> {
        match value.to_str().and_then(FigureName::unlisted) {
            Some(name) => Ok(name),
            None => {
                EnumValueParser::<FigureKind>::new().parse_ref(command, argument, value).map(FigureName::Kind)
            }
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let kinds = <FigureKind as clap::ValueEnum>::value_variants();
        Some(Box::new(kinds.iter().filter_map(clap::ValueEnum::to_possible_value)))
    }
}
