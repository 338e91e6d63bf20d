//! Terms of Sun and Moon in SGP4 for periods from 225 min on (SDP4, \[ValladoCrawford06\]): mean rates of the elements, and
//! periodic terms. Quantities are in radians and minutes.

#[cfg(test)]
mod tests;

use std::f64::consts::{PI, TAU};

use super::two_lines::MeanElements;

/// Inclination (rad) below which the periodic terms of node and perigee are written without its sine in a denominator.
const FLAT: f64 = 0.2;
/// Distance of the inclination (rad) from 0 and from half a turn within which the node has no mean rate by third bodies.
const NO_NODE: f64 = 5.235_987_7e-2;

/// Elements of an orbit at an instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct OrbitElements {
    /// Eccentricity.
    pub eccentricity: f64,
    /// Inclination (rad).
    pub inclination: f64,
    /// Mean anomaly (rad).
    pub anomaly: f64,
    /// Argument of perigee (rad).
    pub perigee: f64,
    /// Right ascension of the ascending node (rad).
    pub node: f64,
}

/// Terms of Sun and Moon.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DeepSpace {
    bodies: [ThirdBody; 2],
    /// Mean rates of the elements (1/min, rad/min).
    pub rates: OrbitElements,
}

/// Terms of the Sun or of the Moon.
#[derive(Copy, Clone, Debug, PartialEq)]
struct ThirdBody {
    /// Mean anomaly at the epoch (rad) and its rate (rad/min).
    anomaly: [f64; 2],
    eccentricity: f64,
    /// Coefficients of the periodic terms, of f2, f3 and the sine of the true anomaly.
    terms: PeriodicTerms,
    rates: OrbitElements,
}

/// Coefficients of periodic terms, of the perigee with the node times the cosine of the inclination, and of the node times its
/// sine.
#[derive(Copy, Clone, Debug, PartialEq)]
struct PeriodicTerms {
    eccentricity: [f64; 3],
    inclination: [f64; 3],
    anomaly: [f64; 3],
    perigee: [f64; 3],
    node: [f64; 3],
}

/// Orbit of a third body as it acts on another orbit.
struct BodyOrbit {
    /// Cosine and sine of perigee, inclination, and node, the last from that of the other orbit.
    perigee: [f64; 2],
    inclination: [f64; 2],
    node: [f64; 2],
    anomaly: [f64; 2],
    eccentricity: f64,
    /// Strength of the perturbation (rad/min).
    strength: f64,
}

impl ThirdBody {
    /// Computes the terms of a body from its orbit and from the elements and the mean motion (rad/min) of the other.
    fn new(body: &BodyOrbit, elements: &MeanElements, motion: f64) -> Self {
        let e = elements.eccentricity;
        let e2 = e * e;
        let [(sin_i, cos_i), (sin_w, cos_w)] = [elements.inclination, elements.perigee].map(libm::sincos);
        let ([cos_g, sin_g], [cos_t, sin_t], [cos_h, sin_h]) = (body.perigee, body.inclination, body.node);
        let a1 = cos_g * cos_h + sin_g * cos_t * sin_h;
        let a3 = -sin_g * cos_h + cos_g * cos_t * sin_h;
        let a7 = -cos_g * sin_h + sin_g * cos_t * cos_h;
        let a8 = sin_g * sin_t;
        let a9 = sin_g * sin_h + cos_g * cos_t * cos_h;
        let a10 = cos_g * sin_t;
        let (a2, a4) = (cos_i * a7 + sin_i * a8, cos_i * a9 + sin_i * a10);
        let (a5, a6) = (-sin_i * a7 + cos_i * a8, -sin_i * a9 + cos_i * a10);
        let (x1, x2) = (a1 * cos_w + a2 * sin_w, a3 * cos_w + a4 * sin_w);
        let (x3, x4) = (-a1 * sin_w + a2 * cos_w, -a3 * sin_w + a4 * cos_w);
        let (x5, x6, x7, x8) = (a5 * sin_w, a6 * sin_w, a5 * cos_w, a6 * cos_w);
        let z31 = 12.0 * x1 * x1 - 3.0 * x3 * x3;
        let z32 = 24.0 * x1 * x2 - 6.0 * x3 * x4;
        let z33 = 12.0 * x2 * x2 - 3.0 * x4 * x4;
        let z11 = -6.0 * a1 * a5 + e2 * (-24.0 * x1 * x7 - 6.0 * x3 * x5);
        let z12 = -6.0 * (a1 * a6 + a3 * a5) + e2 * (-24.0 * (x2 * x7 + x1 * x8) - 6.0 * (x3 * x6 + x4 * x5));
        let z13 = -6.0 * a3 * a6 + e2 * (-24.0 * x2 * x8 - 6.0 * x4 * x6);
        let z21 = 6.0 * a2 * a5 + e2 * (24.0 * x1 * x5 - 6.0 * x3 * x7);
        let z22 = 6.0 * (a4 * a5 + a2 * a6) + e2 * (24.0 * (x2 * x5 + x1 * x6) - 6.0 * (x4 * x7 + x3 * x8));
        let z23 = 6.0 * a4 * a6 + e2 * (24.0 * x2 * x6 - 6.0 * x4 * x8);
        let beta2 = 1.0 - e2;
        let whole = |sum: f64, own: f64| 2.0 * (sum + own * e2) + beta2 * own;
        let z1 = whole(3.0 * (a1 * a1 + a2 * a2), z31);
        let z2 = whole(6.0 * (a1 * a3 + a2 * a4), z32);
        let z3 = whole(3.0 * (a3 * a3 + a4 * a4), z33);
        let s3 = body.strength / motion;
        let s2 = -0.5 * s3 / f64::sqrt(beta2);
        let s4 = s3 * f64::sqrt(beta2);
        let s1 = -15.0 * e * s4;
        let [s5, s6, s7] = [x1 * x3 + x2 * x4, x2 * x3 + x1 * x4, x2 * x4 - x1 * x3];
        let rate = body.anomaly[1];
        let i = elements.inclination;
        let flat = !(NO_NODE..=PI - NO_NODE).contains(&i);
        let node_by_sine = if flat { 0.0 } else { -rate * s2 * (z21 + z23) };
        let node = if sin_i == 0.0 { 0.0 } else { node_by_sine / sin_i };
        Self {
            anomaly: body.anomaly,
            eccentricity: body.eccentricity,
            terms: PeriodicTerms {
                eccentricity: [2.0 * s1 * s6, 2.0 * s1 * s7, 0.0],
                inclination: [2.0 * s2 * z12, 2.0 * s2 * (z13 - z11), 0.0],
                anomaly: [
                    -2.0 * s3 * z2,
                    -2.0 * s3 * (z3 - z1),
                    -2.0 * s3 * (-21.0 - 9.0 * e2) * body.eccentricity,
                ],
                perigee: [2.0 * s4 * z32, 2.0 * s4 * (z33 - z31), -18.0 * s4 * body.eccentricity],
                node: [-2.0 * s2 * z22, -2.0 * s2 * (z23 - z21), 0.0],
            },
            rates: OrbitElements {
                eccentricity: s1 * rate * s5,
                inclination: s2 * rate * (z11 + z13),
                anomaly: -rate * s3 * (z1 + z3 - 14.0 - 6.0 * e2),
                perigee: s4 * rate * (z31 + z33 - 6.0) - cos_i * node,
                node,
            },
        }
    }

    /// Returns the periodic terms at `t` minutes after the epoch.
    fn periodic(&self, t: f64) -> OrbitElements {
        let mean = self.anomaly[0] + self.anomaly[1] * t;
        let (sin, cos) = libm::sincos(mean + 2.0 * self.eccentricity * libm::sin(mean));
        let functions = [0.5 * sin * sin - 0.25, -0.5 * sin * cos, sin];
        let sum = |terms: &[f64; 3]| terms.iter().zip(functions).map(|(term, value)| term * value).sum();
        OrbitElements {
            eccentricity: sum(&self.terms.eccentricity),
            inclination: sum(&self.terms.inclination),
            anomaly: sum(&self.terms.anomaly),
            perigee: sum(&self.terms.perigee),
            node: sum(&self.terms.node),
        }
    }
}

impl DeepSpace {
    /// Creates the terms for elements with this mean motion (rad/min), of Brouwer.
    pub fn new(elements: &MeanElements, motion: f64) -> Self {
        // Days from the noon of 1899-12-31; 1970 began 25567.5 days later.
        let day = elements.epoch_ns as f64 / 8.64e13 + 25_567.5;
        let (sin_node, cos_node) = libm::sincos(elements.node);
        let sun = BodyOrbit {
            perigee: [0.194_590_5, -0.980_884_58],
            inclination: [0.917_448_67, 0.397_854_16],
            node: [cos_node, sin_node],
            anomaly: [libm::fmod(6.256_583_7 + 0.017_201_977 * day, TAU), 1.194_59e-5],
            eccentricity: 0.016_75,
            strength: 2.986_479_7e-6,
        };
        // The Moon's orbit is inclined against the ecliptic, and its node moves.
        let own_node = libm::fmod(4.523_602_0 - 9.242_202_9e-4 * day, TAU);
        let (sin, cos) = libm::sincos(own_node);
        let cos_i = 0.913_751_64 - 0.035_680_96 * cos;
        let sin_i = f64::sqrt(1.0 - cos_i * cos_i);
        let sin_h = 0.089_683_511 * sin / sin_i;
        let cos_h = f64::sqrt(1.0 - sin_h * sin_h);
        let longitude = 5.835_151_4 + 0.001_944_368_0 * day;
        let shift = libm::atan2(0.397_854_16 * sin / sin_i, cos_h * cos + 0.917_448_67 * sin_h * sin);
        let (sin_g, cos_g) = libm::sincos(longitude + shift - own_node);
        let moon = BodyOrbit {
            perigee: [cos_g, sin_g],
            inclination: [cos_i, sin_i],
            node: [cos_h * cos_node + sin_h * sin_node, sin_node * cos_h - cos_node * sin_h],
            anomaly: [libm::fmod(4.719_967_2 + 0.229_971_50 * day - longitude, TAU), 1.583_521_8e-4],
            eccentricity: 0.054_90,
            strength: 4.796_806_5e-7,
        };
        let bodies = [sun, moon].map(|body| ThirdBody::new(&body, elements, motion));
        Self { bodies, rates: bodies[0].rates.plus(&bodies[1].rates, 1.0) }
    }

    /// Returns the elements at `t` minutes after the epoch with the periodic terms; `None` if they are no ellipse.
    pub fn with_periodic_terms(&self, mean: &OrbitElements, t: f64) -> Option<OrbitElements> {
        let terms = self.bodies[0].periodic(t).plus(&self.bodies[1].periodic(t), 1.0);
        let mut found = *mean;
        found.inclination += terms.inclination;
        found.eccentricity += terms.eccentricity;
        found.anomaly += terms.anomaly;
        let (sin_i, cos_i) = libm::sincos(found.inclination);
        if found.inclination >= FLAT {
            let node = terms.node / sin_i;
            found.perigee += terms.perigee - cos_i * node;
            found.node += node;
        } else {
            // The sum of the angles has no singularity where the node is not defined.
            let (sin, cos) = libm::sincos(mean.node);
            let along = sin_i * sin + terms.node * cos + terms.inclination * cos_i * sin;
            let across = sin_i * cos - terms.node * sin + terms.inclination * cos_i * cos;
            let before = libm::fmod(mean.node, TAU);
            let sum = mean.anomaly + mean.perigee + cos_i * before + terms.anomaly + terms.perigee
                - terms.inclination * before * sin_i;
            let mut node = libm::atan2(along, across);
            if (before - node).abs() > PI {
                node += if node < before { TAU } else { -TAU };
            }
            found.node = node;
            found.perigee = sum - found.anomaly - cos_i * node;
        }
        if found.inclination < 0.0 {
            found.inclination = -found.inclination;
            found.node += PI;
            found.perigee -= PI;
        }
        (0.0..=1.0).contains(&found.eccentricity).then_some(found)
    }
}

impl OrbitElements {
    /// Returns the sum with other elements times a factor.
    pub fn plus(&self, other: &Self, factor: f64) -> Self {
        Self {
            eccentricity: self.eccentricity + other.eccentricity * factor,
            inclination: self.inclination + other.inclination * factor,
            anomaly: self.anomaly + other.anomaly * factor,
            perigee: self.perigee + other.perigee * factor,
            node: self.node + other.node * factor,
        }
    }
}
