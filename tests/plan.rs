//! The command `flexsc plan`: its numbers and its words.

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use std::f64::consts::FRAC_PI_2;

use crate::spacecraft::text;
use crate::study::close;
use crate::util::Dir;

fn dir(drive: &str, rate: f64, manoeuvre: &str) -> Dir {
    Dir::holding("turn.toml", text(drive, rate, manoeuvre))
}

#[test]
fn the_numbers_of_a_plan() {
    let quarter =
        format!("angle = {FRAC_PI_2:?}\ntime = 12.0\n[manoeuvre.command]\nsine = {{ suppress = 1 }}");
    let reported = dir("torque", 0.0, &quarter).run("plan turn.toml --json").exits(0).json();
    let number = |key: &str| {
        reported.pointer(key).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("{key}"))
    };
    for (key, exact, tolerance) in [
        ("/time_s", 12.0, 0.0),
        ("/coefficients_nm/0", 411.465238316, 1e-11),
        ("/coefficients_nm/1", -190.087330099, 1e-11),
        ("/peak_torque_nm", 521.080754063, 1e-11),
        ("/rms_torque_nm", 320.4971414899, 1e-12),
        ("/energy_nm2_s", 1232621.012439, 1e-12),
        ("/residual_rad/phi4", 2.174721671e-5, 1e-8),
        ("/residual_rad/angle", 8.285417207e-5, 1e-8),
        ("/residual_worst_rad/phi4", 1.189e-3, 5e-4),
        ("/residual_worst_5_percent_rad/phi4", 3.375e-4, 5e-4),
        ("/peak_deflection_rad", 0.2157570444, 1e-9),
        ("/peak_deflections_rad/angle", 0.132232747, 1e-8),
        ("/residual_energy_j", 5.903e-5, 1e-3),
    ] {
        close(number(key), exact, tolerance);
    }
    assert_eq!(reported["even_coefficients_nm"], serde_json::json!([]));
    assert_eq!(reported["constant_nm"], 0.0);
    let dir = dir("torque", 0.0, &quarter);
    dir.run("plan turn.toml --units si").exits(0).says(&[
        "1.571 rad in 12 s",
        "411.465238316, -190.087330099 N m",
        "521.1 N m",
        "phi4",
        "0.001189",
    ]);
    // Another command, in the time that its peak allows.
    let set = "--set manoeuvre.command.sine.suppress=2 --peak-torque 521.080754063";
    let reported = dir.run(&format!("plan turn.toml --json {set}")).exits(0).json();
    assert!((reported["time_s"].as_f64().expect("a time") - 14.2784).abs() < 1e-4);
    close(reported["peak_torque_nm"].as_f64().expect("a peak"), 521.080754063, 1e-12);
    let reported = dir.run("plan turn.toml --json --set manoeuvre.command={bang_bang={}}").exits(0).json();
    assert!(reported["coefficients_nm"].is_null() && reported["harmonics_nm"].is_null());
    // The same bytes each time.
    let again = |_| dir.run("plan turn.toml --json --compare").printed();
    assert_eq!(again(0), again(1));
}

#[test]
fn rates_and_motion_have_their_keys() {
    let spin = format!(
        "angle = {FRAC_PI_2:?}\ntime = 12.0\nend_rate = 0.2\n[manoeuvre.command]\nsine = {{ suppress = 2 }}"
    );
    let reported = dir("torque", 0.0, &spin).run("plan turn.toml --json").exits(0).json();
    close(reported["constant_nm"].as_f64().expect("a number"), 76.9445, 1e-12);
    close(reported["even_coefficients_nm"][0].as_f64().expect("a number"), -99.55520223269, 1e-11);
    assert!(reported["tuned_times_s"][0]["cosine"].is_null());
    let quarter =
        format!("angle = {FRAC_PI_2:?}\ntime = 12.0\n[manoeuvre.command]\nsine = {{ suppress = 2 }}");
    let reported = dir("motion", 0.0, &quarter).run("plan turn.toml --json").exits(0).json();
    close(reported["coefficients_rad_s2"][2].as_f64().expect("a number"), -0.0367391841, 2e-9);
    close(reported["peak_torque_nm"].as_f64().expect("a number"), 718.49901755, 1e-9);
    assert!(reported.get("coefficients_nm").is_none());
}

/// Returns the header of a CSV file, and the numbers of its rows.
fn numbers(dir: &Dir, name: &str) -> (String, Vec<Vec<f64>>) {
    let text = dir.text(name);
    let (header, rows) = text.split_once('\n').expect("a header");
    let row =
        |line: &str| -> Vec<f64> { line.split(',').map(|cell| cell.parse().expect("a number")).collect() };
    (header.to_owned(), rows.lines().map(row).collect())
}

/// Returns the largest absolute value of a column.
fn largest(rows: &[Vec<f64>], column: usize) -> f64 {
    rows.iter().fold(0.0, |largest: f64, row| largest.max(row[column].abs()))
}

/// Returns the times at which a table has two rows.
fn jumps(rows: &[Vec<f64>]) -> Vec<f64> {
    assert!(rows.windows(2).all(|pair| pair[0][0] <= pair[1][0]), "times in order");
    rows.windows(2).filter(|pair| pair[0][0] == pair[1][0]).map(|pair| pair[0][0]).collect()
}

#[test]
fn a_trajectory_is_written_as_a_table() {
    let quarter =
        format!("angle = {FRAC_PI_2:?}\ntime = 12.0\n[manoeuvre.command]\ncosine = {{ suppress = 2 }}");
    let dir = dir("torque", 0.0, &quarter);
    let reported = dir.run("plan turn.toml --json -o plan.csv").exits(0).says(&["plan.csv: "]).json();
    let number = |key: &str| {
        reported.pointer(key).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("{key}"))
    };
    let (header, rows) = numbers(&dir, "plan.csv");
    let mode = |index: usize| format!("modes[{index}].displacement_rad,modes[{index}].rate_rad_s");
    let modes = [0, 1, 2, 3].map(mode).join(",");
    assert_eq!(header, format!("time_s,angle_rad,rate_rad_s,torque_nm,{modes},phi4_rad"));
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    close(first[3], number("/initial_torque_nm"), 1e-12);
    assert!(first.iter().enumerate().all(|(column, value)| column == 3 || *value == 0.0), "{first:?}");
    close(largest(&rows, 3), number("/peak_torque_nm"), 1e-3);
    // A cosine series has a torque at its end, which jumps to zero.
    assert_eq!(jumps(&rows), [12.0]);
    let arrival = rows.iter().find(|row| row[0] == 12.0).expect("the end of the manoeuvre");
    close(arrival[1], FRAC_PI_2 + number("/end_angle_error_rad"), 1e-13);
    assert!((arrival[2] - number("/end_rate_error_rad_s")).abs() < 1e-13, "{arrival:?}");
    // Afterwards the modes vibrate within the residual.
    assert!(last[0] > 14.0 && last[3] == 0.0, "{last:?}");
    assert!((last[1] - FRAC_PI_2).abs() <= 1.001 * number("/residual_rad/angle"), "{last:?}");
    assert!(last[12].abs() <= 1.001 * number("/residual_rad/phi4"), "{last:?}");

    // The rigid bang-bang jumps in the middle and at the end.
    dir.run("plan turn.toml -o bang.csv --set manoeuvre.command={bang_bang={}}").exits(0);
    assert_eq!(jumps(&numbers(&dir, "bang.csv").1), [6.0, 12.0]);
}

#[test]
fn a_table_of_motion_has_the_command_and_the_torque() {
    let quarter =
        format!("angle = {FRAC_PI_2:?}\ntime = 12.0\n[manoeuvre.command]\nsine = {{ suppress = 2 }}");
    let dir = dir("motion", 0.0, &quarter);
    let reported = dir.run("plan turn.toml --json -o plan.csv").exits(0).json();
    let number = |key: &str| reported[key].as_f64().unwrap_or_else(|| panic!("{key}"));
    let (header, rows) = numbers(&dir, "plan.csv");
    assert!(header.starts_with("time_s,angle_rad,rate_rad_s,acceleration_rad_s2,torque_nm,modes[0]."));
    close(largest(&rows, 3), number("peak_acceleration_rad_s2"), 1e-3);
    close(largest(&rows, 4), number("peak_torque_nm"), 1e-3);
    assert!(jumps(&rows).is_empty());
    // The hub stands still afterwards, and a torque holds it.
    let last = &rows[rows.len() - 1];
    close(last[1], FRAC_PI_2, 1e-10);
    assert!(last[3] == 0.0 && last[4] != 0.0, "{last:?}");
}

#[test]
fn a_scenario_keeps_its_manoeuvre() {
    let turn = "angle = 1.0\npeak_torque = 300.0\n[manoeuvre.command]\ncosine = { zeros = [{ mode = 1, shift = 0.1 }] }\n\
                [manoeuvre.shaper]\nei = { modes = [0], vibration = 0.1 }";
    let scenario = crate::spacecraft::scenario(&text("torque", 0.0, turn));
    let again = crate::spacecraft::scenario(&scenario.to_toml());
    assert_eq!((&scenario.manoeuvre, &scenario.plan), (&again.manoeuvre, &again.plan));
    assert!(scenario.plan.is_some());
}
