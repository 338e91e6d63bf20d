//! The figures that the commands of a page draw.

use flexsc_core::record::Detail;

use super::analysis::Tuned;
use super::command::Command;
use crate::failure::Failure;
use crate::figure::Figure;
use crate::{damping, map, observer, plan, plot, tune};

/// A figure with its name.
type Named = (String, Figure);

impl Command {
    /// The figure that the command draws, of a simulation that of its log; and the command as a user gives it.
    pub fn draw(&self, what: &str) -> Result<(Figure, String), Failure> {
        let drawn = match self.verb.as_str() {
            "simulate" => return self.plot(what),
            "plan" => self.plan_figures()?,
            "tune" => self.tune_figures()?,
            "map" => self.map_figure()?,
            "damping" => self.damping_figure()?,
            "observer" => {
                let (of, kappas) = self.observer()?;
                vec![("observer".to_owned(), observer::figure(&of, &kappas, of.margin()))]
            }
            _ => return Err(self.failure("no verb that draws")),
        };
        let ends = |(name, _): &Named| name.ends_with(&format!("-{what}")) || name == what;
        drawn.into_iter().find(ends).ok_or_else(|| self.failure(what)).map(|(_, figure)| {
            let shown = format!("{} --figures DIR", self.text);
            (figure, shown)
        })
    }

    /// A figure of a run's log, with the motion of a planar body by running it again, as `flexsc plot` does.
    fn plot(&self, what: &str) -> Result<(Figure, String), Failure> {
        let scenario = self.scenario()?;
        let spatial = scenario.spatial.is_some();
        let (detail, option) = if spatial { (Detail::Full, " --log full") } else { (Detail::Events, "") };
        let figure = plot::figure_of(&self.log(detail)?, &self.path("scenarios"), what)?;
        let (text, name) = (&self.text, &scenario.name);
        Ok((figure, format!("{text}{option}; flexsc plot {name}.mcap --what {what}")))
    }

    fn plan_figures(&self) -> Result<Vec<Named>, Failure> {
        let scenario = self.scenario()?;
        let (manoeuvre, plan) = self.planned(&scenario)?;
        let (body, shown) = (scenario.one_angle()?, scenario.model.outputs.len());
        let family = plan::Family::new(&scenario.name, body, &plan, manoeuvre, scenario.planned_for(), shown);
        Ok(plan::figures(&family, self.one("band").unwrap_or(0.1)))
    }

    fn tune_figures(&self) -> Result<Vec<Named>, Failure> {
        let scenario = self.scenario()?;
        let Tuned { gains, limit, regions, robust } = self.tuned(&scenario)?;
        let (_, law) = tune::sampled(&scenario)?;
        let off = self.one("robust").unwrap_or(0.0);
        let robust = robust.as_deref().map(|robust| (robust, off));
        let (name, own) = (&scenario.name, law.extra.as_ref());
        Ok(tune::figures(&tune::Tuned { name, own, gains, limit, regions: &regions, robust }))
    }

    fn map_figure(&self) -> Result<Vec<Named>, Failure> {
        let scenario = self.scenario()?;
        let (of, _) = tune::sampled(&scenario)?;
        let figure = map::figure(&scenario.name, &self.cells(&scenario)?, (of.frequency(), of.period));
        Ok(vec![("map".to_owned(), figure)])
    }

    fn damping_figure(&self) -> Result<Vec<Named>, Failure> {
        let (study, frequencies) = self.relay()?;
        let figure = damping::figure(&study.table(&frequencies), study.relay.frequency_limit());
        Ok(vec![("damping".to_owned(), figure)])
    }
}
