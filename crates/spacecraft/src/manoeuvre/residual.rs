//! Residual vibration after a manoeuvre, as planned and with other frequencies.

use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};

use super::modal_response::ModalResponse;
use super::{Plan, peak_search};

/// Relative uncertainty of the frequencies for which the residual is always reported.
pub const NEAR: f64 = 0.05;

/// Residual in a coordinate after the manoeuvre.
#[derive(Clone, Debug, PartialEq)]
pub struct FinalResidual {
    /// Name of the coordinate: `angle` is that of the hub, the others are outputs of the body.
    pub name: String,
    /// Unit of the coordinate.
    pub unit: String,
    /// Sum of the modes' amplitudes in the coordinate.
    pub nominal: f64,
    /// Largest sum of the amplitudes with all frequencies changed by at most 5 %.
    pub near: f64,
    /// Largest sum of the amplitudes with all frequencies changed by at most the band.
    pub worst: f64,
}

/// Coordinate with its name, its unit, and the weights of the modes' displacements in it.
pub struct ResidualCoordinate {
    pub name: String,
    pub unit: String,
    pub weights: Vec<f64>,
}

/// Returns the coordinates of a body: the hub's angle, then its outputs.
pub fn coordinates(body: &AxisModel) -> Vec<ResidualCoordinate> {
    let own = match body.drive {
        CommandedQuantity::Torque => 1.0,
        CommandedQuantity::Motion => 0.0,
    };
    let angle = ResidualCoordinate {
        name: "angle".to_owned(),
        unit: "rad".to_owned(),
        weights: vec![own; body.modes.len()],
    };
    let outputs = body.outputs.iter().map(|output| ResidualCoordinate {
        name: output.name.clone(),
        unit: output.unit.clone(),
        weights: output.modes.iter().map(|weight| weight.get()).collect(),
    });
    std::iter::once(angle).chain(outputs).collect()
}

/// Returns the sum of the modes' amplitudes in each coordinate after the manoeuvre, with all frequencies times
/// `factor`.
pub fn residual_amplitudes(
    plan: &Plan,
    body: &AxisModel,
    coordinates: &[ResidualCoordinate],
    factor: f64,
) -> Vec<f64> {
    let amplitudes = ModalResponse::new(body, &plan.waveform, factor).amplitudes(plan.time);
    let sum = |c: &ResidualCoordinate| c.weights.iter().zip(&amplitudes).map(|(w, a)| w.abs() * a).sum();
    coordinates.iter().map(sum).collect()
}

/// Computes the residual in each coordinate. Gains and weights are constant, and all frequencies vary by the same
/// factor.
///
/// As a function of that factor, an amplitude varies as fast as the fastest mode turns within the manoeuvre's time:
/// the largest one is found from samples that resolve every peak, and refined to rounding.
pub fn residuals(plan: &Plan, body: &AxisModel, band: f64) -> Vec<FinalResidual> {
    let coordinates = coordinates(body);
    let sums = |factor: f64| residual_amplitudes(plan, body, &coordinates, factor);
    let fastest = body.modes.iter().map(|mode| mode.frequency.get()).fold(0.0, f64::max);
    let step = peak_search::sampling(fastest * plan.time);
    let worst = |band: f64| -> Vec<f64> {
        let ends = [1.0 - band, 1.0 + band];
        let each = peak_search::largest_of_each(coordinates.len(), &ends, step, |_, factor| sums(factor));
        each.into_iter().map(|peak| peak.value).collect()
    };
    let (nominal, near, worst) = (sums(1.0), worst(NEAR), worst(band));
    let described = coordinates.into_iter().enumerate().map(|(i, c)| FinalResidual {
        name: c.name,
        unit: c.unit,
        nominal: nominal[i],
        near: near[i],
        worst: worst[i],
    });
    described.collect()
}
