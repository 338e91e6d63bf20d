//! Linear parts of a loop that cannot be read from a scenario's keys: sampled filters of the laws, and settled
//! estimators.

use flexsc_control::estimator::EstimateOutputs;
use flexsc_control::estimator::kalman::{FilterContext, Kalman, MeasurementFilter, SteadyStateFilter};
use flexsc_control::state_estimate::EstimateNeeds;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::random::Seed;
use serde::Serialize;

use super::linear_attitude_filter::LinearAttitudeFilter;
use flexsc_scenario::Scenario;

/// Linear filters and settled estimators of a loop.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinearLoop {
    /// Coefficients b0, b1, b2 and a1, a2 of each filter of the law about each axis, in the order in which they act.
    pub filters: Vec<Vec<([f64; 3], [f64; 2])>>,
    /// Estimator of each axis; none where the law reads the measurement.
    pub estimators: Option<Vec<LinearAxisEstimator>>,
    /// Attitude filter; none if the law reads no attitude filter.
    pub attitude: Option<LinearAttitudeFilter>,
}

/// Settled Kalman filter of one axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinearAxisEstimator {
    /// Kalman filter with its steady gain.
    #[serde(flatten)]
    pub steady: SteadyStateFilter,
    /// Moment of inertia (kg m²) by which a torque is divided to give its reduced moment.
    pub inertia: f64,
    /// True if the law reads the rigid motion instead of the hub's motion.
    pub rigid: bool,
    /// True if the rate is measured too.
    pub rate: bool,
}

impl LinearLoop {
    /// Returns the linear parts of a scenario whose laws are linear.
    ///
    /// # Errors
    /// An estimator that is not linear, or does not settle: its key, and the reason.
    pub fn from_scenario(scenario: &Scenario) -> Result<Self, ConfigError> {
        let axes = scenario.study.axes.len();
        let filters = (0..axes).map(|axis| scenario.law.about(axis).filter_coefficients()).collect();
        let reads = |axis: usize| scenario.law.about(axis).needs() == EstimateNeeds::DominantMode;
        let estimators = match &scenario.estimator {
            None => None,
            Some(estimator) if estimator.envelope().is_some() || estimator.is_assessed_only() => None,
            Some(estimator)
                if estimator.has_constant_gains()
                    && (0..axes).all(|axis| feeds(scenario, reads(axis)) == EstimateOutputs::Modes) =>
            {
                None
            }
            Some(estimator) => {
                if let Some(kalman) = estimator.kalman() {
                    let observers = (0..axes).map(|axis| observer(scenario, kalman, axis));
                    let estimators = Some(observers.collect::<Result<_, _>>()?);
                    return Ok(Self { filters, estimators, attitude: None });
                }
                if let Some(filter) = estimator.attitude() {
                    let parts = LinearAttitudeFilter::from_scenario(scenario, filter);
                    let attitude = Some(parts.map_err(|fault| fault.within("estimator.attitude"))?);
                    return Ok(Self { filters, estimators: None, attitude });
                }
                let why = "is no linear system with constant gains: a loop has `kalman`, `attitude`, or an estimator \
                           with `watch_only`";
                return Err(ConfigError::new(format!("estimator.{}", estimator.kind()), why));
            }
        };
        Ok(Self { filters, estimators, attitude: None })
    }
}

/// Returns the part of the state estimate that a scenario's estimator writes.
fn feeds(scenario: &Scenario, dominant: bool) -> EstimateOutputs {
    scenario.estimator.as_ref().map_or(EstimateOutputs::Modes, |estimator| estimator.feeds(dominant))
}

/// Returns the settled filter about an axis.
fn observer(scenario: &Scenario, kalman: &Kalman, axis: usize) -> Result<LinearAxisEstimator, ConfigError> {
    let fault = |why: &str| ConfigError::new("estimator.kalman", why);
    let known = scenario.estimator_context();
    let Some(period) = known.sampling else { return Err(fault("has no samples")) };
    let body = &known.axes[axis];
    let setting = FilterContext {
        body,
        back_emf: (known.back_emf.0 / body.inertia.get(), known.back_emf.1),
        period: period.seconds(),
        angle_noise: known.angle_noise,
        rate_noise: known.rate_noise[axis],
    };
    let draws = &mut Seed { scenario: scenario.seed, run: 0 }.stream("prior");
    let Some(steady) = kalman.filter(&setting, draws).steady_state() else {
        return Err(fault("has gains that do not settle: give it `moment_noise`"));
    };
    Ok(LinearAxisEstimator {
        steady,
        inertia: body.commanded_inertia(),
        rigid: feeds(scenario, false) == EstimateOutputs::Rigid,
        rate: setting.rate_noise.is_some(),
    })
}
