//! What the modes still do after a manoeuvre, as planned and with other frequencies.

use super::history::ModalHistory;
use super::{Plan, extremum};
use crate::body::{Drive, Planar};

/// The band that is always reported.
pub const NEAR: f64 = 0.05;

/// What is left in a coordinate after the manoeuvre.
#[derive(Clone, Debug, PartialEq)]
pub struct FinalResidual {
    /// Name of the coordinate: `angle` is the hub's, the others are outputs of the body.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The sum of the modes' amplitudes in the coordinate.
    pub nominal: f64,
    /// The largest such sum with all frequencies off by at most 5 %.
    pub near: f64,
    /// The largest such sum with all frequencies off by at most the band.
    pub worst: f64,
}

/// A coordinate: its name, its unit, and the weights of the modes' displacements in it.
pub struct Coordinate {
    pub name: String,
    pub unit: String,
    pub weights: Vec<f64>,
}

/// The coordinates of a body: the hub's angle, then its outputs.
pub fn coordinates(body: &Planar) -> Vec<Coordinate> {
    let own = match body.drive {
        Drive::Torque => 1.0,
        Drive::Motion => 0.0,
    };
    let angle =
        Coordinate { name: "angle".to_owned(), unit: "rad".to_owned(), weights: vec![own; body.modes.len()] };
    let outputs = body.outputs.iter().map(|output| Coordinate {
        name: output.name.clone(),
        unit: output.unit.clone(),
        weights: output.modes.iter().map(|weight| weight.get()).collect(),
    });
    std::iter::once(angle).chain(outputs).collect()
}

/// The sum of the modes' amplitudes in each coordinate after the manoeuvre, with all frequencies times a factor.
pub fn left(plan: &Plan, body: &Planar, coordinates: &[Coordinate], factor: f64) -> Vec<f64> {
    let amplitudes = ModalHistory::new(body, &plan.waveform, factor).amplitudes(plan.time);
    let sum = |c: &Coordinate| c.weights.iter().zip(&amplitudes).map(|(w, a)| w.abs() * a).sum();
    coordinates.iter().map(sum).collect()
}

/// What is left in each coordinate. Gains and weights stay as they are while the frequencies move together.
///
/// Over the factor of the frequencies, an amplitude turns as fast as the fastest mode does within the manoeuvre's time: the
/// largest one is found as that of a motion is, on samples that no crest falls between, and refined to rounding.
pub fn residuals(plan: &Plan, body: &Planar, band: f64) -> Vec<FinalResidual> {
    let coordinates = coordinates(body);
    let sums = |factor: f64| left(plan, body, &coordinates, factor);
    let fastest = body.modes.iter().map(|mode| mode.frequency.get()).fold(0.0, f64::max);
    let step = extremum::sampling(fastest * plan.time);
    let worst = |band: f64| -> Vec<f64> {
        let ends = [1.0 - band, 1.0 + band];
        let each = extremum::largest_of(coordinates.len(), &ends, step, |_, factor| sums(factor));
        each.into_iter().map(|peak| peak.value).collect()
    };
    let (nominal, near, worst) = (sums(1.0), worst(NEAR), worst(band));
    let told = coordinates.into_iter().enumerate().map(|(i, c)| FinalResidual {
        name: c.name,
        unit: c.unit,
        nominal: nominal[i],
        near: near[i],
        worst: worst[i],
    });
    told.collect()
}
