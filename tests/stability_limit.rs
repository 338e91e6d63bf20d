//! One limit of stability for margins, spectrum and tuning, and crossings at the Nyquist frequency.

use flexsc_core::Scenario;
use flexsc_core::analysis::noise::{NoiseError, NoiseReport, NoiseRequest};
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::analysis::scenario_margins::{MarginsFault, ScenarioMargins};

use crate::util::Dir;

/// Returns a PD loop about one axis with one mode, of a frequency (rad/s), a damping ratio and a gain.
fn with_mode(period: f64, [frequency, damping, gain]: [f64; 3]) -> String {
    format!(
        "duration = 10.0\n[body.planar]\ninertia = 100.0\n\
         modes = [{{ frequency = {frequency}, damping = {damping}, gain = {gain} }}]\n\
         [sensor.sampled]\nperiod = {period}\nrate_noise = 1e-6\n[law.pd]\nk_p = 4.0\nk_d = 28.0\nperiod = {period}\n\
         [actuator.wheel]\ngain = 1.0\n"
    )
}

/// An undamped mode that grows by e in 2.8 days: 40 digits, `tests/golden/common_delay_oracle.py`.
#[test]
fn a_motion_that_grows_slowly_is_unstable_everywhere() {
    let text = with_mode(1e-3, [50.0, 0.0, -3e-5]);
    let scenario = Scenario::parse("edge.toml", &text).expect("valid");
    let fault = ScenarioMargins::from_scenario(&scenario, LoopBreak::Command).expect_err("unstable");
    let MarginsFault::Unstable(unstable) = fault else { panic!("{fault}") };
    let (growth, expected) = (1.0 / unstable.growth_time_s, 4.199_128_636_57e-6);
    assert!((growth / expected - 1.0).abs() < 1e-6, "{growth:e}, expected {expected:e}");
    let fault = NoiseReport::from_scenario(&scenario, &NoiseRequest::default()).expect_err("unstable");
    assert!(matches!(fault, NoiseError::Unstable(_)), "{fault}");
    let dir = Dir::new();
    std::fs::write(dir.path("edge.toml"), text).expect("a file");
    let told = ["not stable", "grows by e in 238\u{202f}145 s"];
    dir.run("margins edge.toml").exits(2).says(&told);
    dir.run("spectrum edge.toml").exits(2).says(&told);
    dir.run("tune edge.toml --vary law.pd.k_d=20:40").exits(2).says(&["not stable"]);
    // With more damping than the loop removes, the mode decays.
    let damped = with_mode(1e-3, [50.0, 1e-6, -3e-5]);
    let damped = Scenario::parse("damped.toml", &damped).expect("valid");
    assert!(ScenarioMargins::from_scenario(&damped, LoopBreak::Command).is_ok());
}

/// A mode at the Nyquist frequency, where the loop transfer ends on the negative real axis.
#[test]
fn a_crossing_at_the_nyquist_frequency_is_listed_once() {
    let text = with_mode(0.1, [10.0 * std::f64::consts::PI, 0.001, 0.02]);
    let scenario = Scenario::parse("nyquist.toml", &text).expect("valid");
    let margins = ScenarioMargins::from_scenario(&scenario, LoopBreak::Command).expect("stable");
    let crossings = &margins.stability.loops[0].crossings.phase;
    assert!(
        crossings.len() == 1 && (crossings[0].factor / 68.621_160_014 - 1.0).abs() < 1e-9,
        "{crossings:?}"
    );
}

/// The worst case needs uncertain keys, which are missed before the margins are computed.
#[test]
fn the_worst_margins_need_uncertain_keys_first() {
    let dir = Dir::with(&["wheel-unstable-band"]);
    let told = dir.run("margins wheel-unstable-band.toml --worst").exits(2);
    told.says(&["uncertain: is missing: the worst case is searched for"]);
}

#[test]
fn a_tuned_scenario_replaces_another_file_if_forced() {
    let dir = Dir::with(&["attitude-hold"]);
    std::fs::write(dir.path("tuned.toml"), "duration = 1.0\n").expect("a file");
    let line = "tune attitude-hold.toml --vary law.per_axis.roll.pd.k_d=200:300 --save tuned.toml";
    dir.run(line).exits(2).says(&["already exists", "--force"]);
    dir.run(&format!("{line} --force")).exits(0);
    assert!(Scenario::load(&dir.path("tuned.toml")).is_ok());
    dir.run("tune attitude-hold.toml --vary law.per_axis.roll.pd.k_d=200:300 --force").exits(2);
}
