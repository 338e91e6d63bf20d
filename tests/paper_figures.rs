//! Figures for papers: PDF with its fonts, sizes on paper, a part of the time, several logs on one figure.

use crate::drawing::{Drawing, near};
use crate::util::Dir;

/// A log of a relay law, and one of another gain.
fn relays() -> Dir {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml --set duration=600").exits(0);
    dir.run("simulate relay-fixed.toml --set duration=600 --set name=\"other\" --set law.relay.k_t=0.34")
        .exits(0);
    dir
}

/// The objects of a PDF as its table of places has them.
#[cfg(feature = "full")]
fn objects(pdf: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(pdf).into_owned();
    assert!(text.starts_with("%PDF-1.") && text.ends_with("%%EOF\n"), "no PDF");
    let end = pdf.windows(9).rposition(|words| words == b"startxref").expect("an end");
    let tail = std::str::from_utf8(&pdf[end..]).expect("ASCII");
    let table: usize = tail.split_whitespace().nth(1).expect("a place").parse().expect("a number");
    let rows = std::str::from_utf8(&pdf[table..end]).expect("ASCII");
    let places = rows.lines().skip(3).take_while(|line| line.ends_with("n ") || line.ends_with('n'));
    let places: Vec<usize> = places.map(|line| line[..10].parse().expect("a place")).collect();
    for (index, place) in places.iter().enumerate() {
        assert!(pdf[*place..].starts_with(format!("{} 0 obj", index + 1).as_bytes()), "object {}", index + 1);
    }
    let ends = places[1..].iter().chain([&table]);
    places.iter().zip(ends).map(|(from, to)| String::from_utf8_lossy(&pdf[*from..*to]).into_owned()).collect()
}

#[test]
#[cfg(feature = "full")]
fn a_pdf_has_its_size_its_letters_and_what_they_say() {
    let dir = relays();
    dir.run("plot relay-fixed.mcap --what angle -o angle.pdf --width 85 --font 8")
        .exits(0)
        .says(&["angle.pdf"]);
    let objects = objects(&dir.read("angle.pdf"));
    let of = |words: &str| {
        objects.iter().find(|object| object.contains(words)).unwrap_or_else(|| panic!("no {words}"))
    };
    let page = of("/MediaBox");
    let size = page.split("/MediaBox [0 0 ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a width");
    near(size.parse().expect("a number"), 85.0 / 25.4 * 72.0, 0.01);
    assert!(of("/Subtype /Type0").contains("+DejaVuSans /Encoding /Identity-H"));
    // The outlines of the letters that are used, and no others.
    let outlines = of("/Length1");
    assert!((3_000..40_000).contains(&outlines.len()), "{}", outlines.len());
    let map = of("beginbfchar");
    assert!(map.contains("<00e5>") || map.contains("<0074>"), "no t in {map}");
    // Letters are as large as asked for: 11 of 12 px are the numbers, 12 the names.
    let content = of("BT /F0 1 Tf");
    let sizes = content.lines().filter(|line| line.starts_with("BT")).filter_map(|line| {
        let numbers: Vec<f64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
        Some(numbers.get(1)?.hypot(*numbers.get(2)?) * 0.75)
    });
    let names = sizes.filter(|size| (size - 8.0).abs() < 0.02).count();
    assert!(names >= "time (s)".len(), "{names} letters of 8 pt");
    // The same again, to the byte.
    dir.run("plot relay-fixed.mcap --what angle -o again.pdf --width 85 --font 8").exits(0);
    assert_eq!(dir.read("again.pdf"), dir.read("angle.pdf"));
    dir.run("plot relay-fixed.mcap --format pdf -o all").exits(0);
    assert!(dir.names("all").contains(&"relay-fixed-torque.pdf".to_owned()), "{:?}", dir.names("all"));
}

#[test]
fn figures_have_their_width_on_paper() {
    let dir = relays();
    dir.run("plot relay-fixed.mcap --what angle -o narrow.svg --width 85").exits(0);
    let narrow = dir.text("narrow.svg");
    assert!(narrow.starts_with("<svg width=\"85.000mm\" height=\""), "{}", &narrow[..80]);
    // The legend has room: nothing begins beyond the right edge.
    let width: f64 = narrow
        .split("viewBox=\"0 0 ")
        .nth(1)
        .and_then(|t| t.split(' ').next())
        .expect("a box")
        .parse()
        .expect("a number");
    let document = roxmltree::Document::parse(&narrow).expect("XML");
    for text in document.descendants().filter(|node| node.has_tag_name("text")) {
        let number = |name: &str| text.attribute(name).and_then(|n| n.parse::<f64>().ok()).expect("a number");
        let (letters, size) =
            (text.text().unwrap_or_default().trim().chars().count() as f64, number("font-size"));
        if text.attribute("text-anchor") == Some("start") {
            assert!(number("x") + 0.5 * size * letters < width, "{:?}", text.text());
        }
    }
    for (options, words) in [
        ("--width 5", "the width must be 30 to 400 mm, got 5"),
        ("--font 100", "the font must have 4 to 24 pt, got 100"),
        ("--width 40 --font 20", "no room for letters of 20 pt"),
    ] {
        dir.run(&format!("plot relay-fixed.mcap -o x.svg {options}")).exits(2).says(&[words]);
    }
    assert!(!dir.has("x.svg"));
}

#[test]
fn a_part_of_the_time_is_shown() {
    let dir = relays();
    dir.run("plot relay-fixed.mcap --what angle,torque,phase-plane,envelope --from 100 --to 200 -o part --format svg").exits(0);
    let angle = Drawing::at(&dir, "part/relay-fixed-angle.svg");
    angle.shows(&["100", "200"]);
    assert!(!angle.texts().iter().any(|text| text == "300"), "{:?}", angle.texts());
    // As many switchings as the log has there.
    let log = dir.run("export relay-fixed.mcap --topic /command").printed();
    let times = log.lines().skip(1).filter_map(|line| line.split(',').next()?.parse::<f64>().ok());
    let inside = times.filter(|time| (100.0..=200.0).contains(time)).count();
    let marks = |colour: &str, kind: &str| angle.shapes(kind, "fill", colour).len();
    // Discs and diamonds, and one of each in the legend.
    assert_eq!(marks("#D55E00", "circle") + marks("#0072B2", "polygon"), inside + 2);
    Drawing::at(&dir, "part/relay-fixed-phase-plane.svg").shows(&["trajectory"]);
    dir.run("plot relay-fixed.mcap --from 700 -o x.svg")
        .exits(2)
        .says(&["the run is from 0 to 600 s, got --from 700 --to -"]);
    dir.run("plot relay-fixed.mcap --to nan -o x.svg")
        .exits(2)
        .says(&["must be a number, or a number with a unit such as \"2 s\", got `nan`"]);
    dir.run("plot . --from 1 -o x.svg").exits(2).says(&["--from: only for logs"]);
}

#[test]
fn several_logs_are_drawn_on_one_figure() {
    let dir = relays();
    dir.run("plot relay-fixed.mcap other.mcap --what angle,envelope -o both --format svg").exits(0);
    assert_eq!(dir.names("both"), ["relay-fixed-angle.svg", "relay-fixed-envelope.svg"]);
    let both = Drawing::at(&dir, "both/relay-fixed-angle.svg");
    both.shows(&["relay-fixed", "other", "\u{b1}\u{3b5}"]);
    for colour in ["#0072B2", "#D55E00"] {
        assert!(both.line(colour).len() > 30, "{colour}");
    }
    // A log of another kind has no figure with the same axes.
    let other = Dir::with(&["iss-ringdown", "relay-fixed"]);
    other.run("simulate iss-ringdown.toml relay-fixed.toml --set duration=60").exits(0);
    other
        .run("plot iss-ringdown.mcap relay-fixed.mcap -o x.svg")
        .exits(2)
        .says(&["no figure with the same axes"]);
}
