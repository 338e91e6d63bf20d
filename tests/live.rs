//! `flexsc simulate --live`: a viewer sees what the log holds, when it is told to see it.

use std::collections::BTreeMap;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use data_encoding::BASE64;
use serde_json::{Value as Json, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

use crate::util::{Dir, Started, end};

/// Nothing of these tests takes longer.
const PATIENCE: Duration = Duration::from_secs(30);
/// A held run says nothing for so long.
const QUIET: Duration = Duration::from_millis(600);
/// The period of the log (ns).
const PERIOD: u64 = 100_000_000;

/// A viewer: a client of the Foxglove WebSocket protocol.
struct Viewer {
    socket: WebSocket<TcpStream>,
    info: Json,
    /// Topic and schema of each channel.
    channels: BTreeMap<u64, (String, Schema)>,
    /// The time that was told last (ns).
    time: u64,
    calls: u32,
}

/// Name and serialised descriptors.
type Schema = (String, Vec<u8>);

/// What a viewer is told of a run.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    topic: String,
    time: u64,
    data: Vec<u8>,
}

/// What the server says.
#[derive(Debug)]
enum Said {
    Row(Row),
    Text(Json),
    Answer(Json),
    Nothing,
    Farewell,
}

impl Viewer {
    /// Connects to a run.
    fn open(run: &mut Started) -> (Self, String) {
        let line = run.line("ws://");
        let address = line.split("ws://").nth(1).and_then(|rest| rest.split(',').next()).expect("an address");
        (Self::connect(address), address.to_owned())
    }

    fn connect(address: &str) -> Self {
        let socket = connect(address, "foxglove.sdk.v1").expect("a connection");
        let mut viewer =
            Self { socket, info: Json::Null, channels: BTreeMap::new(), time: u64::MAX, calls: 0 };
        viewer.info = viewer.text("serverInfo");
        viewer.text("advertiseServices");
        viewer
    }

    /// What is said next; nothing if it does not come in this time.
    fn next(&mut self, within: Duration) -> Said {
        let began = Instant::now();
        while began.elapsed() < within {
            self.socket.get_ref().set_read_timeout(Some(Duration::from_millis(20))).expect("set");
            match self.socket.read() {
                Ok(Message::Text(text)) => {
                    let json: Json = serde_json::from_str(&text).expect("JSON");
                    for channel in json["channels"].as_array().into_iter().flatten() {
                        self.note(channel);
                    }
                    return Said::Text(json);
                }
                Ok(Message::Binary(bytes)) if bytes[0] == 2 => {
                    self.time = u64::from_le_bytes(bytes[1..].try_into().expect("eight bytes"));
                }
                Ok(Message::Binary(bytes)) if bytes[0] == 3 => {
                    assert_eq!(&bytes[9..17], b"\x04\0\0\0json");
                    return Said::Answer(serde_json::from_slice(&bytes[17..]).expect("JSON"));
                }
                Ok(Message::Binary(bytes)) => {
                    let channel = u64::from(u32::from_le_bytes(bytes[1..5].try_into().expect("four"))) - 100;
                    let time = u64::from_le_bytes(bytes[5..13].try_into().expect("eight"));
                    let topic = self.channels[&channel].0.clone();
                    return Said::Row(Row { topic, time, data: bytes[13..].to_vec() });
                }
                Ok(Message::Close(_)) => return Said::Farewell,
                Ok(_) => {}
                Err(tungstenite::Error::Io(error))
                    if matches!(
                        error.kind(),
                        std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut
                    ) => {}
                Err(error) => panic!("{error}"),
            }
        }
        Said::Nothing
    }

    fn note(&mut self, channel: &Json) {
        assert_eq!(
            (&channel["encoding"], &channel["schemaEncoding"]),
            (&json!("protobuf"), &json!("protobuf"))
        );
        let text = |key: &str| channel[key].as_str().expect("a text").to_owned();
        let schema = BASE64.decode(text("schema").as_bytes()).expect("base64");
        let of = (text("topic"), (text("schemaName"), schema));
        self.channels.insert(channel["id"].as_u64().expect("a number"), of);
    }

    /// The next text of a kind.
    fn text(&mut self, op: &str) -> Json {
        loop {
            match self.next(PATIENCE) {
                Said::Text(json) if json["op"] == op => return json,
                Said::Nothing | Said::Farewell => panic!("no {op}"),
                _ => {}
            }
        }
    }

    /// The next row of a topic.
    fn row(&mut self, topic: &str) -> Row {
        loop {
            match self.next(PATIENCE) {
                Said::Row(row) if row.topic == topic => return row,
                Said::Nothing | Said::Farewell => panic!("no {topic}"),
                _ => {}
            }
        }
    }

    /// The rows that come until there are no more for a while.
    fn rest(&mut self) -> Vec<Row> {
        let mut rows = Vec::new();
        loop {
            match self.next(QUIET) {
                Said::Row(row) => rows.push(row),
                Said::Nothing => return rows,
                _ => {}
            }
        }
    }

    fn ask(&mut self, json: &Json) {
        self.socket.send(Message::text(json.to_string())).expect("sent");
    }

    /// Subscribes to these topics, to all if none is named.
    fn subscribe(&mut self, topics: &[&str]) {
        let wanted = |topic: &str| topics.is_empty() || topics.contains(&topic);
        let channels = self.channels.iter().filter(|(_, (topic, _))| wanted(topic));
        let pairs: Vec<Json> = channels.map(|(id, _)| json!({"id": 100 + id, "channelId": id})).collect();
        assert!(!pairs.is_empty(), "{topics:?}");
        self.ask(&json!({"op": "subscribe", "subscriptions": pairs}));
    }

    /// Calls a service, and returns its answer and the rows before it.
    fn call(&mut self, service: u32) -> (Json, Vec<Row>) {
        self.calls += 1;
        let mut bytes = vec![2];
        for number in [service, self.calls, 4] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(b"json{}");
        self.socket.send(Message::binary(bytes)).expect("sent");
        let mut rows = Vec::new();
        loop {
            match self.next(PATIENCE) {
                Said::Answer(answer) => return (answer, rows),
                Said::Row(row) => rows.push(row),
                Said::Nothing | Said::Farewell => panic!("no answer"),
                Said::Text(_) => {}
            }
        }
    }
}

fn connect(address: &str, subprotocol: &'static str) -> Option<WebSocket<TcpStream>> {
    let mut request = format!("ws://{address}").into_client_request().expect("an address");
    let name = tungstenite::http::HeaderValue::from_static(subprotocol);
    request.headers_mut().insert("Sec-WebSocket-Protocol", name);
    let stream = TcpStream::connect(address).expect("a listener");
    let (socket, response) = tungstenite::client(request, stream).ok()?;
    assert_eq!(response.headers()["Sec-WebSocket-Protocol"], subprotocol);
    Some(socket)
}

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
        assert!(seen == rows, "{name}: {} messages live, {} in the log", seen.len(), rows.len());
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

#[test]
fn a_run_pauses_steps_and_goes_on() {
    let dir = Dir::with(&["relay-fixed"]);
    let arguments = "simulate relay-fixed.toml --log none --set duration=1e6 --live=127.0.0.1:0 --speed 2";
    let began = Instant::now();
    let mut run = dir.start(arguments);
    let (mut viewer, address) = Viewer::open(&mut run);
    viewer.subscribe(&["/attitude"]);
    let gone = viewer.rest_of(10);
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

    // Who comes late sees where the run stands, and what it is.
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
    let went = (viewer.rest_of(100) - at(3)) as f64 / 1e9;
    let took = began.elapsed().as_secs_f64();
    assert!((took..20.0 * took).contains(&went), "{went} s in {took} s");

    #[cfg(unix)]
    run.signal("INT").exits(130).says(&["interrupted"]);
}

impl Viewer {
    /// The time of the row that comes after so many others.
    fn rest_of(&mut self, count: usize) -> u64 {
        (0..count).map(|_| self.row("/attitude").time).last().expect("a row")
    }
}

#[cfg(unix)]
#[test]
fn a_live_run_that_is_stopped_has_a_whole_log_and_says_farewell() {
    let dir = Dir::with(&["relay-fixed"]);
    let mut run = dir.start("simulate relay-fixed.toml -o out --log full --live=127.0.0.1:0 --speed 20");
    let (mut viewer, _) = Viewer::open(&mut run);
    viewer.subscribe(&["/attitude"]);
    let seen = viewer.rest_of(20);
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
fn a_client_that_errs_is_told_and_harms_nobody() {
    let dir = Dir::with(&["relay-fixed"]);
    let mut run = dir.start("simulate relay-fixed.toml --log none --live=127.0.0.1:0 --wait --speed max");
    let (mut viewer, address) = Viewer::open(&mut run);
    assert_eq!(viewer.info["capabilities"], json!(["time", "parameters", "parametersSubscribe", "services"]));
    assert!(connect(&address, "chat").is_none());
    assert!(connect(&address, "foxglove.websocket.v1").is_some(), "the name before the SDK's");
    std::io::Write::write_all(&mut TcpStream::connect(&address).expect("a listener"), b"\r\nhello\r\n\r\n")
        .expect("sent");
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
