//! The figures that the commands of a page draw.

use std::io::Cursor;

use flexsc_core::SimulationError;
use flexsc_core::campaign::Campaign;
use flexsc_core::record::{Detail, Log, McapLog, RunEnd};

use super::command::Command;
use crate::failure::Failure;
use crate::figure::{Figure, Named};
use crate::stop::Stop;
use crate::{Verb, plot, simulate};

impl Command {
    /// The figure that the command draws, of a simulation that of its log; and the command as a user gives it.
    pub fn draw(&self, what: &str) -> Result<(Figure, String), Failure> {
        if let Verb::Simulate(args) = &self.verb {
            return self.plot(args, what);
        }
        let ends = |(name, _): &Named| name.ends_with(&format!("-{what}")) || name == what;
        let figure = self.results()?.figures().into_iter().find(ends);
        let (_, figure) = figure.ok_or_else(|| self.failure(&format!("no figure `{what}`")))?;
        Ok((figure, format!("{} --figures DIR", self.text)))
    }

    /// A figure of a run's log, with the motion of a planar body by running it again, as `flexsc plot` does.
    fn plot(&self, args: &simulate::Args, what: &str) -> Result<(Figure, String), Failure> {
        let (scenario, path) = self.simulated(args)?;
        let spatial = scenario.spatial.is_some();
        let (detail, option) = if spatial { (Detail::Full, " --log full") } else { (Detail::Events, "") };
        let figure = plot::figure_of(&self.log(detail)?, path, what)?;
        let (text, name) = (&self.text, &scenario.name);
        Ok((figure, format!("{text}{option}; flexsc plot {name}.mcap --what {what}")))
    }

    /// The log of a simulation in this detail.
    pub fn log(&self, detail: Detail) -> Result<Log, Failure> {
        let Verb::Simulate(args) = &self.verb else { return Err(self.failure("no simulation")) };
        let (scenario, path) = self.simulated(args)?;
        let run = simulate::itself(&Campaign::new(scenario, &path.to_string_lossy(), None)?);
        let failed = |source| Failure::Run { name: run.scenario.name.clone(), source };
        let logged = || -> Result<Vec<u8>, SimulationError> {
            let provenance = Campaign::provenance(&run);
            let mut log = McapLog::new(Cursor::new(Vec::new()), &provenance, detail)?;
            let metrics = Campaign::simulate(&run, (&mut log, Stop))?;
            Ok(log.finish(&metrics.to_row(), RunEnd::Complete)?.into_inner())
        };
        Ok(Log::read(path, logged().map_err(failed)?)?)
    }
}
