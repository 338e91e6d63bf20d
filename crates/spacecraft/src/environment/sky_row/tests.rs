//! Arcs against 50 digits, their proved bounds, and the order of calls.

use std::f64::consts::TAU;

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Span;
use flexsc_numerics::time_arcs::{SplitTime, TimeArc};

use crate::environment::sky_row::SkyRow;
use crate::environment::{Environment, Kepler, OrbitEnvironment, OrbitPath};

/// 2027-03-01T06:00:00Z in nanoseconds after 1970.
const EPOCH: u64 = 1_803_880_800_000_000_000;

const ORBITS: [(&str, &str); 3] = [
    ("L", "semi_major_axis = 6878137, inclination = 1.7, node = 0.4, anomaly = 0.1"),
    (
        "E",
        "semi_major_axis = 7020000, eccentricity = 0.02, inclination = 0.9, node = 1.1, perigee = 0.7, anomaly = 0.2",
    ),
    (
        "M",
        "semi_major_axis = 26560000, eccentricity = 0.7, inclination = 1.1071487177940904, node = 2.0, \
         perigee = 4.71238898038469",
    ),
];

fn sky(orbit: &str) -> OrbitEnvironment {
    let text = format!("orbit = {{ {orbit} }}\nmagnetic_field = {{}}\nsun = \"epoch\"");
    let around: Environment = flexsc_formats::document::from_text(&text).unwrap();
    OrbitEnvironment::new(&around, Span::from_seconds(86_400.0), Some(EPOCH))
}

fn kepler(sky: &OrbitEnvironment) -> &Kepler {
    match sky.orbit() {
        Some(OrbitPath::Kepler(orbit)) => orbit,
        other => panic!("{other:?}"),
    }
}

/// Returns the next random number in [0, 1).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// Positions (m), velocities, fields (T) and directions of the Sun at 12 instants of a day and a year on, computed with 50
/// digits (mpmath) from the same elements, IGRF-14, the formulas of the Astronomical Almanac and sidereal time of 1982.
/// Drift rates are rounded to 1e-16, so that the orbit of a year on may be off by 1e-14.
#[test]
fn rows_are_those_of_fifty_digits() {
    let skies = ORBITS.map(|(name, orbit)| (name, sky(&format!("{orbit}, j2 = true"))));
    let mut count = 0;
    for line in include_str!("oracle.txt").lines() {
        let mut words = line.split(' ');
        let name = words.next().unwrap();
        let t: f64 = words.next().unwrap().parse().unwrap();
        let quantity = words.next().unwrap();
        let exact = Vector::from_iterator(words.map(|word| word.parse::<f64>().unwrap()));
        let (_, sky) = skies.iter().find(|(own, _)| *own == name).unwrap();
        let row = sky.row(t);
        let steep = if name == "M" { 8e-15 } else { 3e-15 };
        let (found, tolerance) = match quantity {
            "r" => (row.position(), steep),
            "v" => (row.velocity(), steep),
            "B" => (row.field(), 1e-14),
            _ => (row.light().direction, 3e-15),
        };
        let tolerance = if t > 1e6 && quantity != "s" { 3e-14 } else { tolerance };
        let off = (found - exact).norm() / exact.norm();
        assert!(off < tolerance, "{name} {t} {quantity}: {off:e}");
        count += 1;
    }
    assert_eq!(count, 3 * 13 * 4);
}

/// Random orbits up to an eccentricity of 0.9, on the arc of their perigee and on others.
#[test]
fn proved_bounds_hold_on_random_orbits() {
    let mut seed = 5;
    for case in 0..200 {
        let eccentricity = if case % 4 == 0 { 0.0 } else { 0.9 * random(&mut seed) };
        let perigee = 6_578_137.0 + 2e6 * random(&mut seed);
        let [inclination, node, argument, anomaly] = [(); 4].map(|()| 3.0 * random(&mut seed));
        let sky = sky(&format!(
            "semi_major_axis = {}, eccentricity = {eccentricity}, inclination = {inclination}, node = {node}, \
             perigee = {argument}, anomaly = {anomaly}, j2 = {}",
            perigee / (1.0 - eccentricity),
            case % 2 == 0
        ));
        let (orbit, field) = (kepler(&sky), sky.field());
        let length = orbit.arc_length(field);
        // Arcs of four times the length have errors that rounding does not hide.
        for length in [length, 4.0 * length] {
            let bounds = orbit.arc_errors(field, length);
            let to_perigee = (TAU - anomaly) / orbit.anomaly_rate();
            let first = length * libm::floor(to_perigee / length);
            let direct = |t: SplitTime| SkyRow::new(sky.orbit(), field, sky.sun(), false, t).0;
            let (arc, _) = TimeArc::new([first, first + length], direct);
            let sizes = [orbit.farthest(), sky.field_bound()];
            for _ in 0..500 {
                let t = first + length * random(&mut seed);
                let (found, exact) = (SkyRow(arc.at(t)), SkyRow(direct(t.into())));
                let offs = [found.position() - exact.position(), found.field() - exact.field()];
                for ((off, bound), size) in offs.iter().zip(bounds).zip(sizes) {
                    assert!(off.norm() <= bound + 4e-15 * size, "{case} {t}: {:e} {bound:e}", off.norm());
                }
            }
        }
    }
}

#[test]
fn lengths_are_those_of_the_specification() {
    for (orbit, length) in [
        (ORBITS[0].1, 256.0),
        (ORBITS[1].1, 256.0),
        (ORBITS[2].1, 128.0),
        ("semi_major_axis = 42164170, eccentricity = 0.0003", 4096.0),
        ("semi_major_axis = 6578137", 256.0),
        ("semi_major_axis = 24400000, eccentricity = 0.73", 128.0),
    ] {
        let sky = sky(orbit);
        assert_eq!(kepler(&sky).arc_length(sky.field()), length, "{orbit}");
    }
}

/// Where an orbit takes 6 s, arcs are as much shorter.
#[test]
fn arcs_of_fast_orbits_follow_them() {
    let sky = sky("semi_major_axis = 10, planet_radius = 1, gravity = 1000");
    for t in (0..100).map(|k| 0.37 * f64::from(k)) {
        let off = (sky.row(t).position() - kepler(&sky).at(t).position).norm();
        assert!(off < 1e-12, "{t}: {off:e}");
    }
}

/// Times are those of two arcs' border, within arcs, before the start and after the end; more arcs than are kept.
#[test]
fn rows_have_the_same_bits_in_any_order() {
    let tle = "tle = [\"1 25544U 98067A   27059.50000000  .00016717  00000-0  10270-3 0  9005\", \
               \"2 25544  51.6400 208.9163 0006317  69.9862  25.2906 15.49560000000019\"]";
    let deep = "tle = [\"1 22675U 93036A   27059.50000000  .00000010  00000-0  10000-3 0  9008\", \
                \"2 22675  63.4000 250.0000 7000000 270.0000  20.0000  2.00600000000011\"]";
    let rows: Vec<String> = (-5..30)
        .map(|k| {
            format!(
                "[{0}, {1:.4}, {2:.4}, 1e5]",
                300 * k,
                7e6 * libm::cos(0.3 * f64::from(k)),
                7e6 * libm::sin(0.3 * f64::from(k))
            )
        })
        .collect();
    let ephemeris = format!("ephemeris = [{}]", rows.join(", "));
    for orbit in [ORBITS[0].1, ORBITS[2].1, tle, deep, &ephemeris] {
        let times: Vec<f64> =
            (-3..40).flat_map(|k| [256.0 * f64::from(k), 200.123 * f64::from(k)]).chain([90_000.0]).collect();
        let [one, other] = [sky(orbit), sky(orbit)];
        let forwards: Vec<[u64; 16]> = times.iter().map(|t| one.row(*t).0.map(f64::to_bits)).collect();
        for (t, bits) in times.iter().zip(&forwards).rev() {
            assert_eq!(other.row(*t).0.map(f64::to_bits), *bits, "{orbit} {t}");
            assert_eq!(other.clone().row(*t).0.map(f64::to_bits), *bits, "{orbit} {t}");
        }
    }
}

/// Of rows and two-line elements the arcs are checked: against the orbit itself, beside borders and between.
#[test]
fn arcs_of_other_orbits_follow_them() {
    let tle = "tle = [\"1 22675U 93036A   27059.50000000  .00000010  00000-0  10000-3 0  9008\", \
               \"2 22675  63.4000 250.0000 7000000 270.0000  20.0000  2.00600000000011\"]";
    let sky = sky(tle);
    let orbit = sky.orbit().unwrap();
    for t in (0..700).map(|k| 123.4 * f64::from(k)) {
        let (row, [position, velocity]) = (sky.row(t), orbit.state(t.into()));
        let field = sky.field().unwrap().at(&position, t);
        assert!((row.position() - position).norm() < 2e-14 * position.norm(), "{t}");
        assert!((row.velocity() - velocity).norm() < 1e-13 * velocity.norm(), "{t}");
        assert!((row.field() - field).norm() < 2e-14 * field.norm(), "{t}");
    }
}
