//! Precession (IAU 2006, \[Capitaine03\]): the mean equator and equinox of a date, from the axes of 2000.

use flexsc_formats::celestial_frame::CelestialFrame;
use flexsc_numerics::attitude::{Vector, rotation};
use nalgebra::Quaternion;

use super::date::{DAY, J2000};

/// Offsets of the mean pole of 2000 along x and y and of its equinox from the axes of the GCRF (arc seconds).
const BIAS: [f64; 3] = [-0.016_617, -0.006_819_2, -0.0146];

/// Coefficients of powers of the centuries since 2000 in the angles zeta, z and theta (arc seconds).
const ZETA: [f64; 6] = [2.650_545, 2_306.083_227, 0.298_849_9, 0.018_018_28, -5.971e-6, -3.173e-7];
const Z: [f64; 6] = [-2.650_545, 2_306.077_181, 1.092_734_8, 0.018_268_37, -2.8596e-5, -2.904e-7];
const THETA: [f64; 6] = [0.0, 2_004.191_903, -0.429_493_4, -0.041_822_64, -7.089e-6, -1.274e-7];

fn radians(arcseconds: f64) -> f64 {
    (arcseconds / 3600.0).to_radians()
}

/// Returns the unit quaternion that rotates components along the axes of a frame into those along the mean equator and
/// equinox of a date (ns after 1970); `None` of axes that nutation separates from these.
pub fn to_mean_of_date(frame: CelestialFrame, epoch_ns: u64) -> Option<Quaternion<f64>> {
    let centuries = (epoch_ns as f64 / 1e9 - J2000) / (36_525.0 * DAY);
    let angle =
        |powers: [f64; 6]| radians(powers.into_iter().rev().fold(0.0, |sum, of| sum * centuries + of));
    let precession = || {
        rotation(&(Vector::z() * angle(Z)))
            * rotation(&(Vector::y() * -angle(THETA)))
            * rotation(&(Vector::z() * angle(ZETA)))
    };
    match frame {
        CelestialFrame::Mod => Some(Quaternion::identity()),
        CelestialFrame::Eme2000 => Some(precession()),
        CelestialFrame::Gcrf | CelestialFrame::Icrf => {
            let [pole_x, pole_y, equinox] = BIAS.map(radians);
            let bias = rotation(&(Vector::x() * pole_y))
                * rotation(&(Vector::y() * -pole_x))
                * rotation(&(Vector::z() * -equinox));
            Some(precession() * bias)
        }
        CelestialFrame::Teme | CelestialFrame::Tod => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Matrices from GCRF and from EME2000 to the mean axes of dates, by another set of angles: `tests/golden/precession_oracle.py`.
    const GOLDEN: &str = include_str!("../../../../tests/golden/precession.csv");

    #[test]
    fn axes_of_dates_are_those_of_four_other_angles() {
        let mut rows = 0;
        for row in GOLDEN.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let (seconds, frame) =
                (cells[0].parse::<u64>().unwrap(), CelestialFrame::named(cells[1]).unwrap());
            let exact: Vec<f64> = cells[2..].iter().map(|cell| cell.parse().unwrap()).collect();
            let q = nalgebra::UnitQuaternion::new_unchecked(
                to_mean_of_date(frame, seconds * 1_000_000_000).unwrap(),
            );
            let found = q.to_rotation_matrix();
            for (place, exact) in exact.into_iter().enumerate() {
                let found = found[(place / 3, place % 3)];
                // 1e-10 rad are 0.02 milliarcseconds, 0.7 mm in a low orbit.
                assert!((found - exact).abs() < 1e-10, "{row}: {place}: {:e}", found - exact);
            }
            rows += 1;
        }
        assert_eq!(rows, 12);
    }

    #[test]
    fn nutation_separates_true_axes() {
        for frame in [CelestialFrame::Teme, CelestialFrame::Tod] {
            assert_eq!(to_mean_of_date(frame, 0), None);
        }
    }
}
