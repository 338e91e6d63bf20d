//! Wheels on mounts: poles with whirl and lines against an independent computation, and what a wrong model gives.

use std::f64::consts::TAU;

use flexsc_core::Scenario;
use flexsc_core::analysis::body_poles::WhirlPoles;
use flexsc_core::analysis::eigenvalues::eigenvalues;
use flexsc_core::analysis::linear_model::LinearModel;
use flexsc_core::analysis::noise::{LineLoop, LineSource, WheelSpectrum};
use flexsc_core::dynamics::three_axis_model::ThreeAxisModel;
use flexsc_core::numerics::attitude::Vector;
use nalgebra::{Complex, DMatrix, DVector};
use serde_json::Value as Json;

use crate::optics::BENCH;
use crate::util::Dir;

/// Speed of the wheel (rad/s).
const SPEED: f64 = 50.0 * TAU;
/// Mount of the wheel, and the wheels: the first turns on it about y, the others on the hub, whose inertia has theirs.
pub const MOUNT: &str =
    "mount = { translation = \"22 Hz\", rocking = \"30 Hz\", damping = 0.06, axis = [0, 1, 0] }\n";
pub const WHEELS: &str = "axes = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]\ninertia = 1.6e-3\npoints = [\"rotor\", \"hub\", \"hub\"]\n\
                      speeds = [\"3000 rpm\", 0, 0]\nspeed_limit = \"6000 rpm\"\n\
                      imbalance = { static = [3.6e-6, 0, 0], dynamic = [1.2e-7, 0, 0], phase = \"-90 deg\" }";

/// Poles (Hz) and damping ratios with the wheel at rest and at 50 Hz. Source: `tests/golden/optics.py`.
const AT_REST: [[f64; 2]; 8] = [
    [22.129_729_556_035, 0.060_350_872_393_241],
    [22.248_359_037_930, 0.060_679_935_642_693],
    [22.264_910_367_997, 0.060_731_518_032_173],
    [30.001_203_343_654, 0.060_002_330_496_146],
    [30.002_651_123_563, 0.060_005_527_009_659],
    [80.033_810_866_116, 0.005_254_395_315_621_8],
    [108.434_087_709_95, 0.004_977_414_392_806_3],
    [146.825_207_329_80, 0.005_255_770_271_915_6],
];
const AT_50_HZ: [[f64; 2]; 8] = [
    [9.184_641_607_430_1, 0.033_563_223_402_740],
    [22.129_729_556_082, 0.060_350_872_393_914],
    [22.248_366_516_367, 0.060_679_956_425_655],
    [22.264_963_085_721, 0.060_731_687_508_226],
    [80.033_810_865_950, 0.005_254_395_314_288_1],
    [98.112_208_779_553, 0.033_555_599_383_730],
    [108.434_106_377_19, 0.004_977_769_277_045_7],
    [146.825_207_374_71, 0.005_255_770_939_719_3],
];
/// Sizes of the line of sight (rad) about x and y for forces (N) along x and z and torques (N m) about x and z on the wheel, on its
/// mount at 22, 50 and 100 Hz. Source: the same.
const RESPONSES: [(f64, [[f64; 4]; 2]); 3] = [
    (
        22.0,
        [
            [
                6.276_806_921_173_8e-08,
                1.390_983_516_506_3e-06,
                4.595_163_355_771_2e-07,
                1.705_847_086_333_3e-06,
            ],
            [
                9.904_575_762_892_4e-06,
                3.096_137_276_263_4e-06,
                4.496_760_247_789_2e-08,
                9.332_887_314_721_4e-09,
            ],
        ],
    ),
    (
        50.0,
        [
            [
                4.989_296_383_535_0e-10,
                3.318_282_555_684_2e-09,
                3.459_829_379_356_5e-08,
                9.538_132_805_567_1e-08,
            ],
            [
                3.919_302_703_922_9e-08,
                1.046_404_401_032_4e-08,
                1.269_169_006_322_5e-09,
                5.412_126_753_847_9e-10,
            ],
        ],
    ),
    (
        100.0,
        [
            [
                2.373_314_998_830_9e-10,
                6.682_504_974_310_8e-09,
                1.918_345_228_726_9e-06,
                1.865_275_834_057_3e-06,
            ],
            [
                9.399_304_355_214_8e-09,
                9.038_747_292_982_2e-09,
                6.372_148_523_842_0e-09,
                6.504_387_365_310_3e-09,
            ],
        ],
    ),
];
/// Harmonic: order, force and torque over the square of the speed, amplitudes (rad) about x and y at 50 Hz, and semi-axes of their
/// ellipse.
type Line = (f64, f64, f64, [f64; 2], [f64; 2]);

/// Source: the same.
#[rustfmt::skip]
const LINES: [Line; 3] = [
    (1.0, 3.6e-6, 1.2e-7, [4.871_998_408_752_5e-10, 1.428_903_020_236_5e-08], [1.429_096_602_198_4e-08, 4.266_590_764_978_8e-10]),
    (2.0, 4.0e-7, 1.5e-8, [5.773_004_458_358_1e-09, 4.941_559_252_652_3e-10], [5.773_038_335_416_5e-09, 4.937_599_948_444_5e-10]),
    (0.6, 2.0e-7, 0.0, [1.945_142_894_067_5e-09, 1.516_164_506_786_5e-08], [1.516_638_396_171_7e-08, 1.907_841_599_306_0e-09]),
];

/// Returns the bench with its wheel on the mount, with some texts replaced.
fn bench(changes: &[(&str, &str)]) -> String {
    let mut text = BENCH.to_owned();
    let wheels = "arrangement = \"orthogonal\"\ninertia = 1e-7";
    let unit = "name = \"wheel unit\"\n";
    let inertia = "inertia = [[4.2, 0, 0], [0, 3.9, 0], [0, 0, 4.8]]";
    let free = "inertia = [[4.2016, 0, 0], [0, 3.9016, 0], [0, 0, 4.8016]]";
    let mounted = format!("{unit}{MOUNT}");
    let own = [(wheels, WHEELS), (unit, mounted.as_str()), (inertia, free)];
    for (from, to) in own.iter().chain(changes) {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    text
}

fn scenario(changes: &[(&str, &str)]) -> Scenario {
    Scenario::parse("bench.toml", &bench(changes)).expect("a scenario")
}

/// Returns the state matrix with the wheel at a speed, and a soft loop on the hub's rotation as that of the reference.
fn closed(scenario: &Scenario, speed: f64) -> DMatrix<f64> {
    let model = LinearModel::at_wheel_speed(scenario, speed).expect("a linear body");
    let matrix =
        |rows: &[Vec<f64>]| DMatrix::from_fn(rows.len(), rows[0].len(), |row, column| rows[row][column]);
    let (a, b, c) = (matrix(&model.a), matrix(&model.b), matrix(&model.c));
    let loop_frequency = 0.05 * TAU;
    let hub = DMatrix::from_diagonal(&DVector::from_row_slice(&[4.2, 3.9, 4.8]));
    let fed_back =
        &hub * c.rows(0, 3) * (loop_frequency * loop_frequency) + hub * c.rows(3, 3) * (1.4 * loop_frequency);
    a - b * fed_back
}

/// Returns the rates of the states per unit of a force and a torque on the wheel.
fn load(body: &ThreeAxisModel, [force, torque]: [Vector; 2]) -> DVector<f64> {
    let (place, shapes) = (body.point("rotor").expect("a point"), body.shapes("rotor"));
    let mut column = DVector::zeros(6 + 2 * body.modes.len());
    let turned = body.inertia.try_inverse().expect("an inertia") * (place.cross(&force) + torque);
    column.rows_mut(3, 3).copy_from(&turned);
    for (mode, (shift, turn)) in shapes.iter().enumerate() {
        column[7 + 2 * mode] = shift.dot(&force) + turn.dot(&torque);
    }
    column
}

/// Returns the complex amplitudes of the line of sight about x and y under a load.
fn seen(scenario: &Scenario, speed: f64, omega: f64, load: &DVector<Complex<f64>>) -> [Complex<f64>; 2] {
    let body = scenario.model.three_axis().expect("three axes");
    let sight = scenario.line_of_sight[0].sensitivity(body);
    let a = closed(scenario, speed).map(|entry| Complex::from(-entry));
    let order = a.nrows();
    let factor = a + DMatrix::from_diagonal_element(order, order, Complex::new(0.0, omega));
    let states = factor.lu().solve(load).expect("a solution");
    [0, 1].map(|about| {
        let rigid: Complex<f64> = (0..3).map(|axis| states[axis] * sight.rigid[(about, axis)]).sum();
        let modes = sight.modes.iter().enumerate();
        rigid + modes.map(|(mode, own)| states[6 + 2 * mode] * own[about]).sum::<Complex<f64>>()
    })
}

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found:e} {expected:e}");
}

#[test]
fn poles_split_by_whirl() {
    let scenario = scenario(&[]);
    for (speed, expected) in [(0.0, AT_REST), (SPEED, AT_50_HZ)] {
        let mut poles = eigenvalues(&closed(&scenario, speed)).expect("poles");
        poles.retain(|pole| pole.im > TAU);
        poles.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        assert_eq!(poles.len(), 8);
        for (pole, [hertz, damping]) in poles.iter().zip(expected) {
            close(pole.norm() / TAU, hertz, 1e-10, "frequency");
            close(-pole.re / pole.norm(), damping, 1e-8, "damping");
        }
    }
}

/// On a base that does not move and without damping: w = sqrt(g² + w0²) +- g, g = Is W/(2 It).
#[test]
fn whirl_on_a_fixed_base() {
    let heavy = [
        ("mass = 62.0", "mass = 62e9"),
        ("[[4.2016, 0, 0], [0, 3.9016, 0], [0, 0, 4.8016]]", "[[4.2e9, 0, 0], [0, 3.9e9, 0], [0, 0, 4.8e9]]"),
        ("damping = 0.06", "damping = 0"),
    ];
    let scenario = scenario(&heavy);
    let whirl =
        WhirlPoles::from_scenario(&scenario, Some(SPEED)).expect("poles").expect("a wheel that is carried");
    for expected in [9.177_460_053_394, 98.066_348_942_282] {
        let nearest = whirl.poles.iter().map(|pole| (pole.frequency_rad_s / TAU / expected - 1.0).abs());
        assert!(nearest.fold(1.0, f64::min) < 1e-9, "{expected}: {whirl:?}");
    }
}

/// Harmonics meet the whirl on a base that does not move: forward ones at w0/sqrt(h (h - Is/It)), if h is above Is/It, backward ones at
/// w0/sqrt(h (h + Is/It)), which have the other sense of the wheel. Both sides of each of two axes are among the speeds.
#[test]
fn harmonics_meet_the_whirl() {
    let scenario = scenario(&[
        ("mass = 62.0", "mass = 62e9"),
        ("[[4.2016, 0, 0], [0, 3.9016, 0], [0, 0, 4.8016]]", "[[4.2e9, 0, 0], [0, 3.9e9, 0], [0, 0, 4.8e9]]"),
        ("damping = 0.06", "damping = 1e-4"),
        (
            "phase = \"-90 deg\"",
            "harmonics = [{ order = 2.0, torque = 1e-8 }, { order = 0.6, torque = 1e-8 }]",
        ),
    ]);
    let source = LineSource::of_wheels(&scenario).expect("wheels").expect("imbalance");
    let lines = LineLoop::from_scenario(&scenario).expect("a loop");
    let output = lines.output("line_of_sight0_x").expect("an output");
    let speeds = source.examined_speeds(&lines, &[output]).expect("speeds");
    let is_met = |hertz: f64| speeds.iter().any(|own| (own / TAU / hertz - 1.0).abs() < 1e-7);
    for hertz in [18.0, 45.0, 10.914_103_126_635, 25.116_550_748_368] {
        assert!(is_met(hertz), "{hertz} Hz: {speeds:?}");
    }
}

#[test]
fn responses_to_loads_on_the_wheel() {
    let scenario = scenario(&[]);
    let body = scenario.model.three_axis().expect("three axes");
    let none = Vector::zeros();
    let loads = [[Vector::x(), none], [Vector::z(), none], [none, Vector::x()], [none, Vector::z()]];
    for (hertz, expected) in RESPONSES {
        for (place, own) in loads.into_iter().enumerate() {
            let found = seen(&scenario, SPEED, hertz * TAU, &load(body, own).map(Complex::from));
            for about in [0, 1] {
                close(
                    found[about].norm(),
                    expected[about][place],
                    1e-9,
                    &format!("{hertz} Hz, {about} {place}"),
                );
            }
        }
    }
}

#[test]
fn lines_of_a_wheel_on_its_mount() {
    let scenario = scenario(&[]);
    let body = scenario.model.three_axis().expect("three axes");
    for (order, force, torque, expected, axes) in LINES {
        // The force turns from x towards -z, and the torque is 90 deg behind.
        let parts = [load(body, [Vector::x(), Vector::zeros()]), load(body, [-Vector::z(), Vector::zeros()])];
        let torques =
            [load(body, [Vector::zeros(), Vector::x()]), load(body, [Vector::zeros(), -Vector::z()])];
        let turning = |[cosine, sine]: &[DVector<f64>; 2], size: f64| {
            cosine.map(Complex::from) * Complex::from(size)
                + sine.map(Complex::from) * Complex::new(0.0, -size)
        };
        let square = SPEED * SPEED;
        let all =
            turning(&parts, force * square) + turning(&torques, torque * square) * Complex::new(0.0, -1.0);
        let found = seen(&scenario, SPEED, order * SPEED, &all);
        for about in [0, 1] {
            close(found[about].norm(), expected[about], 1e-9, &format!("order {order} about {about}"));
        }
        let turn = Complex::new(0.0, 1.0) * found[1];
        let [forward, backward] = [(found[0] + turn).norm() / 2.0, (found[0] - turn).norm() / 2.0];
        for (found, expected) in [forward + backward, (forward - backward).abs()].into_iter().zip(axes) {
            close(found, expected, 1e-8, &format!("ellipse of order {order}"));
        }
    }
}

/// The ellipse of a harmonic by three outputs of the command: about x, y, and between.
#[test]
fn outputs_between_the_axes_give_the_ellipse() {
    let scenario = scenario(&[]);
    let source = LineSource::of_wheels(&scenario).expect("wheels").expect("imbalance");
    let lines = LineLoop::from_scenario(&scenario).expect("a loop");
    let outputs =
        ["x", "y", "xy"].map(|axis| lines.output(&format!("line_of_sight0_{axis}")).expect("an output"));
    let found = WheelSpectrum::new(&source, &lines, &[SPEED], &outputs).expect("lines");
    let [x, y, between] = [0, 1, 2].map(|place| found.lines[0].outputs[place].direct.amplitude.powi(2));
    let mean = x.midpoint(y);
    let (half, shared) = ((x - y) / 2.0, between - mean);
    let axes = [mean + half.hypot(shared), mean - half.hypot(shared)].map(f64::sqrt);
    // The loop of the reference is soft.
    for (found, expected) in axes.into_iter().zip(LINES[0].4) {
        close(found, expected, 1e-3, "ellipse");
    }
}

/// Returns the amplitudes of the first wheel's lines about x and y, as the linear loop of the scenario has them.
fn wheel_lines(changes: &[(&str, &str)]) -> [f64; 2] {
    let scenario = scenario(changes);
    let source = LineSource::of_wheels(&scenario).expect("wheels").expect("imbalance");
    let lines = LineLoop::from_scenario(&scenario).expect("a loop");
    let outputs = ["line_of_sight0_x", "line_of_sight0_y"].map(|name| lines.output(name).expect("an output"));
    let found = WheelSpectrum::new(&source, &lines, &[SPEED], &outputs).expect("lines");
    [0, 1].map(|about| found.lines[0].outputs[about].direct.amplitude)
}

/// Name, replacements in the bench, and amplitudes about x and y (rad).
type Case<'a> = (&'a str, &'a [(&'a str, &'a str)], [f64; 2]);

/// The right model, and those that leave something out, by the same keys. Source: `tests/golden/optics.py`.
#[test]
fn wrong_models_give_other_lines() {
    let points = "points = [\"rotor\", \"hub\", \"hub\"]\n";
    let harmonic = "imbalance = { harmonics = [{ order = 2.0, torque = 1.5e-8 }] }";
    let imbalance = "imbalance = { static = [3.6e-6, 0, 0], dynamic = [1.2e-7, 0, 0], phase = \"-90 deg\" }";
    let at_rotor = "phase = \"-90 deg\", point = \"rotor\" }";
    let harmonic_at_rotor =
        "imbalance = { harmonics = [{ order = 2.0, torque = 1.5e-8 }], point = \"rotor\" }";
    let cases: [Case<'_>; 6] = [
        ("whirl", &[], [4.870_208_720_337_7e-10, 1.428_703_788_536_1e-08]),
        (
            "about -y",
            &[("\"3000 rpm\"", "\"-3000 rpm\"")],
            [4.037_777_207_251_1e-10, 1.457_892_278_872_2e-08],
        ),
        ("second harmonic", &[(imbalance, harmonic)], [5.600_521_967_924_0e-09, 1.905_750_781_314_9e-11]),
        (
            "second harmonic, momentum in the hub",
            &[(points, ""), (imbalance, harmonic_at_rotor)],
            [2.566_850_769_100_0e-10, 8.732_529_382_489_9e-13],
        ),
        // A mount without whirl: the first harmonic is 8 times too large about x, the second 20 times too small.
        (
            "momentum in the hub",
            &[(points, ""), ("phase = \"-90 deg\" }", at_rotor)],
            [3.913_153_863_441_8e-09, 1.422_931_075_182_5e-08],
        ),
        // Loads on the hub: the mount has no effect on them.
        ("bolted", &[(MOUNT, "")], [9.277_496_003_594_9e-09, 5.604_018_897_105_0e-08]),
    ];
    for (name, changes, expected) in cases {
        let found = wheel_lines(changes);
        for about in [0, 1] {
            close(found[about], expected[about], 1e-6, &format!("{name} about {about}"));
        }
    }
}

fn numbers(value: &Json) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|own| own.as_f64().expect("a number")).collect()
}

/// Both maxima about y and the one about x, without a start near to them: speed (Hz) and amplitude (rad).
#[test]
fn worst_speeds_are_found() {
    let dir = Dir::new();
    dir.write("bench.toml", bench(&[("bandwidth = 1.0", "bandwidth = 0.001")]));
    let found =
        dir.run("spectrum bench.toml --signal line_of_sight0_x,line_of_sight0_y --json").exits(0).json();
    let speeds = numbers(&found["wheels"]["speed_rad_s"]);
    for (about, hertz, amplitude) in [
        (0, 22.057_875_182_561, 9.364_150_195_328e-8),
        (1, 80.035_300_411_127, 7.549_015_674_549e-7),
        (1, 22.157_404_172_463, 7.159_720_924_519e-7),
    ] {
        let rms = numbers(&found["wheels"]["rms"][about]);
        let near = speeds.iter().zip(&rms).filter(|(speed, _)| (*speed / TAU / hertz - 1.0).abs() < 2e-6);
        let largest = near.map(|(_, rms)| rms * f64::sqrt(2.0)).fold(0.0, f64::max);
        // Aliases of the slow loop are in the rms.
        close(largest, amplitude, 1e-5, &format!("{hertz} Hz"));
    }
}

/// Returns the keys of a bench whose mount is uncertain.
fn uncertain() -> String {
    let ranges = "\n[uncertain]\n\"appendage[1].mount.rocking\" = { uniform = [\"26 Hz\", \"34 Hz\"] }\n\
                  \"appendage[1].mount.damping\" = { uniform = [0.03, 0.09] }\n";
    bench(&[]) + ranges
}

/// The worst of the mount: the lightest damping, where the translation at 22 Hz, and not the rocking, is the peak about x.
#[test]
fn the_worst_mount_is_the_least_damped() {
    let dir = Dir::new();
    dir.write("bench.toml", uncertain());
    let arguments = "worst bench.toml --signal line_of_sight0_x --points 30 --json";
    let found = dir.run(arguments).exits(0).json();
    let case = &found["cases"][0];
    let damping = case["keys"]["appendage[1].mount.damping"].as_f64().expect("a number");
    assert!((damping - 0.03).abs() < 1e-9, "{case}");
    let least = bench(&[("damping = 0.06", "damping = 0.03")]);
    dir.write("least.toml", least);
    let own = dir.run("spectrum least.toml --signal line_of_sight0_x --json").exits(0).json();
    let largest = numbers(&own["wheels"]["rms"][0]).into_iter().fold(0.0, f64::max);
    // The rocking frequency hardly changes it.
    close(case["worst"].as_f64().expect("a number"), largest, 1e-3, "rms");
    assert!(case["worst"].as_f64() > case["nominal"].as_f64().map(|nominal| 1.5 * nominal), "{case}");
}

/// Masses left by the modes of 18 kg: 18 - 3.1² - 0.2² along x, and so on; a mount leaves none.
#[test]
fn the_mass_that_no_mode_carries_is_printed() {
    let dir = Dir::new();
    dir.write("bench.toml", bench(&[]));
    let found = dir.run("modes bench.toml --json").exits(0).json();
    for (place, left) in [(0, [8.35, 9.58, 11.2]), (1, [0.0; 3])] {
        for (axis, left) in left.into_iter().enumerate() {
            let share = found["residual"][place]["share"][axis].as_f64().expect("a number");
            assert!((share - left / 18.0).abs() < 1e-12, "{}", found["residual"]);
        }
    }
    let words = "telescope: 46.4 % of 18 kg along x, 53.2 % along y and 62.2 % along z are in no mode";
    dir.run("modes bench.toml").exits(0).says(&[words]);
}

#[test]
fn modes_are_printed_at_a_speed() {
    let dir = Dir::new();
    dir.write("bench.toml", bench(&[]));
    let found = dir.run(&format!("modes bench.toml --speed {SPEED} --json")).exits(0).json();
    let poles = found["whirl"]["poles"].as_array().expect("poles");
    // The loop of the reference is soft.
    for [hertz, damping] in AT_50_HZ {
        let matches = |pole: &&Json| {
            let number = |key: &str| pole[key].as_f64().expect("a number");
            (number("frequency_rad_s") / TAU / hertz - 1.0).abs() < 1e-4
                && (number("damping") / damping - 1.0).abs() < 0.05
        };
        assert!(poles.iter().any(|pole| matches(&pole)), "{hertz}: {poles:?}");
    }
    let text = dir.run(&format!("modes bench.toml --speed {SPEED}")).exits(0);
    text.says(&["poles of the body with its wheels at 3000 rpm"]);
    dir.write("bolted.toml", bench(&[(MOUNT, "")]));
    dir.run("modes bolted.toml --speed 1").exits(2).says(&["--speed", "actuator.wheels.points"]);
}

/// A run at a steady speed vibrates by the second harmonic as its line does; without whirl it would be 22 times less. At 50.2 Hz the alias
/// is no constant.
#[test]
fn runs_whirl_as_linear_loops_do() {
    let speed = 3013.0 * TAU / 60.0;
    let quiet = [
        ("angle_random_walk = 1e-6", "angle_random_walk = 1e-13"),
        ("noise = [1e-5, 1e-5, 1e-5]", "noise = [1e-13, 1e-13, 1e-13]"),
        ("period = 0.01\noptics", "period = 0.0017\noptics"),
        ("\"3000 rpm\"", "\"3013 rpm\""),
        (
            "imbalance = { static = [3.6e-6, 0, 0], dynamic = [1.2e-7, 0, 0], phase = \"-90 deg\" }",
            "imbalance = { harmonics = [{ order = 2.0, torque = 1.5e-8 }] }",
        ),
    ];
    let dir = Dir::new();
    dir.write("bench.toml", bench(&quiet));
    let window = "--set duration=24 --set line_of_sight[0].window=[20,24] --log none --json";
    let run = dir.run(&format!("simulate bench.toml {window}")).exits(0).json();
    let rms = run["metrics"]["line_of_sight_rms_rad"][0].as_f64().expect("a number");
    let signals = "--signal line_of_sight0_x,line_of_sight0_y";
    let linear =
        dir.run(&format!("spectrum bench.toml {signals} --speeds {speed}:{speed}:1 --json")).exits(0).json();
    // The other wheels rest in the run.
    let lines = linear["wheels"]["lines"].as_array().expect("lines").iter();
    let outputs =
        lines.filter(|own| own["wheel"] == 1).flat_map(|own| own["outputs"].as_array().expect("outputs"));
    let squares = outputs.map(|own| 0.5 * own["direct"]["amplitude"].as_f64().expect("a number").powi(2));
    close(rms, squares.sum::<f64>().sqrt(), 5e-3, "rms");
}

#[test]
fn mounts_that_do_not_hold_are_refused() {
    let dir = Dir::new();
    let stiff = "mount = { stiffness = [[1e4, 0, 0, 0, 0, 0], [0, 1e4, 0, 0, 0, 0], [0, 0, 1e4, 0, 0, 0], [0, 0, 0, 30, 0, 0], [0, 0, 0, 0, 30, 0], [0, 0, 0, 0, 9, 30]] }\n";
    let flat = "mount = { stiffness = [[0, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]] }\n";
    let no_modes = format!("{MOUNT}modes = [{{ frequency = 1.0 }}]\n");
    for (from, to, why) in [
        ("rocking = \"30 Hz\", ", "", "`appendage[1].mount.rocking` must be given"),
        ("axis = [0, 1, 0] }", "axis = [0, 0, 0] }", "`appendage[1].mount.axis` must have a length"),
        (
            "[[9.0e-4, 0, 0], [0, 1.6e-3, 0], [0, 0, 9.0e-4]]",
            "[[0, 0, 0], [0, 1.6e-3, 0], [0, 0, 9.0e-4]]",
            "`appendage[1].inertia` must",
        ),
        (MOUNT, stiff, "`appendage[1].mount.stiffness` must be symmetric"),
        (MOUNT, flat, "`appendage[1].mount.stiffness` must be positive definite"),
        (MOUNT, no_modes.as_str(), "`appendage[1].modes` must be left out"),
        (
            "[\"rotor\", \"hub\", \"hub\"]",
            "[\"rotor\", \"hub\"]",
            "`actuator.wheels.points` must be one for all, or one for each of 3 wheels",
        ),
        (
            "[\"rotor\", \"hub\", \"hub\"]",
            "[\"rotor\", \"hub\", \"bus\"]",
            "`actuator.wheels.points[2]` must be one of the body's points",
        ),
        (
            "phase = \"-90 deg\" }",
            "point = \"rotor\" }",
            "`actuator.wheels.imbalance.point` must be left out",
        ),
    ] {
        dir.write("bench.toml", bench(&[(from, to)]));
        dir.run("check bench.toml").exits(2).says(&[why]);
    }
}

/// A stiffness at the root is that of the frequencies: k = m w² along, and I w² about each axis.
#[test]
fn a_stiffness_is_what_its_frequencies_are() {
    let square = |hertz: f64| (hertz * TAU) * (hertz * TAU);
    let (along, about) = (0.95 * square(22.0), 9e-4 * square(30.0));
    let rows: Vec<String> = (0..6)
        .map(|row| {
            let entry = |column: usize| {
                if row == column && row < 3 {
                    along
                } else if row == column {
                    about
                } else {
                    0.0
                }
            };
            format!("{:?}", [0, 1, 2, 3, 4, 5].map(entry))
        })
        .collect();
    let mount =
        format!("mount = {{ stiffness = [{}], damping = 0.06, axis = [0, 1, 0] }}\n", rows.join(", "));
    for (own, expected) in wheel_lines(&[(MOUNT, &mount)]).into_iter().zip(wheel_lines(&[])) {
        close(own, expected, 1e-9, "stiffness");
    }
}
