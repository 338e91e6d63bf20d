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
    let deck = deck::read(deck.as_bytes(), &golden("")).map_err(|why| format!("the deck: {why}"))?;
    integrals::modes(frd::read(frd.as_bytes(), &deck.massless)?, &deck, None, points, None)
}

fn file(name: &str, points: &[StructurePoint]) -> FileResults {
    let path = golden(name);
    ResultFormat::from_path(&path).expect("a format").read(&path, None, points, None).expect("modes")
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
        let found = results.mass.expect("a mass").mass;
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
            "the deck: line 231: includes more.inp: No such file",
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
            ResultFormat::Frd.read(&golden(&format!("elements/{kind}.frd")), None, &[], None).expect(kind);
        assert_eq!(results.modes.len(), 6);
        let mass = match kind {
            "b31r" => 2700.0 * 2.0 * 0.02 * 0.03,
            "s3" | "s4r" => 2700.0 * 2.0 * 0.2 * 0.02,
            // Coordinates have six digits.
            _ => 2700.0 * 2.0 * (0.2 + 0.015) * 0.3,
        };
        let found = results.mass.expect("a mass").mass;
        assert!((found / mass - 1.0).abs() < 1e-5, "{kind}: {found} {mass}");
    }
}

/// Returns the results of `run.frd` among files that are written into a directory of their own.
fn modes_of_files(
    files: &[(&str, &str)],
    points: &[StructurePoint],
    centre: [f64; 3],
) -> Result<FileResults, String> {
    static NUMBER: std::sync::atomic::AtomicUsize = std::sync::atomic::AtomicUsize::new(0);
    let number = NUMBER.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    let directory = std::env::temp_dir().join(format!("flexsc-frd-{}-{number}", std::process::id()));
    std::fs::create_dir_all(&directory).expect("a directory");
    for (name, text) in files {
        std::fs::write(directory.join(name), text).expect("a file");
    }
    let read = ResultFormat::Frd.read(&directory.join("run.frd"), None, points, Some(centre));
    std::fs::remove_dir_all(&directory).expect("a directory");
    read
}

#[test]
fn decks_include_files_and_springs() {
    let (frd, deck) = (text("beam.frd"), text("beam.inp"));
    let expected = file("beam.frd", &[]);
    let centre = expected.mass.and_then(|mass| mass.moment.map(|moment| moment.map(|part| part / mass.mass)));
    let centre = centre.expect("a centre");
    let (mesh, rest) = deck.split_at(deck.find("*MATERIAL").expect("a material"));
    let mesh = format!("{mesh}*ELEMENT, TYPE=SPRINGA, ELSET=STRUT\n9001, 1, 2\n");
    let springs = frd.replacen("\n -3", "\n\0", 1).replacen(
        "\n -3",
        "\n -1      9001   11    0    2\n -2         1         2\n -3",
        1,
    );
    let springs = springs.replace("\n\0", "\n -3");
    let files = [
        ("run.frd", springs.as_str()),
        ("run.inp", &format!("*include, Input = \"Mesh 1.inp\"\n{rest}")),
        ("Mesh 1.inp", &mesh),
    ];
    assert_eq!(modes_of_files(&files, &[], centre).expect("modes"), expected);
    let circle = [("run.frd", frd.as_str()), ("run.inp", "*INCLUDE, INPUT=run.inp\n")];
    assert!(modes_of_files(&circle, &[], centre).expect_err("a circle").contains("does one include itself?"));
    let unnamed = [("run.frd", frd.as_str()), ("run.inp", "*INCLUDE\n")];
    assert!(modes_of_files(&unnamed, &[], centre).expect_err("no name").contains("line 1: must name a file"));
}

/// The closed form of a uniform cantilever: w = 1.8751041² sqrt(EI/m)/L², t = 0.7830 sqrt(m), r = 0.5688 sqrt(m) L.
#[test]
fn hollow_beams_have_the_mass_of_their_wall() {
    for (kind, inertia, area) in [
        (
            "pipe",
            std::f64::consts::FRAC_PI_4 * (1.6e-7 - 1.30321e-7),
            std::f64::consts::PI * (0.02 * 0.02 - 0.019 * 0.019),
        ),
        ("box", (0.04 * 2.16e-4 - 0.038 * 1.95112e-4) / 12.0, 0.04 * 0.06 - 0.038 * 0.058),
    ] {
        let results = file(&format!("elements/{kind}.frd"), &[tip([3.0, 0.0, 0.0])]);
        let mass = 1600.0 * area * 3.0;
        let found = results.mass.expect("a mass");
        assert!((found.mass / mass - 1.0).abs() < 1e-6, "{kind}: {} {mass}", found.mass);
        assert!((found.moment.expect("moments")[0] / (1.5 * mass) - 1.0).abs() < 1e-6);
        let largest = |mode: &FileMode| f64::sqrt(mode.translation.iter().map(|part| part * part).sum());
        let stiff = 3.516_015_268_5 * f64::sqrt(1.2e11 * inertia / (1600.0 * area)) / 9.0;
        let mode = results
            .modes
            .iter()
            .min_by(|a, b| (a.frequency - stiff).abs().total_cmp(&(b.frequency - stiff).abs()))
            .expect("modes");
        assert!((mode.frequency / stiff - 1.0).abs() < 0.02, "{kind}: {} {stiff}", mode.frequency);
        assert!((largest(mode) / (0.7830 * f64::sqrt(mass)) - 1.0).abs() < 0.01, "{kind}");
    }
}

#[test]
fn modes_are_about_the_clamp_from_which_the_centre_is_given() {
    let (frd, deck) = (text("beam.frd"), text("beam.inp"));
    let own = file("beam.frd", &[tip([4.0, 0.0, 0.0])]);
    let centre = own
        .mass
        .and_then(|mass| mass.moment.map(|moment| moment.map(|part| part / mass.mass)))
        .expect("a centre");
    // All nodes moved by 3 m along x, in the file and in the deck.
    let shift = |line: &str, from: usize, until: usize| {
        let x: f64 = line[from..until].trim().parse().expect("a number");
        format!("{}{:12.5E}{}", &line[..from], x + 3.0, &line[until..])
    };
    let mut nodes = false;
    let moved: Vec<String> = frd
        .lines()
        .map(|line| {
            nodes = (nodes || line.starts_with("    2C")) && !line.starts_with(" -3");
            if nodes && line.starts_with(" -1") { shift(line, 13, 25) } else { line.to_owned() }
        })
        .collect();
    let mut nodes = false;
    let deck: Vec<String> = deck
        .lines()
        .map(|line| {
            nodes = if line.starts_with('*') {
                line.to_ascii_uppercase().starts_with("*NODE,") || line.eq_ignore_ascii_case("*NODE")
            } else {
                nodes
            };
            match line.split(',').collect::<Vec<_>>()[..] {
                [node, x, y, z] if nodes => {
                    format!("{node},{:e},{y},{z}", x.trim().parse::<f64>().expect("a number") + 3.0)
                }
                _ => line.to_owned(),
            }
        })
        .collect();
    let (moved, deck) = (format!("{}\n", moved.join("\n")), format!("{}\n", deck.join("\n")));
    let files = [("run.frd", moved.as_str()), ("run.inp", deck.as_str())];
    let results = modes_of_files(&files, &[tip([4.0, 0.0, 0.0])], centre).expect("modes");
    for (found, expected) in results.modes.iter().zip(&own.modes) {
        let pairs = found
            .rotation
            .iter()
            .chain(&found.shapes[0][0])
            .zip(expected.rotation.iter().chain(&expected.shapes[0][0]));
        assert!(
            pairs
                .into_iter()
                .all(|(a, b)| (a - b).abs()
                    < 1e-4 * expected.rotation.iter().fold(1.0_f64, |m, r| m.max(r.abs()))),
            "{found:?} {expected:?}"
        );
    }
    // A centre that is at no distance from the clamp: about the origin of the file.
    let far = modes_of_files(&files, &[], centre.map(|part| part + 1.0)).expect("modes");
    let moment = far.mass.and_then(|mass| mass.moment).expect("moments");
    assert!((moment[0] / far.mass.expect("a mass").mass - (centre[0] + 3.0)).abs() < 1e-4);
}
