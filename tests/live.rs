//! `flexsc simulate --live`: a viewer receives the rows of the log, as it requests them.

use std::collections::BTreeMap;
use std::io::Write;
use std::net::TcpStream;
use std::time::Instant;

use serde_json::{Value as Json, json};
use tungstenite::Message;

use crate::util::{Dir, end};
use crate::viewer::{PATIENCE, Row, Said, Schema, Viewer, connect};

/// The period of the log (ns).
const PERIOD: u64 = 100_000_000;

/// The messages of a log, and the schema of each topic.
fn log(dir: &Dir, name: &str) -> (Vec<Row>, BTreeMap<String, Schema>) {
    let (bytes, mut schemas) = (dir.read(name), BTreeMap::new());
    let rows = mcap::MessageStream::new(&bytes).expect("a log").map(|message| {
        let message = message.expect("whole");
        let (topic, schema) =
            (message.channel.topic.clone(), message.channel.schema.clone().expect("a schema"));
        schemas.insert(topic.clone(), (schema.name.clone(), schema.data.to_vec()));
        Row { topic, time: message.log_time, data: message.data.to_vec() }
    });
    (rows.collect(), schemas)
}

/// Returns the rows of a log as a live run sends them: the summary before the metrics, at the end. A log dates its summary
/// at the start of the run.
fn live(rows: &[Row]) -> Vec<Row> {
    let (metrics, start) = (rows.len() - 2, rows[0].time);
    let mut rows = rows.to_vec();
    let end = rows[metrics].time;
    let summary = rows.last_mut().expect("a summary");
    assert_eq!((&*summary.topic, std::mem::replace(&mut summary.time, end)), ("/summary", start));
    rows.swap(metrics, metrics + 1);
    rows
}

#[test]
fn a_viewer_gets_the_messages_of_the_log() {
    let runs = [
        ("relay-adaptive", "--set duration=1100 --speed max"),
        ("relay-fixed", "--set duration=20 --set epoch=2026-03-20T14:46:00Z --speed 40"),
        ("wheel-ekf", "--set duration=4 --speed 8"),
        ("iss-manoeuvre", "--set duration=30 --speed max"),
    ];
    for (name, arguments) in runs {
        let dir = Dir::with(&[name]);
        let (set, speed) = arguments.split_once(" --speed ").expect("a speed");
        let simulate = format!("simulate {name}.toml {set} --log scene");
        dir.run(&format!("{simulate} -o alone")).exits(0);
        let (rows, schemas) = log(&dir, &format!("alone/{name}.mcap"));
        let mut run = dir.start(&format!("{simulate} -o out --live=127.0.0.1:0 --wait --speed {speed}"));
        let (mut viewer, _) = Viewer::open(&mut run);
        viewer.subscribe(&[]);
        let mut seen = Vec::new();
        while seen.last().is_none_or(|row: &Row| row.topic != "/metrics") {
            match viewer.next(PATIENCE) {
                Said::Row(row) => {
                    assert_eq!(row.time, viewer.time, "the time comes before what happens then");
                    seen.push(row);
                }
                Said::Text(json) => panic!("{json}"),
                other => panic!("{name}: {other:?} after {} messages", seen.len()),
            }
        }
        let (count, rows) = (seen.len(), live(&rows));
        assert!(seen == rows, "{name}: {count} messages live, {} in the log", rows.len());
        let channels: BTreeMap<_, _> = viewer.channels.values().cloned().collect();
        for (topic, schema) in schemas {
            assert_eq!(channels[&topic], schema, "{topic}");
        }
        run.line("the run has ended");
        viewer.socket.close(None).expect("closed");
        run.wait().exits(0);
        let bytes = |within: &str| dir.read(&format!("{within}/{name}.mcap"));
        assert!(bytes("out") == bytes("alone"), "{name}: the log is another one than without --live");
    }
}

/// A viewer that subscribes while it has no layout yet, and again when it has one, has all of a run that begins paused.
#[test]
fn a_run_that_begins_paused_loses_nothing() {
    let name = "wheel-ekf";
    let dir = Dir::with(&[name]);
    let simulate = format!("simulate {name}.toml --set duration=4 --log scene");
    dir.run(&format!("{simulate} -o alone")).exits(0);
    let rows = live(&log(&dir, &format!("alone/{name}.mcap")).0);
    let mut run = dir.start(&format!("{simulate} -o out --live=127.0.0.1:0 --paused --speed 8"));
    let (mut viewer, _) = Viewer::open(&mut run);
    viewer.subscribe(&["/log"]);
    let mut seen = viewer.rest();
    assert!(!seen.is_empty() && seen.iter().all(|row| row.topic == "/log" && row.time == 0), "{seen:?}");
    viewer.subscribe_to_others(&["/log"]);
    seen.extend(viewer.rest());
    assert!(
        seen.iter().any(|row| row.topic == "/scene"),
        "what there is at the start is there before it goes on"
    );
    assert!(seen.iter().all(|row| row.time == 0), "it went on");
    let (answer, more) = viewer.call(1);
    assert_eq!(answer["paused"], false);
    seen.extend(more);
    while seen.last().is_none_or(|row: &Row| row.topic != "/metrics") {
        match viewer.next(PATIENCE) {
            Said::Row(row) => seen.push(row),
            other => panic!("{other:?} after {} messages", seen.len()),
        }
    }
    for topic in rows.iter().map(|row| &row.topic).collect::<std::collections::BTreeSet<_>>() {
        let of = |rows: &[Row]| rows.iter().filter(|row| row.topic == *topic).cloned().collect::<Vec<_>>();
        assert!(of(&seen) == of(&rows), "{topic}: {} of {}", of(&seen).len(), of(&rows).len());
    }
    drop(viewer);
    run.wait().exits(0);
}

#[test]
fn a_run_pauses_steps_and_goes_on() {
    let dir = Dir::with(&["relay-fixed"]);
    let arguments = "simulate relay-fixed.toml --log none --set duration=1e6 --set log.period=0.1 --live=127.0.0.1:0 --speed 2";
    let began = Instant::now();
    let mut run = dir.start(arguments);
    let (mut viewer, address) = Viewer::open(&mut run);
    viewer.subscribe(&["/attitude"]);
    let gone = viewer.time_after(10);
    assert!(gone as f64 / 1e9 <= 2.0 * began.elapsed().as_secs_f64(), "it hurries");

    let (answer, mut rows) = viewer.call(0);
    assert_eq!(answer["paused"], true);
    rows.extend(viewer.rest());
    let paused = (answer["time_s"].as_f64().expect("a time") * 1e9).round() as u64;
    let last = rows.last().map_or(gone, |row| row.time);
    assert!(last <= paused && paused - last < PERIOD, "{last} {paused}");
    let at = |step| (paused / PERIOD + step) * PERIOD;
    for step in 1..=3 {
        viewer.call(2);
        let rows: Vec<u64> = viewer.rest().iter().map(|row| row.time).collect();
        assert!(rows.iter().all(|time| (at(step - 1) + 1..=at(step)).contains(time)), "{rows:?} {paused}");
        assert_eq!(rows.last(), Some(&at(step)), "one period");
    }

    // A late viewer receives the current state of the run.
    let mut late = Viewer::connect(&address);
    late.subscribe(&["/params", "/attitude"]);
    let mut rows = late.rest();
    rows.sort_by_key(|row| row.time);
    assert_eq!(rows.iter().map(|row| &row.topic[..]).collect::<Vec<_>>(), ["/params", "/attitude"]);
    assert_eq!((rows[0].time, rows[1].time, late.time), (0, at(3), at(3)));

    late.ask(&json!({"op": "subscribeParameterUpdates", "parameterNames": ["/speed", "/paused"]}));
    late.ask(&json!({"op": "getParameters", "parameterNames": [], "id": "all"}));
    let values = late.text("parameterValues");
    assert_eq!(values["id"], "all");
    let parameters = |paused: bool, speed: f64| json!([{"name": "/paused", "value": paused}, {"name": "/speed", "type": "float64", "value": speed}]);
    assert_eq!(values["parameters"], parameters(true, 2.0));
    let set = |name: &str, value: Json| json!({"op": "setParameters", "parameters": [{"name": name, "value": value}]});
    viewer.ask(&set("/speed", json!(20)));
    assert_eq!(late.text("parameterValues")["parameters"], parameters(true, 20.0));
    viewer.ask(&set("/speed", json!(-1)));
    let status = viewer.text("status");
    assert_eq!(status["message"], "/speed must be a factor above 0, or max, got -1");
    let began = Instant::now();
    viewer.ask(&set("/paused", json!(false)));
    assert_eq!(late.text("parameterValues")["parameters"], parameters(false, 20.0));
    let went = (viewer.time_after(100) - at(3)) as f64 / 1e9;
    let took = began.elapsed().as_secs_f64();
    assert!((took..20.0 * took).contains(&went), "{went} s in {took} s");

    #[cfg(unix)]
    run.signal("INT").exits(130).says(&["interrupted"]);
}

#[cfg(unix)]
#[test]
fn a_live_run_that_is_stopped_has_a_whole_log_and_says_farewell() {
    let dir = Dir::with(&["relay-fixed"]);
    let mut run = dir.start("simulate relay-fixed.toml -o out --log full --live=127.0.0.1:0 --speed 20");
    let (mut viewer, _) = Viewer::open(&mut run);
    viewer.subscribe(&["/attitude"]);
    let seen = viewer.time_after(20);
    let stopped = std::thread::spawn(move || run.signal("INT"));
    let mut last = seen;
    loop {
        match viewer.next(PATIENCE) {
            Said::Row(row) => last = row.time,
            Said::Farewell => break,
            Said::Nothing => panic!("no farewell"),
            _ => {}
        }
    }
    stopped.join().expect("stopped").exits(130).says(&["interrupted", "out/relay-fixed.mcap"]);
    assert_eq!(end(&dir, "out/relay-fixed.mcap")["end"], "interrupted");
    let (rows, _) = log(&dir, "out/relay-fixed.mcap");
    assert!(rows.iter().any(|row| row.topic == "/attitude" && row.time == last));
}

#[test]
fn a_run_without_viewers_ends_by_itself() {
    let dir = Dir::with(&["relay-fixed"]);
    let ran = dir.run("simulate relay-fixed.toml --set duration=5 --live=127.0.0.1:0 --speed 50 --json");
    assert_eq!(ran.exits(0).says(&["50 times real time"]).json()["scenario"], "relay-fixed");
    dir.run("simulate relay-fixed.toml -o alone --set duration=5").exits(0);
    assert!(dir.read("relay-fixed.mcap") == dir.read("alone/relay-fixed.mcap"));
}

#[test]
fn a_faulty_client_gets_an_error_and_harms_no_other() {
    let dir = Dir::with(&["relay-fixed"]);
    let mut run = dir.start("simulate relay-fixed.toml --log none --live=127.0.0.1:0 --wait --speed max");
    let (mut viewer, address) = Viewer::open(&mut run);
    assert_eq!(viewer.info["capabilities"], json!(["time", "parameters", "parametersSubscribe", "services"]));
    assert!(connect(&address, "chat").is_none());
    assert!(connect(&address, "foxglove.websocket.v1").is_some(), "the name before the SDK's");
    let mut stranger = TcpStream::connect(&address).expect("a listener");
    stranger.write_all(b"\r\nhello\r\n\r\n").expect("sent");
    let errors = [
        (
            json!({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 999}]}),
            "there is no channel 999",
        ),
        (
            json!({"op": "setParameters", "parameters": [{"name": "/gain", "value": 1}]}),
            "there is no parameter /gain",
        ),
        (
            json!({"op": "setParameters", "parameters": [{"name": "/paused", "value": 1}]}),
            "true or false, got 1",
        ),
        (json!({"op": "subscribe"}), "not understood"),
        (json!([1]), "not understood"),
    ];
    for (ask, why) in errors {
        viewer.ask(&ask);
        let status = viewer.text("status");
        assert_eq!(status["level"], 2);
        assert!(status["message"].as_str().expect("a text").contains(why), "{status}");
    }
    viewer.socket.send(Message::text("{")).expect("sent");
    assert_eq!(viewer.text("status")["level"], 2);
    viewer.socket.send(Message::binary(vec![2, 9, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0])).expect("sent");
    assert_eq!(viewer.text("serviceCallFailure")["callId"], 1);
    // The run still waits; then it goes to its end.
    viewer.subscribe(&["/metrics"]);
    viewer.row("/metrics");
    drop(viewer);
    run.wait().exits(0);
}

#[test]
fn arguments_that_do_not_fit_are_refused() {
    let dir = Dir::with(&["relay-fixed", "relay-quiet"]);
    let simulate = |arguments: &str| dir.run(&format!("simulate relay-fixed.toml {arguments}"));
    simulate("relay-quiet.toml --live").exits(2).says(&["--live follows one scenario, got 2"]);
    simulate("--live --runs 2").exits(2).says(&["--live", "--runs", "cannot be used"]);
    simulate("--speed 2").exits(2).says(&["--live"]);
    simulate("--wait").exits(2).says(&["--live"]);
    simulate("--paused").exits(2).says(&["--live"]);
    simulate("--live --allow-origin viewer.example").exits(2).says(&["must be an origin such as https://"]);
    for speed in ["0", "-1", "nan", "inf", "quick"] {
        simulate(&format!("--live --speed={speed}")).exits(2).says(&["must be a factor above 0, or max"]);
    }
    simulate("--live=8765").exits(2).says(&["must be a host and a port, such as 127.0.0.1:8765"]);
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = taken.local_addr().expect("an address");
    simulate(&format!("-o out --live={address}"))
        .exits(1)
        .says(&[&format!("error: cannot serve at {address}: "), "--live=127.0.0.1:0"]);
    assert!(dir.names("out").is_empty());
}
