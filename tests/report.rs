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
