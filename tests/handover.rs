//! Hand-over: a run in the formats of other programs, from its log alone.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::util::Dir;

/// A rigid body that rotates freely: its attitude and its orbit are known in closed form.
pub const FREE: &str = r"duration = 60.0
epoch = 2026-03-20T14:46:00Z
log.period = 0.5

[body.spatial]
inertia = [[10.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 30.0]]
rate = [0.0, 0.0, 0.02]
modes = []

[environment]
orbit = { semi_major_axis = 7.0e6, inclination = 0.9, node = 0.4 }

[law.open]
";

/// Returns the keywords and the rows of a message.
fn message(text: &str) -> (BTreeMap<&str, &str>, Vec<Vec<&str>>) {
    let keys = text.lines().filter_map(|line| line.split_once(" = ")).collect();
    let rows = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    (keys, rows.map(|line| line.split(' ').collect()).collect())
}

fn numbers(row: &[&str]) -> Vec<f64> {
    row[1..].iter().map(|cell| cell.parse().expect("a number")).collect()
}

/// Checks that numbers agree within a tolerance.
fn near(found: &[f64], exact: &[f64], within: f64) {
    assert_eq!(found.len(), exact.len());
    for (found_at, exact_at) in found.iter().zip(exact) {
        assert!((found_at - exact_at).abs() <= within, "{found:?} {exact:?}");
    }
}

/// Returns the matrix from the mean axes of 2026-03-20T14:46:00Z to those of a frame: `tests/golden/precession.csv`.
fn from_date(frame: &str) -> Matrix3<f64> {
    let golden = include_str!("golden/precession.csv");
    let row = golden.lines().find(|row| row.starts_with(&format!("1774017960,{frame},"))).expect("a date");
    let cells = row.split(',').skip(2).map(|cell| cell.parse().expect("a number"));
    Matrix3::from_row_iterator(cells).transpose()
}

#[test]
fn an_attitude_message_has_the_free_rotation() {
    let dir = Dir::holding("free.toml", FREE);
    dir.run("simulate free.toml --log full").exits(0);
    dir.run("export free.mcap -o free.aem").exits(0).prints(&[]);
    let text = dir.text("free.aem");
    let (keys, rows) = message(&text);
    for (key, value) in [
        ("CCSDS_AEM_VERS", "2.0"),
        ("CREATION_DATE", "2026-03-20T14:46:00.000000000"),
        ("OBJECT_NAME", "free"),
        ("OBJECT_ID", "UNKNOWN"),
        ("REF_FRAME_A", "EME2000"),
        ("REF_FRAME_B", "SC_BODY_1"),
        ("TIME_SYSTEM", "UTC"),
        ("START_TIME", "2026-03-20T14:46:00.000000000"),
        ("STOP_TIME", "2026-03-20T14:47:00.000000000"),
        ("ATTITUDE_TYPE", "QUATERNION/ANGVEL"),
        ("ANGVEL_FRAME", "REF_FRAME_B"),
        ("INTERPOLATION_METHOD", "LINEAR"),
        ("INTERPOLATION_DEGREE", "1"),
    ] {
        assert_eq!(keys.get(key), Some(&value), "{key}");
    }
    assert_eq!(rows.len(), 121);
    let turn = UnitQuaternion::from_matrix(&from_date("EME2000"));
    for (index, row) in rows.iter().enumerate() {
        let half = 0.5 * 0.02 * 0.5 * index as f64;
        let q = turn.quaternion() * Quaternion::new(half.cos(), 0.0, 0.0, half.sin());
        // 0.02 rad/s in degrees per second.
        let exact = [q.i, q.j, q.k, q.w, 0.0, 0.0, 1.145_915_590_261_646_5];
        near(&numbers(row), &exact, 1e-10);
    }
    assert_eq!(rows[119][0], "2026-03-20T14:46:59.500000000");
    assert!(!text.contains("-0.0000000000000000 "), "no zero has a sign");
}

#[test]
fn an_orbit_message_has_the_circular_orbit() {
    let dir = Dir::holding("free.toml", FREE);
    dir.run("simulate free.toml --log full").exits(0);
    dir.run("export free.mcap -o free.oem --object-id 2026-012A").exits(0);
    let text = dir.text("free.oem");
    let (keys, rows) = message(&text);
    for (key, value) in [
        ("CCSDS_OEM_VERS", "2.0"),
        ("OBJECT_ID", "2026-012A"),
        ("CENTER_NAME", "EARTH"),
        ("REF_FRAME", "EME2000"),
        ("TIME_SYSTEM", "UTC"),
        ("INTERPOLATION", "LAGRANGE"),
        ("INTERPOLATION_DEGREE", "7"),
    ] {
        assert_eq!(keys.get(key), Some(&value), "{key}");
    }
    assert_eq!(rows.len(), 121);
    let (a, gravity) = (7.0e3_f64, 3.986_004_418e5_f64);
    let rate = (gravity / (a * a * a)).sqrt();
    for (index, row) in rows.iter().enumerate() {
        let (sin, cos) = (rate * 0.5 * index as f64).sin_cos();
        let ((tilt, flat), (node, x)) = (0.9_f64.sin_cos(), 0.4_f64.sin_cos());
        let at = |c: f64, s: f64| [c * x - s * flat * node, c * node + s * flat * x, s * tilt];
        let turn = from_date("EME2000");
        let position = turn * Vector3::from(at(a * cos, a * sin));
        let velocity = turn * Vector3::from(at(-a * rate * sin, a * rate * cos));
        let row = numbers(row);
        near(&row[..3], position.as_slice(), 1e-6);
        near(&row[3..], velocity.as_slice(), 1e-9);
    }
}

/// Every frame that a run can be rotated into is named with the rows rotated into it, and no other is.
#[test]
fn the_frame_of_a_message_is_that_of_its_rows() {
    let tle = "orbit = { tle = [\"1 28057U 03049A   06177.78615833  .00000060  00000-0  35940-4 0  1836\", \
               \"2 28057  98.4283 247.6961 0000884  88.1964 271.9322 14.35478080140550\"] }";
    let orbit = FREE.lines().find(|line| line.starts_with("orbit")).expect("an orbit");
    let undated = FREE.replace("epoch = 2026-03-20T14:46:00Z\n", "");
    let elements = undated.replace(orbit, tle);
    let dir = Dir::new();
    for (name, text) in [("free", FREE), ("undated", &undated), ("elements", &elements)] {
        dir.write(&format!("{name}.toml"), text);
        dir.run(&format!("simulate {name}.toml --log full --set duration=10")).exits(0);
    }
    let export = |name: &str, options: &str| {
        let epoch = if name == "undated" { "--epoch 2026-03-20T14:46:00Z" } else { "" };
        let message_of = |format: &str| {
            dir.run(&format!("export {name}.mcap --format {format} {epoch} {options}")).printed()
        };
        let (orbit, attitude) = (message_of("oem"), message_of("aem"));
        let ((orbit, positions), (attitude, quaternions)) = (message(&orbit), message(&attitude));
        let names = format!("{} {}", orbit["REF_FRAME"], attitude["REF_FRAME_A"]);
        (names, Vector3::from_row_slice(&numbers(&positions[3])[..3]), numbers(&quaternions[3])[..4].to_vec())
    };
    let logged = |name: &str| {
        let log = dir.run(&format!("export {name}.mcap --topic /orbit --format jsonl")).printed();
        let row: serde_json::Value = serde_json::from_str(log.lines().nth(3).expect("a row")).expect("JSON");
        Vector3::from_fn(|axis, _| 1e-3 * row[format!("axes[{axis}].position_m")].as_f64().expect("a number"))
    };
    let own = logged("free");
    for (options, names, turn) in [
        ("", "EME2000 EME2000", from_date("EME2000")),
        ("--frame EME2000", "EME2000 EME2000", from_date("EME2000")),
        ("--frame GCRF", "GCRF GCRF", from_date("GCRF")),
        ("--frame ICRF", "ICRF ICRF", from_date("GCRF")),
    ] {
        let (found, position, q) = export("free", options);
        assert_eq!(found, names);
        near(position.as_slice(), (turn * own).as_slice(), 1e-6);
        let half = 0.5 * 0.02 * 1.5_f64;
        let exact = UnitQuaternion::from_matrix(&turn).quaternion()
            * Quaternion::new(half.cos(), 0.0, 0.0, half.sin());
        near(&q, &[exact.i, exact.j, exact.k, exact.w], 1e-10);
    }
    for (name, options, names) in [
        ("elements", "", "TEME TEMEOFDATE"),
        ("elements", "--frame TEME", "TEME TEMEOFDATE"),
        ("undated", "", "EME2000 EME2000"),
        ("undated", "--frame TOD", "TOD TOD_EARTH"),
    ] {
        let (found, position, _) = export(name, options);
        assert_eq!(found, names);
        near(position.as_slice(), logged(name).as_slice(), 1e-8);
    }
    for (name, frame, says) in
        [("free", "TOD", "EME2000"), ("free", "TEME", "EME2000"), ("elements", "EME2000", "TEME")]
    {
        for format in ["oem", "aem"] {
            dir.run(&format!("export {name}.mcap --format {format} --frame {frame}")).exits(2).says(&[
                "--frame",
                "nutation",
                &format!("leave out --frame, for {says}"),
            ]);
        }
    }
}

/// The rotation is that from A to B: it brings the direction to the planet, of one message, into the body's axes, in
/// which the log has it.
#[test]
fn attitude_and_orbit_agree_with_the_nadir_of_the_log() {
    let dir = Dir::with(&["detumble-and-point"]);
    let set = "--set duration=300 --set log.period=2";
    dir.run(&format!("simulate detumble-and-point.toml {set} --log full")).exits(0);
    dir.run("export detumble-and-point.mcap -o a.aem").exits(0);
    dir.run("export detumble-and-point.mcap -o o.oem").exits(0);
    let (attitude, orbit) = (dir.text("a.aem"), dir.text("o.oem"));
    let (attitude, orbit) = (message(&attitude).1, message(&orbit).1);
    let log = dir.run("export detumble-and-point.mcap --topic /orbit --format jsonl").printed();
    let log: Vec<serde_json::Value> =
        log.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((attitude.len(), orbit.len()), (151, 151));
    for ((attitude, orbit), log) in attitude.iter().zip(&orbit).zip(&log) {
        assert_eq!(attitude[0], orbit[0]);
        let (q, r) = (numbers(attitude), numbers(orbit));
        let far = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt();
        let down = [-r[0] / far, -r[1] / far, -r[2] / far];
        let (q1, q2, q3, qc) = (q[0], q[1], q[2], q[3]);
        // The matrix from A to B of a quaternion with the scalar last, as CCSDS 504.0-B-2 and Wertz define it.
        let matrix = [
            [q1 * q1 - q2 * q2 - q3 * q3 + qc * qc, 2.0 * (q1 * q2 + q3 * qc), 2.0 * (q1 * q3 - q2 * qc)],
            [2.0 * (q1 * q2 - q3 * qc), -q1 * q1 + q2 * q2 - q3 * q3 + qc * qc, 2.0 * (q2 * q3 + q1 * qc)],
            [2.0 * (q1 * q3 + q2 * qc), 2.0 * (q2 * q3 - q1 * qc), -q1 * q1 - q2 * q2 + q3 * q3 + qc * qc],
        ];
        for (axis, row) in matrix.iter().enumerate() {
            let nadir: f64 = row.iter().zip(down).map(|(a, b)| a * b).sum();
            let logged = log[format!("axes[{axis}].nadir")].as_f64().expect("a number");
            assert!((nadir - logged).abs() < 1e-12, "{nadir} {logged}");
        }
    }
}

/// The rate is that of the frame whose attitude is given: the integral of one is the other. The gyro is on an appendage's
/// side of the body in neither, so that it would be another rate.
#[test]
fn rates_are_those_of_the_attitude() {
    let dir = Dir::with(&["iss-manoeuvre", "earth-observer"]);
    for (name, set, most) in [
        // Modes that do not act back: the attitude is that of the mean axes.
        ("iss-manoeuvre", "--set duration=40 --set log.period=0.05", 5e-9),
        // The attitude of the hub, which vibrates.
        ("earth-observer", "--set duration=5 --set log.period=0.002", 2e-8),
    ] {
        dir.run(&format!("simulate {name}.toml {set} --log full")).exits(0);
        let text =
            dir.run(&format!("export {name}.mcap --format aem --epoch 2026-01-01T00:00:00Z")).printed();
        let rows: Vec<Vec<f64>> = message(&text).1.iter().map(|row| numbers(row)).collect();
        let step: f64 = set.rsplit('=').next().expect("a period").parse().expect("a number");
        let (mut sum, mut count) = (0.0, 0.0);
        for pair in rows.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            // The vector part of conj(a) b is half the rotation between the rows.
            let turned = |i: usize, j: usize, k: usize| {
                2.0 * (a[3] * b[i] - b[3] * a[i] - (a[j] * b[k] - a[k] * b[j])) / step
            };
            let turned = [turned(0, 1, 2), turned(1, 2, 0), turned(2, 0, 1)];
            for (axis, turned) in turned.into_iter().enumerate() {
                let mean = 0.5 * (a[4 + axis] + b[4 + axis]).to_radians();
                sum += (turned - mean) * (turned - mean);
                count += 1.0;
            }
        }
        let rms = f64::sqrt(sum / count);
        assert!(rms < most, "{name}: {rms}");
    }
}

#[test]
fn a_one_axis_run_rotates_about_z() {
    let dir = Dir::holding(
        "planar.toml",
        "duration = 10.0\nlog.period = 1.0\nbody.planar = { angle = 0.3, rate = 0.02 }\nlaw.open = {}\n",
    );
    dir.run("simulate planar.toml --log full").exits(0);
    let missing = dir.run("export planar.mcap -o planar.aem").exits(2);
    missing.says(&["planar.mcap: the scenario has no `epoch`", "--epoch 2026-03-20T14:46:00Z"]);
    assert!(!dir.has("planar.aem"));
    dir.run("export planar.mcap -o planar.aem --epoch 2024-02-29T23:59:55Z --frame ICRF").exits(0);
    let text = dir.text("planar.aem");
    let (keys, rows) = message(&text);
    assert_eq!((keys["REF_FRAME_A"], rows[5][0]), ("ICRF", "2024-03-01T00:00:00.000000000"));
    for (index, row) in rows.iter().enumerate() {
        let half = 0.5 * (0.3 + 0.02 * index as f64);
        near(&numbers(row), &[0.0, 0.0, half.sin(), half.cos(), 0.0, 0.0, 1.145_915_590_261_646_5], 1e-14);
    }
    dir.run("export planar.mcap -o planar.oem --epoch 2024-02-29T23:59:55Z")
        .exits(2)
        .says(&["planar.mcap: the run has no orbit", "environment.orbit"]);
}

#[test]
fn refusals_name_what_is_missing() {
    let dir = Dir::holding("free.toml", FREE);
    dir.run("simulate free.toml --log events").exits(0);
    dir.run("export free.mcap -o free.aem").exits(2).says(&["no motion", "--log full"]);
    dir.run("simulate free.toml --log full").exits(0);
    for (arguments, said) in [
        ("-o free.aem --topic /pointing", "--topic"),
        ("-o free.aem --epoch 2026-03-20T14:46:01Z", "another `epoch`"),
        ("-o free.aem --epoch yesterday", "--epoch: must be a date and time from 1970 to 2500"),
        ("-o free.aem --frame ITRF", "--frame: must be one of EME2000, GCRF, ICRF, TEME, TOD, got `ITRF`"),
        ("-o free.oem --format aem", "the ending of another format"),
        ("-o free.txt --format aem", "must end in .csv, .jsonl, .aem"),
        ("-o free.csv", "--topic"),
        ("--topic /pointing --center MARS", "--center: is for whole runs"),
        ("-o free.csv --topic /pointing --epoch 2026-03-20T14:46:00Z", "--epoch: is for whole runs"),
    ] {
        dir.run(&format!("export free.mcap {arguments}")).exits(2).says(&[said]);
    }
    assert!(!dir.has("free.aem") && !dir.has("free.oem") && !dir.has("free.csv"));
    // The orbit of another planet has no name.
    dir.write("mars.toml", FREE.replace("orbit = {", "orbit = { gravity = 4.2828e13,"));
    dir.run("simulate mars.toml --log full").exits(0);
    dir.run("export mars.mcap -o mars.oem").exits(2).says(&["4.2828e13 m³/s²", "--center MARS"]);
    dir.run("export mars.mcap -o mars.oem --center Mars").exits(0);
    assert!(dir.text("mars.oem").contains("\nCENTER_NAME = MARS\n"));
}

#[test]
fn a_file_of_other_content_is_kept() {
    let dir = Dir::holding("free.toml", FREE);
    dir.run("simulate free.toml --log full").exits(0);
    for name in ["free.aem", "free.oem", "free.glb", "free.bin"] {
        dir.run(&format!("export free.mcap -o {name}")).exits(0);
        let first = dir.read(name);
        dir.run(&format!("export free.mcap -o {name}")).exits(0);
        assert!(first == dir.read(name), "{name} has other bytes");
        dir.write(name, "mine");
        dir.run(&format!("export free.mcap -o {name}")).exits(2).says(&["already exists", "--force"]);
        assert_eq!(dir.text(name), "mine");
        dir.run(&format!("export free.mcap -o {name} --force")).exits(0);
        assert!(first == dir.read(name));
    }
}

/// A reader interpolates with no more states than there are.
#[test]
fn runs_with_few_rows_are_exported() {
    let dir = Dir::holding("free.toml", FREE);
    // A log period beyond the end leaves the rows of the start and of the end.
    dir.run("simulate free.toml --set log.period=1000 --log full").exits(0);
    for name in ["free.aem", "free.oem", "free.glb", "free.bin"] {
        dir.run(&format!("export free.mcap -o {name}")).exits(0);
    }
    let text = dir.text("free.oem");
    let (keys, rows) = message(&text);
    let degree: usize =
        keys.get("INTERPOLATION_DEGREE").map_or(0, |degree| degree.parse().expect("a number"));
    assert!(degree < rows.len(), "{degree} {}", rows.len());
}
