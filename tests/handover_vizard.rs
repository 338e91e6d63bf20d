//! Vizard's file: the messages of a run, by a decoder of its own of the wire format.

use std::collections::BTreeMap;

use serde_json::Value as Json;

use crate::handover::FREE;
use crate::util::Dir;

/// Field of a message.
#[derive(Clone, Debug)]
enum Field<'a> {
    Varint(u64),
    Fixed(f64),
    Block(&'a [u8]),
}

/// Reads a number of seven bits in each byte.
fn varint(bytes: &[u8], at: &mut usize) -> u64 {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let byte = bytes[*at];
        *at += 1;
        value |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            break;
        }
    }
    value
}

/// Fields of a message by their numbers.
struct Message<'a>(BTreeMap<u64, Vec<Field<'a>>>);

impl<'a> Message<'a> {
    fn read(bytes: &'a [u8]) -> Self {
        let (mut fields, mut at): (BTreeMap<u64, Vec<Field>>, _) = (BTreeMap::new(), 0);
        while at < bytes.len() {
            let tag = varint(bytes, &mut at);
            let field = match tag & 7 {
                0 => Field::Varint(varint(bytes, &mut at)),
                1 => {
                    at += 8;
                    Field::Fixed(f64::from_le_bytes(bytes[at - 8..at].try_into().expect("eight")))
                }
                2 => {
                    let length = varint(bytes, &mut at) as usize;
                    at += length;
                    Field::Block(&bytes[at - length..at])
                }
                other => panic!("wire type {other}"),
            };
            fields.entry(tag >> 3).or_default().push(field);
        }
        Self(fields)
    }

    fn all(&self, number: u64) -> &[Field<'a>] {
        self.0.get(&number).map_or(&[], Vec::as_slice)
    }

    fn messages(&self, number: u64) -> Vec<Message<'a>> {
        self.all(number).iter().map(|field| Message::read(block(field))).collect()
    }

    fn text(&self, number: u64) -> &'a str {
        self.all(number).first().map_or("", |field| std::str::from_utf8(block(field)).expect("UTF-8"))
    }

    fn number(&self, number: u64) -> f64 {
        match self.all(number).first() {
            Some(Field::Fixed(value)) => *value,
            None => 0.0,
            Some(other) => panic!("{number}: {other:?}"),
        }
    }

    fn integer(&self, number: u64) -> i64 {
        match self.all(number).first() {
            Some(Field::Varint(value)) => value.cast_signed(),
            None => 0,
            Some(other) => panic!("{number}: {other:?}"),
        }
    }

    /// Returns packed doubles.
    fn list(&self, number: u64) -> Vec<f64> {
        let packed = self.all(number).first().map_or(&[][..], block);
        packed.chunks(8).map(|part| f64::from_le_bytes(part.try_into().expect("eight"))).collect()
    }
}

fn block<'a>(field: &Field<'a>) -> &'a [u8] {
    match field {
        Field::Block(bytes) => bytes,
        other => panic!("{other:?}"),
    }
}

/// Returns the messages of a file, each after its length.
fn messages(bytes: &[u8]) -> Vec<Message<'_>> {
    let (mut messages, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let length = varint(bytes, &mut at) as usize;
        messages.push(Message::read(&bytes[at..at + length]));
        at += length;
    }
    messages
}

fn rows(dir: &Dir, log: &str, topic: &str) -> Vec<Json> {
    let out = dir.run(&format!("export {log} --topic {topic} --format jsonl")).printed();
    out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

fn near(found: &[f64], exact: &[f64], within: f64) {
    assert_eq!(found.len(), exact.len());
    for (found_at, exact_at) in found.iter().zip(exact) {
        assert!((found_at - exact_at).abs() <= within, "{found:?} {exact:?}");
    }
}

/// Time, date, planet and attitude of a free rotation on a circular orbit.
#[test]
fn messages_have_the_free_rotation() {
    let sun = "sun = [0.0, 3.0, 4.0]\n\n[law.open]";
    let sensor = "\n[sensor.sun_sensor]\nperiod = 1.0\nboresight = [0, 2, 0]\nfield_of_view = \"60 deg\"\n";
    let dir = Dir::holding("free.toml", FREE.replace("\n[law.open]", sun) + sensor);
    dir.run("simulate free.toml --log full").exits(0);
    dir.run("export free.mcap -o free.bin").exits(0).prints(&[]);
    let bytes = dir.read("free.bin");
    let all = messages(&bytes);
    assert_eq!(all.len(), 121);
    let epoch = &all[0].messages(8)[0];
    assert_eq!([1, 2, 3, 4, 5].map(|field| epoch.integer(field)), [2026, 3, 20, 14, 46]);
    assert_eq!(epoch.number(6), 0.0);
    let settings = &all[0].messages(7)[0];
    assert_eq!(settings.text(34), "free");
    let models = settings.messages(12);
    assert!(models.iter().all(|model| model.text(1) == "CUBE" && model.list(5).len() == 3));
    for (index, message) in all.iter().enumerate() {
        let time = &message.messages(1)[0];
        assert_eq!((time.integer(1), time.number(2)), (index as i64, 5e8 * index as f64));
        assert_eq!(message.all(8).len() + message.all(7).len(), if index == 0 { 2 } else { 0 });
        let bodies = message.messages(2);
        assert_eq!((bodies[0].text(1), bodies[1].text(1)), ("earth", "sun"));
        near(&[bodies[0].number(5), bodies[0].number(6)], &[398_600.441_8, 6378.137], 1e-9);
        // 1 au towards the Sun.
        near(&bodies[1].list(2), &[0.0, 0.6 * 149_597_870_700.0, 0.8 * 149_597_870_700.0], 1e-3);
        let spacecraft = message.messages(3);
        let main = &spacecraft[0];
        assert_eq!((main.text(1), main.text(19)), ("free", ""));
        let (sin, cos) = ((398_600.441_8e9_f64 / 7e6_f64.powi(3)).sqrt() * 0.5 * index as f64).sin_cos();
        let ((tilt, flat), (node, x)) = (0.9_f64.sin_cos(), 0.4_f64.sin_cos());
        let position =
            [cos * x - sin * flat * node, cos * node + sin * flat * x, sin * tilt].map(|part| 7e6 * part);
        near(&main.list(2), &position, 1e-5);
        // Modified Rodrigues parameters: the axis times the tangent of a quarter of the angle.
        near(&main.list(4), &[0.0, 0.0, (0.25 * 0.02 * 0.5 * index as f64).tan()], 1e-12);
        let sensor = &main.messages(8)[0];
        near(&sensor.list(3), &[120.0], 1e-9);
        assert_eq!((sensor.list(4), sensor.text(9)), (vec![0.0, 1.0, 0.0], "sensor 1"));
        for part in &spacecraft[1..] {
            assert_eq!(part.text(19), "free");
            let away: f64 = part.list(2).iter().zip(&position).map(|(a, b)| (a - b) * (a - b)).sum();
            assert!(away.sqrt() < 15.0, "parts are at the spacecraft");
        }
        // Twelve sections of the wings; at rest they are along y.
        let first: Vec<f64> = spacecraft[1].list(2).iter().zip(&position).map(|(a, b)| a - b).collect();
        let long = (first[0] * first[0] + first[1] * first[1] + first[2] * first[2]).sqrt();
        let angle = 0.02 * 0.5 * index as f64;
        near(&first, &[-long * angle.sin(), long * angle.cos(), 0.0], 2e-6);
        assert_eq!(spacecraft.len(), 13);
    }
    dir.run("export free.mcap -o again.bin").exits(0);
    assert!(dir.read("again.bin") == bytes);
}

/// Rotations beyond half a turn have the parameters of at most half a turn.
#[test]
fn rodrigues_parameters_stay_within_one() {
    let dir = Dir::holding("free.toml", FREE.replace("rate = [0.0, 0.0, 0.02]", "rate = [0.0, 0.0, 0.2]"));
    dir.run("simulate free.toml --log full").exits(0);
    dir.run("export free.mcap -o free.bin").exits(0);
    let bytes = dir.read("free.bin");
    for (index, message) in messages(&bytes).iter().enumerate() {
        let found = message.messages(3)[0].list(4);
        let angle = 0.1 * index as f64;
        let angle = angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round();
        near(&found, &[0.0, 0.0, (0.25 * angle).tan()], 1e-11);
        assert!(found[2].abs() <= 1.0);
    }
}

#[test]
fn wheels_have_the_speeds_of_the_log() {
    let dir = Dir::with(&["earth-observer", "wheel-ekf"]);
    for (name, topic) in [("earth-observer", "/wheels"), ("wheel-ekf", "/wheel")] {
        dir.run(&format!("simulate {name}.toml --set duration=20 --log full")).exits(0);
        dir.run(&format!("export {name}.mcap --format vizard -o {name}.bin")).exits(0);
        let bytes = dir.read(&format!("{name}.bin"));
        let (all, rows) = (messages(&bytes), rows(&dir, &format!("{name}.mcap"), topic));
        assert_eq!(all.len(), rows.len());
        assert!(all[0].all(8).is_empty(), "no date without an epoch");
        let mut fastest: f64 = 0.0;
        for (message, row) in all.iter().zip(&rows) {
            let wheels = message.messages(3)[0].messages(5);
            assert_eq!(wheels.len(), if topic == "/wheel" { 1 } else { 4 });
            for (index, wheel) in wheels.iter().enumerate() {
                let key = if topic == "/wheel" {
                    "speed_rad_s".to_owned()
                } else {
                    format!("wheels[{index}].speed_rad_s")
                };
                assert_eq!(Some(wheel.number(5)), row[key].as_f64());
                fastest = fastest.max(wheel.number(5).abs());
                let axis: f64 = wheel.list(4).iter().map(|part| part * part).sum();
                assert!((axis - 1.0).abs() < 1e-12);
            }
        }
        assert!(fastest > 0.0);
    }
}

/// The thrust of each thruster is the mean since the last message: its impulse is that of the log.
#[test]
fn thrusters_have_the_impulse_of_the_log() {
    let dir = Dir::with(&["iss-manoeuvre"]);
    dir.run("simulate iss-manoeuvre.toml --set duration=100 --set log.period=0.5 --log full").exits(0);
    dir.run("export iss-manoeuvre.mcap -o a.bin").exits(0);
    let bytes = dir.read("a.bin");
    let mut impulses: BTreeMap<String, f64> = BTreeMap::new();
    let mut before = 0.0;
    for message in messages(&bytes) {
        let time = message.messages(1)[0].number(2) / 1e9;
        for thruster in message.messages(3)[0].messages(6) {
            let thrust = thruster.number(5);
            assert!((0.0..=thruster.number(6)).contains(&thrust));
            *impulses.entry(thruster.text(8).to_owned()).or_default() +=
                thrust * (time - before) / thruster.number(6);
        }
        before = time;
    }
    // On-times of the pitch groups, of which no other axis fires a thruster.
    let (mut plus, mut minus) = (0.0, 0.0);
    for row in rows(&dir, "iss-manoeuvre.mcap", "/jets") {
        let (from, on) =
            (row["time_s"].as_f64().expect("a time"), row["pitch_on_s"].as_f64().expect("a time"));
        let within = on.abs().min(100.0 - from);
        *(if on > 0.0 { &mut plus } else { &mut minus }) += within;
    }
    assert!(plus > 0.1 && minus > 0.1, "{plus} {minus}");
    near(&[impulses["pitch +"], impulses["pitch -"]], &[plus, minus], 1e-6);
}

#[test]
fn runs_without_an_orbit_have_no_planet() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml --set duration=50 --log full").exits(0);
    dir.run("export relay-fixed.mcap -o a.bin").exits(0);
    let bytes = dir.read("a.bin");
    let all = messages(&bytes);
    assert!(all.iter().all(|message| message.all(2).is_empty()));
    let angle = rows(&dir, "relay-fixed.mcap", "/attitude")[0]["angle_rad"].as_f64().expect("an angle");
    near(&all[0].messages(3)[0].list(4), &[0.0, 0.0, (0.25 * angle).tan()], 1e-15);
    dir.run("simulate relay-fixed.toml --set duration=50 --log events --force").exits(0);
    dir.run("export relay-fixed.mcap -o b.bin").exits(2).says(&["no motion", "--log full"]);
    dir.run("export relay-fixed.mcap -o b.glb").exits(2).says(&["no motion", "--log full"]);
    assert!(!dir.has("b.bin") && !dir.has("b.glb"));
}
