//! Filters of the rigid rates of a control system: measured rates in, estimated rates out.

use flexsc_core::Scenario;
use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_flight::rigid_rate::RigidRateFilter;

use super::{CallLayout, Channel, WordReader};

/// Filter of the rigid rate about each axis.
#[derive(Clone, Debug)]
pub struct RateUnit {
    /// Filters.
    pub axes: Vec<RigidRateFilter>,
}

impl RateUnit {
    /// Returns the filters of a scenario; `None` with another estimator.
    pub(super) fn new(scenario: &Scenario, axes: usize) -> Option<Self> {
        let Some(EstimatorKind::RigidRate(spec)) = &scenario.estimator else { return None };
        Some(Self { axes: (0..axes).map(|axis| spec.flight_filter(axis)).collect() })
    }

    /// Returns the function: a sample of the sensors.
    pub(super) fn layout(&self) -> CallLayout {
        let axes = self.axes.len();
        let about = "Change of the rate about each axis by the pulses since the sample before (rad/s)";
        CallLayout {
            inputs: vec![
                Channel::flag("is_measured", "True if there is a measurement", 1),
                Channel::real("rate", "Measured rate about each axis (rad/s)", axes, 1e-3),
                Channel::real("rate_change", about, axes, 1e-5),
            ],
            outputs: vec![Channel::from_quantity(FlightQuantity::Rate, axes, 1.0)],
            ..CallLayout::new("sample", "Takes a sample of the measured rates.")
        }
    }

    /// Takes a sample, and returns the words of the outputs.
    pub(super) fn sample(&mut self, inputs: &[u64]) -> Vec<u64> {
        let (mut words, axes) = (WordReader::new(inputs), self.axes.len());
        let (is_measured, rates, changes) = (words.flag(), words.list(axes), words.list(axes));
        for ((filter, rate), change) in self.axes.iter_mut().zip(rates).zip(changes) {
            filter.take(is_measured, rate, change);
        }
        self.axes.iter().map(|filter| filter.rate.to_bits()).collect()
    }
}
