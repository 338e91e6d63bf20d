//! Fine mirrors of a run: loops of their own behind lines of sight, which nothing else reads.
//!
//! Between two samples the mirror moves in closed form under its held command; the mean of the line of sight over an exposure is
//! that of a copy of the plant.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, earlier};
use flexsc_record::Record;
use nalgebra::{Matrix4, Vector4};

use super::SimulationError;
use super::guidance::Guidance;
use super::mounted_lines::MountedLines;
use super::plant::Plant;
use super::segment_copy::SegmentCopy;
use flexsc_scenario::{FineMirror, LineOfSight, Scenario};

/// Fine mirrors of all lines of sight.
#[derive(Clone, Debug)]
pub struct FineMirrors {
    lines: MountedLines,
    mirrors: Vec<MirrorState>,
    copy: SegmentCopy,
}

/// Run-time state of a fine mirror.
#[derive(Clone, Debug)]
struct MirrorState {
    /// Index of the line of sight.
    line: usize,
    mirror: FineMirror,
    axes: [MirrorAxis; 2],
    /// Motion over a period.
    flow: Matrix4<f64>,
    /// Start of the current period, and its end.
    since: Instant,
    next: Instant,
    /// Integral of the line of sight over the current exposure (rad s).
    integral: Vector,
    noise: Stream,
    /// Number of periods in which a limit shortened a command.
    limited: u64,
}

/// Mirror about one axis.
#[derive(Clone, Debug)]
struct MirrorAxis {
    /// Axis in the body, across the line of sight.
    about: Vector,
    /// Angle (rad), its rate (rad/s) and the command (rad) at the start of the current period.
    state: [f64; 3],
    /// Means over earlier exposures that wait (rad), the latest first.
    waiting: Vec<f64>,
}

/// Mirror at an instant.
#[derive(Copy, Clone, Debug)]
pub struct MirrorReading {
    /// Angle, and command (rad).
    pub angle: Vector,
    pub command: Vector,
    /// Number of periods until then in which a limit shortened a command.
    pub limited: u64,
}

impl MirrorState {
    fn new(line: usize, (of, mirror): (&LineOfSight, FineMirror), seed: Seed) -> Self {
        let axis =
            |about| MirrorAxis { about, state: [0.0; 3], waiting: vec![0.0; mirror.computing_periods] };
        Self {
            line,
            mirror,
            axes: of.across().map(axis),
            flow: mirror.flow(mirror.period.seconds()),
            since: Instant::START,
            next: Instant::START + mirror.period,
            integral: Vector::zeros(),
            noise: seed.stream(&format!("fine mirror {line}")),
            limited: 0,
        }
    }

    /// Ends the exposure and begins the next.
    fn end_period(&mut self) {
        let period = self.mirror.period.seconds();
        let mut is_limited = false;
        for axis in &mut self.axes {
            let [angle, rate, command] = axis.state;
            let moved = self.flow * Vector4::new(angle, rate, command, 0.0);
            let noise = self.mirror.noise.get() * self.noise.normal();
            axis.waiting.insert(0, (axis.about.dot(&self.integral) - moved[3]) / period + noise);
            let mean = axis.waiting.pop().unwrap_or_default();
            let (command, shortened) = self.mirror.limited(command, self.mirror.gain.get() * mean);
            is_limited |= shortened;
            axis.state = [moved[0], moved[1], command];
        }
        self.limited += u64::from(is_limited);
        self.integral = Vector::zeros();
        (self.since, self.next) = (self.next, self.next + self.mirror.period);
    }

    /// Returns the mirror at an instant of the current period.
    fn reading(&self, now: Instant) -> MirrorReading {
        let flow = self.mirror.flow(now.since(self.since).seconds());
        let sum = |of: &dyn Fn(&MirrorAxis) -> f64| -> Vector {
            self.axes.iter().map(|axis| axis.about * of(axis)).sum()
        };
        let angle = |axis: &MirrorAxis| {
            let [angle, rate, command] = axis.state;
            (flow * Vector4::new(angle, rate, command, 0.0))[0]
        };
        MirrorReading { angle: sum(&angle), command: sum(&|axis| axis.state[2]), limited: self.limited }
    }
}

impl FineMirrors {
    /// Creates the mirrors of a scenario, before its start.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        let all = scenario.line_of_sight.iter().enumerate();
        let with_mirror = all.filter_map(|(index, line)| Some((index, (line, line.mirror?))));
        let mirrors: Vec<MirrorState> =
            with_mirror.map(|(index, of)| MirrorState::new(index, of, seed)).collect();
        let lines = if mirrors.is_empty() { MountedLines::default() } else { MountedLines::new(scenario) };
        Self { lines, mirrors, copy: SegmentCopy::new() }
    }

    /// Returns the next instant at which an exposure ends.
    #[inline]
    pub fn due(&self) -> Option<Instant> {
        self.mirrors.iter().fold(None, |due, own| earlier(due, Some(own.next)))
    }

    /// Copies the plant before it advances from `now`, if there is no copy of this segment.
    #[inline]
    pub fn copy_plant(&mut self, now: Instant, plant: &Plant) {
        if !self.mirrors.is_empty() {
            self.copy.begin(now, plant);
        }
    }

    /// Adds the motion up to `now`, at which the plant is evaluated, to the exposures, and ends those that are due.
    #[inline]
    pub fn update(
        &mut self,
        now: Instant,
        plant: &Plant,
        guidance: &Guidance,
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        let Self { lines, mirrors, copy } = self;
        copy.average(now, plant, record, |copy, at, lasts| {
            for own in mirrors.iter_mut() {
                own.integral += lines.error(own.line, copy, guidance, at).unwrap_or_default() * lasts;
            }
        })?;
        mirrors.iter_mut().filter(|own| own.next <= now).for_each(MirrorState::end_period);
        Ok(())
    }

    /// Ends the motion segment, before the body begins its next one.
    #[inline]
    pub fn end_segment(&mut self) {
        self.copy.end();
    }

    /// Returns the mirror of a line of sight at the current instant; `None` for a line without one.
    pub fn reading(&self, line: usize, now: Instant) -> Option<MirrorReading> {
        self.mirrors.iter().find(|own| own.line == line).map(|own| own.reading(now))
    }
}
