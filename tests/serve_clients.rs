//! `flexsc serve` and other programs: the client in C, the description of the packets, and logs of a killed server.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command as Program, Stdio};
use std::sync::atomic::Ordering;

use flexsc_core::numerics::time::Instant;
use flexsc_core::record::Detail;

use crate::control_client::{ControlClient, Faults, FaultyLink};
use crate::serve::{ACCELERATION, in_process, remote_law, run_of, serve};
use crate::util::{Dir, SCENARIOS, has_extension};

#[test]
fn packets_of_every_scenario_are_described() {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(SCENARIOS).expect("shipped").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if !has_extension(&name, "toml") {
            continue;
        }
        let dir = Dir::new();
        let path = entry.path();
        let ran = dir.run(&format!("serve {} --period 0.5 --describe", path.display())).exits(0);
        let document = roxmltree::Document::parse(&ran.out).expect("XML");
        let named = |tag: &str, attribute: &str| -> Vec<String> {
            let nodes = document.descendants().filter(|node| node.has_tag_name(tag));
            nodes.filter_map(|node| Some(node.attribute(attribute)?.to_owned())).collect()
        };
        let parameters = named("Parameter", "name");
        let unique: BTreeSet<_> = parameters.iter().collect();
        assert_eq!(unique.len(), parameters.len(), "{name}");
        assert!(named("ParameterRefEntry", "parameterRef").iter().all(|one| unique.contains(one)), "{name}");
        let types: Vec<String> = ["IntegerParameterType", "FloatParameterType", "EnumeratedParameterType"]
            .iter()
            .flat_map(|tag| named(tag, "name"))
            .collect();
        assert!(named("Parameter", "parameterTypeRef").iter().all(|one| types.contains(one)), "{name}");
        names.push(name);
    }
    assert!(names.len() > 50);
}

/// Compiles the client of C; `None` on a machine without a compiler, which is reported.
pub fn c_client(dir: &Dir) -> Option<PathBuf> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../clients/c");
    let program = dir.path("attitude_law");
    let mut compiler = Program::new("cc");
    compiler.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-Wpedantic", "-Wconversion"]);
    compiler.args(["-ffp-contract=off", "-O2", "-o"]).arg(&program);
    compiler.args(["attitude_law.c", "flexsc_lockstep.c"].map(|name| sources.join(name)));
    let Ok(done) = compiler.output() else {
        eprintln!("skipped: there is no `cc` on this machine, so the client of C is not tested");
        return None;
    };
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    Some(program)
}

#[test]
fn a_client_in_c_gives_the_same_log_with_losses() {
    let dir = Dir::with(&["earth-observer"]);
    let Some(program) = c_client(&dir) else { return };
    let expected = in_process(&run_of(&dir, "earth-observer", 1000.0), Detail::Events, Instant::END);
    let faults = Faults { lost: 0.01, ..Faults::default() };
    for (transport, faults) in [("udp", faults), ("tcp", Faults::default())] {
        let served = format!("earth-observer.toml --{transport} --set duration=1000 --force -o run.mcap");
        let (server, _, address) = serve(&dir, &served);
        let link = FaultyLink::new(&address, faults, 11);
        let address = if transport == "udp" { &link.address } else { &address };
        let (host, port) = address.split_once(':').expect("a port");
        let client = Program::new(&program).args([host, port, transport]).stdout(Stdio::piped()).output();
        let client = client.expect("the client starts");
        assert_eq!(String::from_utf8_lossy(&client.stdout), "4000 cycles, complete\n");
        let ran = server.wait().exits(0);
        let ratio = ran.err.lines().find(|line| line.contains("times real time")).expect("a ratio");
        eprintln!("{transport}:{ratio}; {} packets lost", link.faults.load(Ordering::Relaxed));
        assert!(dir.read("run.mcap") == expected, "{transport}: another log");
    }
}

#[test]
fn a_log_without_its_commands_is_not_repeated() {
    let dir = Dir::with(&["earth-observer"]);
    let (server, transport, address) = serve(&dir, "earth-observer.toml --log events -o run.mcap");
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    assert_eq!(client.control(900, ACCELERATION, remote_law), Ok(None));
    // It is killed, and has no time to write them.
    drop(server);
    assert!(dir.has("run.mcap.partial") && !dir.has("run.mcap"));
    dir.run("log recover run.mcap.partial -o whole.mcap").exits(0);
    dir.run("plot whole.mcap -o figures").exits(1).says(&["is not repeated without its commands"]);
}
