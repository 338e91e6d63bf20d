//! The Moon: its position as seen from the Earth's centre at a date, by the largest terms of the lunar theory in
//! \[Meeus98\], chapter 47.
//!
//! Longitude and latitude are sums of sines, the distance is a sum of cosines, of the arguments D (elongation from the
//! Sun), M and M' (mean anomalies of Sun and Moon), and F (distance from the node). Of the theory's 60 terms each, the
//! largest are taken here: the direction errs by less than 2e-3 rad.

use flexsc_numerics::attitude::Vector;

use super::date::{DAY, J2000};

/// Mean distance (m).
const MEAN_DISTANCE: f64 = 385_000.56e3;

/// Least distance from the Earth's centre (m), below all perigees.
pub(super) const NEAREST: f64 = 3.56e8;

/// Upper bound of the speed (m/s), reached at perigees.
pub(super) const FASTEST: f64 = 1.11e3;

/// Terms of longitude and distance: multiples of D, M, M' and F, coefficients (1e-6 degrees and m).
const ALONG: [([f64; 4], f64, f64); 20] = [
    ([0.0, 0.0, 1.0, 0.0], 6_288_774.0, -20_905_355.0),
    ([2.0, 0.0, -1.0, 0.0], 1_274_027.0, -3_699_111.0),
    ([2.0, 0.0, 0.0, 0.0], 658_314.0, -2_955_968.0),
    ([0.0, 0.0, 2.0, 0.0], 213_618.0, -569_925.0),
    ([0.0, 1.0, 0.0, 0.0], -185_116.0, 48_888.0),
    ([0.0, 0.0, 0.0, 2.0], -114_332.0, -3_149.0),
    ([2.0, 0.0, -2.0, 0.0], 58_793.0, 246_158.0),
    ([2.0, -1.0, -1.0, 0.0], 57_066.0, -152_138.0),
    ([2.0, 0.0, 1.0, 0.0], 53_322.0, -170_733.0),
    ([2.0, -1.0, 0.0, 0.0], 45_758.0, -204_586.0),
    ([0.0, 1.0, -1.0, 0.0], -40_923.0, -129_620.0),
    ([1.0, 0.0, 0.0, 0.0], -34_720.0, 108_743.0),
    ([0.0, 1.0, 1.0, 0.0], -30_383.0, 104_755.0),
    ([2.0, 0.0, 0.0, -2.0], 15_327.0, 10_321.0),
    ([0.0, 0.0, 1.0, 2.0], -12_528.0, 0.0),
    ([0.0, 0.0, 1.0, -2.0], 10_980.0, 79_661.0),
    ([4.0, 0.0, -1.0, 0.0], 10_675.0, -34_782.0),
    ([0.0, 0.0, 3.0, 0.0], 10_034.0, -23_210.0),
    ([4.0, 0.0, -2.0, 0.0], 8_548.0, -21_636.0),
    ([2.0, 1.0, -1.0, 0.0], -7_888.0, 24_208.0),
];

/// Terms of latitude: multiples of D, M, M' and F, coefficient (1e-6 degrees).
const ACROSS: [([f64; 4], f64); 10] = [
    ([0.0, 0.0, 0.0, 1.0], 5_128_122.0),
    ([0.0, 0.0, 1.0, 1.0], 280_602.0),
    ([0.0, 0.0, 1.0, -1.0], 277_693.0),
    ([2.0, 0.0, 0.0, -1.0], 173_237.0),
    ([2.0, 0.0, -1.0, 1.0], 55_413.0),
    ([2.0, 0.0, -1.0, -1.0], 46_271.0),
    ([2.0, 0.0, 0.0, 1.0], 32_573.0),
    ([0.0, 0.0, 2.0, 1.0], 17_198.0),
    ([2.0, 0.0, 1.0, -1.0], 9_266.0),
    ([0.0, 0.0, 2.0, -1.0], 8_822.0),
];

/// Returns the position (m) from the Earth's centre at `seconds` after J2000, in axes of the Earth's equator of the date,
/// x to the equinox.
pub(super) fn position(seconds: f64) -> Vector {
    let days = seconds / DAY;
    let centuries = days / 36_525.0;
    let degrees = |at_epoch: f64, rate: f64, bend: f64| at_epoch + centuries * (rate + centuries * bend);
    let arguments = [
        degrees(297.850_192_1, 445_267.111_403_4, -1.881_9e-3),
        degrees(357.529_109_2, 35_999.050_290_9, -1.536e-4),
        degrees(134.963_396_4, 477_198.867_505_5, 8.741_4e-3),
        degrees(93.272_095_0, 483_202.017_523_3, -3.653_9e-3),
    ];
    let sine_and_cosine = |multiples: &[f64; 4]| {
        let angle: f64 =
            multiples.iter().zip(arguments).map(|(multiple, argument)| multiple * argument).sum();
        libm::sincos(libm::fmod(angle, 360.0).to_radians())
    };
    let (mut longitude, mut distance) = (0.0, MEAN_DISTANCE);
    for (multiples, along, away) in &ALONG {
        let (sin, cos) = sine_and_cosine(multiples);
        longitude += along * sin;
        distance += away * cos;
    }
    let latitude: f64 = ACROSS.iter().map(|(multiples, across)| across * sine_and_cosine(multiples).0).sum();
    let mean = libm::fmod(degrees(218.316_447_7, 481_267.881_234_21, -1.578_6e-3), 360.0);
    let (sin, cos) = libm::sincos((mean + 1e-6 * longitude).to_radians());
    let (up, across) = libm::sincos((1e-6 * latitude).to_radians());
    let (tilt_sin, tilt_cos) = libm::sincos((23.439 - 4e-7 * days).to_radians());
    let [x, y] = [across * cos, across * sin];
    Vector::new(x, tilt_cos * y - tilt_sin * up, tilt_sin * y + tilt_cos * up) * distance
}

/// Returns the time (s) after J2000 of a scenario that begins `epoch_ns` nanoseconds after 1970, UTC.
pub(super) fn since_j2000(epoch_ns: u64) -> f64 {
    epoch_ns as f64 / 1e9 - J2000
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_where_erfa_has_it() {
        // Seconds since 1970 (`date --utc +%s`); direction, mean of date, and distance (km) by ERFA's moon98 and bp06.
        for (seconds, direction, distance) in [
            (1_774_017_960, [0.934_862, 0.296_752, 0.194_862], 368_758.6), // 2026-03-20T14:46:00Z
            (1_782_030_240, [-0.992_585, 0.120_379, 0.016_871], 385_185.1), // 2026-06-21T08:24:00Z
            (1_795_478_400, [0.598_916, 0.695_693, 0.396_625], 362_491.3), // 2026-11-24T00:00:00Z
            (1_798_977_600, [-0.564_244, -0.717_276, -0.408_832], 401_383.6), // 2027-01-03T12:00:00Z
            (1_914_517_800, [-0.880_427, -0.407_312, -0.242_787], 372_192.7), // 2030-09-01T18:30:00Z
        ] {
            let found = position(since_j2000(seconds * 1_000_000_000));
            let off = (found.normalize() - Vector::from(direction)).norm();
            assert!(off < 2e-3, "{seconds}: {off:e}");
            assert!((found.norm() / (1e3 * distance) - 1.0).abs() < 1e-3, "{seconds}: {}", found.norm());
        }
    }

    /// Over nineteen years, a cycle of the node, in steps of an hour.
    #[test]
    fn distance_and_speed_keep_their_bounds() {
        let mut before = position(8e8);
        for hour in 1..166_600 {
            let now = position(8e8 + 3600.0 * f64::from(hour));
            let speed = (now - before).norm() / 3600.0;
            assert!(now.norm() > NEAREST && speed < FASTEST, "{hour}: {} {speed}", now.norm());
            before = now;
        }
    }
}
