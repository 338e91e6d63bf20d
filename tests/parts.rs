//! Campaigns as directories of Parquet files: the same rows on any threads, continued, repeated, merged, drawn.

use std::path::Path;

use flexsc_core::campaign::{ColumnCells, Directory};

use crate::study::pairs;
use crate::util::{Dir, UNCERTAIN, table};

/// All columns of a directory but the time that runs took, with their names.
pub fn rows(path: &Path) -> Vec<(String, ColumnCells)> {
    let directory = Directory::open(path).expect("a campaign");
    assert!(directory.missing().expect("read").is_empty());
    let fields = directory.work().fields().iter().filter(|field| field.name != "seconds");
    let names: Vec<&str> = fields.map(|field| field.name.as_str()).collect();
    let columns = directory.columns(&names).expect("read").into_iter();
    let columns = columns.map(|column| column.expect("a column"));
    names.iter().map(|name| (*name).to_owned()).zip(columns).collect()
}

/// The numbers of a column.
fn numbers(path: &Path, name: &str) -> Vec<f64> {
    let directory = Directory::open(path).expect("a campaign");
    directory.column(name).expect("read").expect("a column").numbers()
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn a_campaign_is_a_directory_of_parts() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 600 -o out").exits(0).says(&["600 runs", "table out"]);
    assert_eq!(dir.names("out"), [".lock", "manifest.toml", "runs", "statistics.csv"]);
    let parts = ["part-0000000000-0000000256", "part-0000000256-0000000512", "part-0000000512-0000000600"];
    assert_eq!(dir.names("out/runs"), parts.map(|name| format!("{name}.parquet")));
    // The same rows as in a table, cell by cell.
    dir.run("simulate u.toml --runs 600 --table csv -o csv").exits(0);
    let csv = table(&dir, "csv/runs.csv");
    for (name, column) in rows(&dir.path("out")) {
        let texts: Vec<&str> = csv.iter().map(|row| row[&name].as_str()).collect();
        match column {
            ColumnCells::Text(words) => {
                let words: Vec<&str> = words.iter().map(|word| word.as_deref().unwrap_or("")).collect();
                assert_eq!(words, texts, "{name}");
            }
            ColumnCells::Lists(lists) => {
                let lists: Vec<_> =
                    lists.into_iter().map(|list| serde_json::json!(list).to_string()).collect();
                assert_eq!(lists, texts, "{name}");
            }
            column => {
                let exact = texts.iter().map(|text| text.parse().unwrap_or(f64::NAN));
                let same = |(a, b): (f64, f64)| a == b || a.is_nan() && b.is_nan();
                assert!(pairs(column.numbers(), exact).all(same), "{name}");
            }
        }
    }
    assert_eq!(dir.text("out/statistics.csv"), dir.text("csv/statistics.csv"));
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn threads_and_wishes_change_no_row() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 300 -o one --jobs 1").exits(0);
    dir.run("simulate u.toml --runs 300 -o eight --jobs 8").exits(0);
    // In three steps, the last of which fills what is left.
    dir.run("simulate u.toml --runs 40:70 -o steps").exits(0);
    dir.run("simulate u.toml --runs 100:101 -o steps").exits(0);
    dir.run("simulate u.toml --runs 300 -o steps").exits(0).says(&["steps: 31 of 300 runs are there"]);
    let one = rows(&dir.path("one"));
    for other in ["eight", "steps"] {
        assert!(rows(&dir.path(other)) == one, "{other} has other rows");
    }
    // Some of the metrics, in the order of all.
    dir.run("simulate u.toml --runs 300 --metrics goal,duty -o some").exits(0);
    let some = rows(&dir.path("some"));
    let names: Vec<&str> = some.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["run", "seed", "body.planar.rate", "law.relay.k_t", "duty", "goal", "error"]);
    assert!(some.iter().all(|column| one.contains(column)));
    dir.run("simulate u.toml --runs 3 --metrics dutty").exits(2).says(&["no metric `dutty`", "`duty`"]);
    dir.run("simulate u.toml --runs 300 --metrics duty -o some")
        .exits(2)
        .says(&["another campaign (metrics"]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn what_does_not_fit_changes_nothing() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 20 -o out").exits(0);
    let manifest = dir.text("out/manifest.toml");
    for (other, why) in [
        ("simulate u.toml --runs 20 --seed 8 -o out", "another campaign (`seed`: 7 before, 8 now)"),
        (
            "simulate u.toml --runs 20 --replicas 2 -o out",
            "another campaign (nothing before, 2 runs of each point now)",
        ),
        ("sweep u.toml --uncertain --vary duration=1,2,3 -o out", "duration = [1.0, 2.0, 3.0] now"),
        ("simulate u.toml --runs 10 -o out", "holds 20 runs of this campaign, and 10 would replace them"),
        ("simulate u.toml --runs 20 --table csv -o out", "holds a campaign as Parquet files"),
    ] {
        dir.run(other).exits(2).says(&["error: out", why, "hint: "]);
        assert_eq!(dir.text("out/manifest.toml"), manifest, "{other}");
        assert_eq!(dir.names("out/runs").len(), 1);
    }
    // The same is nothing to do, and more of it goes on.
    dir.run("simulate u.toml --runs 20 -o out").exits(0).says(&["20 of 20 runs are there"]);
    dir.run("simulate u.toml --runs 30 -o out").exits(0).says(&["20 of 30 runs are there"]);
    assert_eq!(numbers(&dir.path("out"), "run").len(), 30);
    dir.run("simulate u.toml --runs 20 --force -o out").exits(0);
    assert_eq!(numbers(&dir.path("out"), "run").len(), 20);
    dir.run("simulate u.toml --runs 3 --seed 8 --force -o out").exits(0);
    assert_eq!(numbers(&dir.path("out"), "seed"), [8.0; 3]);
    // A manifest that was edited, and parts without any.
    dir.write("out/manifest.toml", dir.text("out/manifest.toml").replace("seed = 8", "seed = 9"));
    dir.run("simulate u.toml --runs 3 --seed 9 -o out").exits(2).says(&["out/manifest.toml: was changed"]);
    std::fs::remove_file(dir.path("out/manifest.toml")).expect("there");
    dir.run("simulate u.toml --runs 3 --seed 9 -o out").exits(2).says(&["its campaign is unknown"]);
    dir.run("top out").exits(2).says(&["out: is not a campaign: it has no manifest.toml"]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn a_run_that_fails_is_a_row() {
    let wide = UNCERTAIN.replace("{ uniform = [0.3, 0.32] }", "{ normal = { mean = 0.31, sd = 0.3 } }");
    let dir = Dir::holding("u.toml", wide);
    let ran = dir.run("simulate u.toml --runs 20 -o out").exits(1);
    let (runs, columns) = (numbers(&dir.path("out"), "run"), rows(&dir.path("out")));
    let Some((_, ColumnCells::Text(errors))) = columns.last() else { panic!("no errors") };
    let failed: Vec<usize> = (0..20).filter(|row| errors[*row].is_some()).collect();
    assert!(runs.len() == 20 && failed.len() > 1 && failed.len() < 19);
    ran.says(&[&format!("{} of 20 runs failed; the first: run {}:", failed.len(), failed[0])]);
    assert!(errors.iter().flatten().all(|error| error.starts_with("u: `law.relay.k_t`: must be")));
    // The same again says the same; the first that fails may end it.
    dir.run("simulate u.toml --runs 20 -o out")
        .exits(1)
        .says(&[&format!("{} of 20 runs failed", failed.len())]);
    let first = format!("run {} failed, and --fail-fast stops there", failed[0]);
    dir.run("simulate u.toml --runs 20 --fail-fast -o fast").exits(1).says(&[&first]);
    dir.run("simulate u.toml --runs 20 --fail-fast").exits(1).says(&[&first]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn any_row_is_run_again_with_its_log() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.run("simulate u.toml --runs 30 --sample sobol --replicas 3 -o out").exits(0);
    let out = dir.path("out");
    let again = dir.run("simulate --from out --row 17 -o again --json").exits(0).json();
    assert_eq!(dir.names("again"), ["u-17.mcap"]);
    assert_eq!(again["metrics"]["gain_initial"], numbers(&out, "law.relay.k_t")[17]);
    assert_eq!(again["metrics"]["duty"], numbers(&out, "duty")[17]);
    // Replicas are one point; noise there is none.
    let rates = numbers(&out, "body.planar.rate");
    assert!(rates.chunks(3).all(|point| point[0] == point[1] && point[1] == point[2]));
    assert!(rates.windows(2).filter(|pair| pair[0] != pair[1]).count() == 9);
    dir.run("simulate --from out --row 30").exits(2).says(&["out: has runs 0 to 29, not 30"]);
    dir.run("simulate --from u.toml --row 3").exits(2).says(&["u.toml: is not a campaign"]);
    dir.run("simulate --from missing --row 3").exits(2).says(&["missing: is not a campaign"]);
    dir.run("simulate u.toml --from out --row 3").exits(2);
    // What the figures of it list.
    let drawn = dir.run("plot out -o figures").printed();
    let command = drawn.lines().find_map(|line| line.trim().strip_prefix("flexsc ")).expect("a command");
    dir.run(command).exits(0);
    assert!(
        dir.names("figures").iter().any(|name| name.contains("-distribution-")),
        "{:?}",
        dir.names("figures")
    );
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn parts_of_several_machines_are_merged() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    for (part, runs) in [("a", "0:300"), ("b", "300:400"), ("c", "400:1000"), ("all", "0:1000")] {
        dir.run(&format!("simulate u.toml --set duration=100 --runs {runs} -o {part}")).exits(0);
    }
    dir.run("merge a c -o merged").exits(1).says(&[
        "a: 300 runs",
        "c: 600 runs",
        "900 runs, 100 missing",
        "runs 300:400 are missing",
    ]);
    dir.run("merge b a -o merged").exits(0).says(&["b: 100 runs", "a: 0 runs", "1000 runs, 0 missing"]);
    assert!(rows(&dir.path("merged")) == rows(&dir.path("all")));
    let statistics = |name: &str| dir.text(&format!("{name}/statistics.csv"));
    assert_eq!(statistics("merged"), statistics("all"));
    dir.run("simulate u.toml --set duration=100 --runs 1000 -o merged")
        .exits(0)
        .says(&["1000 of 1000 runs are"]);
    let top = dir.run("top merged --json").exits(0).json();
    assert_eq!(
        (top["done"].as_u64(), top["runs"].as_u64(), top["failed"].as_u64()),
        (Some(1000), Some(1000), Some(0))
    );
    assert_eq!(top["metrics"]["gain_final"]["runs"], 1000);
    dir.run("top merged").exits(0).prints(&["1000 of 1000 runs, 0 failed", "gain_final"]);
    dir.run("simulate u.toml --runs 3 -o other").exits(0);
    dir.run("merge a other -o new").exits(2).says(&["other/manifest.toml", "another campaign (`duration`"]);
    assert!(!dir.has("new"));
    // A part whose rows were tampered with.
    std::fs::copy(
        dir.path("c/runs").join(&dir.names("c/runs")[0]),
        dir.path("b/runs").join(&dir.names("b/runs")[0]),
    )
    .expect("copied");
    dir.run("merge a b -o new").exits(2).says(&["b/runs/part-"]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn designs_have_lists_tables_ranges_and_replicas() {
    let dir = Dir::with(&["relay-fixed"]);
    let sweep = "sweep relay-fixed.toml --set duration=50 -o";
    dir.run(&format!("{sweep} list --vary law.relay.k_t=0.3,0.35 --vary law.relay.weak=1e-6:2e-6:3"))
        .exits(0);
    assert_eq!(numbers(&dir.path("list"), "law.relay.k_t"), [0.3, 0.3, 0.3, 0.35, 0.35, 0.35]);
    dir.write("points.csv", "law.relay.k_t, law.relay.weak\n0.31, 1e-6\n0.33, 2e-6\n");
    dir.run(&format!("{sweep} table --points points.csv --replicas 2")).exits(0);
    assert_eq!(numbers(&dir.path("table"), "law.relay.weak"), [1e-6, 1e-6, 2e-6, 2e-6]);
    for (method, name) in [("random", "r"), ("latin-hypercube", "l"), ("sobol", "s")] {
        let ranges = "--vary law.relay.k_t=0.3:0.4 --vary law.relay.weak=1e-6:2e-6";
        dir.run(&format!("{sweep} {name} {ranges} --sample {method}:64")).exits(0);
        let path = dir.path(name);
        let (gains, weak) = (numbers(&path, "law.relay.k_t"), numbers(&path, "law.relay.weak"));
        assert!(
            gains.iter().all(|gain| (0.3..0.4).contains(gain))
                && weak.iter().all(|w| (1e-6..2e-6).contains(w))
        );
        let mut cells: Vec<i64> = gains.iter().map(|gain| ((gain - 0.3) * 640.0) as i64).collect();
        cells.sort_unstable();
        // One in each of 64 intervals, but of random numbers.
        assert_eq!(cells == (0..64).collect::<Vec<_>>(), name != "r", "{method}");
        // A run is the same alone.
        dir.run(&format!("{sweep} {name}-alone {ranges} --sample {method}:64 --runs 17:18")).exits(0);
        assert_eq!(numbers(&dir.path(&format!("{name}-alone")), "law.relay.weak"), [weak[17]]);
    }
    for (wrong, why) in [
        ("--vary law.relay.k_t=0.3:0.4", "is a range, from which --sample takes points"),
        ("--vary law.relay.k_t=0.3:0.4 --sample sobol", "is a range, from which --sample takes points"),
        ("--vary law.relay.k_t=0.4:0.3 --sample sobol:4", "the lower one first"),
        ("--vary law.relay.k_t=0.3:0.4 --sample halton:4", "random, latin-hypercube, sobol"),
        ("--vary law.relay.k_t=0.3,0.4 --sample sobol:0", "needs a number of points"),
        ("--vary law.relay.k_t=0.3,x", "is not KEY=LO:HI:COUNT"),
        ("--vary law.relay.k_t=0.3,0.4 --runs 1:3", "the sweep has 2 runs"),
        ("--points missing.csv", "missing.csv"),
        ("--points relay-fixed.toml", "relay-fixed.toml"),
    ] {
        dir.run(&format!("{sweep} none {wrong}")).exits(2).says(&["error: ", why]);
        assert!(!dir.has("none"), "{wrong}");
    }
    for (text, why) in
        [("law.relay.k_t\n0.3\nx\n", "line 3"), ("0.3\n0.4\n", "keys of its columns"), ("a\n", "no point")]
    {
        dir.write("points.csv", text);
        dir.run(&format!("{sweep} none --points points.csv")).exits(2).says(&["points.csv", why]);
    }
    dir.run("simulate relay-fixed.toml --sample sobol").exits(2).says(&["(--runs)"]);
    dir.run("simulate relay-fixed.toml --runs 4 --sample sobol").exits(2).says(&["no key is uncertain"]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn uncertain_keys_are_drawn_together_and_evenly() {
    let together = "[[correlated]]\nkeys = [\"law.relay.k_t\", \"body.planar.rate\"]\nmatrix = [[1.0, 0.9], [0.9, 1.0]]\n";
    let dir = Dir::holding("u.toml", UNCERTAIN);
    dir.write("c.toml", format!("{UNCERTAIN}{together}"));
    for (out, arguments) in [("u", "u.toml"), ("c", "c.toml"), ("s", "c.toml --sample latin-hypercube")] {
        dir.run(&format!("simulate {arguments} --set duration=1 --runs 1000 --metrics duty -o {out}"))
            .exits(0);
    }
    let correlation = |name: &str| {
        let (x, y) =
            (numbers(&dir.path(name), "law.relay.k_t"), numbers(&dir.path(name), "body.planar.rate"));
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        let (mx, my) = (mean(&x), mean(&y));
        let product = |a: &[f64], ma: f64, b: &[f64], mb: f64| -> f64 {
            a.iter().zip(b).map(|(a, b)| (a - ma) * (b - mb)).sum()
        };
        product(&x, mx, &y, my) / (product(&x, mx, &x, mx) * product(&y, my, &y, my)).sqrt()
    };
    // Of a uniform and a normal number the correlation is sqrt(3/pi) 0.9 = 0.8795.
    // Three standard errors of 1000 runs: 3/sqrt(1000) = 0.095, and 3 (1 - 0.8795²)/sqrt(1000) = 0.021.
    assert!(correlation("u").abs() < 0.095, "{}", correlation("u"));
    for name in ["c", "s"] {
        assert!((correlation(name) - 0.8795).abs() < 0.02, "{name}: {}", correlation(name));
        assert!(numbers(&dir.path(name), "law.relay.k_t").iter().all(|gain| (0.3..0.32).contains(gain)));
    }
    // Where nothing is drawn together, nothing changed; the rate is the second key, and stays in its distribution.
    dir.write("wrong.toml", format!("{UNCERTAIN}{}", together.replace("0.9", "1.9")));
    dir.run("check wrong.toml").exits(2).says(&["correlated[0].matrix", "from -1 to 1"]);
    dir.write("wrong.toml", format!("{UNCERTAIN}{}", together.replace("body.planar.rate", "duration")));
    dir.run("check wrong.toml")
        .exits(2)
        .says(&["correlated[0].keys", "`duration`, which is no key of `[uncertain]`"]);
    dir.run("simulate u.toml --runs 5:9 --sample latin-hypercube").exits(2).says(&["latin-hypercube:1000"]);
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn a_full_disk_leaves_whole_parts() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let ran = dir.run_within(10, "simulate u.toml --runs 2000 --set duration=1 -o out").exits(1);
    ran.says(&["error: cannot write out/runs/part-", "File too large"]);
    assert!(dir.names("out/runs").is_empty(), "{:?}", dir.names("out/runs"));
    dir.run("simulate u.toml --runs 2000 --set duration=1 -o out").exits(0);
}
