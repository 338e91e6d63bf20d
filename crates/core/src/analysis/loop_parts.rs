//! Linear parts of a loop that cannot be read from a scenario's keys: sampled filters of the laws, and settled
//! estimators.

use serde::Serialize;

use super::attitude_parts::AttitudeParts;
use crate::belief::Reads;
use crate::document::Fault;
use crate::estimator::kalman::{Kalman, KalmanSetting, Steady};
use crate::estimator::{Estimator, Feeds};
use crate::law::Law;
use crate::random::Seed;
use crate::scenario::Scenario;

/// Linear filters and settled estimators of a loop.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoopParts {
    /// Coefficients b0, b1, b2 and a1, a2 of each filter of the law about each axis, in the order in which they act.
    pub filters: Vec<Vec<([f64; 3], [f64; 2])>>,
    /// Estimator of each axis; none where the law reads the measurement.
    pub estimators: Option<Vec<AxisEstimator>>,
    /// Attitude filter; none if the law reads no attitude filter.
    pub attitude: Option<AttitudeParts>,
}

/// Settled Kalman filter of one axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AxisEstimator {
    /// Kalman filter with its steady gain.
    #[serde(flatten)]
    pub steady: Steady,
    /// Moment of inertia (kg m²) by which a torque is divided to give its reduced moment.
    pub inertia: f64,
    /// True if the law reads the rigid motion instead of the hub's motion.
    pub rigid: bool,
    /// True if the rate is measured too.
    pub rate: bool,
}

impl LoopParts {
    /// Returns the linear parts of a scenario whose laws are linear.
    ///
    /// # Errors
    /// An estimator that is not linear, or does not settle: its key, and the reason.
    pub fn of(scenario: &Scenario) -> Result<Self, Fault> {
        if let Some(fault) = scenario.unlike_loops() {
            return Err(fault);
        }
        let axes = scenario.study.axes.len();
        let filters = (0..axes).map(|axis| filters(scenario.law.about(axis))).collect();
        let reads = |axis: usize| scenario.law.about(axis).reads() == Reads::DominantMode;
        let estimators = match &scenario.estimator {
            None | Some(Estimator::Envelope(_)) => None,
            Some(estimator) if estimator.watches_only() => None,
            Some(Estimator::Kalman(_) | Estimator::Truth(_))
                if (0..axes).all(|axis| feeds(scenario, reads(axis)) == Feeds::Modes) =>
            {
                None
            }
            Some(Estimator::Kalman(kalman)) => {
                Some((0..axes).map(|axis| observer(scenario, kalman, axis)).collect::<Result<_, _>>()?)
            }
            Some(estimator) => {
                if let Some(filter) = estimator.attitude() {
                    let parts = AttitudeParts::of(scenario, filter);
                    let attitude = Some(parts.map_err(|fault| fault.within("estimator.attitude"))?);
                    return Ok(Self { filters, estimators: None, attitude });
                }
                let why = "is no linear system with constant gains: a loop has `kalman`, `attitude`, or an estimator \
                           with `watch_only`";
                return Err(Fault::new(format!("estimator.{}", estimator.kind()), why));
            }
        };
        Ok(Self { filters, estimators, attitude: None })
    }
}

/// Returns the part of the state estimate that a scenario's estimator writes.
fn feeds(scenario: &Scenario, dominant: bool) -> Feeds {
    scenario.estimator.as_ref().map_or(Feeds::Modes, |estimator| estimator.feeds(dominant))
}

/// Returns the coefficients of the filters of a law.
fn filters(law: &Law) -> Vec<([f64; 3], [f64; 2])> {
    let Law::Attitude(law) = law else { return Vec::new() };
    let period = law.period.seconds();
    law.filters.iter().filter_map(|filter| Some(filter.sampled(period).ok()?.coefficients())).collect()
}

/// Returns the settled filter about an axis.
fn observer(scenario: &Scenario, kalman: &Kalman, axis: usize) -> Result<AxisEstimator, Fault> {
    let fault = |why: &str| Fault::new("estimator.kalman", why);
    let known = scenario.known();
    let Some(period) = known.sampling else { return Err(fault("has no samples")) };
    let body = &known.axes[axis];
    let setting = KalmanSetting {
        body,
        back_emf: (known.back_emf.0 / body.inertia.get(), known.back_emf.1),
        period: period.seconds(),
        angle_noise: known.angle_noise,
        rate_noise: known.rate_noise[axis],
    };
    let draws = &mut Seed { scenario: scenario.seed, run: 0 }.stream("prior");
    let Some(steady) = kalman.filter(&setting, draws).steady() else {
        return Err(fault("has gains that do not settle: give it `moment_noise`"));
    };
    Ok(AxisEstimator {
        steady,
        inertia: body.commanded_inertia(),
        rigid: feeds(scenario, false) == Feeds::Rigid,
        rate: setting.rate_noise.is_some(),
    })
}
