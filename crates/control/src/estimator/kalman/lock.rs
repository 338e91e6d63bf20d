//! Lock detection of a filter: lock is lost if the normalised innovations are too large, and regained only if they are
//! white.

use std::collections::VecDeque;

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
#[derive(Clone, Debug)]
pub struct Lock {
    /// NIS of each sample, and the sign of its innovation; the oldest first.
    recent: VecDeque<(f64, f64)>,
    /// Sum of NIS above which lock is lost, and below which it is regained.
    bounds: [f64; 2],
    /// Limit of the squared autocorrelations, times the samples, of white noise.
    white: f64,
    lost: bool,
}

/// Returns the quantile of chi-square that corresponds to `deviations` standard deviations above the mean of a normal.
fn quantile(degrees: f64, deviations: f64) -> f64 {
    // Wilson and Hilferty: the cube root of chi-square over its degrees of freedom is about normal.
    let spread = 2.0 / (9.0 * degrees);
    let root = 1.0 - spread + deviations * f64::sqrt(spread);
    degrees * root * root * root
}

impl Lock {
    /// Creates the detector in lock, for `measurements` measurements per sample.
    pub fn new(measurements: usize) -> Self {
        let degrees = (WINDOW * measurements) as f64;
        Self {
            recent: VecDeque::with_capacity(WINDOW),
            bounds: [LOST * degrees, quantile(degrees, FOUND)],
            white: quantile(LAGS as f64, WHITE),
            lost: false,
        }
    }

    /// Updates the detector with NIS and innovation of a sample, or with `None` for a dropped measurement.
    pub fn update(&mut self, innovation: Option<(f64, f64)>) {
        // A window of dropped measurements only is above the bound, a few dropped ones are not.
        let (nis, innovation) = innovation.unwrap_or((2.0 * self.bounds[0] / WINDOW as f64, 0.0));
        if self.recent.len() == WINDOW {
            self.recent.pop_front();
        }
        self.recent.push_back((nis, innovation.signum()));
        if self.recent.len() == WINDOW {
            let bound = self.bounds[usize::from(self.lost)];
            let above = self.recent.iter().map(|(nis, _)| nis).sum::<f64>() > bound;
            self.lost = above || self.lost && !self.is_white();
        }
    }

    /// Returns true if the innovations are white, by the Box-Pierce test on their signs, which is robust to outliers.
    ///
    /// A filter that fits other frequencies to a stuck sensor makes the innovations small but not white: a repeated
    /// reading has no noise.
    fn is_white(&self) -> bool {
        let products = |lag: usize| -> f64 {
            self.recent.iter().zip(self.recent.iter().skip(lag)).map(|(a, b)| a.1 * b.1).sum()
        };
        let squares: f64 = (1..=LAGS).map(|lag| products(lag) * products(lag)).sum();
        squares <= self.white * WINDOW as f64
    }

    /// Declares lock lost for another reason; a whole window of good innovations is needed to regain it.
    pub fn lose(&mut self) {
        self.lost = true;
        self.recent.clear();
    }

    /// Returns true if the filter has lost lock.
    pub fn is_lost(&self) -> bool {
        self.lost
    }
}
