//! Metrics of lines of sight: their errors, their jitter, and the motion of their points and mirrors.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_record::{FineMirrorSample, LineOfSightAxis, LineOfSightSample};

use super::{
    MIRROR_LIMITED, MIRROR_PEAK, MetricValue, NamedMetric, POINT_DISPLACEMENT, SIGHT_JITTER, SIGHT_PEAK,
    SIGHT_RMS,
};
use flexsc_scenario::{LineOfSight, Scenario};

/// Collector of the samples of all lines of sight.
#[derive(Clone, Debug)]
pub struct LineOfSightMetrics(Vec<LineStatistics>);

/// Statistics of a line of sight.
#[derive(Clone, Debug)]
struct LineStatistics {
    line: LineOfSight,
    /// Sum of the squared errors (rad²), and the number of samples.
    square: (f64, u64),
    /// Largest error (rad) and displacement (m).
    peaks: [f64; 2],
    jitter: Option<JitterWindow>,
    /// Largest angle of the mirror (rad), and the time for which its command was limited (s).
    mirror: [f64; 2],
    /// Periods of the mirror to the first sample in which its command was limited.
    limited_before: u64,
}

/// Mean and deviations over windows of a fixed number of samples, by Welford's recurrence: small deviations from a large
/// mean keep their digits.
#[derive(Clone, Debug)]
struct JitterWindow {
    /// Number of samples in a window, and in the current one.
    samples: u64,
    count: u64,
    /// Mean of the current window (rad), and the sum of its squared deviations (rad²).
    mean: Vector,
    square: f64,
    /// Sum of the squared deviations of all whole windows (rad²), and the number of their samples.
    total: (f64, u64),
}

impl JitterWindow {
    fn new(samples: u64) -> Self {
        Self { samples, count: 0, mean: Vector::zeros(), square: 0.0, total: (0.0, 0) }
    }

    /// Adds an error (rad).
    fn add(&mut self, error: &Vector) {
        self.count += 1;
        let before = error - self.mean;
        self.mean += before / self.count as f64;
        self.square += before.dot(&(error - self.mean));
        if self.count == self.samples {
            let total = (self.total.0 + self.square, self.total.1 + self.count);
            *self = Self { total, ..Self::new(self.samples) };
        }
    }

    /// Returns the root mean square deviation (rad); NaN without a whole window.
    fn rms(&self) -> f64 {
        f64::sqrt(self.total.0 / self.total.1 as f64)
    }
}

impl LineOfSightMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let statistics = |line: &LineOfSight| LineStatistics {
            jitter: line.jitter_samples().map(JitterWindow::new),
            line: line.clone(),
            square: (0.0, 0),
            peaks: [f64::NAN; 2],
            mirror: [f64::NAN; 2],
            limited_before: 0,
        };
        Self(scenario.line_of_sight.iter().map(statistics).collect())
    }

    /// Records a sample.
    pub fn observe(&mut self, now: Instant, sample: &LineOfSightSample) {
        let Some(of) = self.0.get_mut(sample.line as usize) else { return };
        if !of.line.is_assessed(now.seconds()) {
            return;
        }
        let vector =
            |value_of: fn(&LineOfSightAxis) -> f64| Vector::from_iterator(sample.axes.iter().map(value_of));
        let (error, displacement) = (vector(|axis| axis.error_rad), vector(|axis| axis.displacement_m));
        of.square.0 += error.norm_squared();
        of.square.1 += 1;
        of.peaks = [of.peaks[0].max(sample.error_rad), of.peaks[1].max(displacement.norm())];
        if let Some(jitter) = &mut of.jitter {
            jitter.add(&error);
        }
    }

    /// Records a sample of a mirror.
    pub fn observe_mirror(&mut self, now: Instant, sample: &FineMirrorSample) {
        let Some(of) = self.0.get_mut(sample.line as usize) else { return };
        let period = of.line.mirror.map_or(0.0, |mirror| mirror.period.seconds());
        if of.line.is_assessed(now.seconds()) {
            if of.mirror[0].is_nan() {
                of.limited_before = sample.limited;
            }
            of.mirror[1] = (sample.limited - of.limited_before) as f64 * period;
            let angle = Vector::from_iterator(sample.axes.iter().map(|axis| axis.angle_rad)).norm();
            of.mirror[0] = of.mirror[0].max(angle);
        }
    }

    /// Returns the metrics of the run that has ended; empty without lines of sight.
    pub fn finish(self) -> Vec<NamedMetric> {
        if self.0.is_empty() {
            return Vec::new();
        }
        let list = |value_of: &dyn Fn(&LineStatistics) -> f64| {
            MetricValue::Numbers(self.0.iter().map(value_of).collect())
        };
        let mut metrics: Vec<NamedMetric> = vec![
            // Without samples the mean is 0/0: NaN.
            (&SIGHT_RMS, list(&|of| f64::sqrt(of.square.0 / of.square.1 as f64))),
            (&SIGHT_PEAK, list(&|of| of.peaks[0])),
            (&POINT_DISPLACEMENT, list(&|of| of.peaks[1])),
        ];
        if self.0.iter().any(|of| of.line.mirror.is_some()) {
            metrics.push((&MIRROR_PEAK, list(&|of| of.mirror[0])));
            metrics.push((&MIRROR_LIMITED, list(&|of| of.mirror[1])));
        }
        if self.0.iter().any(|of| of.jitter.is_some()) {
            let jitter = |of: &LineStatistics| of.jitter.as_ref().map_or(f64::NAN, JitterWindow::rms);
            metrics.insert(2, (&SIGHT_JITTER, list(&jitter)));
        }
        metrics
    }
}
