//! Runs with commands from outside, repeated: what was commanded, and when, is all that they have beyond their scenario.

use std::fmt::Write;

use super::{Campaign, CampaignRun};
use crate::law::Command;
use crate::metrics::{Gather, Metrics};
use crate::record::{Attachment, COMMANDS, Detail, Provenance, Record};
use crate::sim::{Simulation, SimulationError};
use crate::time::Instant;

const HEADER: &str = "time_whole_s,time_fs,x,y,z";

/// Commands about each axis ([`Command::Torque`]), and the instants at which they were given, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Commanded(Vec<(Instant, [f64; 3])>);

impl Commanded {
    /// A command is given now; one given at the same instant before was never executed.
    pub fn push(&mut self, now: Instant, values: [f64; 3]) {
        match self.0.last_mut() {
            Some((at, last)) if *at == now => *last = values,
            _ => self.0.push((now, values)),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Runs to an instant, everything that is due then included, with the commands given on the way.
    ///
    /// # Errors
    /// As a run.
    pub fn run_until(
        &self,
        simulation: &mut Simulation,
        until: Instant,
        record: &mut impl Record,
    ) -> Result<(), SimulationError> {
        for (at, values) in self.0.iter().take_while(|(at, _)| *at <= until) {
            simulation.run_up_to(*at, record)?;
            simulation.steer(values.map(Command::Torque));
        }
        simulation.run_until(until, record)
    }

    /// Repeats a run up to an instant, or to its end if that is earlier: the metrics are those of what has been. It is
    /// the same run, whichever pieces it was advanced in.
    ///
    /// # Errors
    /// As a run.
    pub fn simulate(
        &self,
        run: &CampaignRun,
        until: Instant,
        record: impl Record,
    ) -> Result<Metrics, SimulationError> {
        // A run that is left is judged as one that ends there.
        let end = Instant::START + run.scenario.duration;
        let left = (until < end).then(|| {
            let mut left = run.scenario.clone();
            left.written.duration = until.since(Instant::START);
            left
        });
        let judged = left.as_ref().unwrap_or(&run.scenario);
        let mut both = (Gather::new(judged), record);
        let mut simulation = Simulation::new(&run.scenario, run.number);
        if both.scene() {
            simulation.draw(&run.scenario);
        }
        self.run_until(&mut simulation, until, &mut both)?;
        simulation.leave(&mut both)?;
        Ok(both.0.finish(judged))
    }

    /// Repeats a run, and tells its motion at times (s) that grow.
    ///
    /// # Errors
    /// As a run.
    pub fn sample(
        &self,
        run: &CampaignRun,
        times: &[f64],
        stop: &mut impl Record,
        seen: &mut impl Record,
    ) -> Result<(), SimulationError> {
        let mut simulation = Simulation::new(&run.scenario, run.number);
        let mut given = self.0.iter().peekable();
        for time in times {
            while let Some((at, values)) = given.next_if(|(at, _)| at.seconds() <= *time) {
                simulation.run_up_to(*at, stop)?;
                simulation.steer(values.map(Command::Torque));
            }
            simulation.run_to(*time, stop)?;
            simulation.tell_now(seen)?;
        }
        Ok(())
    }

    /// The provenance in the log of the run: with commands, it has them too.
    pub fn provenance(&self, run: &CampaignRun, detail: Detail) -> Provenance {
        let mut provenance = Campaign::provenance(run, detail);
        if !self.is_empty() {
            let data = self.to_csv().into_bytes();
            provenance.attachments.push(Attachment { name: COMMANDS, media_type: "text/csv", data });
        }
        provenance
    }

    /// As text: whole seconds, femtoseconds past them, and the values about x, y and z.
    pub fn to_csv(&self) -> String {
        let mut text = format!("{HEADER}\n");
        for (at, [x, y, z]) in &self.0 {
            let (whole, part) = at.parts();
            // A string takes everything.
            let _ = writeln!(text, "{whole},{part},{x:?},{y:?},{z:?}");
        }
        text
    }

    /// From text; nothing if it is none of [`Self::to_csv`].
    pub fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        if lines.next()? != HEADER {
            return None;
        }
        let mut all = Self::default();
        for line in lines {
            let mut cells = line.split(',');
            let mut whole = || cells.next()?.parse::<u64>().ok();
            let (seconds, part) = (whole()?, whole()?);
            let mut values = [0.0; 3];
            for value in &mut values {
                *value = cells.next()?.parse().ok().filter(|value: &f64| value.is_finite())?;
            }
            let at = Instant::of_parts(seconds, part);
            let is_instant = seconds < 1 << 60 && part < 1_000_000_000_000_000;
            let is_later = all.0.last().is_none_or(|(last, _)| *last < at);
            if !is_instant || !is_later || cells.next().is_some() {
                return None;
            }
            all.0.push((at, values));
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;
    use crate::time::Span;

    const TEXT: &str = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0";

    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    fn given() -> Commanded {
        let mut given = Commanded::default();
        given.push(at(1.0), [9.0, 0.0, 0.0]);
        // One that was never executed is not kept.
        given.push(at(1.0), [0.5, 0.0, 0.0]);
        given.push(at(3.0), [-0.1, 0.0, 0.0]);
        given
    }

    #[test]
    fn what_is_written_is_read_back() {
        assert_eq!(Commanded::parse(&given().to_csv()), Some(given()));
        assert_eq!(Commanded::parse(&Commanded::default().to_csv()), Some(Commanded::default()));
        for wrong in ["", "1,0,0,0", "1,0,0,0,inf", "2,0,0,0,0\n1,0,0,0,0", "0,1000000000000000,0,0,0"] {
            assert_eq!(Commanded::parse(&format!("{HEADER}\n{wrong}x")), None, "{wrong}");
            assert_eq!(
                Commanded::parse(&format!("{HEADER}\n{wrong}")).is_none(),
                !wrong.is_empty(),
                "{wrong}"
            );
        }
    }

    #[test]
    fn a_repeated_run_moves_as_it_was_commanded() {
        let scenario = Scenario::parse("steered.toml", TEXT).expect("a scenario");
        let mut simulation = Simulation::new(&scenario, 0);
        given().run_until(&mut simulation, at(5.0), &mut ()).expect("a run");
        // 0.5 N m on 2 kg m² for 2 s, then -0.1 N m for 2 s.
        let rate = simulation.state().map(|state| state.rigid_rate);
        assert!((rate.expect("one angle") - 0.4).abs() < 1e-15);
    }
}
