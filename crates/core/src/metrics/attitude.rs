//! Metrics of an attitude filter: its errors, and their consistency with its covariance (\[BarShalom01\]).

use flexsc_control::estimator::EstimatorKind;
use flexsc_numerics::time::Instant;
use flexsc_record::{AttitudeEstimate, AxisEstimate, ElasticEstimate, ElasticEstimates, Use};

use super::{
    ATTITUDE_ERROR, BIAS_ERROR, FREQUENCY_ERRORS, FREQUENCY_ESTIMATES, MetricDescription, MetricValue,
    NEES_MEAN, NIS_INSIDE, NIS_MEAN, NamedMetric,
};
use flexsc_scenario::Scenario;

/// Descriptions of the metrics.
pub(super) const METRICS: &[MetricDescription] =
    &[NEES_MEAN, NIS_MEAN, NIS_INSIDE, ATTITUDE_ERROR, BIAS_ERROR, FREQUENCY_ESTIMATES, FREQUENCY_ERRORS];

/// 95 % interval of chi-square with three degrees of freedom.
const INSIDE: [f64; 2] = [0.215_795_282_623_897_85, 9.348_403_604_496_148];
/// 95 % interval of chi-square with two degrees of freedom, times 3/2 as the NIS of a direction is: -3 ln 0.975 and -3
/// ln 0.025.
const INSIDE_OF_TWO: [f64; 2] = [0.075_953_423_952_869_69, 11.066_638_362_341_81];

/// Collector of the samples of an attitude filter.
#[derive(Clone, Debug)]
pub struct AttitudeMetrics {
    assess: [f64; 2],
    /// True if the filter is custom, from a program.
    own: bool,
    /// Number of samples, and number of those that measured the attitude.
    count: (u64, u64),
    nees: f64,
    nis: f64,
    inside: u64,
    /// Sums of the squared errors of attitude (rad²) and bias (rad²/s²).
    squares: [f64; 2],
    /// Modes after the last sample, for a filter that identifies their frequencies.
    identified: Option<Vec<ElasticEstimate>>,
}

impl AttitudeMetrics {
    /// Creates an empty collector for runs of a scenario with an attitude filter, or with a custom one, which may
    /// estimate an attitude; `None` for others.
    pub fn new(scenario: &Scenario) -> Option<Self> {
        let estimator = scenario.estimator.as_ref();
        let own = |of: &EstimatorKind| of.custom().is_some() && scenario.axis_count() == 3;
        let filter = estimator.filter(|estimator| estimator.attitude().is_some() || own(estimator))?;
        let assess = filter.assess();
        Some(Self {
            assess,
            own: own(filter),
            count: (0, 0),
            nees: 0.0,
            nis: 0.0,
            inside: 0,
            squares: [0.0; 2],
            identified: filter
                .attitude()
                .and_then(|filter| filter.elastic.as_ref())
                .and_then(|elastic| elastic.identifies().then(Vec::new)),
        })
    }

    /// Returns true if the estimate at the sample of an instant is assessed, or its modes are needed.
    pub fn wants_estimates(&self, now: Instant) -> bool {
        self.is_assessed(now) || self.identified.is_some()
    }

    fn is_assessed(&self, now: Instant) -> bool {
        let [from, to] = self.assess;
        (from..=to).contains(&now.seconds())
    }

    /// Records the filter's estimate at a sample.
    pub fn observe(&mut self, now: Instant, estimate: &AttitudeEstimate) {
        if !self.is_assessed(now) {
            return;
        }
        self.count.0 += 1;
        self.nees += estimate.nees;
        let errors: [fn(&AxisEstimate) -> f64; 2] =
            [|axis| axis.angle_error_rad, |axis| axis.bias_error_rad_s];
        for (sum, error) in self.squares.iter_mut().zip(errors) {
            *sum += estimate.axes.iter().map(|axis| error(axis) * error(axis)).sum::<f64>();
        }
        if estimate.measured == Use::Used {
            self.count.1 += 1;
            self.nis += estimate.nis;
            let [low, high] = if estimate.numbers == 2 { INSIDE_OF_TWO } else { INSIDE };
            self.inside += u64::from((low..=high).contains(&(estimate.nis * AttitudeEstimate::MEASUREMENTS)));
        }
    }

    /// Records the filter's estimates of the modes after a sample.
    pub fn observe_modes(&mut self, estimates: &ElasticEstimates) {
        if let Some(identified) = &mut self.identified {
            identified.clone_from(&estimates.modes);
        }
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(self) -> Vec<NamedMetric> {
        // Without samples the means are 0/0: NaN.
        let (all, measured) = (self.count.0 as f64, self.count.1 as f64);
        let [attitude, bias] = self.squares.map(|sum| MetricValue::Number(f64::sqrt(sum / all)));
        if self.own && self.count.0 == 0 {
            return Vec::new();
        }
        let mut reported = vec![
            (&NEES_MEAN, MetricValue::Number(self.nees / all)),
            (&NIS_MEAN, MetricValue::Number(self.nis / measured)),
            (&NIS_INSIDE, MetricValue::Number(self.inside as f64 / measured)),
            (&ATTITUDE_ERROR, attitude),
            (&BIAS_ERROR, bias),
        ];
        if let Some(last) = self.identified {
            let list = |value_of: &dyn Fn(&ElasticEstimate) -> f64| {
                MetricValue::Numbers(last.iter().map(value_of).collect())
            };
            reported.push((
                &FREQUENCY_ESTIMATES,
                list(&|estimate| estimate.frequency_rad_s / std::f64::consts::TAU),
            ));
            reported.push((
                &FREQUENCY_ERRORS,
                list(&|estimate| estimate.frequency_rad_s / estimate.true_frequency_rad_s - 1.0),
            ));
        }
        reported
    }
}
