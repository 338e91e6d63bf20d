//! Runs that the relay kernel simulates from their start: the kernel of batches, with one number in place of the lanes.
//!
//! Results and records are bit-identical to those of the loop, which takes the run over at the last segment start
//! before its end.

use flexsc_control::law::Command;
use flexsc_numerics::time::Instant;
use flexsc_record::{self, PieceDemand, Record, RecordError, Sample, Trigger};

use super::plant::AppliedTorque;
use super::{Simulation, SimulationError};
use crate::relay_setup::{
    CyclePhase, FoundCrossing, LaneHandover, LaneHost, LaneState, RunSetup, SWITCHINGS, apply_crossing,
    apply_state, guards, instant, law_state, run_single, shortest_window,
};

/// Adapter that runs a single simulation through the relay kernel.
struct SingleRunHost<'a> {
    run: &'a mut Simulation,
    record: &'a mut dyn Record,
    setup: RunSetup,
    /// True until the kernel has taken the setup.
    not_started: bool,
    listens: bool,
    /// True if the loop has to continue the run; `failed` is the error that ends it.
    handover: bool,
    failed: Option<SimulationError>,
    rest: LaneHandover,
}

impl Simulation {
    /// Runs in the kernel from the start up to `until`, or to the last segment start before it, if this run can.
    pub(super) fn run_in_kernel(
        &mut self,
        until: Instant,
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        let band = match record.piece_demand() {
            PieceDemand::None => f64::INFINITY,
            PieceDemand::Beyond(band) if band > 0.0 => band,
            PieceDemand::Beyond(_) | PieceDemand::All => return Ok(()),
        };
        if !self.clock.is_at_start() || !self.runs_uninterrupted() {
            return Ok(());
        }
        let Some(setup) = self.kernel_setup.take() else { return Ok(()) };
        let setup = RunSetup { end: until.parts(), band, ..*setup };
        let listens = record.wants_switchings();
        let (failed, rest) = (None, LaneHandover::default());
        let mut host = SingleRunHost {
            run: self,
            record,
            setup,
            not_started: true,
            listens,
            handover: false,
            failed,
            rest,
        };
        run_single(host.setup.structure, &mut host);
        let SingleRunHost { failed, rest, .. } = host;
        self.take_over(&rest, record)?;
        failed.map_or(Ok(()), Err)
    }

    /// Returns true if nothing is due on the way but the law's switchings and windows, and nothing commands the run
    /// from outside.
    fn runs_uninterrupted(&self) -> bool {
        self.recorder.is_idle()
            && self.loads.due.is_none()
            && self.sensors.is_continuous()
            && self.estimation.origin_is_fixed()
            && self.laws.objective.is_none()
            && !(self.clock.has_bearing_event()
                || self.laws.external_command_pending
                || self.laws.is_external())
    }

    /// Continues the run in the loop from the segment start at which the kernel stopped.
    fn take_over(&mut self, rest: &LaneHandover, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (Some(place), now) = (rest.phase, instant(rest.from.time)) else { return Ok(()) };
        if now == Instant::START {
            return Ok(());
        }
        self.clock.take_over(now, rest.switched.0, instant(rest.switched.1));
        self.laws.begin(law_state(place, rest.from.side), now, instant(rest.push_start));
        let Command::Torque(torque) = self.laws.outputs()[0] else { return Ok(()) };
        self.begin_relay_segment(&rest.from, torque);
        let Some(flow) = self.plant.one_axis() else { return Ok(()) };
        let (sensed, rigid) = (flow.view(now), flow.state().rigid_rate);
        for state_estimate in &mut self.estimation.estimates {
            (state_estimate.angle, state_estimate.rate) = (sensed.angle, sensed.rate);
        }
        self.loads.command(now, self.laws.outputs(), &self.estimation.estimates, [rigid, 0.0, 0.0]);
        if let Some(monitor) = &mut self.estimation.monitor {
            monitor.take_over(instant(rest.integrated_to), rest.integral, &rest.tracks);
        }
        self.find_crossing(record)
    }

    /// Begins a motion segment from the kernel's state `from`, under a constant torque (N m).
    fn begin_relay_segment(&mut self, from: &LaneState, torque: f64) {
        self.loads.applied = AppliedTorque { constant: torque, feedback: torque, back_emf: (0.0, false) };
        if let Some(flow) = self.plant.one_axis() {
            flow.set_state(instant(from.time), |state| apply_state(state, from));
            flow.begin_under_torque(0.0 + torque);
        }
    }
}

impl SingleRunHost<'_> {
    /// Stores the first error that ends the run.
    fn keep_error<E: Into<SimulationError>>(&mut self, result: Result<(), E>) {
        if let Err(error) = result {
            self.failed.get_or_insert(error.into());
        }
    }

    fn record_state(&mut self, to: CyclePhase, now: &LaneState) -> Result<(), RecordError> {
        self.record.poll()?;
        let at = instant(now.time);
        let Some(flow) = self.run.plant.one_axis() else { return Ok(()) };
        flow.set_state(at, |state| apply_state(state, now));
        let sensed = flow.view(at);
        let (time_s, time_whole_s, time_fs) = flexsc_record::Command::times(at);
        let command = flexsc_record::Command {
            time_s,
            time_whole_s,
            time_fs,
            state: law_state(to, now.side),
            cause: if to == CyclePhase::Coast { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: self.setup.torque(to, now.side),
            angle_rad: sensed.angle,
            rate_rad_s: sensed.rate,
            gain: now.gain,
        };
        self.record.record(at, Sample::Switching(&command, flow.state()))
    }
}

impl LaneHost for SingleRunHost<'_> {
    fn wants_switchings(&self) -> bool {
        self.listens
    }

    fn wants_band_exits(&self) -> bool {
        self.setup.band.is_finite()
    }

    fn next_run(&mut self, lane: usize) -> Option<&RunSetup> {
        (lane == 0 && std::mem::take(&mut self.not_started)).then_some(&self.setup)
    }

    fn find_crossing(
        &mut self,
        _: usize,
        place: CyclePhase,
        from: &LaneState,
        found: &mut FoundCrossing,
    ) -> bool {
        self.run.begin_relay_segment(from, self.setup.torque(place, from.side));
        let horizon = instant(self.setup.end).since(instant(from.time));
        let guards = guards(&self.setup, place, from.side);
        let Some(flow) = self.run.plant.one_axis() else { return false };
        match flow.first_trip(&guards, horizon, &mut self.record) {
            Ok(Some((at, guard))) => {
                flow.view(at);
                apply_crossing(found, at.since(instant(from.time)), guard == 0, flow.state());
                true
            }
            Ok(None) => false,
            Err(error) => {
                self.keep_error(Err(error));
                false
            }
        }
    }

    fn reject(&mut self, _: usize) {
        self.handover = true;
    }

    fn chatters(&mut self, _: usize, at: (u64, u64)) {
        let span =
            shortest_window(self.setup.modes.iter().map(|[frequency, ..]| *frequency).fold(0.0, f64::max));
        self.failed.get_or_insert(SimulationError::LawChatter { at: instant(at), count: SWITCHINGS, span });
    }

    fn on_switching(&mut self, _: usize, to: CyclePhase, now: &LaneState) {
        let reported = self.record_state(to, now);
        self.keep_error(reported);
    }

    fn on_window(&mut self, _: usize, at: (u64, u64), integral: f64, gain: f64) -> f64 {
        let (now, run) = (instant(at), &mut *self.run);
        let Some(monitor) = &mut run.estimation.monitor else { return gain };
        let closed = monitor.close_with(now, integral, gain);
        let learned = closed.step.as_ref().map(|(row, _)| row.gain);
        if let (Some(learned), Some(search)) = (learned, monitor.search()) {
            run.laws.tune(search.parameter().0, learned);
        }
        let reported = run.recorder.record_envelope_window(now, Some(&closed), &mut self.record);
        self.keep_error(reported);
        learned.unwrap_or(gain)
    }

    fn on_possible_band_exit(&mut self, _: usize, place: CyclePhase, from: &LaneState, until: (u64, u64)) {
        self.run.begin_relay_segment(from, self.setup.torque(place, from.side));
        let Simulation { plant, loads, .. } = &*self.run;
        let reported = plant.record_pieces(instant(until), &loads.applied, &mut self.record);
        self.keep_error(reported);
    }

    fn should_stop(&self) -> bool {
        self.handover || self.failed.is_some()
    }

    fn hand_over(&mut self, rest: LaneHandover) {
        self.rest = rest;
    }
}

#[cfg(test)]
mod tests {
    use flexsc_scenario::Scenario;

    use crate::Simulation;
    use flexsc_numerics::time::{Instant, Span};
    use flexsc_record::{Detail, Trace};

    fn shipped(name: &str, changes: &[(&str, &str)]) -> Scenario {
        let path = format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let mut document = flexsc_formats::document::Document::load(path.as_ref()).expect("shipped");
        for (key, value) in changes.iter().chain(&[("log.period", "500.0")]) {
            document.set_text(key, value).expect("a key");
        }
        Scenario::from_document(&document).expect("valid")
    }

    /// Returns the events of a run that is stopped after each of `pieces` equal parts, and the motion at its end, as
    /// text with all digits.
    fn after_record(scenario: &Scenario, detail: Detail, pieces: u32) -> String {
        let mut trace = Trace::new(detail);
        let mut simulation = Simulation::new(scenario, 3);
        for piece in 1..=pieces {
            let until = scenario.duration.seconds() * f64::from(piece) / f64::from(pieces);
            simulation.run_until(Instant::START + Span::from_seconds(until), &mut trace).expect("a run");
        }
        let topics = ["/command", "/envelope_mean", "/adaptation"].map(|topic| trace.topic(topic).cloned());
        let sensed = simulation.laws.phase();
        format!("{topics:?} {:?} {sensed:?} {:?}", simulation.state(), simulation.estimation.estimates)
    }

    /// Compares event records, which use the kernel, with full records, whose rows at fixed times need the loop from
    /// the start on.
    fn compare(scenario: &Scenario, name: &str) {
        let expected = after_record(scenario, Detail::Full, 1);
        for pieces in [1, 7] {
            assert!(after_record(scenario, Detail::Events, pieces) == expected, "{name} in {pieces}");
        }
    }

    #[test]
    fn kernel_and_loop_record_the_same_rows() {
        for name in ["relay-fixed", "relay-quiet", "relay-adaptive", "relay-no-freeze"] {
            for gain in ["0.3389", "0.31", "0.29", "0.28", "0.4"] {
                let scenario = shipped(name, &[("law.relay.k_t", gain)]);
                assert!(Simulation::new(&scenario, 0).kernel_setup.is_some(), "{name}");
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
                assert_eq!(Simulation::new(&scenario, 0).kernel_setup.is_some(), flies, "{name} {modes}");
                compare(&scenario, &format!("{name} {modes}"));
            }
        }
        let scenario = shipped("relay-fixed", &[("estimator.envelope", other)]);
        assert_eq!(Simulation::new(&scenario, 0).kernel_setup.is_some(), flies);
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
            assert!(Simulation::new(&scenario, 0).kernel_setup.is_none(), "{changes:?}");
            compare(&scenario, &format!("{changes:?}"));
        }
    }
}
