//! Parameters of exported control systems: defaults, check, and numbers that are changed on board.

use std::process::Command;

use crate::day_balance::SHORT;
use crate::flight_exports::is_installed;
use crate::util::Dir;

/// Returns the driver of an export that sets parameters before its calls.
fn tuned_driver(driver: &str, parameters: &str) -> String {
    let tune = format!(
        "static void tune(sat_state *state)\n{{\n    sat_parameters p = sat_default_parameters;\n{parameters}    \
         if (sat_parameters_check(&p) != 0) {{\n        abort();\n    }}\n    sat_set_parameters(state, &p);\n}}\n\n"
    );
    let (before, rest) = driver.split_once("#define INIT(state, time) ").expect("the start of the state");
    let (init, after) = rest.split_once('\n').expect("a line");
    format!("{before}{tune}#define INIT(state, time) ({init}, tune(state))\n{after}")
}

/// Compiles a driver, and returns what it says about the calls in a file.
fn replay(dir: &Dir, driver: &str, vectors: &str) -> (bool, String) {
    let built = Command::new("gcc")
        .args(
            "-std=c99 -O2 -ffp-contract=off -Wall -Wextra -Wpedantic -Wconversion -Werror -I out".split(' '),
        )
        .args([driver, "out/sat.c", "-o", "replay"])
        .current_dir(dir.path("."))
        .output()
        .expect("gcc runs");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let done = Command::new(dir.path("replay"))
        .arg(vectors)
        .current_dir(dir.path("."))
        .output()
        .expect("the driver runs");
    (done.status.success(), String::from_utf8_lossy(&done.stdout).into_owned())
}

#[test]
fn changed_parameters_give_the_run_of_the_changed_scenario() {
    if !is_installed("gcc") {
        return;
    }
    let axes = ["roll", "pitch", "yaw"];
    let each = |head: &str, tail: &str, value: &str| -> String {
        axes.map(|axis| format!("    p.{head}{axis}_{tail} = {value};\n")).concat()
    };
    let observer = each("", "bandwidth", "0.09") + &each("", "damping", "0.9");
    let along = ["x", "y", "z"].map(|axis| format!("    p.detumble_gain_{axis} = 7e5;\n")).concat();
    let cubesat = along
        + &each("point_", "bandwidth", "0.04")
        + "    p.unload_above = 0.004;\n    p.unload_gain = 1e-3;\n    p.wheel_torque = 2e-3;\n    p.detumble_to_sun_0 = 5e-3;\n";
    let cubesat_sets = "--set mode[0].law.b_dot.gain=7e5 --set mode[2].law.attitude.bandwidth=0.04 --set actuator[1].unloads.above=0.004 \
                        --set actuator[1].unloads.gain=1e-3 --set actuator[0].wheels.torque=2e-3";
    for (name, changes, sets, parameters) in [
        (
            "earth-observer",
            &[][..],
            "--set law.attitude.bandwidth=0.09 --set law.attitude.damping=0.9",
            observer,
        ),
        ("cubesat-day", &SHORT, cubesat_sets, cubesat),
    ] {
        let dir = Dir::with(&[name]);
        let file = format!("{name}.toml");
        let text = changes.iter().fold(dir.text(&file), |text, (from, to)| text.replace(from, to));
        dir.write(&file, &text);
        dir.run(&format!("export-c {file} -o out --name sat --calls 2000")).exits(0);
        let changed = text.replace("when = \"rate < 4e-3\"", "when = \"rate < 5e-3\"");
        dir.write("changed.toml", changed);
        dir.run(&format!("vectors changed.toml -o changed.bin --calls 40000 {sets}")).exits(0);
        dir.write("tuned.c", tuned_driver(&dir.text("out/driver.c"), &parameters));
        let (is_equal, said) = replay(&dir, "tuned.c", "changed.bin");
        assert!(is_equal && said.contains("calls equal"), "{name}: {said}");
        // The defaults give another run.
        assert!(!replay(&dir, "out/driver.c", "changed.bin").0, "{name}");
        assert!(replay(&dir, "out/driver.c", "out/vectors.bin").0, "{name}");
    }
}

#[test]
fn parameters_beyond_their_limits_are_refused_by_number() {
    if !is_installed("gcc") {
        return;
    }
    let dir = Dir::with(&["cubesat-day"]);
    dir.run("export-c cubesat-day.toml -o out --name sat --calls 10").exits(0);
    let program = "#include \"sat.h\"\n#include <stdio.h>\nint main(void)\n{\n    sat_parameters p = sat_default_parameters;\n    \
        printf(\"%d\", (int)sat_parameters_check(&p));\n    p.detumble_gain_x *= 20.0;\n    printf(\" %d\", (int)sat_parameters_check(&p));\n    \
        p = sat_default_parameters;\n    p.detumble_gain_x /= p.detumble_gain_x - p.detumble_gain_x;\n    printf(\" %d\", (int)sat_parameters_check(&p));\n    \
        p = sat_default_parameters;\n    p.unload_below = p.unload_above;\n    printf(\" %d\\n\", (int)sat_parameters_check(&p) > 0);\n    return 0;\n}\n";
    dir.write("main.c", program);
    let (_, said) = replay(&dir, "main.c", "");
    assert_eq!(said, "0 1 1 1\n");
}

#[test]
fn modes_whose_names_run_together_have_parameters_of_their_own() {
    let dir = Dir::with(&["cubesat-day"]);
    let mut text = dir.text("cubesat-day.toml");
    // `detumble` ends in `sun_to_pass`, and `detumble_to_sun` in `pass`.
    for (from, to) in [
        ("name = \"sun\"", "name = \"sun_to_pass\""),
        ("{ to = \"sun\",", "{ to = \"sun_to_pass\","),
        ("name = \"point\"", "name = \"detumble_to_sun\""),
        ("{ to = \"point\",", "{ to = \"detumble_to_sun\","),
        ("run_time > 17600", "rate > 1 and run_time > 17600"),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    dir.write("cubesat-day.toml", text);
    dir.run("export-c cubesat-day.toml -o out --name sat --calls 10 --guest cfs").exits(0);
    let header = dir.text("out/sat.h");
    let declared = |name: &str| header.matches(&format!("    double {name};\n")).count();
    assert_eq!((declared("detumble_to_sun_to_pass_0"), declared("detumble_to_sun_to_pass_0_")), (1, 1));
    // Programs that read the header find structs by this form.
    assert!(header.contains("} sat_step_input;") && !header.contains("typedef struct sat_"), "{header}");
}

#[test]
fn ends_of_a_mode_with_one_target_have_parameters_of_their_own() {
    if !is_installed("gcc") {
        return;
    }
    let dir = Dir::with(&["cubesat-day"]);
    let one = r#"{ to = "safe", when = "silent(star_tracker) > 2400" }"#;
    let two = format!(r#"{one}, {{ to = "safe", when = "rate > 0.2" }}"#);
    let text = dir.text("cubesat-day.toml");
    assert!(text.contains(one));
    dir.write("cubesat-day.toml", text.replace(one, &two));
    dir.run("export-c cubesat-day.toml -o out --name sat --calls 10").exits(0);
    let program = "#include \"sat.h\"\n#include <stdio.h>\nint main(void)\n{\n    \
        const sat_parameters p = sat_default_parameters;\n    \
        printf(\"%g %g\\n\", p.point_to_safe_0, p.point_to_safe_1);\n    return 0;\n}\n";
    dir.write("main.c", program);
    let (_, said) = replay(&dir, "main.c", "");
    assert_eq!(said, "2400 0.2\n");
}
