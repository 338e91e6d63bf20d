//! Commands that a page names, parsed by the program's own parser.

use std::path::PathBuf;

use clap::Parser;
use flexsc_core::Scenario;

use super::shipped_scenarios;
use crate::error::CliError;
use crate::{Cli, Verb, scenario, simulate};

/// Command on a page, without the program's name: every option is one that the program knows.
pub struct PageCommand {
    /// Text of the command on the page.
    pub text: String,
    /// The verb with its arguments.
    pub verb: Verb,
}

impl PageCommand {
    /// Parses a command.
    pub fn parse(text: &str) -> Result<Self, CliError> {
        let words = std::iter::once("flexsc".to_owned()).chain(words(text));
        let unknown = |error: clap::Error| CliError::Arguments(format!("flexsc {text}: {error}"));
        let Cli { verb } = Cli::try_parse_from(words).map_err(unknown)?;
        Ok(Self { text: text.to_owned(), verb })
    }

    /// Returns the error for a command that cannot be executed here; `why` is the reason.
    pub fn failure(&self, why: &str) -> CliError {
        CliError::Arguments(format!("flexsc {}: {why}", self.text))
    }

    /// Returns the scenario of a simulation, and the path that the command gives it.
    pub fn simulated<'a>(
        &self,
        args: &'a simulate::SimulateArgs,
    ) -> Result<(Scenario, &'a PathBuf), CliError> {
        let [path] = &args.scenarios[..] else { return Err(self.failure("one scenario at a time")) };
        Ok((shipped_scenarios::load(path, &args.set, args.seed)?, path))
    }
}

/// Returns the scenario of an analysis.
pub fn analysed(args: &scenario::ScenarioArgs) -> Result<Scenario, CliError> {
    args.in_mode(shipped_scenarios::load(&args.scenario, &args.set, None)?)
}

/// Splits a command into words as a shell does: at blanks, except within apostrophes.
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
