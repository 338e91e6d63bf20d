//! Natural frequencies of a body with the hub free and with the hub held, for modes of either kind.

use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_formats::structure::eigenvalues;
use nalgebra::DMatrix;

/// Returns the natural frequencies (rad/s) of the body that turns freely. With a commanded torque they are those of
/// the modes; with a commanded motion, increasing, and `None` if the gains add up to 1 or more, because no such
/// body exists.
pub fn free_frequencies(body: &AxisModel) -> Option<Vec<f64>> {
    match body.drive {
        CommandedQuantity::Torque => Some(frequencies(body)),
        CommandedQuantity::Motion => other_frequencies(body, -1.0),
    }
}

/// Returns the natural frequencies (rad/s) of the body whose hub is held. With a commanded motion they are those of
/// the modes; with a commanded torque, increasing, and `None` if a gain is negative, because no such body exists.
pub fn clamped_frequencies(body: &AxisModel) -> Option<Vec<f64>> {
    match body.drive {
        CommandedQuantity::Torque => other_frequencies(body, 1.0),
        CommandedQuantity::Motion => Some(frequencies(body)),
    }
}

fn frequencies(body: &AxisModel) -> Vec<f64> {
    body.modes.iter().map(|mode| mode.frequency.get()).collect()
}

/// Returns the natural frequencies for the other state of the hub: held for `sign` 1, free for `sign` -1.
///
/// With a held hub, m = -sum x_i''; with a free one, the torque J (m - sum x_i'') vanishes. In z_i =
/// x_i/sqrt(k_i) the modes are then those of (1 + sign s s') z'' + W² z = 0 with s_i = sqrt(k_i), whose inverse
/// squares are the eigenvalues of W⁻¹ (1 + sign s s') W⁻¹.
fn other_frequencies(body: &AxisModel, sign: f64) -> Option<Vec<f64>> {
    let gains = body.modes.iter().map(|mode| mode.hub_gain.get());
    if gains.clone().any(|gain| gain < 0.0) || (sign < 0.0 && gains.clone().sum::<f64>() >= 1.0) {
        return None;
    }
    let inverse: Vec<f64> = body.modes.iter().map(|mode| 1.0 / mode.frequency.get()).collect();
    let scaled_gains: Vec<f64> =
        gains.zip(&inverse).map(|(gain, inverse)| f64::sqrt(gain) * inverse).collect();
    let matrix = DMatrix::from_fn(scaled_gains.len(), scaled_gains.len(), |i, j| {
        let own = if i == j { inverse[i] * inverse[i] } else { 0.0 };
        own + sign * scaled_gains[i] * scaled_gains[j]
    });
    let squares = eigenvalues(&matrix)?;
    squares.iter().rev().map(|square| (*square > 0.0).then(|| 1.0 / f64::sqrt(*square))).collect()
}
