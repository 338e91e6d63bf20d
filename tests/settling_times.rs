//! Settling times of linear loops, and the delay of all actuators together, against independent numbers.

use flexsc_core::Scenario;
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::analysis::scenario_margins::ScenarioMargins;
use flexsc_core::analysis::settling_time::settling_times;

use crate::margins::wheel_loop;
use crate::util::Dir;

/// Returns the settling time of a scenario about its only axis.
fn only(text: &str) -> f64 {
    let scenario = Scenario::parse("wheel.toml", text).expect("valid");
    let found = settling_times(&scenario).expect("linear");
    assert_eq!((found.len(), found[0].step, found[0].angle), (1, "angle", "angle"));
    found[0].time_s
}

/// The root of the sum of |r| |l|^k, by 36-digit arithmetic over the eigenvectors; the derivatives by its differences.
#[test]
fn the_bound_of_a_loop_with_four_modes() {
    let text = wheel_loop(0.0);
    let nominal = only(&text);
    assert!((nominal - 163.357_575_447_6).abs() < 1e-9, "{nominal:.12}");
    let slower = [
        ("0.3", "0.2"),
        ("0.8", "0.5333333333333333"),
        ("1.0", "0.6666666666666666"),
        ("2.0", "1.3333333333333333"),
    ];
    let scaled = slower.iter().fold(text.clone(), |text, (of, to)| {
        text.replace(&format!("frequency = {of},"), &format!("frequency = {to},"))
    });
    let slow = only(&scaled);
    assert!((slow - 186.212_964_883_8).abs() < 1e-9, "{slow:.12}");
    for (key, value, step, expected) in
        [("k_p", 7.5, 1e-3, 2.502_735_389_8), ("k_d", 275.0, 1e-2, -0.606_472_940_79)]
    {
        let written = format!("{key} = {value:?}");
        assert!(text.contains(&written), "{text}");
        let at = |value: f64| only(&text.replace(&written, &format!("{key} = {value}")));
        let slope = (at(value + step) - at(value - step)) / (2.0 * step);
        assert!((slope / expected - 1.0).abs() < 1e-5, "{key}: {slope}, expected {expected}");
    }
}

/// Scenarios whose actuators are later by a little less and a little more than the margin, of loops with one sample of the law in
/// a period and with several.
#[test]
fn the_common_delay_is_the_limit_of_stability() {
    let dir = Dir::with(&["attitude-hold", "earth-observer"]);
    let text = std::fs::read_to_string(dir.path("earth-observer.toml")).expect("a file");
    let wheels = text.find("[actuator.wheels]").expect("wheels");
    let end = wheels + text[wheels..].find("\n[").expect("another table");
    let torques = format!("{}[actuator.wheel]\ngain = 1.0\n{}", &text[..wheels], &text[end..]);
    std::fs::write(dir.path("torques.toml"), torques).expect("a file");
    for (name, key, samples) in
        [("attitude-hold", "actuator.wheel.delay", 1), ("torques", "actuator.wheel.delay", 2)]
    {
        let margins = dir.run(&format!("margins {name}.toml --json")).exits(0).json();
        assert_eq!(margins["samples"], samples);
        let delay = margins["common_delay_s"].as_f64().expect("unstable with a long delay");
        for (factor, code) in [(1.0 - 1e-6, 0), (1.0 + 1e-6, 2)] {
            let late = delay * factor;
            let told = dir.run(&format!("margins {name}.toml --set {key}={late}")).exits(code);
            if code == 2 {
                told.says(&["not stable"]);
            }
        }
    }
}

/// Returns a rigid body with PD laws about three axes: its tensor, the gains about each axis, the period, and the delay.
fn rigid(tensor: [[f64; 3]; 3], gains: [[f64; 2]; 3], period: f64, delay: f64) -> Scenario {
    let law = |(axis, [k_p, k_d]): (&str, [f64; 2])| {
        format!("[law.per_axis.{axis}.pd]\nk_p = {k_p}\nk_d = {k_d}\nperiod = {period}\n")
    };
    let laws: String = ["roll", "pitch", "yaw"].into_iter().zip(gains).map(law).collect();
    let text = format!(
        "duration = 10.0\n[body.spatial]\ninertia = {tensor:?}\npoints = [{{ name = \"hub\" }}]\n[sensor.sampled]\n\
         period = {period}\nrate_noise = 1e-6\n{laws}[actuator.wheel]\ngain = 1.0\ndelay = {delay}\n"
    );
    Scenario::parse("rigid.toml", &text).expect("valid")
}

/// Slow loops whose delay is thousands of periods, and coupled ones whose delay is a part of a period: 40 digits,
/// `tests/golden/common_delay_oracle.py`.
#[test]
fn the_common_delay_of_slow_and_of_coupled_loops() {
    let delay = |scenario: &Scenario| {
        let margins = ScenarioMargins::from_scenario(scenario, LoopBreak::Command).expect("stable");
        margins.common_delay_s.expect("unstable with a long delay")
    };
    let diagonal = [[100.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 120.0]];
    for (bandwidth, period, expected) in [
        (0.03, 0.1, 24.520_379_006_776_41),
        (0.01, 0.1, 73.661_105_124_742_67),
        (0.002, 0.01, 368.550_500_941_274_45),
    ] {
        let gains = [100.0, 80.0, 120.0].map(|own| [own * bandwidth * bandwidth, 1.4 * own * bandwidth]);
        let found = delay(&rigid(diagonal, gains, period, 0.0));
        assert!((found / expected - 1.0).abs() < 1e-9, "{bandwidth}: {found:.15}, expected {expected:.15}");
    }
    let tensor = [[100.0, 8.0, -5.0], [8.0, 80.0, 6.0], [-5.0, 6.0, 120.0]];
    let gains = [[81.0, 126.0], [28.8, 67.2], [10.8, 50.4]];
    for own in [0.0, 0.2, 0.5] {
        let (found, expected) = (delay(&rigid(tensor, gains, 0.5, own)), 0.573_728_430_446_654_7 - own);
        assert!((found / expected - 1.0).abs() < 1e-9, "{own}: {found:.15}, expected {expected:.15}");
    }
}

#[test]
fn the_command_prints_both() {
    let dir = Dir::with(&["earth-observer", "wheel-fixed-gain"]);
    let told = dir.run("margins earth-observer.toml").exits(0);
    told.says(&[
        "delay that all actuators together may add: ",
        "settling within 5 % after a step of the target: roll ",
    ]);
    let object = dir.run("margins earth-observer.toml --json").exits(0).json();
    assert!(object["common_delay_s"].as_f64().is_some_and(|delay| delay > 0.1));
    assert_eq!(object["settling"].as_array().map(Vec::len), Some(9));
}
