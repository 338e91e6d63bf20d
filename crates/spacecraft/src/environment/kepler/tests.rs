//! Kepler orbits, and those about an oblate planet.

use super::*;

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
fn it_falls_as_gravity_pulls() {
    let orbit = eccentric_orbit();
    let (h, gravity) = (1e-2, 3.986_004_418e14);
    for t in [0.0, 777.0, 5000.0, 30_000.0] {
        let [before, now, after] = [t - h, t, t + h].map(|t| orbit.at(t));
        let speed = (after.position - before.position) / (2.0 * h);
        assert!((speed - now.velocity).norm() < 1e-5, "{t}");
        let pull = (after.velocity - before.velocity) / (2.0 * h);
        let radius = now.position.norm();
        let exact = -now.position * (gravity / (radius * radius * radius));
        assert!((pull - exact).norm() < 1e-7 && (now.tide * radius - exact.norm()).abs() < 1e-13, "{t}");
        // Energy -mu/2a, and momentum sqrt(mu a (1 - e²)) along the normal.
        let energy = 0.5 * now.velocity.norm_squared() - gravity / radius;
        assert!((energy / (-gravity / 2.4e7) - 1.0).abs() < 1e-14, "{t}");
        let momentum = now.position.cross(&now.velocity);
        let exact = f64::sqrt(gravity * 1.2e7 * (1.0 - 0.16));
        assert!((momentum + now.local[1] * exact).norm() < 1e-13 * exact, "{t}");
        // The local axes turn about -y at the rate of the true anomaly.
        let [rate, change] = now.turning;
        let nadir = (after.local[2] - before.local[2]) / (2.0 * h);
        assert!((nadir - now.local[0] * rate.y).norm() < 1e-10, "{t}");
        assert!(((after.turning[0] - before.turning[0]) / (2.0 * h) - change).norm() < 1e-12, "{t}");
        assert!(rate.norm() <= orbit.fastest() * (1.0 + 1e-14));
    }
}

#[test]
fn an_orbit_through_the_planet_is_refused() {
    let fault = |text: &str| {
        flexsc_formats::document::from_text::<Kepler>(text).unwrap().fault().unwrap().to_string()
    };
    assert!(fault("semi_major_axis = 7e6\neccentricity = 0.1").starts_with("`semi_major_axis` must keep"));
    assert!(fault("semi_major_axis = 7e6\neccentricity = 1.0").starts_with("`eccentricity` must be below 1"));
}

/// Rates of a circular orbit of 780 km, published inclinations of orbits that follow the Sun, and a drift of the elements
/// against those of an orbit about a sphere.
#[test]
fn an_oblate_planet_turns_the_orbit_at_its_mean_rates() {
    let daily = |rate: f64| (rate * 86_400.0).to_degrees();
    // i = 98.6 degrees.
    let oblate = orbit("semi_major_axis = 7158e3\ninclination = 1.720894642606775\nj2 = true");
    let rates = oblate.secular_rates();
    for (found, expected) in
        [(rates.node, 0.995_028_74), (rates.perigee, -2.955_088_85), (rates.anomaly, -3.103_880_82)]
    {
        assert!((daily(found) - expected).abs() < 6e-9, "{} {expected}", daily(found));
    }
    // The node follows the mean Sun, 360 degrees in a tropical year of 365.2421897 days.
    for (altitude, inclination) in [(500e3, 97.401_811_7), (700e3, 98.187_986_3), (800e3, 98.603_115_3)] {
        let text = format!(
            "semi_major_axis = {}\ninclination = {}\nj2 = 1.0826261e-3",
            6_378_137.0 + altitude,
            f64::to_radians(inclination)
        );
        let found = daily(orbit(&text).secular_rates().node);
        assert!((found - 360.0 / 365.242_189_7).abs() < 2e-8, "{altitude}: {found}");
    }
    // An orbit whose elements are those after a time.
    let moving = orbit(
        "semi_major_axis = 1.2e7\neccentricity = 0.4\ninclination = 0.9\nnode = 0.7\nperigee = 2.1\nanomaly = -0.5\nj2 = true",
    );
    let (t, rates) = (4e5, moving.secular_rates());
    let plus = |value: Finite, rate: f64| Finite::new(value.get() + rate * t).unwrap();
    let then = Kepler {
        node: plus(moving.node, rates.node),
        perigee: plus(moving.perigee, rates.perigee),
        anomaly: plus(moving.anomaly, moving.mean_motion() + rates.anomaly),
        j2: Oblateness::default(),
        ..moving
    };
    assert!((moving.at(t).position - then.at(0.0).position).norm() < 1e-3);
    assert!((then.at(t).position - moving.at(2.0 * t).position).norm() > 1e5);
}

#[test]
fn rates_of_a_drifting_orbit_are_derivatives_within_their_bounds() {
    // With an oblateness a hundred times that of the Earth, so that products of rates count.
    for (e, j2) in [(0.4, 0.1), (0.0, 0.1), (0.4, 1e-3)] {
        let orbit = orbit(&format!(
            "semi_major_axis = 1.2e7\neccentricity = {e}\ninclination = 0.9\nnode = 0.7\nperigee = 2.1\nanomaly = -0.5\nj2 = {j2}"
        ));
        let h = 0.05;
        for k in 0..40 {
            let t = 333.0 * f64::from(k);
            let [before, now, after] = [t - h, t, t + h].map(|t| orbit.motion(t));
            for (order, tolerance) in [(0, 1e-5), (1, 1e-8), (2, 1e-10)] {
                let rate = (after[order] - before[order]) / (2.0 * h);
                assert!(
                    (rate - now[order + 1]).norm() < tolerance,
                    "{e} {j2} {t} {order}: {:e}",
                    (rate - now[order + 1]).norm()
                );
            }
            let [before, place, after] = [t - h, t, t + h].map(|t| orbit.at(t));
            assert!((place.velocity - now[1]).norm() < 1e-8);
            let [rate, change] = place.turning;
            let axes = nalgebra::Matrix3::from_columns(&place.local);
            for axis in 0..3 {
                let turned = (after.local[axis] - before.local[axis]) / (2.0 * h);
                assert!((turned - (axes * rate).cross(&place.local[axis])).norm() < 1e-9, "{e} {t} {axis}");
            }
            assert!(((after.turning[0] - before.turning[0]) / (2.0 * h) - change).norm() < 1e-12, "{t}");
            let [before, normal, after] = [t - h, t, t + h].map(|t| orbit.normal_motion(t));
            for order in [0, 1] {
                let rate = (after[order] - before[order]) / (2.0 * h);
                assert!((rate - normal[order + 1]).norm() < 1e-12);
            }
            assert!((normal[0] + place.local[1]).norm() < 1e-14);
            assert!(normal[1].norm() <= orbit.plane_rate() && rate.norm() <= orbit.fastest());
            assert!(
                now[1].norm() <= orbit.largest_speed() && now[1].norm() <= orbit.fastest() * orbit.nearest()
            );
            let turn = now[1].cross(&now[2]).norm() / now[1].norm_squared();
            assert!(turn <= orbit.fastest_velocity(), "{turn} {}", orbit.fastest_velocity());
        }
    }
}

#[test]
fn oblateness_is_a_coefficient_or_that_of_the_earth() {
    let j2 = |text: &str| {
        flexsc_formats::document::from_text::<Kepler>(&format!("semi_major_axis = 7e6\nj2 = {text}"))
            .map(|orbit| orbit.j2.coefficient())
            .map_err(|error| error.to_string())
    };
    assert_eq!(j2("true"), Ok(1.082_626_1e-3));
    assert_eq!([j2("false"), j2("0"), j2("2e-3")], [Ok(0.0), Ok(0.0), Ok(2e-3)]);
    for bad in ["-1e-3", "\"earth\"", "inf"] {
        assert!(j2(bad).unwrap_err().contains("true for the Earth's, or a number from 0"), "{bad}");
    }
    assert!(orbit("semi_major_axis = 7e6\nj2 = 0").motion(5.0) == orbit("semi_major_axis = 7e6").motion(5.0));
}
