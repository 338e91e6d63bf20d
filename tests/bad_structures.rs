//! Bad structures: each is refused with one error that names the key, what was found and what is accepted.

use std::fmt::Write as _;

use crate::structure::RELAY;
use crate::util::Dir;

/// Case: name of the fault, replaced lines of `[body.matrices]` (1 is its header), the text that the carets mark, and
/// words of the error.
type Case = (&'static str, &'static [(usize, &'static str)], &'static str, &'static [&'static str]);

/// The lines after the law's seven.
const GOOD: [&str; 5] = [
    "[body.matrices]",
    "mass = [[10, 1, 0], [1, 2, 0], [0, 0, 3]]",
    "stiffness = [[0, 0, 0], [0, 5, -1], [0, -1, 7]]",
    "outputs = [{ name = \"tip\", weights = { q2 = 1 } }]",
    "",
];

#[rustfmt::skip] // One case a line.
const BAD: &[Case] = &[
    ("a number for a matrix", &[(2, "mass = 5")], "5", &["`body.matrices.mass`", "found integer `5`", "expected rows of numbers, or the path of a .csv, .mtx or .npz file"]),
    ("a row for a matrix", &[(2, "mass = [5, 3]")], "5", &["`body.matrices.mass[0]`", "found integer `5`", "expected an array"]),
    ("a string in a matrix", &[(2, "mass = [[10, 1, 0], [1, \"a\", 0], [0, 0, 3]]")], "\"a\"", &["`body.matrices.mass[1][1]`", "expected a number"]),
    ("no number in a matrix", &[(2, "mass = [[10, 1, 0], [1, nan, 0], [0, 0, 3]]")], "nan", &["`body.matrices.mass[1][1]`", "must be a finite number, got NaN"]),
    ("a short row", &[(2, "mass = [[10, 1, 0], [1, 2], [0, 0, 3]]")], "[1, 2]", &["`body.matrices.mass[1]` must have 3 numbers, as the first row, got 2"]),
    ("no square", &[(3, "stiffness = [[0, 0, 0], [0, 5, -1]]")], "[[0, 0, 0], [0, 5, -1]]", &["`body.matrices.stiffness` must be square, got 2 x 3"]),
    ("no order", &[(2, "mass = [[1]]")], "[[1]]", &["`body.matrices.mass` must be of order 2 to 2000, got 1 x 1"]),
    ("no rows", &[(2, "mass = []")], "[]", &["`body.matrices.mass` must be of order 2 to 2000, got 0 x 0"]),
    ("no symmetry", &[(2, "mass = [[10, 1, 0], [1, 2, 0], [0.5, 0, 3]]")], "0.5", &["`body.matrices.mass[2][0]` must be symmetric: element [2][0] is 0.5, [0][2] is 0"]),
    ("other sizes", &[(3, "stiffness = [[0, 0], [0, 5]]")], "[[0, 0], [0, 5]]", &["`body.matrices.stiffness` must be 3 x 3, as the mass, got 2 x 2"]),
    ("no mass", &[(2, "mass = [[10, 1, 0], [1, 2, 0], [0, 0, 0]]")], "0", &["`body.matrices.mass[2][2]` must be positive, got 0"]),
    ("an indefinite mass", &[(2, "mass = [[10, 5, 0], [5, 2, 0], [0, 0, 3]]")], "[[10, 5, 0], [5, 2, 0], [0, 0, 3]]", &["`body.matrices.mass` must be positive definite"]),
    ("an indefinite mass under a clamp", &[(2, "mass = [[10, 5, 0], [5, 2, 0], [0, 0, 3]]"), (5, "drive = \"motion\"")], "[[10, 5, 0], [5, 2, 0], [0, 0, 3]]", &["`body.matrices.mass` must be positive definite"]),
    ("another rigid motion", &[(3, "stiffness = [[0, 0, 0], [0, 5, -5], [0, -5, 5]]")], "[[0, 0, 0], [0, 5, -5], [0, -5, 5]]", &["`body.matrices.stiffness` must be positive definite with the hub held", "another motion without strain"]),
    ("a negative stiffness", &[(3, "stiffness = [[0, 0, 0], [0, 5, 0], [0, 0, -7]]")], "[[0, 0, 0], [0, 5, 0], [0, 0, -7]]", &["`body.matrices.stiffness` must be positive definite with the hub held"]),
    ("a hub on a spring", &[(3, "stiffness = [[4, 0, 0], [0, 5, -1], [0, -1, 7]]")], "4", &["`body.matrices.stiffness[0][0]` must be 0, as the hub's angle alone strains nothing, got 4", "in `rotation`"]),
    ("a soft structure", &[(3, "stiffness = [[0, 0, 0], [0, 5e-9, 0], [0, 0, 7]]")], "[[0, 0, 0], [0, 5e-9, 0], [0, 0, 7]]", &["`body.matrices.stiffness` gives an elastic mode of 5.1", "lowest accepted has 1e-4"]),
    ("damping without symmetry", &[(5, "damping_matrix = [[0, 0, 0], [0, 0.1, 0.2], [0, 0, 0.3]]")], "0", &["`body.matrices.damping_matrix[2][1]` must be symmetric: element [2][1] is 0, [1][2] is 0.2"]),
    ("damping of another order", &[(5, "damping_matrix = [[0, 0], [0, 0.1]]")], "[[0, 0], [0, 0.1]]", &["`body.matrices.damping_matrix` must be 3 x 3, as the mass, got 2 x 2"]),
    ("damping that resists the rotation", &[(5, "damping_matrix = [[0.5, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]")], "[[0.5, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]", &["`body.matrices.damping_matrix` must not resist the rotation of the whole, but gives 0.5 for coordinate 0"]),
    ("damping that drives", &[(5, "damping_matrix = [[0, 0, 0], [0, 0.1, 0], [0, 0, -0.1]]")], "[[0, 0, 0], [0, 0.1, 0], [0, 0, -0.1]]", &["`body.matrices.damping_matrix` must be positive semidefinite"]),
    ("damping under a clamp", &[(4, "drive = \"motion\""), (5, "damping_matrix = [[0, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]")], "[[0, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]", &["`body.matrices.damping_matrix` couples the modes of a body whose hub turns freely"]),
    ("a hub beyond", &[(5, "hub = 3")], "3", &["`body.matrices.hub` must be the index of a coordinate, 0 to 2, got 3"]),
    ("a short rotation", &[(5, "rotation = [1, 0]")], "[1, 0]", &["`body.matrices.rotation` must have one number for each of 3 coordinates, got 2"]),
    ("a rotation without the hub", &[(5, "rotation = [2, 0, 0]")], "2", &["`body.matrices.rotation[0]` must be 1, as the angle of the hub itself, got 2"]),
    ("a rotation with strain", &[(5, "rotation = [1, 0.5, 0]")], "[1, 0.5, 0]", &["`body.matrices.rotation` must strain nothing, but the stiffness gives 2.5 for coordinate 1"]),
    ("damping of another number", &[(5, "damping = [0.1]")], "[0.1]", &["`body.matrices.damping` must be one number, or one for each of 2 modes, got 1"]),
    ("negative damping", &[(5, "damping = -0.1")], "-0.1", &["`body.matrices.damping`", "must be a number of 0 or more, got -0.1"]),
    ("a negative damping of one", &[(5, "damping = [0.1, -0.1]")], "-0.1", &["`body.matrices.damping[1]`", "must be a number of 0 or more, got -0.1"]),
    ("a word for damping", &[(5, "damping = \"low\"")], "\"low\"", &["`body.matrices.damping`", "expected a damping ratio, or an array of them"]),
    ("too many modes kept", &[(5, "keep = 3")], "3", &["`body.matrices.keep` must be at most 2, the number of modes up to 1e4 rad/s, got 3"]),
    ("a negative number of modes", &[(5, "keep = -1")], "-1", &["`body.matrices.keep`", "expected a whole number from 0"]),
    ("another drive", &[(5, "drive = \"wheel\"")], "\"wheel\"", &["`body.matrices.drive`", "`wheel` is not known here", "`torque` or `motion`"]),
    ("few names", &[(5, "coordinates = [\"a\", \"b\"]")], "[\"a\", \"b\"]", &["`body.matrices.coordinates` must have one name for each of 3 coordinates, got 2"]),
    ("a name again", &[(5, "coordinates = [\"a\", \"b\", \"a\"]")], "\"a\"", &["`body.matrices.coordinates[2]` must differ from the other names, got `a` again"]),
    ("few weights", &[(4, "outputs = [{ name = \"tip\", weights = [1] }]")], "[1]", &["`body.matrices.outputs[0].weights` must have one number for each of 3 coordinates, got 1"]),
    ("a weight of no coordinate", &[(4, "outputs = [{ name = \"tip\", weights = { v2 = 1 } }]")], "{ v2 = 1 }", &["`body.matrices.outputs[0].weights` must name coordinates (`q0` to `q2`), got `v2`"]),
    ("a number for weights", &[(4, "outputs = [{ name = \"tip\", weights = 1 }]")], "1", &["`body.matrices.outputs[0].weights`", "expected an array with a weight for each coordinate, or a table of weights by coordinate"]),
    ("an output again", &[(4, "outputs = [{ name = \"a\", weights = [0, 1, 0] }, { name = \"a\", weights = [0, 0, 1] }]")], "\"a\"", &["`body.matrices.outputs[1].name` must differ from the other names, got `a` again"]),
    ("an unknown key", &[(5, "masses = 1")], "masses", &["unknown key `masses`", "`mass`"]),
    ("no stiffness", &[(3, "")], "[body.matrices]", &["`body.matrices`", "missing key `stiffness`"]),
    ("an unknown kind of file", &[(2, "mass = \"m.txt\"")], "\"m.txt\"", &["`body.matrices.mass` must be rows of numbers, or the path of a .csv, .mtx or .npz file", "m.txt"]),
    ("a missing file", &[(2, "mass = \"none.csv\"")], "\"none.csv\"", &["`body.matrices.mass` cannot be used", "none.csv: No such file"]),
    ("words in a file", &[(2, "mass = \"words.csv\"")], "\"words.csv\"", &["words.csv: line 2: must have numbers separated by commas, got `x` in column 1"]),
    ("a short line in a file", &[(2, "mass = \"short.csv\"")], "\"short.csv\"", &["short.csv: line 2: must have 2 numbers, as the first row, got 1"]),
    ("infinity in a file", &[(2, "mass = \"infinite.csv\"")], "\"infinite.csv\"", &["line 1: must have numbers separated by commas, got `inf` in column 2"]),
    ("no market", &[(2, "mass = \"words.mtx\"")], "\"words.mtx\"", &["words.mtx: line 1: must begin with `%%MatrixMarket matrix`"]),
    ("no archive", &[(2, "mass = \"words.npz\"")], "\"words.npz\"", &["words.npz: is not an npz archive"]),
    ("no name of an array", &[(2, "mass = \"dense.npz\"")], "\"dense.npz\"", &["dense.npz: must be followed by a colon and the name of an array, one of `K`, `M`"]),
    ("no such array", &[(2, "mass = \"dense.npz:m\"")], "\"dense.npz:m\"", &["dense.npz: has no array `m`, only `K`, `M`"]),
    ("envelopes of what has none", &[(5, "damping = 1\n[estimator.envelope]\nwindow = 1")], "1", &["`body.matrices.damping` must be below 1 for a mode to have an envelope"]),
    ("a table with few weights", &[(1, "[body.planar]\nmodes = [{ frequency = 1, gain = 0.1 }]"), (2, ""), (3, ""), (4, "outputs = [{ name = \"tip\", modes = [] }]")], "[]", &["`body.planar.outputs[0].modes` must have one number for each of 1 mode, got 0"]),
    ("no sections", &[(1, "[body.panels]\nhub_inertia = 1\nroot = 1\nsections = []"), (2, ""), (3, ""), (4, "")], "[]", &["`body.panels.sections` must be 1 to 99, got 0"]),
    ("no panels", &[(1, "[body.panels]\nhub_inertia = 1\nroot = 1\ncount = 0\nsections = [{ length = 1, mass_per_length = 1, hinge_stiffness = 1 }]"), (2, ""), (3, ""), (4, "")], "0", &["`body.panels.count` must be 1 or more, got 0"]),
    ("a section without length", &[(1, "[body.panels]\nhub_inertia = 1\nroot = 1\nsections = [{ length = 0, mass_per_length = 1, hinge_stiffness = 1 }]"), (2, ""), (3, ""), (4, "")], "0", &["`body.panels.sections[0].length`", "must be a positive number, got 0"]),
    ("sections far apart", &[(1, "[body.panels]\nhub_inertia = 1\nroot = 1\nsections = [{ length = 1, mass_per_length = 1, tip_mass = 1e308, hinge_stiffness = 1 }]"), (2, ""), (3, ""), (4, "")], "[{", &["`body.panels.sections` hold numbers that differ too much in size"]),
];

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn bad_structures_are_refused_at_their_keys() {
    let dir = Dir::new();
    dir.write("words.csv", "1, 2\nx, 3\n");
    dir.write("short.csv", "1, 2\n3\n");
    dir.write("infinite.csv", "1, inf\n3, 4\n");
    dir.write("words.mtx", "1 2\n");
    dir.write("words.npz", "1 2\n");
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/structure-dense.npz");
    std::fs::copy(golden, dir.path("dense.npz")).expect("golden");
    dir.write("bad.toml", format!("{RELAY}{}\n", GOOD.join("\n")));
    dir.run("check bad.toml").exits(0);
    let mut wrong = String::new();
    for (what, edits, marked, words) in BAD {
        let mut lines = GOOD;
        for (line, text) in *edits {
            lines[line - 1] = text;
        }
        let text = format!("{RELAY}{}\n", lines.join("\n"));
        dir.write("bad.toml", &text);
        let ran = dir.run("check bad.toml");
        let carets = ran.err.lines().nth(3).and_then(|line| line.split_once("| ")).unwrap_or_default().1;
        let line = ran.err.lines().nth(2).and_then(|line| line.split_once("| ")).unwrap_or_default().1;
        let (start, width) = (carets.find('^').unwrap_or(0), carets.matches('^').count());
        if ran.code != Some(2)
            || !ran.err.starts_with("error: bad.toml:")
            || !line.get(start..start + width).unwrap_or_default().starts_with(marked)
            || words.iter().any(|word| !ran.err.contains(word))
        {
            let _ = write!(wrong, "\n--- {what}: `{marked}`, {words:?}\n{}", ran.err);
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
