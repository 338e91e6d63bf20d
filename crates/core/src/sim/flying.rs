//! Runs that the relay kernel simulates from their start: the kernel of batches, with one number in place of the lanes.
//!
//! Results and records are bit-identical to those of the loop, which takes the run over at the last segment start
//! before its end.

use super::plant::{Exerted, Plant};
use super::{Simulation, SimulationError};
use crate::flight::{
    Crew, CyclePlace, LaneRest, LaneSight, SWITCHINGS, Searched, Setup, fly_alone, guards, instant, phase,
    searched, see, shortest_window,
};
use crate::law::Command;
use crate::record::{self, Course, Record, RecordError, Sample, Trigger};
use crate::time::Instant;

/// Adapter that runs a single simulation through the relay kernel.
struct Alone<'a> {
    run: &'a mut Simulation,
    record: &'a mut dyn Record,
    setup: Setup,
    /// True until the kernel has taken the setup.
    waits: bool,
    listens: bool,
    /// True if the loop has to continue the run; `failed` is the error that ends it.
    stopped: bool,
    failed: Option<SimulationError>,
    rest: LaneRest,
}

impl Simulation {
    /// Runs in the kernel from the start up to `until`, or to the last segment start before it, if this run can.
    pub(super) fn fly(&mut self, until: Instant, record: &mut dyn Record) -> Result<(), SimulationError> {
        let band = match record.course() {
            Course::None => f64::INFINITY,
            Course::Beyond(band) if band > 0.0 => band,
            Course::Beyond(_) | Course::All => return Ok(()),
        };
        if self.now != Instant::START || self.decisions > 0 || !self.is_left_alone() {
            return Ok(());
        }
        let Some(setup) = self.flight.take() else { return Ok(()) };
        let setup = Setup { end: until.parts(), band, ..*setup };
        let listens = record.switchings();
        let (failed, rest) = (None, LaneRest::default());
        let mut crew = Alone { run: self, record, setup, waits: true, listens, stopped: false, failed, rest };
        fly_alone(crew.setup.structure, &mut crew);
        let Alone { failed, rest, .. } = crew;
        self.land(&rest, record)?;
        failed.map_or(Ok(()), Err)
    }

    /// Returns true if nothing is due on the way but the law's switchings and windows, and nothing commands the run
    /// from outside.
    fn is_left_alone(&self) -> bool {
        self.telling.due().is_none()
            && self.telling.scene.is_none()
            && self.drive.due.is_none()
            && self.sensing.next.is_none()
            && self.next_target.is_none()
            && self.meter.is_none()
            && self.read.is_none()
            && !(self.met || self.steered || self.laws.are_steered())
    }

    /// Continues the run in the loop from the segment start at which the kernel stopped.
    fn land(&mut self, rest: &LaneRest, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (Some(place), now) = (rest.place, instant(rest.from.at)) else { return Ok(()) };
        if now == Instant::START {
            return Ok(());
        }
        (self.now, self.decisions) = (now, 1);
        self.switchings = (rest.switched.0, instant(rest.switched.1));
        self.laws.begin(phase(place, rest.from.side), now, instant(rest.pushed));
        let Command::Torque(torque) = self.laws.commands()[0] else { return Ok(()) };
        self.set_off(&rest.from, torque);
        let Plant::Planar(plant) = &mut self.plant else { return Ok(()) };
        let (sensed, rigid) = (plant.view(now), plant.state().rigid_rate);
        for belief in &mut self.beliefs {
            (belief.angle, belief.rate) = (sensed.angle, sensed.rate);
        }
        self.drive.command(now, self.laws.commands(), &self.beliefs, [rigid, 0.0, 0.0]);
        if let Some(monitor) = &mut self.monitor {
            monitor.take_over(instant(rest.seen), rest.integral, &rest.tracks);
        }
        self.seek(record)
    }

    /// Begins a motion segment from the kernel's state `from`, under a constant torque (N m).
    fn set_off(&mut self, from: &LaneSight, torque: f64) {
        self.exerted = Exerted { constant: torque, feedback: torque, back_emf: (0.0, false) };
        if let Plant::Planar(plant) = &mut self.plant {
            plant.put(instant(from.at), |state| see(state, from));
            plant.depart_under(0.0 + torque);
        }
    }
}

impl Alone<'_> {
    /// Stores the first error that ends the run.
    fn keep<E: Into<SimulationError>>(&mut self, result: Result<(), E>) {
        if let Err(error) = result {
            self.failed.get_or_insert(error.into());
        }
    }

    fn tell(&mut self, to: CyclePlace, now: &LaneSight) -> Result<(), RecordError> {
        self.record.poll()?;
        let at = instant(now.at);
        let Plant::Planar(plant) = &mut self.run.plant else { return Ok(()) };
        plant.put(at, |state| see(state, now));
        let sensed = plant.view(at);
        let (time_s, time_whole_s, time_fs) = record::Command::times(at);
        let command = record::Command {
            time_s,
            time_whole_s,
            time_fs,
            state: phase(to, now.side),
            cause: if to == CyclePlace::Coast { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: self.setup.torque(to, now.side),
            angle_rad: sensed.angle,
            rate_rad_s: sensed.rate,
            gain: now.gain,
        };
        self.record.record(at, Sample::Switching(&command, plant.state()))
    }
}

impl Crew for Alone<'_> {
    fn listens(&self) -> bool {
        self.listens
    }

    fn looks(&self) -> bool {
        self.setup.band.is_finite()
    }

    fn next(&mut self, lane: usize) -> Option<&Setup> {
        (lane == 0 && std::mem::take(&mut self.waits)).then_some(&self.setup)
    }

    fn search(&mut self, _: usize, place: CyclePlace, from: &LaneSight, found: &mut Searched) -> bool {
        self.run.set_off(from, self.setup.torque(place, from.side));
        let horizon = instant(self.setup.end).since(instant(from.at));
        let guards = guards(&self.setup, place, from.side);
        let Plant::Planar(plant) = &mut self.run.plant else { return false };
        match plant.trip(&guards, horizon, &mut self.record) {
            Ok(Some((at, guard))) => {
                plant.view(at);
                searched(found, at.since(instant(from.at)), guard == 0, plant.state());
                true
            }
            Ok(None) => false,
            Err(error) => {
                self.keep(Err(error));
                false
            }
        }
    }

    fn give_up(&mut self, _: usize) {
        self.stopped = true;
    }

    fn chatters(&mut self, _: usize, at: (u64, u64)) {
        let span =
            shortest_window(self.setup.modes.iter().map(|[frequency, ..]| *frequency).fold(0.0, f64::max));
        self.failed.get_or_insert(SimulationError::LawChatter { at: instant(at), count: SWITCHINGS, span });
    }

    fn switched(&mut self, _: usize, to: CyclePlace, now: &LaneSight) {
        let told = self.tell(to, now);
        self.keep(told);
    }

    fn closed(&mut self, _: usize, at: (u64, u64), integral: f64, gain: f64) -> f64 {
        let (now, run) = (instant(at), &mut *self.run);
        let Some(monitor) = &mut run.monitor else { return gain };
        let closed = monitor.conclude(now, integral, gain);
        let learned = closed.step.as_ref().map(|(row, _)| row.gain);
        if let (Some(learned), Some(search)) = (learned, monitor.search()) {
            run.laws.tune(search.tunes().0, learned);
        }
        let told = run.telling.window(now, &closed, &mut self.record);
        self.keep(told);
        learned.unwrap_or(gain)
    }

    fn strays(&mut self, _: usize, place: CyclePlace, from: &LaneSight, until: (u64, u64)) {
        self.run.set_off(from, self.setup.torque(place, from.side));
        let Plant::Planar(plant) = &self.run.plant else { return };
        let told = plant.tell_course(instant(until), &self.run.exerted, &mut self.record);
        self.keep(told);
    }

    fn stops(&self) -> bool {
        self.stopped || self.failed.is_some()
    }

    fn take_back(&mut self, rest: LaneRest) {
        self.rest = rest;
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

    /// Returns the events of a run that is stopped after each of `pieces` equal parts, and the motion at its end, as
    /// text with all digits.
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

    /// Compares event records, which use the kernel, with full records, whose rows at fixed times need the loop from
    /// the start on.
    fn compare(scenario: &Scenario, name: &str) {
        let expected = told(scenario, Detail::Full, 1);
        for pieces in [1, 7] {
            assert!(told(scenario, Detail::Events, pieces) == expected, "{name} in {pieces}");
        }
    }

    #[test]
    fn flights_tell_what_the_loop_tells() {
        for name in ["relay-fixed", "relay-quiet", "relay-adaptive", "relay-no-freeze"] {
            for gain in ["0.3389", "0.31", "0.29", "0.28", "0.4"] {
                let scenario = shipped(name, &[("law.relay.k_t", gain)]);
                assert!(Simulation::new(&scenario, 0).flight.is_some(), "{name}");
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
        // Without the feature `damped-flights`, there are no kernels for damped modes.
        let flies = cfg!(feature = "damped-flights");
        for name in ["relay-fixed", "relay-adaptive"] {
            for modes in [one, three] {
                let scenario = shipped(name, &[("body.planar.modes", modes)]);
                assert_eq!(Simulation::new(&scenario, 0).flight.is_some(), flies, "{name} {modes}");
                compare(&scenario, &format!("{name} {modes}"));
            }
        }
        let scenario = shipped("relay-fixed", &[("estimator.envelope", other)]);
        assert_eq!(Simulation::new(&scenario, 0).flight.is_some(), flies);
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
            assert!(Simulation::new(&scenario, 0).flight.is_none(), "{changes:?}");
            compare(&scenario, &format!("{changes:?}"));
        }
    }
}
