//! Results of finite-element programs and matrices that cannot be used: each is refused with the line, or with what is missing.

use std::path::Path;

use flexsc_core::formats::structure::fe::ResultFormat;

use crate::structure::RELAY;
use crate::util::Dir;

/// Case: a file of `tests/golden/fe`, a text in it, the text in its place, and words of the error.
type Case = (&'static str, &'static str, &'static str, &'static [&'static str]);

#[rustfmt::skip] // One case a line.
const BAD: &[Case] = &[
    ("bars-msc.f06", "9.912048E-01        1.000000E+00", "9.912048E-01        0.000000E+00", &["line 34", "the generalised mass of mode 1 must be positive, got 0"]),
    ("bars-msc.f06", "3.878703E+01        6.227923E+00        9.912048E-01", "3.878703E-11        6.227923E-06        9.912048E-07", &["line 34", "mode 1 at 0.000006227923 rad/s is none of a clamped structure", "clamp the root"]),
    ("bars.flex", "4                                    ! Number of Flex", "201                                  ! Number of Flex", &["line 3: must have 1 to 200 modes, got 201"]),
    ("bars.flex", "4                                    ! Number of non-zero elements\n0 0 1.000000e+00                   ! [Row] [Col] Value\n1 1 1.000000e+00                   ! [Row] [Col] Value\n2 2 1.000000e+00                   ! [Row] [Col] Value\n3 3 1.000000e+00                   ! [Row] [Col] Value\n", "0                                    ! Number of non-zero elements\n", &["must have a mass matrix, got no elements"]),
    ("bars.flex", "1 1 4.983328e+01", "0 1 4.983328e+01", &["must have a symmetric stiffness matrix"]),
    ("bars.flex", "2 2 1.779005e-01", "2 1 1.779005e-01", &["must have a symmetric damping matrix"]),
    ("bars.flex", "0 0 3.878703e+01", "0 0 -3.87870e+01", &["must have a positive definite stiffness matrix: are its modes clamped?"]),
    ("bars.flex", "1 1 1.000000e+00", "1 1 -1.00000e+00", &["must have a positive definite mass matrix"]),
    ("beam.frd", "    1UMAT    1", "    1UMAT    1OTHER\n    1UMAT    1", &["must name material 1 once", "after `OTHER`"]),
];

/// Reads all modes of a file of `tests/golden/fe` with another text in it, and of its deck where it has one.
fn read(name: &str, text: &str) -> Result<(), String> {
    let golden = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/fe"));
    let dir = Dir::holding(name, text);
    let deck = Path::new(name).with_extension("inp");
    if let Ok(text) = std::fs::read(golden.join(&deck)) {
        dir.write(&deck.to_string_lossy(), text);
    }
    let format = ResultFormat::from_path(Path::new(name)).expect("a format");
    format.read(&dir.path(name), None, &[], None).map(drop)
}

fn golden(name: &str) -> String {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/fe")).join(name);
    std::fs::read_to_string(path).expect("there")
}

#[track_caller]
fn refused(name: &str, text: &str, words: &[&str]) {
    let error = read(name, text).expect_err(words[0]);
    assert!(words.iter().all(|word| error.contains(word)), "{name}: no {words:?} in: {error}");
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn results_that_cannot_be_used_are_refused() {
    for (name, old, new, words) in BAD {
        let whole = golden(name);
        read(name, &whole).expect(name);
        assert!(whole.contains(old), "{name} has no `{old}`");
        refused(name, &whole.replacen(old, new, 1), words);
    }
    // Sections of integrals that are all 0.
    let whole = golden("bars.flex");
    let without = |sections: &[&str]| {
        let mut is_within = false;
        let lines = whole.lines().map(|line| {
            if line.starts_with("**") {
                is_within = sections.iter().any(|section| line.contains(section));
            }
            let has_value = is_within && (line.contains("[x y z]") || line.contains("[i] [j] [Mode]"));
            match line.split_once('!').filter(|_| has_value) {
                Some((_, comment)) if line.contains("[x y z]") => format!("0 0 0 ! {comment}"),
                Some((values, comment)) => {
                    let places: Vec<&str> = values.split_whitespace().take(3).collect();
                    format!("{} 0 ! {comment}", places.join(" "))
                }
                None => line.to_owned(),
            }
        });
        lines.collect::<Vec<_>>().join("\n") + "\n"
    };
    refused("bars.flex", &without(&["Linear Momentum"]), &["its section Pf is all 0", "its modes are free"]);
    refused(
        "bars.flex",
        &without(&["Angular Momentum", "Linear Modal"]),
        &["its sections Hf and L are all 0"],
    );
    read("bars.flex", &without(&["Linear Modal"])).expect("rotations are in Hf");
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn matrices_that_cannot_be_used_are_refused() {
    let body = format!("{RELAY}[body.matrices]\nstiffness = [[0, 0], [0, 5]]\nmass = \"m.mtx\"\n");
    for (text, words) in [
        (
            "%%MatrixMarket matrix coordinate real symmetric\n2 3 1\n1 1 1\n",
            &["line 2: must be square to be symmetric, got 2 x 3"][..],
        ),
        ("%%MatrixMarket matrix coordinate real hermitian\n2 2 1\n1 1 1\n", &["line 1"]),
        (
            "%%MatrixMarket matrix coordinate real general\n2 2 1\n3 1 1\n",
            &["line 3: must be within 2 x 2, counted from 1, got 3 1"],
        ),
        (
            "%%MatrixMarket matrix array real general\n2 2\n1\n0\n0\n1\n7\n",
            &["line 7: must end after 4 elements"],
        ),
    ] {
        let dir = Dir::holding("a.toml", &body);
        dir.write("m.mtx", text);
        dir.run("check a.toml").exits(2).says(&["`body.matrices.mass`"]).says(words);
    }
}
