//! Tests with real files of finite-element programs, and errors of broken files.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::*;

fn golden(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/fe")).join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(golden(name)).expect("there")
}

fn parse(format: ResultFormat, text: &[u8], keep: Option<usize>) -> Result<FileResults, String> {
    match format {
        ResultFormat::F06 => f06::read(text, keep),
        ResultFormat::CalculiX => calculix::read(text, keep),
        ResultFormat::Flex => flex::read(text, keep),
        ResultFormat::Frd => {
            let deck = deck::read(&bytes("boom.inp")[..], &golden(""))?;
            integrals::modes(frd::read(text, &deck.massless)?, &deck, keep, &[], None)
        }
    }
}

fn file(name: &str) -> FileResults {
    let path = golden(name);
    ResultFormat::from_path(&path).expect("a format").read(&path, None, &[], None).expect("modes")
}

/// Returns the modes of a structure from an independent computation: frequency, t, r, r phi'.
fn expected(structure: &str) -> Vec<[f64; 16]> {
    let text = String::from_utf8(bytes("expected.csv")).expect("text");
    let rows = text.lines().filter_map(|line| line.strip_prefix(&format!("{structure},")));
    let row = |row: &str| row.split(',').map(|field| field.parse().expect("a number")).collect::<Vec<f64>>();
    rows.map(|line| row(line).try_into().expect("16 numbers")).collect()
}

/// Returns the largest deviations in frequency (relative), of t in sqrt(mass) and of r in sqrt(inertia).
fn deviations(modes: &[FileMode], structure: &str, mass: f64, inertia: f64) -> [f64; 3] {
    let expected = expected(structure);
    let mut worst = [0.0_f64; 3];
    for (mode, row) in modes.iter().zip(&expected) {
        worst[0] = worst[0].max((mode.frequency / row[0] - 1.0).abs());
        for axis in 0..3 {
            worst[1] = worst[1].max((mode.translation[axis] - row[1 + axis]).abs() / mass.sqrt());
            worst[2] = worst[2].max((mode.rotation[axis] - row[4 + axis]).abs() / inertia.sqrt());
        }
    }
    assert!(modes.len() <= expected.len());
    worst
}

#[test]
fn participations_are_those_of_shapes_and_masses() {
    // CalculiX omits the mass between clamped and free nodes: a coarse panel has t to 3e-3.
    let cases = [
        ("bars.F06", "bars", 14.4, 116.95, [1e-7, 3e-7, 2e-7]),
        ("barsmax.F06", "barsmax", 14.4, 116.95, [1e-7, 3e-7, 2e-7]),
        ("bars-msc.f06", "bars", 14.4, 116.95, [1e-7, 3e-7, 2e-7]),
        ("bars.flex", "bars", 14.4, 116.95, [2e-7, 3e-7, 2e-7]),
        ("boom.dat", "boom", 14.8, 125.914, [1e-7, 1e-3, 1e-6]),
        ("beam.dat", "beam", 3.66, 35.52, [1e-7, 1e-3, 2e-6]),
        ("panel.dat", "panel", 42.48, 447.547, [1e-7, 3e-3, 1.4e-4]),
    ];
    for (name, structure, mass, inertia, bounds) in cases {
        let results = file(name);
        let worst = deviations(&results.modes, structure, mass, inertia);
        assert!(worst.iter().zip(bounds).all(|(found, bound)| *found <= bound), "{name}: {worst:?}");
        assert!(
            results.mass.is_none_or(|found| (found.mass / mass - 1.0).abs() < 0.02),
            "{name}: {:?}",
            results.mass
        );
    }
}

#[test]
fn the_first_moments_of_42_are_turned_over() {
    let results = file("bars.flex");
    assert_eq!(results.modes.len(), 4);
    for (mode, row) in results.modes.iter().zip(expected("bars")) {
        let moments = mode.moments.expect("first moments").concat();
        let largest = row[7..].iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        for (found, expected) in moments.iter().zip(&row[7..]) {
            assert!((found - expected).abs() < 1e-6 * largest, "{found} {expected}");
        }
        assert!((mode.damping.expect("damping") - 0.005).abs() < 1e-8);
    }
}

#[test]
fn matrices_of_42_that_are_not_diagonal_are_solved() {
    // Modes q of bars, in coordinates p with q = A p: M = A'A, K = A' W² A, C = A' D A, and Pf, Hf and L times A.
    let text = String::from_utf8(bytes("bars.flex")).expect("text");
    let rows = expected("bars");
    let a = [[1.0, 0.5, 0.0, 0.0], [0.0, 2.0, 0.0, 0.3], [0.2, 0.0, 1.0, 0.0], [0.0, 0.0, -0.4, 3.0]];
    let through = |column: &dyn Fn(usize) -> f64, j: usize| (0..4).map(|i| column(i) * a[i][j]).sum::<f64>();
    let matrix = |entry: &dyn Fn(f64) -> f64| {
        let mut text = "16\n".to_owned();
        for (i, j) in (0..16).map(|place| (place / 4, place % 4)) {
            let element: f64 = (0..4).map(|k| a[k][i] * entry(rows[k][0]) * a[k][j]).sum();
            writeln!(text, "{i} {j} {element:e} ! [Row] [Col] Value").expect("written");
        }
        text
    };
    let three = |from: usize| {
        let line = |j: usize| {
            let part = |axis: usize| through(&|i| rows[i][from + axis], j);
            format!("{:e} {:e} {:e}\n", part(0), part(1), part(2))
        };
        (0..4).map(line).collect::<String>()
    };
    let mut l = "36\n".to_owned();
    for (i, j, mode) in (0..36).map(|place| (place / 12, place / 4 % 3, place % 4)) {
        writeln!(l, "{i} {j} {mode} {:e}", through(&|k| rows[k][7 + 3 * j + i], mode)).expect("written");
    }
    let head = &text[..text.find("****************  Non-zero Mass").expect("a heading")];
    let text = format!(
        "{head}* Mass Matrix\n{}* Stiffness Matrix\n{}* Damping Matrix\n{}* Linear Momentum Modal Integral\n{}\
         * Angular Momentum Modal Integral\n{}* Linear Modal Integral\n{l}[EOF]\n",
        matrix(&|_| 1.0),
        matrix(&|w| w * w),
        matrix(&|w| 0.01 * w),
        three(1),
        three(4)
    );
    let modes = parse(ResultFormat::Flex, text.as_bytes(), Some(3)).expect("modes").modes;
    assert_eq!(modes.len(), 3);
    for (mode, row) in modes.iter().zip(&rows) {
        assert!((mode.frequency / row[0] - 1.0).abs() < 1e-12);
        assert!((mode.damping.expect("damping") - 0.005).abs() < 1e-12);
        let sign = (mode.translation[1] * row[2]).signum();
        let found =
            [&mode.translation[..], &mode.rotation, &mode.moments.expect("moments").concat()].concat();
        for (index, (found, expected)) in found.iter().zip(&row[1..]).enumerate() {
            // Rotations of the other file are printed digits of the moments.
            assert!((sign * found - expected).abs() < if (3..6).contains(&index) { 1e-6 } else { 1e-11 });
        }
    }
}

#[test]
fn a_table_goes_on_over_pages_and_is_of_mass_normalised_modes() {
    let results = file("pages-nx.f06");
    assert_eq!(results.modes.len(), 60);
    for (index, mode) in results.modes.iter().enumerate() {
        let k = index as f64 + 1.0;
        let t = [3.0 * libm::cos(k), 2.0 * libm::sin(k), libm::cos(2.0 * k)].map(|part| part / k);
        let r = [libm::sin(3.0 * k), 4.0 * libm::cos(3.0 * k), -3.0 * libm::sin(k)].map(|part| part / k);
        assert!((mode.frequency / (2.0 * libm::pow(k, 1.5)) - 1.0).abs() < 1e-6);
        for (found, expected) in mode.translation.iter().chain(&mode.rotation).zip(t.iter().chain(&r)) {
            assert!((found - expected).abs() < 1e-6 * 4.0 / k, "mode {k}: {found} {expected}");
        }
    }
    let six = parse(ResultFormat::F06, &bytes("pages-nx.f06"), Some(6)).expect("modes");
    assert_eq!(six.modes[..], results.modes[..6]);
}

#[test]
fn errors_name_line_and_field() {
    let reported = |name: &str, from: &str, to: &str| {
        let text = String::from_utf8(bytes(name)).expect("text");
        assert!(text.contains(from), "{name}: {from}");
        let format = ResultFormat::from_path(Path::new(name)).expect("a format");
        parse(format, text.replacen(from, to, 1).as_bytes(), None).expect_err("wrong")
    };
    let cases = [
        (
            reported("bars-msc.f06", "6.227923E+00        9", "************        9"),
            "`RADIANS` must be a finite number, got `**",
        ),
        (
            reported("bars-msc.f06", "6.227923E+00        9", "6.228923E+00        9"),
            "mode 1 must have one frequency",
        ),
        (
            reported("bars-msc.f06", "3.878703E+01        6", "-3.87870E+01        6"),
            "eigenvalue of mode 1 must be positive",
        ),
        (
            reported("bars-msc.f06", "       10        10   ", "       11        10   "),
            "must be mode 10, got mode 11",
        ),
        (reported("bars-msc.f06", "2.848100E+00", "2.948100E+00"), "`T2` must be the generalised mass times"),
        (reported("bars-msc.f06", "R E A L   E I G E N V A L U E S", "-"), "must have a table `R E A L"),
        (
            reported("bars-msc.f06", "MODAL PARTICIPATION FACTORS", "-"),
            "line 156: must have participation factors",
        ),
        (reported("bars-msc.f06", "0\n", "0 *** USER FATAL MESSAGE 9050\n"), "the run failed"),
        (reported("bars.F06", "2.815070E-02 -2.8", "-2.81507E-02 -2.8"), "from its factor T1"),
        (reported("bars.F06", "S P C   F O R C E S", "-"), "SPCFORCES = ALL"),
        (reported("feet.F06", "CLAMPED", "CLAMPED"), "clamp one grid at the root"),
        (reported("panel.dat", "0.4817442E+01", "0.4817452E+01 NaN"), "line 8: must have 5 fields"),
        (
            reported("panel.dat", "0.2061183E+02", "0.2061183E+0x"),
            "line 23: `Y-ROTATION` must be a finite number",
        ),
        (reported("panel.dat", "P A R T", "P A R"), "P A R T I C I P A T I O N"),
        (reported("bars.flex", "3 3 3.565450e+02", "3 4 3.565450e+02"), "`Col` must be 0 to 3, got 4"),
        (reported("bars.flex", "3 3 3.565450e+02", "3 3 -3.56545e+02"), "positive definite stiffness"),
        (
            reported("bars.flex", "3 3 3.565450e+02", "! 3"),
            "must have 4 elements in its section Stiffness, got 3",
        ),
        (reported("bars.flex", "2 1 3  1.0", "2 1 3  1.5"), "must have the same rotation of mode 3"),
    ];
    for (error, why) in cases {
        assert!(error.contains(why), "{error}");
    }
}

#[test]
fn effective_masses_alone_do_for_modes_of_one_direction() {
    let text =
        String::from_utf8(bytes("bars-msc.f06")).expect("text").replace("MODAL PARTICIPATION FACTORS", "-");
    let (head, table) = text.split_once("MODAL EFFECTIVE MASS\n").expect("a table");
    let rows =
        table.lines().filter(|line| line.len() > 100 && !line.contains("TOTAL") && !line.starts_with('1'));
    let one_way =
        rows.skip(1).take(10).map(|line| format!("{}{}\n", &line[..42], "      0.000000E+00".repeat(5)));
    let text = format!("{head}MODAL EFFECTIVE MASS\n\n   MODE\n{}", one_way.collect::<String>());
    let modes = parse(ResultFormat::F06, text.as_bytes(), None).expect("modes").modes;
    for (mode, row) in modes.iter().zip(expected("bars")) {
        assert!((mode.translation[0] - row[1].abs()).abs() < 1e-6 && mode.translation[1] == 0.0);
    }
}

#[test]
fn residual_vectors_leave_one_table() {
    let text = String::from_utf8(bytes("bars-msc.f06")).expect("text");
    let title = "R E A L   E I G E N V A L U E S\n";
    let from = text.find(title).expect("a title");
    let until = text[from..].find("\n1 ").expect("a page") + from + 1;
    let tables =
        ["(BEFORE AUGMENTATION OF RESIDUAL VECTORS)", "", "(AFTER AUGMENTATION OF RESIDUAL VECTORS)"];
    let tables = tables.map(|remark| text[from..until].replacen(title, &format!("{title}  {remark}\n"), 1));
    let three = format!("{}{}\n{}", &text[..from], tables.concat(), &text[until..]);
    assert_eq!(
        parse(ResultFormat::F06, three.as_bytes(), None).expect("modes").modes,
        file("bars-msc.f06").modes
    );
    let two = format!("{}{}\n{}", &text[..from], tables[..2].concat(), &text[until..]);
    assert!(parse(ResultFormat::F06, two.as_bytes(), None).expect_err("two").contains("several subcases"));
}
