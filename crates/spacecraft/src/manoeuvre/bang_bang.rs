//! Bang-bang command: turns a rigid body with the smallest peak, full one way, then full the other.

use flexsc_dynamics::waveform::{Term, TermShape, Waveform};

use super::task::RestToRestTask;

/// Plans the bang-bang command: A before the switching, -A after it.
///
/// With P the impulse and E the excess travel over that of the mean command, A² T² - 4 E A - P² = 0 and the
/// switching is at T/2 + P/(2 A); of the two roots the larger has its switching within the time.
pub fn plan(task: &RestToRestTask) -> Waveform {
    let (t, p, e) = (task.time, task.impulse, task.excess_travel());
    let root = 2.0 * f64::sqrt(e * e + 0.25 * p * p * t * t);
    let sum = if e < 0.0 { 2.0 * e - root } else { 2.0 * e + root };
    let amplitude = sum / (t * t);
    if amplitude == 0.0 {
        return pieces(&[0.0, t], 0.0);
    }
    let switching = (0.5 * (t + p / amplitude)).clamp(0.0, t);
    if switching <= 0.0 {
        return pieces(&[0.0, t], -amplitude);
    }
    if switching >= t {
        return pieces(&[0.0, t], amplitude);
    }
    pieces(&[0.0, switching, t], amplitude)
}

/// Returns a command that is constant between the given times, `first` in the first interval, with a change of sign at
/// each time.
pub fn pieces(times: &[f64], first: f64) -> Waveform {
    let piece = |(index, ends): (usize, &[f64])| {
        let value = if index % 2 == 0 { first } else { -first };
        Term { from: ends[0], to: ends[1], shape: TermShape::Polynomial(vec![value]) }
    };
    Waveform { terms: times.windows(2).enumerate().map(piece).collect() }
}
