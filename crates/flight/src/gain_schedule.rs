//! Gain that depends on the estimated frequency of a mode: linear between points, constant before the first and after the last.

/// Point of a schedule.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SchedulePoint {
    /// Frequency of the mode (rad/s).
    pub frequency: f64,
    /// Gain at that frequency.
    pub gain: f64,
}

/// Returns the gain at a frequency (rad/s), for points in the order of their frequencies; 0 without points.
pub fn scheduled_gain(points: &[SchedulePoint], frequency: f64) -> f64 {
    let count: usize = points.len();
    let mut after: usize = 0;
    while after < count && points[after].frequency <= frequency {
        after += 1;
    }
    if count == 0 {
        return 0.0;
    }
    if after == 0 {
        return points[0].gain;
    }
    if after == count {
        return points[count - 1].gain;
    }
    let low: SchedulePoint = points[after - 1];
    let high: SchedulePoint = points[after];
    low.gain + (high.gain - low.gain) * (frequency - low.frequency) / (high.frequency - low.frequency)
}
