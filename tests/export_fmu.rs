//! `flexsc export-fmu`: equal bytes at each export, and what is refused.

use crate::util::Dir;

#[test]
fn two_exports_have_equal_bytes() {
    let dir = Dir::with(&["relay-fixed", "earth-observer"]);
    for (scenario, options) in [
        ("relay-fixed", ""),
        ("earth-observer", "--fmi 2 --part plant"),
        ("earth-observer", "--part controller"),
    ] {
        for out in ["a.fmu", "b.fmu"] {
            dir.run(&format!("export-fmu {scenario}.toml {options} -o {out} --force")).exits(0);
        }
        let bytes = dir.read("a.fmu");
        assert!(bytes.starts_with(b"PK") && bytes == dir.read("b.fmu"), "{scenario}");
    }
    // Another content is not lost.
    dir.run("export-fmu relay-fixed.toml -o a.fmu").exits(2).says(&["--force"]);
}

#[test]
fn a_changed_key_changes_the_fmu() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("export-fmu relay-fixed.toml -o a.fmu").exits(0);
    dir.run("export-fmu relay-fixed.toml --set law.relay.k_t=0.34 -o b.fmu").exits(0);
    assert_ne!(dir.read("a.fmu"), dir.read("b.fmu"));
}

#[test]
fn what_cannot_be_exported_is_refused_and_nothing_is_written() {
    let dir = Dir::with(&["relay-fixed"]);
    let refused = |options: &str, words: &[&str]| {
        dir.run(&format!("export-fmu relay-fixed.toml {options}")).exits(2).says(words);
    };
    refused("--part controller -o a.fmu", &["law.relay", "controller", "hint"]);
    refused("-o a.zip", &["-o a.zip", ".fmu"]);
    refused("-o a.fmu --library absent.so", &["absent.so"]);
    refused("-o a.fmu --set law.relay.k_t=-1", &["k_t"]);
    refused("-o relay-fixed.toml", &["lost"]);
    refused("-o a.fmu --fmi 1", &["--fmi"]);
    assert_eq!(dir.names("."), ["relay-fixed.toml"]);
}
