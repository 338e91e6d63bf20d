//! Results of finite-element programs beside a scenario with an appendage that fits them.

use std::path::Path;

use super::{Seeds, structures};
use crate::chance::Chance;

/// Formats of results. Their decks end with `inp`.
const FORMATS: [&str; 5] = ["f06", "F06", "dat", "frd", "flex"];

/// Appendages by the begin of a file's name: mass, centre, inertia.
const FITS: &[(&str, &str)] = &[
    ("solar", PANEL),
    ("s3", PANEL),
    ("s4r", "mass = 21.6\ncentre = [1, 0.1, 0]\ninertia = [[1, 0, 0], [0, 7.2, 0], [0, 0, 8]]"),
    ("b31r", "mass = 3.24\ncentre = [1, 0, 0]\ninertia = [[1, 0, 0], [0, 1.2, 0], [0, 0, 1.3]]"),
    ("c3d", "mass = 348.3\ncentre = [1, 0, 0]\ninertia = [[20, 0, 0], [0, 120, 0], [0, 0, 120]]"),
    ("beam", "mass = 3.66\ncentre = [2.82, 0, 0]\ninertia = [[9e-5, 0, 0], [0, 6.42, 0], [0, 0, 6.42]]"),
    ("panel", "mass = 42.48\ncentre = [3, 0, 0]\ninertia = [[60, 0, 0], [0, 140, 0], [0, 0, 190]]"),
    ("boom", BOOM),
    ("", BOOM),
];
const PANEL: &str =
    "mass = 18.0\ncentre = [3.0, 0, 0]\ninertia = [[1.515, 0, 0], [0, 54.015, 0], [0, 0, 55.5]]";
const BOOM: &str = "mass = 14.4\ncentre = [2.375, 0.266666667, 0.888888889]\n\
    inertia = [[14.79422, -2.4, -8.0], [-2.4, 24.34722, -4.266667], [-8.0, -4.266667, 15.697]]";

/// Whether a file is a result or a deck.
pub fn is_one(name: &str) -> bool {
    let extension = Path::new(name).extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|extension| extension == "inp" || FORMATS.contains(&extension))
}

/// A scenario, results with something else in them, and their deck where there is one.
pub fn make(seeds: &Seeds, chance: &mut Chance) -> Vec<(String, Vec<u8>)> {
    let results: Vec<_> = seeds
        .results
        .iter()
        .filter(|(name, _)| Path::new(name).extension().is_none_or(|ending| ending != "inp"))
        .collect();
    let (name, bytes) = results[chance.below(results.len())];
    let (path, extension) = name.rsplit_once('.').unwrap_or((name, ""));
    let stem = path.rsplit('/').next().unwrap_or(path);
    let text = String::from_utf8_lossy(bytes);
    let deck = seeds.results.iter().find(|(name, _)| *name == format!("{path}.inp"));
    let deck = deck.map(|(_, bytes)| String::from_utf8_lossy(bytes)).filter(|_| extension == "frd");
    // One of the two is spoilt, seldom both.
    let in_deck = deck.is_some() && chance.percent(30);
    let spoil = |text: &str, yes: bool, chance: &mut Chance| {
        if yes || chance.percent(10) { structures::spoilt(text, chance) } else { text.as_bytes().to_vec() }
    };
    let file = format!("m.{extension}");
    let mut files = vec![
        ("s.toml".to_owned(), scenario(stem, &file, chance).into_bytes()),
        (file, spoil(&text, !in_deck, chance)),
    ];
    if let Some(deck) = deck {
        files.push(("m.inp".to_owned(), spoil(&deck, in_deck, chance)));
    }
    files
}

fn scenario(stem: &str, file: &str, chance: &mut Chance) -> String {
    let fits = FITS.iter().find(|(begin, _)| stem.starts_with(begin)).map_or(BOOM, |(_, fits)| fits);
    let keep = chance.one(&["", "keep = 1\n", "keep = 3\n", "keep = 3\n"]);
    let points = chance.one(&["", "points = [{ name = \"tip\", position = [1, 0.1, 0] }]\n"]);
    format!(
        "duration = 2.0\n[spacecraft]\nmass = 900.0\ninertia = [[900, 0, 0], [0, 800, 0], [0, 0, 700]]\n\
         [[appendage]]\nname = \"a\"\n{fits}\nat = [0.4, 0.1, -0.2]\n{keep}{points}modes = \"{file}\"\ndamping = 0.01\n\
         [law.pd]\nk_p = 1.0\nk_d = 20.0\nperiod = 0.5\n"
    )
}
