//! Whether a filter still follows the body: its innovations, squared and weighed, stay in their chi-square band.

/// Samples over which the innovations are judged.
const WINDOW: usize = 50;
/// How far above its mean a sum of the window may lie, in standard deviations of a normal: one in 10^9 lies above.
const DEVIATIONS: f64 = 6.0;

/// The innovations of late.
#[derive(Clone, Debug)]
pub struct Lock {
    /// NIS of each sample, the oldest at `next`.
    recent: Vec<f64>,
    next: usize,
    /// No sum over the window is larger as long as the filter follows.
    largest: f64,
    /// What a dropped measurement counts.
    dropped: f64,
}

impl Lock {
    /// A filter that follows so far, with so many measurements in each sample.
    pub fn new(measurements: usize) -> Self {
        let degrees = (WINDOW * measurements) as f64;
        // Wilson and Hilferty: the cube root of chi-square over its degrees of freedom is about normal.
        let spread = 2.0 / (9.0 * degrees);
        let root = 1.0 - spread + DEVIATIONS * libm::sqrt(spread);
        let largest = degrees * root * root * root;
        // A window of nothing but dropped measurements is above the band, a few of them are not.
        let dropped = 2.0 * largest / WINDOW as f64;
        Self { recent: Vec::with_capacity(WINDOW), next: 0, largest, dropped }
    }

    /// Takes the NIS of a sample, or none for a dropped measurement, and says whether the filter follows.
    pub fn follows(&mut self, nis: Option<f64>) -> bool {
        let nis = nis.unwrap_or(self.dropped);
        if self.recent.len() < WINDOW {
            self.recent.push(nis);
        } else {
            self.recent[self.next] = nis;
            self.next = (self.next + 1) % WINDOW;
        }
        self.recent.len() < WINDOW || self.recent.iter().sum::<f64>() <= self.largest
    }
}
