//! Exported control systems as an app of cFS and as a component of F Prime, against stubs: the calls of a run go through their
//! messages and ports, and come back with the same bits.

use crate::flight_exports::{EXPORTED, exported, is_installed, make, prefix, text};
use crate::util::Dir;

/// Directory, compilers and last words of the replay of each guest.
const GUESTS: [(&str, &[&str], &str); 2] = [
    ("cfs", &["make", "gcc"], "calls equal through messages; faulty messages are refused"),
    ("fprime", &["make", "gcc", "g++"], "calls equal through ports"),
];

#[test]
fn calls_go_through_messages_and_ports_with_equal_bits() {
    for name in EXPORTED.into_iter().filter(|name| !name.contains("--precision")) {
        let (dir, own) = (exported(name), prefix(name));
        // A guest is a copy of the control system: compiled once, for both.
        let source = dir.text(&format!("out/{own}.c"));
        let fprime = dir.names("out/fprime/Components").pop().expect("a component");
        for copy in [format!("cfs/{own}_app/fsw/src/{own}.c"), format!("fprime/Components/{fprime}/{own}.c")]
        {
            assert_eq!(dir.text(&format!("out/{copy}")), source);
        }
        let vectors = dir.read("out/vectors.bin");
        let calls = u64::from_le_bytes(vectors[8..16].try_into().expect("a word"));
        for (guest, commands, words) in GUESTS {
            if !commands.iter().all(|command| is_installed(command)) {
                continue;
            }
            let object = format!("out/cfs/{own}.o");
            if guest != "cfs" && name != EXPORTED[0] && dir.has(&object) {
                dir.write(&format!("out/{guest}/{own}.o"), dir.read(&object));
            }
            let output = make(&dir, &format!("out/{guest}"), &["check"]);
            let said = text(&output);
            assert!(output.status.success(), "{name}: {said}");
            assert!(said.contains(&format!("{calls} {words}")), "{name}: {said}");
        }
    }
}

/// A replay that never differs would prove nothing.
#[test]
fn replays_find_an_exchanged_member_and_a_message_that_is_not_refused() {
    let dir = Dir::with(&["earth-observer"]);
    dir.run("export-c earth-observer.toml -o out --name aocs --calls 50 --guest cfs --guest fprime").exits(0);
    let app = "out/cfs/aocs_app/fsw/src/aocs_app.c";
    let component = "out/fprime/Components/AocsControl/AocsControl.cpp";
    let changes = [
        (
            "cfs",
            app,
            "Input.gyro_rate[Index] = In->gyro_rate[Index]",
            "Input.gyro_rate[Index] = In->gyro_rate[0]",
        ),
        ("cfs", app, "if (Length == Expected)", "if (Length >= Expected)"),
        ("cfs", app, "UPPER_APP_Data.Has_Step_Input = false", "(void)0"),
        ("fprime", component, "torque[i] = output.torque[i]", "torque[i] = output.torque[0]"),
        ("fprime", component, "this->m_hasInput = false;\n        this->step", "this->step"),
    ];
    for (guest, path, from, to) in changes {
        let commands = GUESTS.iter().find(|(own, ..)| *own == guest).expect("a guest").1;
        if !commands.iter().all(|command| is_installed(command)) {
            continue;
        }
        let source = dir.text(path);
        let from = from.replace("UPPER", "AOCS");
        assert!(source.contains(&from), "{from}");
        dir.write(path, source.replacen(&from, to, 1));
        // The programs are older than the change; the control system is compiled once.
        std::fs::remove_file(dir.path(&format!("out/{guest}/replay"))).ok();
        let output = make(&dir, &format!("out/{guest}"), &["check"]);
        assert!(!output.status.success(), "{to}: {}", text(&output));
        dir.write(path, source);
    }
}

/// The stubs say that they are stubs, and nothing of the guest depends on them.
#[test]
fn stubs_say_so() {
    let dir = Dir::with(&["relay-sampled"]);
    dir.run("export-c relay-sampled.toml -o out --guest cfs --guest fprime").exits(0);
    for path in [
        "out/cfs/stubs/cfe.h",
        "out/cfs/stubs/bus.c",
        "out/fprime/stubs/framework.fpp",
        "out/fprime/stubs/Components/RelaySampledControl/RelaySampledControlComponentAc.hpp",
    ] {
        assert!(dir.text(path).lines().take(2).any(|line| line.contains("STUB")), "{path}");
    }
    let model = dir.text("out/fprime/Components/RelaySampledControl/RelaySampledControl.fpp");
    assert!(model.contains("$event: I64"), "a keyword of the modelling language: {model}");
    assert!(!dir.has("out/guests"));
    dir.run("export-c relay-sampled.toml -o other --guest vxworks")
        .exits(2)
        .says(&["vxworks", "cfs", "fprime"]);
    assert!(!dir.has("other"));
}
