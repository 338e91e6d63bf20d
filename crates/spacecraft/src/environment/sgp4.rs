//! SGP4, the theory with which two-line elements are made and read: \[ValladoCrawford06\], with the constants of WGS 72 and with the
//! terms of deep space (SDP4) for periods from 225 min on. Quantities are in radii of the Earth, radians and minutes, positions in the axes of the true equator and
//! the mean equinox (TEME).

use std::f64::consts::TAU;

use flexsc_numerics::attitude::Vector;

use super::date::greenwich;
use super::deep_space::{DeepSpace, OrbitElements};
use super::resonance::{Resonance, ResonantOrbit};
use super::two_lines::MeanElements;

/// Radius of the Earth (m), WGS 72.
const RADIUS: f64 = 6_378_135.0;
/// GM of the Earth (m³/s²), WGS 72.
const GRAVITY: f64 = 3.986_008e14;
const J2: f64 = 1.082_616e-3;
const J3: f64 = -2.538_81e-6;
const J4: f64 = -1.655_97e-6;
/// Period (min) from which on Sun and Moon act.
const DEEP_SPACE: f64 = 225.0;
/// Eccentricity below which terms in its inverse are left out.
const CIRCULAR: f64 = 1e-4;

/// Constants of an orbit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sgp4 {
    elements: MeanElements,
    /// Mean motion (rad/min) and semi-major axis (radii), without the secular effect of J2 on the period.
    motion: f64,
    axis: f64,
    tilt: Tilt,
    eta: f64,
    c1: f64,
    c4: f64,
    c5: f64,
    /// Rates of mean anomaly, perigee and node (rad/min).
    rates: [f64; 3],
    perigee_drag: f64,
    anomaly_drag: f64,
    node_drag: f64,
    delta_start: f64,
    /// Coefficients of powers of time from the second on: of the axis (2 to 4), and of the longitude (2 to 5).
    d: [f64; 3],
    powers: [f64; 4],
    /// True without the terms of higher order, for perigees below 220 km and in deep space.
    is_simple: bool,
    /// Terms of Sun and Moon, in deep space.
    deep_space: Option<DeepSpace>,
    resonance: Option<Resonance>,
}

/// Inclination with functions of it.
#[derive(Copy, Clone, Debug, PartialEq)]
struct Tilt {
    inclination: f64,
    cos: f64,
    sin: f64,
    /// Coefficients of the long-period terms.
    long: [f64; 2],
}

impl Tilt {
    fn new(inclination: f64) -> Self {
        let (sin, cos) = libm::sincos(inclination);
        // An inclination of 180 degrees would divide by zero.
        let beside = if (1.0 + cos).abs() > 1.5e-12 { 1.0 + cos } else { 1.5e-12 };
        let long = [-0.25 * (J3 / J2) * sin * (3.0 + 5.0 * cos) / beside, -0.5 * (J3 / J2) * sin];
        Self { inclination, cos, sin, long }
    }
}

/// Returns the square root of GM (radii^1.5/min).
fn xke() -> f64 {
    60.0 * f64::sqrt(GRAVITY / RADIUS) / RADIUS
}

impl Sgp4 {
    /// Creates the constants of an orbit.
    pub fn new(elements: &MeanElements) -> Self {
        let MeanElements { inclination, eccentricity: e, perigee, anomaly, motion, drag, .. } = *elements;
        let tilt = Tilt::new(inclination);
        let Tilt { sin, cos, .. } = tilt;
        let (cos2, beta2) = (cos * cos, 1.0 - e * e);
        let (beta, con41, con42) = (f64::sqrt(beta2), 3.0 * cos2 - 1.0, 1.0 - 5.0 * cos2);
        // The elements have the mean motion of Kozai, the theory that of Brouwer.
        let kozai = libm::pow(xke() / motion, 2.0 / 3.0);
        let shift = 0.75 * J2 * con41 / (beta * beta2);
        let ratio = shift / (kozai * kozai);
        let shrunk = kozai * (1.0 - ratio * ratio - ratio * (1.0 / 3.0 + 134.0 * ratio * ratio / 81.0));
        let motion = motion / (1.0 + shift / (shrunk * shrunk));
        let axis = libm::pow(xke() / motion, 2.0 / 3.0);
        let parameter = axis * beta2;
        let lowest = axis * (1.0 - e);
        let height = (lowest - 1.0) * RADIUS / 1e3;
        let floor = if height < 98.0 {
            20.0
        } else if height < 156.0 {
            height - 78.0
        } else {
            78.0
        };
        let fourth = |x: f64| (x * x) * (x * x);
        let radius_km = RADIUS / 1e3;
        let density = fourth((120.0 - floor) / radius_km);
        let floor = floor / radius_km + 1.0;
        let tsi = 1.0 / (axis - floor);
        let eta = axis * e * tsi;
        let (eta2, e_eta) = (eta * eta, e * eta);
        let psi2 = (1.0 - eta2).abs();
        let coef = density * fourth(tsi);
        let coef1 = coef / libm::pow(psi2, 3.5);
        let c2 = coef1
            * motion
            * (axis * (1.0 + 1.5 * eta2 + e_eta * (4.0 + eta2))
                + 0.375 * J2 * tsi / psi2 * con41 * (8.0 + 3.0 * eta2 * (8.0 + eta2)));
        let c1 = drag * c2;
        let c3 = if e > CIRCULAR { -2.0 * coef * tsi * (J3 / J2) * motion * sin / e } else { 0.0 };
        let sin2 = 1.0 - cos2;
        let c4 = 2.0
            * motion
            * coef1
            * axis
            * beta2
            * (eta * (2.0 + 0.5 * eta2) + e * (0.5 + 2.0 * eta2)
                - J2 * tsi / (axis * psi2)
                    * (-3.0 * con41 * (1.0 - 2.0 * e_eta + eta2 * (1.5 - 0.5 * e_eta))
                        + 0.75 * sin2 * (2.0 * eta2 - e_eta * (1.0 + eta2)) * libm::cos(2.0 * perigee)));
        let c5 = 2.0 * coef1 * axis * beta2 * (1.0 + 2.75 * (eta2 + e_eta) + e_eta * eta2);
        let cos4 = cos2 * cos2;
        let inverse2 = 1.0 / (parameter * parameter);
        let temp1 = 1.5 * J2 * inverse2 * motion;
        let temp2 = 0.5 * temp1 * J2 * inverse2;
        let temp3 = -0.468_75 * J4 * inverse2 * inverse2 * motion;
        let anomaly_rate =
            motion + 0.5 * temp1 * beta * con41 + 0.0625 * temp2 * beta * (13.0 - 78.0 * cos2 + 137.0 * cos4);
        let perigee_rate = -0.5 * temp1 * con42
            + 0.0625 * temp2 * (7.0 - 114.0 * cos2 + 395.0 * cos4)
            + temp3 * (3.0 - 36.0 * cos2 + 49.0 * cos4);
        let first_node_rate = -temp1 * cos;
        let node_rate =
            first_node_rate + (0.5 * temp2 * (4.0 - 19.0 * cos2) + 2.0 * temp3 * (3.0 - 7.0 * cos2)) * cos;
        let rates = [anomaly_rate, perigee_rate, node_rate];
        let deep_space = (TAU / motion >= DEEP_SPACE).then(|| DeepSpace::new(elements, motion));
        let resonance = deep_space.as_ref().and_then(|terms| {
            let (third_bodies, greenwich) = (&terms.rates, greenwich(elements.epoch_ns));
            Resonance::new(&ResonantOrbit { elements, motion, axis, rates, third_bodies, greenwich })
        });
        let c1_2 = c1 * c1;
        let d2 = 4.0 * axis * tsi * c1_2;
        let temp = d2 * tsi * c1 / 3.0;
        let d3 = (17.0 * axis + floor) * temp;
        let d4 = 0.5 * temp * axis * tsi * (221.0 * axis + 31.0 * floor) * c1;
        Self {
            motion,
            axis,
            tilt,
            eta,
            c1,
            c4,
            c5,
            rates,
            perigee_drag: drag * c3 * libm::cos(perigee),
            anomaly_drag: if e > CIRCULAR { -2.0 / 3.0 * coef * drag / e_eta } else { 0.0 },
            node_drag: 3.5 * beta2 * first_node_rate * c1,
            delta_start: cube(1.0 + eta * libm::cos(anomaly)),
            d: [d2, d3, d4],
            powers: [
                1.5 * c1,
                d2 + 2.0 * c1_2,
                0.25 * (3.0 * d3 + c1 * (12.0 * d2 + 10.0 * c1_2)),
                0.2 * (3.0 * d4 + 12.0 * c1 * d3 + 6.0 * d2 * d2 + 15.0 * c1_2 * (2.0 * d2 + c1_2)),
            ],
            is_simple: lowest < 220.0 / radius_km + 1.0 || deep_space.is_some(),
            deep_space,
            resonance,
            elements: elements.clone(),
        }
    }

    /// Returns position (m) and velocity (m/s) at `t` minutes after the epoch of the elements; `None` where the theory
    /// does not hold, as after a decay.
    pub fn at(&mut self, t: f64) -> Option<[Vector; 2]> {
        let of = &self.elements;
        let [anomaly_rate, perigee_rate, node_rate] = self.rates;
        let first_anomaly = of.anomaly + anomaly_rate * t;
        let first_perigee = of.perigee + perigee_rate * t;
        let node = of.node + node_rate * t + self.node_drag * t * t;
        let (mut anomaly, mut perigee) = (first_anomaly, first_perigee);
        let (mut shrinks, mut circles) = (1.0 - self.c1 * t, of.drag * self.c4 * t);
        let mut along = self.powers[0] * t * t;
        if !self.is_simple {
            let delta = cube(1.0 + self.eta * libm::cos(first_anomaly)) - self.delta_start;
            let moved = self.perigee_drag * t + self.anomaly_drag * delta;
            anomaly += moved;
            perigee -= moved;
            let (t2, t3) = (t * t, t * t * t);
            let t4 = t3 * t;
            shrinks -= self.d[0] * t2 + self.d[1] * t3 + self.d[2] * t4;
            circles += of.drag * self.c5 * (libm::sin(anomaly) - libm::sin(of.anomaly));
            along += self.powers[1] * t3 + t4 * (self.powers[2] + t * self.powers[3]);
        }
        let mut mean = OrbitElements {
            eccentricity: of.eccentricity,
            inclination: of.inclination,
            anomaly,
            perigee,
            node,
        };
        let mut axis = self.axis;
        if let Some(terms) = &self.deep_space {
            mean = mean.plus(&terms.rates, t);
            if let Some(resonance) = &mut self.resonance {
                let [motion, anomaly] = resonance.advance(t, [mean.perigee, mean.node]);
                mean.anomaly = anomaly;
                axis = libm::pow(xke() / motion, 2.0 / 3.0);
            }
        }
        let axis = axis * shrinks * shrinks;
        let motion = xke() / libm::pow(axis, 1.5);
        let e = mean.eccentricity - circles;
        // Drag shrinks an orbit: beyond some decades the powers of time do not hold.
        if !((0.5..1.1).contains(&(axis / self.axis)) && (-1e-3..1.0).contains(&e)) {
            return None;
        }
        mean.eccentricity = e.max(1e-6);
        mean.anomaly += self.motion * along;
        let Some(terms) = &self.deep_space else {
            return short_period(&self.tilt, [axis, motion], &mean);
        };
        let found = terms.with_periodic_terms(&mean, t)?;
        short_period(&Tilt::new(found.inclination), [axis, motion], &found)
    }
}

/// Returns position (m) and velocity (m/s) with the long- and short-period terms, from semi-major axis (radii) and mean
/// motion (rad/min), and from eccentricity, mean anomaly, perigee and node (rad).
fn short_period(tilt: &Tilt, [axis, motion]: [f64; 2], elements: &OrbitElements) -> Option<[Vector; 2]> {
    let Tilt { cos: cos_i, sin: sin_i, long, inclination } = *tilt;
    let OrbitElements { eccentricity: e, anomaly, perigee, node, .. } = *elements;
    let (con41, sin2_i, x7) = (3.0 * cos_i * cos_i - 1.0, 1.0 - cos_i * cos_i, 7.0 * cos_i * cos_i - 1.0);
    let (sin_w, cos_w) = libm::sincos(perigee);
    let inverse = 1.0 / (axis * (1.0 - e * e));
    let (ax, ay) = (e * cos_w, e * sin_w + inverse * long[1]);
    let u = libm::fmod(anomaly + perigee + inverse * long[0] * ax, TAU);
    let (sin, cos) = eccentric_longitude(u, ax, ay);
    let (e_cos, e_sin, e2) = (ax * cos + ay * sin, ax * sin - ay * cos, ax * ax + ay * ay);
    let parameter = axis * (1.0 - e2);
    if parameter <= 0.0 {
        return None;
    }
    let radius = axis * (1.0 - e_cos);
    let (radial, across) = (f64::sqrt(axis) * e_sin / radius, f64::sqrt(parameter) / radius);
    let beta = f64::sqrt(1.0 - e2);
    let temp = e_sin / (1.0 + beta);
    let sin_u = axis / radius * (sin - ay - ax * temp);
    let cos_u = axis / radius * (cos - ax + ay * temp);
    let (sin_2u, cos_2u) = (2.0 * sin_u * cos_u, 1.0 - 2.0 * sin_u * sin_u);
    let temp1 = 0.5 * J2 / parameter;
    let temp2 = temp1 / parameter;
    let distance = radius * (1.0 - 1.5 * temp2 * beta * con41) + 0.5 * temp1 * sin2_i * cos_2u;
    let latitude = libm::atan2(sin_u, cos_u) - 0.25 * temp2 * x7 * sin_2u;
    let node = node + 1.5 * temp2 * cos_i * sin_2u;
    let inclination = inclination + 1.5 * temp2 * cos_i * sin_i * cos_2u;
    let scale = motion * temp1 / xke();
    let climb = radial - scale * sin2_i * sin_2u;
    let forward = across + scale * (sin2_i * cos_2u + 1.5 * con41);
    let [(su, cu), (sn, cn), (si, ci)] = [latitude, node, inclination].map(libm::sincos);
    let [mx, my] = [-sn * ci, cn * ci];
    let up = Vector::new(mx * su + cn * cu, my * su + sn * cu, si * su);
    let ahead = Vector::new(mx * cu - cn * su, my * cu - sn * su, si * cu);
    let speed = RADIUS * xke() / 60.0;
    Some([up * (distance * RADIUS), (up * climb + ahead * forward) * speed])
}

/// Returns sine and cosine of the eccentric longitude, by Newton's method.
fn eccentric_longitude(u: f64, ax: f64, ay: f64) -> (f64, f64) {
    let mut longitude = u;
    for _ in 0..10 {
        let (sin, cos) = libm::sincos(longitude);
        let step = (u - ay * cos + ax * sin - longitude) / (1.0 - cos * ax - sin * ay);
        longitude += step.clamp(-0.95, 0.95);
        if step.abs() < 1e-12 {
            break;
        }
    }
    libm::sincos(longitude)
}

fn cube(x: f64) -> f64 {
    x * x * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::two_lines::parse;

    /// Minutes from the epoch, position (km) and velocity (km/s).
    type VerificationRow = (f64, [f64; 3], [f64; 3]);

    /// Published states of the verification of SGP4 (AIAA 2006-6753, `tcppver.out`): minutes, km, km/s.
    #[test]
    fn it_has_the_states_of_its_verification() {
        let orbits: [([&str; 2], &[VerificationRow]); 3] = [
            (
                [
                    "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753",
                    "2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667",
                ],
                &[(
                    4320.0,
                    [-9_060.473_735_69, 4_658.709_525_02, 813.686_731_53],
                    [-2.232_832_783, -4.110_453_490, -3.157_345_433],
                )],
            ),
            (
                [
                    "1 06251U 62025E   06176.82412014  .00008885  00000-0  12808-3 0  3985",
                    "2 06251  58.0579  54.0425 0030035 139.1568 221.1854 15.56387291  6774",
                ],
                &[(
                    2880.0,
                    [1_159.278_028_97, 5_056.601_754_95, 4_353.494_185_79],
                    [-5.968_060_341, -2.314_790_406, 4.230_722_669],
                )],
            ),
            (
                [
                    "1 28057U 03049A   06177.78615833  .00000060  00000-0  35940-4 0  1836",
                    "2 28057  98.4283 247.6961 0000884  88.1964 271.9322 14.35478080140550",
                ],
                &[
                    (
                        0.0,
                        [-2_715.282_374_86, -6_619.264_368_89, -0.013_414_43],
                        [-1.008_587_273, 0.422_782_003, 7.385_272_942],
                    ),
                    (
                        120.0,
                        [-1_816.879_209_42, -1_835.787_621_32, 6_661.079_264_65],
                        [2.325_140_071, 6.655_669_329, 2.463_394_512],
                    ),
                    (
                        2880.0,
                        [1_788.423_345_80, 1_990.505_309_57, -6_640.593_377_25],
                        [-2.074_169_091, -6.683_381_288, -2.562_777_776],
                    ),
                ],
            ),
        ];
        for (lines, states) in orbits {
            let mut orbit = Sgp4::new(&parse(&lines.map(str::to_owned)).unwrap());
            for (minutes, position, velocity) in states {
                let found = orbit.at(*minutes).unwrap();
                for (axis, (position, velocity)) in position.iter().zip(velocity).enumerate() {
                    let [here, speed] = found.map(|vector| vector[axis] / 1e3);
                    assert!((here - position).abs() < 1e-8, "{minutes} {axis}: {here} {position}");
                    assert!((speed - velocity).abs() < 1e-9, "{minutes} {axis}: {speed} {velocity}");
                }
            }
        }
    }
}
