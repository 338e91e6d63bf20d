//! Limit cycles of the relay law: closed forms, simulated ones, multipliers and resonances.
//!
//! The periods and multipliers with modes come from Newton's method on the five-dimensional Poincaré map in quadruple
//! arithmetic, those of the rigid body from its closed form.

use flexsc_core::Scenario;
use flexsc_core::analysis::rigid_cycle::{cycles, resonances};
use flexsc_core::control::law::{LawKind, RelaySides};
use flexsc_core::metrics::MetricValue;

use crate::study::{close, metrics, numbers, scenario};
use crate::util::Dir;

#[test]
fn limit_cycles_and_their_multipliers() {
    // (k_t, period, largest multiplier, symmetric): Newton on the five-dimensional Poincaré map.
    let exact = [
        (0.31, 44.130_916_267, 0.795, false),
        (0.32, 44.799_371_442, 0.857, false),
        (0.325, 45.536_432_912, 0.705, true),
        (0.3389, 47.510_226_382, 0.935, true),
        (0.357, 50.014_453_304, 0.797, true),
        (0.36, 50.441_238_422, 0.897, true),
        (0.3752, 52.696_776_597, 0.920, true),
    ];
    for (k_t, period, multiplier, symmetric) in exact {
        let metrics = metrics(scenario("relay-fixed", &[("law.relay.k_t", &k_t.to_string())]));
        let ours = |name| metrics.number(name).unwrap_or(f64::NAN);
        assert_eq!(metrics.get("cycle_kind"), Some(&MetricValue::Word("two-sided")), "k_t = {k_t}");
        assert!((ours("cycle_period_s") - period).abs() < 2e-8, "k_t = {k_t}: {}", ours("cycle_period_s"));
        let largest = ours("cycle_multiplier_max");
        assert!((largest - multiplier).abs() < 6e-4, "k_t = {k_t}: multiplier {largest}");
        assert_eq!(ours("cycle_symmetric") > 0.5, symmetric, "k_t = {k_t}");
        assert_eq!(numbers(&metrics, "cycle_multipliers").len(), 5);
    }
    let chaotic = metrics(scenario("relay-fixed", &[("law.relay.k_t", "0.345")]));
    assert_eq!(chaotic.get("cycle_kind"), Some(&MetricValue::Word("none")));
    assert!(chaotic.number("cycle_period_s").expect("a metric").is_nan());
}

#[test]
fn a_rigid_cycle_has_one_multiplier() {
    // That of the closed form's half cycle, squared.
    let rigid = [("body.planar.modes", "[]"), ("law.relay.k_t", "0.36")];
    let cycle = metrics(scenario("relay-fixed", &rigid));
    close(cycle.number("cycle_multiplier_max").expect("a multiplier"), 0.2492 * 0.2492, 1e-3);
}

#[test]
fn without_weak_torque_a_body_crosses_the_dead_zone_at_a_constant_rate() {
    for (weak, tolerance) in [("0.0", 1e-13), ("1e-300", 1e-13), ("1e-12", 1e-6)] {
        let case = scenario("relay-fixed", &[("body.planar.modes", "[]"), ("law.relay.weak", weak)]);
        let LawKind::Relay(law) = &case.law else { panic!("a relay") };
        let body = case.model.one_axis().expect("one axis");
        let all = cycles(law, body, 0.31);
        let [cycle] = &all[..] else { panic!("{all:?}") };
        assert_eq!(cycle.sides, RelaySides::Two);
        // Braking from the boundary at which the push ends to the entry rate, then coasting to the other boundary.
        let strong = law.strong.get() / body.inertia.get();
        let braking = cycle.brake_s * (cycle.entry_rate_rad_s + 0.5 * strong * cycle.brake_s);
        let width = 2.0 * law.dead_zone.get() - law.hysteresis.get();
        close(cycle.coast_s, (width - braking) / cycle.entry_rate_rad_s, tolerance);
    }
}

/// A rigid body under the paper's law at a gain.
fn rigid(k_t: f64) -> Scenario {
    scenario("relay-fixed", &[("body.planar.modes", "[]"), ("law.relay.k_t", &k_t.to_string())])
}

#[test]
fn rigid_cycles_in_closed_form_and_simulated() {
    let exact = [
        (0.28, 4.348_520_067e-5, 3.573_462_994, 1.000_569_638, 15.945_332_88, 41.038_731_03, 0.0714),
        (0.31, 3.762_878_822e-5, 3.366_612_029, 1.043_649_729, 17.660_915_56, 44.142_354_64, -0.0358),
        (0.3389, 3.245_071_122e-5, 3.189_955_530, 1.081_075_929, 19.453_761_61, 47.449_586_14, -0.1519),
        (0.36, 2.888_860_357e-5, 3.072_022_451, 1.105_928_082, 20.866_567_59, 50.089_036_24, -0.2492),
        (0.40, 2.249_850_453e-5, 2.868_186_836, 1.147_274_734, 23.839_475_00, 55.709_873_14, -0.4843),
    ];
    for (k_t, entry, push, brake, coast, period, multiplier) in exact {
        let scenario = rigid(k_t);
        let LawKind::Relay(law) = &scenario.law else { panic!("a relay law") };
        let cycle = cycles(law, scenario.one_angle().expect("one angle"), k_t)[0];
        assert_eq!(cycle.sides, RelaySides::Two);
        for (ours, exact) in [
            (cycle.entry_rate_rad_s, entry),
            (cycle.push_s, push),
            (cycle.brake_s, brake),
            (cycle.coast_s, coast),
            (cycle.period_s, period),
        ] {
            close(ours, exact, 1e-9);
        }
        assert!((cycle.multiplier - multiplier).abs() < 6e-5);
        let simulated = metrics(scenario.clone());
        close(simulated.number("cycle_period_s").expect("a period"), cycle.period_s, 1e-9);
        close(simulated.number("cycle_duty").expect("a duty"), cycle.duty, 1e-7);
        let impulse = simulated.number("cycle_impulse_per_hour_nm_s").expect("an impulse");
        close(impulse, cycle.impulse_per_hour_nm_s, 1e-7);
    }
}

#[test]
fn rigid_cycles_exist_and_are_stable_where_they_should_be() {
    let of = |k_t: f64| {
        let scenario = rigid(k_t);
        let LawKind::Relay(law) = &scenario.law else { panic!("a relay law") };
        cycles(law, scenario.one_angle().expect("one angle"), k_t)
    };
    let kinds = |k_t: f64| of(k_t).iter().map(|c| (c.sides, c.stable)).collect::<Vec<_>>();
    // Two-sided below 0.547089, stable below 0.450650; one-sided from 0.415477 on, always stable.
    assert_eq!(kinds(0.415_47), [(RelaySides::Two, true)]);
    assert_eq!(kinds(0.415_48), [(RelaySides::Two, true), (RelaySides::One, true)]);
    assert_eq!(kinds(0.450_64), [(RelaySides::Two, true), (RelaySides::One, true)]);
    assert_eq!(kinds(0.450_66), [(RelaySides::Two, false), (RelaySides::One, true)]);
    assert_eq!(kinds(0.547_08), [(RelaySides::Two, false), (RelaySides::One, true)]);
    assert_eq!(kinds(0.547_10), [(RelaySides::One, true)]);
    close(of(0.5)[1].period_s, 71.390_494, 1e-7);
    // Bistable: which cycle a run ends in depends on where it starts.
    for (rate, kind) in [("2.2e-5", "two-sided"), ("4e-5", "one-sided")] {
        let set = [("body.planar.modes", "[]"), ("law.relay.k_t", "0.42"), ("body.planar.rate", rate)];
        let metrics = metrics(scenario("relay-fixed", &set));
        assert_eq!(metrics.get("cycle_kind"), Some(&MetricValue::Word(kind)), "rate {rate}");
    }
}

#[test]
fn resonances_with_the_modes() {
    let scenario = scenario("relay-fixed", &[]);
    let LawKind::Relay(law) = &scenario.law else { panic!("a relay law") };
    let found = resonances(law, scenario.one_angle().expect("one angle"));
    let exact = [
        (0, 3, 42.8399, 0.297_777),
        (0, 5, 71.3998, 0.485_146),
        (1, 5, 41.6105, 0.285_758),
        (1, 7, 58.2547, 0.416_197),
    ];
    for (mode, harmonic, period, k_t) in exact {
        let ours = found.iter().find(|r| r.mode == mode && r.harmonic == harmonic).expect("a resonance");
        close(ours.period_s, period, 2e-6);
        assert!((ours.k_t - k_t).abs() < 1e-6, "{}", ours.k_t);
    }
}

#[test]
fn resonances_of_the_one_sided_cycle() {
    let scenario = scenario("relay-one-sided", &[]);
    let LawKind::Relay(law) = &scenario.law else { panic!("a relay law") };
    let found = resonances(law, scenario.one_angle().expect("one angle"));
    // Push, brake and coast by mpmath with 30 digits: the period that is as many periods of the mode. Even harmonics act.
    let exact = [
        (0, 5, 71.399_833_036_131_7, 0.499_951_922_478_525),
        (0, 8, 114.239_732_857_811, 0.328_058_412_032_372),
        (1, 6, 49.932_598_467_652_3, 0.626_352_805_037_949),
        (1, 11, 91.543_097_190_696, 0.408_029_898_451_479),
    ];
    for (mode, harmonic, period, k_t) in exact {
        let ours = found.iter().find(|r| r.mode == mode && r.harmonic == harmonic).expect("a resonance");
        close(ours.period_s, period, 1e-12);
        close(ours.k_t, k_t, 1e-12);
    }
}

#[test]
fn summaries_of_one_sided_laws_and_rigid_bodies() {
    let dir = Dir::with(&["relay-one-sided", "relay-fixed"]);
    dir.run("cycle relay-one-sided.toml").exits(0).says(&["resonances of the one-sided cycle"]);
    dir.run("cycle relay-fixed.toml").exits(0).says(&["resonances of the two-sided cycle"]);
    let rigid = dir.run("simulate relay-one-sided.toml --set body.planar.modes=[] --log none").exits(0);
    assert!(!rigid.err.contains("NaN") && !rigid.err.contains("envelope"), "{}", rigid.err);
}

#[test]
fn one_sided_law_ends_in_its_cycle() {
    // Without the left boundary the one-sided cycle exists at 0.31 too: period 120.343 s.
    let set = [("body.planar.modes", "[]"), ("duration", "50000")];
    let scenario = scenario("relay-one-sided", &set);
    let LawKind::Relay(law) = &scenario.law else { panic!("a relay law") };
    let closed = cycles(law, scenario.one_angle().expect("one angle"), 0.31)[0];
    close(closed.period_s, 120.343, 1e-5);
    // Three digits are known.
    close(closed.angle_min_rad, -1.25e-3, 4e-3);
    let simulated = metrics(scenario.clone());
    assert_eq!(simulated.get("cycle_kind"), Some(&MetricValue::Word("one-sided")));
    close(simulated.number("cycle_period_s").expect("a period"), closed.period_s, 1e-9);
    assert_eq!(simulated.number("pushes_left"), Some(0.0));
}
