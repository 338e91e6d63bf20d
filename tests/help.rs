//! Promises of `--help`: verbs in groups, and examples that work as they stand, one after another in one directory, with
//! options of any value too.

use crate::control_client::ControlClient;
#[cfg(unix)]
use crate::extremes::every_option_ends_in_seconds;
use crate::util::{Dir, SCENARIOS, has_extension};

/// Returns the examples at the end of a verb's help, without redirections.
pub fn examples(dir: &Dir, verb: &str) -> Vec<String> {
    let ran = dir.run(&format!("{verb} --help")).exits(0);
    let (_, examples) = ran.out.split_once("Examples:\n").unwrap_or_else(|| panic!("{verb}: {}", ran.out));
    let lines = examples.lines().filter_map(|line| line.trim().strip_prefix("flexsc "));
    lines.map(|line| line.split(" > ").next().unwrap_or(line).to_owned()).collect()
}

/// Runs an example that waits for a control program, with one that commands no torque, on a port that is free.
fn answered(dir: &Dir, line: &str) {
    let mut server = dir.start(&format!("{line} --set duration=10 --bind 127.0.0.1:0"));
    let line = server.line("  serve ");
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut client = ControlClient::connect(words[1], words[2].trim_end_matches(',')).expect("a welcome");
    assert_eq!(client.control(u64::MAX, 0, |_| vec![0.0; 3]), Ok(Some(0)));
    server.wait().exits(0);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn every_example_works_and_every_option_ends_in_seconds_whatever_its_value() {
    let dir = Dir::new();
    for entry in std::fs::read_dir(SCENARIOS).expect("shipped").flatten() {
        if has_extension(&entry.file_name().to_string_lossy(), "toml") {
            std::fs::copy(entry.path(), dir.path(&entry.file_name().to_string_lossy())).expect("copied");
        }
    }
    let overview = dir.run("--help").printed();
    let verbs = overview.lines().filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
    let verbs: Vec<&str> = verbs.filter(|word| !word.starts_with('-')).collect();
    assert_eq!(verbs.len(), 33, "{overview}");
    // The papers take a minute, are of the full build, and have a test of their own.
    for verb in verbs.into_iter().filter(|verb| *verb != "reproduce") {
        let examples = examples(&dir, verb);
        assert_eq!(examples.len(), 2, "{verb}");
        for line in &examples {
            if verb == "serve" && !line.contains("--describe") {
                answered(&dir, line);
            } else {
                dir.run(line).exits(0);
            }
        }
    }
    #[cfg(unix)]
    every_option_ends_in_seconds(&dir);
}
