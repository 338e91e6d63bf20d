//! Files that others published, read as they are: `tests/golden/foreign/public` has their sources and licences.

use std::fs;
use std::path::{Path, PathBuf};

use flexsc_core::Scenario;
use flexsc_core::numerics::attitude::Vector;

use crate::orbits::drifting;
use crate::util::Dir;

fn foreign(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/foreign")).join(name)
}

fn text(name: &str) -> String {
    fs::read_to_string(foreign(&format!("public/{name}"))).expect("a file")
}

/// Returns a scenario with an orbit from a file, or the text for which it is refused.
fn flown(key: &str, file: &Path, duration: f64) -> Result<Scenario, String> {
    let orbit = format!("{{ {key} = {:?} }}", file.display().to_string());
    let text = drifting(&orbit, "gravity_gradient = {}\n")
        .replace("duration = 7200.0", &format!("duration = {duration:?}"));
    Scenario::parse("orbit.toml", &text).map_err(|error| error.to_string())
}

fn position(scenario: &Scenario, t: f64) -> Vector {
    scenario.orbit_environment().position(t).expect("an orbit").position
}

/// Positions of python-sgp4 (tests/golden/foreign/public_orbits.py) for the sets with which SGP4 is verified, and for messages.
#[test]
fn element_sets_have_the_orbits_of_another_implementation() {
    let dir = Dir::new();
    let verification: Vec<String> = text("python-sgp4/SGP4-VER.TLE").lines().map(str::to_owned).collect();
    let table = fs::read_to_string(foreign("public_orbits.csv")).expect("a table");
    let (mut compared, mut refused) = (0, Vec::new());
    for row in table.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let line: usize = cells[1].parse().expect("a line");
        let file = if line == 0 {
            foreign(&format!("public/{}", cells[0]))
        } else {
            // Behind column 69 the file has the times of the verification.
            let lines = [line - 1, line].map(|line| verification[line][..69].to_owned());
            dir.write("elements.tle", lines.join("\n"));
            dir.path("elements.tle")
        };
        match flown("tle", &file, 7200.0) {
            Ok(scenario) => {
                let exact =
                    Vector::from_iterator(cells[3..].iter().map(|cell| cell.parse().expect("a number")));
                let off = (position(&scenario, cells[2].parse().expect("a time")) - 1e3 * exact).norm();
                assert!(off < 0.01, "{row}: {off}");
                compared += 1;
            }
            Err(error) => refused.push((cells[1].to_owned(), cells[3].to_owned(), error)),
        }
    }
    assert_eq!(compared + refused.len(), table.lines().count() - 1);
    for (line, expected, error) in &refused {
        let why = if expected == "checksum" { "must end with its checksum" } else { "planet's radius" };
        assert!(error.contains(why), "{line}: {error}");
    }
    // Two fall below the planet's radius within the two hours, and three have a wrong checksum.
    assert_eq!((compared, refused.len()), (99, 9), "{refused:?}");
}

#[test]
fn messages_in_xml_have_the_orbits_of_those_in_keywords() {
    for number in ["32275", "36111", "44850", "54031", "65590"] {
        let [keywords, xml] = ["omm", "xml"].map(|ending| {
            let file = foreign(&format!("public/oem/{number}.{ending}"));
            position(&flown("tle", &file, 600.0).expect("an orbit"), 500.0)
        });
        assert_eq!(keywords, xml, "{number}");
    }
}

/// Between the rows of real ephemerides the orbit passes through rows that were held out; distances do not depend on axes.
#[test]
fn ephemerides_pass_through_rows_that_were_held_out() {
    let dir = Dir::new();
    for name in ["LEO_60s", "MEO_60s", "GEO_60s"] {
        let all = text(&format!("oem/{name}.oem"));
        // Some have accelerations too.
        let is_row = |line: &&str| line.starts_with('2') && line.split_whitespace().count() >= 7;
        let rows: Vec<&str> = all.lines().filter(is_row).collect();
        let odd: Vec<&str> = rows.iter().skip(1).step_by(2).copied().collect();
        let kept: Vec<&str> = all.lines().filter(|line| !odd.contains(line)).collect();
        dir.write("thinned.oem", kept.join("\n"));
        let thinned = dir.path("thinned.oem");
        let duration = 60.0 * (rows.len() - 2) as f64;
        let [whole, thin] = [foreign(&format!("public/oem/{name}.oem")), thinned]
            .map(|file| flown("ephemeris", &file, duration).expect("an orbit"));
        for (index, row) in rows.iter().enumerate().take(rows.len() - 1) {
            let cells: Vec<f64> =
                row.split_whitespace().skip(1).map(|cell| cell.parse().expect("a number")).collect();
            let (t, distance) = (60.0 * index as f64, 1e3 * Vector::from_column_slice(&cells[..3]).norm());
            let of_whole = position(&whole, t);
            assert!((of_whole.norm() - distance).abs() < 1e-6, "{name}: {row}");
            let off = (position(&thin, t) - of_whole).norm();
            // At the ends there are fewer rows on one side.
            let most = if (8..rows.len() - 8).contains(&index) { 2e-3 } else { 0.05 };
            assert!(off < most, "{name}: {row}: {off}");
        }
    }
}

/// Coefficients of two agencies for the same years, and those that are built in.
#[test]
fn fields_of_agencies_agree() {
    let field = |year: u32, table: &str| {
        let rest = format!("gravity_gradient = {{}}\nmagnetic_field = {{ {table} }}\n");
        let text = drifting("{ altitude = \"525 km\", inclination = 1.5 }", &rest);
        Scenario::parse("field.toml", &format!("epoch = {year}-07-01T00:00:00Z\n{text}"))
            .map(|scenario| {
                [0.0, 900.0, 2700.0].map(|t| scenario.orbit_environment().field_at(t).expect("a field"))
            })
            .map_err(|error| error.to_string())
    };
    let file = |name: &str| format!("table = {:?}", foreign(&format!("public/{name}")).display().to_string());
    for (year, name, most) in [
        // The same coefficients.
        (2026, "ppigrf/IGRF14.shc", 1e-18),
        (2021, "ppigrf/IGRF14.shc", 1e-18),
        // The World Magnetic Model is of other data (40 000 nT).
        (2026, "pygeomag/WMM_2025.COF", 60e-9),
        (2021, "pygeomag/WMM_2020.COF", 60e-9),
    ] {
        let (own, read) = (field(year, "").expect("built in"), field(year, &file(name)).expect("a table"));
        for (own, read) in own.iter().zip(read) {
            assert!((own - read).norm() < most, "{year} {name}: {own} {read}");
        }
    }
    let late = field(2026, &file("pygeomag/WMM_2020.COF")).expect_err("older than its five years");
    assert!(late.contains("2025"), "{late}");
}

/// Each example with the reason for which it is refused; without one it is an orbit about the Earth.
#[test]
fn examples_of_the_standards_are_read_or_refused_with_the_reason() {
    for (key, name, reason) in [
        ("ephemeris", "orekit/OEMExample1.txt", "must have `CENTER_NAME = EARTH`, got `MARS BARYCENTER`"),
        ("ephemeris", "orekit/OEMExample3.xml", "this is an OEM in XML"),
        ("ephemeris", "orekit/OEMExample5.txt", "rows are too far apart"),
        ("ephemeris", "orekit/OEMExample5ITRF.txt", "must have `REF_FRAME`"),
        ("ephemeris", "orekit/ISS.resampled.truncated.txt", "rows are too far apart"),
        // `utc` and `eme2000` are accepted.
        ("ephemeris", "orekit/oemLowerCaseValue.oem", "must have at least 8 rows, got 6"),
        ("tle", "orekit/OMMExample1.txt", ""),
        ("tle", "orekit/OMMExample2.txt", ""),
        ("tle", "orekit/OMMExample2.xml", ""),
        ("tle", "orekit/OMM-with-units.xml", ""),
        ("tle", "orekit/OMM-empty-object-id.xml", ""),
        ("tle", "orekit/OMM-wrong-keyword.txt", ""),
        ("tle", "orekit/OMMExample3.txt", "must have `REF_FRAME = TEME`, got `TOD`"),
        ("tle", "orekit/OMMExample5.txt", "got `SGP4-XP`"),
        ("tle", "orekit/OMM-number-format-error.txt", "must have a number as `ARG_OF_PERICENTER`"),
        ("tle", "oem/v2-valid-sample.omm", ""),
        ("tle", "oem/v2-valid-sample.xml", ""),
        ("tle", "oem/v2-valid-semi-major-axis.omm", "must have `REF_FRAME = TEME`"),
        ("tle", "oem/v2-valid-sgp.omm", "got `SGP`"),
        ("tle", "oem/v2-invalid-missing-sgp-derivative.omm", "got `SGP`"),
        ("tle", "oem/v2-invalid-sgp4-xp.omm", "got `SGP4-XP`"),
        ("tle", "oem/v2-invalid-unsupported-version.omm", "must have `REF_FRAME = TEME`"),
        ("tle", "oem/v2-invalid-metadata-after-data.omm", "must have `MEAN_MOTION`"),
        ("tle", "oem/v3-invalid-invalid-root.xml", "this is an OPM in XML"),
        ("tle", "oem/v3-valid-comments-and-units.omm", ""),
        ("tle", "oem/v3-valid-covariance-default-frame.omm", "must have `REF_FRAME = TEME`"),
        ("tle", "oem/v3-valid-namespaced-user-defined.xml", "must have `REF_FRAME = TEME`"),
        ("tle", "oem/v3-valid-optional-header-and-spacecraft.omm", "must have `REF_FRAME = TEME`"),
        ("tle", "oem/v3-valid-sample.omm", ""),
        ("tle", "oem/v3-valid-sample.xml", ""),
        ("tle", "oem/v3-valid-yday-and-scientific-notation.omm", ""),
    ] {
        match flown(key, &foreign(&format!("public/{name}")), 60.0) {
            Ok(_) => assert!(reason.is_empty(), "{name} is accepted"),
            Err(error) => assert!(!reason.is_empty() && error.contains(reason), "{name}: {error}"),
        }
    }
}
