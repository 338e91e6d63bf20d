//! Packets to a run in lockstep: of every kind, whole or not, of this session and cycle or others, over UDP and TCP.

use std::fmt::Write as _;

use crate::case::{Case, PACKETS};
use crate::chance::Chance;
use crate::{mutate, nasty};

/// Scenarios of 20 and 24 cycles: three axes with jets and wheels, and one axis.
const RUNS: [(&str, &str); 2] = [
    (include_str!("../../../../scenarios/earth-observer.toml"), "--set duration=5"),
    (include_str!("../../../../scenarios/wheel-fixed-gain.toml"), "--set duration=6"),
];
/// Kinds of packets with their telecommand bit: those of clients, of the server, and others.
const KINDS: [u16; 12] =
    [0x12F0, 0x12F3, 0x12F5, 0x12F5, 0x12F5, 0x12F7, 0x02F0, 0x02F1, 0x02F4, 0x1AF5, 0x32F5, 0x12F8];

pub fn make(chance: &mut Chance) -> Case {
    let (scenario, duration) = RUNS[chance.below(RUNS.len())];
    let mut script = String::new();
    if chance.percent(85) {
        script += "hello\n";
    }
    for _ in 0..=chance.below(10) {
        line(&mut script, chance);
    }
    let transport = chance.one(&["--tcp", "--udp"]);
    let pace = chance.one(&["", "", "--pace step"]);
    let log = chance.one(&["--log none", "-o l.mcap", "--log full -o l.mcap"]);
    Case::new(
        &format!("serve s.toml {transport} --bind 127.0.0.1:0 --timeout 0.1 {duration} {pace} {log}"),
        vec![("s.toml".to_owned(), scenario.as_bytes().to_vec()), (PACKETS.to_owned(), script.into_bytes())],
    )
}

fn line(script: &mut String, chance: &mut Chance) {
    let _ = match chance.below(20) {
        0..4 => writeln!(script, "answer {} {}", quantity(chance), value(chance)),
        4 => writeln!(script, "hello"),
        5 => writeln!(script, "request"),
        6 => writeln!(script, "{}", chance.one(&["farewell", "farewell", "wait", "wait", "open"])),
        7..9 => writeln!(script, "wait"),
        9..12 => writeln!(script, "raw {}", hexadecimal(&whole(chance))),
        12..14 => writeln!(script, "raw {}", hexadecimal(&noise(chance))),
        14..17 => {
            let (cycle, quantity) = (nasty::whole(chance, 0), quantity(chance));
            let axes = [1, 3, 3, 0, 4, 200][chance.below(6)];
            let value: f64 = value(chance).parse().unwrap_or(0.0);
            let cycle = if chance.percent(60) { "C".to_owned() } else { format!("{cycle:016x}") };
            let quantities = format!("{quantity:02x}").repeat(axes);
            let values = format!("{:016x}", value.to_bits()).repeat(axes);
            writeln!(script, "packet 12f500000000 S {cycle} {quantities} {values}")
        }
        _ => writeln!(script, "packet {}", hexadecimal(&whole(chance))),
    };
}

fn quantity(chance: &mut Chance) -> u8 {
    [0, 0, 2, 2, 1, 3, 4, 255][chance.below(8)]
}

/// A value, most often a small one.
fn value(chance: &mut Chance) -> &'static str {
    if chance.percent(60) { chance.one(&["0", "1e-4", "-1e-4", "0.01"]) } else { nasty::number(chance) }
}

/// A packet with a header of some kind; its content is random, or that of a hello.
fn whole(chance: &mut Chance) -> Vec<u8> {
    let mut packet = KINDS[chance.below(KINDS.len())].to_be_bytes().to_vec();
    packet.extend([[0xC0, 0], [0x40, 0], [0, 0], [0xFF, 0xFF]][chance.below(4)]);
    packet.extend((nasty::whole(chance, 19) as u16).to_be_bytes());
    let length = [0, 1, 4, 12, 18, 21, 39, 80, 1400][chance.below(9)];
    if chance.percent(30) {
        packet.extend([0, 0, 0, 0, 1, 2, 3, 4, 0, 1]);
        packet.extend(nasty::whole(chance, 0).to_be_bytes());
    } else {
        packet.extend((0..length).map(|_| chance.number() as u8));
    }
    if chance.percent(20) {
        mutate::bytes(&mut packet, chance);
    }
    packet.truncate(70_000);
    packet
}

/// Bytes that are no packet.
fn noise(chance: &mut Chance) -> Vec<u8> {
    let length = [0, 1, 5, 6, 7, 8, 50, 1400, 60_010, 65_507, 65_600][chance.below(11)];
    (0..length).map(|_| chance.number() as u8).collect()
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
