//! Rows of a three-axis run for its figures: those of a full log, or those of the repeated run.

use std::any::Any;
use std::path::Path;

use flexsc_core::control::actuator::JetCycle;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::row::TopicRow;
use flexsc_core::record::{
    Columns, Energy, Jets, Log, LogRow, Pointing, Rates, Record, RecordError, Report, Sample, ThreeAxisCycle,
    Wheels,
};
use flexsc_figure::Point;

use super::run_events::RunEvents;
use crate::error::CliError;

/// Rows of a run, each with its time: of a full log, or all of a repeated run, which also has the values of each cycle.
#[derive(Default)]
pub struct CycleData(TimedReports);

/// Rows of a run, each with its time (s).
type TimedReports = Vec<(f64, Report)>;

/// Topic whose rows a figure shows.
#[derive(Copy, Clone)]
pub struct RowSource {
    /// Name of the topic.
    pub topic: &'static str,
    /// Reads the rows of a log's table; `None` for rows of another form.
    read: fn(&Columns) -> Option<TimedReports>,
}

impl RowSource {
    /// Returns the topic of a type of rows.
    pub const fn new<R: TopicRow + LogRow>() -> Self {
        Self { topic: R::TOPIC.name, read: Self::read::<R> }
    }

    fn read<R: TopicRow + LogRow>(columns: &Columns) -> Option<TimedReports> {
        let report = |(time, row): (f64, R)| {
            let mut report = Report::new();
            report.add(row);
            (time, report)
        };
        Some(columns.timed_rows::<R>()?.into_iter().map(report).collect())
    }
}

impl CycleData {
    /// Reads the rows of some topics, from the log if it has them, else from the repeated run.
    ///
    /// # Errors
    /// A run that cannot be repeated.
    pub fn read(story: &RunEvents, log: &Log, path: &Path, sources: &[RowSource]) -> Result<Self, CliError> {
        let is_full = log.topics().iter().any(|topic| topic == Pointing::TOPIC.name);
        let is_event = |source: &&RowSource| source.topic == Jets::TOPIC.name;
        let missing = sources.iter().find(|source| !is_full && !is_event(source));
        let unread = match missing {
            Some(source) => source.topic,
            None => match Self::from_log(log, sources)? {
                Ok(cycles) => return Ok(cycles),
                Err(topic) => topic,
            },
        };
        let mut cycles = Self::default();
        story.repeat(log, path, &format!("rows of {unread}"), &mut cycles)?;
        Ok(cycles)
    }

    /// Reads the rows of a log, or returns the topic whose rows have another form.
    fn from_log(log: &Log, sources: &[RowSource]) -> Result<Result<Self, &'static str>, CliError> {
        let topics: Vec<&str> = sources.iter().map(|source| source.topic).collect();
        let mut reports = Vec::new();
        for (source, table) in sources.iter().zip(log.tables(&topics)?) {
            let Some(table) = table else { continue };
            match (source.read)(&table) {
                Some(rows) => reports.extend(rows),
                None => return Ok(Err(source.topic)),
            }
        }
        Ok(Ok(Self(reports)))
    }

    /// Iterates over the rows of a type, each with its time (s).
    pub fn rows<T: Any>(&self) -> impl Iterator<Item = (f64, &T)> {
        self.0.iter().filter_map(|(time, report)| Some((*time, report.row()?)))
    }

    /// Returns the first row of a type.
    pub fn first<T: Any>(&self) -> Option<&T> {
        self.rows().next().map(|(_, row)| row)
    }

    /// Returns a number of the rows of a type over time.
    pub fn line<T: Any>(&self, of: impl Fn(&T) -> f64) -> Vec<Point> {
        self.rows().map(|(time, row)| (time, of(row))).collect()
    }

    /// Returns a number of the rows of a type that have it over time.
    pub fn line_where<T: Any>(&self, of: impl Fn(&T) -> Option<f64>) -> Vec<Point> {
        self.rows().filter_map(|(time, row)| Some((time, of(row)?))).collect()
    }

    /// Iterates over the values of a type in the reports of cycles, each with its time (s).
    fn values<T: Any>(&self) -> impl Iterator<Item = (f64, &T)> {
        let cycles = self.0.iter().filter(|(_, report)| report.get::<ThreeAxisCycle>().is_some());
        cycles.filter_map(|(time, report)| Some((*time, report.get()?)))
    }

    /// Returns a number over time: of each cycle of a repeated run, or of each row of a log.
    pub fn over_time<R: Any>(
        &self,
        of_cycle: impl Fn(&ThreeAxisCycle) -> f64,
        of_row: impl Fn(&R) -> f64,
    ) -> Vec<Point> {
        let cycles: Vec<Point> = self.values().map(|(time, cycle)| (time, of_cycle(cycle))).collect();
        if cycles.is_empty() {
            return self.line(of_row);
        }
        cycles
    }

    /// Returns a number of the pointing error over time, from its components about the axes (rad).
    pub fn errors(&self, of: impl Fn([f64; 3]) -> f64) -> Vec<Point> {
        self.over_time(
            |cycle| of(cycle.error_rad),
            |row: &Pointing| of([row.roll_error_rad, row.pitch_error_rad, row.yaw_error_rad]),
        )
    }

    /// Returns a number of the rates over time, from the rigid and the elastic parts at the gyro about the axes (rad/s).
    pub fn rates(&self, of: impl Fn([f64; 3], [f64; 3]) -> f64) -> Vec<Point> {
        self.over_time(
            |cycle| of(cycle.rigid_rate_rad_s, cycle.elastic_rate_rad_s),
            |row: &Rates| {
                let rates = |axis: usize| {
                    row.axes.get(axis).map_or([f64::NAN; 2], |of| [of.rigid_rad_s, of.elastic_rad_s])
                };
                of([0, 1, 2].map(|axis| rates(axis)[0]), [0, 1, 2].map(|axis| rates(axis)[1]))
            },
        )
    }

    /// Returns the elastic energy over time (J): that of all modes, and that of the modes that move the gyro.
    pub fn elastic_energies(&self) -> [Vec<Point>; 2] {
        [
            self.over_time(|cycle| cycle.elastic_energy_j, |row: &Energy| row.elastic_j),
            self.over_time(|cycle| cycle.visible_energy_j, |row: &Energy| row.visible_j),
        ]
    }

    /// Returns a number of the momentum of wheels over time, from its components in the body's axes (N m s).
    pub fn wheel_momenta(&self, story: &RunEvents, of: impl Fn([f64; 3]) -> f64) -> Vec<Point> {
        let axes = story.scenario.study.wheels.as_ref().map_or(&[][..], |allocation| allocation.axes());
        let stored = |row: &Wheels| -> [f64; 3] {
            let wheels = axes.iter().zip(&row.wheels);
            wheels.fold(Vector::zeros(), |sum, (axis, wheel)| sum + axis * wheel.momentum_nm_s).into()
        };
        self.over_time(|cycle| of(cycle.stored_momentum_nm_s), |row| of(stored(row)))
    }

    /// Returns the period of pulses (s), and the signed on-times of the jets about the axes (s) at each cycle; of a log, at
    /// those with pulses, and at the end of the last of a series.
    pub fn pulses(&self, story: &RunEvents) -> (f64, Vec<(f64, [f64; 3])>) {
        let cycles: Vec<_> = self.values().map(|(time, jets): (f64, &JetCycle)| (time, jets.on)).collect();
        if let [(first, _), rest @ ..] = &cycles[..] {
            return (rest.first().map_or(0.0, |(second, _)| second - first), cycles);
        }
        let period = jet_period(story);
        let mut pulses: Vec<(f64, [f64; 3])> = Vec::new();
        for (time, row) in self.rows::<Jets>() {
            if let Some((last, _)) = pulses.last().filter(|(last, _)| time > last + 1.5 * period) {
                pulses.push((last + period, [0.0; 3]));
            }
            pulses.push((time, [row.roll_on_s, row.pitch_on_s, row.yaw_on_s]));
        }
        (period, pulses)
    }

    /// Returns the propellant that the jets have used (kg): until the end of the pulses of each cycle; empty without jets.
    pub fn fuel(&self, story: &RunEvents) -> Vec<Point> {
        let cycles: Vec<Point> = self.values::<JetCycle>().map(|(time, jets)| (time, jets.fuel)).collect();
        if !cycles.is_empty() || !story.scenario.study.fires() {
            return cycles;
        }
        let period = jet_period(story);
        let mut used = vec![(0.0, 0.0)];
        for (time, row) in self.rows::<Jets>() {
            let (last, before) = used[used.len() - 1];
            if time > last + 1.5 * period {
                used.push((time - period, before));
            }
            used.push((time, row.fuel_kg));
        }
        used.push((story.end, used[used.len() - 1].1));
        used
    }
}

/// Returns the period of the jets (s): that of their own, or of the cycles.
fn jet_period(story: &RunEvents) -> f64 {
    let own = story.scenario.actuator.jets().and_then(|(jets, _)| jets.period);
    own.unwrap_or(story.scenario.study.assessment_period).seconds()
}

impl Record for CycleData {
    fn wants_motion(&self) -> bool {
        true
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Report(report) => self.0.push((now.seconds(), report.clone())),
            Sample::Row(row) => self.0.push((now.seconds(), Report::from_row(row))),
            Sample::Begin(_) | Sample::Switching(..) => {}
        }
        Ok(())
    }
}
