//! Settling of the angle: the settling time of the papers, and measures that are smooth in the parameters.

use serde::Serialize;

use super::ClosedLoop;

/// Settling band, and horizon of the evaluation.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SettlingWindow {
    /// Half width of the band (rad).
    pub band: f64,
    /// Horizon (s): longer than any settling time of interest.
    pub horizon: f64,
}

/// Settling measures of a loop.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct Settling {
    /// Time of the last sample outside the band (s), 0 if there is none: T_r of the papers. None if the last sample of
    /// the horizon is outside: the loop has not settled.
    pub time_s: Option<f64>,
    /// Time at which a straight line from the last sample outside to the next enters the band (s): free of the samples'
    /// steps.
    pub crossing_s: Option<f64>,
    /// Integral of time times |angle| over the horizon (rad s²): smooth in the parameters, where the settling time
    /// jumps by half a period whenever a swing touches the band.
    pub itae_rad_s2: f64,
}

impl SettlingWindow {
    /// Returns the number of samples within the horizon, its ends included.
    pub fn samples(&self, period: f64) -> usize {
        // A sample at the horizon itself counts in spite of rounding.
        libm::floor(self.horizon / period * (1.0 + 1e-12)) as usize + 1
    }
}

impl ClosedLoop {
    /// Returns the settling measures of the loop, from the angle at its samples.
    pub fn settle(&self, window: SettlingWindow) -> Settling {
        let count = window.samples(self.period);
        let SettlingWindow { band, .. } = window;
        let (mut index, mut outside) = (0_usize, None);
        let (mut weighted, mut before, mut entry) = (0.0, 0.0_f64, 0.0);
        self.for_each_angle(count, |angle| {
            let size = angle.abs();
            weighted += index as f64 * size;
            // NaN is outside the band.
            if size <= band {
                if outside == Some(index.wrapping_sub(1)) {
                    entry = (before - band) / (before - size);
                }
            } else {
                outside = Some(index);
            }
            before = size;
            index += 1;
        });
        let settled = outside.is_none_or(|last| last + 1 < count);
        let time_at =
            |part: f64| settled.then(|| outside.map_or(0.0, |last| (last as f64 + part) * self.period));
        Settling {
            time_s: time_at(0.0),
            crossing_s: time_at(entry),
            itae_rad_s2: weighted * self.period * self.period,
        }
    }
}
