//! Tests with real files of shapes and their decks: participations, first moments, the motion of points, and errors of
//! broken files.

use std::path::{Path, PathBuf};

use super::*;

fn golden(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/fe")).join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(golden(name)).expect("there")
}

/// Returns the rows of a structure in a table.
fn rows(table: &str, structure: &str) -> Vec<Vec<f64>> {
    let row = |row: &str| row.split(',').map(|field| field.parse().expect("a number")).collect();
    text(table).lines().filter_map(|line| line.strip_prefix(&format!("{structure},"))).map(row).collect()
}

fn read(frd: &str, deck: &str, points: &[StructurePoint]) -> Result<FileResults, String> {
    let deck = deck::read(deck.as_bytes()).map_err(|why| format!("the deck: {why}"))?;
    integrals::modes(frd::read(frd.as_bytes())?, &deck, None, points)
}

fn file(name: &str, points: &[StructurePoint]) -> FileResults {
    let path = golden(name);
    ResultFormat::from_path(&path).expect("a format").read(&path, None, points).expect("modes")
}

fn tip(position: [f64; 3]) -> StructurePoint {
    StructurePoint { name: "tip".to_owned(), at: position }
}

#[test]
fn first_moments_follow_from_shapes_and_masses() {
    for (structure, mass) in [("boom", 14.8), ("beam", 3.66), ("panel", 42.48)] {
        let results = file(&format!("{structure}.frd"), &[]);
        let expected = rows("expected.csv", structure);
        assert_eq!(results.modes.len(), expected.len());
        let found = results.mass.expect("a mass");
        assert!((found / mass - 1.0).abs() < 1e-12, "{structure}: {found}");
        for (mode, row) in results.modes.iter().zip(&expected) {
            assert!((mode.frequency / row[0] - 1.0).abs() < 1e-6, "{structure}");
            let moments = mode.moments.expect("first moments").concat();
            let largest = row[4..].iter().fold(0.0_f64, |most, part| most.max(part.abs()));
            for (axis, part) in mode.translation.iter().enumerate() {
                assert!((part - row[1 + axis]).abs() < 1e-6 * f64::sqrt(mass), "{structure}: {part} {row:?}");
            }
            for (part, expected) in mode.rotation.iter().chain(&moments).zip(&row[4..]) {
                assert!((part - expected).abs() < 1e-6 * largest, "{structure}: {part} {expected}");
            }
        }
    }
}

#[test]
fn points_move_as_the_structure_at_their_place() {
    // The mean of the nodes of an end face is its centre, except for the warping of the face.
    for (structure, position, displacement, rotation) in
        [("boom", [3.05, 1.25, 2.1], 1e-3, 2e-3), ("beam", [4.0, 0.0, 0.0], 2e-5, 1e-4)]
    {
        let results = file(&format!("{structure}.frd"), &[tip(position)]);
        let mut worst = [0.0_f64; 2];
        for (mode, row) in results.modes.iter().zip(rows("tips.csv", structure)) {
            for (half, error) in worst.iter_mut().enumerate() {
                let expected = &row[3 * half..3 * half + 3];
                let largest = expected.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
                for (part, expected) in mode.shapes[0][half].iter().zip(expected) {
                    *error = error.max((part - expected).abs() / largest);
                }
            }
        }
        assert!(worst[0] < displacement && worst[1] < rotation, "{structure}: {worst:?}");
    }
    // At the position of a node, a point has the displacement of that node.
    let results = file("panel.frd", &[tip([6.0, 0.0, 0.0])]);
    assert!((results.modes[0].shapes[0][0][2] - 0.326_269).abs() < 1e-12);
    let error = read(&text("boom.frd"), &text("boom.inp"), &[tip([1.0, 1.0, 0.0])]).expect_err("outside");
    assert!(error.contains("an element at point `tip`, and has none at [1, 1, 0]"), "{error}");
}

#[test]
fn errors_name_line_and_field() {
    let (frd, deck) = (text("boom.frd"), text("boom.inp"));
    let beam = |from: &str, to: &str| {
        let deck = text("beam.inp");
        assert!(deck.contains(from), "{from}");
        read(&text("beam.frd"), &deck.replacen(from, to, 1), &[]).expect_err(to)
    };
    let in_frd = |from: &str, to: &str| {
        assert!(frd.contains(from), "{from}");
        read(&frd.replacen(from, to, 1), &deck, &[]).expect_err(to)
    };
    let in_deck = |from: &str, to: &str| {
        assert!(deck.contains(from), "{from}");
        read(&frd, &deck.replacen(from, to, 1), &[]).expect_err(to)
    };
    let cases = [
        (in_frd("6.29607E-04", "6.2960*E-04"), "line 263: `D1` must be a finite number, got `6.2960*E-04`"),
        (
            in_frd("\n    1PMODE                         2", "\n    1PMODE                         1"),
            "line 457: must have one step",
        ),
        (
            in_frd("1PGK                3.876851E+01", "1PGK                3.976851E+01"),
            "line 256: mode 1 must have one frequency",
        ),
        (
            in_frd("    1PGK                3.876851E+01", "    1PGX                3.876851E+01"),
            "line 256: must follow lines `1PGM`",
        ),
        (
            in_frd(" -4  DISP        4    1", " -4  DOSP        4    1"),
            "line 457: must begin with mode 1, got mode 2",
        ),
        (
            in_frd(" -1         1    4    0    1", " -1         1   12    0    1"),
            "line 204: `type` must be that of a solid, 1 to 6, got 12: write",
        ),
        (
            in_frd(" -2        11        12", " -2       911        12"),
            "line 206: element 1 must have nodes of the file, got 911",
        ),
        (in_frd("        15        16\n", "        15\n"), "line 204: element 1 must have 20 nodes, got 19"),
        (in_frd("\n 9999", "\n"), "must end with a line 9999"),
        (
            in_frd("1UMAT    1LIGHT", "1UMAT    3LIGHT"),
            "line 204: element 1 must have a material of the file, got 1",
        ),
        (
            in_deck("*DENSITY\n200.", "*DENSITY\n-200."),
            "the deck: line 235: `density` must be positive, got -200",
        ),
        (in_deck("*DENSITY\n200.", "*DENSITY\n300."), "normalised by the mass of the deck"),
        (in_deck("*DENSITY\n200.\n", ""), "line 204: element 1 must have a *DENSITY of LIGHT in the deck"),
        (in_deck("TYPE=C3D20,", "TYPE=C3D20X,"), "the deck: line 191: `TYPE` must be one of C3D20"),
        (in_deck("TYPE=C3D20,", "TYPE=C3D20R,"), "normalised by the mass of the deck"),
        (
            in_deck("*MASS, ELSET=TIP\n0.5", "*MASS, ELSET=TIP\nhalf"),
            "the deck: line 228: `mass` must be a finite number, got `half`",
        ),
        (in_deck("*MASS, ELSET=TIP", "*MASS, ELSET=TAP"), "the deck: line 228: must have a set TAP"),
        (
            in_deck("*MATERIAL", "*INCLUDE, INPUT=more.inp\n*MATERIAL"),
            "the deck: line 231: must have no *INCLUDE",
        ),
        (in_deck("16, 177", "16, 977"), "line 223 of the deck: must have a node of the deck, got 977"),
        (beam("*MASS, ELSET=TIP\n1.5", "*MASS, ELSET=TIP\n1.4"), "normalised by the mass of the deck"),
    ];
    for (error, why) in cases {
        assert!(error.contains(why), "{why}: {error}");
    }
    // Node order of a deck in place of that of the format.
    let mut mixed = frd.clone();
    for line in frd.lines().filter(|line| line.starts_with(" -2") && line.len() == 103) {
        let order = [0, 1, 6, 7, 8, 9, 2, 3, 4, 5].map(|place| &line[3 + 10 * place..13 + 10 * place]);
        let from_second = frd[..frd.find(line).expect("there")].lines().count() % 2 == 1;
        if from_second {
            mixed = mixed.replacen(line, &format!(" -2{}", order.concat()), 1);
        }
    }
    let error = read(&mixed, &deck, &[]).expect_err("another order");
    assert!(error.contains("turned inside out") || error.contains("normalised by the mass"), "{error}");
}

#[test]
fn sets_of_masses_may_be_written_anyhow() {
    let (frd, deck) = (text("boom.frd"), text("boom.inp"));
    let sound = read(&frd, &deck, &[]).expect("modes");
    let variants = [
        ("*ELEMENT, TYPE=MASS, ELSET=TIP", "*Element,\n type = mass"),
        ("*MASS, ELSET=TIP", "*ELSET, ELSET=TIP, GENERATE\n16, 19, 1\n*mass, elset=tip"),
    ];
    let generated = variants.iter().fold(deck.clone(), |deck, (from, to)| deck.replacen(from, to, 1));
    assert_eq!(read(&frd, &generated, &[]).expect("modes"), sound);
    let within = deck.replacen("*MASS, ELSET=TIP", "*ELSET, ELSET=ALL\nTIP, 1\n*MASS, ELSET=ALL", 1);
    assert_eq!(read(&frd, &within, &[]).expect("modes"), sound);
}

#[test]
fn every_kind_of_element_weighs_what_the_run_took_it_to_weigh() {
    // Block of 2 m by 0.2 m (skewed) by 0.3 m: 6 modes of each element kind, normalised with only one rule of
    // integration.
    for kind in ["c3d4", "c3d6", "c3d8", "c3d8r", "c3d10", "c3d15", "c3d20r", "s3", "s4r", "b31r"] {
        let results =
            ResultFormat::Frd.read(&golden(&format!("elements/{kind}.frd")), None, &[]).expect(kind);
        assert_eq!(results.modes.len(), 6);
        let mass = match kind {
            "b31r" => 2700.0 * 2.0 * 0.02 * 0.03,
            "s3" | "s4r" => 2700.0 * 2.0 * 0.2 * 0.02,
            // Coordinates have six digits.
            _ => 2700.0 * 2.0 * (0.2 + 0.015) * 0.3,
        };
        let found = results.mass.expect("a mass");
        assert!((found / mass - 1.0).abs() < 1e-5, "{kind}: {found} {mass}");
    }
}
