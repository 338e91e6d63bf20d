//! Resonance of an orbit with the Earth's rotation in SGP4 (SDP4, \[ValladoCrawford06\]): periods of a day, and eccentric orbits of half
//! a day, whose mean motion and longitude are integrated. Quantities are in radians and minutes.

use super::deep_space::OrbitElements;
use super::two_lines::MeanElements;

/// Rotation rate of the Earth (rad/min).
const ROTATION: f64 = 4.375_269_088_011_3e-3;
/// Step of the integration (min).
const STEP: f64 = 720.0;

/// Phases of the terms of a day (rad).
const DAY_PHASES: [f64; 3] = [0.131_309_08, 2.884_319_8, 0.374_480_87];

/// Term of half a day: multiples of perigee and longitude, and the phase (rad).
const HALF_DAY: [([f64; 2], f64); 10] = [
    ([2.0, 1.0], 5.768_639_6),
    ([0.0, 1.0], 5.768_639_6),
    ([1.0, 1.0], 0.952_408_98),
    ([-1.0, 1.0], 0.952_408_98),
    ([2.0, 2.0], 1.801_499_8),
    ([0.0, 2.0], 1.801_499_8),
    ([1.0, 1.0], 1.050_833_0),
    ([-1.0, 1.0], 1.050_833_0),
    ([1.0, 2.0], 4.410_889_8),
    ([-1.0, 2.0], 4.410_889_8),
];

/// Powers 0 to 3 of the eccentricity in a function of it.
type Cubic = [f64; 4];

/// Resonant motion of an orbit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Resonance {
    kind: ResonanceKind,
    /// Perigee at the epoch (rad) and its rate (rad/min).
    perigee: [f64; 2],
    /// Resonant longitude (rad) and mean motion (rad/min) at the epoch.
    start: [f64; 2],
    /// Rate of the longitude without the mean motion (rad/min).
    drift: f64,
    /// Angle of Greenwich at the epoch (rad).
    greenwich: f64,
    /// Time (min), longitude (rad) and mean motion (rad/min) up to which the motion is integrated.
    reached: [f64; 3],
}

/// Kind of a resonance, with the accelerations of its terms (rad/min²).
#[derive(Copy, Clone, Debug, PartialEq)]
enum ResonanceKind {
    Day([f64; 3]),
    HalfDay([f64; 10]),
}

/// Elements and rates from which a resonance follows.
pub(super) struct ResonantOrbit<'a> {
    pub elements: &'a MeanElements,
    /// Mean motion of Brouwer (rad/min) and semi-major axis (radii).
    pub motion: f64,
    pub axis: f64,
    /// Mean rates by the oblateness (rad/min) of mean anomaly, perigee and node.
    pub rates: [f64; 3],
    /// Mean rates by Sun and Moon.
    pub third_bodies: &'a OrbitElements,
    /// Angle of Greenwich at the epoch (rad).
    pub greenwich: f64,
}

impl Resonance {
    /// Creates the resonant motion; `None` of an orbit without a resonance.
    pub fn new(orbit: &ResonantOrbit<'_>) -> Option<Self> {
        let ResonantOrbit { elements, motion, greenwich, .. } = *orbit;
        let [anomaly_rate, perigee_rate, node_rate] = orbit.rates;
        let (by, e) = (orbit.third_bodies, elements.eccentricity);
        let is_day = motion > 0.003_490_658_5 && motion < 0.005_235_987_7;
        let is_half_day = (8.26e-3..=9.24e-3).contains(&motion) && e >= 0.5;
        let (kind, longitude, drift) = if is_day {
            let all = anomaly_rate + perigee_rate + node_rate + by.anomaly + by.perigee + by.node;
            let longitude = elements.anomaly + elements.node + elements.perigee - greenwich;
            (ResonanceKind::Day(day_terms(orbit)), longitude, all - ROTATION - motion)
        } else if is_half_day {
            let node = node_rate + by.node - ROTATION;
            let longitude = elements.anomaly + 2.0 * (elements.node - greenwich);
            let drift = anomaly_rate + by.anomaly + 2.0 * node - motion;
            (ResonanceKind::HalfDay(half_day_terms(orbit)), longitude, drift)
        } else {
            return None;
        };
        let start = [libm::fmod(longitude, std::f64::consts::TAU), motion];
        Some(Self {
            kind,
            perigee: [elements.perigee, perigee_rate],
            start,
            drift,
            greenwich,
            reached: [0.0, start[0], start[1]],
        })
    }

    /// Returns the acceleration of the longitude (rad/min²) and its rate of change (rad/min³) per rate of the longitude.
    fn acceleration(&self, [time, longitude, _]: [f64; 3]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        let mut add = |strength: f64, multiple: f64, angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            sums[0] += strength * sin;
            sums[1] += strength * multiple * cos;
        };
        match &self.kind {
            ResonanceKind::Day(strengths) => {
                for (order, (strength, phase)) in strengths.iter().zip(DAY_PHASES).enumerate() {
                    let multiple = (order + 1) as f64;
                    add(*strength, multiple, multiple * (longitude - phase));
                }
            }
            ResonanceKind::HalfDay(strengths) => {
                let perigee = self.perigee[0] + self.perigee[1] * time;
                for (strength, ([of_perigee, multiple], phase)) in strengths.iter().zip(HALF_DAY) {
                    add(*strength, multiple, of_perigee * perigee + multiple * longitude - phase);
                }
            }
        }
        sums
    }

    /// Integrates to `t` minutes after the epoch; returns mean motion (rad/min) and mean anomaly (rad) for a perigee and a
    /// node (rad) at that time.
    pub fn advance(&mut self, t: f64, [perigee, node]: [f64; 2]) -> [f64; 2] {
        let reached = self.reached[0];
        if reached * t < 0.0 || t.abs() < reached.abs() {
            self.reached = [0.0, self.start[0], self.start[1]];
        }
        let step = if t > 0.0 { STEP } else { -STEP };
        loop {
            let [time, longitude, motion] = self.reached;
            let [acceleration, change] = self.acceleration(self.reached);
            let rate = motion + self.drift;
            let jerk = change * rate;
            let moved = |step: f64| {
                let half = 0.5 * step * step;
                [longitude + rate * step + acceleration * half, motion + acceleration * step + jerk * half]
            };
            if (t - time).abs() >= STEP {
                let [longitude, motion] = moved(step);
                self.reached = [time + step, longitude, motion];
                continue;
            }
            let [longitude, motion] = moved(t - time);
            let turned = self.greenwich + ROTATION * t;
            let anomaly = match self.kind {
                ResonanceKind::Day(_) => longitude - node - perigee + turned,
                ResonanceKind::HalfDay(_) => longitude - 2.0 * (node - turned),
            };
            return [motion, anomaly];
        }
    }
}

/// Returns the accelerations of the terms of a day (rad/min²).
fn day_terms(orbit: &ResonantOrbit<'_>) -> [f64; 3] {
    let (sin, cos) = libm::sincos(orbit.elements.inclination);
    let e2 = orbit.elements.eccentricity * orbit.elements.eccentricity;
    let beside = 1.0 + cos;
    let scale = 3.0 * orbit.motion * orbit.motion / (orbit.axis * orbit.axis);
    let f311 = 0.9375 * sin * sin * (1.0 + 3.0 * cos) - 0.75 * beside;
    [
        scale * f311 * (1.0 + 2.0 * e2) * 2.146_074_8e-6 / orbit.axis,
        2.0 * scale * 0.75 * beside * beside * (1.0 + e2 * (-2.5 + 0.8125 * e2)) * 1.789_167_9e-6,
        3.0 * scale
            * (1.875 * beside * beside * beside)
            * (1.0 + e2 * (-6.0 + 6.609_37 * e2))
            * 2.212_301_5e-7
            / orbit.axis,
    ]
}

/// Returns the accelerations of the terms of half a day (rad/min²), in the order of [`HALF_DAY`].
fn half_day_terms(orbit: &ResonantOrbit<'_>) -> [f64; 10] {
    let (sin, cos) = libm::sincos(orbit.elements.inclination);
    let e = orbit.elements.eccentricity;
    let (cos2, sin2) = (cos * cos, sin * sin);
    let low = |low: Cubic, high: Cubic, limit: f64| {
        let [c0, c1, c2, c3] = if e <= limit { low } else { high };
        c0 + c1 * e + c2 * e * e + c3 * e * e * e
    };
    let g201 = -0.306 - (e - 0.64) * 0.440;
    let g211 = low([3.616, -13.247, 16.29, 0.0], [-72.099, 331.819, -508.738, 266.724], 0.65);
    let g310 = low([-19.302, 117.39, -228.419, 156.591], [-346.844, 1582.851, -2415.925, 1246.113], 0.65);
    let g322 =
        low([-18.9068, 109.7927, -214.6334, 146.5816], [-342.585, 1554.908, -2366.899, 1215.972], 0.65);
    let g410 = low([-41.122, 242.694, -471.094, 313.953], [-1052.797, 4758.686, -7193.992, 3651.957], 0.65);
    let g422 =
        low([-146.407, 841.88, -1629.014, 1083.435], [-3581.69, 16_178.11, -24_462.77, 12_422.52], 0.65);
    let middle = [1464.74, -4664.75, 3763.64, 0.0];
    let above = low(middle, [-5149.66, 29_936.92, -54_087.36, 31_324.56], 0.715);
    let g520 = if e <= 0.65 { low([-532.114, 3017.977, -5740.032, 3708.276], middle, 0.65) } else { above };
    // From 0.7 on, without the equality of the others.
    let limit = 0.7_f64.next_down();
    let g533 =
        low([-919.2277, 4988.61, -9064.77, 5542.21], [-37_995.78, 161_616.52, -229_838.2, 109_377.94], limit);
    let g521 = low(
        [-822.710_72, 4568.6173, -8491.4146, 5337.524],
        [-51_752.104, 218_913.95, -309_468.16, 146_349.42],
        limit,
    );
    let g532 =
        low([-853.666, 4690.25, -8624.77, 5341.4], [-40_023.88, 170_470.89, -242_699.48, 115_605.82], limit);
    let f220 = 0.75 * (1.0 + 2.0 * cos + cos2);
    let f321 = 1.875 * sin * (1.0 - 2.0 * cos - 3.0 * cos2);
    let f322 = -1.875 * sin * (1.0 + 2.0 * cos - 3.0 * cos2);
    let f522 = 9.843_75
        * sin
        * (sin2 * (1.0 - 2.0 * cos - 5.0 * cos2) + 0.333_333_33 * (-2.0 + 4.0 * cos + 6.0 * cos2));
    let f523 = sin
        * (4.921_875_12 * sin2 * (-2.0 - 4.0 * cos + 10.0 * cos2)
            + 6.562_500_12 * (1.0 + 2.0 * cos - 3.0 * cos2));
    let f542 = 29.531_25 * sin * (2.0 - 8.0 * cos + cos2 * (-12.0 + 8.0 * cos + 10.0 * cos2));
    let f543 = 29.531_25 * sin * (-2.0 - 8.0 * cos + cos2 * (12.0 + 8.0 * cos - 10.0 * cos2));
    let second = 3.0 * orbit.motion * orbit.motion / (orbit.axis * orbit.axis);
    let third = second / orbit.axis;
    let fourth = third / orbit.axis;
    let fifth = fourth / orbit.axis;
    let [root22, root32, root44] =
        [second * 1.789_167_9e-6, third * 3.739_379_2e-7, 2.0 * fourth * 7.363_695_3e-9];
    let [root52, root54] = [fifth * 1.142_863_9e-7, 2.0 * fifth * 2.176_580_3e-9];
    [
        root22 * f220 * g201,
        root22 * 1.5 * sin2 * g211,
        root32 * f321 * g310,
        root32 * f322 * g322,
        root44 * 35.0 * sin2 * f220 * g410,
        root44 * 39.375 * sin2 * sin2 * g422,
        root52 * f522 * g520,
        root52 * f523 * g532,
        root54 * f542 * g521,
        root54 * f543 * g533,
    ]
}
