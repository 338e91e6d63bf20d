//! Observer of a run for its answer: errors by mode of operation and by part of the run, largest values of requirements,
//! wheel speeds and events, from every control cycle.

use std::collections::BTreeMap;

use flexsc_control::operation::OperatingMode;
use flexsc_dynamics::MotionPiece;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_record::{
    BlindingEvent, FaultEvent, LineOfSightSample, LogRow, ModeEvent, Onset, PieceDemand, Pointing, Record,
    RecordError, RequirementErrors, RequirementScopes, Sample, ThreeAxisCycle, Wheels,
};
use flexsc_scenario::{RequirementSource, Scenario};

use super::angle_watch::AngleWatch;
use super::error_statistics::{ErrorStatistics, ErrorSummary};
use super::event::{EventKind, RunEvent};
use super::largest_sample::LargestSample;
use super::limit_watch::{LimitStay, LimitWatch};
use crate::metrics::ErrorStream;

/// Part of a run after which its end begins.
pub const LATE: f64 = 0.9;
/// Largest number of events that are listed.
const MOST_EVENTS: usize = 10_000;

/// Observer of a run.
#[derive(Clone, Debug)]
pub struct RunObserver {
    modes: Vec<ModeObserved>,
    /// Errors while the target moves from one attitude to another, afterwards, and in the last tenth of the run.
    slews: ErrorStatistics,
    settled: ErrorStatistics,
    late: ErrorStatistics,
    /// Start of the first slew and end of the last one (s), and number of slews.
    slewing: Option<[f64; 2]>,
    slew_count: u64,
    requirements: Vec<Option<(ErrorStream, LargestSample)>>,
    events: Vec<RunEvent>,
    /// Events that have begun, and not ended, by kind, part and cause.
    open: BTreeMap<(EventKind, String, String), usize>,
    names: Vec<String>,
    limits: LimitWatch,
    /// Watch of the angle of a one-axis body without a switching law, whose pieces of motion are all computed.
    angle: Option<AngleWatch>,
    /// True if the body has three axes, and thus control cycles; true if it has wheels; true if errors are required.
    has_cycles: bool,
    has_wheels: bool,
    has_errors: bool,
    mode: usize,
    /// Last cycle: its instant, error (rad), mode, and whether the target moves.
    last: Option<(Instant, f64, usize, bool)>,
    late_from: f64,
    end: Instant,
}

/// Observations in a mode of operation.
#[derive(Clone, Debug, Default)]
pub struct ModeObserved {
    /// True if the mode has a target; without modes always.
    pub has_target: bool,
    errors: ErrorStatistics,
    /// Smallest and largest speed of a wheel (rad/s); NaN without wheels.
    pub wheel_speed: [f64; 2],
}

impl ModeObserved {
    /// Returns the statistics of the pointing error; `None` without a target.
    pub fn errors(&self) -> Option<ErrorSummary> {
        self.errors.finish().filter(|_| self.has_target)
    }
}

/// Observations of a run that has ended.
#[derive(Clone, Debug)]
pub struct Observed {
    /// Each mode of operation, or the run without modes.
    pub modes: Vec<ModeObserved>,
    /// Errors while the target moves, if it does.
    pub slews: Option<ErrorSummary>,
    /// Errors after the first slew while the target does not move.
    pub settled: Option<ErrorSummary>,
    /// Errors in the last tenth of the run.
    pub late: Option<ErrorSummary>,
    /// Start of the first slew, and end of the last one (s).
    pub slewing: Option<[f64; 2]>,
    /// Number of slews.
    pub slew_count: u64,
    /// Largest distance of the angle of a one-axis body from the goal after the manoeuvre (rad).
    pub largest_angle: Option<LargestSample>,
    /// Largest value of each requirement on an error.
    pub peaks: Vec<Option<LargestSample>>,
    /// Events, in the order of their starts.
    pub events: Vec<RunEvent>,
}

impl RunObserver {
    /// Creates an observer of a run of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let end = Instant::START + scenario.duration;
        let observed =
            |has_target: bool| ModeObserved { has_target, wheel_speed: [f64::NAN; 2], ..Default::default() };
        let of_mode = |mode: &OperatingMode| observed(mode.target.is_some() || !scenario.has_mode_targets());
        let modes: Vec<ModeObserved> = scenario.mode.iter().map(of_mode).collect();
        let stream = |source: &RequirementSource| match source {
            RequirementSource::Metric(..) | RequirementSource::Formula(_) => None,
            RequirementSource::Error(error) => {
                Some((ErrorStream::new(error), LargestSample { value: f64::NAN, at: f64::NAN, mode: 0 }))
            }
        };
        Self {
            modes: if modes.is_empty() { vec![observed(true)] } else { modes },
            slews: ErrorStatistics::default(),
            settled: ErrorStatistics::default(),
            late: ErrorStatistics::default(),
            slewing: None,
            slew_count: 0,
            requirements: scenario.study.requirements.iter().map(|own| stream(&own.source)).collect(),
            events: Vec::new(),
            open: BTreeMap::new(),
            names: scenario.mode.iter().map(|mode| mode.name.clone()).collect(),
            limits: LimitWatch::new(scenario.actuator_limits(), MOST_EVENTS),
            angle: (scenario.axis_count() == 1 && !scenario.law.is_switching())
                .then(|| AngleWatch::new(scenario.goal())),
            has_cycles: scenario.axis_count() == 3,
            has_wheels: scenario.actuator.wheels().is_some(),
            has_errors: scenario
                .study
                .requirements
                .iter()
                .any(|own| matches!(own.source, RequirementSource::Error(_))),
            mode: 0,
            last: None,
            late_from: LATE * end.seconds(),
            end,
        }
    }

    /// Returns the observations of the run that has ended.
    pub fn finish(mut self) -> Observed {
        self.close_cycle(self.end);
        let end = self.end.seconds();
        for index in std::mem::take(&mut self.open).into_values() {
            self.events[index].to_s = end;
        }
        let stay = |(part, stay): (String, LimitStay)| RunEvent {
            kind: EventKind::Saturation,
            part,
            cause: String::new(),
            mode: self.names.get(stay.mode).cloned(),
            from_s: stay.from,
            to_s: stay.to,
        };
        self.events.extend(self.limits.finish(self.end).into_iter().map(stay));
        let has_slews = self.slewing.is_some();
        Observed {
            slews: self.slews.finish(),
            settled: self.settled.finish().filter(|_| has_slews),
            late: self.late.finish(),
            slewing: self.slewing,
            slew_count: self.slew_count,
            largest_angle: self.angle.and_then(AngleWatch::finish),
            peaks: self.requirements.into_iter().map(|own| own.map(|(_, peak)| peak)).collect(),
            events: self.events,
            modes: self.modes,
        }
    }

    /// Adds the error of the last cycle, which lasts until now.
    fn close_cycle(&mut self, now: Instant) {
        let Some((at, error, mode, slews)) = self.last.take() else { return };
        let time = now.since(at).seconds();
        if let Some(own) = self.modes.get_mut(mode).filter(|own| own.has_target) {
            own.errors.add(at, error, time);
        } else {
            return;
        }
        if slews {
            self.slews.add(at, error, time);
        } else if self.slewing.is_some() {
            self.settled.add(at, error, time);
        }
        if at.seconds() >= self.late_from {
            self.late.add(at, error, time);
        }
    }

    fn observe_cycle(&mut self, now: Instant, cycle: &ThreeAxisCycle) {
        let was_slewing = self.last.is_some_and(|(.., slews)| slews);
        self.observe_error(now, cycle.error_rad, cycle.visit.mode, cycle.slewing);
        if cycle.slewing {
            self.slew_count += u64::from(!was_slewing);
            self.slewing.get_or_insert([now.seconds(); 2]);
        }
        if let (true, Some(slewing)) = (cycle.slewing || was_slewing, &mut self.slewing) {
            slewing[1] = now.seconds();
        }
    }

    /// Takes the error about each axis (rad) in a mode of operation, which lasts until the next one.
    fn observe_error(&mut self, now: Instant, error: [f64; 3], mode: usize, slews: bool) {
        self.close_cycle(now);
        let square: f64 = error.iter().map(|error| error * error).sum();
        self.last = Some((now, square.sqrt(), mode, slews));
    }

    /// Takes a row of a log at its time. Errors of requirements are not in the rows.
    pub(super) fn observe_row(&mut self, now: Instant, row: &dyn LogRow) {
        if let Some(row) = row.downcast::<Pointing>() {
            let error = [row.roll_error_rad, row.pitch_error_rad, row.yaw_error_rad];
            self.observe_error(now, error, self.mode, false);
        }
        row.downcast().into_iter().for_each(|wheels| self.observe_wheels(wheels));
        self.observe_event(row);
    }

    fn observe_wheels(&mut self, wheels: &Wheels) {
        let Some(own) = self.modes.get_mut(self.mode) else { return };
        for speed in wheels.wheels.iter().map(|wheel| wheel.speed_rad_s.abs()) {
            // A comparison with NaN takes the other number.
            own.wheel_speed = [own.wheel_speed[0].min(speed), own.wheel_speed[1].max(speed)];
        }
    }

    fn observe_mode(&mut self, event: &ModeEvent) {
        self.mode = event.index as usize;
        let before = std::mem::take(&mut self.open);
        let (modes, others) = before.into_iter().partition(|((kind, ..), _)| *kind == EventKind::Mode);
        self.open = others;
        for index in BTreeMap::into_values(modes) {
            self.events[index].to_s = event.time_s;
        }
        self.begin(EventKind::Mode, event.time_s, (&event.mode, &event.cause));
    }

    /// Notes the start of an event of a part, with what brings it about.
    fn begin(&mut self, kind: EventKind, from: f64, (part, cause): (&str, &str)) {
        if self.events.len() < MOST_EVENTS {
            self.open.insert((kind, part.to_owned(), cause.to_owned()), self.events.len());
            let mode = self.names.get(self.mode).cloned();
            let event = RunEvent {
                kind,
                part: part.to_owned(),
                cause: cause.to_owned(),
                mode,
                from_s: from,
                to_s: from,
            };
            self.events.push(event);
        }
    }

    /// Notes the start or the end of an event.
    fn observe_onset(&mut self, (kind, onset): (EventKind, Onset), time: f64, (part, cause): (&str, &str)) {
        if onset == Onset::Begins {
            self.begin(kind, time, (part, cause));
        } else if let Some(index) = self.open.remove(&(kind, part.to_owned(), cause.to_owned())) {
            self.events[index].to_s = time;
        }
    }

    fn observe_event(&mut self, row: &dyn LogRow) {
        row.downcast().into_iter().for_each(|event| self.observe_mode(event));
        if let Some(event) = row.downcast::<BlindingEvent>() {
            let part = format!("sensor[{}]", event.sensor);
            self.observe_onset((EventKind::Blinding, event.onset), event.time_s, (&part, &event.body));
        }
        if let Some(event) = row.downcast::<FaultEvent>() {
            let of =
                if event.of.is_empty() { event.part.clone() } else { format!("{} {}", event.part, event.of) };
            self.observe_onset((EventKind::Failure, event.onset), event.time_s, (&of, &event.fault));
        }
    }

    /// Takes a sample of the error of a requirement.
    fn push(&mut self, now: Instant, requirement: usize, error: Vector) {
        let mode = self.mode;
        if let Some(Some((stream, peak))) = self.requirements.get_mut(requirement) {
            stream.push(error, |value| {
                let value = value.norm();
                if value > peak.value || peak.value.is_nan() {
                    *peak = LargestSample { value, at: now.seconds(), mode };
                }
            });
        }
    }

    fn observe_line(&mut self, now: Instant, sample: &LineOfSightSample) {
        for requirement in 0..self.requirements.len() {
            if let Some(Some((stream, _))) = self.requirements.get(requirement)
                && stream.takes_line(now, sample)
            {
                let error = Vector::from_iterator(sample.axes.iter().map(|axis| axis.error_rad));
                self.push(now, requirement, error);
            }
        }
    }
}

impl Record for RunObserver {
    fn wants_estimates(&self, _: Instant) -> bool {
        false
    }

    fn wants_journal(&self) -> bool {
        false
    }

    fn wants_switchings(&self) -> bool {
        false
    }

    fn piece_demand(&self) -> PieceDemand {
        if self.angle.is_some() { PieceDemand::All } else { PieceDemand::None }
    }

    fn piece(&mut self, _: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        self.angle.iter_mut().for_each(|angle| angle.observe(piece));
        Ok(())
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        // The most frequent samples come first; most runs need few of their values.
        if let (true, Sample::Report(report)) = (self.has_cycles, sample)
            && let Some(cycle) = report.get()
        {
            self.observe_cycle(now, cycle);
            self.limits.observe(now, cycle.visit.mode, report);
            if self.has_wheels {
                report.get().into_iter().for_each(|wheels| self.observe_wheels(wheels));
            }
        }
        if self.has_errors
            && let Some(errors) = sample.get::<RequirementErrors>()
        {
            errors.0.iter().for_each(|own| self.push(now, own.requirement, Vector::from(own.error)));
        }
        if self.has_errors
            && let Some(scopes) = sample.get::<RequirementScopes>()
        {
            for scope in &scopes.0 {
                if let Some(Some((stream, _))) = self.requirements.get_mut(scope.requirement) {
                    stream.set_counts(scope.counts);
                }
            }
        }
        if let Sample::Row(row) = sample {
            self.observe_event(row);
            row.downcast().into_iter().for_each(|sample| self.observe_line(now, sample));
        }
        Ok(())
    }
}
