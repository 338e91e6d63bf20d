//! Requirements: pointing indices of logs against direct sums, verdicts of runs and campaigns, exit codes, and errors.

use flexsc_core::metrics::{MetricValue, Metrics, MetricsCollector};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use crate::util::Dir;

/// A PD loop on one axis with a manoeuvre to follow no more: it settles and stays within its noise.
const HOLD: &str = r#"
name = "hold"
duration = 60.0

[body.planar]
angle = 1e-3
inertia = 100.0

[sensor.sampled]
period = 0.1
noise = 1e-5

[law.pd]
k_p = 25.0
k_d = 70.0
period = 0.1

[log]
period = 0.1
"#;

fn flown(text: &str) -> (Metrics, Trace) {
    let scenario = Scenario::parse("hold.toml", text).expect("valid");
    let (mut metrics, mut trace) = (MetricsCollector::new(&scenario), Trace::new(Detail::Full));
    Simulation::new(&scenario, 0).run(&mut (&mut metrics, &mut trace)).expect("a run");
    (metrics.finish(&scenario), trace)
}

fn values(metrics: &Metrics, name: &str) -> Vec<f64> {
    metrics.get(name).map(MetricValue::numbers).expect("a list")
}

/// Returns the order statistic of magnitudes at a level.
fn order(values: impl IntoIterator<Item = f64>, level: f64) -> f64 {
    let mut values: Vec<f64> = values.into_iter().map(f64::abs).collect();
    values.sort_by(f64::total_cmp);
    values[(level * values.len() as f64 - 1e-9).ceil() as usize - 1]
}

#[test]
fn indices_of_a_run_are_those_of_its_log() {
    let requirement = |name: &str, rest: &str| {
        format!(
            "\n[[requirement]]\nname = \"{name}\"\nquantity = \"pointing_error\"\nfrom = 20.0\nlimit = 1.0\n{rest}\n"
        )
    };
    let temporal = "level = 0.95\ninterpretation = \"temporal\"";
    let relative = |convention: &str| {
        format!("index = \"RPE\"\nwindow = 2.0\nconvention = \"{convention}\"\n{temporal}")
    };
    let text = [
        HOLD.to_owned(),
        requirement("ape", temporal),
        requirement("largest", ""),
        requirement("mpe", &format!("index = \"MPE\"\nwindow = \"2 s\"\n{temporal}")),
        requirement("end", &relative("end")),
        requirement("middle", &relative("middle")),
        requirement("uniform", &relative("uniform")),
        requirement("pde", &format!("index = \"PDE\"\nwindow = 2.0\nshift = 10.0\n{temporal}")),
    ];
    let (metrics, trace) = flown(&text.concat());
    let rows = trace.topic("/attitude").expect("the angle");
    // Rows are 0.1 s apart.
    let e = rows.numbers("angle_rad").expect("angles")[200..].to_vec();
    assert_eq!(e.len(), 401);
    let mean = |from: usize| e[from..from + 20].iter().sum::<f64>() / 20.0;
    let positions = 0..e.len() - 19;
    let expected = [
        order(e.clone(), 0.95),
        order(e.clone(), 1.0),
        order(positions.clone().map(mean), 0.95),
        order(positions.clone().map(|from| e[from + 19] - mean(from)), 0.95),
        order(positions.clone().map(|from| e[from + 10] - mean(from)), 0.95),
        order(
            (0..20)
                .flat_map(|window| (0..20).map(move |at| (20 * window, at)))
                .map(|(from, at)| e[from + at] - mean(from)),
            0.95,
        ),
        order((0..e.len() - 119).map(|from| mean(from + 100) - mean(from)), 0.95),
    ];
    for (found, expected) in values(&metrics, "requirement_values").into_iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-11, "{found:e}, {expected:e}");
    }
    assert_eq!(values(&metrics, "requirement_shares"), [1.0; 7]);
    assert_eq!(metrics.get("requirement"), Some(&MetricValue::Word("met")));
}

#[test]
fn a_requirement_does_not_change_the_motion() {
    let rate =
        "\n[[requirement]]\nname = \"rate\"\nquantity = \"rate_error\"\nperiod = 0.033\nlimit = 1e-9\n";
    let ((_, without), (metrics, with)) = (flown(HOLD), flown(&format!("{HOLD}{rate}")));
    let angles = |trace: &Trace| {
        trace.topic("/attitude").expect("rows").numbers("angle_rad").expect("a column").to_vec()
    };
    assert_eq!(angles(&without), angles(&with));
    assert_eq!(metrics.get("requirement"), Some(&MetricValue::Word("missed")));
}

#[test]
fn a_missed_requirement_ends_with_3_and_is_beside_no_plain_goal() {
    let dir = Dir::new();
    let text = |limit: &str| {
        format!(
            "{HOLD}\n[[requirement]]\nname = \"settling\"\nquantity = \"settling_time_s\"\nlimit = {limit}\n"
        )
    };
    dir.write("good.toml", text("\"1 min\""));
    dir.write("bad.toml", text("0.1"));
    dir.run("simulate good.toml --log none").exits(0).says(&[
        "hold   1 of 1 requirement met",
        "✓ settling",
        "at most 1 min",
    ]);
    dir.run("simulate bad.toml --log none").exits(3).says(&[
        "hold   MISSED: 1 of 1 requirement",
        "✗ settling",
        "× limit",
        "1 of 1 requirement not met; hold: settling is missed",
    ]);
    let object = dir.run("simulate bad.toml --log none --json").exits(3).json();
    let verdict = &object["requirements"][0];
    assert_eq!((verdict["verdict"].as_str(), verdict["limit"].as_f64()), (Some("missed"), Some(0.1)));
    assert_eq!(verdict["value"], object["metrics"]["settling_time_s"]);
    assert_eq!(object["metrics"]["requirement"], "missed");
    // A run that never settles has no value, and meets nothing.
    dir.write("short.toml", text("60.0").replace("duration = 60.0", "duration = 0.5"));
    dir.run("simulate short.toml --log none").exits(3).says(&["✗ settling   no value   at most 60 s"]);
}

#[test]
fn a_campaign_has_verdicts_with_intervals_and_confidence() {
    let dir = Dir::new();
    let requirement = "\n[[requirement]]\nname = \"error\"\nquantity = \"pointing_error\"\nfrom = 40.0\nlimit = 1e-3\nlevel = 0.8\ninterpretation = \"ensemble\"\nconfidence = 0.9\n";
    dir.write("study.toml", HOLD.to_owned() + requirement);
    // 1 - 0.8^10 = 0.893 is below the confidence; 11 runs give 0.914.
    let few = "simulate study.toml --runs 10 --table csv -o few --metrics itae";
    dir.run(few).exits(3).says(&[
        "undecided: 10 of 10 runs meet the requirement, 100 % (72 to 100 %)",
        "?  error",
        "confidence 89.3 %, 11 runs needed for 90 %",
    ]);
    dir.run("simulate study.toml --runs 11 -o enough")
        .exits(0)
        .says(&["✓  error", "error: met at 80 % of the runs; confidence 91.4 %, at least 90 %"]);
    for (table, verdict) in [("few/requirements.csv", "undecided"), ("enough/requirements.csv", "met")] {
        let text = dir.text(table);
        let mut lines = text.lines();
        assert!(
            lines.next().is_some_and(|heading| heading.starts_with("name,verdict,value,limit,unit,level,")),
            "{text}"
        );
        assert!(lines.next().is_some_and(|row| row.starts_with(&format!("error,{verdict},"))), "{text}");
    }
    assert!(
        dir.text("few/runs.csv").lines().next().is_some_and(|heading| heading.contains("requirement_values"))
    );
    // A sweep explores.
    dir.run("sweep study.toml --vary law.pd.k_d=60:70:3").exits(0);
}

#[test]
fn mixed_levels_of_a_campaign_count_all_values() {
    let dir = Dir::new();
    let requirement = |level: f64| {
        format!(
            "{HOLD}\n[[requirement]]\nname = \"error\"\nquantity = \"pointing_error\"\nfrom = 20.0\nlimit = 3e-6\nlevel = {level}\ninterpretation = \"mixed\"\n"
        )
    };
    dir.write("hold.toml", requirement(0.5));
    dir.run("simulate hold.toml --runs 6 --table csv -o runs");
    let text = dir.text("runs/requirements.csv");
    let cells: Vec<&str> = text.lines().nth(1).expect("a row").split(',').collect();
    let share: f64 = cells[7].parse().expect("a share");
    assert!(cells[2].is_empty() && share > 0.05 && share < 0.95, "{text}");
    for (level, code, mark) in [(share - 1e-6, 0, "✓  error"), (share + 1e-6, 3, "✗  error")] {
        dir.write("hold.toml", requirement(level));
        dir.run("simulate hold.toml --runs 6").exits(code).says(&["error: within its limit for ", mark]);
    }
}

#[test]
fn bad_requirements_are_refused_at_their_keys() {
    let dir = Dir::new();
    let sampled = "name = \"a\"\nquantity = \"pointing_error\"\n";
    for (table, expected) in [
        (
            "name = \"a\"\nquantity = \"pointing_eror\"\nlimit = 1.0",
            "quantity` must be `pointing_error`, `rate_error`, `line_of_sight` or a metric",
        ),
        ("name = \"a\"\nquantity = \"goal\"\nlimit = 1.0", "must be a number to have a limit"),
        (
            "name = \"a\"\nquantity = \"settling_time_s\"\nwindow = 1.0\nlimit = 1.0",
            "the quantity is the metric `settling_time_s`",
        ),
        (
            "name = \"a\"\nquantity = \"settling_time_s\"\nlimit = \"2 rad\"",
            "limit` has the unit `rad`, expected a unit such as `s`",
        ),
        ("name = \"\"\nquantity = \"settling_time_s\"\nlimit = 1.0", "name` must be a name of its own"),
        (
            "name = \"a\"\nquantity = \"line_of_sight\"\npoint = \"hub\"\nlimit = 1.0",
            "needs a `[[line_of_sight]]`",
        ),
        (
            &format!("{sampled}limit = \"two arcsec\""),
            "must be a number, or a number with a unit such as \"2 rad\"",
        ),
        (&format!("{sampled}limit = -1.0"), "limit` must be 0 or more"),
        (&format!("{sampled}limit = 1.0\nindex = \"RPE\"\nwindow = 1.0"), "convention` is missing"),
        (&format!("{sampled}limit = 1.0\nindex = \"MPE\""), "window` is missing: MPE needs it"),
        (
            &format!("{sampled}limit = 1.0\nindex = \"MPE\"\nwindow = 0.25"),
            "a whole number of sampling periods of 0.1 s",
        ),
        (
            &format!("{sampled}limit = 1.0\nwindow = 1.0"),
            "window` is for MPE, RPE, PDE and PRE, and the index is APE",
        ),
        (
            &format!("{sampled}limit = 1.0\nindex = \"PDE\"\nwindow = 2.0\nshift = 1.0"),
            "shift` must be at least the window",
        ),
        (&format!("{sampled}limit = 1.0\nlevel = 0.9"), "interpretation` is missing"),
        (
            &format!("{sampled}limit = 1.0\nlevel = 0.9\nindex = \"RPE\""),
            "window` is missing, and so are `convention`, `interpretation`",
        ),
        (
            &format!("{sampled}limit = 1.0\nlevel = 0.9\ninterpretation = \"mixed\"\nconfidence = 0.9"),
            "is for `interpretation = \"ensemble\"`",
        ),
        (&format!("{sampled}limit = 1.0\nconfidence = 0.9"), "needs a `level` below 1"),
        (&format!("{sampled}limit = 1.0\naxis = \"y\""), "must be `x`, the only axis"),
        (&format!("{sampled}limit = 1.0\nfrom = 9.0\nto = 8.0"), "to` must be after `from`"),
        (&format!("{sampled}limit = 1.0\nperiod = 1e-5"), "at most 1000000 are allowed"),
    ] {
        dir.write("bad.toml", format!("{HOLD}\n[[requirement]]\n{table}\n"));
        dir.run("simulate bad.toml").exits(2).says(&[expected, "requirement[0]", "bad.toml:"]);
    }
}

#[test]
fn a_budget_has_levels_of_all_runs_by_campaign_convolution_and_rule() {
    let dir = Dir::new();
    let requirement =
        "\n[[requirement]]\nname = \"error\"\nquantity = \"pointing_error\"\nfrom = 40.0\nlimit = 1e-3\n";
    dir.write("hold.toml", HOLD.to_owned() + requirement);
    let object = dir.run("budget hold.toml --runs 8 --json").exits(0).json();
    let budget = &object["budgets"][0];
    assert_eq!(
        (budget["name"].as_str(), object["requirements"][0]["verdict"].as_str()),
        (Some("error"), Some("met"))
    );
    let level = |place: usize, interpretation: &str, way: &str| {
        budget["levels"][place][interpretation][way].as_f64().expect("a number")
    };
    for place in 0..3 {
        // The mixed level is the least: the others take the worst run, or the worst time.
        let mixed = level(place, "mixed", "campaign");
        assert!(mixed > 0.0 && mixed <= level(place, "temporal", "campaign"));
        assert!(mixed <= level(place, "ensemble", "campaign"));
    }
    // Noise is nearly all of the error: by convolution 68.3 % is one standard deviation, as by the rule.
    let noise = budget["sources"]["noise"].as_f64().expect("a number");
    assert!(
        (level(0, "mixed", "rule") / noise - 1.0).abs() < 0.2
            && (level(0, "mixed", "convolution") / noise - 1.0).abs() < 0.2
    );
    dir.run("budget hold.toml --runs 8 -o budget.csv").exits(0).says(&[
        "temporal",
        "convolved",
        "k sigma",
        "✓  error",
    ]);
    let table = dir.text("budget.csv");
    let mut lines = table.lines();
    assert!(lines.next().is_some_and(|heading| heading.starts_with("budget,level,temporal_campaign,")));
    assert_eq!(lines.count(), 3);
    dir.write("bad.toml", HOLD.to_owned() + &requirement.replace("1e-3", "1e-9"));
    dir.run("budget bad.toml --runs 2 -o figures --format svg").exits(3).says(&["✗  error"]);
    assert!(dir.text("figures/hold-budget-error.svg").contains("<svg"));
    dir.write("none.toml", HOLD);
    dir.run("budget none.toml").exits(2).says(&["has no [[requirement]] on a pointing index"]);
}

/// The loop of `HOLD` settles within 30 s: the runs from then on have its stationary noise.
#[test]
fn the_linear_noise_of_a_budget_is_that_of_its_runs() {
    let requirement = |name: &str, rest: &str| {
        format!(
            "\n[[requirement]]\nname = \"{name}\"\nquantity = \"pointing_error\"\naxis = \"x\"\nfrom = 30.0\nlimit = 1.0\n\
             period = 0.1\n{rest}\n"
        )
    };
    let relative = |convention: &str| {
        requirement(convention, &format!("index = \"RPE\"\nwindow = 2.0\nconvention = \"{convention}\""))
    };
    let tables = [
        requirement("absolute", ""),
        requirement("mean", "index = \"MPE\"\nwindow = 2.0"),
        relative("uniform"),
        relative("end"),
        relative("middle"),
        requirement("drift", "index = \"PDE\"\nwindow = 2.0\nshift = 5.0"),
    ];
    let dir = Dir::holding("hold.toml", format!("{HOLD}{}", tables.concat()));
    let budget = dir.run("budget hold.toml --runs 40 --json").exits(0).json();
    for found in budget["budgets"].as_array().expect("a list") {
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        let (noise, sources) = (number(&found["linear_noise"]), &found["sources"]);
        // The bias of 40 runs of 30 s is what their noise leaves.
        let each = ["bias", "bias_spread", "noise"].map(|key| number(&sources[key]));
        let runs = each.iter().map(|part| part * part).sum::<f64>().sqrt();
        assert!(
            (runs / noise - 1.0).abs() < 0.1,
            "{}: {runs} in the runs, {noise} by the loop",
            found["name"]
        );
    }
    dir.run("budget hold.toml --runs 2").exits(0).says(&["noise of the linear loop at rest"]);
}

#[test]
fn a_metric_that_runs_do_not_have_is_refused() {
    let dir = Dir::with(&["attitude-hold"]);
    let text = std::fs::read_to_string(dir.path("attitude-hold.toml")).expect("a file");
    for (quantity, told) in [
        ("fuel_kg", "runs of this scenario do not have"),
        ("settling_time_s", "runs of this scenario do not have"),
    ] {
        let requirement =
            format!("\n[[requirement]]\nname = \"r\"\nquantity = \"{quantity}\"\nlimit = 1.0\n");
        std::fs::write(dir.path("limited.toml"), format!("{text}{requirement}")).expect("a file");
        for verb in ["simulate", "check", "budget", "worst"] {
            dir.run(&format!("{verb} limited.toml")).exits(2).says(&[
                "limited.toml",
                "requirement[0].quantity",
                told,
            ]);
        }
    }
}

/// An empty collector, by which requirements are checked, has the metrics of the run.
#[test]
fn the_metrics_of_a_scenario_are_known_before_its_run() {
    for name in [
        "relay-fixed",
        "relay-adaptive",
        "wheel-ekf",
        "iss-manoeuvre",
        "attitude-hold",
        "earth-observer",
        "thruster-phase-plane",
        "momentum-unloading",
        "orbit-correction",
        "agile-observer",
        "wheel-friction",
        "rotation-sine",
        "panel-deployment",
    ] {
        let scenario = crate::open_loops::scenario(name);
        let names = |metrics: &Metrics| metrics.0.iter().map(|(meaning, _)| meaning.name).collect::<Vec<_>>();
        let mut run = MetricsCollector::new(&scenario);
        Simulation::new(&scenario, 0).run(&mut run).expect("a run");
        let before = names(&MetricsCollector::new(&scenario).finish(&scenario));
        assert_eq!(before, names(&run.finish(&scenario)), "{name}");
    }
}
