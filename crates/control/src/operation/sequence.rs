//! Sequence of modes during a run: the supervisor of flight code, and the exact instants of conditions on the truth.

use flexsc_flight::mode_supervisor::{ModeSupervisor, ModeTest, SupervisedExit};
use flexsc_flight_precision::Precision;
use flexsc_numerics::time::{Instant, Span};

use super::condition::{Expression, ModeReadings};
use super::mode_tables::{ModeReading, ModeTables};
use super::quantity::ModeQuantity;

/// Change of the mode.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModeChange {
    /// Index of the mode before; `None` at the start of a run.
    pub from: Option<usize>,
    /// Index of the mode from now on.
    pub to: usize,
    /// Condition that was met, as written; empty at the start.
    pub cause: String,
    /// True if the mode stays, because it has changed too often in the last second.
    pub is_chatter: bool,
}

/// State of the sequence.
#[derive(Clone, Debug)]
pub struct ModeSequence {
    /// Lists of the supervisor; of those that a run changes, the numbers of the run.
    tables: ModeTables,
    supervisor: ModeSupervisor,
    /// For each end, the instants at which quantities of the sky pass numbers of the condition, in order.
    crossings: Vec<Vec<Instant>>,
}

impl ModeSequence {
    /// Creates the sequence at the start of a run, in the first mode; `None` without modes. `crossings` returns the instants at
    /// which a quantity of the sky passes a number.
    pub fn new(
        mut tables: ModeTables,
        crossings: &dyn Fn(ModeQuantity, f64) -> Vec<Instant>,
    ) -> Option<Self> {
        if tables.modes.is_empty() {
            return None;
        }
        let passed = |condition: &Expression| {
            let of_sky = condition.leaves().into_iter().filter(|(quantity, _)| quantity.is_of_sky());
            let mut instants: Vec<Instant> =
                of_sky.flat_map(|(quantity, limit)| crossings(quantity, limit.unwrap_or(f64::NAN))).collect();
            instants.sort_unstable();
            instants
        };
        let crossings = tables.written.iter().map(|exit| passed(&exit.condition)).collect();
        let supervisor = ModeSupervisor::start(Instant::START.ticks(), &mut tables.modes, &mut tables.exits);
        Some(Self { tables, supervisor, crossings })
    }

    /// Returns the index of the active mode.
    pub fn active(&self) -> usize {
        self.supervisor.active
    }

    /// Returns the instant at which the active mode was entered.
    pub fn entered(&self) -> Instant {
        Instant::from_ticks(self.supervisor.entered)
    }

    /// Returns the number of times that a mode was entered, the start included.
    pub fn entries(&self, mode: usize) -> u64 {
        self.tables.modes[mode].entries
    }

    /// Returns the name of a mode.
    pub fn name(&self, mode: usize) -> &str {
        self.tables.names.get(mode).map_or("", String::as_str)
    }

    /// Returns the next instant at which conditions are tested; `None` for a mode without an end.
    pub fn due(&self) -> Option<Instant> {
        let ModeTables { modes, exits, .. } = &self.tables;
        let due = self.supervisor.due(modes, exits);
        let tested = Instant::from_ticks(self.supervisor.tested);
        let exact = self.active_exits().flat_map(|exit| self.exact_instants(exit)).filter(|at| *at > tested);
        exact.chain(due.has_time.then_some(Instant::from_ticks(due.time))).min()
    }

    /// Iterates over the indices of the ends of the active mode.
    fn active_exits(&self) -> std::ops::Range<usize> {
        let mode = self.tables.modes[self.supervisor.active];
        mode.first_exit..mode.first_exit + mode.exit_count
    }

    /// Returns the instants at which the truth may make the condition of an end true or false, of those of the sky the next one
    /// after the last test.
    fn exact_instants(&self, exit: usize) -> impl Iterator<Item = Instant> {
        let (entered, tested) = (self.entered(), Instant::from_ticks(self.supervisor.tested));
        let instant = move |(quantity, limit): (ModeQuantity, Option<f64>)| {
            let origin = if quantity == ModeQuantity::TrueTime { entered } else { Instant::START };
            Some(origin + Span::from_seconds(limit?))
        };
        let is_exact = self.tables.exits.get(exit).is_some_and(|exit| exit.is_exact);
        let written = self.tables.written.get(exit).filter(|_| is_exact);
        // A time is above its limit from the next tick on.
        let leaves = written.map(|exit| exit.condition.leaves()).unwrap_or_default();
        let reads_sky = leaves.iter().any(|(quantity, _)| quantity.is_of_sky());
        let crossings = self.crossings.get(exit).map_or(&[][..], |crossings| crossings);
        let next = crossings.get(crossings.partition_point(|at| *at <= tested)).copied();
        // The sky may meet the condition from the start of the mode on.
        let of_sky = next.into_iter().chain(reads_sky.then_some(entered + Span::TICK));
        let clocks = leaves.into_iter().filter(|(quantity, _)| !quantity.is_of_sky());
        clocks.filter_map(instant).flat_map(|at| [at, at + Span::TICK]).chain(of_sky)
    }

    /// Returns the number of readings of all conditions.
    pub fn reading_count(&self) -> usize {
        self.tables.readings.len()
    }

    /// Returns the readings of the supervisor that conditions of the active mode compare at `now`; NaN of all others.
    pub fn read(&self, now: Instant, readings: &dyn ModeReadings) -> Vec<f64> {
        let is_sample = now.ticks() >= self.supervisor.next;
        let mut values = vec![f64::NAN; self.tables.readings.len()];
        let place = |reading: ModeReading| self.tables.readings.iter().position(|known| *known == reading);
        for index in self.active_exits() {
            let (SupervisedExit { is_exact, .. }, written) =
                (self.tables.exits[index], &self.tables.written[index]);
            if is_exact {
                if let Some(place) = place(ModeReading::Truth(index)) {
                    values[place] = f64::from(u8::from(written.condition.holds(readings)));
                }
            } else if is_sample {
                for (quantity, _) in written.condition.leaves() {
                    if let Some(place) = place(ModeReading::Known(quantity)) {
                        values[place] = readings.value(quantity);
                    }
                }
            }
        }
        values
    }

    /// Tests the conditions that are due at `now`, in their order, and changes the mode if one is met.
    pub fn test(&mut self, now: Instant, readings: &[f64], precision: Precision) -> Option<ModeChange> {
        let ModeTables { modes, exits, steps, written, .. } = &mut self.tables;
        let from = self.supervisor.active;
        let ModeTest { has_changed, is_chattering, exit } =
            precision.test_modes(&mut self.supervisor, now.ticks(), readings, modes, exits, steps);
        (has_changed || is_chattering).then(|| ModeChange {
            from: Some(from),
            to: exits[exit].to,
            cause: written[exit].text.clone(),
            is_chatter: is_chattering,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::super::operating_mode::OperatingMode;
    use super::*;

    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    struct Known<'a> {
        rate: &'a Cell<f64>,
        now: Instant,
        entered: Instant,
    }

    impl ModeReadings for Known<'_> {
        fn value(&self, _: ModeQuantity) -> f64 {
            self.rate.get()
        }

        fn clock(&self, quantity: ModeQuantity) -> Span {
            let is_of_mode = matches!(quantity, ModeQuantity::Time | ModeQuantity::TrueTime);
            self.now.since(if is_of_mode { self.entered } else { Instant::START })
        }
    }

    fn sequence(text: &str) -> ModeSequence {
        #[derive(serde::Deserialize)]
        struct Of {
            mode: Vec<OperatingMode>,
        }
        let modes = flexsc_formats::document::from_text::<Of>(text).unwrap().mode;
        assert_eq!(OperatingMode::fault(&modes, &[]), None);
        let tables = ModeTables::from_modes(&modes, &[], Span::from_seconds(1.0));
        ModeSequence::new(tables, &|_, _| Vec::new()).unwrap()
    }

    /// Returns the changes of a run with a rate over time.
    fn changes(mut sequence: ModeSequence, end: f64, rate: impl Fn(f64) -> f64) -> Vec<(f64, usize)> {
        let mut found = Vec::new();
        while let Some(now) = sequence.due().filter(|now| *now <= at(end)) {
            let value = Cell::new(rate(now.seconds()));
            let known = Known { rate: &value, now, entered: sequence.entered() };
            let readings = sequence.read(now, &known);
            found.extend(
                sequence.test(now, &readings, Precision::Double).map(|change| (now.seconds(), change.to)),
            );
        }
        found
    }

    const TWO: &str = "[[mode]]\nname = 'fast'\nlaw.b_dot = { period = 2.0, gain = 1.0 }\n\
                       leave = [{ to = 'slow', when = 'rate < 1', for = 5.0 }]\n\
                       [[mode]]\nname = 'slow'\nlaw.open = {}\nleave = [{ to = 'fast', when = 'rate > 2' }]\n";

    #[test]
    fn a_condition_must_hold_without_a_break() {
        // True at the samples 2 and 4, false at 6, true from 8 on: 5 s later, at the sample at 14.
        let rate = |t: f64| if t == 6.0 { 1.5 } else { 0.5 };
        assert_eq!(changes(sequence(TWO), 30.0, rate), [(14.0, 1)]);
        // Hysteresis: a rate between the two limits changes nothing; samples of the second mode are 1 s apart.
        let rate = |t: f64| {
            if t < 17.0 {
                0.5
            } else if t < 20.5 {
                1.5
            } else {
                2.5
            }
        };
        assert_eq!(changes(sequence(TWO), 30.0, rate), [(8.0, 1), (21.0, 0)]);
        assert_eq!(changes(sequence(TWO), 30.0, |_| f64::NAN), []);
    }

    #[test]
    fn the_first_condition_in_order_counts() {
        let text = "[[mode]]\nname = 'a'\nlaw.b_dot = { period = 1.0, gain = 1.0 }\n\
                    leave = [{ to = 'b', when = 'rate > 9' }, { to = 'c', when = 'rate > 5' }, { to = 'b', when = 'rate > 1' }]\n\
                    [[mode]]\nname = 'b'\nlaw.open = {}\n[[mode]]\nname = 'c'\nlaw.open = {}";
        assert_eq!(changes(sequence(text), 5.0, |_| 6.0), [(1.0, 2)]);
        assert_eq!(changes(sequence(text), 5.0, |_| 10.0), [(1.0, 1)]);
        assert_eq!(sequence(text).name(2), "c");
    }

    #[test]
    fn conditions_on_the_truth_are_met_at_their_instants() {
        let text = "[[mode]]\nname = 'a'\nlaw.b_dot = { period = 1.0, gain = 1.0 }\n\
                    leave = [{ to = 'b', when = 'truth.run_time >= 2.345678901234', for = 0.1 }]\n\
                    [[mode]]\nname = 'b'\nlaw.open = {}\nleave = [{ to = 'a', when = 'truth.time > 0.7' }]";
        let found = changes(sequence(text), 3.3, |_| 0.0);
        // From then on, the first condition holds from the start of its mode, where it is tested next at its limits.
        assert_eq!(found[0], (2.345_678_901_234 + 0.1, 1));
        assert!((found[1].0 - 3.145_678_901_234).abs() < 2e-15 && found[1].1 == 0, "{found:?}");
    }

    #[test]
    fn what_is_no_sequence_is_refused() {
        let fault = |text: &str| {
            #[derive(serde::Deserialize)]
            struct Of {
                mode: Vec<OperatingMode>,
            }
            let modes = flexsc_formats::document::from_text::<Of>(text).unwrap().mode;
            OperatingMode::fault(&modes, &["gyro"]).unwrap().to_string()
        };
        let mode = |keys: &str| {
            format!("[[mode]]\nname = 'a'\nlaw.open = {{}}\n{keys}\n[[mode]]\nname = 'b'\nlaw.open = {{}}")
        };
        for (text, begins) in [
            (
                mode("leave = [{ to = 'c', when = 'time > 1' }]"),
                "`[0].leave[0].to` must name one of the modes, `a`, `b`",
            ),
            (mode("leave = [{ to = 'a', when = 'time > 1' }]"), "`[0].leave[0].to` must name another mode"),
            (
                mode("leave = [{ to = 'b', when = 'tme > 1' }]"),
                "`[0].leave[0].when` must begin with a quantity",
            ),
            (
                mode("leave = [{ to = 'b', when = 'truth.time > 1 or rate > 2' }]"),
                "`[0].leave[0].when` joins the truth",
            ),
            (mode("sensors = ['gyro', 'sun_sensor']"), "`[0].sensors[1]` must be one of the sensors, `gyro`"),
            (mode("").replace("'b'", "'a'"), "`[1].name` is that of a mode before"),
            (mode("").replace("'b'", "''"), "`[1].name` must be a name"),
        ] {
            let found = fault(&text);
            assert!(found.starts_with(begins), "{found}");
        }
    }
}
