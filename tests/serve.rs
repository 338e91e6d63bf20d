//! `flexsc serve`: a control program in lockstep gives the log of the same commands in one process, over links with
//! faults, and every disagreement ends with a clear text.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::campaign::{Campaign, CampaignRun, CommandLog};
use flexsc_core::control::law::Command;
use flexsc_core::control::quantity::total_width;
use flexsc_core::metrics::Metrics;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Log, LogBytes, RunEnd};
use flexsc_core::{Document, Scenario, Simulation, Telemetry, TelemetryLayout};
use flexsc_view::scene::Scene;
use flexsc_view::with_layout;

use crate::control_client::{COMMAND, ControlClient, Faults, FaultyLink, Sensed, hello, packet};
use crate::util::{Dir, Started, end};

/// Code of accelerations.
pub const ACCELERATION: u8 = 2;

/// Returns the commands of the law of the Earth observer, to the bit: accelerations by the error, its rate and the
/// acceleration of the reference.
fn attitude_law(numbers: &dyn Fn(&str) -> Vec<f64>) -> Vec<f64> {
    let (wn, zeta) = (0.1, 0.8);
    let [error, angle, rate, reference, acceleration] =
        ["estimate.error", "reference.angle", "estimate.rate", "reference.rate", "reference.acceleration"]
            .map(numbers);
    (0..3)
        .map(|axis| {
            let (error, rate) = (error[axis] - angle[axis], rate[axis] - reference[axis]);
            -(wn * wn * error + 2.0 * zeta * wn * rate) + acceleration[axis]
        })
        .collect()
}

pub fn remote_law(sensed: &Sensed<'_>) -> Vec<f64> {
    attitude_law(&|name| sensed.numbers(name))
}

/// Starts a server on a free port; returns it with its transport and its address.
pub fn serve(dir: &Dir, arguments: &str) -> (Started, String, String) {
    let mut server = dir.start(&format!("serve {arguments} --bind 127.0.0.1:0"));
    let line = server.line("  serve ");
    let words: Vec<&str> = line.split_whitespace().collect();
    (server, words[1].to_owned(), words[2].trim_end_matches(',').to_owned())
}

/// Returns the run of a shipped scenario with another duration.
pub fn run_of(dir: &Dir, name: &str, duration: f64) -> CampaignRun {
    let path = dir.path(&format!("{name}.toml"));
    let mut document = Document::load(&path).expect("a file");
    document.set_text("duration", &format!("{duration:?}")).expect("a key");
    let scenario = Scenario::from_document(&document).expect("a scenario");
    let campaign = Campaign::new(scenario, &format!("{name}.toml"), None).expect("a campaign");
    CampaignRun::new(Campaign::undrawn(campaign.scenario().clone()), 0)
}

/// Returns the numbers of a field of the telemetry.
fn field(layout: &TelemetryLayout, telemetry: &Telemetry, name: &str) -> Vec<f64> {
    let place = layout.law_inputs.iter().position(|field| field.path() == name).expect("a field");
    let before = total_width(&layout.law_inputs[..place]);
    telemetry.law_inputs[before..before + layout.law_inputs[place].width()].to_vec()
}

/// Returns the log of a run in this process, under the attitude law in cycles of 0.25 s, up to an instant.
pub fn in_process(run: &CampaignRun, detail: Detail, until: Instant) -> Vec<u8> {
    let mut simulation = Simulation::new(&run.scenario, run.number);
    let layout = simulation.telemetry_layout(&run.scenario);
    let mut commands = CommandLog::default();
    simulation.open(&mut ()).expect("a start");
    while !simulation.is_finished() && simulation.time() < until {
        let telemetry = simulation.telemetry(&layout).expect("numbers");
        let values = attitude_law(&|name| field(&layout, &telemetry, name));
        let given = [0, 1, 2].map(|axis| Command::Acceleration(values[axis]));
        commands.push(simulation.time(), given);
        simulation.set_external_command(given);
        simulation.run_up_to(simulation.time() + Span::from_seconds(0.25), &mut ()).expect("a cycle");
    }
    logged(run, &commands, detail, until)
}

fn logged(run: &CampaignRun, commands: &CommandLog, detail: Detail, until: Instant) -> Vec<u8> {
    let provenance = with_layout(commands.provenance(run), &run.scenario, detail);
    let mut log = LogBytes::new(&provenance, detail).expect("a log");
    let (scene, none) = (Scene::for_detail(&run.scenario, detail), Metrics::default());
    let metrics = commands.simulate(run, until, (&mut log, scene)).expect("a run");
    // A run that is interrupted has no metrics.
    let end = RunEnd::at(until, run.scenario.duration);
    log.finish(if end == RunEnd::Complete { &metrics } else { &none }, end).expect("a log")
}

#[test]
fn the_log_is_that_of_the_same_commands_in_one_process() {
    let dir = Dir::with(&["earth-observer"]);
    let expected = in_process(&run_of(&dir, "earth-observer", 60.0), Detail::Full, Instant::END);
    let faults = Faults { lost: 0.05, repeated: 0.05, damaged: 0.05, late: 0.05, foreign: 0.05 };
    let served = "earth-observer.toml --set duration=60 --log full";
    for (transport, faults) in [("udp", Faults::default()), ("udp", faults), ("tcp", Faults::default())] {
        let (server, told, address) = serve(&dir, &format!("{served} --{transport} --force -o run.mcap"));
        assert_eq!(told, transport);
        let link = FaultyLink::new(&address, faults, 7);
        let address = if transport == "udp" { &link.address } else { &address };
        let mut client = ControlClient::connect(transport, address).expect("a welcome");
        assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)));
        server.wait().exits(0).says(&["240 cycles", "log run.mcap, "]);
        assert!(dir.read("run.mcap") == expected, "{transport}: another log");
        assert_eq!(link.faults.load(Ordering::Relaxed) > 20, faults.lost > 0.0);
    }
    // The log can be repeated, and is not replaced by a run without commands.
    let log = Log::open(&dir.path("run.mcap")).expect("a log");
    let commands = CommandLog::parse(log.commands().expect("commands")).expect("a table");
    let run = run_of(&dir, "earth-observer", 60.0);
    assert!(logged(&run, &commands, Detail::Full, Instant::END) == expected);
    let simulate = "simulate earth-observer.toml --set duration=60 --log full -o run.mcap";
    dir.run(simulate).exits(2).says(&["was stepped under commands", "--force"]);
    dir.run(&format!("serve {served} -o run.mcap")).exits(2).says(&["which may be others", "--force"]);
    dir.run("plot run.mcap -o figures").exits(0);
}

/// Returns the rows of a log: topics, times and bytes.
pub fn rows(dir: &Dir, name: &str) -> Vec<(String, u64, Vec<u8>)> {
    let bytes = dir.read(name);
    let all = mcap::MessageStream::new(&bytes).expect("a log").map(|message| {
        let message = message.expect("whole");
        (message.channel.topic.clone(), message.log_time, message.data.to_vec())
    });
    all.collect()
}

#[test]
fn a_client_with_the_law_of_the_scenario_gives_the_rows_of_simulate() {
    let dir = Dir::with(&["earth-observer"]);
    // At an instant of the law at the very end, no command would act any more.
    let set = "earth-observer.toml --set duration=99.9 --log full";
    dir.run(&format!("simulate {set} -o own.mcap")).exits(0);
    let (server, transport, address) = serve(&dir, &format!("{set} -o served.mcap"));
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)));
    server.wait().exits(0);
    let (own, served) = (rows(&dir, "own.mcap"), rows(&dir, "served.mcap"));
    assert_eq!(own.len(), served.len());
    let different: Vec<_> = own.iter().zip(&served).filter(|(own, served)| own != served).collect();
    let topics: Vec<_> = different.iter().map(|(own, _)| (&own.0, own.1)).take(4).collect();
    assert!(different.is_empty(), "{} of {} rows: {topics:?}", different.len(), own.len());
}

#[test]
fn sensors_have_their_times_units_and_states() {
    let dir = Dir::with(&["earth-observer"]);
    let (server, transport, address) = serve(&dir, "earth-observer.toml --set duration=2 --log none");
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    let mut seen = Vec::new();
    let ended = client.control(u64::MAX, ACCELERATION, |sensed| {
        let at = |name: &str| sensed.integer(name);
        let tracker = (at("star_tracker.status"), at("star_tracker.time_s"), at("star_tracker.time_fs"));
        let gyro = (at("gyro.status"), at("gyro.time_s"), at("gyro.time_fs"));
        seen.push((sensed.cycle, at("time_s"), at("time_fs"), gyro, tracker));
        let attitude = sensed.numbers("star_tracker.attitude");
        let square: f64 = attitude.iter().map(|part| part * part).sum();
        assert!(tracker.0 == 0 && square == 0.0 || (square - 1.0).abs() < 1e-12, "{square}");
        assert_eq!(sensed.numbers("wheels.speed").len(), 4);
        vec![0.0; 3]
    });
    assert_eq!(ended, Ok(Some(0)));
    server.wait().exits(0);
    let tenth = |tenths: u64| (tenths / 10, tenths % 10 * 100_000_000_000_000);
    for (cycle, whole, part, gyro, tracker) in seen {
        assert_eq!((whole, part), (cycle / 4, cycle % 4 * 250_000_000_000_000));
        // The gyro reads every 0.1 s, so twice or three times in each cycle of 0.25 s.
        let (at_s, at_fs) = tenth(cycle * 5 / 2);
        assert_eq!(gyro, (2, at_s, at_fs), "{cycle}");
        // The star tracker exposes every 0.5 s, and its reading is available 0.2 s later.
        let last = (cycle * 25 + 30) / 50;
        assert!(cycle == 0 || last == 0 || tracker.0 > 0, "{cycle} {tracker:?}");
        if tracker.0 > 0 {
            let available = 10 * tracker.1 + tracker.2 / 100_000_000_000_000;
            assert!(available == 0 || available % 5 == 2, "{tracker:?}");
            assert!(available * 10 <= cycle * 25, "{tracker:?}");
        }
    }
}

#[test]
fn clients_that_expect_other_packets_are_refused() {
    let dir = Dir::with(&["earth-observer"]);
    for transport in ["udp", "tcp"] {
        let set = format!("earth-observer.toml --{transport} --set duration=2 --log none");
        let (server, _, address) = serve(&dir, &set);
        let refused = |version, layout| ControlClient::expecting(transport, &address, version, layout).err();
        let why = refused(9, 0).expect("refused");
        assert_eq!(why, "the server has version 1 of the packets, and the client 9");
        let why = refused(1, 0xABCD).expect("refused");
        assert!(why.contains("the client expects 000000000000abcd"), "{why}");
        let mut client = ControlClient::connect(transport, &address).expect("a welcome");
        let layout = client.layout;
        // Only one client controls a run.
        let other = ControlClient::connect(transport, &address).err();
        // The server reads while it waits for an answer.
        assert_eq!(other.as_deref(), Some("another client controls this run"), "{transport}");
        assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)));
        server.wait().exits(0);
        let (server, _, address) = serve(&dir, &set);
        let mut client = ControlClient::expecting(transport, &address, 1, layout).expect("the same");
        assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)));
        server.wait().exits(0);
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_has_the_log_up_to_its_cycle() {
    let dir = Dir::with(&["earth-observer"]);
    let run = run_of(&dir, "earth-observer", 60.0);
    let at = Instant::START + Span::from_seconds(2.5);
    let expected = in_process(&run, Detail::Full, at);
    for signal in ["INT", "TERM"] {
        let served = "earth-observer.toml --set duration=60 --log full --force -o run.mcap";
        let (server, transport, address) = serve(&dir, served);
        let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
        assert_eq!(client.control(10, ACCELERATION, remote_law), Ok(None));
        server.sends(signal);
        server.wait().exits(130).says(&["interrupted; run.mcap holds the run up to that time"]);
        assert_eq!(end(&dir, "run.mcap")["end"], "interrupted");
        assert!(dir.read("run.mcap") == expected, "another log");
    }
    // Without a client, there is no run and no log.
    let (server, ..) = serve(&dir, "earth-observer.toml -o none.mcap");
    server.signal("INT").exits(130);
    assert!(!dir.has("none.mcap"));
}

#[test]
fn a_client_that_vanishes_ends_the_run() {
    let dir = Dir::with(&["earth-observer"]);
    let served = "earth-observer.toml --set duration=60 --log full --force -o run.mcap";
    let at = Instant::START + Span::from_seconds(2.5);
    let expected = in_process(&run_of(&dir, "earth-observer", 60.0), Detail::Full, at);
    for (options, why) in [("--timeout 0.3", "silent for 0.3 s"), ("--tcp", "has closed its connection")] {
        let (server, transport, address) = serve(&dir, &format!("{served} {options}"));
        let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
        assert_eq!(client.control(10, ACCELERATION, remote_law), Ok(None));
        drop(client);
        server.wait().exits(1).says(&[why, "run.mcap holds the run up to that time"]);
        assert!(dir.read("run.mcap") == expected, "{options}");
    }
}

#[test]
fn commands_that_are_none_are_refused() {
    let dir = Dir::with(&["earth-observer"]);
    for (quantity, value, why) in [
        (ACCELERATION, f64::NAN, "the command about axis 1 is NaN"),
        (4, 0.0, "the first cycle has no commands: none are in force"),
        (5, 0.0, "the command about axis 1 has the quantity 5"),
    ] {
        let (server, transport, address) = serve(&dir, "earth-observer.toml --set duration=9 --log none");
        let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
        let refused = client.control(u64::MAX, quantity, |_| vec![value; 3]).expect_err("refused");
        assert_eq!(refused, why);
        server.wait().exits(1).says(&[why]);
    }
}

#[test]
fn a_stream_that_holds_no_packets_is_closed() {
    let dir = Dir::with(&["earth-observer"]);
    let (server, transport, address) = serve(&dir, "earth-observer.toml --tcp --set duration=9 --log none");
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    assert_eq!(client.control(1, ACCELERATION, remote_law), Ok(None));
    client.send_bytes(&[0xFF; 200]);
    server.wait().exits(1).says(&["has closed its connection"]);
    // Datagrams of other programs are no reason to stop.
    let (server, transport, address) = serve(&dir, "earth-observer.toml --set duration=2 --log none");
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    for bytes in [&[0xFF; 200][..], &[], &packet(COMMAND, 0, &[]), &packet(0x2F0, 0, &hello(1, 1, 0)[..9])] {
        client.send_bytes(bytes);
    }
    assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)));
    server.wait().exits(0);
}

#[test]
fn the_client_or_the_clock_paces_the_run() {
    let dir = Dir::with(&["earth-observer"]);
    let set = "earth-observer.toml --set duration=1 --log none --pace";
    let (server, transport, address) = serve(&dir, &format!("{set} step"));
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    assert_eq!(client.pace, 2);
    assert!(client.receive().is_none() && client.receive().is_none(), "not requested");
    assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)));
    server.wait().exits(0).says(&["4 cycles"]);
    let (server, transport, address) = serve(&dir, &format!("{set} real-time"));
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    let mut began = None;
    client
        .control(u64::MAX, ACCELERATION, |sensed| {
            began.get_or_insert_with(WallInstant::now);
            remote_law(sensed)
        })
        .expect("no refusal");
    // The last of the four cycles begins 0.75 s after the first.
    assert!(began.expect("cycles").elapsed() > Duration::from_millis(700));
    server.wait().exits(0);
}

#[test]
fn a_port_in_use_and_a_law_without_a_period_are_reported() {
    let dir = Dir::with(&["earth-observer", "relay-fixed"]);
    for transport in ["udp", "tcp"] {
        let (_server, _, address) = serve(&dir, &format!("earth-observer.toml --{transport} --log none"));
        dir.run(&format!("serve earth-observer.toml --{transport} --bind {address} -o second.mcap"))
            .exits(1)
            .says(&["cannot serve at 127.0.0.1:", "--bind 127.0.0.1:0"]);
        assert!(!dir.has("second.mcap"));
    }
    dir.run("serve relay-fixed.toml").exits(2).says(&["`law.relay` has no period", "--period 0.1"]);
    dir.run("serve relay-fixed.toml --udp --tcp").exits(2);
    dir.run("serve relay-fixed.toml --bind nowhere").exits(2).says(&["must be a host and a port"]);
    let served = "relay-fixed.toml --set duration=20 --period 0.5 --log none";
    let (server, transport, address) = serve(&dir, served);
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    assert_eq!(client.axes, 1);
    let mut signs = Vec::new();
    let ended = client.control(u64::MAX, 0, |sensed| {
        let [angle, rate] = ["continuous.angle", "continuous.rate"].map(|name| sensed.numbers(name)[0]);
        signs.push(angle == sensed.numbers("estimate.angle")[0]);
        vec![-1e-3 * angle - 0.1 * rate]
    });
    assert_eq!(ended, Ok(Some(0)));
    assert!(signs.len() == 40 && signs.iter().all(|same| *same), "{signs:?}");
    server.wait().exits(0);
}
