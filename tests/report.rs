//! `flexsc report`: a page that stands alone, has the output of the commands it names, and is the same each time.

use crate::util::Dir;

#[test]
fn a_page_for_a_review() {
    let dir = Dir::with(&["attitude-hold"]);
    let line = "report attitude-hold.toml --runs 3 --set duration=20";
    dir.run(&format!("{line} -o study.html"))
        .exits(0)
        .says(&["flexsc margins attitude-hold.toml", "study.html"]);
    let page = dir.text("study.html");
    for title in ["Spacecraft", "Margins at the command", "Margins at the measurement", "One run", "Campaign"]
    {
        assert!(page.contains(&format!("<h2>{title}</h2>")), "{title}");
    }
    // Each block is what its command prints.
    let margins = dir.run("margins attitude-hold.toml --set duration=20").exits(0).err;
    for line in margins.lines().filter(|line| !line.is_empty()) {
        assert!(page.contains(&line.replace('&', "&amp;")), "{line}");
    }
    for command in [
        "flexsc modes attitude-hold.toml --set 'duration=20'",
        "flexsc margins attitude-hold.toml --set 'duration=20' -o margins",
        "flexsc simulate attitude-hold.toml --set 'duration=20' -o run.mcap",
        "flexsc simulate attitude-hold.toml --set 'duration=20' --runs 3 -o campaign",
    ] {
        assert!(page.contains(&format!("<code>{command}</code>")), "{command}");
    }
    assert!(page.matches("<svg").count() >= 8, "{}", page.matches("<svg").count());
    // Long lines wrap on the screen too.
    let (screen, _) = page.split_once("@media print").expect("a style for print");
    assert!(screen.contains("white-space: pre-wrap"));
    // The page refers to no other file, and names nothing of the computer.
    for outside in ["http://", "https://", "<script", "<link", "<img", "/tmp", " ms"] {
        let found = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!found.contains(outside), "{outside}");
    }
    dir.run(&format!("{line} -o again.html")).exits(0);
    assert_eq!(page, dir.text("again.html"));
    dir.run(&format!("{line} -o study.html")).exits(2).says(&["already exists", "--force"]);
}

#[test]
fn what_has_no_numbers_has_a_reason() {
    let dir = Dir::with(&["relay-fixed"]);
    let line = "report relay-fixed.toml -o page.html --runs 0 --set duration=2000";
    dir.run(line).exits(0).says(&["without numbers", "Margins at the command"]);
    let page = dir.text("page.html");
    assert!(page.contains("class=\"refused\"") && page.contains("is not linear"));
    assert!(!page.contains("<h2>Campaign</h2>"));
    for (arguments, told) in [
        ("-o page.pdf", "cannot be written as .pdf"),
        ("-o page", "must end in"),
        ("-o other.html --runs 1000000", "--runs must be at most 100000"),
        ("-o other.html --set law.relay.k=1", "unknown key"),
        ("", "--out"),
    ] {
        dir.run(&format!("report relay-fixed.toml {arguments}")).exits(2).says(&[told]);
    }
    assert!(!dir.path("other.html").exists());
}

/// Returns the processes whose parent is this one.
#[cfg(target_os = "linux")]
fn children(parent: u32) -> Vec<u32> {
    let all = std::fs::read_dir("/proc").expect("there").flatten();
    let numbers = all.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    let is_child = |number: &u32| {
        let stat = std::fs::read_to_string(format!("/proc/{number}/stat")).unwrap_or_default();
        let after_name = stat.rsplit(')').next().unwrap_or_default();
        after_name.split_whitespace().nth(1) == Some(&parent.to_string())
    };
    numbers.filter(is_child).collect()
}

#[cfg(target_os = "linux")]
#[test]
fn a_report_that_is_killed_takes_its_command_along() {
    use std::time::{Duration, Instant};

    let dir = Dir::with(&["earth-observer"]);
    std::fs::create_dir(dir.path("tmp")).expect("made");
    let begin = format!("export TMPDIR={}", dir.path("tmp").display());
    let report = dir.start_by(&begin, "report earth-observer.toml --set duration=1e8 --runs 0 -o r.html");
    let is_running = |pid: u32, word: &str| {
        std::fs::read_to_string(format!("/proc/{pid}/cmdline")).is_ok_and(|line| line.contains(word))
    };
    let began = Instant::now();
    // A run of this length takes minutes.
    let child = loop {
        let found = children(report.id()).into_iter().find(|pid| is_running(*pid, "simulate"));
        if let Some(child) = found {
            break child;
        }
        assert!(began.elapsed() < Duration::from_secs(60), "no run");
        std::thread::sleep(Duration::from_millis(5));
    };
    report.sends("KILL");
    drop(report);
    let began = Instant::now();
    while is_running(child, "simulate") {
        assert!(began.elapsed() < Duration::from_secs(5), "the run lives on");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(dir.names("tmp").len(), 1);
    // The next report removes what that one has left.
    let next = dir.start_by(&begin, "report earth-observer.toml --set duration=1e8 --runs 0 -o r.html");
    let began = Instant::now();
    while children(next.id()).is_empty() {
        assert!(began.elapsed() < Duration::from_secs(60), "no command");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(dir.names("tmp").len(), 1);
    next.signal("TERM").exits(130);
    assert!(dir.names("tmp").is_empty());
}
