//! Broadband forces and lines of machines on the bench of micro-vibration, against an independent computation, in linear loops and in runs.

use flexsc_core::Scenario;
use serde_json::Value;

use crate::fine_mirror::MIRROR;
use crate::mounts::{MOUNT, WHEELS};
use crate::optics::BENCH;
use crate::traces::{nested, traced};
use crate::util::Dir;

/// Density of the forces on the wheel unit.
pub const DENSITY: &str = r#"
[[disturbance]]
point = "rotor"
density = { force = [1e-6, 1e-6, 1e-6], lower = "5 Hz", upper = "120 Hz" }
"#;

/// Returns the bench under a law on the hub's rotation, of 0.05 Hz and with samples of a period (s), and what else acts.
pub fn bench(period: f64, loads: &str) -> String {
    let start = BENCH.find("[[sensor]]").expect("sensors");
    let end = BENCH.find("[actuator").expect("actuators");
    let law = format!(
        "[law.attitude]\nperiod = {period}\nbandwidth = \"0.05 Hz\"\ndamping = 0.7\n\
         inertia = [[4.2, 0, 0], [0, 3.9, 0], [0, 0, 4.8]]\n"
    );
    let text = format!("{}{law}{}{loads}", &BENCH[..start], &BENCH[end..]);
    text.replace("seed = 1\n", "seed = 1\nsensor = \"continuous\"\n")
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Asserts that two numbers agree to a fraction of the second.
pub fn agree(what: &str, found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{what}: {found:.12e}, expected {expected:.12e}");
}

/// Samples at 1 kHz, and at 100 Hz, where the law shakes the second mode through its aliases. Source: `tests/golden/broadband.py`; the
/// wheels of the scenario have some inertia, which is 2e-8 of the deviations.
#[test]
fn broadband_forces_move_the_line_of_sight_as_covariances_say() {
    let dir = Dir::new();
    #[rustfmt::skip]
    let golden = [
        (0.001, [5.755_744_551_780e-8, 6.221_408_938_144e-8], [5.755_744_552_569e-8, 6.221_408_940_798e-8], [5.671_125_102_175e-8, 6.069_332_081_679e-8]),
        (0.01, [6.527_487_413_753e-8, 9.888_027_571_555e-8], [6.527_497_266_220e-8, 9.888_080_345_691e-8], [6.452_866_031_218e-8, 9.792_306_828_005e-8]),
    ];
    for (period, at_samples, over_time, means) in golden {
        dir.write("bench.toml", bench(period, DENSITY));
        let command = "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --window 0.02 --json";
        let report = dir.run(command).exits(0).json();
        assert_eq!(report["sources"], serde_json::json!(["disturbance[0].density"]));
        for about in 0..2 {
            let output = &report["outputs"][about];
            agree("rms", number(&output["rms"]), over_time[about], 1e-7);
            agree("source", number(&output["rms_by_source"][0]), over_time[about], 1e-7);
            agree("samples", number(&output["sample_rms"]), at_samples[about], 1e-7);
            agree("mean", number(&output["window"]["mpe"]), means[about], 1e-7);
            let last = output["cumulative_rms"].as_array().and_then(|all| all.last()).expect("numbers");
            // At 1 kHz the loop is nearly the continuous one of the bench, whose wheel turns.
            if period < 0.005 {
                let bench = [(5.755_262_772e-8, 1e-4), (6.211_101_866e-8, 2e-3)];
                agree("bench", number(&output["rms"]), bench[about].0, bench[about].1);
            }
            agree("cumulative", number(last), over_time[about], 1e-7);
        }
    }
}

/// The wheel on its mount at 50 Hz, whose rotor whirls, and a mirror behind the line of sight. Source: `tests/golden/broadband.py`, which
/// has the published numbers of a bench with a continuous law. The mount makes broadband forces worse, by 10 % about x at 1 kHz, and the
/// mirror slow ones better. At 100 Hz lines above the Nyquist frequency of the law, which are left out, have 5e-6 of the rms.
#[test]
fn broadband_forces_pass_a_mount_and_a_mirror() {
    let dir = Dir::new();
    let imbalance = WHEELS.find("imbalance").expect("an imbalance");
    let on_mount = |period: f64| {
        bench(period, DENSITY)
            .replace("arrangement = \"orthogonal\"\ninertia = 1e-7", &WHEELS[..imbalance])
            .replace("name = \"wheel unit\"\n", &format!("name = \"wheel unit\"\n{MOUNT}"))
            .replacen(
                "[[4.2, 0, 0], [0, 3.9, 0], [0, 0, 4.8]]",
                "[[4.2016, 0, 0], [0, 3.9016, 0], [0, 0, 4.8016]]",
                1,
            )
            .replace("[law.attitude]", &format!("{MIRROR}[law.attitude]"))
    };
    let names = ["line_of_sight0_x", "line_of_sight0_y"];
    let before = names.map(|name| format!("{name}_before_mirror"));
    let all = format!("{},{},{},{}", before[0], before[1], names[0], names[1]);
    for (period, golden, part) in [
        (0.01, [6.342_049_016e-8, 6.768_652_689e-8, 1.629_444_535e-8, 1.674_251_471e-8], 1e-5),
        (0.001, [6.332_449_681e-8, 6.749_006_316e-8, 1.628_592_419e-8, 1.673_481_978e-8], 1e-8),
    ] {
        dir.write("bench.toml", on_mount(period));
        let report = dir.run(&format!("spectrum bench.toml --signal {all} --json")).exits(0).json();
        for (place, expected) in golden.into_iter().enumerate() {
            agree(&all, number(&report["outputs"][place]["rms"]), expected, part);
        }
    }
    // Of exposures: their means, what is left, and straight lines.
    for (exposure, x, y) in [
        (
            0.02,
            [6.085_301_636e-8, 1.751_862_692e-8, 1.669_273_664e-8],
            [6.498_911_575e-8, 1.820_229_267e-8, 1.735_113_733e-8],
        ),
        (
            0.004,
            [6.320_888_353e-8, 3.824_778_706e-9, 3.817_341_045e-9],
            [6.737_219_979e-8, 3.986_893_594e-9, 3.977_700_781e-9],
        ),
    ] {
        let command =
            format!("spectrum bench.toml --signal {},{} --window {exposure} --json", before[0], before[1]);
        let report = dir.run(&command).exits(0).json();
        for (place, golden) in [x, y].into_iter().enumerate() {
            let window = &report["outputs"][place]["window"];
            for (key, expected) in ["mpe", "rpe_uniform", "smear"].into_iter().zip(golden) {
                agree(&format!("{key} over {exposure} s"), number(&window[key]), expected, 1e-7);
            }
        }
    }
}

/// Cooler whose strokes are known to a tenth.
const COOLER: &str = r#"
[[disturbance]]
point = "rotor"
[disturbance.lines]
frequency = "51 Hz"
harmonics = [
  { order = 1, force = [0.01, 0, 0.02] },
  { order = 2, force = [0, 0.003, 0], torque = [2e-4, 0, 0], phase = 1.0 },
]
"#;

/// At the worst frequency for x an alias of the second harmonic is within the band of the law, and 200 times the rest; for y the worst is
/// an end of the range. Source: `tests/golden/broadband.py`.
#[test]
fn lines_of_a_machine_are_at_their_worst_frequency() {
    let dir = Dir::new();
    let command = "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --json";
    let machines = |about: usize, text: String| {
        dir.write("bench.toml", text);
        let report = dir.run(command).exits(0).json();
        let own = &report["outputs"][about]["machines"][0];
        assert_eq!(own["source"], "disturbance[0].lines");
        // The cumulative rms has all lines, also those above the Nyquist frequency of the law.
        let output = &report["outputs"][about];
        let last = output["cumulative_rms"].as_array().and_then(|all| all.last()).expect("numbers");
        agree("cumulative", number(last), number(&output["rms"]), 1e-3);
        ["frequency_rad_s", "rms", "peak"].map(|key| number(&own[key]))
    };
    let nominal = [(5.618_647_738_181e-10, 9.551_164_11e-10), (3.128_011_993_153e-10, 4.441_789_69e-10)];
    for (about, (rms, peak)) in nominal.into_iter().enumerate() {
        let found = machines(about, bench(0.01, COOLER));
        // Aliases above the Nyquist frequency of the law are not among the lines.
        agree("rms", found[1], rms, 1e-6);
        agree("peak", found[2], peak, 1e-7);
    }
    let wide = COOLER.replace("harmonics", "tolerance = 0.1\nharmonics");
    let hertz = std::f64::consts::TAU;
    let [at, rms, peak] = machines(0, bench(0.01, &wide));
    agree("at", at / hertz, 49.987_800_51, 1e-7);
    agree("rms", rms, 1.564_895_101_171e-7, 1e-7);
    agree("peak", peak, 7.510_75e-10, 1e-5);
    let [at, rms, _] = machines(1, bench(0.01, &wide));
    agree("at", at / hertz, 45.9, 1e-7);
    agree("rms", rms, 1.276_624_948_6e-9, 1e-6);
}

/// Runs draw what linear loops have: a line of sight under both kinds of load, after what the start of a load has left in the loop.
#[test]
fn runs_have_the_motion_of_linear_loops() {
    let dir = Dir::new();
    let rms = |report: &Value| {
        let outputs = report["outputs"].as_array().expect("outputs");
        outputs.iter().map(|own| number(&own["rms"]).powi(2)).sum::<f64>().sqrt()
    };
    // A run has samples, in which a line and its alias by the law add up. What the start leaves has decayed to 1e-11 rad after 140 s.
    for (load, from, duration, part) in [(DENSITY, 80, 160, 0.12), (COOLER, 140, 160, 0.02)] {
        dir.write("bench.toml", bench(0.01, load));
        let linear = "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --json";
        let expected = rms(&dir.run(linear).exits(0).json());
        let set = format!("--set duration={duration} --set line_of_sight[0].window=[{from},{duration}]");
        let run = dir.run(&format!("simulate bench.toml {set} --log none --json")).exits(0).json();
        let found = number(&run["metrics"]["line_of_sight_rms_rad"][0]);
        agree(load, found, expected, part);
    }
}

/// The frequencies of the noise are among those of the densities, and its density is what it is alone.
#[test]
fn densities_keep_the_frequencies_of_the_noise() {
    let dir = Dir::new();
    let densities = |text: String| -> Vec<(f64, f64)> {
        dir.write("bench.toml", text);
        let report = dir.run("spectrum bench.toml --signal roll --json").exits(0).json();
        let own = &report["outputs"][0]["density_by_source"][0];
        let numbers = |list: &Value| list.as_array().expect("a list").iter().map(number).collect::<Vec<_>>();
        numbers(&report["frequency_hz"]).into_iter().zip(numbers(own)).collect()
    };
    let alone = densities(BENCH.to_owned());
    let table = DENSITY.replace(
        &DENSITY[DENSITY.find("density").expect("a key")..],
        "density = { table = [[20, 1e-7], [40, 1e-7]] }\n",
    );
    let both = densities(format!("{BENCH}{table}"));
    assert!(both.len() > alone.len() && both.is_sorted_by(|a, b| a.0 < b.0));
    for (frequency, density) in alone {
        let place = both.partition_point(|own| own.0 < frequency * (1.0 - 1e-12));
        agree("frequency", both[place].0, frequency, 1e-12);
        agree("density", both[place].1, density, 1e-9);
    }
}

/// A torque about the boresight turns these optics too, because one of them is off it: by 0.012 rad for 1 rad.
#[test]
fn optics_off_the_boresight_see_the_rotation_about_it() {
    let twist = "\n[[disturbance]]\npoint = \"rotor\"\n[disturbance.lines]\nfrequency = \"51 Hz\"\n\
                 harmonics = [{ order = 1, torque = [0, 0, 0.01] }]\n";
    let text = bench(0.01, twist);
    let dir = Dir::new();
    dir.write("bench.toml", &text);
    let command = "spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --json";
    let report = dir.run(command).exits(0).json();
    let short = text.replacen("duration = 2.0", "duration = 100.0", 1);
    assert_ne!(short, text);
    let trace = traced(&Scenario::parse("bench.toml", &short).expect("a scenario"));
    for about in 0..2 {
        let errors = nested(&trace, "/line_of_sight", ["axes", "error_rad"], (about, 3));
        let late = &errors[errors.len() - 500..];
        let mean = late.iter().sum::<f64>() / 500.0;
        let rms = (late.iter().map(|error| (error - mean).powi(2)).sum::<f64>() / 500.0).sqrt();
        agree("run", rms, number(&report["outputs"][about]["rms"]), 2e-3);
    }
}

/// Requirement on the line of sight, sampled like it.
const REQUIREMENT: &str = r#"
[[requirement]]
name = "sharp"
quantity = "line_of_sight"
point = "detector"
axis = "y"
limit = "1 arcsec"
"#;

#[test]
fn budgets_have_machines() {
    let dir = Dir::new();
    let budget = |period: f64, load: &str| {
        dir.write("bench.toml", bench(period, load) + REQUIREMENT);
        let report = dir.run("budget bench.toml --runs 2 --json").exits(0).json();
        report["budgets"][0].clone()
    };
    let own = budget(0.001, DENSITY);
    agree("noise", number(&own["linear_noise"]), 6.221_408_940_798e-8, 1e-7);
    let own = budget(0.01, COOLER);
    let sines = own["linear_sources"]["amplitudes"].as_array().expect("sines").iter().map(number);
    let rms = sines.map(|amplitude| 0.5 * amplitude * amplitude).sum::<f64>().sqrt();
    agree("sines", rms, 3.128_011_993e-10, 1e-6);
}

/// Sensors with a hundred samples of the law in their period, behind a mirror: too many lines, and the reason of `spectrum`.
#[test]
fn budgets_refuse_what_the_spectrum_refuses() {
    let dir = Dir::new();
    let text = BENCH
        .replace("gyro = { period = 0.1", "gyro = { period = 0.005")
        .replace("star_tracker = { period = 0.1", "star_tracker = { period = 0.5")
        .replace("[law.attitude]\nperiod = 0.1", &format!("{MIRROR}[law.attitude]\nperiod = 0.005"));
    dir.write("bench.toml", text + DENSITY + REQUIREMENT);
    let why = &["disturbance[0].density", "lines of outputs with the aliases of law and mirror"];
    dir.run("spectrum bench.toml --signal line_of_sight0_y").exits(2).says(why);
    dir.run("budget bench.toml --runs 1 -o figures").exits(2).says(why);
    assert!(!dir.has("figures"));
    dir.run("tune bench.toml --vary law.attitude.bandwidth=0.5:1.5 --objective sharp").exits(2).says(why);
}

#[test]
fn machines_that_do_not_hold_are_refused() {
    let dir = Dir::new();
    for (load, from, to, why) in [
        (
            DENSITY,
            "upper = \"120 Hz\"",
            "upper = \"2 Hz\"",
            "`disturbance[0].density.upper` must be above `lower`",
        ),
        (DENSITY, "lower = \"5 Hz\"", "lower = 1e-7", "`disturbance[0].density.lower` must be at least"),
        (DENSITY, ", upper = \"120 Hz\"", "", "`disturbance[0].density.upper` must be given"),
        (
            DENSITY,
            "force = [1e-6, 1e-6, 1e-6]",
            "force = [0, 0, 0]",
            "`disturbance[0].density.force` must have a density",
        ),
        (
            DENSITY,
            "lower = ",
            "table = [[1, 1], [2, 1]], lower = ",
            "`disturbance[0].density.table` has the densities",
        ),
        (DENSITY, "density", "force = [1, 0, 0]\ndensity", "`disturbance[0].density` must be alone"),
        (DENSITY, "rotor", "stator", "`disturbance[0].point`"),
        (COOLER, "order = 1", "order = 0", "order`: must be a positive number"),
        (
            COOLER,
            "frequency",
            "tolerance = 0.9\nfrequency",
            "`disturbance[0].lines.tolerance` must be at most 0.5",
        ),
        (
            COOLER,
            "order = 2, force = [0, 0.003, 0], torque = [2e-4, 0, 0]",
            "order = 2",
            "`disturbance[0].lines.harmonics[1]` must have",
        ),
    ] {
        assert!(load.contains(from), "{from}");
        dir.write("bench.toml", bench(0.01, &load.replace(from, to)));
        dir.run("check bench.toml").exits(2).says(&[why]);
    }
    // A table of a file that is not in order.
    let table = "density = { table = \"test.csv\" }";
    let text = DENSITY.replace(&DENSITY[DENSITY.find("density").expect("a key")..], table);
    dir.write("bench.toml", bench(0.01, &text));
    dir.write("test.csv", "frequency,force\n5,1e-7\n4,1e-6\n");
    dir.run("spectrum bench.toml")
        .exits(2)
        .says(&["test.csv", "line 3: must have increasing positive frequencies"]);
    let open = bench(0.01, DENSITY);
    let law = &open[open.find("[law").expect("a law")..open.find("[actuator").expect("an actuator")];
    let actuators =
        &open[open.find("[actuator").expect("actuators")..open.find("[[disturbance").expect("a load")];
    dir.write("open.toml", open.replace(law, "[law.open]\n").replace(actuators, ""));
    dir.run("spectrum open.toml").exits(2).says(&["law.open", "answers a slow force with 1/f²"]);
}
