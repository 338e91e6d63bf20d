//! The papers reproduced: a page that stands alone, and documentation that says what the program computes.

use crate::util::Dir;

const PAPERS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/papers.md");

/// A section of the documentation, by the number of its heading.
fn section(text: &str, number: u32) -> String {
    let heading = format!("## {number}. ");
    let lines = text.lines().skip_while(|line| !line.starts_with(&heading));
    let other = |line: &&str| line.starts_with("## ") && !line.starts_with(&heading);
    let own: Vec<&str> = lines.take_while(|line| !other(line)).collect();
    own.join("\n").trim_end().to_owned()
}

/// Reproduces a paper, and compares the documentation with what comes out. The others take long: `tests/all.py` does
/// it.
fn reproduced(paper: &str, number: u32) -> String {
    let dir = Dir::new();
    dir.run(&format!("reproduce {paper} -o page --docs docs")).exits(0).says(&["papers.html", "verdicts in"]);
    let committed = std::fs::read_to_string(PAPERS).expect("documentation");
    let (ours, committed) = (section(&dir.text("docs/papers.md"), number), section(&committed, number));
    assert!(!committed.is_empty(), "no section {number}");
    for (line, (ours, committed)) in ours.lines().zip(committed.lines()).enumerate() {
        assert_eq!(ours, committed, "line {} of section {number} of docs/papers.md", line + 1);
    }
    assert_eq!(ours, committed);
    for figure in committed.split("(images/").skip(1).filter_map(|rest| rest.split(')').next()) {
        assert!(dir.has(&format!("docs/images/{figure}")), "{figure}");
    }
    dir.run(&format!("reproduce {paper} -o page --docs docs"))
        .exits(2)
        .says(&["has a section of each paper"]);
    dir.text("page/papers.html")
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn rotations_are_as_the_documentation_says() {
    let page = reproduced("rotation", 2);
    assert!(page.contains("<b class=\"no\">no</b>: it rounds to 7.398"), "the misprint is a verdict");
    // A figure has its command below it, its drawing within the page.
    assert_eq!(page.matches("<figure>").count(), page.matches("</svg>").count());
    assert!(page.contains(
        "flexsc plan scenarios/rotation-sine.toml --set manoeuvre.command.sine.suppress=4 --figures DIR"
    ));
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn the_station_is_as_the_documentation_says() {
    stands_alone(&reproduced("station", 4));
}

/// Checks that a page contains everything it needs: no address but XML names, no external script, style or image.
fn stands_alone(page: &str) {
    for mark in ["src=", "url(", "@import", "<script", "<link", "<iframe", "<!--", "{{", "{%"] {
        assert!(!page.contains(mark), "{mark}");
    }
    let addresses = page.split("://").count() - 1;
    assert_eq!(addresses, page.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());
    let targets = page.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next());
    for target in targets {
        let name = target.strip_prefix('#').unwrap_or_else(|| panic!("{target} is elsewhere"));
        assert!(page.contains(&format!("id=\"{name}\"")), "{target} is nowhere");
    }
    assert!(page.contains("<h2>4. Space station") && page.contains("<h2>What was run</h2>"));
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn unknown_papers_are_refused() {
    Dir::new().run("reproduce satellite -o page").exits(2).says(&["satellite", "relay", "rotation"]);
    let dir = Dir::holding("page", "a file");
    dir.run("reproduce station -o page").exits(1).says(&["cannot write page"]);
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn room_is_looked_for_before_anything_is_computed() {
    let dir = Dir::new();
    // Files of 512 kB at most stand for a full disk: the page of a paper would fit.
    let full = dir.start_by("trap '' XFSZ; ulimit -f 1024", "reproduce station -o page").wait();
    full.exits(1).says(&["cannot write page/papers.html", "16 MB are looked for"]);
    assert!(dir.names("page").is_empty());
    std::fs::create_dir(dir.path("page/papers.html")).expect("a directory");
    dir.run("reproduce station -o page").exits(1).says(&["cannot write page/papers.html", "is a directory"]);
    assert_eq!(dir.names("page"), ["papers.html"]);
}
