//! The page about other programs: each of its examples is accepted with a file of its format, and files of one orbit in several
//! formats give it.

use std::fs;
use std::path::{Path, PathBuf};

use flexsc_core::numerics::attitude::Vector;

use crate::orbits::{drifting, scenario};
use crate::util::Dir;

/// Tables that an example of the page leaves out.
const CRAFT: &str = "[spacecraft]\nmass = 600.0\ninertia = [[250, 0, 0], [0, 300, 0], [0, 0, 220]]\n";
const LAW: &str = "[law.attitude]\nperiod = 0.5\nbandwidth = 0.01\n";

fn golden(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden")).join(name)
}

#[test]
fn every_example_of_the_page_is_accepted() {
    let dir = Dir::new();
    for folder in ["foreign", "fe"] {
        let files = fs::read_dir(golden(folder)).expect("a folder").flatten().map(|entry| entry.path());
        for file in files.filter(|file| file.is_file()) {
            let name = file.file_name().expect("a name").to_string_lossy().into_owned();
            fs::copy(&file, dir.path(&name)).expect("a copy");
        }
    }
    let page = fs::read_to_string(golden("../../docs/import.md")).expect("a page");
    let examples: Vec<&str> =
        page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(examples.len() >= 8, "{}", examples.len());
    for example in examples {
        let (top, tables) = example.split_at(example.find('[').unwrap_or_default());
        let rest = if example.contains("[body") { "" } else { &[CRAFT, LAW].concat() };
        dir.write("example.toml", format!("duration = 10.0\n{top}{rest}{tables}"));
        let run = dir.run("check example.toml").exits(0);
        let printed = [run.out, run.err].concat();
        assert!(printed.contains("accepted"), "{example}\n{printed}");
    }
}

/// Returns the position (m) in a run with an orbit in a file of this page.
fn position(key: &str, file: &str, t: f64) -> Vector {
    let path = golden("foreign").join(file);
    let text = drifting(&format!("{{ {key} = {:?} }}", path.display().to_string()), "");
    // The shorter of the ephemerides has an hour.
    scenario(&text.replace("duration = 7200.0", "duration = 3600.0"))
        .orbit_environment()
        .position(t)
        .expect("an orbit")
        .position
}

#[test]
fn one_set_of_elements_has_one_orbit() {
    let lines = position("tle", "geo.tle", 3000.0);
    for message in ["geo.omm", "geo.xml", "geo.json"] {
        assert_eq!(position("tle", message, 3000.0), lines, "{message}");
    }
    assert!((lines.norm() - 42_165e3).abs() < 5e3, "{lines}");
}

/// Rows five minutes apart with their velocities: the orbit by Kepler's equation, solved in another language.
#[test]
fn velocities_of_a_message_are_used_between_its_rows() {
    let exact = Vector::new(-4_238_423.184_855, 772_220.419_090, -5_494_633.790_593);
    let off = (position("ephemeris", "sparse.oem", 3750.0) - exact).norm();
    assert!(off < 0.05, "{off}");
    let joined = position("ephemeris", "two-segments.oem", 1830.0);
    assert!((joined.norm() - 6.97e6).abs() < 2e4, "{joined}");
}
