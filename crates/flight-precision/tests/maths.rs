//! Functions of mathematics in single precision, beside those in double precision.

use flexsc_flight::{inverse_trigonometry as double_inverse, trigonometry as double};
use flexsc_flight_precision::{inverse_trigonometry, maths, square_root, trigonometry};

/// Step through the bits of floats: a prime, so that all exponents and digits come.
const STEP: usize = 997;

/// Returns a sample of all floats.
fn floats() -> impl Iterator<Item = f32> {
    (0..=u32::MAX).step_by(STEP).map(f32::from_bits)
}

/// Returns a difference from an exact value in units of the last place of its float.
fn units(found: f32, exact: f64) -> f64 {
    let nearest = (exact as f32).abs().max(f32::MIN_POSITIVE);
    let unit = f64::from(nearest.next_up()) - f64::from(nearest);
    (f64::from(found) - exact).abs() / unit
}

#[test]
fn angles_have_an_error_of_three_units_of_the_last_place() {
    let mut worst = [0.0_f64; 3];
    for x in floats().filter(|x| x.is_finite()) {
        let found = trigonometry::sincos(x);
        let exact = double::sincos(f64::from(x));
        worst[0] = worst[0].max(units(found.sin, exact.sin));
        worst[1] = worst[1].max(units(found.cos, exact.cos));
        assert_eq!((trigonometry::sin(x), trigonometry::cos(x)), (found.sin, found.cos));
        worst[2] = worst[2].max(units(inverse_trigonometry::atan(x), double_inverse::atan(f64::from(x))));
    }
    assert!(worst[0] < 3.0 && worst[1] < 3.0 && worst[2] < 1.0, "{worst:?}");
    // The float nearest to a multiple of pi/2: 16367173 2^72.
    let nearest = f32::from_bits((((72 + 23) + 127) << 23) | (0xf9_be45 & 0x7f_ffff));
    assert!(units(trigonometry::cos(nearest), double::cos(f64::from(nearest))) < 3.0);
    assert!(units(trigonometry::sin(nearest), double::sin(f64::from(nearest))) < 3.0);
    for x in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        let found = trigonometry::sincos(x);
        assert!(found.sin.is_nan() && found.cos.is_nan() && trigonometry::tan(x).is_nan());
    }
}

#[test]
fn tangents_and_points_have_an_error_of_some_units() {
    let mut worst = [0.0_f64; 2];
    let mut other = 1.0_f32;
    for x in floats().filter(|x| x.is_finite()) {
        worst[0] = worst[0].max(units(trigonometry::tan(x), double::tan(f64::from(x))));
        let exact = double_inverse::atan2(f64::from(x), f64::from(other));
        worst[1] = worst[1].max(units(inverse_trigonometry::atan2(x, other), exact));
        // Of sizes near x and far from it, with both signs.
        other = if x.abs() < 1e30 { -1.37 * x + other.signum() } else { 0.5 };
    }
    assert!(worst[0] < 4.0 && worst[1] < 3.0, "{worst:?}");
    let corners = [(0.0, -1.0), (-0.0, -1.0), (1.0, 0.0), (-1.0, -0.0), (f32::INFINITY, f32::NEG_INFINITY)];
    for (y, x) in corners {
        assert_eq!(inverse_trigonometry::atan2(y, x), double_inverse::atan2(y.into(), x.into()) as f32);
    }
}

#[test]
fn roots_and_integers_are_those_of_the_processor() {
    for x in floats() {
        let (root, known) = (square_root::sqrt(x), x.sqrt());
        assert!(root.to_bits() == known.to_bits() || root.is_nan() && known.is_nan(), "{x:e}");
        if !x.is_nan() {
            assert_eq!(maths::trunc(x).to_bits(), x.trunc().to_bits(), "{x:e}");
            assert_eq!(maths::round(x).to_bits(), x.round().to_bits(), "{x:e}");
        }
    }
}
