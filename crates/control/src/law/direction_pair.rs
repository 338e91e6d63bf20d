//! Attitude from two directions: one body axis exactly along the first, another as near to the second as it can be
//! (\[Wertz78\]).

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, from_axes, vector};
use flexsc_numerics::quantity::Finite;
use flexsc_spacecraft::environment::{DirectionMotion, OrbitEnvironment, to_body};
use flexsc_spacecraft::manoeuvre::AttitudeMotion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::direction_motion::SkyDirection;

/// Least angle (rad) between the two directions, or their opposites: nearer to it the attitude turns too fast.
const LEAST_ANGLE: f64 = 1e-3;
/// Largest number of instants at which the angle is computed.
const MOST_INSTANTS: usize = 2_000_000;

/// Axis of the body along a direction.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointedAxis {
    /// Axis in the body's axes, of any length.
    pub body: [Finite; 3],
    /// Direction.
    pub along: SkyDirection,
}

/// Two axes of the body with their directions.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DirectionPair {
    /// Axis that is exactly along its direction.
    pub primary: PointedAxis,
    /// Axis that is as near to its direction as the first one lets it.
    pub secondary: PointedAxis,
}

/// Right-handed axes that move.
struct MovingAxes {
    axes: [Vector; 3],
    /// Angular rate (rad/s) and acceleration (rad/s²), in the same axes as those.
    turning: [Vector; 2],
}

impl MovingAxes {
    /// Returns the axes of two directions that are not parallel: the first one, their normal, and what completes them.
    fn new(first: &DirectionMotion, second: &DirectionMotion) -> Self {
        let (a, da, dda) = (first.direction, first.rate, first.acceleration);
        let (b, db, ddb) = (second.direction, second.rate, second.acceleration);
        let normal = DirectionMotion::along([
            a.cross(&b),
            da.cross(&b) + a.cross(&db),
            dda.cross(&b) + da.cross(&db) * 2.0 + a.cross(&ddb),
        ]);
        let (n, dn, ddn) = (normal.direction, normal.rate, normal.acceleration);
        let (c, dc) = (a.cross(&n), da.cross(&n) + a.cross(&dn));
        let ddc = dda.cross(&n) + da.cross(&dn) * 2.0 + a.cross(&ddn);
        let (by_a, by_n, by_c) = (dn.dot(&c), dc.dot(&a), da.dot(&n));
        let rate = a * by_a + n * by_n + c * by_c;
        let acceleration = a * (ddn.dot(&c) + dn.dot(&dc))
            + da * by_a
            + n * (ddc.dot(&a) + dc.dot(&da))
            + dn * by_n
            + c * (dda.dot(&n) + da.dot(&dn))
            + dc * by_c;
        Self { axes: [a, n, c], turning: [rate, acceleration] }
    }
}

impl DirectionPair {
    /// Returns the attitude of the body with its rate and acceleration `t` (s) after the start.
    pub fn state_at(&self, sky: &OrbitEnvironment, t: f64) -> AttitudeMotion {
        let [first, second] = [self.primary, self.secondary].map(|axis| axis.along.motion(sky, t));
        let moving = MovingAxes::new(&first, &second);
        let [a, b] = [self.primary, self.secondary].map(|axis| vector(&axis.body).normalize());
        let normal = a.cross(&b).normalize();
        let own = [a, normal, a.cross(&normal)];
        // The columns of the attitude are the body's axes: e = sum t_i (s_i . e).
        let axis = |place: usize| -> Vector {
            moving.axes.iter().zip(&own).map(|(inertial, body)| inertial * body[place]).sum()
        };
        let attitude = from_axes(&[axis(0), axis(1), axis(2)]);
        let [rate, acceleration] = moving.turning.map(|turning| to_body(&attitude, &turning));
        AttitudeMotion { attitude, rate, acceleration }
    }

    /// Returns true if the attitude turns.
    pub fn rotates(&self, sky: &OrbitEnvironment) -> bool {
        self.primary.along.moves(sky) || self.secondary.along.moves(sky)
    }

    /// Checks the axes and the directions for a run from `from` (s) on; returns the key within the target and the reason.
    pub fn validate(&self, sky: &OrbitEnvironment, from: f64) -> Option<ConfigError> {
        for (key, axis) in [("primary", &self.primary), ("secondary", &self.secondary)] {
            if let Some(fault) = axis.along.validate(sky) {
                return Some(fault.within(key));
            }
            if vector(&axis.body) == Vector::zeros() {
                let why = "must be a direction, got the zero vector".to_owned();
                return Some(ConfigError::new(format!("{key}.body"), why));
            }
        }
        let [a, b] = [self.primary, self.secondary].map(|axis| vector(&axis.body).normalize());
        if a.cross(&b).norm() < LEAST_ANGLE {
            return Some(ConfigError::new(
                "secondary.body",
                "must be another axis than `primary.body`, and not its opposite",
            ));
        }
        self.singular_time(sky, from).map(|found| {
            let why = match found {
                Ok(t) => format!(
                    "is along the direction of `primary`, or its opposite, to {LEAST_ANGLE} rad at {t:.1} s: the attitude is not \
                     defined there"
                ),
                Err(t) => format!(
                    "cannot be shown to differ from the direction of `primary` after {t:.0} s: the run is too long"
                ),
            };
            ConfigError::new("secondary.along", why)
        })
    }

    /// Returns the angle (rad) between the directions, or between one and the opposite of the other.
    fn angle(&self, sky: &OrbitEnvironment, t: f64) -> f64 {
        let [a, b] = [self.primary, self.secondary].map(|axis| axis.along.motion(sky, t).direction);
        libm::atan2(a.cross(&b).norm(), a.dot(&b).abs())
    }

    /// Returns the first time (s) at which the directions may be parallel; as an error, the time up to which it is known
    /// that they are not. The bounds of their rates exclude all others.
    fn singular_time(&self, sky: &OrbitEnvironment, from: f64) -> Option<Result<f64, f64>> {
        let mut t = from;
        for _ in 0..MOST_INSTANTS {
            let angle = self.angle(sky, t);
            // A field of zero has no angle.
            if angle.is_nan() || angle < LEAST_ANGLE {
                return Some(Ok(t));
            }
            let rate = self.primary.along.fastest(sky, t) + self.secondary.along.fastest(sky, t);
            if t >= sky.duration() || rate == 0.0 {
                return None;
            }
            // Within this time the angle falls to half of its distance from the least one at most.
            t = (t + 0.5 * (angle - 0.5 * LEAST_ANGLE) / rate).min(sky.duration());
        }
        Some(Err(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::time::Span;

    /// Orbit and Sun of the oracle, with Greenwich at 1.1 rad: 40 digits, mpmath.
    fn sky() -> OrbitEnvironment {
        let environment = flexsc_formats::document::from_text(
            "orbit = { semi_major_axis = 6.978e6, eccentricity = 0.01, inclination = 1.7, node = 0.4, perigee = 0.3, anomaly = 0.2 }\n\
             sun = [0.9, 0.4, 0.17]",
        );
        OrbitEnvironment::new(&environment.unwrap(), Span::from_seconds(6000.0), None).with_greenwich(1.1)
    }

    fn pair(text: &str) -> DirectionPair {
        #[derive(serde::Deserialize)]
        struct Two {
            primary: PointedAxis,
            secondary: PointedAxis,
        }
        let two: Two = flexsc_formats::document::from_text(text).unwrap();
        DirectionPair { primary: two.primary, secondary: two.secondary }
    }

    #[test]
    fn attitudes_rates_and_accelerations_are_those_of_forty_digits() {
        let nadir_sun = "primary = { body = [0, 0, 1], along = \"nadir\" }\nsecondary = { body = [1, 0, 0], along = \"sun\" }";
        let site = "primary = { body = [0, 0, 2], along = { site = { latitude = 0.79, longitude = -0.8, height = 100 } } }\n\
                    secondary = { body = [0, -3, 0], along = \"orbit_normal\" }";
        let sun_nadir = "primary = { body = [0, 0, 1], along = \"sun\" }\nsecondary = { body = [1, 0, 0], along = \"nadir\" }";
        #[rustfmt::skip]
        let rows = [
            (nadir_sun, 600.0, [0.026_972_507_098_25, -0.950_218_447_910_4, -0.229_461_711_578_2, 0.209_056_710_083_9],
             [-5.186_240_667_48e-5, 0.001_096_144_384_5, 3.342_872_914_15e-5], [3.750_345_44e-8, -1.645_859_78e-8, -1.046_407_64e-7]),
            (nadir_sun, 1500.0, [0.110_993_015_437_6, -0.937_814_501_651_7, -0.192_605_049_847_3, -0.266_622_965_607_2],
             [-4.657_793_210_71e-5, 0.001_076_427_876_1, -1.999_847_843_8e-5], [-2.055_782_64e-8, -2.332_747_94e-8, -6.820_709_01e-8]),
            (site, 100.0, [0.839_303_476_735_5, 0.105_997_794_078_7, -0.523_933_499_224_2, 0.099_135_412_345_21],
             [-0.000_908_060_783_476, -0.002_974_821_699_73, -0.000_387_980_951_685], [-8.405_873_72e-6, -2.475_809_47e-5, -5.976_257_66e-6]),
            (site, 250.0, [0.467_162_961_538, 0.121_830_206_781, -0.865_572_836_719_9, -0.133_040_717_133_6],
             [-0.000_984_177_933_4, -0.012_799_836_368_9, -0.004_989_255_378_97], [5.680_058_11e-5, -2.970_684_38e-5, -2.609_075_82e-5]),
            (site, 400.0, [0.148_284_984_927_3, -0.200_571_306_164_2, 0.946_525_917_878_6, 0.204_625_025_773_3],
             [0.000_911_576_173_569, -0.003_372_377_368_7, -0.000_757_113_480_328], [-7.894_897_14e-6, 3.056_152_79e-5, 1.009_032_11e-5]),
            (sun_nadir, 1500.0, [0.738_635_657_176_1, -0.099_759_712_060_53, 0.636_397_054_711_5, 0.198_655_869_664_7],
             [0.0, 0.0, -5.068_967_251_04e-5], [0.0, 0.0, -4.579_984_34e-8]),
        ];
        for (text, t, [w, x, y, z], rate, acceleration) in rows {
            let found = pair(text).state_at(&sky(), t);
            let expected = nalgebra::Quaternion::new(w, x, y, z);
            let off = (found.attitude - expected).norm().min((found.attitude + expected).norm());
            assert!(off < 2e-12, "{t}: {off:e}");
            let off = (found.rate - Vector::from(rate)).norm();
            // The digits of the oracle end at 1e-13.
            assert!(off < 1e-13, "{t}: {off:e}");
            let off = (found.acceleration - Vector::from(acceleration)).norm();
            assert!(off < 2e-8 * found.acceleration.norm(), "{t}: {off:e}");
        }
    }

    /// Attitudes with an axis along the field or along one of the local axes: 40 digits, `tests/golden/field_references.py`.
    #[test]
    fn attitudes_along_the_field_are_those_of_forty_digits() {
        // 2025-01-01T00:00:00Z.
        let sky = |degree: u32| magnetic_sky(&format!("model = \"IGRF-14\", degree = {degree}"));
        let field = "{ body = [0, 0, 1], along = \"field\" }";
        let pairs = [
            (13, format!("primary = {field}\nsecondary = {{ body = [1, 0, 0], along = \"sun\" }}")),
            (
                1,
                format!(
                    "primary = {{ body = [0, 0, 1], along = \"nadir\" }}\nsecondary = {}",
                    field.replace("0, 0, 1", "1, 0, 0")
                ),
            ),
            (
                4,
                format!(
                    "primary = {{ body = [0, 0, 1], along = {{ orbit = [0.3, 0.1, 1] }} }}\nsecondary = {}",
                    field.replace("0, 0, 1", "1, 0, 0")
                ),
            ),
        ];
        #[rustfmt::skip]
        let rows = [
            (0, 600.0, [-0.003_561_327_245_118, 0.928_334_059_895_6, 0.229_587_518_908_4, -0.292_357_249_521_1],
             [5.009_466_030_962e-6, 0.001_734_216_084_533, -4.676_085_995_002e-6], [2.651_169_520_032e-7, -1.024_145_040_696e-6, -2.312_162_518_76e-7]),
            (0, 1500.0, [-0.214_637_780_380_8, 0.881_155_537_495_1, 0.149_640_242_179_4, 0.393_831_613_631_2],
             [0.000_272_627_148_975_7, 0.001_853_250_511_75, 0.000_242_129_867_506_2], [7.377_690_806_662e-7, 7.776_715_411_903e-7, 1.559_016_039_788e-6]),
            (1, 600.0, [-0.210_764_178_545_3, -0.121_042_978_133, 0.970_008_439_795_5, 0.003_268_824_314_491],
             [-0.000_194_656_265_714_3, -0.001_079_968_128_748, 0.000_741_723_820_118_7], [-7.978_074_499_416e-7, 1.623_050_099_532e-7, 5.993_097_087_669e-6]),
            (1, 1500.0, [-0.105_257_126_890_4, 0.933_474_241_300_9, 0.212_646_621_329, 0.268_939_012_610_5],
             [-9.263_366_367_309e-5, 0.001_073_445_611_361, 9.059_671_008_663e-5], [9.917_796_249_782e-8, -1.394_163_787_347e-8, -3.268_001_395_194e-7]),
            (2, 600.0, [0.086_013_106_357_09, 0.925_302_420_543_4, -0.126_709_380_555_8, -0.346_932_138_826_3],
             [0.000_690_702_559_246_2, 0.000_846_288_792_793_6, -0.003_225_195_648_362], [-2.652_362_910_46e-6, 2.141_337_020_98e-6, 2.033_836_650_077e-5]),
            (2, 1500.0, [-0.132_276_962_632_2, 0.956_847_973_080_1, 0.228_948_167_140_6, 0.120_530_072_315_1],
             [-7.985_688_050_889e-5, 0.001_069_549_448_707, -0.000_335_252_283_210_8], [-2.470_332_213_75e-7, -4.082_143_142_068e-8, 6.140_774_752_967e-7]),
        ];
        for (place, t, [w, x, y, z], rate, acceleration) in rows {
            let (degree, text) = &pairs[place];
            let found = pair(text).state_at(&sky(*degree), t);
            let expected = nalgebra::Quaternion::new(w, x, y, z);
            let off = (found.attitude - expected).norm().min((found.attitude + expected).norm());
            assert!(off < 2e-12, "{place} {t}: {off:e}");
            let off = (found.rate - Vector::from(rate)).norm();
            assert!(off < 1e-14, "{place} {t}: {off:e}");
            let off = (found.acceleration - Vector::from(acceleration)).norm();
            assert!(off < 1e-10 * found.acceleration.norm(), "{place} {t}: {off:e}");
        }
    }

    /// The bound of the field's rate holds over the time that it is for, and a field along the nadir is found.
    #[test]
    fn the_rate_of_the_field_is_bounded() {
        for keys in
            ["model = \"IGRF-14\"", "model = \"dipole\"", "coefficients = [3e-6, 0, 1e-6], rotation = 2e-4"]
        {
            let sky = magnetic_sky(keys);
            let mut tightest: f64 = 0.0;
            for k in 0..580 {
                let t = 10.0 * f64::from(k);
                let bound = SkyDirection::Field.fastest(&sky, t);
                for part in [0.0, 0.5, 1.0] {
                    let rate = SkyDirection::Field.motion(&sky, t + part / bound).rate.norm();
                    assert!(rate <= bound, "{keys} {t}: {rate} {bound}");
                    tightest = tightest.max(rate / bound);
                }
            }
            assert!(tightest > 0.1, "{keys}: {tightest}");
        }
        // Over the magnetic pole of a dipole along the axis the field is along the nadir.
        let sky = magnetic_sky("coefficients = [0, 0, -3e-5]");
        let two = pair(
            "primary = { body = [0, 0, 1], along = \"nadir\" }\nsecondary = { body = [1, 0, 0], along = \"field\" }",
        );
        assert_eq!(two.validate(&sky, 0.0), None);
        let polar = from_text(
            "orbit = { semi_major_axis = 7e6, inclination = 1.5707963267948966 }\nmagnetic_field = { coefficients = [0, 0, -3e-5] }",
        );
        let fault = two.validate(&polar, 0.0).unwrap();
        // A quarter of a revolution of 5829 s.
        assert!(fault.key == "secondary.along" && fault.why.contains("at 145"), "{fault:?}");
    }

    fn from_text(text: &str) -> OrbitEnvironment {
        let environment = flexsc_formats::document::from_text(text).unwrap();
        OrbitEnvironment::new(&environment, Span::from_seconds(6000.0), Some(1_735_689_600_000_000_000))
    }

    /// Orbit and Sun of the oracle with a magnetic field, whose meridian is at 1.1 rad.
    fn magnetic_sky(field: &str) -> OrbitEnvironment {
        from_text(&format!(
            "orbit = {{ semi_major_axis = 6.978e6, eccentricity = 0.01, inclination = 1.7, node = 0.4, perigee = 0.3, anomaly = 0.2 }}\n\
             sun = [0.9, 0.4, 0.17]\nmagnetic_field = {{ meridian = 1.1, {field} }}"
        ))
    }

    /// The bounds of the rates hold, and the least angle between nadir and Sun is 0.0398 rad, at 5495 s.
    #[test]
    fn the_least_angle_is_certified() {
        let sky = sky();
        for along in ["\"nadir\"", "\"velocity\"", "{ site = { latitude = 0.79, longitude = -0.8 } }"] {
            let text = format!(
                "primary = {{ body = [0, 0, 1], along = {along} }}\nsecondary = {{ body = [1, 0, 0], along = \"sun\" }}"
            );
            let direction = pair(&text).primary.along;
            for k in 0..600 {
                let motion = direction.motion(&sky, 10.0 * f64::from(k));
                assert!(
                    motion.rate.norm() <= direction.fastest(&sky, 10.0 * f64::from(k)) * (1.0 + 1e-12),
                    "{along} {k}"
                );
            }
        }
        let near = pair(
            "primary = { body = [0, 0, 1], along = \"nadir\" }\nsecondary = { body = [1, 0, 0], along = \"sun\" }",
        );
        assert!((near.angle(&sky, 5495.0) - 0.0398).abs() < 1e-4, "{}", near.angle(&sky, 5495.0));
        assert_eq!(near.validate(&sky, 0.0), None);
        // The velocity of a circular orbit in the plane of the Sun passes it.
        let flat =
            flexsc_formats::document::from_text("orbit = { semi_major_axis = 7e6 }\nsun = [1, 0.2, 0]");
        let flat = OrbitEnvironment::new(&flat.unwrap(), Span::from_seconds(6000.0), None);
        let fault = pair("primary = { body = [1, 0, 0], along = \"velocity\" }\nsecondary = { body = [0, 0, 1], along = \"sun\" }")
            .validate(&flat, 0.0)
            .unwrap();
        assert!(fault.key == "secondary.along" && fault.why.contains("is not defined there"), "{fault:?}");
    }

    #[test]
    fn axes_and_directions_that_do_not_fit_are_refused() {
        let none = OrbitEnvironment::default();
        let fault = |primary: &str, secondary: &str, sky: &OrbitEnvironment| {
            let text = format!("primary = {{ {primary} }}\nsecondary = {{ {secondary} }}");
            pair(&text).validate(sky, 0.0).map(|fault| fault.key)
        };
        let nadir = "body = [0, 0, 1], along = \"nadir\"";
        assert_eq!(
            fault(nadir, "body = [1, 0, 0], along = \"sun\"", &none),
            Some("primary.along".to_owned())
        );
        let inertial = "body = [0, 0, -2], along = { inertial = [1, 0, 0] }";
        assert_eq!(fault(nadir, inertial, &sky()), Some("secondary.body".to_owned()));
        let zero = "body = [1, 0, 0], along = { inertial = [0, 0, 0] }";
        assert_eq!(fault(nadir, zero, &sky()), Some("secondary.along".to_owned()));
        let field = "body = [1, 0, 0], along = \"field\"";
        assert_eq!(fault(nadir, field, &sky()), Some("secondary.along".to_owned()));
        let zero = magnetic_sky("coefficients = [0, 0, 0]");
        assert_eq!(fault(nadir, field, &zero), Some("secondary.along".to_owned()));
        let local = "body = [1, 0, 0], along = { orbit = [0, 0, -1] }";
        assert_eq!(fault(nadir, local, &none), Some("primary.along".to_owned()));
        assert_eq!(fault(nadir, local, &sky()), Some("secondary.along".to_owned()));
        assert_eq!(fault(nadir, &local.replace("-1", "0"), &sky()), Some("secondary.along".to_owned()));
        let high = "body = [1, 0, 0], along = { site = { latitude = 0, longitude = 0, height = 1e6 } }";
        assert_eq!(fault(nadir, high, &sky()), Some("secondary.along".to_owned()));
    }
}
