//! `flexsc report`: a page that stands alone, says what the answers say, names the commands, and is the same each time.

use std::time::{Duration, Instant};

use serde_json::Value as Json;

use crate::util::{Dir, FLEXSC};

/// Returns the texts of an answer's requirements.
fn texts(answer: &Json) -> Vec<String> {
    let requirements = answer["requirements"].as_array().into_iter().flatten();
    let own =
        requirements.flat_map(|own| own["text"].as_object().into_iter().flat_map(serde_json::Map::values));
    own.filter_map(Json::as_str).map(str::to_owned).collect()
}

/// Returns a page without the marks of HTML in texts.
fn plain(page: &str) -> String {
    page.replace("&quot;", "\"").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
}

#[test]
fn a_page_for_a_review() {
    let dir = Dir::with(&["half-turn"]);
    let line = "report half-turn.toml --runs 40";
    dir.run(&format!("{line} -o study.html")).exits(3).says(&["study.html", "MISSED", "of 40 runs meet"]);
    let page = plain(&dir.text("study.html"));
    for title in [
        "Requirements",
        "Spacecraft",
        "Time line",
        "The run",
        "Margins",
        "Noise",
        "Campaign of 40 runs",
        "Assumptions and what is left out",
        "Scenario",
    ] {
        assert!(page.contains(&format!("</span>{title}</h2>")), "{title}");
    }
    // The strings of the answers, and no numbers of its own.
    let run = dir.run("simulate half-turn.toml --log none --json").exits(0).json()["answer"].clone();
    let lines = dir.run("simulate half-turn.toml --runs 40 --json").exits(3).out;
    let last: Json = serde_json::from_str(lines.lines().last().expect("a line")).expect("an object");
    let campaign = &last["answer"];
    for text in texts(&run).iter().chain(&texts(campaign)) {
        assert!(page.contains(text), "{text}");
    }
    for line in run["lines"].as_array().expect("lines") {
        let text = line["text"].as_str().expect("a text");
        assert!(page.contains(text), "{text}");
    }
    assert!(page.contains(campaign["verdict_text"].as_str().expect("words").trim_start_matches("MISSED: ")));
    assert!(page.contains(campaign["requirements"][0]["driven_by"][0]["text"].as_str().expect("words")));
    // The scenario as it is, beside the runs.
    let nominal = run["requirements"][0]["text"]["value"].as_str().expect("a text");
    let nominal = nominal.split(' ').next().expect("a number");
    assert!(page.contains(&format!("<td class=\"n\" data-l=\"Nominal\">{nominal}</td>")), "{nominal}");
    for command in [
        "flexsc simulate half-turn.toml",
        "flexsc modes half-turn.toml",
        "flexsc margins half-turn.toml --mask '6 dB, 30 deg'",
        "flexsc worst half-turn.toml --margin modulus --points 40",
        "flexsc simulate half-turn.toml --runs 40 -o campaign",
    ] {
        assert!(page.contains(&format!("<code>{command}</code>")), "{command}");
    }
    assert!(page.matches("<table").count() >= 5 && page.matches("<svg").count() >= 4);
    for number in 1..=page.matches("<figure ").count() {
        assert!(page.contains(&format!("<b>Figure {number}.</b>")), "{number}");
    }
    // The page refers to no other file, and names nothing of the computer.
    for outside in ["http://", "https://", "<script ", "src=", "<link", "<img", "/tmp"] {
        let found = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!found.contains(outside), "{outside}");
    }
    assert!(page.contains("@page{size:A4") && page.contains("@media(max-width:700px)"));
    dir.run(&format!("{line} -o again.html")).exits(3);
    assert_eq!(dir.text("study.html"), dir.text("again.html"));
    dir.run(&format!("{line} -o study.html")).exits(2).says(&["already exists", "--force"]);
}

/// A directory of runs is used, and the runs that it lacks are added; one of another scenario is refused.
#[test]
#[cfg(feature = "parquet")]
fn the_campaign_of_a_directory_is_not_run_again() {
    let dir = Dir::with(&["half-turn"]);
    dir.run("simulate half-turn.toml --runs 12 -o made").exits(3);
    let parts = || {
        let all = std::fs::read_dir(dir.path("made/runs")).expect("a directory");
        let mut parts: Vec<_> = all.map(|entry| entry.expect("a file")).collect();
        parts.sort_by_key(std::fs::DirEntry::file_name);
        parts
            .iter()
            .map(|file| file.metadata().expect("a file").modified().expect("a time"))
            .collect::<Vec<_>>()
    };
    let before = parts();
    dir.run("report half-turn.toml --campaign made -o held.html").exits(3).says(&["of 12 runs meet"]);
    assert_eq!(parts(), before);
    let page = plain(&dir.text("held.html"));
    assert!(page.contains("<code>flexsc simulate half-turn.toml --runs 12 -o made</code>"));
    assert!(page.contains("<code>flexsc simulate --from made --row"));
    dir.run("report half-turn.toml --campaign made --runs 20 -o more.html")
        .exits(3)
        .says(&["of 20 runs meet"]);
    assert_eq!(parts()[..before.len()], before);
    // The answer of runs in memory.
    dir.run("report half-turn.toml --runs 20 -o alone.html").exits(3);
    let alone = plain(&dir.text("alone.html"))
        .replace("-o campaign<", "-o made<")
        .replace("--from campaign ", "--from made ");
    assert_eq!(plain(&dir.text("more.html")), alone);
    dir.run("report half-turn.toml --set seed=5 --campaign made -o other.html")
        .exits(2)
        .says(&["made", "seed"]);
    dir.run("report half-turn.toml --campaign held.html -o other.html").exits(2).says(&["is a file"]);
    assert!(!dir.path("other.html").exists());
}

/// The margins of each loop are those of `flexsc margins`.
#[test]
fn margins_are_those_of_the_command() {
    let dir = Dir::with(&["attitude-hold"]);
    let set = "--set duration=20";
    dir.run(&format!("report attitude-hold.toml --runs 0 {set} -o page.html")).exits(0);
    let page = dir.text("page.html");
    let found = dir.run(&format!("margins attitude-hold.toml {set} --json")).exits(0).json();
    let loops = found["loops"].as_array().expect("loops");
    assert_eq!(loops.len(), 3);
    for own in loops {
        let number = |name: &str| own[name].as_f64();
        let modulus = own["modulus"]["margin"].as_f64().expect("a number");
        let phase = number("phase_rad").expect("a phase").abs().to_degrees();
        for value in [modulus, phase] {
            let digits = if value < 1.0 { format!("{value:.3}") } else { format!("{value:.1}") };
            assert!(page.contains(&format!("<td class=\"n\">{digits}</td>")), "{digits}");
        }
    }
    assert!(
        page.contains("--set 'duration=20'") && page.contains("Keys set on the command line: duration=20.")
    );
}

/// The verdict on each loop is that of the command, whose mask is stricter than two margins.
#[test]
fn verdicts_on_loops_are_those_of_the_command() {
    let dir = Dir::with(&["earth-observer"]);
    for (bandwidth, missed) in [("0.1", 0), ("0.3", 1)] {
        let set = format!("--set law.attitude.bandwidth={bandwidth}");
        dir.run(&format!("report earth-observer.toml --runs 0 {set} -o {bandwidth}.html")).exits(0);
        let line = format!("margins earth-observer.toml --mask 6dB,30deg --json {set}");
        let found = dir.run(&line).exits(if missed > 0 { 3 } else { 0 }).json();
        let loops = found["mask"]["loops"].as_array().expect("loops");
        assert_eq!(loops.iter().filter(|own| !own["violated_at_hz"].is_null()).count(), missed);
        let page = dir.text(&format!("{bandwidth}.html"));
        let (_, table) = page.split_once("Mask 6 dB, 30 deg</th>").expect("a table");
        let (table, _) = table.split_once("</table>").expect("its end");
        let count = |verdict: &str| table.matches(&format!("class=\"v {verdict}\"")).count();
        assert_eq!((count("missed"), count("met")), (missed, 3 - missed));
        assert!(page.contains("mask 6 dB, 30 deg"), "the Nichols diagram has the mask");
    }
    // A scenario from stdin has the same blocks.
    let mut command = std::process::Command::new(FLEXSC);
    command.args(["report", "-", "--runs", "0", "-o", "stdin.html"]).current_dir(dir.path("."));
    command.stdin(std::fs::File::open(dir.path("earth-observer.toml")).expect("a file"));
    assert!(command.output().expect("it starts").status.success());
    let page = dir.text("stdin.html");
    assert!(page.contains("Mask 6 dB, 30 deg</th>") && page.contains("[[appendage]]"), "{page}");
}

#[test]
fn the_title_block_has_what_is_given() {
    let dir = Dir::with(&["half-turn"]);
    let text = dir.text("half-turn.toml");
    let (before, after) = text.split_once("\n[spacecraft]").expect("a table");
    let block =
        "[document]\ntitle = \"Turn <1>\"\nauthor = \"A. Engineer\"\nissue = \"2\"\ndate = \"May 2027\"\n";
    dir.write("half-turn.toml", format!("{before}\n{block}\n[spacecraft]{after}"));
    dir.run("report half-turn.toml --runs 0 -o page.html").exits(0);
    let page = dir.text("page.html");
    for piece in [
        "<h1>Turn &lt;1&gt;</h1>",
        "<b>Author</b>A. Engineer</div>",
        "<b>Issue</b>2, May 2027</div>",
        "content:\"half-turn, issue 2\"",
    ] {
        assert!(page.contains(piece), "{piece}");
    }
    assert!(!page.contains("<b>Project</b>") && !page.contains("<b>Campaign</b>"));
    dir.run("simulate half-turn.toml --log none --set document.revision=3").exits(2).says(&["unknown key"]);
}

#[test]
fn what_has_no_numbers_has_a_reason() {
    let dir = Dir::with(&["relay-fixed"]);
    let line = "report relay-fixed.toml -o page.html --runs 0 --set duration=2000";
    dir.run(line).exits(0).says(&["without numbers", "Margins"]);
    let page = dir.text("page.html");
    assert!(page.contains("class=\"refused\"") && page.contains("is not linear"));
    assert!(!page.contains("</span>Campaign"));
    for (arguments, told) in [
        ("-o page.pdf", "cannot be written as .pdf"),
        ("-o page", "must end in"),
        ("-o other.html --runs 1000000", "1000000 is not in 0..=100000"),
        ("-o other.html --set law.relay.k=1", "unknown key"),
        ("-o other.html --runs 3 --watch", "--watch"),
        ("-o other.html --runs 0 --campaign made", "leaves the campaign out"),
        ("", "--out"),
    ] {
        dir.run(&format!("report relay-fixed.toml {arguments}")).exits(2).says(&[told]);
    }
    assert!(!dir.path("other.html").exists());
}

/// While it is watched, the page follows the file, and shows its errors above what was good last.
#[cfg(unix)]
#[test]
fn a_page_that_is_watched_follows_the_file() {
    let dir = Dir::with(&["half-turn"]);
    let text = dir.text("half-turn.toml");
    let watched = dir.start("report half-turn.toml -o page.html --watch");
    let until = |wanted: &dyn Fn(&str) -> bool, what: &str| {
        let began = Instant::now();
        loop {
            let page = std::fs::read_to_string(dir.path("page.html")).unwrap_or_default();
            if wanted(&page) {
                return page;
            }
            assert!(began.elapsed() < Duration::from_secs(60), "{what}: {page}");
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    let first = until(&|page| page.contains("1 of 1 requirement met."), "the first page");
    assert!(
        first.contains("flexscVersion")
            && !first.contains("http://localhost")
            && !first.contains("</span>Campaign")
    );
    dir.write("half-turn.toml", text.replace("[law.attitude]", "[law.attitude]\nwrong = 1"));
    let broken = until(&|page| page.contains("class=\"broken\""), "the error");
    assert!(broken.contains("wrong") && broken.contains("1 of 1 requirement met."));
    dir.write("half-turn.toml", text.replace("duration = 90.0", "duration = 85.0"));
    let last =
        until(&|page| page.contains("duration = 85.0") && !page.contains("class=\"broken\""), "the change");
    assert!(last.contains("85 s</div>"));
    assert!(dir.path("page.html.js").exists());
    watched.signal("TERM");
    assert!(!dir.path("page.html.js").exists());
}
