//! The figures of campaigns: their numbers are those of the tables, and the worst runs can be repeated.

use serde_json::Value as Json;

use crate::drawing::{BLACK, BLUE, Drawing, RED, near};
use crate::study::pairs;
use crate::util::{Dir, UNCERTAIN, has_extension, table};

const ARCSEC: f64 = std::f64::consts::PI / 648_000.0;
const GREEN: &str = "#009E73";
const GREY: &str = "#787878";

/// Returns the quantile of some values as NumPy defines it.
fn quantile(values: &[f64], q: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = q * (sorted.len() - 1) as f64;
    let (low, part) = (place.floor() as usize, place.fract());
    sorted[low] + part * (sorted[(low + 1).min(sorted.len() - 1)] - sorted[low])
}

/// Returns the numbers of a column.
fn column(dir: &Dir, file: &str, name: &str) -> Vec<f64> {
    table(dir, file).iter().map(|row| row[name].parse().expect("a number")).collect()
}

/// Returns the worst runs, as `plot --json` prints them.
fn worst(dir: &Dir, arguments: &str) -> Vec<Json> {
    let out = dir.run(&format!("plot {arguments} --json --force")).printed();
    let lines = out.lines().map(|line| serde_json::from_str::<Json>(line).expect("an object"));
    lines.filter_map(|line| line.get("worst").cloned()).collect()
}

#[test]
fn distributions_have_the_quantiles_of_the_table() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 60 --table csv -o out").exits(0);
    dir.run(
        "plot out -o figures --format svg --metric gain_initial,envelope_late_mean_rad --what distribution",
    )
    .exits(0);
    assert_eq!(
        dir.names("figures"),
        ["u-distribution-envelope_late_mean_rad.svg", "u-distribution-gain_initial.svg"]
    );
    for (metric, label, unit) in [
        ("gain_initial", "gain initial", 1.0),
        ("envelope_late_mean_rad", "envelope late mean (arcsec)", ARCSEC),
    ] {
        let drawing = Drawing::read(&dir, &format!("u-distribution-{metric}"));
        drawing.shows(&["60 runs", "runs (of 60)", label]);
        let values = column(&dir, "out/runs.csv", metric);
        let range = quantile(&values, 1.0) - quantile(&values, 0.0);
        // Dashes of the median and of the 95 % quantile, which are named with their numbers.
        let lines = drawing.shapes("polyline", "stroke", BLACK);
        let mut at: Vec<f64> = lines
            .iter()
            .filter(|line| is_upright(line))
            .map(|line| drawing.along(line[0].0) * unit)
            .collect();
        at.sort_by(f64::total_cmp);
        at.dedup();
        assert_eq!(at.len(), 2, "{at:?}");
        for (found, q) in at.iter().zip([0.5, 0.95]) {
            near(*found, quantile(&values, q), 2e-3 * range);
        }
        let texts = drawing.texts();
        for (word, q) in [("median: ", 0.5), ("95 %: ", 0.95)] {
            let named = texts.iter().find_map(|text| text.strip_prefix(word)).expect("named");
            let number: f64 = named.split(' ').next().expect("a number").parse().expect("a number");
            near(number * unit, quantile(&values, q), 5e-3 * quantile(&values, q).abs());
        }
        // Each run is a tick.
        let ticks = drawing.shapes("polyline", "stroke", GREY);
        let mut at: Vec<f64> = ticks
            .iter()
            .filter(|line| is_upright(line))
            .map(|line| drawing.along(line[0].0) * unit)
            .collect();
        at.sort_by(f64::total_cmp);
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        assert_eq!(at.len(), 60);
        for (found, value) in at.iter().zip(&sorted) {
            near(*found, *value, 2e-3 * range);
        }
    }
}

/// Returns true for a line along which x is the same.
fn is_upright(line: &[(f64, f64)]) -> bool {
    line.len() == 2 && line[0].0.to_bits() == line[1].0.to_bits()
}

#[test]
fn an_edge_of_a_bar_is_at_the_limit() {
    let dir = Dir::with(&["slew-wheel-lqg"]);
    let limit = format!("--set requirement[0].limit={}", 63.0 * ARCSEC);
    dir.run(&format!("simulate slew-wheel-lqg.toml --runs 40 {limit} --table csv -o out")).exits(3);
    dir.run("plot out -o figures --format svg --what distribution --metric arrival").exits(0);
    let drawing = Drawing::read(&dir, "slew-wheel-lqg-distribution-arrival");
    let ends = |colour: &str| {
        let bars = drawing.shapes("polygon", "fill", colour);
        assert!(!bars.is_empty(), "{colour}");
        bars.iter()
            .flatten()
            .map(|point| point.0)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let line = drawing.shapes("polyline", "stroke", RED);
    let line = line.iter().find(|line| is_upright(line)).expect("the limit")[0].0;
    near(ends(GREEN).1, line, 2.0);
    near(ends(RED).0, line, 2.0);
    near(drawing.along(line), 63.0, 0.05);
    let values: Vec<Vec<f64>> = table(&dir, "out/runs.csv")
        .iter()
        .map(|row| serde_json::from_str(&row["requirement_values"]).expect("numbers"))
        .collect();
    let met = values.iter().filter(|values| values[0] <= 63.0 * ARCSEC).count();
    assert!((1..40).contains(&met), "{met}");
    // The interval of Wilson.
    let (n, p, z) = (40.0, met as f64 / 40.0, 1.959_963_984_540_054_f64);
    let middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    let words = format!("({:.0} to {:.0} %)", 100.0 * (middle - half), 100.0 * (middle + half));
    let head = format!("{met} of 40 runs meet the limit: ");
    let texts = drawing.texts();
    assert!(texts.iter().any(|text| text.starts_with(&head) && text.ends_with(&words)), "{words} {texts:?}");
    drawing.shows(&["arrival (arcsec)", "at most 63 arcsec"]);
}

#[test]
fn scatters_show_what_was_drawn_and_fans_what_was_logged() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 9 --table csv -o out --log events").exits(0);
    let reported = dir.run("plot out -o figures --format svg").exits(0).prints(&["u: the worst of 9 runs"]);
    assert!(reported.contains("flexsc simulate out/scenario.toml --runs "), "{reported}");
    assert!(dir.names("figures").contains(&"u-fan.svg".to_owned()), "{:?}", dir.names("figures"));
    let scatter = Drawing::read(&dir, "u-scatter-envelope_late_mean_rad");
    scatter.shows(&["law.relay.k_t", "body.planar.rate (arcsec/s)", "envelope late mean (arcsec)"]);
    let dots = scatter
        .each(|node| (node.has_tag_name("circle") && node.attribute("fill") == Some(BLUE)).then_some(()));
    // Two panels with a legend each.
    assert_eq!(dots.len(), 2 * (9 + 1));

    let fan = Drawing::read(&dir, "u-fan");
    fan.shows(&["5 to 95 %", "25 to 75 %", "median", "mean envelope (arcsec)", "time (s)"]);
    let last = |run: usize| -> f64 {
        let json = table(&dir, "out/runs.csv")[run]["envelope_window_means_rad"].clone();
        let means: Vec<f64> = serde_json::from_str(&json).expect("numbers");
        means[means.len() - 1]
    };
    let median = quantile(&(0..9).map(last).collect::<Vec<_>>(), 0.5);
    let lines = fan.shapes("polyline", "stroke", BLACK);
    let line = lines.iter().find(|line| line.len() > 10).expect("a line");
    near(fan.up(line[line.len() - 1].1, ["2", "4"]) * ARCSEC, median, 1e-7);
    dir.run("plot out --what fan,curve").exits(2).says(&["no figure `curve`", "distribution, scatter, fan"]);
    // Logs alone have their fan.
    for file in ["runs.csv", "statistics.csv", "scenario.toml"] {
        std::fs::remove_file(dir.path(&format!("out/{file}"))).expect("there");
    }
    dir.run("plot out -o fan.svg").exits(0);
    assert_eq!(dir.text("fan.svg"), fan.0);
}

#[test]
fn sweeps_have_curves_and_maps() {
    let dir = Dir::with(&["relay-fixed"]);
    let sweep = "sweep relay-fixed.toml --set duration=1500 --vary law.relay.k_t=0.30:0.36:7";
    dir.run(&format!("{sweep} --table csv -o one")).exits(0);
    dir.run("plot one -o figures/one.svg --metric torque_impulse_per_hour_nm_s").exits(0);
    dir.run("plot one -o one.svg --metric torque_impulse_per_hour_nm_s").exits(0);
    let curve = Drawing::at(&dir, "one.svg");
    curve.shows(&["law.relay.k_t", "acceleration impulse per hour (deg/s)"]);
    let dots = curve.each(|node| {
        let is = node.has_tag_name("circle") && node.attribute("fill") == Some(BLUE);
        is.then(|| node.attribute("cx").and_then(|x| x.parse::<f64>().ok()))?
    });
    let keys = column(&dir, "one/runs.csv", "law.relay.k_t");
    for (dot, key) in pairs(&dots, keys) {
        near(curve.along(*dot), key, 1e-4);
    }

    dir.run(&format!("{sweep} --vary law.relay.weak=8e-7:1.6e-6:5 --table csv -o two")).exits(0);
    dir.run("plot two -o two.svg --metric envelope_late_mean_rad").exits(0);
    let map = Drawing::at(&dir, "two.svg");
    map.shows(&["law.relay.k_t", "law.relay.weak (arcsec/s²)", "envelope late mean (arcsec)", "as designed"]);
    map.shows(&["same noise at all points"]);
    // A dot at each point of the grid.
    let dots = map.each(|node| {
        let is = node.has_tag_name("circle") && node.attribute("fill") == Some(GREY);
        is.then(|| node.attribute("cx").and_then(|x| x.parse::<f64>().ok()))?
    });
    let keys = column(&dir, "two/runs.csv", "law.relay.k_t");
    let mut found: Vec<f64> = dots.iter().map(|x| map.along(*x)).collect();
    found.sort_by(f64::total_cmp);
    let mut expected = keys;
    expected.sort_by(f64::total_cmp);
    for (dot, key) in pairs(&found, expected) {
        near(*dot, key, 1e-4);
    }
}

#[test]
fn the_worst_runs_can_be_repeated() {
    let dir = Dir::with(&["relay-sampled", "rotation-robust", "iss-ringdown", "relay-fixed"]);
    dir.run("simulate relay-sampled.toml --runs 6 --seed 3 --set duration=2000 --table csv -o relay")
        .exits(0);
    dir.run("simulate rotation-robust.toml --runs 4 --table csv -o rotation").exits(0);
    dir.run("simulate iss-ringdown.toml --runs 3 --set duration=40 --table csv -o station").exits(0);
    let two = "--vary law.relay.k_t=0.31:0.35:3 --vary body.planar.modes[0].damping=0:0.01:2";
    dir.run(&format!("sweep relay-fixed.toml --set duration=1500 {two} --table csv -o sweep")).exits(0);
    for name in ["relay", "rotation", "station", "sweep"] {
        let found = worst(&dir, &format!("{name} -o {name}.svg --worst 1"));
        assert!(!found.is_empty(), "{name}");
        for worst in &found {
            let command = worst["command"].as_str().expect("a command");
            let arguments = command.strip_prefix("flexsc ").expect("of flexsc").replace('\'', "");
            dir.run(&arguments).exits(0);
            let run = worst["run"].as_u64().expect("a number");
            // The points of a sweep have the noise of run 0.
            let noise = if name == "sweep" { 0 } else { run };
            let own = dir.text(&format!("{name}/run-{run}/runs-{noise}-{}.csv", noise + 1));
            let own = own.lines().nth(1).expect("a row");
            let whole = dir.text(&format!("{name}/runs.csv"));
            if name == "sweep" {
                // Its key is set, and no column.
                let metrics =
                    |row: &str| row.split(',').rev().take(20).map(str::to_owned).collect::<Vec<_>>();
                assert!(
                    whole
                        .lines()
                        .any(|row| row.starts_with(&format!("{run},")) && metrics(row) == metrics(own))
                );
            } else {
                assert!(whole.lines().any(|row| row == own), "{name}: {own}");
            }
            assert_eq!(
                dir.names(&format!("{name}/run-{run}"))
                    .iter()
                    .filter(|file| has_extension(file, "mcap"))
                    .count(),
                1
            );
        }
    }
    // The largest value of each metric, in order.
    let found = worst(&dir, "relay -o relay.svg --metric duty --worst 6");
    let values: Vec<f64> = found.iter().map(|worst| worst["value"].as_f64().expect("a number")).collect();
    assert!(values.len() == 6 && values.is_sorted_by(|a, b| a >= b), "{values:?}");
    let mut duty = column(&dir, "relay/runs.csv", "duty");
    duty.sort_by(|a, b| b.total_cmp(a));
    // JSON here is read to some fifteen digits.
    for (found, exact) in pairs(&values, duty) {
        near(*found, exact, 1e-12);
    }
}

#[test]
fn parts_make_up_a_campaign_and_failures_are_listed() {
    let wide = UNCERTAIN.replace("{ uniform = [0.3, 0.32] }", "{ normal = { mean = 0.31, sd = 0.3 } }");
    let dir = Dir::holding("u.toml", wide);
    dir.run("simulate u.toml --runs 20 --table csv -o whole").exits(1);
    dir.run("simulate u.toml --runs 0:9 --table csv -o parts").exits(1);
    dir.run("simulate u.toml --runs 9:20 --table csv -o parts").exits(1);
    let listed = |name: &str| dir.run(&format!("plot {name} -o {name}.svg")).printed().replace(name, "");
    assert_eq!(listed("parts"), listed("whole"));
    assert_eq!(dir.text("parts.svg"), dir.text("whole.svg"));
    assert!(listed("parts").contains("failed") && listed("parts").contains("law.relay.k_t"));
    let part = dir.text("parts/runs-0-9.csv");
    dir.write("parts/runs-0-5.csv", part.replace(",7,", ",8,"));
    dir.run("plot parts -o parts.svg").exits(2).says(&["run 0 is another than in", "runs-0-5.csv"]);
}

#[test]
fn bad_tables_are_named() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 3 --table csv -o out").exits(0);
    std::fs::create_dir(dir.path("empty")).expect("made");
    dir.run("plot empty")
        .exits(2)
        .says(&["empty: no campaign, neither parts nor a table `runs.csv`", "flexsc simulate"]);
    dir.run("plot out --metric dutie").exits(2).says(&["no metric `dutie`", "switchings", "duty"]);
    dir.run("plot out --metric cycle_kind").exits(2).says(&["no metric `cycle_kind` that is a number"]);
    dir.run("plot out --what gain").exits(2).says(&["no figure `gain`", "it has distribution, scatter"]);
    let header = "run,seed,duty,error\n";
    for (table, words) in [
        ("", "must be `run`, ..., `error`"),
        ("a,b\n1,2\n", "must be `run`, ..., `error`"),
        (header, "contains no runs"),
        (&format!("{header}x,1,2,\n"), "line 2: `run` must be the number of a run, got `x`"),
        (&format!("{header}1,1\n"), "not the table of a campaign"),
        (&format!("{header}1,1,0.5,\n2,1,0.5,\n"), "no metric varies"),
    ] {
        dir.write("empty/runs.csv", table);
        dir.run("plot empty").exits(2).says(&["empty", words]);
    }
    assert_eq!(dir.names("empty"), ["runs.csv"]);
    // A table without its scenario is drawn, but its runs cannot be repeated.
    dir.write("empty/runs.csv", format!("{header}1,1,0.5,\n2,1,0.6,\n"));
    let reported = dir.run("plot empty --json").printed();
    assert!(reported.contains("\"command\":null"), "{reported}");
    dir.run("plot empty").exits(0).says(&["no scenario.toml"]);
}

/// A campaign that was killed leaves a torn log: its table is drawn all the same.
#[test]
fn a_torn_log_is_left_out() {
    let dir = Dir::with(&["relay-sampled"]);
    dir.run("simulate relay-sampled.toml --runs 3 --log events --set duration=600 --table csv -o c").exits(0);
    dir.write("c/torn.mcap", "no log");
    dir.run("plot c --format svg -o drawn").exits(0).says(&["left out", "torn.mcap"]);
    dir.run("plot c --what fan -o drawn").exits(2).says(&["torn.mcap"]);
    dir.run("plot c/relay-sampled-0.mcap --worst 2")
        .exits(2)
        .says(&["--worst: ", "not the directory of a campaign"]);
}

#[test]
fn requirements_are_drawn_first_under_their_names() {
    let dir = Dir::with(&["slew-wheel-lqg"]);
    dir.run("simulate slew-wheel-lqg.toml --runs 8 --table csv -o csv").exits(3);
    dir.run("plot csv -o figures --format svg").exits(0);
    let names = dir.names("figures");
    for requirement in ["arrival", "stability"] {
        let name = format!("slew-wheel-lqg-distribution-{requirement}");
        assert!(names.contains(&format!("{name}.svg")), "{names:?}");
        let drawing = Drawing::read(&dir, &name);
        drawing.shows(&["runs (of 8)", &format!("{requirement} (arcsec)")]);
        assert!(drawing.0.contains(" of 8 runs meet the limit: "), "{requirement}");
    }
    // They are the values of the table, and their worst runs are listed.
    let values: Vec<Vec<f64>> = table(&dir, "csv/runs.csv")
        .iter()
        .map(|row| serde_json::from_str(&row["requirement_values"]).expect("numbers"))
        .collect();
    let found = worst(&dir, "csv -o worst.svg --worst 1");
    let of = |name: &str| found.iter().find(|worst| worst["metric"] == *name).expect("a worst run");
    let largest = values.iter().map(|values| values[1]).fold(0.0, f64::max);
    near(of("stability")["value"].as_f64().expect("a number"), largest, 1e-12 * largest);
    // The name and the element of the list are one metric.
    for metric in ["arrival", "requirement_values[0]"] {
        dir.run(&format!("plot csv -o one --format svg --what distribution --metric {metric} --force"))
            .exits(0);
        assert_eq!(dir.names("one"), ["slew-wheel-lqg-distribution-arrival.svg"]);
    }
    dir.run("plot csv -o one --metric departure").exits(2).says(&["no metric `departure`", "arrival"]);
}

#[test]
fn an_explorer_has_the_numbers_of_the_table_and_repeats_each_run() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 6 --table csv -o out").exits(0);
    dir.run("plot out -o e.html").exits(0);
    let page = dir.text("e.html");
    assert!(!page.contains("http"), "a page that stands alone");
    let data = page.split("const data = ").nth(1).expect("data").split(";\nconst").next().expect("an end");
    let data: Json = serde_json::from_str(data).expect("an object");
    let of = |name: &str| {
        let columns = data["columns"].as_array().expect("columns");
        columns.iter().find(|own| own["name"] == name).unwrap_or_else(|| panic!("{name}")).clone()
    };
    let late = of("envelope_late_mean_rad");
    assert_eq!((late["isKey"].as_bool(), late["unit"].as_str()), (Some(false), Some("arcsec")));
    for (shown, value) in late["values"].as_array().expect("values").iter().zip(column(
        &dir,
        "out/runs.csv",
        "envelope_late_mean_rad",
    )) {
        let shown = shown.as_f64().expect("a number");
        assert!((shown * ARCSEC / value - 1.0).abs() < 1e-12, "{shown} {value}");
    }
    let command = data["runs"][4]["command"].as_str().expect("a command").to_owned();
    let words = command.strip_prefix("flexsc ").expect("a command of flexsc");
    let printed = dir.run(&format!("{words} --json")).printed();
    let repeated: Json = serde_json::from_str(printed.lines().next().expect("a run")).expect("an object");
    let value = repeated["metrics"]["envelope_late_mean_rad"].as_f64();
    assert_eq!(value, Some(column(&dir, "out/runs.csv", "envelope_late_mean_rad")[4]));
}
