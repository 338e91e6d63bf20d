//! Habits of the command: options have the same names in every verb, files and directories are distinguished, and no
//! file is lost.

use std::collections::BTreeSet;

use crate::util::{Dir, UNCERTAIN, has_extension};

/// Returns a directory with a short run without anything random.
fn quiet() -> Dir {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml --set duration=400").exits(0);
    dir
}

#[test]
fn options_have_one_name_in_all_verbs() {
    let command = flexsc_cli::command();
    for verb in command.get_subcommands() {
        let options =
            verb.get_arguments().chain(verb.get_subcommands().flat_map(clap::Command::get_arguments));
        for option in options {
            let (name, short) = (option.get_long(), option.get_short());
            assert_eq!(short == Some('o'), name == Some("out"), "{}: {name:?}", verb.get_name());
            assert_ne!(name, Some("output"), "{}", verb.get_name());
            for forms in option.get_value_names().into_iter().flatten() {
                let parts: BTreeSet<&str> = forms.split([':', '|']).collect();
                for other in ["START", "END", "STEP", "FROM", "TO"] {
                    assert!(!parts.contains(other), "{} {name:?}: {forms}", verb.get_name());
                }
                if forms.matches(':').count() == 2 {
                    assert_eq!(forms.as_str(), "LO:HI:COUNT", "{} {name:?}", verb.get_name());
                }
            }
        }
    }
}

#[test]
fn old_names_are_still_taken() {
    let dir = Dir::with(&["wheel-fixed-gain", "rotation-sine"]);
    let grid = "--frequency 0.5:0.6:2 --period 0.3:0.4:2";
    dir.run(&format!("map wheel-fixed-gain.toml {grid} --output old.csv")).exits(0);
    dir.run(&format!("map wheel-fixed-gain.toml {grid} --out new.csv")).exits(0);
    assert_eq!(dir.text("old.csv"), dir.text("new.csv"));
    dir.run("examples relay-fixed --output copies").exits(0);
    assert!(dir.has("copies/relay-fixed.toml"));
    dir.run("plan rotation-sine.toml --compare --output angle").exits(0);
}

#[test]
fn a_name_that_ends_in_a_form_is_a_file_in_every_verb_that_draws() {
    let dir = Dir::with(&["wheel-fixed-gain", "wheel-scheduled-gain", "rotation-sine"]);
    let grid = "--frequency 0.5:0.6:2 --period 0.3:0.4:2";
    for (index, verb) in [
        format!("map wheel-fixed-gain.toml {grid}"),
        "plan rotation-sine.toml".to_owned(),
        "tune wheel-scheduled-gain.toml --frequency 0.3:0.4:2 --gain 0:2:3".to_owned(),
        "damping --frequency 0.5:8:4 --acceleration 4e-5".to_owned(),
        "observer --frequency 1.556".to_owned(),
        "identify --runs 2 --off 0.1 --modes 1.556:2.89".to_owned(),
    ]
    .iter()
    .enumerate()
    {
        let file = format!("{index}.svg");
        dir.run(&format!("{verb} -o {file}")).exits(0);
        assert!(dir.text(&file).starts_with("<svg "), "{verb}");
        dir.run(&format!("{verb} --figures {index} --format svg")).exits(0);
        assert!(dir.names(&index.to_string()).iter().all(|name| has_extension(name, "svg")), "{verb}");
        assert!(!dir.names(&index.to_string()).is_empty(), "{verb}");
        dir.run(&format!("{verb} --figures {index}.gif")).exits(2).says(&["cannot be written as .gif"]);
    }
}

#[test]
fn runs_without_randomness_are_reported() {
    let dir = quiet();
    let warning = "warning: no metric differs between the 3 runs";
    let alike =
        dir.run("simulate relay-fixed.toml --set duration=400 --runs 3 --all").exits(0).says(&[warning]);
    // Their deviation is nothing, and no rounding.
    let rows: Vec<&str> = alike.err.lines().filter(|line| line.starts_with("  duty ")).collect();
    assert!(rows.len() == 1 && rows[0].split_whitespace().nth(3) == Some("0"), "{}", alike.err);
    for random in ["simulate u.toml --runs 3", "simulate relay-fixed.toml --set duration=400"] {
        dir.write("u.toml", UNCERTAIN);
        assert!(!dir.run(random).exits(0).err.contains("warning"), "{random}");
    }
    // A sweep prints its differences itself.
    let swept = dir.run("sweep relay-fixed.toml --set duration=400 --vary seed=1:3:3").exits(0);
    assert!(!swept.err.contains("warning"), "{}", swept.err);
}

#[test]
fn statistics_of_a_sweep_leave_out_what_was_swept() {
    let dir = quiet();
    let said = |vary: &str| {
        dir.run(&format!("sweep relay-fixed.toml --set duration=400 --vary {vary}")).exits(0).err
    };
    let swept = said("law.relay.k_t=0.30:0.34:3");
    assert!(!swept.contains("gain_") && swept.contains("duty"), "{swept}");
}

#[test]
fn a_sweep_has_a_log_of_each_row() {
    let dir = quiet();
    let sweep =
        "sweep relay-fixed.toml --set duration=400 --vary law.relay.k_t=0.30:0.34:3 --table csv -o out";
    dir.run(&format!("{sweep} --log events")).exits(0).says(&["relay-fixed-0.mcap to", "relay-fixed-2.mcap"]);
    let logs = dir.names("out");
    let logs: Vec<&String> = logs.iter().filter(|name| has_extension(name, "mcap")).collect();
    assert_eq!(logs, ["relay-fixed-0.mcap", "relay-fixed-1.mcap", "relay-fixed-2.mcap"]);
    // Each is of its row.
    for (row, gain) in [(0, "0.3"), (2, "0.34")] {
        let scenario = dir.run(&format!("log scenario out/relay-fixed-{row}.mcap")).printed();
        assert!(scenario.contains(&format!("k_t = {gain}\n")), "{scenario}");
    }
    dir.run(&format!("{sweep} --log events")).exits(0);
    dir.run("plot out -o drawn --what fan --format svg").exits(0);
    // Logs of other settings are not lost.
    let other = sweep.replace("0.34", "0.36").replace("-o out", "-o out --force");
    dir.run(&other.replace(" --force", "")).exits(2).says(&["another campaign", "--force"]);
    dir.run(&format!("{other} --log events")).exits(0);
}

#[test]
fn a_run_does_not_replace_what_another_scenario_left() {
    let dir = quiet();
    let before = dir.read("relay-fixed.mcap");
    // The same again, as every day.
    dir.run("simulate relay-fixed.toml --set duration=400").exits(0);
    assert_eq!(dir.read("relay-fixed.mcap"), before);
    dir.run("simulate relay-fixed.toml --set duration=500")
        .exits(2)
        .says(&["`duration`: 400.0 before, 500.0 now", "--force"]);
    assert_eq!(dir.read("relay-fixed.mcap"), before);
    dir.run("simulate relay-fixed.toml --set duration=500 --force").exits(0);
    assert_ne!(dir.read("relay-fixed.mcap"), before);
}

#[test]
fn metrics_are_exported_as_a_table_for_people() {
    let dir = Dir::with(&["relay-adaptive"]);
    dir.run("simulate relay-adaptive.toml --set duration=1200").exits(0);
    dir.run("export relay-adaptive.mcap --topic /metrics -o metrics.csv").exits(0);
    let text = dir.text("metrics.csv");
    let mut table = csv::Reader::from_reader(text.as_bytes());
    assert_eq!(table.headers().expect("a header"), vec!["name", "value", "unit", "meaning"]);
    let rows: Vec<[String; 4]> = table.deserialize().collect::<Result<_, _>>().expect("rows");
    let of =
        |name: &str| rows.iter().find(|row| row[0] == name).unwrap_or_else(|| panic!("no {name} in\n{text}"));
    let reported = dir.run("simulate relay-adaptive.toml --set duration=1200 --json").exits(0).json();
    let metrics = &reported["metrics"];
    for name in ["switchings", "duty", "envelope_mean_rad"] {
        assert_eq!(of(name)[1].parse::<f64>().ok(), metrics[name].as_f64(), "{name}");
    }
    assert_eq!(of("switchings")[3], "Number of switchings of the law");
    assert_eq!(
        (of("envelope_mean_rad")[2].as_str(), of("goal")[1].as_str()),
        ("rad", metrics["goal"].as_str().expect("a word"))
    );
    // Missing values are empty, and a list has a row for each element.
    assert_eq!((of("gain_frozen_at_s")[1].as_str(), of("gain_frozen_at_s")[2].as_str()), ("", "s"));
    let means = metrics["envelope_window_means_rad"].as_array().expect("a list");
    for (index, mean) in means.iter().enumerate() {
        assert_eq!(of(&format!("envelope_window_means_rad[{index}]"))[1].parse::<f64>().ok(), mean.as_f64());
    }
    let lines = dir.run("export relay-adaptive.mcap --topic /metrics --format jsonl").printed();
    assert_eq!(lines.lines().count(), rows.len());
    assert!(lines.starts_with("{\"name\":\"switchings\",\"value\":"), "{lines}");
}

/// Verbs that write a file can replace one, and those that print quantities print them in SI units too.
#[test]
fn force_and_units_are_in_every_verb_that_can_have_them() {
    let command = flexsc_cli::command();
    let has =
        |verb: &clap::Command, name: &str| verb.get_arguments().any(|option| option.get_long() == Some(name));
    for verb in command.get_subcommands().flat_map(|verb| std::iter::once(verb).chain(verb.get_subcommands()))
    {
        if has(verb, "out") && verb.get_name() != "reproduce" {
            assert!(has(verb, "force"), "{}", verb.get_name());
        }
    }
    let with: BTreeSet<&str> =
        command.get_subcommands().filter(|verb| has(verb, "units")).map(clap::Command::get_name).collect();
    let all = [
        "bound", "budget", "compare", "cycle", "damping", "identify", "map", "margins", "modes", "observer",
        "plan", "plot", "serve", "simulate", "spectrum", "sweep", "tune", "worst",
    ];
    assert_eq!(with, BTreeSet::from(all));
}
