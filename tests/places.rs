//! Where `-o` leads: a file by its ending, a directory otherwise, and never the input.

use crate::util::{Dir, FLEXSC, UNCERTAIN};

/// A directory with a log, a scenario of a sampled loop and two campaigns of one scenario.
fn furnished() -> Dir {
    let dir = Dir::with(&["relay-fixed", "wheel-fixed-gain", "rotation-cosine"]);
    dir.write("u.toml", UNCERTAIN);
    dir.run("simulate relay-fixed.toml --set duration=300").exits(0);
    dir
}

const GRID: &str = "map wheel-fixed-gain.toml --frequency 0.5:1:2 --period 0.2:0.4:2 -o";

#[test]
fn a_file_is_written_where_its_ending_makes_sense() {
    let dir = furnished();
    for (command, file, begin) in [
        ("simulate relay-fixed.toml --set duration=300 -o", "deep/er/x.mcap", "\u{89}MCAP"),
        ("simulate u.toml --set duration=50 --runs 3 -o", "deep/runs.csv", "run,seed,"),
        (
            "sweep relay-fixed.toml --set duration=50 --vary law.relay.k_t=0.3,0.35 -o",
            "s/s.csv",
            "run,seed,law",
        ),
        ("examples wheel-ekf -o", "e/ex.toml", "# "),
        (GRID, "m/map.csv", "frequency_rad_s,"),
        (GRID, "m/map.svg", "<svg"),
        ("plan rotation-cosine.toml -o", "p/plan.svg", "<svg"),
        ("plan rotation-cosine.toml -o", "p/plan.csv", "time_s,angle_rad,"),
        ("damping --frequency 0.5:5:5 --acceleration 0.1 -o", "d/d.svg", "<svg"),
        ("damping --frequency 0.5:5:5 --acceleration 0.1 -o", "d/d.csv", "frequency_rad_s,"),
        ("layout relay-fixed.toml -o", "l/lay.json", "{"),
        ("log recover relay-fixed.mcap -o", "r/saved.mcap", "\u{89}MCAP"),
        ("export relay-fixed.mcap --topic /command -o", "t/c.csv", "time_s,"),
        ("export relay-fixed.mcap --topic /command -o", "t/c.jsonl", "{\"time_s\""),
        ("plot relay-fixed.mcap --what torque -o", "f/f.svg", "<svg"),
    ] {
        dir.run(&format!("{command} {file}")).exits(0);
        let bytes = dir.read(file);
        // The first byte of a log is no character by itself.
        let text: String = bytes.iter().take(40).map(|byte| char::from(*byte)).collect();
        assert!(text.contains(begin), "{command} {file}: {text}");
        // The same command may write the same again.
        if !command.contains(" --runs ") && !command.starts_with("sweep") {
            dir.run(&format!("{command} {file}")).exits(0);
        }
        if !file.ends_with("x.mcap") {
            dir.write(file, "mine");
            dir.run(&format!("{command} {file}")).exits(2).says(&[
                file,
                "already exists",
                "hint: --force replaces it",
            ]);
            assert_eq!(dir.text(file), "mine", "{command} {file}");
            dir.run(&format!("{command} {file} --force")).exits(0);
            assert_ne!(dir.read(file), b"mine", "{command} {file}");
        }
    }
    dir.run("new n/e/w").exits(0);
    assert!(dir.text("n/e/w.toml").starts_with("# "));
}

#[test]
fn other_endings_are_refused_and_nothing_is_made() {
    let dir = furnished();
    let before = dir.names("");
    for (command, accepted) in [
        ("simulate relay-fixed.toml -o x.csv", ".mcap, or a directory"),
        ("simulate relay-fixed.toml --log none -o x.mcap", "--log none"),
        ("simulate relay-fixed.toml u.toml -o x.mcap", "several scenarios"),
        ("simulate u.toml --runs 3 -o x.mcap", ".csv or .parquet, or a directory"),
        ("simulate u.toml --runs 3 --log events -o x.csv", "--log"),
        ("simulate u.toml --runs 3 --table parquet -o x.csv", "--table"),
        ("sweep relay-fixed.toml --vary law.relay.k_t=0.3,0.35 -o s.svg", ".csv or .parquet"),
        ("examples wheel-ekf -o ex.csv", ".toml"),
        ("examples wheel-ekf wheel-wheel -o ex.toml", "several examples"),
        ("new x.mcap", ".toml"),
        ("plan rotation-cosine.toml -o plan.parquet", ".svg, .png, .pdf or .csv"),
        ("plan rotation-cosine.toml --format svg -o plan.csv", "--format"),
        ("plan rotation-cosine.toml --coordinate angle -o plan.csv", "--coordinate"),
        ("damping --frequency 0.5:5:5 --acceleration 0.1 -o dd.mcap", ".svg, .png, .pdf or .csv"),
        ("damping --frequency 0.5:5:5 --acceleration 0.1 --format pdf -o dd.csv", "--format"),
        ("observer --frequency 1.2566 -o observer.csv", ".svg, .png or .pdf"),
        ("plot relay-fixed.mcap -o f.jpg", ".svg, .png or .pdf"),
        ("layout relay-fixed.toml -o lay", "must end in .json"),
        ("log recover relay-fixed.mcap -o rec", "must end in .mcap"),
        ("export relay-fixed.mcap --topic /command -o c", ".glb, .bin or .json"),
        ("export relay-fixed.mcap --topic /command --format csv -o c.jsonl", "--format"),
        ("export relay-fixed.mcap -o all.csv", "--topic"),
        (
            "map wheel-fixed-gain.toml --frequency 0.5:1:2 --period 0.2:0.4:2 -o m.mcap",
            ".csv, .svg, .png or .pdf",
        ),
    ] {
        dir.run(command).exits(2).says(&[accepted]);
        assert_eq!(dir.names(""), before, "{command}");
    }
    // No ending: a directory.
    dir.run(&format!("{GRID} mm")).exits(0);
    assert!(dir.has("mm/wheel-fixed-gain-map.svg"));
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn rows_of_a_campaign_go_to_one_file() {
    let dir = Dir::holding("u.toml", UNCERTAIN);
    let simulate = "simulate u.toml --set duration=50";
    dir.run(&format!("{simulate} --runs 8 --table csv -o whole")).exits(0);
    dir.run(&format!("{simulate} --runs 8 -o rows.csv")).exits(0).says(&["rows.csv"]);
    assert_eq!(dir.text("rows.csv"), dir.text("whole/runs.csv"));
    dir.run(&format!("{simulate} --runs 8 -o rows.parquet")).exits(0);
    assert!(dir.read("rows.parquet").starts_with(b"PAR1"));
    for (part, runs) in [("a", "0:5"), ("b", "3:8")] {
        dir.run(&format!("{simulate} --runs {runs} -o {part}")).exits(0);
    }
    dir.run("merge a b -o merged.csv").exits(0).says(&["a: 5 runs", "b: 3 runs", "merged.csv: 8 runs"]);
    assert_eq!(dir.text("merged.csv"), dir.text("rows.csv"));
    dir.run("merge a b -o merged.svg").exits(2).says(&[".csv or .parquet"]);
    assert!(!dir.names("").iter().any(|name| name.ends_with("statistics.csv")));
}

#[cfg(unix)]
#[test]
fn an_input_is_no_output() {
    let dir = furnished();
    dir.write("points.csv", "law.relay.k_t\n0.3\n0.31\n");
    std::fs::hard_link(dir.path("relay-fixed.mcap"), dir.path("hard.csv")).expect("linked");
    std::os::unix::fs::symlink("relay-fixed.toml", dir.path("soft.json")).expect("linked");
    std::fs::hard_link(dir.path("wheel-fixed-gain.toml"), dir.path("map.csv")).expect("linked");
    std::fs::hard_link(dir.path("rotation-cosine.toml"), dir.path("plan.svg")).expect("linked");
    std::fs::hard_link(dir.path("rotation-cosine.toml"), dir.path("plan.csv")).expect("linked");
    std::os::unix::fs::symlink("relay-fixed.mcap", dir.path("soft.svg")).expect("linked");
    std::fs::hard_link(dir.path("u.toml"), dir.path("u.csv")).expect("linked");
    std::fs::hard_link(dir.path("u.toml"), dir.path("u.mcap")).expect("linked");
    let all = dir.names("");
    let before: Vec<_> = all.iter().map(|name| dir.read(name)).collect();
    for command in [
        "export relay-fixed.mcap --topic /command -o relay-fixed.mcap",
        "export relay-fixed.mcap --topic /command -o hard.csv",
        "layout relay-fixed.mcap -o relay-fixed.mcap",
        "layout relay-fixed.toml -o relay-fixed.toml",
        "layout relay-fixed.toml -o soft.json",
        "map wheel-fixed-gain.toml --frequency 0.5:1:2 --period 0.2:0.4:2 -o wheel-fixed-gain.toml",
        "map wheel-fixed-gain.toml --frequency 0.5:1:2 --period 0.2:0.4:2 -o map.csv",
        "plan rotation-cosine.toml -o plan.csv",
        "plan rotation-cosine.toml -o plan.svg",
        "plot relay-fixed.mcap -o soft.svg",
        "log recover relay-fixed.mcap -o ./relay-fixed.mcap",
        "simulate u.toml -o u.mcap",
        "simulate u.toml --runs 2 -o u.csv",
        "sweep relay-fixed.toml --points points.csv -o points.csv",
    ] {
        let force =
            if command.starts_with("sweep") || command.starts_with("export") { " --force" } else { "" };
        dir.run(&format!("{command}{force}")).exits(2).says(&["is the input", "would be lost"]);
        assert!(
            crate::study::pairs(&all, &before).all(|(name, bytes)| dir.read(name) == *bytes),
            "{command}"
        );
    }
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_enough_is_no_failure() {
    use std::process::{Command, Stdio};

    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml --set duration=3000 --log full").exits(0);
    for format in ["csv", "jsonl"] {
        let mut child = Command::new(FLEXSC)
            .args(["export", "relay-fixed.mcap", "--topic", "/attitude", "--format", format])
            .current_dir(dir.path(""))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        drop(child.stdout.take());
        let done = child.wait_with_output().expect("ended");
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success() && said.is_empty(), "{format}: {} {said}", done.status);
    }
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn a_file_that_the_scenario_names_is_no_output() {
    let dir = Dir::new();
    dir.write("m.csv", "frequency,damping,tx,ty,tz,rx,ry,rz\n1.5,0.005,0.055,0.19,0.093,0.41,0.43,0.13\n");
    let scenario = "duration = 20.0\n[spacecraft]\nmass = 600.0\ninertia = [[250, 0, 0], [0, 300, 0], [0, 0, 220]]\n\
        [[appendage]]\nname = \"a\"\nmass = 14.4\ncentre = [2.4, 0.27, 0.89]\nat = [0.5, 0, 0]\nmodes = \"m.csv\"\n\
        inertia = [[14.8, -2.4, -8.0], [-2.4, 24.4, -4.3], [-8.0, -4.3, 15.7]]\n\
        [sensor.sampled]\nperiod = 0.5\nnoise = 4e-6\nrate_noise = 1e-6\n\
        [law.pd]\nk_p = 1.0\nk_d = 20.0\nperiod = 0.5\n[uncertain.\"law.pd.k_d\"]\nuniform = [18.0, 22.0]\n";
    dir.write("t.toml", scenario);
    dir.run("check t.toml").exits(0);
    for (name, target) in [("m.svg", "m.csv"), ("m.json", "m.csv"), ("m.fmu", "m.csv"), ("m.html", "m.csv")] {
        std::os::unix::fs::symlink(target, dir.path(name)).expect("linked");
    }
    std::fs::hard_link(dir.path("m.csv"), dir.path("m.mcap")).expect("linked");
    let before = dir.read("m.csv");
    for command in [
        "simulate t.toml --runs 3 -o m.csv --force",
        "simulate t.toml -o m.mcap --force",
        "sweep t.toml --vary law.pd.k_p=300,400 -o m.csv --force",
        "spectrum t.toml -o m.csv --force",
        "margins t.toml -o m.svg --force",
        "worst t.toml --margin modulus --points 2 -o m.csv --force",
        "layout t.toml -o m.json --force",
        "export-fmu t.toml -o m.fmu --force",
        "serve t.toml --bind 127.0.0.1:0 -o m.mcap --force",
    ] {
        dir.run(command).exits(2).says(&["is the input", "m.csv, which would be lost"]);
        assert!(dir.read("m.csv") == before, "{command}");
    }
    // The library of an FMU is an input, too.
    dir.run("export-fmu t.toml -o a.fmu").exits(0);
    dir.run("export-fmu t.toml --library a.fmu -o a.fmu --force").exits(2).says(&["is the input a.fmu"]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn figures_replace_figures_and_nothing_else() {
    let dir = Dir::with(&["earth-observer"]);
    let margins = "margins earth-observer.toml -o d";
    std::fs::create_dir(dir.path("d")).expect("made");
    dir.write("d/bode.svg", "not mine");
    dir.run(margins).exits(0);
    assert_eq!(dir.text("d/bode.svg"), "not mine");
    let names = dir.names("d");
    assert!(names.contains(&"earth-observer-bode.svg".to_owned()), "{names:?}");
    // Figures of before are replaced.
    dir.run(&format!("{margins} --set law.attitude.bandwidth=0.05")).exits(0);
    for ending in ["svg", "png", "pdf"] {
        let name = format!("d/earth-observer-nichols.{ending}");
        dir.write(&name, "not mine");
        let again = format!("{margins} --format {ending}");
        dir.run(&again).exits(2).says(&["already exists, with other content", "--force replaces it"]);
        assert_eq!(dir.text(&name), "not mine");
        dir.run(&format!("{again} --force")).exits(0);
        assert_ne!(dir.read(&name), b"not mine");
        dir.run(&format!("{again} --set law.attitude.bandwidth=0.06")).exits(0);
    }
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn endless_inputs_are_refused_and_a_pipe_without_a_reader_can_be_left() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("sweep relay-fixed.toml --points /dev/zero").exits(2).says(&["must have at most 67108864 bytes"]);
    dir.run("export-fmu relay-fixed.toml --library /dev/zero -o a.fmu")
        .exits(2)
        .says(&["/dev/zero: not a file"]);
    let made = std::process::Command::new("mkfifo").arg(dir.path("pipe")).status().expect("mkfifo starts");
    assert!(made.success());
    let waiting = dir.start("layout relay-fixed.toml -o pipe");
    std::thread::sleep(std::time::Duration::from_millis(500));
    let began = std::time::Instant::now();
    waiting.signal("TERM").exits(130);
    assert!(began.elapsed() < std::time::Duration::from_secs(1), "{:?}", began.elapsed());
}
