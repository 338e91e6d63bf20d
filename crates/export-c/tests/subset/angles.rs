//! Second file of the sample: constants and functions that the first one imports.

/// Number of axes.
pub const AXES: usize = 3;

/// Half a turn (rad), computed from another constant.
pub const HALF_TURN: f64 = TURN * 0.5;

/// Turn (rad).
pub const TURN: f64 = core::f64::consts::TAU;

/// Gains, of which one is negative.
pub const GAINS: [f64; AXES] = [0.1, -2.5e-3, HALF_TURN / 3.0];

/// Frame of a vector.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// Fixed to the body.
    Body,
    /// Inertial.
    Inertial,
    /// Along the orbit.
    LocalOrbit,
}

/// Vector in a frame.
#[derive(Clone, Copy)]
pub struct FramedVector {
    /// Components (m).
    pub components: [f64; AXES],
    /// Frame of the components.
    pub frame: Frame,
}

impl FramedVector {
    /// Vector of zeros.
    pub const ZERO: FramedVector = FramedVector { components: [0.0; AXES], frame: Frame::Inertial };

    /// Returns the sum of the squared components (m²).
    #[must_use]
    pub fn squared(&self) -> f64 {
        let mut sum = 0.0;
        for i in 0..AXES {
            sum += self.components[i] * self.components[i];
        }
        sum
    }

    /// Multiplies the components by a factor.
    pub fn scale(&mut self, factor: f64) {
        for i in 0..self.components.len() {
            self.components[i] *= factor;
        }
    }

    /// Returns the vector with another first component (m).
    #[must_use]
    pub fn with_first(self, first: f64) -> Self {
        let mut changed = self;
        changed.components[0] = first;
        changed
    }

    /// Returns the name of the frame as a number.
    #[must_use]
    pub fn frame_number(&self) -> u32 {
        self.frame.number()
    }
}

impl Frame {
    /// Returns a number for each frame.
    #[must_use]
    pub fn number(self) -> u32 {
        match self {
            Self::Body => 7,
            Self::Inertial | Self::LocalOrbit => 9,
        }
    }
}

/// Returns the lesser number, the second of NaN.
#[inline(always)]
#[must_use]
pub fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[cfg(feature = "std")]
/// Dropped: the other one is translated.
pub fn halved(x: f64) -> f64 {
    x / 2.0
}

/// Returns a half.
#[cfg(not(feature = "std"))]
#[must_use]
pub fn halved(x: f64) -> f64 {
    0.5 * x
}

/// Adds a matrix's rows, weighted, to a vector.
pub fn add_rows(rows: &[[f64; 3]], weights: &[f64], sum: &mut [f64; 3]) {
    for i in 0..rows.len() {
        for j in 0..sum.len() {
            sum[j] += weights[i % weights.len()] * rows[i][j];
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn is_dropped() {
        assert!((super::halved(3.0) - 1.5).abs() < f64::EPSILON, "a closure: {:?}", Some(1).map(|x| x + 1));
    }
}
