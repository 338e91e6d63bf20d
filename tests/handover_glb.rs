//! glTF: the file of a run against the scene of its log, by a reader of its own.

use std::collections::BTreeMap;

use serde_json::Value as Json;

use crate::util::Dir;

type Vector = [f64; 3];
type Rotation = [f64; 4];

/// Frames of a scene: each with its parent, translation and rotation.
type Frames = BTreeMap<String, (String, Vector, Rotation)>;

/// A file in parts: its document and its binary data.
struct Glb {
    document: Json,
    data: Vec<u8>,
}

impl Glb {
    fn read(bytes: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("a word")) as usize;
        assert_eq!(&bytes[..4], b"glTF");
        assert_eq!((word(4), word(8)), (2, bytes.len()));
        let text = word(12);
        assert_eq!((text % 4, &bytes[16..20]), (0, b"JSON".as_slice()));
        let document = serde_json::from_slice(&bytes[20..20 + text]).expect("JSON");
        let data = word(20 + text);
        assert_eq!((data % 4, &bytes[24 + text..28 + text]), (0, b"BIN\0".as_slice()));
        assert_eq!(28 + text + data, bytes.len());
        Self { document, data: bytes[28 + text..].to_vec() }
    }

    /// Returns the numbers of an accessor.
    fn numbers(&self, index: &Json) -> Vec<f64> {
        let accessor = &self.document["accessors"][index.as_u64().expect("an index") as usize];
        let view = &self.document["bufferViews"][accessor["bufferView"].as_u64().expect("a view") as usize];
        let width = match accessor["type"].as_str() {
            Some("SCALAR") => 1,
            Some("VEC3") => 3,
            _ => 4,
        };
        let start = view["byteOffset"].as_u64().expect("an offset") as usize;
        let length = view["byteLength"].as_u64().expect("a length") as usize;
        assert_eq!(accessor["count"].as_u64().map(|count| count as usize * width * 4), Some(length));
        let words = self.data[start..start + length].chunks(4).map(|word| word.try_into().expect("a word"));
        words.map(|word| f64::from(f32::from_le_bytes(word))).collect()
    }

    fn node(&self, name: &str) -> (usize, &Json) {
        let nodes = self.document["nodes"].as_array().expect("nodes");
        nodes.iter().enumerate().find(|(_, node)| node["name"] == name).expect(name)
    }

    /// Returns times and values of the channel to a property of a node in an animation.
    fn channel(&self, animation: usize, node: &str, path: &str) -> Option<(Vec<f64>, Vec<f64>)> {
        let animation = &self.document["animations"][animation];
        let (index, _) = self.node(node);
        let channels = animation["channels"].as_array().expect("channels");
        let own = channels
            .iter()
            .find(|channel| channel["target"]["node"] == index && channel["target"]["path"] == path)?;
        let sampler = &animation["samplers"][own["sampler"].as_u64().expect("a sampler") as usize];
        let kind = if path == "scale" { "STEP" } else { "LINEAR" };
        assert_eq!(sampler["interpolation"], kind);
        Some((self.numbers(&sampler["input"]), self.numbers(&sampler["output"])))
    }

    /// Returns translation and rotation of a node at a key frame of the run's animation.
    fn placement(&self, node: &str, frame: usize) -> (Vector, Rotation) {
        let (_, rest) = self.node(node);
        let parts = |path: &str, width: usize| -> Vec<f64> {
            self.channel(0, node, path).map_or_else(
                || rest[path].as_array().expect("at rest").iter().map(|x| x.as_f64().expect("f")).collect(),
                |(_, values)| values[frame * width..(frame + 1) * width].to_vec(),
            )
        };
        (parts("translation", 3).try_into().expect("three"), parts("rotation", 4).try_into().expect("four"))
    }
}

fn turn([x, y, z, w]: Rotation, v: Vector) -> Vector {
    let cross = |a: Vector, b: Vector| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let axis = [x, y, z];
    let once = cross(axis, v).map(|part| 2.0 * part);
    let twice = cross(axis, once);
    [0, 1, 2].map(|i| v[i] + w * once[i] + twice[i])
}

fn apply((at, rotation): (Vector, Rotation), v: Vector) -> Vector {
    let turned = turn(rotation, v);
    [0, 1, 2].map(|i| at[i] + turned[i])
}

fn distance(a: Vector, b: Vector) -> f64 {
    [0, 1, 2].map(|i| (a[i] - b[i]) * (a[i] - b[i])).iter().sum::<f64>().sqrt()
}

/// Returns the frames of a log's scene with their times.
fn frames(dir: &Dir, log: &str) -> Vec<(f64, Frames)> {
    let rows = dir.run(&format!("export {log} --topic /tf --format jsonl")).printed();
    let row = |line: &str| {
        let row: Json = serde_json::from_str(line).expect("JSON");
        let number = |key: String| row[key].as_f64().expect("a number");
        let mut frames = BTreeMap::new();
        for index in 0.. {
            let key = |part: &str| format!("transforms[{index}].{part}");
            let Some(name) = row[key("child_frame_id")].as_str() else { break };
            let parent = row[key("parent_frame_id")].as_str().expect("a parent").to_owned();
            let at = ["x", "y", "z"].map(|axis| number(key(&format!("translation.{axis}"))));
            let turned = ["x", "y", "z", "w"].map(|axis| number(key(&format!("rotation.{axis}"))));
            frames.insert(name.to_owned(), (parent, at, turned));
        }
        (row["time_s"].as_f64().expect("a time"), frames)
    };
    rows.lines().map(row).collect()
}

/// Returns a place of a frame in inertial axes.
fn in_inertial(frames: &Frames, frame: &str, at: Vector) -> Vector {
    let (mut name, mut at) = (frame, at);
    while let Some((parent, origin, turned)) = frames.get(name) {
        at = apply((*origin, *turned), at);
        name = parent;
    }
    at
}

/// Returns the indices of key frames and of frames of the log at equal times.
fn pairs(times: &[f64], frames: &[(f64, Frames)]) -> Vec<(usize, usize)> {
    let at = |time: f64| times.iter().position(|own| (own - time).abs() < 1e-4);
    frames.iter().enumerate().filter_map(|(index, (time, _))| Some((at(*time)?, index))).collect()
}

#[test]
fn panels_bend_by_the_modes_as_in_the_scene() {
    let dir = Dir::with(&["relay-adaptive"]);
    dir.run("simulate relay-adaptive.toml --set duration=60 --set log.period=0.5 --log scene").exits(0);
    dir.run("export relay-adaptive.mcap -o a.glb --speed 1").exits(0).prints(&[]);
    let glb = Glb::read(&dir.read("a.glb"));
    let about = &glb.document["asset"]["extras"]["flexsc"];
    let (times, weights) = glb.channel(0, "panel_1", "weights").expect("it bends");
    let modes = about["modes"].as_array().expect("modes");
    assert_eq!(weights.len(), modes.len() * times.len());

    // The weights are the modal displacements, each over its largest.
    let rows = dir.run("export relay-adaptive.mcap --topic /modes --format jsonl").printed();
    let rows: Vec<Json> = rows.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let mut found = 0;
    for (frame, time) in times.iter().enumerate() {
        let near = |row: &&Json| (row["time_s"].as_f64().expect("a time") - time).abs() < 1e-5;
        let row = rows.iter().find(near).expect("a row of the log");
        for (place, mode) in modes.iter().enumerate() {
            let x = row[format!("modes[{}].displacement_rad", mode["mode"])].as_f64().expect("a number");
            let per_weight = mode["per_weight"].as_f64().expect("a number");
            let weight = weights[frame * modes.len() + place];
            assert!((weight * per_weight - x).abs() <= 2e-7 * per_weight, "{weight} {x}");
            assert!(weight.abs() <= 1.000_001);
            found += 1;
        }
    }
    assert!(found > 200, "{found}");

    // The end of the panel: in the file by its targets, in the log by the chain of sections.
    let scene = frames(&dir, "relay-adaptive.mcap");
    let (length, section) = (10.0, 1.25);
    let mesh = glb.node("panel_1").1["mesh"].as_u64().expect("a mesh") as usize;
    let primitive = &glb.document["meshes"][mesh]["primitives"][0];
    let vertices = glb.numbers(&primitive["attributes"]["POSITION"]);
    let targets = primitive["targets"].as_array().expect("targets");
    let targets: Vec<Vec<f64>> = targets.iter().map(|target| glb.numbers(&target["POSITION"])).collect();
    let far = vertices.chunks(3).map(|v| v[0]).fold(0.0, f64::max);
    let ends: Vec<usize> = (0..vertices.len() / 3).filter(|v| far - vertices[3 * v] < 1e-4).collect();
    let mut largest: f64 = 0.0;
    let compared = pairs(&times, &scene);
    assert!(compared.len() > 100);
    for (frame, row) in compared {
        let (_, frames) = &scene[row];
        let body = glb.placement("body", frame);
        let [.., w] = frames["body"].2;
        assert!((body.1[3].abs() - w.abs()).abs() < 1e-6);
        let weights = &weights[frame * modes.len()..(frame + 1) * modes.len()];
        let mut end = [0.0; 3];
        for vertex in &ends {
            for axis in 0..3 {
                let at = 3 * vertex + axis;
                let moved = weights.iter().zip(&targets).map(|(weight, target)| weight * target[at]);
                end[axis] += (vertices[at] + moved.sum::<f64>()) / ends.len() as f64;
            }
        }
        let drawn = apply(body, apply(glb.placement("panel_1", frame), end));
        let exact = in_inertial(frames, "panel_1/8", [0.985 * section, 0.0, 0.0]);
        // Sums of the sections' rotations are the slopes along the panel.
        let turns = (1..=8).map(|n| 2.0 * frames[&format!("panel_1/{n}")].2[2]);
        let slopes = turns.scan(0.0, |sum: &mut f64, turn| {
            *sum += turn;
            Some(sum.abs())
        });
        let bent = slopes.fold(0.0, f64::max);
        largest = largest.max(bent);
        let off = distance(drawn, exact);
        assert!(off < 0.4 * length * bent * bent + 1e-4, "{frame}: {off} at a bending of {bent}");
    }
    assert!(largest > 0.1, "{largest}");
}

/// Without modes, as of a hinge, the parts are where the scene has them, to single precision.
#[test]
fn hinges_turn_their_parts_as_in_the_scene() {
    let dir = Dir::with(&["panel-deployment"]);
    dir.run("simulate panel-deployment.toml --set duration=20 --log scene").exits(0);
    dir.run("export panel-deployment.mcap -o a.glb --speed 1").exits(0);
    let glb = Glb::read(&dir.read("a.glb"));
    let scene = frames(&dir, "panel-deployment.mcap");
    let (times, _) = glb.channel(0, "wing_1", "rotation").expect("it turns");
    let compared = pairs(&times, &scene);
    assert!(compared.len() > 30);
    for (frame, row) in compared {
        let frames = &scene[row].1;
        for wing in ["wing_1", "wing_2"] {
            for place in [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]] {
                let drawn = apply(glb.placement("body", frame), apply(glb.placement(wing, frame), place));
                let exact = in_inertial(frames, &format!("{wing}/1"), place);
                assert!(distance(drawn, exact) < 2e-5, "{wing} {frame}: {drawn:?} {exact:?}");
            }
        }
    }
}

/// Points move, and plumes are there while their jets fire.
#[test]
fn jets_have_plumes_at_their_points() {
    let dir = Dir::with(&["iss-manoeuvre"]);
    dir.run("simulate iss-manoeuvre.toml --set duration=60 --set log.period=0.2 --log scene").exits(0);
    dir.run("export iss-manoeuvre.mcap -o a.glb --speed 1").exits(0);
    let glb = Glb::read(&dir.read("a.glb"));
    let scene = frames(&dir, "iss-manoeuvre.mcap");
    let (times, _) = glb.channel(0, "body", "rotation").expect("it turns");
    for (frame, row) in pairs(&times, &scene) {
        let frames = &scene[row].1;
        let place = [0.0, 1.0, 2.0];
        let drawn = apply(glb.placement("body", frame), apply(glb.placement("point_tail", frame), place));
        let exact = in_inertial(frames, "point_tail", place);
        assert!(distance(drawn, exact) < 2e-4, "{drawn:?} {exact:?}");
    }
    let rows = dir.run("export iss-manoeuvre.mcap --topic /plumes --format jsonl").printed();
    let rows: Vec<Json> = rows.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let nodes = glb.document["nodes"].as_array().expect("nodes").iter();
    let plumes: Vec<&str> = nodes.filter_map(|node| node["name"].as_str()?.strip_prefix("plume_")).collect();
    assert!(plumes.len() >= 4, "{plumes:?}");
    let mut seen = 0;
    for pair in rows.windows(2) {
        let time = |row: &Json| row["time_s"].as_f64().expect("a time");
        let middle = 0.5 * (time(&pair[0]) + time(&pair[1]));
        // Plumes last for at least a sixtieth of a second of the animation.
        if time(&pair[1]) - time(&pair[0]) < 0.05 {
            continue;
        }
        let fires = |name: &str| (0..12).any(|i| pair[0][format!("entities[{i}].id")] == name);
        for name in &plumes {
            let (times, scales) = glb.channel(0, &format!("plume_{name}"), "scale").expect("it fires");
            let at = times.iter().rposition(|time| *time <= middle).expect("from the start on");
            assert_eq!(scales[3 * at] > 0.0, fires(name), "{name} at {middle}");
            seen += usize::from(fires(name));
        }
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn long_runs_last_a_minute_and_are_drawn_with_y_up() {
    let dir = Dir::with(&["relay-adaptive"]);
    dir.run("simulate relay-adaptive.toml --log full").exits(0);
    dir.run("export relay-adaptive.mcap -o a.glb --modes").exits(0);
    let bytes = dir.read("a.glb");
    let glb = Glb::read(&bytes);
    let animations = glb.document["animations"].as_array().expect("animations");
    assert_eq!(animations[0]["name"], "run, 500 times as fast");
    let (times, weights) = glb.channel(0, "panel_2", "weights").expect("it bends");
    assert!((times[times.len() - 1] - 40.0).abs() < 1e-4, "20 000 s at 500 times the speed");
    assert!(times.windows(2).all(|pair| pair[1] > pair[0]) && times.len() <= 2402, "{}", times.len());
    assert!(weights.iter().all(|weight| weight.is_finite()));
    // One oscillation of each mode.
    let modes = glb.document["asset"]["extras"]["flexsc"]["modes"].as_array().expect("modes").len();
    assert_eq!(animations.len(), 1 + modes);
    assert!(animations[1]["name"].as_str().is_some_and(|name| name.starts_with("mode 0, ")));
    let (times, weights) = glb.channel(1, "panel_1", "weights").expect("a shape");
    assert_eq!((times[0], times[times.len() - 1]), (0.0, 2.0));
    assert!((weights[8 * modes] - 1.0).abs() < 1e-7 && weights[16 * modes].abs() < 1e-7);
    // z of the scene is up, and x stays.
    let root = glb.document["scenes"][0]["nodes"][0].as_u64().expect("a node") as usize;
    let rotation = &glb.document["nodes"][root]["rotation"];
    let rotation = [0, 1, 2, 3].map(|i| rotation[i].as_f64().expect("a number"));
    assert!(distance(turn(rotation, [0.0, 0.0, 1.0]), [0.0, 1.0, 0.0]) < 1e-6);
    assert!(distance(turn(rotation, [1.0, 0.0, 0.0]), [1.0, 0.0, 0.0]) < 1e-6);
    // A second export has equal bytes, also of a log with its scene.
    dir.run("export relay-adaptive.mcap -o b.glb --modes").exits(0);
    assert!(dir.read("b.glb") == bytes);
    dir.run("export relay-adaptive.mcap -o a.glb --speed 0").exits(2).says(&["--speed: must be from 1e-6"]);
    dir.run("export relay-adaptive.mcap -o a.glb --speed nan").exits(2);
    dir.run("export relay-adaptive.mcap --topic /modes --modes")
        .exits(2)
        .says(&["--modes: is for whole runs"]);
}

/// Every kind of body gives a file whose numbers are finite and whose accessors lie within it.
#[test]
fn every_kind_of_body_has_a_scene() {
    let names = [
        "rotation-nonlinear",
        "wheel-ekf",
        "rotation-sine",
        "flexible-boom",
        "sun-tracking",
        "attitude-hold",
    ];
    let dir = Dir::with(&names);
    for name in names {
        dir.run(&format!("simulate {name}.toml --set duration=14 --log full")).exits(0);
        dir.run(&format!("export {name}.mcap -o {name}.glb")).exits(0).prints(&[]);
        let glb = Glb::read(&dir.read(&format!("{name}.glb")));
        for (index, accessor) in glb.document["accessors"].as_array().expect("accessors").iter().enumerate() {
            if accessor["componentType"] == 5126 {
                let numbers = glb.numbers(&index.into());
                assert!(numbers.iter().all(|number| number.is_finite()), "{name}");
            }
        }
        assert_eq!(glb.document["animations"].as_array().map(Vec::len), Some(1), "{name}");
    }
}
