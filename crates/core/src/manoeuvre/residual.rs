//! What the modes still do after a manoeuvre, as planned and with other frequencies.

use super::Plan;
use super::history::History;
use crate::body::{Drive, Planar};

/// Points of a band of frequencies.
const POINTS: u32 = 401;
/// The band that is always told of.
pub const NEAR: f64 = 0.05;

/// What is left in a coordinate after the manoeuvre.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
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
    let amplitudes = History::new(body, &plan.waveform, factor).amplitudes(plan.time);
    let sum = |c: &Coordinate| c.weights.iter().zip(&amplitudes).map(|(w, a)| w.abs() * a).sum();
    coordinates.iter().map(sum).collect()
}

/// What is left in each coordinate. Gains and weights stay as they are while the frequencies move together.
pub fn residuals(plan: &Plan, body: &Planar, band: f64) -> Vec<Residual> {
    let coordinates = coordinates(body);
    let sums = |factor: f64| left(plan, body, &coordinates, factor);
    let worst = |band: f64| {
        let factor = |i: u32| 1.0 + band * (2.0 * f64::from(i) / f64::from(POINTS - 1) - 1.0);
        let largest = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect();
        (0..POINTS).map(|i| sums(factor(i))).fold(vec![0.0; coordinates.len()], largest)
    };
    let (nominal, near, worst) = (sums(1.0), worst(NEAR), worst(band));
    let told = coordinates.into_iter().enumerate().map(|(i, c)| Residual {
        name: c.name,
        unit: c.unit,
        nominal: nominal[i],
        near: near[i],
        worst: worst[i],
    });
    told.collect()
}
