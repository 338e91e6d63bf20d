//! Results of finite-element programs with lines repeated, removed or swapped, or with other bytes: refused with their line, or
//! read, and never indexed beyond what they hold.

use std::fmt::Write as _;
use std::path::Path;

use flexsc_core::formats::structure::fe::{FileResults, ResultFormat, StructurePoint};

use crate::util::Dir;

fn bytes(name: &str) -> Vec<u8> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/fe"));
    std::fs::read(folder.join(name)).expect("there")
}

fn lines(name: &str) -> Vec<String> {
    String::from_utf8(bytes(name)).expect("text").lines().map(str::to_owned).collect()
}

fn format_of(name: &str) -> ResultFormat {
    ResultFormat::from_path(Path::new(name)).expect("a format")
}

/// Reads the lowest modes of a file with these lines, and of CalculiX's deck.
fn read_lines(
    dir: &Dir,
    format: ResultFormat,
    text: &[String],
    deck: &[String],
) -> Result<FileResults, String> {
    // Few modes and a point, so that all that reads them is reached.
    let points = [StructurePoint { name: "tip".to_owned(), at: [1.0, 0.1, 0.0] }];
    if format.has_shapes() {
        dir.write("results.inp", deck.join("\n") + "\n");
    }
    dir.write("results", text.join("\n") + "\n");
    format.read(&dir.path("results"), Some(2), if format.has_shapes() { &points } else { &[] }, None)
}

/// Reads all modes of a file with these bytes.
fn read_bytes(dir: &Dir, format: ResultFormat, bytes: &[u8]) -> Result<FileResults, String> {
    dir.write("results", bytes);
    format.read(&dir.path("results"), None, &[], None)
}

/// Every text with one line of it changed.
fn damaged(whole: &[String]) -> impl Iterator<Item = Vec<String>> + '_ {
    (0..whole.len()).flat_map(move |place| {
        (0..6).map(move |how| {
            let mut lines = whole.to_vec();
            match how {
                0 => lines.insert(place, whole[place].clone()),
                1 => drop(lines.remove(place)),
                2 => lines.swap(place, (place + 1) % whole.len()),
                3 => lines.swap(place, (place * 7 + 3) % whole.len()),
                // Its first number is another, of the same width.
                4 => {
                    let nines = |c: char| if c.is_ascii_digit() { '9' } else { c };
                    lines[place] = lines[place].chars().map(nines).collect();
                }
                _ => {
                    let half = lines[place].chars().count() / 2;
                    lines[place] = lines[place].chars().take(half).collect();
                }
            }
            lines
        })
    })
}

fn is_sound(results: &FileResults) -> bool {
    let finite = |parts: &[f64]| parts.iter().all(|part| part.is_finite());
    results.mass.is_none_or(|own| own.mass.is_finite())
        && results.modes.iter().all(|mode| {
            mode.frequency.is_finite()
                && finite(&mode.translation)
                && finite(&mode.rotation)
                && finite(&mode.moments.unwrap_or_default().concat())
                && mode.shapes.iter().all(|shape| finite(&shape.concat()))
        })
}

#[test]
fn a_changed_line_is_refused_or_read() {
    let dir = Dir::new();
    let results = ["bars.F06", "feet.F06", "bars-msc.f06", "panel.dat", "boom.dat", "bars.flex"];
    let with_decks = ["elements/s3.frd", "elements/b31r.frd", "elements/c3d4.frd"];
    for name in results.iter().chain(&with_decks) {
        let format = format_of(name);
        let whole = lines(name);
        let deck = name.strip_suffix(".frd").map_or_else(Vec::new, |stem| lines(&format!("{stem}.inp")));
        for text in damaged(&whole) {
            if let Ok(results) = read_lines(&dir, format, &text, &deck) {
                assert!(is_sound(&results), "{name}");
            }
        }
        for deck in damaged(&deck) {
            if let Ok(results) = read_lines(&dir, format, &whole, &deck) {
                assert!(is_sound(&results), "{name}");
            }
        }
    }
}

#[test]
fn what_is_given_twice_is_refused_with_its_line() {
    let dir = Dir::new();
    let [frd, deck] = ["elements/s3.frd", "elements/s3.inp"].map(lines);
    let reported = |format: ResultFormat, text: &[String], deck: &[String]| {
        read_lines(&dir, format, text, deck).expect_err("wrong")
    };
    let again = |lines: &[String], beginning: &str| {
        let place = lines.iter().position(|line| line.starts_with(beginning)).expect("a line");
        let mut lines = lines.to_vec();
        lines.insert(place, lines[place].clone());
        (lines, place + 2)
    };
    let cases = [
        (" -4  DISP", "must follow displacements of all 20 nodes in mode 1, got 0"),
        (" -1        11 0.0", "must have each node once, got node 11 again"),
        (" -1         2    2", "must have 6 nodes, got 0"),
    ];
    for (beginning, why) in cases {
        let (text, line) = again(&frd, beginning);
        let error = reported(ResultFormat::Frd, &text, &deck);
        assert!(error.contains(why) && error.contains("line "), "{error}");
        assert!(error.contains(&format!("line {line}: ")) || why.contains("6 nodes"), "{error}");
    }
    // A whole element, and nodes after the displacements of a mode.
    let element = frd.iter().position(|line| line.starts_with(" -1         2    2")).expect("an element");
    let mut text = frd.clone();
    drop(text.splice(element..element, frd[element..element + 2].to_vec()));
    assert!(
        reported(ResultFormat::Frd, &text, &deck)
            .contains("must have each element once, got element 2 again")
    );
    let nodes = frd.iter().position(|line| line.starts_with("    2C")).expect("nodes");
    let mut text = frd.clone();
    let end = text.len() - 1;
    drop(
        text.splice(end..end, [frd[nodes].clone(), frd[nodes + 1].replace(" 11 ", " 99 "), " -3".to_owned()]),
    );
    assert!(
        reported(ResultFormat::Frd, &text, &deck)
            .contains("must have its nodes before elements and displacements")
    );
    let (twice, line) = again(&deck, "3, 2, 5, 6");
    let error = reported(ResultFormat::Frd, &frd, &twice);
    assert!(
        error.starts_with("the deck ")
            && error.contains(&format!(
                "results.inp: line {line}: must have each element once, got element 3 again"
            )),
        "{error}"
    );
    // An element of a matrix twice, in the place of another.
    let mut flex = lines("bars.flex");
    let row = flex.iter().position(|line| line.starts_with("1 1 ")).expect("a row");
    flex[row] = flex[row - 1].clone();
    let error = reported(ResultFormat::Flex, &flex, &[]);
    assert!(
        error.contains(&format!("line {}: must have each element of its section once", row + 1)),
        "{error}"
    );
}

#[test]
fn sets_within_sets_are_read_once() {
    let dir = Dir::new();
    let [results, mut deck] = ["elements/s3.frd", "elements/s3.inp"].map(lines);
    let mass = |deck: &[String]| read_lines(&dir, ResultFormat::Frd, &results, deck).map(|read| read.mass);
    let without = mass(&deck).expect("a deck").expect("a mass").mass;
    let links = 20_000;
    let mut sets = "*ELEMENT, TYPE=MASS, ELSET=S0\n99, 9\n".to_owned();
    for link in 1..=links {
        write!(sets, "*ELSET, ELSET=S{link}\nS{}\n", link - 1).expect("memory");
    }
    let place = deck.iter().position(|line| line.starts_with("*MATERIAL")).expect("a material");
    // So little that the shapes are still those of the deck.
    let one = format!("*MASS, ELSET=S{links}\n2e-9");
    deck.insert(place, sets + &one);
    let with = mass(&deck).expect("a deck").expect("a mass").mass;
    assert!(((with - without) / 2e-9 - 1.0).abs() < 1e-5, "{with} {without}");
    deck.insert(place + 1, vec![one; 600].join("\n"));
    let error = mass(&deck).expect_err("long");
    assert!(error.contains("must have at most 10000000 members of sets of point masses"), "{error}");
}

/// Generator of pseudo-random numbers.
struct Draws(u64);

impl Draws {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % most
    }
}

#[test]
fn damaged_files_are_refused_or_read_and_never_crash() {
    let dir = Dir::new();
    // Only CalculiX's results have a deck.
    dir.write("results.inp", bytes("boom.inp"));
    let mut draws = Draws(7);
    for name in ["bars.F06", "feet.F06", "bars-msc.f06", "pages-nx.f06", "panel.dat", "bars.flex", "boom.frd"]
    {
        let format = format_of(name);
        let whole = bytes(name);
        let sound = read_bytes(&dir, format, &whole).ok();
        for _ in 0..200 {
            // Results of a cut file must equal those of the complete one.
            if let Ok(results) = read_bytes(&dir, format, &whole[..draws.below(whole.len())]) {
                assert_eq!(Some(&results.modes), sound.as_ref().map(|sound| &sound.modes), "{name}");
            }
            let mut swapped = whole.clone();
            for _ in 0..=draws.below(4) {
                let (a, b) = (draws.below(whole.len()), draws.below(whole.len()));
                swapped.swap(a, b);
                let place = draws.below(whole.len());
                swapped[place] ^= if draws.below(3) == 0 { draws.below(256) as u8 } else { 0 };
            }
            if let Ok(results) = read_bytes(&dir, format, &swapped) {
                assert!(results.modes.iter().all(|mode| mode.frequency.is_finite()), "{name}");
            }
        }
    }
    let long = vec![b'1'; 10_000];
    assert!(read_bytes(&dir, ResultFormat::F06, &long).expect_err("long").contains("is this a text file"));
}
