//! Structured tuning against an independent search: a yaw axis with four modes and a notch, alone and over the corners of
//! its frequencies; and `flexsc tune --vary` on shipped scenarios.

use flexsc_core::Scenario;
use flexsc_core::analysis::margins::StabilityMargins;
use flexsc_core::analysis::open_loop::{LoopBreak, OpenLoop};
use flexsc_core::analysis::structured_tuning::{
    LoopSet, TunedLoop, TunedParameter, TunedPlant, TuningFault, TuningGoal, tune,
};

use crate::margins::yaw_axis;
use crate::util::Dir;

/// Returns the tuning of the yaw axis over its nominal frequencies, and over the corners of +-10 % of each if `corners`.
fn tuned(corners: bool, bandwidth: Option<f64>) -> TunedLoop {
    let parameter = |key: &str, start: f64, low: f64, high: f64| TunedParameter {
        key: key.to_owned(),
        start,
        range: [low, high],
    };
    let parameters = [
        parameter("k_d", 0.07, 0.01, 0.2),
        parameter("notch", 1.5557, 1.0, 2.5),
        parameter("r", 0.9, 0.05, 0.98),
    ];
    let plant_at = |values: &[f64], plant: usize| {
        let factor = |mode: usize| match plant.checked_sub(1) {
            None => 1.0,
            Some(corner) if (corner >> mode) & 1 == 1 => 1.1,
            Some(_) => 0.9,
        };
        let opened = yaw_axis([0, 1, 2, 3].map(factor), [values[0], values[1], values[2]]);
        Ok(TunedPlant { opened, measures: Vec::new() })
    };
    let goal = TuningGoal { bandwidth, ..TuningGoal::default() };
    let set = LoopSet { plant_at: &plant_at, plants: if corners { 17 } else { 1 }, goal };
    tune(&set, &parameters).expect("stable")
}

fn agree(what: &str, found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{what}: {found:.12}, expected {expected:.12}");
}

/// The optimum of a search of its own: 60 linear programmes over minima found by golden section, with gradients by the
/// envelope theorem. Three minima are equal there, which fixes the three parameters.
#[test]
fn the_nominal_loop_has_three_equal_minima() {
    let found = tuned(false, None);
    agree("before", found.before.plants[0].margin, 0.550_988_725_078_1, 1e-11);
    agree("least", found.after.plants[0].margin, 0.789_864_859_7, 1e-9);
    for (value, expected) in found.after.values.iter().zip([0.048_146_16, 1.628_518_1, 0.553_121_64]) {
        agree("value", *value, expected, 1e-6);
    }
    agree("radius", found.after.plants[0].spectral_radius, 0.998_416_0, 1e-6);
    assert!(found.steps < 300, "{}", found.steps);
}

/// Over 17 plants, four minima of four corners are equal. Another local optimum has .68545.
#[test]
fn the_corners_have_four_equal_minima() {
    let found = tuned(true, None);
    let worst = found.before.worst().expect("plants");
    agree("before", worst.margin, 0.129_119_690_882_4, 1e-10);
    // The first frequency is low, the others are high.
    assert_eq!(worst.plant, 1 + 0b1110);
    agree("least", found.after.worst().expect("plants").margin, 0.714_725_369_8, 1e-9);
    for (value, expected) in found.after.values.iter().zip([0.041_669_09, 1.641_963_95, 0.333_051_05]) {
        agree("value", *value, expected, 1e-6);
    }
    let equal = found.after.plants.iter().filter(|plant| plant.margin < 0.714_725_38);
    let mut corners: Vec<usize> = equal.map(|plant| plant.plant - 1).collect();
    corners.sort_unstable();
    assert_eq!(corners, [0b0000, 0b0001, 0b1110, 0b1111]);
}

/// With a bandwidth the rate gain cannot fall: the loop gain is 1 at the frequency.
#[test]
fn a_bandwidth_is_kept() {
    let without = tuned(false, None);
    let frequency = 0.07;
    let found = tuned(false, Some(frequency));
    let nominal = yaw_axis([1.0; 4], [found.after.values[0], found.after.values[1], found.after.values[2]]);
    let margins = StabilityMargins::new(&nominal).expect("stable");
    let crossing = margins.loops[0].crossings.gain[0].frequency_rad_s;
    agree("crossing", crossing, frequency, 1e-6);
    assert!(found.after.values[0] > 1.05 * without.after.values[0], "{:?}", found.after.values);
    let least = found.after.plants[0].margin;
    assert!(least < without.after.plants[0].margin && least > found.before.plants[0].margin, "{least}");
}

#[test]
fn an_unstable_loop_is_refused() {
    let plant_at = |values: &[f64], _: usize| {
        Ok(TunedPlant { opened: yaw_axis([1.0; 4], [values[0], 1.5557, 0.9]), measures: Vec::new() })
    };
    let set = LoopSet { plant_at: &plant_at, plants: 1, goal: TuningGoal::default() };
    let parameter = TunedParameter { key: "k_d".to_owned(), start: 1.0, range: [0.5, 2.0] };
    let fault = tune(&set, &[parameter]).expect_err("unstable");
    assert!(matches!(fault, TuningFault::Unstable(0, radius) if radius > 1.0), "{fault}");
}

/// Returns the modulus margin of a scenario.
fn modulus(path: &std::path::Path) -> f64 {
    let scenario = Scenario::load(path).expect("a scenario");
    let opened = OpenLoop::from_scenario(&scenario, LoopBreak::Command).expect("linear");
    StabilityMargins::new(&opened).expect("stable").modulus.margin
}

#[test]
fn the_command_writes_a_tuned_scenario() {
    let dir = Dir::with(&["earth-observer", "wheel-fixed-gain"]);
    let line =
        "tune earth-observer.toml --vary law.attitude.bandwidth=0.02:0.3 --vary law.attitude.damping=0.4:1.5";
    let told = dir.run(&format!("{line} --bandwidth 0.08 --save tuned.toml -o figures"));
    told.exits(0).says(&["least modulus margin of 1 plant", "law.attitude.damping", "tuned.toml"]);
    assert!(dir.path("figures/earth-observer-tune-margin.svg").exists());
    let (before, after) = (modulus(&dir.path("earth-observer.toml")), modulus(&dir.path("tuned.toml")));
    assert!(after > before + 0.01, "{before} {after}");
    // The file is as it was but for the two numbers, with its comments.
    let [old, new] = ["earth-observer.toml", "tuned.toml"].map(|name| dir.text(name));
    let changed: Vec<&str> =
        new.lines().zip(old.lines()).filter(|(new, old)| new != old).map(|(new, _)| new).collect();
    assert_eq!(new.lines().count(), old.lines().count());
    assert!(changed.len() == 2 && changed[0].contains("# rad/s"), "{changed:?}");
    // The tuned scenario is a scenario of its own: a second search stays where it is.
    let again = line.replace("earth-observer.toml", "tuned.toml");
    let object = dir.run(&format!("{again} --bandwidth 0.08 --json")).exits(0).json();
    let (start, end) = (object["least_margin_before"].as_f64(), object["least_margin"].as_f64());
    let (start, end) = (start.expect("a number"), end.expect("a number"));
    assert!((start - after).abs() < 1e-12 && end - start < 1e-6, "{start} {end} {after}");
    for (arguments, told) in [
        ("--vary law.attitude.width=1:2", "law.attitude.width"),
        ("--vary law.attitude.damping=2:1", "LO < HI"),
        ("--vary law.attitude.damping=1:2", "does not contain the value of the scenario, 0.8"),
        ("--vary law.attitude.damping=0.5:1 --robust 0.1", "cannot be used with"),
        ("--bandwidth 1", "--vary"),
        ("--vary law.attitude.damping=0.5:1 --save tuned.txt", "must end in .toml"),
        ("--vary law.attitude.damping=0.5:1 --save earth-observer.toml", "already exists"),
        ("--vary law.attitude.damping=0.5:1 --vary law.attitude.damping=0.5:1", "given twice"),
    ] {
        dir.run(&format!("tune earth-observer.toml {arguments}")).exits(2).says(&[told]);
    }
}

#[test]
fn uncertain_keys_are_corners() {
    let dir = Dir::with(&["earth-observer"]);
    let text = std::fs::read_to_string(dir.path("earth-observer.toml")).expect("a file");
    let scenario = Scenario::load(&dir.path("earth-observer.toml")).expect("a scenario");
    let known = scenario.uncertain.len();
    let line = "tune earth-observer.toml --vary law.attitude.damping=0.4:1.5 --json";
    let all = dir.run(line).exits(0).json();
    let plants = all["plants"].as_array().expect("plants").len();
    assert_eq!(plants, if known == 0 { 1 } else { 1 + (1 << known) }, "{text}");
    let nominal = dir.run(&format!("{line} --nominal")).exits(0).json();
    assert_eq!(nominal["plants"].as_array().expect("plants").len(), 1);
}

/// The settling time falls until a limit of the margin binds. The tuned scenario has the numbers that the tuning states.
#[test]
fn a_settling_time_within_a_margin() {
    let dir = Dir::with(&["attitude-hold"]);
    let line = "tune attitude-hold.toml --vary law.per_axis.yaw.pd.k_p=5:200 --vary law.per_axis.yaw.pd.k_d=50:2000 \
                --vary law.per_axis.roll.pd.k_p=5:200 --vary law.per_axis.roll.pd.k_d=50:2000 \
                --vary law.per_axis.pitch.pd.k_p=5:200 --vary law.per_axis.pitch.pd.k_d=50:2000";
    let told = dir.run(&format!("{line} --objective settling --keep margin>=0.9 --save tuned.toml")).exits(0);
    told.says(&["settling  24.95 s", "margin"]);
    let longest = |path: &str| {
        let found = dir.run(&format!("margins {path} --json")).exits(0).json();
        let times = found["settling"].as_array().expect("times").iter();
        let longest = times.map(|own| own["time_s"].as_f64().expect("settles")).fold(0.0, f64::max);
        (longest, found["modulus"]["margin"].as_f64().expect("a margin"))
    };
    let (before, _) = longest("attitude-hold.toml");
    let (after, margin) = longest("tuned.toml");
    assert!(after < 0.5 * before, "{before} s before, {after} s tuned");
    assert!((0.9 - 1e-6..0.91).contains(&margin), "{margin}");
    // The other way round: the largest margin that settles as fast ends at the same point.
    let limit = format!("--keep settling<={after}");
    let object = dir.run(&format!("{line} {limit} --json")).exits(0).json();
    let measure = &object["measures"][0];
    assert_eq!(measure["name"], "settling");
    assert!(measure["after"].as_f64().expect("finite") <= after * (1.0 + 1e-6), "{measure}");
    let least = object["least_margin"].as_f64().expect("a margin");
    assert!(least > 0.89, "{least}");
}

/// The rms of a pointing index, which `flexsc budget` gives for the tuned scenario, and a limit of it.
#[test]
fn a_pointing_index_is_minimised_and_limited() {
    let dir = Dir::with(&["attitude-hold"]);
    let text = std::fs::read_to_string(dir.path("attitude-hold.toml")).expect("a file");
    let requirement = "\n[[requirement]]\nname = \"jitter\"\nquantity = \"pointing_error\"\naxis = \"y\"\n\
                       index = \"RPE\"\nwindow = 10\nconvention = \"uniform\"\nfrom = 150\nlimit = 1e-4\n\
                       level = 0.997\ninterpretation = \"mixed\"\n";
    std::fs::write(dir.path("hold.toml"), format!("{text}{requirement}")).expect("a file");
    let line =
        "tune hold.toml --vary law.per_axis.pitch.pd.k_p=10:60 --vary law.per_axis.pitch.pd.k_d=100:600";
    let object = dir.run(&format!("{line} --objective jitter --save tuned.toml --json")).exits(0).json();
    let measure = &object["measures"][0];
    let (before, after) =
        (measure["before"].as_f64().expect("finite"), measure["after"].as_f64().expect("finite"));
    assert!(after < 0.9 * before, "{before} {after}");
    let budget = dir.run("budget tuned.toml --runs 2 --json").exits(0).json();
    let noise = budget["budgets"][0]["linear_noise"].as_f64().expect("linear");
    assert!((noise / after - 1.0).abs() < 1e-9, "{noise} {after}");
    let middle = 3.0 * 0.5 * (before + after);
    let limited = format!("{line} --keep jitter --set requirement[0].limit={middle} --json");
    let object = dir.run(&limited).exits(0).json();
    let kept = object["measures"][0]["after"].as_f64().expect("finite");
    assert!(3.0 * kept <= middle * (1.0 + 1e-6), "{kept} {middle}");
    for (arguments, told) in [
        ("--objective jiter", "no requirement `jiter`"),
        ("--keep margin<=0.5", "margin>=VALUE"),
        ("--keep margin>=0", "margin>=VALUE"),
    ] {
        dir.run(&format!("{line} {arguments}")).exits(2).says(&[told]);
    }
}

/// A search for margins alone says what it costs: the settling time, and that a key goes to the end of its range.
#[test]
fn a_search_says_that_settling_is_lost_and_that_a_range_ends_it() {
    let dir = Dir::with(&["earth-observer"]);
    dir.write(
        "hertz.toml",
        dir.text("earth-observer.toml").replace("bandwidth = 0.1 ", "bandwidth = \"0.016 Hz\" "),
    );
    let line = "tune hertz.toml --vary law.attitude.bandwidth=0.02:0.4 --nominal --save tuned.toml";
    dir.run(line).exits(0).says(&[
        "! settling of the nominal plant 42.",
        "--keep 'settling<=42.",
        "! law.attitude.bandwidth ends at its lowest value",
        "0.016 Hz",
    ]);
    // The number keeps its unit.
    assert!(dir.text("tuned.toml").contains("bandwidth = \"0.00318"), "{}", dir.text("tuned.toml"));
}
