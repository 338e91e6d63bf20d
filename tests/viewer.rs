//! A viewer of live runs: a client of the Foxglove WebSocket protocol.

use std::collections::BTreeMap;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use data_encoding::BASE64;
use serde_json::{Value as Json, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::{HandshakeError, Message, WebSocket};

use crate::util::Started;

/// Time limit of every step of these tests.
pub const PATIENCE: Duration = Duration::from_secs(30);
/// Time of silence after which a run counts as held.
const QUIET: Duration = Duration::from_millis(600);

/// A viewer: a client of the Foxglove WebSocket protocol.
pub struct Viewer {
    pub socket: WebSocket<TcpStream>,
    pub info: Json,
    /// Topic and schema of each channel.
    pub channels: BTreeMap<u64, (String, Schema)>,
    /// Last time that was received (ns).
    pub time: u64,
    calls: u32,
}

/// Name and serialised descriptors.
pub type Schema = (String, Vec<u8>);

/// Row that a viewer receives.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub topic: String,
    pub time: u64,
    pub data: Vec<u8>,
}

/// Message of the server.
#[derive(Debug)]
pub enum Said {
    Row(Row),
    Text(Json),
    Answer(Json),
    Nothing,
    Farewell,
}

impl Viewer {
    /// Connects to a run.
    pub fn open(run: &mut Started) -> (Self, String) {
        let line = run.line("ws://");
        let address = line.split("ws://").nth(1).and_then(|rest| rest.split(',').next()).expect("an address");
        (Self::connect(address), address.to_owned())
    }

    pub fn connect(address: &str) -> Self {
        let socket = connect(address, "foxglove.sdk.v1").expect("a connection");
        let mut viewer =
            Self { socket, info: Json::Null, channels: BTreeMap::new(), time: u64::MAX, calls: 0 };
        viewer.info = viewer.text("serverInfo");
        viewer.text("advertiseServices");
        viewer
    }

    /// Returns the next message; `Said::None` if none comes within this time.
    pub fn next(&mut self, within: Duration) -> Said {
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

    /// Returns the next text of a kind.
    pub fn text(&mut self, op: &str) -> Json {
        loop {
            match self.next(PATIENCE) {
                Said::Text(json) if json["op"] == op => return json,
                Said::Nothing | Said::Farewell => panic!("no {op}"),
                _ => {}
            }
        }
    }

    /// Returns the next row of a topic.
    pub fn row(&mut self, topic: &str) -> Row {
        loop {
            match self.next(PATIENCE) {
                Said::Row(row) if row.topic == topic => return row,
                Said::Nothing | Said::Farewell => panic!("no {topic}"),
                _ => {}
            }
        }
    }

    /// Returns the rows until there are no more for a while.
    pub fn rest(&mut self) -> Vec<Row> {
        let mut rows = Vec::new();
        loop {
            match self.next(QUIET) {
                Said::Row(row) => rows.push(row),
                Said::Nothing => return rows,
                _ => {}
            }
        }
    }

    /// Returns the time of the row that comes after `count` others.
    pub fn time_after(&mut self, count: usize) -> u64 {
        (0..count).map(|_| self.row("/attitude").time).last().expect("a row")
    }

    pub fn ask(&mut self, json: &Json) {
        self.socket.send(Message::text(json.to_string())).expect("sent");
    }

    /// Subscribes to these topics, to all if none is named.
    pub fn subscribe(&mut self, topics: &[&str]) {
        let wanted = |topic: &str| topics.is_empty() || topics.contains(&topic);
        let channels = self.channels.iter().filter(|(_, (topic, _))| wanted(topic));
        let pairs: Vec<Json> = channels.map(|(id, _)| json!({"id": 100 + id, "channelId": id})).collect();
        assert!(!pairs.is_empty(), "{topics:?}");
        self.ask(&json!({"op": "subscribe", "subscriptions": pairs}));
    }

    /// Subscribes to all topics but these.
    pub fn subscribe_to_others(&mut self, topics: &[&str]) {
        let all: Vec<String> = self.channels.values().map(|(topic, _)| topic.clone()).collect();
        let others: Vec<&str> =
            all.iter().map(String::as_str).filter(|topic| !topics.contains(topic)).collect();
        self.subscribe(&others);
    }

    /// Asks for a service.
    pub fn ask_for(&mut self, service: u32) {
        self.calls += 1;
        let mut bytes = vec![2];
        for number in [service, self.calls, 4] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(b"json{}");
        self.socket.send(Message::binary(bytes)).expect("sent");
    }

    /// Calls a service, and returns its answer and the rows before it.
    pub fn call(&mut self, service: u32) -> (Json, Vec<Row>) {
        self.ask_for(service);
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

/// Connects to a server by this subprotocol; returns `None` if it refuses.
pub fn connect(address: &str, subprotocol: &'static str) -> Option<WebSocket<TcpStream>> {
    connect_with(address, &[("Sec-WebSocket-Protocol", subprotocol)]).ok()
}

/// Connects to a server with these headers, or returns the status and the words with which it refuses.
pub fn connect_with(
    address: &str,
    headers: &[(&'static str, &str)],
) -> Result<WebSocket<TcpStream>, (u16, String)> {
    let mut request = format!("ws://{address}").into_client_request().expect("an address");
    for (name, value) in headers {
        request.headers_mut().insert(*name, value.parse().expect("a value"));
    }
    let stream = TcpStream::connect(address).expect("a listener");
    let asked = request.headers()["Sec-WebSocket-Protocol"].clone();
    match tungstenite::client(request, stream) {
        Ok((socket, response)) => {
            assert_eq!(response.headers()["Sec-WebSocket-Protocol"], asked);
            Ok(socket)
        }
        Err(HandshakeError::Failure(tungstenite::Error::Http(response))) => {
            let body = response.body().clone().unwrap_or_default();
            Err((response.status().as_u16(), String::from_utf8(body).expect("text")))
        }
        Err(error) => panic!("{error}"),
    }
}
