//! Sequence of modes during a run: the active one, when its conditions are tested, and the changes.

use flexsc_numerics::time::{Instant, Span};

use super::condition::{Expression, ModeReadings, Vocabulary};
use super::operating_mode::OperatingMode;
use super::quantity::ModeQuantity;

/// Mode with its conditions, ready for a run.
#[derive(Clone, Debug, PartialEq)]
pub struct SequencedMode {
    /// Name of the mode.
    pub name: String,
    /// Period of the samples at which its conditions are tested.
    period: Span,
    exits: Vec<SequencedExit>,
}

/// End of a mode, with its condition read.
#[derive(Clone, Debug, PartialEq)]
struct SequencedExit {
    /// Index of the mode that follows.
    to: usize,
    text: String,
    condition: Expression,
    dwell: Span,
    /// Instants at which quantities of the sky pass numbers of the condition, in order.
    crossings: Vec<Instant>,
    /// True if the condition reads the truth, and is tested at exact instants.
    is_exact: bool,
}

/// Change of the mode.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModeChange {
    /// Index of the mode before; `None` at the start of a run.
    pub from: Option<usize>,
    /// Index of the mode from now on.
    pub to: usize,
    /// Condition that was met, as written; empty at the start.
    pub cause: String,
}

/// State of the sequence.
#[derive(Clone, Debug)]
pub struct ModeSequence {
    modes: Vec<SequencedMode>,
    active: usize,
    /// Instant at which the mode was entered.
    entered: Instant,
    /// Number of times that each mode was entered.
    entries: Vec<u64>,
    /// Instant of the next test at a sample.
    next: Instant,
    /// Last instant at which conditions were tested.
    tested: Instant,
    /// Since when the condition of each end of the mode has held.
    held: Vec<Option<Instant>>,
}

impl SequencedMode {
    /// Reads the conditions of modes, which were checked before, on sensors of these kinds; a mode whose law has no period
    /// is tested at `shortest`. `crossings` returns the instants at which a quantity of the sky passes a number.
    pub fn from_modes(
        modes: &[OperatingMode],
        sensors: &[&str],
        shortest: Span,
        crossings: &dyn Fn(ModeQuantity, f64) -> Vec<Instant>,
    ) -> Vec<Self> {
        let known = Vocabulary {
            sensors: sensors.to_vec(),
            modes: modes.iter().map(|mode| mode.name.as_str()).collect(),
            numbers: None,
        };
        let passed = |condition: &Expression| {
            let of_sky = condition.leaves().into_iter().filter(|(quantity, _)| quantity.is_of_sky());
            let mut instants: Vec<Instant> =
                of_sky.flat_map(|(quantity, limit)| crossings(quantity, limit.unwrap_or(f64::NAN))).collect();
            instants.sort_unstable();
            instants
        };
        let each = modes.iter().map(|mode| {
            let exits = mode.leave.iter().filter_map(|exit| {
                let condition = exit.read(&known).ok()?;
                Some(SequencedExit {
                    to: known.modes.iter().position(|name| *name == exit.to)?,
                    text: exit.when.text().to_owned(),
                    is_exact: condition.reads_truth(),
                    crossings: passed(&condition),
                    condition,
                    dwell: exit.dwell(),
                })
            });
            Self {
                name: mode.name.clone(),
                period: mode.law.period().unwrap_or(shortest),
                exits: exits.collect(),
            }
        });
        each.collect()
    }
}

impl SequencedExit {
    /// Returns the instants at which the truth may make the condition true or false, of those of the sky the next one after
    /// `tested`.
    fn exact_instants(&self, entered: Instant, tested: Instant) -> impl Iterator<Item = Instant> {
        let instant = move |(quantity, limit): (ModeQuantity, Option<f64>)| {
            let origin = if quantity == ModeQuantity::TrueTime { entered } else { Instant::START };
            Some(origin + Span::from_seconds(limit?))
        };
        // A time is above its limit from the next tick on.
        let leaves = if self.is_exact { self.condition.leaves() } else { Vec::new() };
        let reads_sky = leaves.iter().any(|(quantity, _)| quantity.is_of_sky());
        let next = self.crossings.get(self.crossings.partition_point(|at| *at <= tested)).copied();
        // The sky may meet the condition from the start of the mode on.
        let of_sky = next.into_iter().chain(reads_sky.then_some(entered + Span::TICK));
        let clocks = leaves.into_iter().filter(|(quantity, _)| !quantity.is_of_sky());
        clocks.filter_map(instant).flat_map(|at| [at, at + Span::TICK]).chain(of_sky)
    }
}

impl ModeSequence {
    /// Creates the sequence at the start of a run, in the first mode; `None` without modes.
    pub fn new(modes: Vec<SequencedMode>) -> Option<Self> {
        let first = modes.first()?;
        let mut entries = vec![0; modes.len()];
        entries[0] = 1;
        Some(Self {
            active: 0,
            entered: Instant::START,
            entries,
            next: Instant::START + first.period,
            tested: Instant::START,
            held: vec![None; first.exits.len()],
            modes,
        })
    }

    /// Returns the index of the active mode.
    pub fn active(&self) -> usize {
        self.active
    }

    /// Returns the instant at which the active mode was entered.
    pub fn entered(&self) -> Instant {
        self.entered
    }

    /// Returns the number of times that a mode was entered.
    pub fn entries(&self, mode: usize) -> u64 {
        self.entries.get(mode).copied().unwrap_or(0)
    }

    /// Returns the name of a mode.
    pub fn name(&self, mode: usize) -> &str {
        self.modes.get(mode).map_or("", |mode| &mode.name)
    }

    /// Returns the next instant at which conditions are tested; `None` for a mode without an end.
    pub fn due(&self) -> Option<Instant> {
        let exits = &self.modes[self.active].exits;
        let sampled = exits.iter().any(|exit| !exit.is_exact).then_some(self.next);
        let exact = exits.iter().zip(&self.held).flat_map(|(exit, held)| {
            let dwelt = held.filter(|_| exit.is_exact).map(|since| since + exit.dwell);
            exit.exact_instants(self.entered, self.tested).chain(dwelt).filter(|at| *at > self.tested)
        });
        exact.chain(sampled).min()
    }

    /// Tests the conditions that are due at `now`, in their order, and changes the mode if one is met.
    pub fn test(&mut self, now: Instant, readings: &dyn ModeReadings) -> Option<ModeChange> {
        let is_sample = now >= self.next;
        let mode = &self.modes[self.active];
        if is_sample {
            self.next = now + mode.period;
        }
        self.tested = now;
        let mut met = None;
        for (index, exit) in mode.exits.iter().enumerate() {
            if !exit.is_exact && !is_sample {
                continue;
            }
            let held = &mut self.held[index];
            *held = exit.condition.holds(readings).then(|| held.unwrap_or(now));
            if held.is_some_and(|since| now.since(since) >= exit.dwell) {
                met = met.or(Some(index));
            }
        }
        let exit = &mode.exits[met?];
        let change = ModeChange { from: Some(self.active), to: exit.to, cause: exit.text.clone() };
        self.enter(now, exit.to);
        Some(change)
    }

    fn enter(&mut self, now: Instant, mode: usize) {
        self.active = mode;
        self.entered = now;
        self.entries[mode] += 1;
        self.next = now + self.modes[mode].period;
        self.held = vec![None; self.modes[mode].exits.len()];
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

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
        ModeSequence::new(SequencedMode::from_modes(&modes, &[], Span::from_seconds(1.0), &|_, _| Vec::new()))
            .unwrap()
    }

    /// Returns the changes of a run with a rate over time.
    fn changes(mut sequence: ModeSequence, end: f64, rate: impl Fn(f64) -> f64) -> Vec<(f64, usize)> {
        let mut found = Vec::new();
        while let Some(now) = sequence.due().filter(|now| *now <= at(end)) {
            let value = Cell::new(rate(now.seconds()));
            let known = Known { rate: &value, now, entered: sequence.entered() };
            found.extend(sequence.test(now, &known).map(|change| (now.seconds(), change.to)));
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
