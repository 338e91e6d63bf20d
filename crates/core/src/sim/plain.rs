//! The loop of plain runs: a law that decides at events, about a body in closed form, with nothing beside it but windows of the
//! envelope.
//!
//! It does what the loop of all runs does, in the same order, and leaves out what comes to nothing there.

use super::plant::{Exerted, Plant};
use super::{MOST_DECISIONS, Simulation, SimulationError};
use crate::belief::Belief;
use crate::estimator::Estimator;
use crate::flight::{self, Setup};
use crate::law::{Command, Event};
use crate::record::Record;
use crate::scenario::Scenario;
use crate::time::{Instant, Span};

/// Which quicker loops suit a run.
#[derive(Clone, Debug)]
pub struct Quick {
    /// Whether it is plain.
    plain: bool,
    /// The start of a flight of its own, if it can make one.
    pub flight: Option<Box<Setup>>,
}

impl Quick {
    /// Those that suit runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self { plain: is_plain(scenario), flight: flight::alone(scenario).map(Box::new) }
    }
}

/// Whether runs of a scenario are plain.
fn is_plain(scenario: &Scenario) -> bool {
    let observes = |estimator: &Estimator| estimator.envelope().is_some();
    scenario.is_plain() && !scenario.has_own_parts() && scenario.estimator.as_ref().is_none_or(observes)
}

impl Simulation {
    /// Runs as far as an instant by the quicker loops that suit it, and as they may.
    pub(super) fn run_quickly(
        &mut self,
        until: Instant,
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        self.fly(until, record)?;
        self.run_plainly(until, record)
    }

    /// Runs as far as an instant, as long as nothing is due that is not plain.
    fn run_plainly(&mut self, until: Instant, record: &mut dyn Record) -> Result<(), SimulationError> {
        if !self.goes_plainly() {
            return Ok(());
        }
        let run = self.go_plainly(until, record);
        let rigid = if let Plant::Planar(plant) = &self.plant { plant.state().rigid_rate } else { 0.0 };
        self.drive.command(self.now, self.laws.commands(), &self.beliefs, [rigid, 0.0, 0.0]);
        run
    }

    /// Whether nothing is due that is not plain.
    pub(super) fn goes_plainly(&self) -> bool {
        self.quick.plain
            && self.telling.due().is_none()
            && self.telling.scene.is_none()
            && self.drive.due.is_none()
            && self.sensing.next.is_none()
            && self.next_target.is_none()
            && self.meter.is_none()
            && self.read.is_none()
            && !(self.met || self.steered || self.laws.are_steered())
    }

    fn go_plainly(&mut self, until: Instant, record: &mut dyn Record) -> Result<(), SimulationError> {
        let last = until.min(self.end);
        loop {
            let closes = self.monitor.as_ref().map(|monitor| monitor.closes);
            let trip = self.trip.map(|(at, _)| at);
            let due = [trip, self.laws.until(), closes];
            let next = due.into_iter().flatten().fold(self.end + Span::TICK, Instant::min);
            if next > last {
                return Ok(());
            }
            record.poll()?;
            if next > self.now {
                self.now = next;
                self.decisions = 0;
            }
            let event = match self.trip {
                Some((at, guard)) if at == next => Event::Guard(guard),
                _ => Event::Due { sampled: false },
            };
            if closes == Some(next) {
                self.close_window(record)?;
            }
            if matches!(event, Event::Guard(_)) || self.laws.until() == Some(next) {
                self.decide_plainly(event, record)?;
            }
        }
    }

    fn decide_plainly(&mut self, event: Event, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.decisions += 1;
        if self.decisions > MOST_DECISIONS {
            return Err(SimulationError::Chatter { at: now, count: self.decisions });
        }
        let Plant::Planar(plant) = &mut self.plant else { return Ok(()) };
        let sensed = plant.view(now);
        if !(sensed.angle.is_finite() && sensed.rate.is_finite()) {
            return Err(SimulationError::NonFinite { at: now });
        }
        for Belief { angle, rate, .. } in &mut self.beliefs {
            (*angle, *rate) = (sensed.angle, sensed.rate);
        }
        let before = self.laws.about(0).state();
        let cause = self.ask(event);
        let Command::Torque(torque) = self.laws.commands()[0] else { return Ok(()) };
        let Plant::Planar(plant) = &mut self.plant else { return Ok(()) };
        plant.tell_course(now, &self.exerted, record)?;
        self.exerted = Exerted { constant: torque, feedback: torque, back_emf: (0.0, false) };
        if let Some(monitor) = &mut self.monitor {
            monitor.command(now, plant.state(), torque);
        }
        // As a sum of torques has no negative zero.
        plant.depart_under(0.0 + torque);
        self.seek(record)?;
        self.tell_switching(before, cause, [sensed.angle, sensed.rate], torque, record)
    }

    /// Finds the next trip of the motion that begins.
    pub(super) fn seek(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (guards, now) = (self.laws.guards(), self.now);
        let Plant::Planar(plant) = &mut self.plant else { return Ok(()) };
        self.trip = if guards.is_empty() {
            None
        } else {
            let ends = self.laws.until().map_or(self.end, |until| until.min(self.end));
            plant.trip(guards, ends.since(now), record)?
        };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::record::{Detail, Trace};
    use crate::time::{Instant, Span};
    use crate::{Scenario, Simulation};

    fn shipped(name: &str, changes: &[(&str, &str)]) -> Scenario {
        let path = format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let mut document = crate::Document::load(path.as_ref()).expect("shipped");
        for (key, value) in changes.iter().chain(&[("log.period", "500.0")]) {
            document.set_text(key, value).expect("a key");
        }
        Scenario::from_document(&document).expect("valid")
    }

    /// What a run in pieces tells of its events, and the motion at its end, as text, whose digits are those of all bits.
    fn told(scenario: &Scenario, detail: Detail, pieces: u32) -> String {
        let mut trace = Trace::new(detail);
        let mut simulation = Simulation::new(scenario, 3);
        for piece in 1..=pieces {
            let until = scenario.duration.seconds() * f64::from(piece) / f64::from(pieces);
            simulation.run_until(Instant::START + Span::from_seconds(until), &mut trace).expect("a run");
        }
        let topics = ["/command", "/envelope_mean", "/adaptation"].map(|topic| trace.topic(topic).cloned());
        let sensed = simulation.laws.about(0).state();
        format!("{topics:?} {:?} {sensed:?} {:?}", simulation.state(), simulation.beliefs)
    }

    /// A record of rows at fixed times has the loop of all runs.
    fn compare(scenario: &Scenario, name: &str) {
        let expected = told(scenario, Detail::Full, 1);
        for pieces in [1, 7] {
            assert!(told(scenario, Detail::Events, pieces) == expected, "{name} in {pieces}");
        }
    }

    #[test]
    fn quick_loops_tell_what_the_loop_of_all_runs_tells() {
        for name in ["relay-fixed", "relay-quiet", "relay-adaptive", "relay-no-freeze"] {
            for gain in ["0.3389", "0.31", "0.29", "0.28", "0.4"] {
                let scenario = shipped(name, &[("law.relay.k_t", gain)]);
                assert!(Simulation::new(&scenario, 0).quick.flight.is_some(), "{name}");
                compare(&scenario, name);
            }
        }
    }

    #[test]
    fn so_do_those_of_damped_modes() {
        let one = "[{ frequency = 0.44, gain = 0.0213, damping = 0.01 }]";
        let three = "[{ frequency = 0.44, gain = 0.0213, damping = 0.002, displacement = 2.75e-6 }, \
                     { frequency = 0.755, gain = 0.0216 }, { frequency = 3.4, gain = 0.01, damping = 0.4 }]";
        let other = "{ window = 500.0, modes = [{ frequency = 0.5, gain = 0.02, damping = 0.01 }] }";
        // In a light build, which has no kernels for damped modes, they have the plain loop.
        let flies = cfg!(feature = "damped-flights");
        for name in ["relay-fixed", "relay-adaptive"] {
            for modes in [one, three] {
                let scenario = shipped(name, &[("body.planar.modes", modes)]);
                assert_eq!(Simulation::new(&scenario, 0).quick.flight.is_some(), flies, "{name} {modes}");
                compare(&scenario, &format!("{name} {modes}"));
            }
        }
        let scenario = shipped("relay-fixed", &[("estimator.envelope", other)]);
        assert_eq!(Simulation::new(&scenario, 0).quick.flight.is_some(), flies);
        compare(&scenario, "a model of its own");
    }

    #[test]
    fn so_do_those_that_cannot_fly() {
        let critical = "[{ frequency = 0.44, gain = 0.0213, damping = 1.0 }]";
        let other = "{ window = 500.0, modes = [{ frequency = 0.5, gain = 0.02, damping = 0.01 }] }";
        let damped =
            "[{ frequency = 0.44, gain = 0.0213, damping = 0.01 }, { frequency = 0.755, gain = 0.0 }]";
        for changes in [
            &[("law.relay.sides", "one")][..],
            &[("body.planar.modes", damped)],
            &[("body.planar.modes", damped), ("estimator.envelope.form", "trigonometric")],
            &[("estimator.envelope.form", "truth")],
            &[("body.planar.modes", critical), ("estimator.envelope", other)],
        ] {
            let scenario = shipped("relay-fixed", changes);
            assert!(Simulation::new(&scenario, 0).quick.flight.is_none(), "{changes:?}");
            assert!(Simulation::new(&scenario, 0).quick.plain, "{changes:?}");
            compare(&scenario, &format!("{changes:?}"));
        }
    }
}
