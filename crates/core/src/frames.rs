//! Frames of a camera: the error of the lines of sight of a run as means over exposures, and where lines of its spectrum land.
//!
//! Between samples of a line of sight its error is a straight line. Of frames R per second, a sine of the frequency f appears at the
//! distance of f from the nearest multiple of R, by the mean over exposures T smaller by the factor sinc(f T).

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use flexsc_formats::document::ScenarioError;
use flexsc_formats::reader_units;
use flexsc_record::{Column, Columns, Log, LogError};
use flexsc_scenario::Scenario;
use serde::Serialize;

/// Topic of lines of sight.
const TOPIC: &str = "/line_of_sight";
/// Topic of the wheels.
const WHEELS: &str = "/wheels";
/// Least number of sampling periods in an exposure.
const LEAST_PERIODS: f64 = 2.0;
/// Largest number of frames.
const MOST_FRAMES: f64 = 1e6;
/// Largest number of samples times lines of which the amplitudes are computed.
const MOST_PRODUCTS: usize = 200_000_000;
/// Largest change of a wheel's speed, relative to its mean, at which its harmonics are lines.
const STEADY: f64 = 0.01;
/// Part of a period by which an exposure may end after the last sample.
const ROUNDING: f64 = 1e-9;

/// Frames of a camera.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FrameRequest {
    /// Frames per second (Hz).
    pub rate: f64,
    /// Length of each exposure, at the start of its frame (s); `None` for the whole frame.
    pub exposure: Option<f64>,
}

/// Motion of the lines of sight in frames, and where lines land.
#[derive(Clone, Debug, PartialEq)]
pub struct Frames {
    /// Frame, start of the exposure (s), line of sight, mean error about x, y and z (rad), and rms about the mean (rad).
    pub columns: Columns,
    /// Lines that may be in the motion, those that are largest in the frames first.
    pub lines: Vec<FrameLine>,
}

/// Line of a line of sight, and where it lands in the spectrum of the frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameLine {
    /// Number of the line of sight.
    pub line: usize,
    /// Key of the machine or the mode.
    pub source: String,
    /// Frequency (Hz).
    pub frequency_hz: f64,
    /// Frequency in the spectrum of the frames (Hz).
    pub lands_at_hz: f64,
    /// Amplitude of the run at the frequency, under Hann's window (rad).
    pub amplitude_rad: f64,
    /// Amplitude of its mean over exposures (rad).
    pub in_frames_rad: f64,
}

/// Reason for which a run has no frames.
#[derive(Debug)]
pub enum FrameFault {
    /// Log without lines of sight.
    Log(LogError),
    /// Scenario of the log that is not accepted.
    Scenario(ScenarioError),
    /// Request that cannot be met: a text that begins with the name of the argument.
    Request(String),
}

/// Samples of one line of sight.
#[derive(Default)]
struct SampledLine {
    times: Vec<f64>,
    errors: Vec<[f64; 3]>,
}

impl Frames {
    /// Returns the frames of the lines of sight in a log.
    ///
    /// # Errors
    /// A log without samples of a line of sight, and an exposure that is shorter than two samples or longer than a frame.
    pub fn from_log(log: &Log, request: FrameRequest) -> Result<Self, FrameFault> {
        let topic = log.columns(TOPIC).map_err(FrameFault::Log)?;
        let text = log.require_scenario().map_err(FrameFault::Log)?;
        let scenario = Scenario::parse_logged(&log.path().display().to_string(), text, log)
            .map_err(FrameFault::Scenario)?;
        let exposure = request.exposure.unwrap_or(1.0 / request.rate);
        if !(request.rate > 0.0 && request.rate.is_finite()) {
            return Err(FrameFault::Request(format!(
                "frames must be a positive rate, got {} Hz",
                request.rate
            )));
        }
        if !(exposure > 0.0 && exposure * request.rate <= 1.0 + ROUNDING) {
            let [frame, got] = [1.0 / request.rate, exposure].map(reader_units::time_span);
            let why = format!("exposure must be positive and at most a frame, {frame}, got {got}");
            return Err(FrameFault::Request(why));
        }
        let (mut found, mut lines) = (FrameColumns::default(), Vec::new());
        let known = known_lines(&scenario, log);
        for (line, own) in samples(&topic) {
            found.add(line, &own, (request.rate, exposure, request.exposure.is_none()))?;
            lines.extend(known.iter().filter_map(|(source, frequency)| {
                own.line_at(line, (source, *frequency), (request.rate, exposure), known.len())
            }));
        }
        lines.sort_by(|a, b| b.in_frames_rad.total_cmp(&a.in_frames_rad));
        Ok(Self { columns: found.columns(), lines })
    }
}

/// Columns of frames.
#[derive(Default)]
struct FrameColumns {
    frame: Vec<u64>,
    time: Vec<f64>,
    line: Vec<u64>,
    means: [Vec<f64>; 3],
    jitter: Vec<f64>,
}

impl FrameColumns {
    /// Adds the frames of a line of sight.
    fn add(
        &mut self,
        line: usize,
        own: &SampledLine,
        (rate, exposure, is_frame): (f64, f64, bool),
    ) -> Result<(), FrameFault> {
        let (Some(first), Some(last)) = (own.times.first(), own.times.last()) else { return Ok(()) };
        let period = (last - first) / (own.times.len().max(2) - 1) as f64;
        if exposure < LEAST_PERIODS * period * (1.0 - ROUNDING) {
            let [least, got] = [LEAST_PERIODS * period, exposure].map(reader_units::time_span);
            let why = format!("must have two samples of line_of_sight[{line}], {least}, got {got}");
            // Without its own length the exposure is a whole frame.
            let subject = if is_frame { "frames: each frame" } else { "exposure" };
            return Err(FrameFault::Request(format!("{subject} {why}")));
        }
        let count = ((last - first - exposure) * rate + ROUNDING).floor() + 1.0;
        if !(1.0..=MOST_FRAMES).contains(&count) {
            let why = format!("frames must be from 1 to {MOST_FRAMES} in the run, got {}", count.max(0.0));
            return Err(FrameFault::Request(why));
        }
        for frame in 0..count as u64 {
            let start = first + frame as f64 / rate;
            let (mean, square) = own.over([start, start + exposure]);
            self.frame.push(frame);
            self.time.push(start);
            self.line.push(line as u64);
            self.means.iter_mut().zip(mean).for_each(|(column, value)| column.push(value));
            self.jitter.push(f64::sqrt(square));
        }
        Ok(())
    }

    fn columns(self) -> Columns {
        let [x, y, z] = self.means.map(Column::Numbers);
        let all = [
            ("frame", Column::Counts(self.frame)),
            ("time_s", Column::Numbers(self.time)),
            ("line", Column::Counts(self.line)),
            ("mean_x_rad", x),
            ("mean_y_rad", y),
            ("mean_z_rad", z),
            ("jitter_rms_rad", Column::Numbers(self.jitter)),
        ];
        Columns { columns: all.map(|(name, column)| (name.to_owned(), column)).into_iter().collect() }
    }
}

impl SampledLine {
    /// Returns the mean error over an interval (s), and the mean square about it (rad²).
    fn over(&self, [from, to]: [f64; 2]) -> ([f64; 3], f64) {
        let at = |time: f64| -> [f64; 3] {
            let next = self.times.partition_point(|own| *own < time).clamp(1, self.times.len() - 1);
            let (before, after) = (self.times[next - 1], self.times[next]);
            let part = ((time - before) / (after - before)).clamp(0.0, 1.0);
            std::array::from_fn(|axis| {
                self.errors[next - 1][axis] * (1.0 - part) + self.errors[next][axis] * part
            })
        };
        let inner =
            self.times.partition_point(|own| *own <= from)..self.times.partition_point(|own| *own < to);
        let mut knots = vec![(from, at(from))];
        knots.extend(inner.map(|place| (self.times[place], self.errors[place])));
        knots.push((to, at(to)));
        let mut mean = [0.0; 3];
        for ends in knots.windows(2) {
            let part = (ends[1].0 - ends[0].0) / (to - from);
            (0..3).for_each(|axis| mean[axis] += 0.5 * part * (ends[0].1[axis] + ends[1].1[axis]));
        }
        let mut square = 0.0;
        for ends in knots.windows(2) {
            let part = (ends[1].0 - ends[0].0) / (to - from);
            for axis in 0..3 {
                // The mean square of a straight line.
                let [one, other] = [0, 1].map(|end: usize| ends[end].1[axis] - mean[axis]);
                square += part * (one * one + one * other + other * other) / 3.0;
            }
        }
        (mean, square)
    }

    /// Returns a line at a frequency (Hz), and where it lands; `None` above half the rate of the samples.
    fn line_at(
        &self,
        line: usize,
        (source, frequency): (&String, f64),
        (rate, exposure): (f64, f64),
        lines: usize,
    ) -> Option<FrameLine> {
        let (first, last) = (*self.times.first()?, *self.times.last()?);
        let count = self.times.len();
        let sampling = (count - 1) as f64 / (last - first);
        if frequency > 0.5 * sampling || count.saturating_mul(lines) > MOST_PRODUCTS {
            return None;
        }
        let (mut sums, mut weights) = ([[0.0; 2]; 3], 0.0);
        for (time, error) in self.times.iter().zip(&self.errors) {
            let weight = 1.0 - libm::cos(TAU * (time - first) / (last - first));
            let angle = TAU * frequency * (time - first);
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            weights += weight;
            for (sum, value) in sums.iter_mut().zip(error) {
                sum[0] += weight * value * cosine;
                sum[1] += weight * value * sine;
            }
        }
        let square: f64 = sums.iter().flatten().map(|sum| sum * sum).sum();
        let amplitude = 2.0 * f64::sqrt(square) / weights;
        let turn = PI * frequency * exposure;
        let factor = if turn == 0.0 { 1.0 } else { (libm::sin(turn) / turn).abs() };
        Some(FrameLine {
            line,
            source: source.clone(),
            frequency_hz: frequency,
            lands_at_hz: (frequency - rate * libm::round(frequency / rate)).abs(),
            amplitude_rad: amplitude,
            in_frames_rad: amplitude * factor,
        })
    }
}

/// Returns the samples of each line of sight in its topic, by its number.
fn samples(topic: &Columns) -> BTreeMap<usize, SampledLine> {
    let mut found: BTreeMap<usize, SampledLine> = BTreeMap::new();
    let (Some(times), Some(Column::Counts(lines)), Some(Column::Rows(counts, axes))) =
        (topic.numbers("time_s"), topic.get("line"), topic.get("axes"))
    else {
        return found;
    };
    let errors = axes.numbers("error_rad").unwrap_or_default();
    let mut place = 0;
    for ((time, line), count) in times.iter().zip(lines).zip(counts) {
        let own = found.entry(*line as usize).or_default();
        let error = |axis: usize| errors.get(place + axis).copied().filter(|_| axis < *count as usize);
        own.errors.push(std::array::from_fn(|axis| error(axis).unwrap_or(0.0)));
        own.times.push(*time);
        place += *count as usize;
    }
    found
}

/// Returns the frequencies (Hz) of the machines, of the wheels at their mean speed if it is steady, and of the modes, with their keys.
fn known_lines(scenario: &Scenario, log: &Log) -> Vec<(String, f64)> {
    let mut found = Vec::new();
    for (index, lines) in scenario.disturbance.iter().enumerate() {
        for (number, harmonic) in lines.lines.iter().flat_map(|own| own.harmonics.iter().enumerate()) {
            let multiple =
                lines.lines.as_ref().map_or(1.0, |own| own.multiple(harmonic) * own.frequency.get());
            found.push((format!("disturbance[{index}].lines.harmonics[{number}]"), multiple / TAU));
        }
    }
    let members = scenario.actuator.members();
    let unbalanced = members.iter().find_map(|member| member.kind.unbalanced_wheels());
    let imbalance = unbalanced.and_then(|wheels| wheels.imbalance.as_ref());
    if let (Some(imbalance), Ok(topic)) = (imbalance, log.columns(WHEELS)) {
        let orders = imbalance.harmonics.iter().map(|harmonic| harmonic.order.get());
        let orders: Vec<f64> = std::iter::once(1.0).chain(orders).collect();
        for (wheel, speed) in steady_speeds(&topic).into_iter().enumerate() {
            let Some(speed) = speed else { continue };
            let line = |order: &f64| (format!("wheel {}, order {order}", wheel + 1), order * speed / TAU);
            found.extend(orders.iter().map(line));
        }
    }
    let modes = scenario.model.frequencies().enumerate();
    found.extend(modes.map(|(mode, frequency)| (format!("mode {}", mode + 1), frequency / TAU)));
    found
}

/// Returns the mean speed of each wheel (rad/s); `None` of one whose speed changes.
fn steady_speeds(topic: &Columns) -> Vec<Option<f64>> {
    let Some(Column::Rows(counts, wheels)) = topic.get("wheels") else { return Vec::new() };
    let speeds = wheels.numbers("speed_rad_s").unwrap_or_default();
    let count = counts.first().map_or(0, |count| *count as usize);
    let of_wheel = |wheel: usize| {
        let own = || speeds.iter().skip(wheel).step_by(count).copied();
        let mean = own().sum::<f64>() / own().count().max(1) as f64;
        own().all(|speed| (speed - mean).abs() <= STEADY * mean.abs()).then_some(mean.abs())
    };
    (0..count).map(of_wheel).collect()
}
