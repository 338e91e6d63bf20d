//! Bad scenario files without a line at fault: unreadable, hostile, or together with good ones.

use crate::bad_scenarios::GOOD;
use crate::util::Dir;

/// Files that have no line to point at: the error names the file, and says why.
#[test]
fn unreadable_files_are_refused() {
    let long = format!("duration = 1 #{}", "x".repeat(4 << 20));
    let latin = b"duration = 1\nname = \"gr\xfcn\"\n";
    let binary: Vec<u8> = (0..=255).cycle().take(10_000).collect();
    let files: [(&str, &[u8], &[&str]); 4] = [
        ("long.toml", long.as_bytes(), &["at most 4194304 bytes", "has 4194318"]),
        ("latin.toml", latin, &["line 2 is not UTF-8 text"]),
        ("binary.toml", &binary, &["is not UTF-8 text"]),
        ("log.mcap", b"\x89MCAP0\r\n\xff\xfe", &["line 1 is not UTF-8 text"]),
    ];
    let dir = Dir::new();
    std::fs::create_dir(dir.path("folder.toml")).expect("a directory");
    let mut cases = vec![("folder.toml", &["not a file"][..]), ("missing.toml", &["No such file"][..])];
    for (name, bytes, words) in files {
        dir.write(name, bytes);
        cases.push((name, words));
    }
    for (name, words) in cases {
        for command in [format!("simulate {name} -o out"), format!("check {name}")] {
            let ran = dir.run(&command).exits(2).says(&[&format!("error: {name}: ")]).says(words);
            assert_eq!(ran.err.lines().count(), 1, "{}", ran.err);
            assert!(ran.out.is_empty());
        }
    }
    assert!(!dir.has("out"));
}

/// An error never floods the terminal, and never sends it what a file holds to command it.
#[test]
fn errors_are_short_and_printable() {
    let long = "x".repeat(1 << 20);
    let texts = [
        format!("duration = \"{long}\"\n"),
        format!("{long} = 1\n"),
        format!("duration = 1\n[law.{long}]\n"),
        "duration = 1\nname = \"\u{1b}[31m\"\n".to_owned(),
        "duration = \"\\u001b[31m\"\n".to_owned(),
        format!("a = {}", "[".repeat(100_000)),
    ];
    for text in texts {
        let dir = Dir::holding("bad.toml", &text);
        let ran = dir.run("check bad.toml").exits(2).says(&["error: bad.toml:"]);
        assert!(ran.err.len() < 2000, "{} bytes for {}", ran.err.len(), &text[..20]);
        assert!(!ran.err.contains(|c: char| c.is_control() && c != '\n'), "{:?}", ran.err);
    }
}

/// One bad file among good ones: nothing is run.
#[test]
fn nothing_is_run_beside_a_bad_file() {
    let dir = Dir::holding("good.toml", GOOD);
    dir.write("bad.toml", GOOD.replace("k_t = 0.31", "k_t = 31"));
    dir.run("simulate good.toml bad.toml -o out").exits(2).says(&["bad.toml:16:7"]);
    dir.run("simulate good.toml bad.toml --runs 2 -o out").exits(2).says(&["bad.toml:16:7"]);
    assert!(!dir.has("out"));
}

#[test]
fn nesting_too_deep_is_refused_with_line_and_key() {
    let dir = Dir::new();
    let headers: Vec<String> = (1..300).map(|depth| format!("[law{}]", ".a".repeat(depth))).collect();
    let headers = headers.join("\n");
    let cases = [
        (format!("duration = 1.0\nlaw{} = 1\n", ".a".repeat(100_000)), "deep.toml:2:1: ", "`law.a.a"),
        (format!("duration = 1.0\n[law{}]\nx = 1\n", ".a".repeat(200)), "deep.toml:2:1: ", "`law.a.a"),
        (format!("duration = 1.0\n[law]\n{headers}"), "deep.toml:82:1: ", "`law.a.a"),
        (
            format!("duration = 1.0\nabout = {}{}\n", "[".repeat(200), "]".repeat(200)),
            "deep.toml:2:1: ",
            "`about`",
        ),
        (
            format!("duration = 1.0\n[law.pd]\n  k_p = {}1{}\n", "{a=".repeat(200), "}".repeat(200)),
            "deep.toml:3:3: ",
            "`law.pd.k_p`",
        ),
    ];
    for (text, place, key) in cases {
        dir.write("deep.toml", text);
        dir.run("check deep.toml").exits(2).says(&[place, key, "is nested too deep"]);
    }
    // A key that is set is bounded before anything is made of it: this one was too much for the stack.
    dir.write("good.toml", GOOD);
    let path = format!("body{}", ".a".repeat(30_000));
    dir.run(&format!("simulate good.toml --set {path}=1")).exits(2).says(&["body.a.a", "is nested too deep"]);
    dir.run(&format!("simulate good.toml --set body{}=1", ".a".repeat(50))).exits(2).says(&["body.a.a"]);
}
