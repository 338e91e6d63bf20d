//! Quality of an observer: its innovations relative to its estimate of the elastic rate.

/// Weight of a sample in a mean: about 50 samples count.
const WEIGHT: f64 = 0.02;

/// Moving means of squares ((rad/s)²): exponential, over about 50 samples.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct MovingResidual {
    /// Mean square of the innovation, the measured rate minus the predicted one.
    pub innovation: f64,
    /// Mean square of the estimated elastic rate, summed over the modes.
    pub elastic: f64,
}

impl MovingResidual {
    /// Updates the means with the innovation (rad/s) of a sample, `None` if it was dropped, and the elastic rate
    /// (rad/s).
    pub(super) fn update(&mut self, innovation: Option<f64>, elastic: f64) {
        // Without a measurement, the estimate may be wrong by its full value.
        let innovation = innovation.unwrap_or(elastic);
        self.innovation += WEIGHT * (innovation * innovation - self.innovation);
        self.elastic += WEIGHT * (elastic * elastic - self.elastic);
    }

    /// Returns true if laws may act on the elastic rate: in mean square, the innovations are below a share of it, or
    /// below a floor (rad/s).
    pub fn is_below(&self, share: f64, floor: f64) -> bool {
        self.innovation < share * self.elastic + floor * floor
    }
}
