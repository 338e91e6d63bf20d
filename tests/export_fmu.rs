//! `flexsc export-fmu`: equal bytes at each export, and what is refused.

use crate::util::Dir;

#[test]
fn two_exports_have_equal_bytes() {
    let dir = Dir::with(&["relay-fixed", "earth-observer", "cubesat-day"]);
    for (scenario, options) in [
        ("relay-fixed", ""),
        ("earth-observer", "--fmi 2 --part plant"),
        ("earth-observer", "--part controller"),
        ("cubesat-day", "--part controller --sources --fmi 2"),
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
fn an_fmu_holds_the_libraries_of_several_platforms() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.write("a.so", "of linux");
    dir.write("b.dll", "of windows");
    let libraries = "--library linux64=a.so x86_64-windows=b.dll";
    for (version, folders) in [("2", ["linux64", "win64"]), ("3", ["x86_64-linux", "x86_64-windows"])] {
        dir.run(&format!("export-fmu relay-fixed.toml --fmi {version} {libraries} -o {version}.fmu"))
            .exits(0);
        // Names are not compressed.
        let bytes = dir.read(&format!("{version}.fmu"));
        for path in
            [format!("binaries/{}/flexsc.so", folders[0]), format!("binaries/{}/flexsc.dll", folders[1])]
        {
            assert!(bytes.windows(path.len()).any(|part| part == path.as_bytes()), "{path}");
        }
    }
    for (options, words) in [
        ("--library linux65=a.so", "is no platform"),
        ("--library linux64=a.so x86_64-linux=b.dll", "two libraries"),
        ("--fmi 2 --library aarch64-linux=a.so", "export FMI 3.0"),
    ] {
        dir.run(&format!("export-fmu relay-fixed.toml {options} -o c.fmu")).exits(2).says(&[words]);
        assert!(!dir.has("c.fmu"));
    }
}

#[test]
fn sources_have_the_flight_code_and_no_library() {
    let dir = Dir::with(&["earth-observer", "relay-adaptive"]);
    for (version, build) in [("2", false), ("3", true)] {
        dir.run(&format!(
            "export-fmu earth-observer.toml --part controller --sources --fmi {version} -o a.fmu --force"
        ))
        .exits(0);
        let bytes = dir.read("a.fmu");
        let has = |path: &str| bytes.windows(path.len()).any(|part| part == path.as_bytes());
        for path in ["earth_observer.c", "fmu_calls.c", &format!("fmi{version}.c")] {
            assert!(has(&format!("sources/{path}")), "{path}");
        }
        assert_eq!((has("sources/buildDescription.xml"), has("binaries/")), (build, false));
        assert!(bytes.len() < 100_000, "{}", bytes.len());
    }
    for (scenario, options, words) in [
        ("earth-observer", "--sources", ["--sources", "controller"]),
        ("earth-observer", "--part controller --sources --library a.so", ["--sources", "--library"]),
        ("relay-adaptive", "--part controller --sources", ["relay-adaptive.toml:", "^"]),
    ] {
        dir.run(&format!("export-fmu {scenario}.toml {options} -o b.fmu")).exits(2).says(&words);
        assert!(!dir.has("b.fmu"));
    }
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
