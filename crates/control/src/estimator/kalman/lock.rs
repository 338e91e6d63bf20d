//! Whether a filter follows the body: its innovations, squared and weighed, are about what it expects, and to follow again
//! they must be white.

use std::collections::VecDeque;

/// Samples over which the innovations are judged.
const WINDOW: usize = 50;
/// Above so many times its mean, the sum over the window shows that the filter has lost the body. A body that leaves the
/// ramp of its frequencies brings three or four times the mean for a while, and the estimate is still of use.
const LOST: f64 = 10.0;
/// Below so many standard deviations of a normal above the mean, it follows again.
const FOUND: f64 = 6.0;
/// How many autocorrelations tell whether the innovations are white.
const LAGS: usize = 8;
/// Above so many standard deviations of a normal they are not. Of white innovations one window in a thousand is.
const WHITE: f64 = 3.0;

/// The innovations of late.
#[derive(Clone, Debug)]
pub struct Lock {
    /// NIS of each sample, and the sign of its innovation, the oldest first.
    recent: VecDeque<(f64, f64)>,
    /// Above the first the filter is lost, below the second it follows again.
    bounds: [f64; 2],
    /// Up to this the squared autocorrelations, times the samples, are those of white noise.
    white: f64,
    lost: bool,
}

/// The quantile of chi-square that lies so many standard deviations of a normal above its mean.
fn quantile(degrees: f64, deviations: f64) -> f64 {
    // Wilson and Hilferty: the cube root of chi-square over its degrees of freedom is about normal.
    let spread = 2.0 / (9.0 * degrees);
    let root = 1.0 - spread + deviations * f64::sqrt(spread);
    degrees * root * root * root
}

impl Lock {
    /// A filter that follows so far, with so many measurements in each sample.
    pub fn new(measurements: usize) -> Self {
        let degrees = (WINDOW * measurements) as f64;
        Self {
            recent: VecDeque::with_capacity(WINDOW),
            bounds: [LOST * degrees, quantile(degrees, FOUND)],
            white: quantile(LAGS as f64, WHITE),
            lost: false,
        }
    }

    /// Takes the NIS of a sample and its innovation, or none for a dropped measurement.
    pub fn take(&mut self, told: Option<(f64, f64)>) {
        // A window of nothing but dropped measurements is above the band, a few of them are not.
        let (nis, innovation) = told.unwrap_or((2.0 * self.bounds[0] / WINDOW as f64, 0.0));
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

    /// Whether no innovation tells of the next ones, by the test of Box and Pierce on their signs, which no outlier sways.
    ///
    /// A filter that fits other frequencies to a sensor that sticks makes the innovations small, but never white: what
    /// repeats itself has no noise.
    fn is_white(&self) -> bool {
        let products = |lag: usize| -> f64 {
            self.recent.iter().zip(self.recent.iter().skip(lag)).map(|(a, b)| a.1 * b.1).sum()
        };
        let squares: f64 = (1..=LAGS).map(|lag| products(lag) * products(lag)).sum();
        squares <= self.white * WINDOW as f64
    }

    /// The filter has lost the body for another reason: it has to prove itself over a whole window.
    pub fn lose(&mut self) {
        self.lost = true;
        self.recent.clear();
    }

    /// Whether the filter has lost the body.
    pub fn is_lost(&self) -> bool {
        self.lost
    }
}
