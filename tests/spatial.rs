//! The three-axis body: rigid motion and elastic modes.
//!
//! Golden numbers: tests/golden/station_oracle.py, SciPy and mpmath.

use flexsc_core::dynamics::flow::{ElasticModes, RigidBody, RigidState, ThreeAxisState};
use flexsc_core::dynamics::three_axis_model::ThreeAxisModel;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::Detail;
use flexsc_core::{Document, Scenario};

use crate::study::{close, scenario};
use crate::traces::{column, flown};
use crate::util::Dir;

/// A small free body with one mode: the law's dead zones are so wide that the jets stay silent.
pub const FREE: &str = r#"duration = 100.0
[body.spatial]
inertia = [[5.0, 0.4, -0.2], [0.4, 3.0, 0.1], [-0.2, 0.1, 2.0]]
rate = [0.3, -0.2, 0.5]
points = [{ name = "hub" }]
[[body.spatial.modes]]
frequency = 1.2566370614359172
damping = 0.005
shapes.hub = { translation = [1.0, 0.0, 0.0], rotation = [0.0, 0.5, 0.0] }
[sensor.gyro]
point = "hub"
[law.phase_plane]
period = 0.2
dead_zone = 10.0
rate_limit = 1.0
switch_on = 100.0
switch_off = 1.0
[actuator.jets]
specific_impulse = 200.0
thrusters = [
    { name = "x", point = "hub", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, 1.0], thrust = 1.0 },
    { name = "-x", point = "hub", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, -1.0], thrust = 1.0 },
    { name = "y", point = "hub", offset = [0.0, 0.0, 1.0], direction = [1.0, 0.0, 0.0], thrust = 1.0 },
    { name = "-y", point = "hub", offset = [0.0, 0.0, 1.0], direction = [-1.0, 0.0, 0.0], thrust = 1.0 },
    { name = "z", point = "hub", offset = [1.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], thrust = 1.0 },
    { name = "-z", point = "hub", offset = [1.0, 0.0, 0.0], direction = [0.0, -1.0, 0.0], thrust = 1.0 },
]
[actuator.jets.groups]
roll = { plus = ["x"], minus = ["-x"] }
pitch = { plus = ["y"], minus = ["-y"] }
yaw = { plus = ["z"], minus = ["-z"] }
"#;

/// Returns the small free body with some keys set.
pub fn free(set: &[(&str, &str)]) -> Scenario {
    let mut document = Document::parse("free.toml", FREE.to_owned()).expect("TOML");
    for (key, value) in set {
        document.set_text(key, value).expect("a key");
    }
    Scenario::from_document(&document).expect("valid")
}

/// A body that hardly anything turns is as far from its target as the target's angle says, up to half a turn.
#[test]
fn pointing_errors_are_rotation_vectors() {
    let degrees = |angle: f64| angle.to_radians();
    for (target, angle, [roll, pitch, yaw]) in [
        ("yaw = \"150 deg\"", degrees(150.0), [0.0, 0.0, -degrees(150.0)]),
        ("yaw = \"180 deg\"", degrees(180.0), [0.0, 0.0, degrees(180.0)]),
        ("pitch = \"1e-5 deg\"", degrees(1e-5), [0.0, -degrees(1e-5), 0.0]),
        // A quarter turn about z and then about the turned x: a third of a turn about (1, 1, 1).
        ("roll = \"90 deg\"\nyaw = \"90 deg\"", degrees(120.0), [-degrees(120.0) / f64::sqrt(3.0); 3]),
    ] {
        // The form of the error is that of the law alone.
        let form = if angle > 3.1 { "quaternion" } else { "rodrigues" };
        let text = format!(
            "duration = 10.0\n[spacecraft]\nmass = 50.0\ninertia = [[5, 0, 0], [0, 6, 0], [0, 0, 7]]\n\
             [sensor.gyro]\nperiod = 0.5\n[law.pd]\nk_p = 1e-15\nk_d = 1e-15\nperiod = 0.5\nerror = \"{form}\"\n[log]\n\
             period = 1.0\n[[target]]\nfrom = 0.0\n{target}\n"
        );
        let (metrics, trace) = flown(&Scenario::parse("far.toml", &text).expect("valid"), 0, Detail::Full);
        let near = |name: &str, exact: f64| {
            let found = metrics.number(name).expect(name);
            assert!((found - exact).abs() < 1e-9 * exact.min(1.0), "{target}: {name} {found} {exact}");
        };
        near("pointing_error_end_rad", angle);
        near("goal_band_rad", 0.05 * angle);
        for (name, exact) in [("roll_error_rad", roll), ("pitch_error_rad", pitch), ("yaw_error_rad", yaw)] {
            for found in column(&trace, "/pointing", name) {
                // Either way around is half a turn.
                let found = if angle > 3.1 { found.abs() } else { *found };
                assert!((found - exact).abs() < 1e-9 * angle, "{target}: {name} {found} {exact}");
            }
        }
    }
}

/// Returns the body of a scenario.
pub fn body(scenario: &Scenario) -> &ThreeAxisModel {
    scenario.model.three_axis().expect("three axes")
}

/// Callback that never stops these motions.
#[expect(clippy::unnecessary_wraps, reason = "the motion wants a result")]
fn go_on() -> Result<(), std::convert::Infallible> {
    Ok(())
}

#[test]
fn a_tumbling_body_is_where_thirty_digits_put_it() {
    #[rustfmt::skip]
    let exact = [
        ([0.0, 0.0, 0.0], [-0.507_767_528_548_667, -0.730_551_828_790_898_9, -0.319_830_593_538_844_9, 0.325_844_370_579_640_4],
         [-0.052_423_834_693_582_82, 0.563_702_583_902_254_3, -0.054_077_652_513_899_01]),
        ([0.02, -0.01, 0.03], [0.675_847_417_291_500_4, -0.291_732_333_088_535_73, 0.162_797_066_718_684_26, -0.656_977_647_594_589_3],
         [0.248_287_393_218_305_87, 0.179_815_096_323_343_9, 1.085_638_361_491_806]),
    ];
    let scenario = free(&[]);
    let rigid = RigidBody::new(body(&scenario));
    for (torque, [w, x, y, z], rate) in exact {
        let mut turn = ThreeAxisState::start(body(&scenario), &rigid).turn;
        for k in 0..400 {
            rigid
                .advance(&mut turn, &Vector::from(torque), None, None, (0.1 * f64::from(k), 0.1), go_on)
                .expect("done");
        }
        let q = turn.attitude;
        for (found, exact) in [q.w, q.i, q.j, q.k].into_iter().zip([w, x, y, z]) {
            assert!((found - exact).abs() < 2e-13, "{found} {exact}");
        }
        for (found, exact) in rigid.rate(&turn).iter().zip(rate) {
            assert!((found - exact).abs() < 2e-13, "{found} {exact}");
        }
    }
}

/// Without a torque momentum and energy last, and so does the direction of the momentum in space.
#[test]
fn momentum_and_energy_last() {
    let station = scenario("iss-manoeuvre-off", &[("body.spatial.rate", "[7e-4, -5e-4, 6e-4]")]);
    let tumbling = free(&[]);
    // (body, time, step, relative error of momentum and energy, of the momentum's direction).
    for (of, time, step, bound, direction) in [
        (&station, 1e4, 0.2, 1e-14, 1e-14),
        (&tumbling, 1e4, 0.2, 2e-14, 1e-13),
        (&station, 1e6, 0.2, 1e-14, 1e-14),
    ] {
        let rigid = RigidBody::new(body(of));
        let mut turn = ThreeAxisState::start(body(of), &rigid).turn;
        let inertial = |turn: &RigidState| {
            let (v, momentum) = (turn.attitude.vector().into_owned(), RigidBody::momentum(turn));
            let across = v.cross(&momentum);
            momentum + (across * turn.attitude.w + v.cross(&across)) * 2.0
        };
        let (momentum, energy, fixed) =
            (RigidBody::momentum(&turn).norm(), rigid.energy(&turn), inertial(&turn));
        let (mut worst, mut longest) = (0.0_f64, 0.0_f64);
        for k in 0..(time / step) as u64 {
            rigid
                .advance(&mut turn, &Vector::zeros(), None, None, (step * k as f64, step), go_on)
                .expect("done");
            worst = worst.max((RigidBody::momentum(&turn).norm() / momentum - 1.0).abs());
            worst = worst.max((rigid.energy(&turn) / energy - 1.0).abs());
            longest = longest.max((turn.attitude.norm() - 1.0).abs());
        }
        let turned = (inertial(&turn) - fixed).norm() / momentum;
        assert!(worst < bound, "{time} s: {worst:e}");
        assert!(longest <= 1e-15, "{longest:e}");
        assert!(turned < direction, "{time} s: {turned:e}");
    }
}

#[test]
fn modes_follow_the_matrix_exponential() {
    // (frequency in Hz, damping ratio, seconds, Phi of (q', w q) row by row).
    #[rustfmt::skip]
    let exact = [
        (0.2, 0.005, 0.2, [0.966_125_660_194_103, -0.248_377_636_158_584, 0.248_377_636_158_584, 0.968_609_436_555_689]),
        (1.1, 0.0, 0.37, [-0.834_078_433_613_169, -0.551_645_870_628_429, 0.551_645_870_628_429, -0.834_078_433_613_169]),
        (0.05, 0.9, 3.1, [0.025_317_774_961_25, -0.393_303_064_339_043, 0.393_303_064_339_043, 0.733_263_290_771_527]),
        (0.05, 1.7, 3.1, [-0.030_189_525_212_371, -0.246_753_845_344_867, 0.246_753_845_344_867, 0.808_773_548_960_176]),
    ];
    for (hertz, damping, t, phi) in exact {
        let w = std::f64::consts::TAU * hertz;
        let keys = [("frequency", w.to_string()), ("damping", format!("{damping:?}"))];
        // A unit of q', then a unit of w q.
        for (start, column) in [([1.0, 0.0], [phi[0], phi[2]]), ([0.0, 1.0], [phi[1], phi[3]])] {
            let start = [("rate", start[0].to_string()), ("displacement", (start[1] / w).to_string())];
            let keys: Vec<_> =
                keys.iter().chain(&start).map(|(k, v)| (format!("body.spatial.modes[0].{k}"), v)).collect();
            let keys: Vec<_> = keys.iter().map(|(k, v)| (k.as_str(), v.as_str())).collect();
            assert_moves(&free(&keys), w, &[(0.0, t)], column);
        }
    }
    // Pulses of 0.2 s and of 0.05 s at the start of a cycle of 0.2 s, then three accelerations one after the other.
    let w = std::f64::consts::TAU * 0.2;
    assert_moves(&free(&[]), w, &[(1.0, 0.2)], [0.197_652_642_740_595, 0.024_979_816_693_009]);
    assert_moves(&free(&[]), w, &[(1.0, 0.05), (0.0, 0.15)], [0.048_679_778_117_469, 0.010_893_305_635_643]);
    let moving = [
        ("body.spatial.modes[0].rate", "0.3"),
        ("body.spatial.modes[0].displacement", "-0.15915494309189535"),
    ];
    let pieces = [(0.7, 0.13), (-1.1, 0.05), (0.0, 0.62)];
    assert_moves(&free(&moving), w, &pieces, [0.343_354_755_413_247, 0.177_055_131_174_376]);
}

/// Checks the state (q', w q) of a body's mode after these accelerations for these times (m sqrt(kg)/s², s).
#[track_caller]
fn assert_moves(scenario: &Scenario, w: f64, pieces: &[(f64, f64)], exact: [f64; 2]) {
    // One of the pieces may be the cycle, whose transition is known beforehand.
    let mut elastic = ElasticModes::new(body(scenario), 0.2);
    let mut phases = ElasticModes::start(body(scenario));
    for (push, t) in pieces {
        elastic.advance(&mut phases, &[*push], *t);
    }
    let rate = elastic.rates(&phases).next().expect("a mode");
    let found = [rate, w * phases[0].displacement];
    for (found, exact) in found.into_iter().zip(exact) {
        assert!((found - exact).abs() < 1e-14, "{pieces:?}: {found} {exact}");
    }
    close(elastic.energies(&phases).sum(), 0.5 * (found[0] * found[0] + found[1] * found[1]), 1e-14);
}

/// The free body with its modes in a file, and that file.
fn in_a_file(csv: &str) -> Dir {
    let (head, rest) = FREE.split_once("[[body.spatial.modes]]").expect("modes");
    let (_, tail) = rest.split_once("[sensor.gyro]").expect("a gyro");
    let dir = Dir::holding("modes.csv", csv);
    dir.write("free.toml", format!("{head}modes = \"modes.csv\"\n[sensor.gyro]{tail}"));
    dir
}

const IN_A_FILE: &str =
    "# shapes of the hub\nfrequency, damping, hub.tx, hub.ry\n1.2566370614359172, 0.005, 1.0, 0.5\n";

#[test]
fn modes_in_a_file_are_those_of_the_table_and_stay_in_the_log() {
    let dir = in_a_file(IN_A_FILE);
    let read = Scenario::load(&dir.path("free.toml")).expect("valid");
    let free = free(&[]);
    assert_eq!(body(&read).modes[..], body(&free).modes[..]);
    assert_eq!(read.self_contained().to_toml(), free.to_toml());
    dir.run("simulate free.toml --log full").exits(0);
    let document = Document::load(&dir.path("free.toml")).expect("there");
    std::fs::remove_file(dir.path("modes.csv")).expect("there");
    let again = Scenario::from_document_reusing(&document, &read).expect("the modes are taken over");
    assert_eq!(again, read);
    std::fs::rename(dir.path("free.mcap"), dir.path("first.mcap")).expect("there");
    let kept = dir.run("log scenario first.mcap").exits(0).prints(&["hub"]);
    dir.write("free.toml", kept);
    dir.run("simulate free.toml --log full").exits(0);
    assert!(dir.read("free.mcap") == dir.read("first.mcap"), "the log repeats without the file");
}

#[test]
fn columns_of_a_file_of_modes_may_stand_in_any_order() {
    let csv = "hub.rz,rate,hub.tz,frequency,displacement\n3,4,5,6,7\n";
    let read = Scenario::load(&in_a_file(csv).path("free.toml")).expect("valid");
    let mode = &body(&read).modes[0];
    let (translation, rotation) = body(&read).shapes("hub")[0];
    assert_eq!(translation, Vector::new(0.0, 0.0, 5.0));
    assert_eq!(rotation, Vector::new(0.0, 0.0, 3.0));
    let numbers = (mode.frequency.get(), mode.damping.get(), mode.displacement.get(), mode.rate.get());
    assert_eq!(numbers, (6.0, 0.0, 7.0, 4.0));
}

#[test]
fn keys_of_modes_in_a_file_may_be_uncertain_and_swept() {
    let uncertain = "[uncertain]\n\"body.spatial.modes[0].frequency\" = { relative_uniform = 0.2 }\n\
                     \"body.spatial.modes[0].shapes.hub.rotation[1]\" = { uniform = [0.1, 0.2] }\n";
    let dir = in_a_file(IN_A_FILE);
    dir.write("free.toml", format!("{}{uncertain}", dir.text("free.toml")));
    dir.write("table.toml", format!("{FREE}{uncertain}"));
    for name in ["free", "table"] {
        dir.run(&format!("simulate {name}.toml --runs 3 --table csv -o {name}")).exits(0);
        let vary = "body.spatial.modes[0].frequency=1:2:3";
        dir.run(&format!("sweep {name}.toml --vary {vary} --table csv -o {name}-sweep")).exits(0);
    }
    assert_eq!(dir.text("free/runs.csv"), dir.text("table/runs.csv"));
    let drawn = crate::util::table(&dir, "free/runs.csv");
    assert_ne!(drawn[0]["body.spatial.modes[0].frequency"], drawn[1]["body.spatial.modes[0].frequency"]);
    assert_eq!(dir.names("free-sweep"), dir.names("table-sweep"));
    dir.run("check free.toml").exits(0);
    dir.write("free.toml", dir.text("free.toml").replace("modes[0].f", "modes[1].f"));
    dir.run("check free.toml").exits(2).says(&["modes[1].frequency\"` names no key of this scenario"]);
}
