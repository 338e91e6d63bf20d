//! Whether a filter follows the body: its innovations, squared and weighed, are about what it expects.

/// Samples over which the innovations are judged.
const WINDOW: usize = 50;
/// Above so many times its mean, the sum over the window tells that the filter has lost the body. A body that leaves the
/// ramp of its frequencies brings three or four times the mean for a while, and the estimate is still of use.
const LOST: f64 = 10.0;
/// Below so many standard deviations of a normal above the mean, it follows again.
const FOUND: f64 = 6.0;

/// The innovations of late.
#[derive(Clone, Debug)]
pub struct Lock {
    /// NIS of each sample, the oldest at `next`.
    recent: Vec<f64>,
    next: usize,
    /// Above the first the filter is lost, below the second it follows again.
    bounds: [f64; 2],
    lost: bool,
}

impl Lock {
    /// A filter that follows so far, with so many measurements in each sample.
    pub fn new(measurements: usize) -> Self {
        let degrees = (WINDOW * measurements) as f64;
        // Wilson and Hilferty: the cube root of chi-square over its degrees of freedom is about normal.
        let spread = 2.0 / (9.0 * degrees);
        let quantile = |deviations: f64| {
            let root = 1.0 - spread + deviations * libm::sqrt(spread);
            degrees * root * root * root
        };
        Self {
            recent: Vec::with_capacity(WINDOW),
            next: 0,
            bounds: [LOST * degrees, quantile(FOUND)],
            lost: false,
        }
    }

    /// Takes the NIS of a sample, or none for a dropped measurement.
    pub fn take(&mut self, nis: Option<f64>) {
        // A window of nothing but dropped measurements is above the band, a few of them are not.
        let nis = nis.unwrap_or(2.0 * self.bounds[0] / WINDOW as f64);
        if self.recent.len() < WINDOW {
            self.recent.push(nis);
        } else {
            self.recent[self.next] = nis;
            self.next = (self.next + 1) % WINDOW;
        }
        if self.recent.len() == WINDOW {
            let bound = self.bounds[usize::from(self.lost)];
            self.lost = self.recent.iter().sum::<f64>() > bound;
        }
    }

    /// The filter has lost the body for another reason: it has to prove itself over a whole window.
    pub fn lose(&mut self) {
        self.lost = true;
        self.recent.clear();
        self.next = 0;
    }

    /// Whether the filter has lost the body.
    pub fn is_lost(&self) -> bool {
        self.lost
    }
}
