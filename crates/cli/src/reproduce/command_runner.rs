//! Execution of the commands of a page within the program itself.

use flexsc_core::record::Detail;
use flexsc_figure::Figure;
use flexsc_papers::Laboratory;
use serde_json::Value as Json;

use super::command::PageCommand;
use crate::error::CliError;

/// Laboratory that executes commands by this program.
pub struct CommandRunner;

impl Laboratory for CommandRunner {
    fn run(&self, command: &str) -> Result<Json, String> {
        message(PageCommand::parse(command).and_then(|command| command.output_of()))
    }

    fn column(&self, command: &str, topic: &str, name: &str) -> Result<[Vec<f64>; 2], String> {
        let log = message(PageCommand::parse(command).and_then(|command| command.log(Detail::Full)))?;
        let columns = log.columns(topic).map_err(|error| error.to_string())?;
        Ok(["time_s", name].map(|name| columns.numbers(name).map(<[f64]>::to_vec).unwrap_or_default()))
    }

    fn draw(&self, command: &str, kind: &str) -> Result<(Figure, String), String> {
        message(PageCommand::parse(command).and_then(|command| command.draw(kind)))
    }
}

fn message<T>(result: Result<T, CliError>) -> Result<T, String> {
    result.map_err(|failure| failure.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_tells_what_it_prints() {
        let reported =
            CommandRunner.run("simulate scenarios/relay-quiet.toml --set duration=1000.0").expect("a run");
        assert_eq!(reported["pushes_right"], 21);
    }

    #[test]
    fn what_is_not_known_is_an_error() {
        let wrong = [
            ("simulate scenarios/other.toml", "there is no example"),
            ("simulate scenarios/relay-quiet.toml --sets duration=100.0", "--sets"),
            ("simulate scenarios/relay-quiet.toml --set durations=100.0", "durations"),
        ];
        for (command, why) in wrong {
            let error = CommandRunner.run(command).expect_err(command);
            assert!(error.contains(why), "{command}: {error}");
        }
        let drawn = CommandRunner.draw("plan scenarios/rotation-sine.toml", "colour");
        assert!(drawn.is_err_and(|error| error.contains("colour")));
    }
}
