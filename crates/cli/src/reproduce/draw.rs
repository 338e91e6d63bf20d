//! Figures that the commands of a page draw.

use flexsc_core::record::{Detail, Log};
use flexsc_figure::{Figure, Named};

use super::command::PageCommand;
use crate::error::CliError;
use crate::memory_log::logged;
use crate::{Verb, plot, simulate};

impl PageCommand {
    /// Returns the figure that the command draws, for a simulation from its log; and the command as a user would type
    /// it.
    pub fn draw(&self, kind: &str) -> Result<(Figure, String), CliError> {
        if let Verb::Simulate(args) = &self.verb {
            return self.plot(args, kind);
        }
        let ends = |(name, _): &Named| name.ends_with(&format!("-{kind}")) || name == kind;
        let figure = self.results()?.figures().into_iter().find(ends);
        let (_, figure) = figure.ok_or_else(|| self.failure(&format!("no figure `{kind}`")))?;
        Ok((figure, format!("{} --figures DIR", self.text)))
    }

    /// Returns a figure of a run's log of events, for which the run is repeated, as `flexsc plot` does.
    fn plot(&self, args: &simulate::SimulateArgs, kind: &str) -> Result<(Figure, String), CliError> {
        let (scenario, path) = self.simulated(args)?;
        let figure = plot::figure_of(&self.log(Detail::Events)?, path, kind, None)?;
        let (text, name) = (&self.text, &scenario.name);
        Ok((figure, format!("{text} && flexsc plot {name}.mcap --what {kind}")))
    }

    /// Returns the log of a simulation in this detail.
    pub fn log(&self, detail: Detail) -> Result<Log, CliError> {
        let Verb::Simulate(args) = &self.verb else { return Err(self.failure("no simulation")) };
        let (scenario, path) = self.simulated(args)?;
        logged(scenario, path, detail)
    }
}
