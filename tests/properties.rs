//! Properties that hold for all values: quaternions, times, polynomials, and documents. Every test draws the
//! same cases.

use std::f64::consts::PI;
use std::fmt::Debug;
use std::ops::Range;

use flexsc_core::Document;
use flexsc_core::numerics::attitude::{
    Vector, angles, from_axes, from_yaw_pitch_roll, rotation, rotation_vector,
};
use flexsc_core::numerics::polynomial::{Polynomial, TERMS};
use flexsc_core::numerics::time::{Instant, Span};
use nalgebra::{Matrix3, Quaternion};
use proptest::array::{uniform3, uniform22};
use proptest::collection::{btree_map, vec};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use toml::{Table, Value};

/// Checks a property on `cases` values, always the same, and panics with the simplest value that it does not
/// hold for.
#[track_caller]
pub fn holds<S: Strategy>(cases: u32, of: S, property: impl Fn(S::Value) -> Result<(), TestCaseError>)
where
    S::Value: Debug,
{
    let config =
        Config { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..Config::default() };
    TestRunner::new(config).run(&of, property).unwrap_or_else(|error| panic!("{error}"));
}

/// Numbers of an interval.
pub fn between(low: f64, high: f64) -> Range<f64> {
    low..high
}

/// Angles from 0 to half a turn (rad): tiny ones, all, and those near half a turn.
fn angle() -> impl Strategy<Value = f64> {
    prop_oneof![
        between(-300.0, -1.0).prop_map(|exponent| 10_f64.powf(exponent)),
        between(0.0, PI),
        between(-17.0, -1.0).prop_map(|exponent| PI - 10_f64.powf(exponent)),
    ]
}

fn direction() -> impl Strategy<Value = Vector> {
    let cube = uniform3(between(-1.0, 1.0)).prop_map(Vector::from);
    cube.prop_filter("a direction", |v| v.norm() > 0.1).prop_map(|v| v.normalize())
}

fn rotation_by() -> impl Strategy<Value = Vector> {
    (direction(), angle()).prop_map(|(direction, angle)| direction * angle)
}

/// Rodrigues' formula.
fn matrix(by: &Vector) -> Matrix3<f64> {
    let angle = by.norm();
    let a = if angle == 0.0 { Matrix3::zeros() } else { (by / angle).cross_matrix() };
    Matrix3::identity() + a * angle.sin() + a * a * (1.0 - angle.cos())
}

fn turned(q: &Quaternion<f64>, v: &Vector) -> Vector {
    (q * Quaternion::from_imag(*v) * q.conjugate()).vector().into_owned()
}

#[test]
fn rotation_vectors_come_back_at_all_angles() {
    holds(4000, (rotation_by(), rotation_by(), any::<bool>()), |(start, by, negative)| {
        let from = rotation(&start);
        let to = from * rotation(&by) * if negative { -1.0 } else { 1.0 };
        let found = rotation_vector(&from, &to);
        // At half a turn either direction is right.
        let other = by - by.normalize() * (2.0 * PI);
        let off = (found - by).norm().min((found - other).norm());
        prop_assert!(off <= 4e-15 * by.norm().max(1.0), "{found} is off by {off:e}");
        prop_assert!(found.norm() <= PI + 4e-15);
        // A tiny one keeps its digits if nothing is added to it.
        let tiny = rotation_vector(&rotation(&Vector::zeros()), &rotation(&by));
        prop_assert!((tiny - by).norm() <= 4e-15 * by.norm() || by.norm() > PI - 1e-14, "{tiny}");
        Ok(())
    });
}

#[test]
fn products_of_quaternions_are_those_of_matrices() {
    holds(4000, (rotation_by(), rotation_by(), direction(), between(-PI, PI)), |(a, b, v, more)| {
        let (p, q) = (rotation(&a), rotation(&b));
        prop_assert!((p.norm() - 1.0).abs() <= 4.0 * f64::EPSILON);
        let off = (turned(&(p * q), &v) - matrix(&a) * matrix(&b) * v).norm();
        prop_assert!(off <= 8e-15, "{off:e}");
        let inverse = p * rotation(&-a);
        prop_assert!((inverse - Quaternion::identity()).norm() <= 4.0 * f64::EPSILON);
        // About one axis angles add.
        let [one, other] = [a.norm(), more].map(|angle| rotation(&(v * angle)));
        let off = (one * other - rotation(&(v * (a.norm() + more)))).norm();
        prop_assert!(off <= 2e-15, "{off:e}");
        Ok(())
    });
}

#[test]
fn attitudes_come_back_from_their_axes_and_their_angles() {
    let (half, quarter) = (between(-PI, PI), between(-0.499 * PI, 0.499 * PI));
    holds(4000, (rotation_by(), half.clone(), quarter, half), |(by, roll, pitch, yaw)| {
        let q = rotation(&by);
        let found = from_axes(&[Vector::x(), Vector::y(), Vector::z()].map(|axis| turned(&q, &axis)));
        prop_assert!(rotation_vector(&q, &found).norm() <= 4e-15);
        // Near a pitch of a quarter turn roll and yaw lose digits as 1/cos(pitch).
        let found = angles(&from_yaw_pitch_roll(roll, pitch, yaw));
        let off = Vector::from(found) - Vector::new(roll, pitch, yaw);
        prop_assert!(off.norm() * pitch.cos() <= 4e-15, "{found:?} is off by {off}");
        Ok(())
    });
}

const FEMTOSECONDS: i128 = 1_000_000_000_000_000;

fn count(at: Instant) -> i128 {
    let (whole, part) = at.parts();
    i128::from(whole as i64) * FEMTOSECONDS + i128::from(part)
}

/// Instants of up to 300 000 years, and spans.
fn instant() -> impl Strategy<Value = Instant> {
    let whole = prop_oneof![0..10_u64, 0..10_000_000_000_000_u64];
    (whole, 0..FEMTOSECONDS as u64).prop_map(|(whole, part)| Instant::from_parts(whole, part))
}

fn span() -> impl Strategy<Value = Span> {
    let short = any::<i64>().prop_map(Span::from_femtoseconds);
    prop_oneof![short, between(-1e13, 1e13).prop_map(Span::from_seconds)]
}

#[test]
fn times_are_integers() {
    holds(4000, (instant(), instant(), span(), span()), |(a, b, s, t)| {
        prop_assert_eq!(a.cmp(&b), count(a).cmp(&count(b)));
        prop_assert_eq!((a + s).since(a), s);
        prop_assert_eq!((a + s).before(s), a);
        prop_assert_eq!(a + s + t, a + (t + s));
        prop_assert_eq!((s + t).remaining_after(t), s);
        prop_assert_eq!(count(Instant::START + b.since(a)), count(b) - count(a));
        if a.parts().0 < 10_000_000_000 {
            prop_assert_eq!(i128::from(a.nanoseconds()), count(a) / 1_000_000);
        }
        // Printed decimals are read as they are.
        let text = a.to_string();
        let (whole, part) = text.split_once('.').expect("decimals");
        prop_assert_eq!(
            Instant::from_parts(whole.parse().expect("digits"), part.parse().expect("digits")),
            a
        );
        Ok(())
    });
}

#[test]
fn seconds_are_rounded_to_ticks_and_stay_within_limits() {
    holds(4000, (any::<f64>(), 1..1_000_000_000_000_000_i64, 0..16_u32), |(seconds, digits, decimals)| {
        let span = Span::from_seconds(seconds);
        let limited = if seconds.is_nan() { 0.0 } else { seconds.clamp(-1e16, 1e16) };
        prop_assert_eq!(span, Span::from_seconds(limited));
        // Half a tick, and the rounding of a double three times.
        prop_assert!((span.seconds() - limited).abs() <= 0.51e-15 + 3.4e-16 * limited.abs());
        // Decimals below a second are exact, to the last of 15 digits.
        let fraction = digits % 10_i64.pow(decimals).max(1);
        let text = format!("0.{fraction:0width$}", width = decimals as usize);
        let exact = fraction * 10_i64.pow(15 - decimals);
        let read = Span::from_seconds(text.parse().expect("a number"));
        prop_assert_eq!(read, Span::from_femtoseconds(exact));
        // Scenarios take what is positive and at most 300 000 years.
        let written = format!("duration = {seconds:e}").parse::<Table>().ok();
        let written = written.and_then(|table| table["duration"].clone().try_into::<Span>().ok());
        let is_taken = span > Span::ZERO && seconds <= 1e13;
        prop_assert_eq!(written, is_taken.then_some(span));
        Ok(())
    });
}

/// Polynomials of degree 9 at most: shifted ones of higher degrees lose more digits than the tests allow.
fn polynomial() -> impl Strategy<Value = Polynomial> {
    (1..10_usize, uniform22(between(-1.0, 1.0))).prop_map(|(count, mut terms)| {
        terms[count..].fill(0.0);
        Polynomial::new(terms)
    })
}

#[test]
fn polynomials_agree_with_their_parts_and_derivatives() {
    holds(4000, (polynomial(), uniform3(between(0.0, 1.0))), |(p, [a, b, s])| {
        let off = p.restrict(a, b).at(s) - p.at(a + (b - a) * s);
        prop_assert!(off.abs() <= 1e-12, "{off:e}");
        let [whole, first, second] = [(0.0, b), (0.0, a), (a, b)].map(|(from, to)| p.integrals(from, to));
        for moment in 0..2 {
            prop_assert!((whole[moment] - first[moment] - second[moment]).abs() <= 1e-12);
        }
        let off = p.derivative().integrals(a, b)[0] - (p.at(b) - p.at(a));
        prop_assert!(off.abs() <= 1e-12, "{off:e}");
        let (low, high) = p.bounds();
        let (top, size) = (p.maximum(f64::NEG_INFINITY), p.magnitude(0.0));
        prop_assert!(top <= high + 1e-13 && p.at(s) <= top + 1e-13 && p.at(s) >= low - 1e-13);
        prop_assert!(p.at(s).abs() <= size + 1e-13 && size <= high.max(-low) + 1e-13);
        // The maximum is attained: at an end, or where the derivative vanishes.
        let mut places = vec![0.0, 1.0];
        p.derivative().roots(0.0, &mut places);
        let best = places.iter().map(|place| p.at(*place)).fold(f64::NEG_INFINITY, f64::max);
        prop_assert!((top - best).abs() <= 1e-9, "{top} {best}");
        Ok(())
    });
}

#[test]
fn roots_of_polynomials_are_those_that_they_are_made_of() {
    // Gaps of a tenth and more: closer roots lose more digits than the test allows.
    let gaps = vec(between(0.1, 0.5), 1..7);
    holds(4000, (gaps, between(-3.0, 3.0), between(0.5, 2.0)), |(gaps, level, scale)| {
        let mut exact = Vec::new();
        let mut place = 0.0;
        for gap in gaps {
            place += gap;
            if place < 0.95 {
                exact.push(place);
            }
        }
        let mut terms = [0.0; TERMS];
        terms[0] = scale;
        for root in &exact {
            for n in (1..TERMS).rev() {
                terms[n] = terms[n - 1] - root * terms[n];
            }
            terms[0] *= -root;
        }
        terms[0] += level;
        let mut found = Vec::new();
        Polynomial::new(terms).roots(level, &mut found);
        prop_assert_eq!(found.len(), exact.len(), "{:?} {:?}", &found, &exact);
        for (found, exact) in found.iter().zip(&exact) {
            prop_assert!((found - exact).abs() <= 1e-9, "{found} {exact}");
        }
        Ok(())
    });
}

/// Values of documents: every kind but dates, which no scenario has.
fn value() -> impl Strategy<Value = Value> {
    let number = prop_oneof![any::<f64>(), (-20..20_i32).prop_map(|n| f64::from(n) * 0.1)];
    let leaf = prop_oneof![
        any::<bool>().prop_map(Value::Boolean),
        any::<i64>().prop_map(Value::Integer),
        // NaN does not equal itself.
        number.prop_filter("a number", |x| !x.is_nan()).prop_map(Value::Float),
        any::<String>().prop_map(Value::String),
    ];
    leaf.prop_recursive(3, 24, 4, |inner| {
        let tables = btree_map(key(), inner.clone(), 0..4);
        prop_oneof![
            vec(inner, 0..4).prop_map(Value::Array),
            tables.prop_map(|entries| Value::Table(entries.into_iter().collect())),
        ]
    })
}

fn key() -> impl Strategy<Value = String> {
    prop_oneof![4 => "[a-z][a-z_]{0,8}", 1 => any::<String>()]
}

#[test]
fn documents_come_back_from_their_text() {
    holds(2000, btree_map(key(), value(), 0..6), |entries| {
        let document = Document::from_table("a table", entries.into_iter().collect());
        let text = toml::to_string(document.table()).expect("TOML");
        let read =
            Document::parse("a text", text.clone()).map_err(|why| TestCaseError::fail(why.to_string()))?;
        prop_assert_eq!(read.table(), document.table(), "{}", text);
        Ok(())
    });
}

#[test]
fn keys_that_are_set_have_their_value() {
    let name = || "[a-z][a-z0-9_]{0,6}";
    holds(1000, (vec(name(), 1..4), value(), value()), |(path, first, second)| {
        let key = path.join(".");
        let mut document = Document::parse("a text", String::new()).expect("empty");
        for value in [first, second] {
            document.set(&key, value.clone()).map_err(|why| TestCaseError::fail(why.to_string()))?;
            prop_assert!(document.has(&key));
            let (first, rest) = path.split_first().expect("a key");
            let found = rest.iter().try_fold(&document.table()[first], |table, name| table.get(name));
            prop_assert_eq!(found, Some(&value));
        }
        Ok(())
    });
}
