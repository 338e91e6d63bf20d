//! The papers reproduced: a page that stands alone, and the same in Markdown, which the site shows.

use crate::frozen::is_frozen_file;
use crate::util::Dir;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn the_page_of_the_papers_is_frozen() {
    let dir = Dir::new();
    dir.run("reproduce -o page --docs docs").exits(0).says(&["papers.html", "verdicts in"]);
    let ours = dir.text("docs/papers.md");
    is_frozen_file("tests/frozen/papers.md", ours.as_bytes());
    let figures: Vec<&str> =
        ours.split("(images/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(!figures.is_empty());
    for figure in figures {
        let image = format!("docs/images/{figure}");
        is_frozen_file(&image, &dir.read(&image));
    }
    let page = dir.text("page/papers.html");
    stands_alone(&page);
    assert!(page.contains("<b class=\"no\">no</b>: it rounds to 7.398"), "the misprint is a verdict");
    // A figure has its command below it, its drawing within the page.
    assert_eq!(page.matches("<figure>").count(), page.matches("</svg>").count());
    assert!(page.contains(
        "flexsc plan scenarios/rotation-sine.toml --set manoeuvre.command.sine.suppress=4 --figures DIR"
    ));
    dir.run("reproduce station -o page --docs docs").exits(2).says(&["has a section of each paper"]);
}

/// Returns the numbers of a text: digits with a fraction or an exponent, apart from words and versions.
fn numbers(text: &str) -> impl Iterator<Item = &str> {
    let parts = text.split(|c: char| !c.is_ascii_alphanumeric() && !matches!(c, '.' | '-' | '_'));
    parts.map(|part| part.trim_matches(['.', '-'])).filter(|part| {
        part.starts_with(|c: char| c.is_ascii_digit())
            && part.contains(['.', 'e'])
            && part.parse::<f64>().is_ok()
    })
}

#[test]
fn the_summary_of_the_papers_has_the_numbers_of_the_page() {
    let text = |path: &str| std::fs::read_to_string(format!("{ROOT}/{path}")).expect("a page");
    let (summary, page) = (text("docs/papers.md"), text("tests/frozen/papers.md"));
    let known: Vec<&str> = numbers(&page).collect();
    let missing: Vec<&str> = numbers(&summary).filter(|number| !known.contains(number)).collect();
    assert!(missing.is_empty(), "tests/frozen/papers.md does not have {missing:?}");
    assert!(numbers(&summary).count() > 20 && !known.contains(&"1.97192e-5"));
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn one_paper_has_a_page_of_its_own() {
    let dir = Dir::new();
    dir.run("reproduce station -o page").exits(0).says(&["papers.html", "verdicts in"]);
    let page = dir.text("page/papers.html");
    stands_alone(&page);
    assert!(!page.contains("<h2>2. "), "the section of another paper");
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
