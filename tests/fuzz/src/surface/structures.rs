//! Structures: matrices in every kind of file and inline, panels, and tables of modes.

use std::fmt::Write as _;
use std::io::{Cursor, Read, Write};

use zip::write::SimpleFileOptions;

use super::{Seeds, results};
use crate::case::Case;
use crate::chance::Chance;
use crate::mutate;
use crate::nasty;
use crate::node::Node;

const LAW: &str = "duration = 2.0\n[law.relay]\ndead_zone = 2e-3\nhysteresis = 2e-4\nstrong = 1.0\nweak = 0.02\nk_t = 0.33\n";
const MASS: &str = "[[4616.67, 75.0, 137.5, 200.0, 177.5], [75.0, 20.0, 2.5, 0.0, 0.0], [137.5, 2.5, 20.0, 2.5, 0.0], \
    [200.0, 0.0, 2.5, 20.0, 2.5], [177.5, 0.0, 0.0, 2.5, 15.0]]";
const STIFFNESS: &str = "[[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 4160.0, -2560.0, 640.0, 0.0], [0.0, -2560.0, 3840.0, -2560.0, \
    640.0], [0.0, 640.0, -2560.0, 3200.0, -1280.0], [0.0, 0.0, 640.0, -1280.0, 640.0]]";
const MARKET: &str = "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n3 3 4\n1 1 10.0\n2 1 1\n2 2 2.0\n3 3 3.0\n";
const ARRAY: &str = "%%MatrixMarket matrix array real general\n3 3\n10\n1\n0\n1\n2\n0\n0\n0\n3\n";
const MODES: &str = "frequency,damping,displacement,rate,tail.tx,tail.ty,tail.tz,tail.rx,tail.ry,tail.rz,gyro.rx,gyro.ry,gyro.rz\n\
    0.61,0.005,0,0,2.2e-5,4.9e-6,5.1e-4,-4e-6,1.8e-5,2.6e-8,-4e-6,1.8e-5,2.8e-8\n\
    1.48,0.005,0,3.4,7.7e-4,-1.3e-4,-3.9e-4,1.8e-8,-2.3e-5,6.1e-6,1.8e-8,-2.2e-5,5.9e-6\n";
const COMMANDS: &[&str] = &[
    "check s.toml",
    "modes s.toml",
    "modes s.toml --json",
    "simulate s.toml --log none",
    "simulate s.toml -o out",
];
const KEYS: &[&str] = &[
    "drive = \"motion\"",
    "keep = 2",
    "hub = 1",
    "damping = 0.01",
    "damping = [0.1, 0.2, 0.3, 0.4]",
    "rotation = [1, 0, 0, 0, 0]",
    "outputs = [{ name = \"last\", weights = [0, 0, 0, -0.4, 0.4] }]",
    "coordinates = [\"a\", \"b\", \"c\", \"d\", \"e\"]",
];

pub fn make(seeds: &Seeds, chance: &mut Chance) -> Case {
    let command = chance.one(COMMANDS);
    let files = match chance.below(16) {
        0 => vec![scenario(inline(chance))],
        1 => vec![scenario(panels(seeds, chance))],
        2 | 3 => modes(seeds, chance),
        4..10 => results::make(seeds, chance),
        _ => matrices(seeds, chance),
    };
    Case::new(command, files)
}

fn scenario(text: impl Into<Vec<u8>>) -> (String, Vec<u8>) {
    ("s.toml".to_owned(), text.into())
}

/// Matrices within the scenario.
fn inline(chance: &mut Chance) -> String {
    let mut text = body(MASS, STIFFNESS, chance);
    let tree: Result<toml::Table, _> = toml::from_str(&text);
    if let Ok(table) = tree
        && chance.percent(60)
    {
        let mut tree = Node::from(&toml::Value::Table(table));
        for _ in 0..chance.times() {
            mutate::tree(&mut tree, &[], chance);
        }
        return tree.toml();
    }
    for _ in 0..chance.times() {
        mutate::number(&mut text, chance);
    }
    text
}

fn body(mass: &str, stiffness: &str, chance: &mut Chance) -> String {
    let mut text = format!("{LAW}[body.matrices]\nmass = {mass}\nstiffness = {stiffness}\n");
    while chance.percent(40) {
        text += chance.one(KEYS);
        text.push('\n');
    }
    text
}

/// Panels of a shipped scenario.
fn panels(seeds: &Seeds, chance: &mut Chance) -> String {
    let with: Vec<_> = seeds.scenarios.iter().filter(|(_, text, _)| text.contains("[body.panels]")).collect();
    let mut tree = with[chance.below(with.len())].2.clone();
    *tree.key("duration") = Node::Leaf("2.0".to_owned());
    for _ in 0..chance.times() {
        mutate::tree(tree.key("body"), &[], chance);
    }
    tree.toml()
}

/// A table of modes beside a spatial scenario.
fn modes(seeds: &Seeds, chance: &mut Chance) -> Vec<(String, Vec<u8>)> {
    let with: Vec<_> = seeds.scenarios.iter().filter(|(name, ..)| name.starts_with("iss")).collect();
    let mut tree = with[chance.below(with.len())].2.clone();
    *tree.key("duration") = Node::Leaf("2.0".to_owned());
    *tree.key("body").key("spatial").key("modes") = Node::Leaf("\"m.csv\"".to_owned());
    vec![scenario(tree.toml()), ("m.csv".to_owned(), spoilt(MODES, chance))]
}

/// Matrices in files.
fn matrices(seeds: &Seeds, chance: &mut Chance) -> Vec<(String, Vec<u8>)> {
    let comma = |matrix: &str| matrix.replace("], [", "\n").replace(['[', ']'], "");
    let (name, bytes) = match chance.below(6) {
        0 => ("m.csv", spoilt(&comma(MASS), chance)),
        1 => ("m.mtx", spoilt(if chance.percent(60) { MARKET } else { ARRAY }, chance)),
        2 => ("m.mtx", header(chance).into_bytes()),
        _ => ("m.npz", archive(seeds, chance)),
    };
    let array = chance.one(&["", "", "", ":M", ":K", ":data", ":format", ":indices", ":shape", ":x", ":"]);
    let path = if name == "m.npz" { format!("\"{name}{array}\"") } else { format!("\"{name}\"") };
    let text = if chance.percent(70) { body(&path, STIFFNESS, chance) } else { body(MASS, &path, chance) };
    vec![scenario(text), (name.to_owned(), bytes)]
}

/// A text with other lines, numbers or bytes.
pub fn spoilt(text: &str, chance: &mut Chance) -> Vec<u8> {
    let mut text = text.to_owned();
    if chance.percent(25) {
        rewrite(&mut text, chance);
    }
    let change = match chance.below(5) {
        0 => mutate::number,
        1 | 2 => mutate::lines,
        3 => return text.into_bytes(),
        _ => return spoilt_bytes(&text, chance),
    };
    for _ in 0..chance.times() {
        change(&mut text, chance);
    }
    text.into_bytes()
}

/// Writes a text as other programs do: with a byte order mark, other ends of lines, exponents or letters.
pub fn rewrite(text: &mut String, chance: &mut Chance) {
    match chance.below(6) {
        0 => text.insert(0, '\u{feff}'),
        1 => *text = text.replace('\n', "\r\n"),
        2 => *text = text.replace('\n', " \t \n"),
        3 => *text = text.replace('e', "D"),
        4 => *text = text.to_ascii_lowercase(),
        _ => *text = text.to_ascii_uppercase(),
    }
}

fn spoilt_bytes(text: &str, chance: &mut Chance) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..chance.times() {
        mutate::bytes(&mut bytes, chance);
    }
    bytes
}

/// A MatrixMarket file whose header lies.
fn header(chance: &mut Chance) -> String {
    let form = chance.one(&["coordinate", "array", "vector"]);
    let field = chance.one(&["real", "integer", "complex", "pattern", "double"]);
    let symmetry = chance.one(&["general", "symmetric", "skew-symmetric", "hermitian"]);
    let mut text = format!("%%MatrixMarket matrix {form} {field} {symmetry}\n");
    for _ in 0..chance.below(4) {
        text += nasty::number(chance);
        text.push(' ');
    }
    text.push('\n');
    for _ in 0..chance.below(20) {
        let (row, column, element) = (nasty::number(chance), 1 + chance.below(4), nasty::number(chance));
        let _ = writeln!(text, "{row} {column} {element}");
    }
    text
}

/// An archive: a shipped one with other bytes inside its entries, or outside.
fn archive(seeds: &Seeds, chance: &mut Chance) -> Vec<u8> {
    let (_, bytes) = &seeds.archives[chance.below(seeds.archives.len())];
    let mut bytes = bytes.clone();
    if chance.percent(80)
        && let Ok(changed) = repacked(&bytes, chance)
    {
        bytes = changed;
    }
    if chance.percent(30) {
        mutate::bytes(&mut bytes, chance);
    }
    bytes
}

fn repacked(bytes: &[u8], chance: &mut Chance) -> zip::result::ZipResult<Vec<u8>> {
    let mut from = zip::ZipArchive::new(Cursor::new(bytes))?;
    let mut to = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let which = chance.below(from.len());
    for index in 0..from.len() {
        let mut entry = from.by_index(index)?;
        let mut data = Vec::new();
        let _ = entry.read_to_end(&mut data)?;
        if index == which {
            spoil_array(&mut data, chance);
        }
        let method = if chance.percent(50) {
            zip::CompressionMethod::Stored
        } else {
            zip::CompressionMethod::Deflated
        };
        let name = entry.name()?.into_owned();
        to.start_file(name, SimpleFileOptions::default().compression_method(method))?;
        to.write_all(&data)?;
    }
    Ok(to.finish()?.into_inner())
}

/// The header of an array says something else, or its numbers are others.
fn spoil_array(data: &mut Vec<u8>, chance: &mut Chance) {
    let length = data.get(8..10).map_or(0, |b| usize::from(u16::from_le_bytes([b[0], b[1]])));
    if chance.percent(60) && data.len() >= 10 + length {
        let mut header = String::from_utf8_lossy(&data[10..10 + length]).into_owned();
        for _ in 0..chance.times() {
            match chance.below(4) {
                0 => mutate::number(&mut header, chance),
                1 => {
                    let descr = [
                        "'<f8'",
                        "'>f8'",
                        "'<i4'",
                        "'|S3'",
                        "'|S2147483647'",
                        "'<U99999999'",
                        "'|b1'",
                        "'<c16'",
                        "'|O'",
                        "[('a', '<f8')]",
                    ];
                    for old in ["'<f8'", "'<i4'", "'|S3'", "'<i8'"] {
                        header = header.replace(old, chance.one(&descr));
                    }
                }
                2 => {
                    let levels = [1, 30, 100, 5000][chance.below(4)];
                    header = header.replacen('(', &"(".repeat(levels), 1);
                }
                _ => {
                    let mut bytes = header.into_bytes();
                    mutate::bytes(&mut bytes, chance);
                    header = String::from_utf8_lossy(&bytes).into_owned();
                }
            }
        }
        let length = (header.len() as u16).to_le_bytes();
        let rest = data.split_off(10 + usize::from(u16::from_le_bytes([data[8], data[9]])));
        data.truncate(8);
        data.extend(length);
        data.extend(header.into_bytes());
        data.extend(rest);
    } else {
        mutate::bytes(data, chance);
    }
}
