//! How well an observer follows: its innovations beside its estimate of the elastic rate.

/// What a sample weighs in a mean: the last 50 count.
const WEIGHT: f64 = 0.02;

/// Moving means of squares ((rad/s)²): exponential, over about 50 samples.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct MovingResidual {
    /// Of the innovation, the measured rate less the predicted one.
    pub innovation: f64,
    /// Of the estimated elastic rate, all modes together.
    pub elastic: f64,
}

impl MovingResidual {
    /// Takes the innovation (rad/s) of a sample, or none for one that was dropped, and the elastic rate (rad/s).
    pub(super) fn take(&mut self, innovation: Option<f64>, elastic: f64) {
        // An estimate that nothing confirms may be wrong by all of itself.
        let innovation = innovation.unwrap_or(elastic);
        self.innovation += WEIGHT * (innovation * innovation - self.innovation);
        self.elastic += WEIGHT * (elastic * elastic - self.elastic);
    }

    /// Whether the elastic rate may be acted on: the innovations are less than a share of it, or than a floor (rad/s), in
    /// mean square.
    pub fn is_small(&self, share: f64, floor: f64) -> bool {
        self.innovation < share * self.elastic + floor * floor
    }
}
