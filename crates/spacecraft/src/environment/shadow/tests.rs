//! Shadows on circular and eccentric orbits, under a Sun that stands still and one that moves.

use super::*;
use crate::environment::solar_disc::Discs;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::Finite;

fn orbit(text: &str) -> Kepler {
    let orbit: Kepler = flexsc_formats::document::from_text(text).unwrap();
    assert_eq!(orbit.fault(), None);
    orbit
}

fn eccentric_orbit() -> Kepler {
    orbit(
        "semi_major_axis = 1.2e7\neccentricity = 0.4\ninclination = 0.9\nnode = 0.7\nperigee = 2.1\nanomaly = -0.5",
    )
}

#[test]
fn the_shadow_of_a_circular_orbit_is_as_by_hand() {
    // With the Sun in the plane, the planet hides 2 asin(Rp/R) of the orbit, centred opposite to the Sun.
    let orbit = orbit("semi_major_axis = 7e6\nanomaly = 1.0");
    let shadows = orbit.shadows(ShadowRegion::Cylinder, &SunPath::Fixed(Vector::x()), 12_000.0);
    let half = libm::asin(6_378_137.0 / 7e6);
    let rate = orbit.mean_motion();
    assert_eq!(shadows.len(), 2);
    for (k, [from, to]) in shadows.into_iter().enumerate() {
        let middle = (std::f64::consts::PI - 1.0 + TAU * k as f64) / rate;
        assert!((from - (middle - half / rate)).abs() < 1e-8 && (to - (middle + half / rate)).abs() < 1e-8);
    }
    // For a run that begins within a shadow, only the rest of it.
    let within = Kepler { anomaly: Finite::new(3.2).unwrap(), ..orbit };
    let first = within.shadows(ShadowRegion::Cylinder, &SunPath::Fixed(Vector::x()), 10.0);
    assert!(first.len() == 1 && first[0][0] == 0.0 && first[0][1] < half / rate);
    // With the Sun along the normal there is no shadow.
    assert!(orbit.shadows(ShadowRegion::Cylinder, &SunPath::Fixed(Vector::z()), 12_000.0).is_empty());
}

#[test]
fn at_its_edges_the_body_leaves_the_shadow() {
    let orbit = eccentric_orbit();
    let sun = Vector::new(-0.5, -0.4, 0.3).normalize();
    let depth = |t: f64| {
        let position = orbit.at(t).position;
        let along = position.dot(&sun);
        (along < 0.0).then(|| (position - sun * along).norm() - 6_378_137.0)
    };
    let shadows = orbit.shadows(ShadowRegion::Cylinder, &SunPath::Fixed(sun), 40_000.0);
    // Reference by a scan of every second with other code: after 9104, 11 764, 22 187, 24 847, 35 269 and 37 929 s.
    let scanned = [[9104.5, 11_764.5], [22_187.5, 24_847.5], [35_269.5, 37_929.5]];
    assert_eq!(shadows.len(), scanned.len());
    for (found, scanned) in shadows.iter().flatten().zip(scanned.iter().flatten()) {
        assert!((found - scanned).abs() <= 0.5, "{found} {scanned}");
    }
    for [from, to] in &shadows {
        if *from > 0.0 {
            assert!(depth(*from).unwrap().abs() < 1e-4);
        }
        assert!(depth(*to).unwrap().abs() < 1e-4 && depth(0.5 * (from + to)).unwrap() < 0.0);
    }
    // No other time is in shadow.
    for k in 0..4000 {
        let t = 10.0 * f64::from(k);
        let dark = shadows.iter().any(|[from, to]| *from <= t && t < *to);
        assert_eq!(dark, depth(t).is_some_and(|depth| depth < 0.0), "{t}");
    }
}

#[test]
fn under_a_moving_sun_the_edges_are_those_of_its_direction_then() {
    // Seconds from 1970 to 2026-11-24T00:00:00Z.
    let sun = SunPath::new(&crate::environment::Sun::Epoch, 1_795_478_400_000_000_000);
    let depth = |orbit: &Kepler, t: f64| {
        let (position, sun) = (orbit.at(t).position, sun.direction(t));
        let along = position.dot(&sun);
        if along < 0.0 { (position - sun * along).norm() - 6_378_137.0 } else { f64::INFINITY }
    };
    for (orbit, days, count) in [
        (eccentric_orbit(), 40.0, 265),
        // Low circular orbit whose shadows end as the Sun moves away from its plane.
        (orbit("semi_major_axis = 7e6\ninclination = 1.7\nnode = 6.5\nanomaly = 4.0"), 40.0, 323),
        // Geostationary orbit: no shadows but about the equinox, which is in March.
        (orbit("semi_major_axis = 4.2164e7"), 200.0, 45),
    ] {
        let duration = 86_400.0 * days;
        let shadows = orbit.shadows(ShadowRegion::Cylinder, &sun, duration);
        assert_eq!(shadows.len(), count, "{orbit:?}");
        for [from, to] in &shadows {
            assert!(depth(&orbit, *from).abs() < 1e-2 || *from == 0.0, "{from}");
            assert!(depth(&orbit, *to).abs() < 1e-2 && depth(&orbit, 0.5 * (from + to)) < 0.0, "{to}");
        }
        for k in 0..50_000 {
            let t = duration * f64::from(k) / 50_000.0;
            let dark = shadows.iter().any(|[from, to]| *from <= t && t < *to);
            assert_eq!(dark, depth(&orbit, t) < 0.0, "{t}");
        }
    }
    // Over an orbit the moving Sun differs little from the one at the start.
    let orbit = eccentric_orbit();
    let fixed = orbit.shadows(ShadowRegion::Cylinder, &SunPath::Fixed(sun.direction(0.0)), 13_000.0);
    let moving = orbit.shadows(ShadowRegion::Cylinder, &sun, 13_000.0);
    assert_eq!(fixed.len(), moving.len());
    for (fixed, moving) in fixed.iter().flatten().zip(moving.iter().flatten()) {
        assert!((fixed - moving).abs() < 10.0 && (fixed != moving || *fixed == 0.0), "{fixed} {moving}");
    }
}

/// Returns the part of the disc of the Sun in view, and the part of it that the planet hides beyond first contact (rad)
/// and within second (rad): both are zero on the edges.
fn contacts(orbit: &Kepler, sun: &SunPath, t: f64) -> [f64; 3] {
    let place = sun.direction(t) * (sun.distance(t)[0] * ASTRONOMICAL_UNIT);
    let discs = Discs::from_position(&orbit.at(t).position, &place, orbit.planet_radius.get());
    let Discs { sun, planet, apart } = discs;
    [discs.part_in_view(), apart - planet - sun, apart - (planet - sun).abs()]
}

#[test]
fn edges_of_circular_orbits_are_those_of_the_cone() {
    // Altitude (m), angle of the Sun to the plane (degrees), times (s) from the point nearest to the Sun to penumbra, umbra
    // and cylinder: own computation of 30 digits of the times at which the discs touch.
    #[rustfmt::skip]
    let rows = [
        (500e3, 0.0, Some(1_761.636_144_309), Some(1_770.039_746_736), Some(1_765.876_467_668)),
        (500e3, 30.0, Some(1_818.031_690_69), Some(1_828.010_036_862), Some(1_823.064_685_403)),
        (500e3, 66.0, Some(2_451.249_422_893), Some(2_500.286_894_55), Some(2_475.232_658_57)),
        (500e3, 68.0, Some(2_695.853_367_192), None, Some(2_802.194_059_328)),
        (1000e3, 0.0, Some(2_100.787_555_06), Some(2_110.123_952_644), Some(2_105.498_551_935)),
        (35_786e3, 0.0, Some(40_935.223_245_37), Some(41_062.771_373_27), Some(40_999.581_990_43)),
        (35_786e3, 8.6, Some(42_469.954_667_09), None, Some(42_765.221_489_64)),
    ];
    for (altitude, beta, penumbra, core, cylinder) in rows {
        let orbit = orbit(&format!("semi_major_axis = {}", 6_378_137.0 + altitude));
        let (sin, cos) = libm::sincos(f64::to_radians(beta));
        let sun = SunPath::Fixed(Vector::new(cos, 0.0, sin));
        let period = TAU / orbit.mean_motion();
        let regions = [ShadowRegion::Penumbra, ShadowRegion::Core, ShadowRegion::Cylinder];
        for (region, expected) in regions.into_iter().zip([penumbra, core, cylinder]) {
            let found = orbit.shadows(region, &sun, 0.9 * period);
            assert_eq!(found.len(), usize::from(expected.is_some()), "{altitude} {beta} {region:?}");
            if let (Some([from, to]), Some(expected)) = (found.first(), expected) {
                assert!((from - expected).abs() < 1e-6, "{altitude} {beta} {region:?}: {from}");
                assert!((from + to - period).abs() < 1e-6, "{altitude} {beta} {region:?}: {to}");
            }
        }
    }
}

/// On an orbit beyond the apex of the umbra, the planet before the Sun leaves a ring.
#[test]
fn beyond_the_apex_of_the_umbra_eclipses_are_annular() {
    let orbit = orbit("semi_major_axis = 1.6e9");
    let sun = SunPath::Fixed(Vector::x());
    let period = TAU / orbit.mean_motion();
    let [outer, core] =
        [ShadowRegion::Penumbra, ShadowRegion::Core].map(|region| orbit.shadows(region, &sun, period)[0]);
    assert!(outer[0] < core[0] && core[1] < outer[1]);
    let [ring, ..] = contacts(&orbit, &sun, 0.5 * period);
    assert!(ring > 0.1 && ring < 0.5, "{ring}");
    for (t, contact) in [(outer[0], 1), (core[0], 2), (core[1], 2), (outer[1], 1)] {
        assert!(contacts(&orbit, &sun, t)[contact].abs() < 1e-12, "{t}");
    }
}

/// Edges are where the discs touch, and no others exist: against a scan, with a moving Sun, a plane that drifts, or both.
#[test]
fn cones_on_orbits_that_drift_are_those_of_the_discs() {
    let dated = SunPath::new(&crate::environment::Sun::Epoch, 1_795_478_400_000_000_000);
    let fixed = SunPath::Fixed(Vector::new(0.8, -0.5, 0.33).normalize());
    let low = "semi_major_axis = 7e6\ninclination = 1.7\nnode = 6.5\nanomaly = 4.0\neccentricity = 0.01\n";
    let eccentric = "semi_major_axis = 1.2e7\neccentricity = 0.4\ninclination = 0.9\nnode = 0.7\nperigee = 2.1\nanomaly = -0.5\n";
    for (text, sun, days) in [
        (format!("{low}j2 = true"), fixed, 30.0),
        (format!("{low}j2 = true"), dated, 30.0),
        (low.to_owned(), dated, 30.0),
        (format!("{eccentric}j2 = true"), fixed, 30.0),
        ("semi_major_axis = 4.2164e7\ninclination = 1e-3\nj2 = true".to_owned(), dated, 200.0),
    ] {
        let (orbit, duration) = (orbit(&text), 86_400.0 * days);
        let [outer, core] =
            [ShadowRegion::Penumbra, ShadowRegion::Core].map(|region| orbit.shadows(region, &sun, duration));
        assert!(outer.len() > 40 && outer.len() >= core.len(), "{} {}", outer.len(), core.len());
        for (passages, contact) in [(&outer, 1), (&core, 2)] {
            for t in passages.iter().flatten().filter(|t| **t > 0.0) {
                // An angle of 1e-9 rad takes about 1 microsecond.
                assert!(contacts(&orbit, &sun, *t)[contact].abs() < 1e-9, "{text} {t}");
            }
        }
        for k in 0..40_000 {
            let t = duration * f64::from(k) / 40_000.0;
            let [part, ..] = contacts(&orbit, &sun, t);
            let within = |passages: &[[f64; 2]]| passages.iter().any(|[from, to]| *from <= t && t < *to);
            assert_eq!([within(&outer), within(&core)], [part < 1.0, part == 0.0], "{text} {t}: {part}");
        }
    }
}

/// A step of torque excites a mode of the frequency W with the factor 1, a penumbra of the length T with that of its
/// spectrum, about |2 J1(x)/x| with x = W T/2.
#[test]
fn a_penumbra_excites_modes_less_than_a_step() {
    let orbit = orbit("semi_major_axis = 6.878137e6");
    let sun = SunPath::Fixed(Vector::x());
    let period = TAU / orbit.mean_motion();
    let [outer, core] = [ShadowRegion::Penumbra, ShadowRegion::Core]
        .map(|region| orbit.shadows(region, &sun, 0.9 * period)[0]);
    let (from, length) = (outer[0], core[0] - outer[0]);
    assert!((length - 8.403_602_4).abs() < 1e-6, "{length}");
    for (frequency, expected) in [
        (0.02, 0.965_55),
        (0.05, 0.797_44),
        (0.1, 0.348_06),
        (0.2, 0.130_94),
        (0.5, 0.004_089_4),
        (1.0, 0.005_607_8),
        (2.0, 0.004_087_0),
    ] {
        // W times the integral of (1 - f) exp(i W t), after parts |integral of f' exp(i W t)|, with nodes in the angle in
        // which f is smooth; the midpoint rule is exact but for rounding.
        let (w, n) = (TAU * frequency, 4000);
        let (mut re, mut im) = (0.0, 0.0);
        for k in 0..n {
            let [before, after] = [k, k + 1].map(|k| {
                let part = libm::sin(0.25 * TAU * f64::from(k) / f64::from(n));
                let t = from + length * part * part;
                (t, contacts(&orbit, &sun, t)[0])
            });
            let (sin, cos) = libm::sincos(w * (0.5 * (before.0 + after.0) - from));
            (re, im) = (re + (before.1 - after.1) * cos, im + (before.1 - after.1) * sin);
        }
        let factor = libm::hypot(re, im);
        assert!((factor - expected).abs() < 2e-5, "{frequency}: {factor}");
    }
}
