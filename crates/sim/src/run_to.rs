//! Access to a run from outside: motion at instants chosen by the caller, between events and exactly at them, its state
//! as a vector, and its parameters.

use flexsc_dynamics::AxisState;
use flexsc_dynamics::flow::ThreeAxisState;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Record;

use super::{QuantityField, Simulation, SimulationError};
use flexsc_scenario::Scenario;

const FEMTOSECONDS: i128 = 1_000_000_000_000_000;

impl Simulation {
    /// Runs to the instant that `seconds` stands for, including everything that is due at that instant.
    ///
    /// A double stands for many femtoseconds. If an event or a row of the scenario's log lies among them, the run stops
    /// there, so that the motion is the row of the log to the bit; otherwise it stops at the nearest femtosecond.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub fn run_to(&mut self, seconds: f64, record: &mut dyn Record) -> Result<(), SimulationError> {
        let named = (Instant::START + Span::from_seconds(seconds)).min(self.clock.end());
        let early = named.before(Span::from_seconds(seconds * f64::EPSILON));
        self.run_until(early.max(self.clock.now()), record)?;
        let mut met = false;
        loop {
            let next = self.next_due();
            if next > self.clock.end() || next.seconds() > seconds {
                break;
            }
            self.run_until(next, record)?;
            met = self.clock.now().seconds() == seconds;
        }
        let row = self.nearest_row_instant(named).min(self.clock.end());
        let is_row = row.seconds() == seconds;
        if (is_row || !met) && self.clock.now() < if is_row { row } else { named } {
            self.run_until(if is_row { row } else { named }, record)?;
        }
        Ok(())
    }

    /// Records the motion at the current instant, and the law's row of a one-axis body, whatever rows the record wants
    /// otherwise.
    ///
    /// # Errors
    /// Fails if the state is no longer finite, a custom part cannot go on or the record cannot be written.
    pub fn record_now(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.plant.evaluate(self.clock.now())?;
        let (run, recorder) = self.view();
        recorder.record_now(&run, record)?;
        self.check_custom_parts()
    }

    /// Returns the state of a one-axis body at the current instant.
    pub fn state(&self) -> Option<&AxisState> {
        self.plant.quantities().one_axis().map(|motion| &motion.body().state)
    }

    /// Returns the state of a three-axis body at the current instant.
    pub fn three_axis_state(&self) -> Option<&ThreeAxisState> {
        self.plant.quantities().three_axis().map(|motion| &motion.body().state)
    }

    /// Returns the mean of the total envelope over the last closed window (rad).
    pub fn window_mean(&self) -> Option<f64> {
        self.estimation.monitor.as_ref().map(|monitor| monitor.mean)
    }

    /// Sets a tunable parameter of the law, such as `k_t`, as an adaptation does.
    pub fn set_parameter(&mut self, key: &str, value: f64) {
        self.laws.tune(key, value);
    }

    /// Returns the fields of the vector of [`Simulation::observe`], in its order, for a run of this scenario.
    pub fn observation_fields(&self, scenario: &Scenario) -> Vec<QuantityField> {
        self.read_view().quantity_fields(scenario, true)
    }

    /// Writes the current state into a vector with the fields of [`Simulation::observation_fields`]. With a sensor that measures at
    /// every instant, measurements and estimates are current too; otherwise they are those of the last sample.
    ///
    /// # Errors
    /// Fails if the state is no longer finite.
    ///
    /// # Panics
    /// Panics if the length of `row` differs from the total width of the fields.
    pub fn observe(&mut self, row: &mut [f64]) -> Result<(), SimulationError> {
        self.plant.evaluate(self.clock.now())?;
        self.read_view().write_observation(row);
        Ok(())
    }

    /// Returns the instant of the dense log's row that is nearest to `at`.
    fn nearest_row_instant(&self, at: Instant) -> Instant {
        let femtoseconds = |instant: Instant| {
            let (whole, part) = instant.parts();
            i128::from(whole) * FEMTOSECONDS + i128::from(part)
        };
        let period = femtoseconds(Instant::START + self.recorder.log_period()).max(1);
        let rows = (femtoseconds(at) + period / 2) / period;
        let nearest = rows * period;
        Instant::from_parts((nearest / FEMTOSECONDS) as u64, (nearest % FEMTOSECONDS) as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_record::{Columns, Detail, Trace};

    const SCENARIOS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios");

    fn columns(trace: &Trace, topic: &str) -> Columns {
        trace.topic(topic).expect("a topic").clone()
    }

    /// Compares rows of a dense log with the motion that a run without a record on the way has at their times, to the
    /// bit.
    fn both(name: &str, duration: f64, topics: &[&str], every: usize) {
        let path = format!("{SCENARIOS}/{name}.toml");
        let mut scenario = Scenario::load(path.as_ref()).expect("a scenario");
        scenario.written.duration = Span::from_seconds(duration);
        let mut whole = Trace::new(Detail::Full);
        Simulation::new(&scenario, 0).run(&mut whole).expect("a run");
        let times: Vec<f64> = whole
            .clone()
            .into_columns()
            .find(|(topic, _)| *topic == topics[0].trim_start_matches('/'))
            .and_then(|(_, columns)| columns.numbers("time_s").map(<[f64]>::to_vec))
            .expect("times");
        let mut seen = Trace::new(Detail::Full);
        let mut simulation = Simulation::new(&scenario, 0);
        let places: Vec<usize> = (0..times.len()).step_by(every).collect();
        for place in &places {
            simulation.run_to(times[*place], &mut ()).expect("a run");
            simulation.record_now(&mut seen).expect("a look");
        }
        for topic in topics {
            let (rows, seen) = (columns(&whole, topic), columns(&seen, topic));
            for (name, _) in &rows.columns {
                let (Some(rows), Some(seen)) = (rows.numbers(name), seen.numbers(name)) else { continue };
                let rows = places.iter().map(|place| rows[*place].to_bits());
                assert!(rows.eq(seen.iter().map(|value| value.to_bits())), "{topic} {name}");
            }
        }
    }

    #[test]
    fn what_is_seen_at_a_row_is_the_row() {
        // Some rows are at switchings, whose times are rounded in a double.
        both("relay-adaptive", 12_000.0, &["/attitude", "/rate", "/modes", "/envelope"], 7);
        both("relay-sampled", 9_200.0, &["/attitude", "/rate"], 13);
        both("rotation-robust", 40.0, &["/attitude", "/goal", "/torque", "/outputs"], 3);
        both("wheel-ekf", 100.0, &["/attitude", "/wheel"], 3);
    }
}
