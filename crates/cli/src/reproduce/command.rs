//! The commands that a page names, read as the program itself reads them.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory};
use flexsc_core::campaign::Campaign;
use flexsc_core::record::{Detail, Log, McapLog, RunEnd};
use flexsc_core::{Scenario, SimulationError};

use super::shipped;
use crate::Cli;
use crate::failure::Failure;
use crate::stop::Stop;

/// A command as a page names it, without the program's name: every option is one that the program knows.
pub struct Command {
    /// What the page says.
    pub text: String,
    /// The verb.
    pub verb: String,
    matches: ArgMatches,
}

impl Command {
    /// Reads a command.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let words = std::iter::once("flexsc".to_owned()).chain(words(text));
        let unknown = |why: String| Failure::Arguments(format!("flexsc {text}: {why}"));
        let mut all =
            Cli::command().try_get_matches_from(words).map_err(|error| unknown(error.to_string()))?;
        let (verb, matches) = all.remove_subcommand().ok_or_else(|| unknown("no verb".to_owned()))?;
        Ok(Self { text: text.to_owned(), verb, matches })
    }

    /// A run's log of this detail.
    pub fn log(&self, detail: Detail) -> Result<Log, Failure> {
        let run = Campaign::new(self.scenario()?, "", None)?.run(0)?;
        let failed = |source| Failure::Run { name: run.scenario.name.clone(), source };
        let logged = || -> Result<Vec<u8>, SimulationError> {
            let provenance = Campaign::provenance(&run);
            let mut log = McapLog::new(Cursor::new(Vec::new()), &provenance, detail)?;
            let metrics = Campaign::simulate(&run, (&mut log, Stop))?;
            Ok(log.finish(&metrics.to_row(), RunEnd::Complete)?.into_inner())
        };
        Ok(Log::read(&self.path("scenarios"), logged().map_err(failed)?)?)
    }

    /// The scenario with the keys that the command sets.
    pub fn scenario(&self) -> Result<Scenario, Failure> {
        let name = if self.verb == "simulate" { "scenarios" } else { "scenario" };
        let set: Vec<String> =
            self.matches.get_many("set").map(|set| set.cloned().collect()).unwrap_or_default();
        let seed = if matches!(self.verb.as_str(), "simulate" | "sweep") { self.one("seed") } else { None };
        shipped::load(&self.path(name).to_string_lossy(), &set, seed)
    }

    /// The file that an argument names.
    pub fn path(&self, name: &str) -> PathBuf {
        let given = self.matches.get_one::<PathBuf>(name);
        given.map_or_else(|| Path::new("").to_owned(), PathBuf::clone)
    }

    /// The value of an option that the verb may have.
    pub fn one<T: Clone + Send + Sync + 'static>(&self, name: &str) -> Option<T> {
        self.matches.try_get_one::<T>(name).ok().flatten().cloned()
    }

    /// The numbers of an option.
    pub fn many(&self, name: &str) -> Vec<f64> {
        let given = self.matches.try_get_many::<f64>(name).ok().flatten();
        given.map_or_else(Vec::new, |given| given.copied().collect())
    }

    /// Whether the command gives an option.
    pub fn is_given(&self, name: &str) -> bool {
        matches!(self.matches.value_source(name), Some(ValueSource::CommandLine))
    }

    /// The text of an option; empty without it.
    pub fn raw(&self, name: &str) -> String {
        let given = self.matches.get_raw(name).and_then(|mut given| given.next());
        given.map_or_else(String::new, |given| given.to_string_lossy().into_owned())
    }

    /// That the command cannot be executed here.
    pub fn failure(&self, why: &str) -> Failure {
        Failure::Arguments(format!("flexsc {}: {why}", self.text))
    }
}

/// The words of a command as a shell reads them: parted by blanks, but for those between apostrophes.
fn words(text: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    for (index, part) in text.split('\'').enumerate() {
        let quoted = index % 2 == 1;
        for (blank, piece) in part.split(|c: char| !quoted && c.is_whitespace()).enumerate() {
            if blank > 0 {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.push_str(piece);
            }
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_a_shell() {
        let text = "simulate a.toml\n    --set 'x={y = 1}' --set z=2 --set k='a b'c";
        let expected = ["simulate", "a.toml", "--set", "x={y = 1}", "--set", "z=2", "--set", "k=a bc"];
        assert_eq!(words(text), expected);
    }
}
