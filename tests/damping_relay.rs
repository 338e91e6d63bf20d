//! The relay of active damping alone, its guards, and bad keys of the relay and of adaptive observers.

use flexsc_core::control::law::{ActiveDamping, Authority, DampingGuards};
use flexsc_flight::active_damping::{DampingLaw, ElasticRateEstimate, RateTolerance};

use crate::study::{close, scenario};
use crate::util::Dir;

const ACCELERATIONS: [f64; 2] = [2e-5, 2e-5];

/// A relay with a threshold of 3e-5 rad/s and the station's jets.
fn relay(spec: &ActiveDamping) -> DampingLaw {
    spec.start(0.2, &authority())
}

fn authority() -> Authority {
    let jets = scenario("iss-ringdown", &[]).study.authorities[0];
    Authority { accelerations: ACCELERATIONS, threshold: 3e-5, ..jets }
}

const ALLOWED: RateTolerance = RateTolerance { above: 1e-4, below: 1e-4 };

/// Returns the on-time for one mode of 0.2 Hz with this elastic rate, if the rigid rate is off by 9e-5 rad/s and 1e-4
/// rad/s are allowed.
fn fired(relay: &mut DampingLaw, rate: f64, influence: f64, gates: [bool; 2]) -> f64 {
    let [free, trusted] = gates;
    let mode = ElasticRateEstimate { rate, frequency: 1.256_637, influence };
    relay.decide(&[mode], trusted, free, 9e-5, &ALLOWED).on
}

#[test]
fn the_relay_keeps_its_rules() {
    let open = [true, true];
    let guards = DampingGuards { dead_zone: false, ..DampingGuards::default() };
    let spec = ActiveDamping { guards: guards.clone(), ..ActiveDamping::default() };
    let at = &mut relay(&spec);
    // Latched above the threshold, and until half of it; a pulse is as long as it takes, 0.05 to 0.2 s.
    assert_eq!(fired(at, 2.9e-5, 2.0, open), 0.0);
    assert_eq!(fired(at, 3.1e-5, 2.0, open), -0.2);
    close(fired(at, -1.6e-5, 8.0, open), 0.1, 1e-12);
    assert_eq!(fired(at, 1.6e-5, 20.0, open), 0.0);
    assert_eq!(fired(at, 1.4e-5, 2.0, open), 0.0);
    assert_eq!(fired(at, 2.0e-5, 2.0, open), 0.0);
    // Only where the rigid law leaves the jets free, the observer follows, and the jets can damp the mode.
    for (influence, gates) in [(2.0, [false, true]), (2.0, [true, false]), (-2.0, open), (0.0, open)] {
        assert_eq!(fired(at, 5e-5, influence, gates), 0.0, "{influence} {gates:?}");
    }
    // A pulse adds 4e-6 rad/s to the rigid rate, which may then be 1e-4 rad/s off.
    let at = &mut relay(&ActiveDamping::default());
    assert_eq!(fired(at, -5e-5, 0.1, open), 0.2);
    let mode = ElasticRateEstimate { rate: -5e-5, frequency: 1.0, influence: 0.1 };
    for (excess, on) in [(9.5e-5, 0.2), (9.7e-5, 0.0), (-9.7e-5, 0.2)] {
        assert_eq!(at.decide(&[mode], true, true, excess, &ALLOWED).on, on, "{excess}");
    }
    // Without pulse widths the whole cycle.
    let whole = ActiveDamping { pulse_width: false, ..spec };
    assert_eq!(fired(&mut relay(&whole), -4e-5, 50.0, open), 0.2);
    // Without the predictor, of a mode that a late push still damps: 0.6 Hz is not one, with a cycle of delay.
    let late = ActiveDamping { predictor: false, ..ActiveDamping::default() };
    for (hertz, eligible) in [(0.25, true), (0.5, true), (0.6, false), (0.8, false)] {
        let frequency = std::f64::consts::TAU * hertz;
        let mode = ElasticRateEstimate { rate: -5e-5, frequency, influence: 0.1 };
        let damped = relay(&late).decide(&[mode], true, true, 0.0, &ALLOWED);
        assert_eq!(damped.on != 0.0, eligible, "{hertz} Hz");
    }
    assert_eq!(late.lead_time(0.2, &authority()), 0.0);
    close(ActiveDamping::default().lead_time(0.2, &authority()), 0.3, 1e-12);
}

/// 75 cycles at one rate, then 75 at another: the pause comes if that is more than 0.9 of the first, and lasts 300
/// cycles.
#[test]
fn the_watchdog_rests_where_nothing_falls() {
    let guards = |watchdog| DampingGuards { dead_zone: false, watchdog, ..DampingGuards::default() };
    for (watchdog, second, rests) in [(true, 4.6e-5, true), (true, 4.4e-5, false), (false, 5e-5, false)] {
        let at = &mut relay(&ActiveDamping { guards: guards(watchdog), ..ActiveDamping::default() });
        for k in 0..150 {
            assert!(fired(at, if k < 75 { 5e-5 } else { second }, 1.0, [true, true]) < 0.0);
        }
        let pause = (0..1000).take_while(|_| fired(at, second, 1.0, [true, true]) == 0.0).count();
        assert_eq!(pause, if rests { 300 } else { 0 }, "{watchdog} {second}");
    }
}

/// If the delay is long for the cycle, the limit cycle sets the threshold: 9.95e-6 rad/s of the yaw mode.
#[test]
fn the_threshold_stays_off_the_limit_cycle() {
    let yaw = [1.555_716_68, 5.908_320e-5];
    let found = ActiveDamping::default().threshold(2, &[yaw], 0.01, 0.2, 0.005);
    close(found, 1.5 * 9.95e-6, 3e-3);
    close(ActiveDamping::default().threshold(2, &[yaw, [4.0, 6e-5]], 0.2, 0.2, 0.005), 2.363_328e-5, 1e-9);
}

#[test]
fn bad_keys_are_refused() {
    let dir = Dir::with(&["iss-ringdown"]);
    for (set, words) in [
        (
            "estimator.adaptive.frequency_error=-1",
            "`estimator.adaptive.frequency_error` must be above -1, got -1",
        ),
        (
            "estimator.adaptive.influence_error=-2",
            "`estimator.adaptive.influence_error` must be above -1, got -2",
        ),
        ("estimator.adaptive.frequency_error=nan", "must be a finite number, got NaN"),
        ("estimator.adaptive.count=0", "`estimator.adaptive.count` must be 1 or more, got 0"),
        ("estimator.adaptive.count=-1", "estimator.adaptive.count"),
        ("estimator.adaptive.merge=-0.1", "must be a number of 0 or more, got -0.1"),
        ("estimator.adaptive.form={newton={}}", "newton"),
        (
            "estimator.adaptive.form.gradient.damping=1",
            "`estimator.adaptive.form.gradient.damping` must be below 1, got 1",
        ),
        (
            "estimator.adaptive.form={gradient={reach=0.5}}",
            "`estimator.adaptive.form.gradient.reach` must be above 1, got 0.5",
        ),
        (
            "estimator.adaptive.trackers={yaw=[{frequency=1.5,influence=[2.0]}]}",
            "`estimator.adaptive.trackers.yaw[0].influence` must be one number for each of 3 inputs, got 1",
        ),
        (
            "estimator.adaptive.trackers={yaw=[{frequency=20.0,influence=[0.0,0.0,2.0]}]}",
            "`estimator.adaptive.trackers.yaw[0].frequency` must be below the Nyquist frequency",
        ),
        ("estimator.adaptive.trackers={}", "`estimator.adaptive` must have a mode to track"),
        ("estimator.adaptive.gyro=1", "unknown key `gyro`"),
        ("law.phase_plane.damping.release=1", "must be a number between 0 and 1, got 1"),
        ("law.phase_plane.damping.threshold=[1e-5,1e-5]", "expected an array of length 3"),
        ("law.phase_plane.damping.threshold=[0,1e-5,1e-5]", "must be a positive number, got 0"),
        ("law.phase_plane.damping.guards={sentinel=true}", "unknown key `sentinel`"),
        (
            "estimator={rigid_rate={correction=0.01}}",
            "`law.phase_plane.damping` needs the elastic rates of an `[estimator.adaptive]`",
        ),
    ] {
        dir.run(&format!("simulate iss-ringdown.toml --set {set}")).exits(2).says(&[words]);
    }
    for (set, words) in [
        (
            "estimator.adaptive.count=2",
            "`estimator.adaptive.count` must be 1 in the form `recurrence`, got 2",
        ),
        (
            "estimator.adaptive.cross_axis=true",
            "`estimator.adaptive.cross_axis` must be false in the form `recurrence`",
        ),
    ] {
        let form = "--set estimator.adaptive.form={recurrence={}}";
        dir.run(&format!("simulate iss-ringdown.toml {form} --set {set}")).exits(2).says(&[words]);
    }
    // Undamped modes that a long delay leaves no stable gain: no elastic rate would reach the rule's threshold.
    dir.run("simulate iss-ringdown.toml --set law.phase_plane.period=0.6 --set estimator.adaptive.form.gradient.damping=0")
        .exits(2)
        .says(&["`law.phase_plane.damping` gives roll a threshold of inf rad/s", "which is never reached", "give `threshold`"]);
}
