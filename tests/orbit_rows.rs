//! Rows of orbits: wrong ones and gaps, jumps of the theory of two-line elements, and axes of other dates.

use std::fmt::Write as _;

use flexsc_core::Scenario;
use flexsc_core::numerics::attitude::Vector;
use nalgebra::Matrix3;

use crate::orbits::{KEPLER, TLE, drifting, scenario};
use crate::util::Dir;

/// Date of the matrices of `mean_of_date`.
const EQUINOX: &str = "epoch = 2026-03-20T14:46:00Z\n";

/// Rows of a CSV file of the Kepler orbit, at times (s), with something done to each.
fn ephemeris(times: impl Iterator<Item = f64>, change: impl Fn(usize, &mut Vector)) -> String {
    let sky = scenario(&drifting(KEPLER, "")).orbit_environment();
    let mut table = "t,x,y,z\n".to_owned();
    for (row, t) in times.enumerate() {
        let mut place = sky.position(t).expect("an orbit").position;
        change(row, &mut place);
        writeln!(table, "{t},{},{},{}", place.x, place.y, place.z).expect("text");
    }
    table
}

/// A row is the line two above its number: after the header, which is the first line.
#[test]
fn an_ephemeris_with_wrong_rows_or_gaps_is_refused_with_the_line() {
    let dir = Dir::new();
    dir.write("study.toml", drifting("{ ephemeris = \"orbit.csv\" }", ""));
    let minutes = || (-6..=130).map(|row| 60.0 * f64::from(row));
    let unchanged = |_: usize, _: &mut Vector| ();
    let away =
        |wrong: usize| move |row: usize, place: &mut Vector| place.x += if row == wrong { 5e4 } else { 0.0 };
    let sparse = |step: f64| (-6..=130).map(move |row| step * f64::from(row));
    let from_start = || (0..=130).map(|row| 60.0 * f64::from(row));
    let without = |from: f64, to: f64| minutes().filter(move |t| *t < from || *t > to);
    for (table, words) in [
        (ephemeris(minutes(), away(40)), ["orbit.csv: line 42: must be within 1 km", "got 50.0 km"]),
        (ephemeris(from_start(), away(0)), ["orbit.csv: line 2: must be within 1 km", "got 50.0 km"]),
        (ephemeris(from_start(), away(2)), ["orbit.csv: line 4: must be within 1 km", "got 50.0 km"]),
        (
            ephemeris(from_start().take(121), away(120)),
            ["orbit.csv: line 122: must be within 1 km", "got 50.0 km"],
        ),
        (
            ephemeris(without(1990.0, 4370.0), unchanged),
            ["line 41: the next row comes 2400 s later", "known to"],
        ),
        (ephemeris(sparse(600.0), unchanged), ["orbit.csv: line", "rows are too far apart"]),
    ] {
        dir.write("orbit.csv", table);
        dir.run("check study.toml").exits(2).says(&["`environment.orbit.ephemeris`", words[0], words[1]]);
    }
    // Beyond the run nothing follows from the rows.
    dir.write("orbit.csv", ephemeris((-6..=230).map(|row| 60.0 * f64::from(row)), away(180)));
    assert!(!dir.run("check study.toml").exits(0).err.contains("remark"));
    dir.write("orbit.csv", ephemeris(minutes(), unchanged));
    assert!(!dir.run("check study.toml").exits(0).err.contains("remark"));
    dir.write("orbit.csv", ephemeris(sparse(360.0), unchanged));
    dir.run("check study.toml").exits(0).says(&["remark: `environment.orbit.ephemeris`", "orbit.csv: line"]);
}

/// A wrong row is as far from the polynomial of its neighbours as it was put, and the error between sparse rows is
/// estimated within a factor of two.
#[test]
fn departures_of_rows_are_those_of_the_orbit() {
    let told = |table: &str| {
        let rows: Vec<String> = table.lines().skip(1).map(|line| format!("[{line}]")).collect();
        let text = drifting(&format!("{{ ephemeris = [{}] }}", rows.join(", ")), "");
        let remarks = scenario(&text).remarks();
        let remark = remarks.first().expect("a remark").to_string();
        let of = remark.split(" m ").next().and_then(|before| before.rsplit(' ').next());
        (of.and_then(|number| number.parse::<f64>().ok()).expect("a distance"), remark)
    };
    let minutes = (-6..=130).map(|row| 60.0 * f64::from(row));
    let (found, remark) =
        told(&ephemeris(minutes, |row, place| place.y -= if row == 77 { 345.0 } else { 0.0 }));
    assert!(found == 345.0 && remark.contains("row 78: is"), "{remark}");
    // A gap of 30 minutes: the true error in its middle.
    let gap = || (-6..=130).map(|row| 60.0 * f64::from(row)).filter(|t| *t < 1990.0 || *t > 3770.0);
    let (found, remark) = told(&ephemeris(gap(), |_, _| ()));
    let sky = scenario(&drifting(KEPLER, "")).orbit_environment();
    let times: Vec<f64> = gap().filter(|t| (1800.0..=3960.0).contains(t)).collect();
    assert_eq!(times.len(), 8);
    let lagrange = |t: f64| -> Vector {
        let weight = |of: f64| -> f64 {
            times.iter().filter(|other| **other != of).map(|other| (t - other) / (of - other)).product()
        };
        times.iter().map(|of| sky.position(*of).expect("an orbit").position * weight(*of)).sum()
    };
    let exact = (lagrange(2880.0) - sky.position(2880.0).expect("an orbit").position).norm();
    assert!(
        found > 0.5 * exact && found < 2.0 * exact && remark.contains("1800 s later"),
        "{remark}: {exact}"
    );
}

/// SDP4 jumps by 1650 km between 110 580 s and 110 640 s after the epoch of one set of its verification, where the
/// perturbed inclination passes 0.2 rad (python-sgp4 2.27); that of another set does so by 1.07 km.
#[test]
fn jumps_of_the_theory_are_refused_or_remarked() {
    let far = "{ tle = [\"1 20413U 83020D   05363.79166667  .00000000  00000-0  00000+0 0  7041\", \
               \"2 20413  12.3514 187.4253 7864447 196.3027 356.5478  0.24690082  7978\"] }";
    let days = |days: f64, orbit: &str| {
        drifting(orbit, "").replace("duration = 7200.0", &format!("duration = {}", 86_400.0 * days))
    };
    let error = Scenario::parse("far.toml", &days(2.0, far)).expect_err("a jump").to_string();
    assert!(error.contains("`environment.orbit.tle` jumps by") && error.contains("11.46 deg"), "{error}");
    let number = |before: &str| -> f64 {
        let word = error.split(before).nth(1).and_then(|rest| rest.split(' ').next());
        word.and_then(|word| word.parse().ok()).expect("a number")
    };
    assert!((number("jumps by ") - 1650.0).abs() < 170.0, "{error}");
    assert!((number("near ") - 110_610.0).abs() < 1000.0, "{error}");
    assert!(scenario(&days(1.0, far)).remarks().is_empty());
    let near = "{ tle = [\"1 14128U 83058A   06176.02844893 -.00000158  00000-0  10000-3 0  9627\", \
                \"2 14128  11.4384  35.2134 0011562  26.4582 333.5652  0.98870114 46093\"] }";
    let remarks: Vec<String> = scenario(&days(2.0, near)).remarks().iter().map(ToString::to_string).collect();
    assert!(remarks.len() == 1 && remarks[0].contains("jumps by about"), "{remarks:?}");
    // The most eccentric set: the derivative of the positions is 312 m/s from the velocity of SGP4, without a jump.
    let long = "{ tle = [\"1 23333U 94071A   94305.49999999 -.00172956  26967-3  10000-3 0    15\", \
                \"2 23333  28.7490   2.3720 9728298  30.4360   1.3500  0.07309491    70\"] }";
    assert!(scenario(&days(2.0, long)).remarks().is_empty());
}

#[test]
fn elements_far_from_their_epoch_are_remarked() {
    let at = |epoch: &str| {
        let remarks = scenario(&format!("epoch = {epoch}\n{}", drifting(TLE, ""))).remarks();
        remarks.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    for (epoch, words) in [
        ("2026-11-29T00:00:00Z", "up to 7460 days after its epoch"),
        ("2006-07-10T20:00:00Z", "up to 14 days after its epoch"),
        ("2006-06-12T00:00:00Z", "up to 15 days before its epoch"),
    ] {
        let remarks = at(epoch);
        assert!(remarks.len() == 1 && remarks[0].contains(words), "{epoch}: {remarks:?}");
    }
    for epoch in ["2006-07-10T10:00:00Z", "2006-06-13T00:00:00Z"] {
        assert_eq!(at(epoch), Vec::<String>::new());
    }
}

/// Matrix from EME2000 to the mean equator and equinox of 2026-03-20T14:46:00Z: `tests/golden/precession.csv`.
fn mean_of_date(frame: &str) -> Matrix3<f64> {
    let row = include_str!("golden/precession.csv")
        .lines()
        .find(|row| row.starts_with(&format!("1774017960,{frame},")));
    Matrix3::from_row_iterator(
        row.expect("a date").split(',').skip(2).map(|cell| cell.parse().expect("a number")),
    )
}

/// Rows along axes of 2000 are rotated to the mean equator and equinox of the start, whatever the first row's date; those in
/// axes of date stay, and a log keeps the name of these.
#[test]
fn rows_are_rotated_into_the_axes_of_the_start() {
    let dir = Dir::new();
    let table = ephemeris((-6..=130).map(|row| 60.0 * f64::from(row)), |_, _| ());
    dir.write("orbit.csv", &table);
    let header = |frame: &str| {
        format!(
            "CCSDS_OEM_VERS = 2.0\nMETA_START\nCENTER_NAME = EARTH\nREF_FRAME = {frame}\nTIME_SYSTEM = UTC\nMETA_STOP\n"
        )
    };
    let states: Vec<String> = table
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
            let minute = 14 * 60 + 46 + (cells[0] / 60.0) as i32;
            let [x, y, z] = [1, 2, 3].map(|axis| cells[axis] / 1e3);
            format!("2026-03-20T{:02}:{:02}:00 {x} {y} {z} 0 0 0\n", minute / 60, minute % 60)
        })
        .collect();
    for frame in ["EME2000", "GCRF", "ICRF", "MOD", "TEME", "TOD"] {
        dir.write(&format!("{frame}.oem"), format!("{}{}", header(frame), states.concat()));
    }
    let position = |orbit: &str| {
        dir.write("study.toml", format!("{EQUINOX}{}", drifting(orbit, "")));
        let found = Scenario::load(&dir.path("study.toml")).expect("a scenario");
        let alone = found.self_contained().to_toml();
        let again = Scenario::parse("alone.toml", &alone).expect("self-contained");
        let [first, second] =
            [&found, &again].map(|of| of.orbit_environment().position(600.0).expect("an orbit").position);
        assert!((first - second).norm() < 1e-6, "{orbit}");
        let names: Vec<&str> = ["MOD", "TEME", "TOD", "EME2000"]
            .into_iter()
            .filter(|name| alone.contains(&format!("\"{name}\"")))
            .collect();
        (first, names.concat())
    };
    let (plain, unnamed) = position("{ ephemeris = \"orbit.csv\" }");
    assert_eq!(unnamed, "");
    for (frame, named) in
        [("EME2000", ""), ("GCRF", ""), ("ICRF", ""), ("MOD", ""), ("TEME", "TEME"), ("TOD", "TOD")]
    {
        let golden = match frame {
            "EME2000" => mean_of_date("EME2000"),
            "GCRF" | "ICRF" => mean_of_date("GCRF"),
            _ => Matrix3::identity(),
        };
        for orbit in [
            format!("{{ ephemeris = \"{frame}.oem\" }}"),
            format!("{{ ephemeris = \"{frame}.oem\", frame = \"{frame}\" }}"),
            format!("{{ ephemeris = \"orbit.csv\", frame = \"{frame}\" }}"),
        ] {
            let (found, name) = position(&orbit);
            assert!((found - golden * plain).norm() < 1e-3, "{orbit}: {}", (found - golden * plain).norm());
            assert_eq!(name, named, "{orbit}");
        }
    }
    let refused = |orbit: &str, words: &[&str]| {
        dir.write("study.toml", drifting(orbit, ""));
        dir.run("check study.toml").exits(2).says(words);
    };
    refused(
        "{ ephemeris = \"orbit.csv\", frame = \"EME2000\" }",
        &["`environment.orbit.ephemeris`", "needs an `epoch`"],
    );
    refused(
        "{ ephemeris = \"TOD.oem\", frame = \"TEME\" }",
        &["`environment.orbit.frame`", "REF_FRAME = TOD", "got TEME"],
    );
    refused("{ semi_major_axis = 7e6, frame = \"TEME\" }", &["`frame`", "`ephemeris`"]);
}
