//! Results with lines repeated, removed or swapped, or with other fields: refused with their line, or read, and never indexed
//! beyond what they hold.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::*;

fn golden(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/fe")).join(name)
}

fn lines(name: &str) -> Vec<String> {
    std::fs::read_to_string(golden(name)).expect("there").lines().map(str::to_owned).collect()
}

fn parse(format: ResultFormat, text: &[String], deck: &[String]) -> Result<FileResults, String> {
    let text = text.join("\n") + "\n";
    let text = text.as_bytes();
    // Few modes and a point, so that all that reads them is reached.
    let keep = Some(2);
    match format {
        ResultFormat::F06 => f06::read(text, keep),
        ResultFormat::CalculiX => calculix::read(text, keep),
        ResultFormat::Flex => flex::read(text, keep),
        ResultFormat::Frd => {
            let deck = deck.join("\n") + "\n";
            let deck = deck::read(deck.as_bytes()).map_err(|why| format!("the deck: {why}"))?;
            let point = StructurePoint { name: "tip".to_owned(), at: [1.0, 0.1, 0.0] };
            integrals::modes(frd::read(text)?, &deck, keep, &[point])
        }
    }
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
    results.mass.is_none_or(f64::is_finite)
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
    let results = ["bars.F06", "feet.F06", "bars-msc.f06", "panel.dat", "boom.dat", "bars.flex"];
    let with_decks = ["elements/s3.frd", "elements/b31r.frd", "elements/c3d4.frd"];
    for name in results.iter().chain(&with_decks) {
        let format = ResultFormat::from_path(Path::new(name)).expect("a format");
        let whole = lines(name);
        let deck = name.strip_suffix(".frd").map_or_else(Vec::new, |stem| lines(&format!("{stem}.inp")));
        for text in damaged(&whole) {
            if let Ok(results) = parse(format, &text, &deck) {
                assert!(is_sound(&results), "{name}");
            }
        }
        for deck in damaged(&deck) {
            if let Ok(results) = parse(format, &whole, &deck) {
                assert!(is_sound(&results), "{name}");
            }
        }
    }
}

#[test]
fn what_is_given_twice_is_refused_with_its_line() {
    let [frd, deck] = ["elements/s3.frd", "elements/s3.inp"].map(lines);
    let reported = |format: ResultFormat, text: &[String], deck: &[String]| {
        parse(format, text, deck).expect_err("wrong")
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
        error.contains(&format!("the deck: line {line}: must have each element once, got element 3 again")),
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
    let links = 20_000;
    let mut deck = "*ELEMENT, TYPE=MASS, ELSET=S0\n1, 1\n".to_owned();
    for link in 1..=links {
        writeln!(deck, "*ELSET, ELSET=S{link}\nS{}", link - 1).expect("memory");
    }
    let one = format!("{deck}*MASS, ELSET=S{links}\n2.0\n");
    assert_eq!(deck::read(one.as_bytes()).expect("a deck").masses[0].mass, 2.0);
    let many = deck + &format!("*MASS, ELSET=S{links}\n2.0\n").repeat(600);
    let error = deck::read(many.as_bytes()).expect_err("long");
    assert!(error.contains("must have at most 10000000 members of sets of point masses"), "{error}");
}
