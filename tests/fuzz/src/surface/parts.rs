//! Parts of a campaign: other bytes inside a Parquet file, which holds their checksum or not.

use std::io;
use std::path::Path;

use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, Design, Manifest, RowMaker};
use flexsc_core::metrics::Selection;
use flexsc_core::numerics::random::fnv1a_of;

use crate::case::Case;
use crate::chance::Chance;
use crate::mutate;

/// A short scenario with lists, words and integers among its metrics.
const SCENARIO: &str = "duration = 60.0\n[body.planar]\nangle = 4.5e-4\n\
    modes = [{ frequency = 0.44, gain = 0.0213, displacement = 2.75e-6 }]\n\
    [law.relay]\ndead_zone = 5e-4\nhysteresis = 1e-4\nstrong = 4e-5\nweak = 1e-6\nk_t = 0.31\n\
    [uncertain]\n\"law.relay.k_t\" = { uniform = [0.3, 0.32] }\n";
const RUNS: u64 = 12;
const COMMANDS: &[&str] = &[
    "top c --json",
    "plot c -o out --format svg",
    "plot c --json --worst 2",
    "merge c -o m",
    "merge c -o m.csv",
    "simulate s.toml --runs 12 -o c",
];
/// Bytes before the digits of the checksum.
const BEFORE: &[u8] = b"flexsc.checksum\x18\x10";
const DIGITS: usize = 16;

/// The files of a whole campaign; the part is the last one.
pub fn seeds() -> io::Result<Vec<(String, Vec<u8>)>> {
    let scenario = Scenario::parse("s.toml", SCENARIO).map_err(io::Error::other)?;
    let campaign = Campaign::from_design(scenario, "s.toml", Design::default()).map_err(io::Error::other)?;
    let manifest = Manifest::new(&campaign, 0..RUNS, &Selection::ALL).map_err(io::Error::other)?;
    let text = manifest.to_toml();
    let work = RowMaker::from_manifest(manifest, Path::new("manifest.toml")).map_err(io::Error::other)?;
    let (name, part) = work.part(0..RUNS, 1, ()).map_err(io::Error::other)?;
    Ok(vec![
        ("s.toml".to_owned(), SCENARIO.into()),
        ("c/manifest.toml".to_owned(), text.into_bytes()),
        (format!("c/runs/{name}"), part),
    ])
}

pub fn make(files: &[(String, Vec<u8>)], chance: &mut Chance) -> Case {
    let mut files = files.to_vec();
    if let Some((_, part)) = files.last_mut() {
        for _ in 0..chance.times() {
            change(part, chance);
        }
        // Else all of it would be refused at the checksum.
        if chance.percent(90) {
            seal(part);
        }
    }
    Case::new(chance.one(COMMANDS), files)
}

/// Another byte, in the footer more often than in the pages, or bytes that are added, removed or moved.
fn change(part: &mut Vec<u8>, chance: &mut Chance) {
    if part.len() < 16 || chance.percent(15) {
        return mutate::bytes(part, chance);
    }
    let end = part.len() - 8;
    let length = part[end..end + 4].iter().rev().fold(0, |length, byte| length << 8 | usize::from(*byte));
    let from = if chance.percent(70) { end.saturating_sub(length) } else { 4 };
    let place = from + chance.below(end + 4 - from);
    part[place] = match chance.below(4) {
        0 => part[place] ^ (1 << chance.below(8)),
        1 => [0x00, 0x01, 0x7f, 0x80, 0xff][chance.below(5)],
        2 => part[place].wrapping_add(1),
        _ => chance.below(256) as u8,
    };
}

/// Gives a part the checksum of its bytes, if it has a place for one.
fn seal(part: &mut [u8]) {
    let Some(before) = part.windows(BEFORE.len()).rposition(|window| window == BEFORE) else { return };
    let from = before + BEFORE.len();
    if from + DIGITS <= part.len() {
        let sum = format!("{:016x}", fnv1a_of(&[&part[..from], &part[from + DIGITS..]]));
        part[from..from + DIGITS].copy_from_slice(sum.as_bytes());
    }
}
