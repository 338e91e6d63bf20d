//! Lock detection of a filter: lock is lost if the normalised innovations are too large, and regained only if they are
//! white.

use crate::square_root::sqrt;

/// Number of samples over which the innovations are judged.
const WINDOW: usize = 50;
/// Lock is lost if the sum over the window exceeds its mean by this factor. A body that leaves the ramp of its
/// frequencies causes three or four times the mean for a while, and the estimate is still useful.
const LOST: f64 = 10.0;
/// Lock is regained below the mean plus this number of standard deviations of a normal distribution.
const FOUND: f64 = 6.0;
/// Number of autocorrelations in the test for whiteness.
const LAGS: usize = 8;
/// Standard deviations of a normal above which innovations are not white; one window of white ones in a thousand
/// exceeds them.
const WHITE: f64 = 3.0;

/// Lock detector with the recent innovations.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FilterLock {
    /// Normalised squared innovation of each recent sample.
    pub squares: [f64; WINDOW],
    /// Sign of each of these innovations.
    pub signs: [f64; WINDOW],
    /// Index of the oldest one.
    pub oldest: usize,
    /// Number of recent samples.
    pub count: usize,
    /// Sum of the squares above which lock is lost.
    pub lost_above: f64,
    /// Sum of the squares below which lock is regained.
    pub found_below: f64,
    /// Limit of the squared autocorrelations, times the samples, of white noise.
    pub white: f64,
    /// True without lock.
    pub is_lost: bool,
}

/// Returns the quantile of chi-square that corresponds to a number of standard deviations above the mean of a normal.
fn quantile(degrees: f64, deviations: f64) -> f64 {
    // Wilson and Hilferty: the cube root of chi-square over its degrees of freedom is about normal.
    let spread: f64 = 2.0 / (9.0 * degrees);
    let root: f64 = 1.0 - spread + deviations * sqrt(spread);
    degrees * root * root * root
}

impl FilterLock {
    /// Returns the detector in lock, for a number of measurements per sample.
    pub fn new(measurements: u32) -> Self {
        let degrees: f64 = WINDOW as f64 * f64::from(measurements);
        Self {
            squares: [0.0; WINDOW],
            signs: [0.0; WINDOW],
            oldest: 0,
            count: 0,
            lost_above: LOST * degrees,
            found_below: quantile(degrees, FOUND),
            white: quantile(LAGS as f64, WHITE),
            is_lost: false,
        }
    }

    /// Returns the place of a recent sample, counted from the oldest one.
    #[inline]
    fn place(&self, index: usize) -> usize {
        (self.oldest + index) % WINDOW
    }

    /// Takes the normalised squared innovation and the innovation of a sample; `is_accepted` is false for a dropped measurement.
    pub fn update(&mut self, is_accepted: bool, square: f64, innovation: f64) {
        // A window of dropped measurements only is above the bound, a few dropped ones are not.
        let taken: f64 = if is_accepted { square } else { 2.0 * self.lost_above / WINDOW as f64 };
        let sign: f64 = if is_accepted { 1.0_f64.copysign(innovation) } else { 1.0 };
        let place: usize = self.place(self.count);
        self.squares[place] = taken;
        self.signs[place] = sign;
        if self.count < WINDOW {
            self.count += 1;
        } else {
            self.oldest = self.place(1);
        }
        if self.count == WINDOW {
            let bound: f64 = if self.is_lost { self.found_below } else { self.lost_above };
            let mut sum: f64 = 0.0;
            for index in 0..WINDOW {
                sum += self.squares[self.place(index)];
            }
            self.is_lost = sum > bound || self.is_lost && !self.is_white();
        }
    }

    /// Returns true if the innovations are white, by the Box-Pierce test on their signs, which is robust to outliers.
    ///
    /// A filter that fits other frequencies to a stuck sensor makes the innovations small but not white: a repeated
    /// reading has no noise.
    fn is_white(&self) -> bool {
        let mut squares: f64 = 0.0;
        for lag in 1..LAGS + 1 {
            let mut products: f64 = 0.0;
            for index in 0..WINDOW - lag {
                products += self.signs[self.place(index)] * self.signs[self.place(index + lag)];
            }
            squares += products * products;
        }
        squares <= self.white * WINDOW as f64
    }

    /// Declares lock lost for another reason; a whole window of good innovations is needed to regain it.
    pub fn lose(&mut self) {
        self.is_lost = true;
        self.oldest = 0;
        self.count = 0;
    }
}
