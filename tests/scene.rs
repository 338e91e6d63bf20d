//! The scene in a log: frames that follow the engine's numbers, plumes that follow its torques, and nothing else
//! changed.

use flexsc_core::record::{Column, Columns, Log};

use crate::study::pairs;
use crate::util::{Dir, SCENARIOS};

fn log(dir: &Dir, scenario: &str, options: &str) -> Log {
    dir.run(&format!("simulate {scenario}.toml --log scene --force {options}")).exits(0);
    Log::open(&dir.path(&format!("{scenario}.mcap"))).expect("a log")
}

/// The frames of each message: child, and then rotation (x, y, z, w) and translation of each by name.
struct Frames {
    times: Vec<f64>,
    names: Vec<String>,
    rotations: Vec<[f64; 4]>,
    translations: Vec<[f64; 3]>,
}

impl Frames {
    fn from_log(log: &Log) -> Self {
        let columns = log.columns("/tf").expect("frames");
        let times = columns.numbers("time_s").expect("times").to_vec();
        let Some(Column::Rows(counts, inner)) = columns.get("transforms") else { panic!("{columns:?}") };
        assert!(counts.iter().all(|count| *count == counts[0]));
        let number = |name: &str| inner.numbers(name).expect("a part").to_vec();
        let stamps = number("timestamp");
        for (index, time) in times.iter().enumerate() {
            assert!(
                (stamps[index * counts[0] as usize] - time).abs() < 1e-9,
                "stamps are on the log's time base"
            );
        }
        let parts = |of: &str, names: &[&str]| -> Vec<Vec<f64>> {
            let columns: Vec<_> = names.iter().map(|name| number(&format!("{of}.{name}"))).collect();
            (0..columns[0].len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
        };
        let names = match inner.get("child_frame_id") {
            Some(Column::Texts(texts)) => texts[..counts[0] as usize].to_vec(),
            other => panic!("{other:?}"),
        };
        let array4 = |part: Vec<f64>| [part[0], part[1], part[2], part[3]];
        let array3 = |part: Vec<f64>| [part[0], part[1], part[2]];
        Self {
            times,
            rotations: parts("rotation", &["x", "y", "z", "w"]).into_iter().map(array4).collect(),
            translations: parts("translation", &["x", "y", "z"]).into_iter().map(array3).collect(),
            names,
        }
    }

    fn at(&self, message: usize, frame: &str) -> usize {
        let index = self.names.iter().position(|name| name == frame).expect("a frame");
        message * self.names.len() + index
    }

    /// The angle about z of a frame in its parent.
    fn angle(&self, message: usize, frame: &str) -> f64 {
        let [x, y, z, w] = self.rotations[self.at(message, frame)];
        assert!(x == 0.0 && y == 0.0, "{frame} turns about z alone");
        2.0 * z.atan2(w)
    }
}

fn rows<'a>(columns: &'a Columns, name: &str) -> (&'a [u32], &'a Columns) {
    match columns.get(name) {
        Some(Column::Rows(counts, inner)) => (counts, inner),
        other => panic!("{name}: {other:?}"),
    }
}

/// Panels that have sections are drawn with the sections' own angles, times the bending that was asked for.
#[test]
fn sections_are_drawn_at_their_angles() {
    for (scenario, bending) in [("rotation-sine", 1.0), ("rotation-nonlinear", 2.5)] {
        let dir = Dir::with(&[scenario]);
        let options = format!("--set log.scene.bending={bending} --set log.period=0.1 --set duration=14");
        let log = log(&dir, scenario, &options);
        let frames = Frames::from_log(&log);
        let attitude = log.columns("/attitude").expect("a motion");
        let outputs = log.columns("/outputs").expect("sections");
        let (times, hub) =
            (attitude.numbers("time_s").expect("times"), attitude.numbers("angle_rad").expect("angles"));
        let (counts, values) = rows(&outputs, "outputs");
        let values = values.numbers("value").expect("values");
        assert_eq!((counts[0], frames.times.len()), (4, times.len()));
        let mut largest = 0.0_f64;
        for message in 0..times.len() {
            assert!((frames.angle(message, "body") - hub[message]).abs() < 1e-6);
            for panel in ["panel_1", "panel_2"] {
                let mut drawn = 0.0;
                for (section, value) in values[4 * message..][..4].iter().enumerate() {
                    drawn += frames.angle(message, &format!("{panel}/{}", section + 1));
                    // The second panel points the other way.
                    let turned = if panel == "panel_1" { 0.0 } else { std::f64::consts::PI };
                    let off = (drawn - turned - bending * value).rem_euclid(std::f64::consts::TAU);
                    assert!(off.min(std::f64::consts::TAU - off) < 1e-6, "{scenario} {message} {section}");
                    largest = largest.max(value.abs());
                }
            }
        }
        assert!(largest > 0.05, "the panels bend");
    }
}

/// With modes only, the panels lag: their slopes are minus the modes' displacements, magnified.
#[test]
fn modes_bend_panels_against_the_hub() {
    let dir = Dir::with(&["relay-fixed"]);
    let log =
        log(&dir, "relay-fixed", "--set duration=300 --set log.scene={bending=20000,turning=500,period=0.5}");
    let frames = Frames::from_log(&log);
    assert_eq!(frames.times.len(), 601);
    let (attitude, modes) =
        (log.columns("/attitude").expect("a motion"), log.columns("/modes").expect("modes"));
    let times = attitude.numbers("time_s").expect("times");
    let (_, displacements) = rows(&modes, "modes");
    let displacements = displacements.numbers("displacement_rad").expect("displacements");
    let half = std::f64::consts::FRAC_PI_2;
    for (message, time) in frames.times.iter().enumerate() {
        let row = times.iter().position(|other| (other - time).abs() < 1e-9).expect("the same instant");
        let hub = attitude.numbers("angle_rad").expect("angles")[row];
        assert!((frames.angle(message, "body") - 500.0 * hub).abs() < 1e-6);
        let drawn: f64 = (1..=8).map(|n| frames.angle(message, &format!("panel_1/{n}"))).sum();
        // The last of eight sections, whose middle is at 15/16 of the panel.
        let slope = |mode: f64| ((2.0 * mode + 1.0) * half * 15.0 / 16.0).sin();
        let exact =
            -20000.0 * (slope(0.0) * displacements[2 * row] + slope(1.0) * displacements[2 * row + 1]);
        assert!((drawn - exact).abs() < 1e-5, "{time}: {drawn} {exact}");
    }
}

/// A point of a spatial body is drawn where the modes' shapes put it.
#[test]
fn points_move_as_the_shapes_say() {
    let dir = Dir::with(&["iss-ringdown-off"]);
    let log = log(&dir, "iss-ringdown-off", "--set duration=30 --set log.scene={bending=300,turning=1}");
    let frames = Frames::from_log(&log);
    let scenario =
        flexsc_core::Scenario::load(format!("{SCENARIOS}/iss-ringdown-off.toml").as_ref()).expect("shipped");
    let body = scenario.model.three_axis().expect("three axes");
    let (pointing, vibrations) =
        (log.columns("/pointing").expect("a motion"), log.columns("/vibrations").expect("modes"));
    let (counts, modes) = rows(&vibrations, "modes");
    let displacements = modes.numbers("displacement").expect("displacements");
    let shapes = body.shapes("tail");
    let mut largest = 0.0_f64;
    for message in 0..frames.times.len() {
        let q = displacements[message * counts[0] as usize..][..shapes.len()].iter();
        let (mut u, mut theta) = ([-30.5, 0.0, 0.0], [0.0; 3]);
        for ((f, phi), q) in shapes.iter().zip(q) {
            for axis in 0..3 {
                u[axis] += 300.0 * f[axis] * q;
                theta[axis] += 300.0 * phi[axis] * q;
            }
        }
        let at = frames.at(message, "point_tail");
        for (drawn, exact) in frames.translations[at].into_iter().zip(u) {
            assert!((drawn - exact).abs() < 1e-5, "{message}: {drawn} {exact}");
        }
        let angle = theta.iter().map(|part| part * part).sum::<f64>().sqrt();
        let [x, y, z, w] = frames.rotations[at];
        assert!((2.0 * (x * x + y * y + z * z).sqrt().atan2(w) - angle).abs() < 1e-6, "{message}");
        largest = largest.max(angle);
        let body = frames.rotations[frames.at(message, "body")];
        for (part, name) in body.into_iter().zip(["q_x", "q_y", "q_z", "q_w"]) {
            assert!((part - pointing.numbers(name).expect("a part")[message]).abs() < 1e-6);
        }
    }
    assert!(largest > 0.05, "the boom bends by {largest}");
}

/// Drawing changes no number: the switchings are those of a run without a scene.
#[test]
fn a_scene_changes_no_motion() {
    for (scenario, options, topic) in [
        ("relay-adaptive", "--set duration=3000", "/command"),
        ("iss-manoeuvre", "--set duration=60 --set log.scene.period=0.07", "/jets"),
        ("rotation-nonlinear", "--set log.scene.period=0.13", "/arrival"),
    ] {
        let dir = Dir::with(&[scenario]);
        let export = format!("export {scenario}.mcap --topic {topic}");
        dir.run(&format!("simulate {scenario}.toml {options}")).exits(0);
        let without = dir.run(&export).printed();
        dir.run(&format!("simulate {scenario}.toml {options} --log scene")).exits(0);
        assert!(dir.run(&export).printed() == without, "{scenario}");
    }
}

/// The entities of each message of a topic, with their ids.
fn entities(log: &Log, topic: &str) -> Vec<(f64, Vec<String>)> {
    let columns = log.columns(topic).expect("a scene");
    let (counts, inner) = rows(&columns, "entities");
    let Some(Column::Texts(ids)) = inner.get("id") else { panic!("ids") };
    let times = columns.numbers("time_s").expect("times");
    let mut from = 0;
    let message = |(time, count): (&f64, &u32)| {
        from += *count as usize;
        (*time, ids[from - *count as usize..from].to_vec())
    };
    times.iter().zip(counts).map(message).collect()
}

#[test]
fn plumes_are_those_of_the_torque() {
    let dir = Dir::with(&["relay-fixed"]);
    let log = log(&dir, "relay-fixed", "--set duration=500");
    let plumes = entities(&log, "/plumes");
    let command = log.columns("/command").expect("switchings");
    let (times, torques) =
        (command.numbers("time_s").expect("times"), command.numbers("torque_nm").expect("torques"));
    // One at the start, and one at each switching to another torque.
    assert_eq!(plumes[0].0, 0.0);
    for (time, torque) in pairs(times, torques) {
        let (_, burning) = plumes.iter().rev().find(|(at, _)| *at <= time + 1e-9).expect("told");
        let sign = if *torque > 0.0 { "plus" } else { "minus" };
        assert_eq!(*burning, [format!("{sign} 1"), format!("{sign} 2")], "{time}");
    }
    assert!(plumes.len() <= times.len() + 1 && plumes.len() > times.len() / 2);
}

#[test]
fn jets_have_plumes_while_they_fire() {
    let dir = Dir::with(&["iss-manoeuvre-off"]);
    let log = log(&dir, "iss-manoeuvre-off", "--set duration=40");
    let plumes = entities(&log, "/plumes");
    let jets = log.columns("/jets").expect("pulses");
    let (times, yaw) = (jets.numbers("time_s").expect("times"), jets.numbers("yaw_on_s").expect("pulses"));
    assert!(yaw.iter().any(|on| *on != 0.0));
    for (time, on) in times.iter().zip(yaw).filter(|(_, on)| **on != 0.0) {
        let at = |t: f64| &plumes.iter().rev().find(|(at, _)| *at <= t).expect("told").1;
        let jet = if *on > 0.0 { "yaw +" } else { "yaw -" };
        assert!(at(time + 0.5 * on.abs()).iter().any(|name| name == jet), "{time}");
        // A pulse that fills its cycle may go on in the next.
        assert!(on.abs() > 0.199 || !at(time + on.abs() + 1e-6).iter().any(|name| name == jet), "{time}");
    }
}

/// Every shipped scenario shows how it bends, without a key that says so.
#[test]
fn panels_visibly_bend() {
    let shipped = std::fs::read_dir(SCENARIOS).expect("scenarios").flatten();
    let names =
        shipped.filter_map(|entry| entry.file_name().to_str()?.strip_suffix(".toml").map(str::to_owned));
    for name in names {
        // A rigid body has nothing to bend, drives and hinges turn wings by far more than they bend, 1e-4 N m bend
        // nothing beside what wheels could, a force bends two wings alike, which turns no hub to draw them against, the
        // turns of a pass are too smooth, and a telescope shakes by microradians.
        let straight = "detumble-and-point sun-tracking panel-deployment adaptive-bandwidth bounded-jitter \
                        orbit-correction ground-pass safe-mode cubesat-day s2e-sample basilisk-momentum forty-two-leo blinded-tracker \
                        two-line-orbit site-pass field-aligned molniya false-readings cubesat-faults solar-telescope";
        if straight.split(' ').any(|straight| straight == name) {
            continue;
        }
        let dir = Dir::with(&[&name]);
        let is_long = name.starts_with("relay");
        let shorter = if is_long { "--set duration=2000 --set log.scene.period=1" } else { "" };
        let period = if name == "magnetic-unloading" { 5.0 } else { 0.5 };
        let log = log(&dir, &name, &format!("{shorter} --set log.period={period}"));
        let frames = Frames::from_log(&log);
        let chain = if frames.names.iter().any(|frame| frame == "wing_1/1") { "wing_1/" } else { "panel_1/" };
        let bend = |message: usize| -> f64 {
            let sections = frames.names.iter().filter(|frame| frame.starts_with(chain));
            let of = |frame: &String| {
                let [x, y, z, w] = frames.rotations[frames.at(message, frame)];
                let largest =
                    [x, y, z].into_iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
                2.0 * largest.atan2(w)
            };
            sections.map(of).sum::<f64>().abs()
        };
        let largest = (0..frames.times.len()).map(bend).fold(0.0, f64::max);
        // Torques on the panels themselves bend them less.
        let least = if name == "rotation-panel-torque" { 0.015 } else { 0.04 };
        assert!(largest > least, "{name} bends by {largest} rad");
        // A loop that is unstable bends as far as anything is drawn.
        let most = if name == "wheel-unstable-band" { 1.51 } else { 1.0 };
        assert!(largest < most, "{name} bends by {largest} rad");
    }
}

/// Wings unfold with the hinges of their panels, each about its own axis.
#[test]
fn wings_swing_on_their_hinges() {
    let dir = Dir::with(&["panel-deployment"]);
    let log = log(&dir, "panel-deployment", "--set duration=60 --set log.scene.period=1");
    let frames = Frames::from_log(&log);
    let about_x = |message: usize, wing: &str| {
        let [x, y, z, w] = frames.rotations[frames.at(message, wing)];
        assert!(y.abs() < 1e-12 && z.abs() < 1e-12, "{wing} turns about x alone");
        2.0 * x.atan2(w)
    };
    let last = frames.times.len() - 1;
    for (wing, way) in [("wing_1/1", 1.0), ("wing_2/1", -1.0)] {
        assert!((about_x(0, wing) - 1.4 * way).abs() < 1e-6, "{}", about_x(0, wing));
        assert!(about_x(last, wing).abs() < 0.02, "{}", about_x(last, wing));
    }
}

/// Lines for people: the run, each step of the adaptation, the end.
#[test]
fn a_log_tells_what_happened() {
    let reported = |scenario: &str, options: &str| {
        let dir = Dir::with(&[scenario]);
        dir.run(&format!("simulate {scenario}.toml {options}")).exits(0);
        dir.run(&format!("export {scenario}.mcap --topic /log")).printed()
    };
    let relay = reported("relay-adaptive", "");
    assert_eq!(relay.lines().count(), 1 + 2 + 36, "{relay}");
    for line in [
        "0e0,0e0,info,\"relay-adaptive: 20000 s, seed 157, run 0\",run",
        "5e2,5e2,info,\"window 0: the search begins, gain 0.31000 -> 0.30911\",adaptation",
        "1.8e4,1.8e4,info,\"window 35: the mean is settled, gain frozen at 0.33890\",adaptation",
        "2e4,2e4,info,the end of the run,run",
    ] {
        assert!(relay.contains(line), "no `{line}` in\n{relay}");
    }
    let lost = reported("wheel-ekf", "--set sensor.sampled.faults=[{stuck={from=60}}] --set duration=120");
    assert!(lost.contains("warning,the filter has lost the body,estimator"), "{lost}");
    let rotation = reported("rotation-sine", "");
    assert!(rotation.contains("the manoeuvre ends") && rotation.contains("1.2e1,1.2e1,info"), "{rotation}");
    let station = reported("iss-manoeuvre", "");
    for line in [
        "the target is roll 0.00873, pitch 0.01745, yaw 0.05236 rad",
        "within the dead zone about its target",
    ] {
        assert!(station.contains(line), "no `{line}` in\n{station}");
    }
}

/// Points and thrusters may be called as the scene's own parts are: no frame is its own parent, and no entity another.
#[test]
fn names_of_a_user_do_not_meet_those_of_the_scene() {
    let dir = Dir::with(&["iss-ringdown"]);
    let text = dir.text("iss-ringdown.toml");
    let text = text.replace("name = \"gyro\"", "name = \"body\"").replace("gyro = {", "body = {");
    let text = text.replace("point = \"gyro\"", "point = \"body\"").replace("\"yaw +\"", "\"hub\"");
    dir.write("iss-ringdown.toml", text);
    let log = log(&dir, "iss-ringdown", "--set duration=1");
    let unique = |mut names: Vec<String>| {
        names.sort();
        names.windows(2).all(|pair| pair[0] != pair[1])
    };
    assert!(unique(Frames::from_log(&log).names));
    let scene = log.columns("/scene").expect("a scene");
    let (_, entities) = rows(&scene, "entities");
    let Some(Column::Texts(ids)) = entities.get("id") else { panic!("ids") };
    assert!(unique(ids.clone()), "{ids:?}");
}

#[test]
fn a_mode_that_does_not_swing_is_magnified_too() {
    let dir = Dir::with(&["wheel-fast-mode"]);
    let words = |damping: &str| {
        let mode = format!("[{{frequency=0.3,gain=1.44,damping={damping},displacement=0.003}}]");
        let set = format!("--set duration=1 --set body.planar.angle=0.0 --set body.planar.modes={mode}");
        let log = log(&dir, "wheel-fast-mode", &set);
        let columns = log.columns("/scene").expect("a scene");
        let (_, entities) = rows(&columns, "entities");
        let (_, texts) = rows(entities, "texts");
        let Some(Column::Texts(texts)) = texts.get("text") else { panic!("words") };
        texts[0].clone()
    };
    assert_eq!(words("1.2"), words("0"));
}

#[test]
fn a_wheel_turns_as_its_speed_says_and_slowly_enough_to_be_seen() {
    let dir = Dir::with(&["wheel-ekf"]);
    let log = log(&dir, "wheel-ekf", "--set duration=60");
    let scene = log.columns("/scene").expect("a scene");
    let (_, texts) = rows(rows(&scene, "entities").1, "texts");
    let Some(Column::Texts(texts)) = texts.get("text") else { panic!("words") };
    let slowed = texts.iter().find_map(|text| text.split_once("wheel ÷ ")?.1.split(' ').next()?.parse().ok());
    let slowed: f64 = slowed.expect("it is slowed");
    let wheel = log.columns("/wheel").expect("a wheel");
    let speeds = wheel.numbers("speed_rad_s").expect("speeds");
    let times = wheel.numbers("time_s").expect("times");
    let frames = Frames::from_log(&log);
    assert_eq!(frames.times, times);
    for at in 1..times.len() {
        let turned = frames.angle(at, "wheel") - frames.angle(at - 1, "wheel");
        let half = std::f64::consts::PI;
        let seen = (turned + half).rem_euclid(2.0 * half) - half;
        let exact = 0.5 * (speeds[at - 1] + speeds[at]) * (times[at] - times[at - 1]) / slowed;
        assert!((seen - exact).abs() < 1e-3 && seen.abs() < 1.0, "{}: {seen} {exact}", times[at]);
    }
}

#[test]
fn factors_that_leave_no_picture_are_refused() {
    let dir = Dir::with(&["relay-fixed", "iss-ringdown"]);
    for (scenario, key) in [("relay-fixed", "turning"), ("iss-ringdown", "bending")] {
        dir.run(&format!("simulate {scenario}.toml --set log.scene.{key}=1e200"))
            .exits(2)
            .says(&[&format!("`log.scene.{key}` must be at most 1e9, got 1e200")]);
    }
}
