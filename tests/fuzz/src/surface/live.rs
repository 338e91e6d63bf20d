//! Messages of viewers to a live run: requests to upgrade, frames, and the words within; and a run that receives them.

use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use serde_json::{Value as Json, json};

use crate::case::{Case, SENT};
use crate::chance::Chance;
use crate::node::Node;
use crate::{mutate, nasty};

/// Run that viewers watch.
const RUN: &str = include_str!("../../../../scenarios/relay-fixed.toml");
const COMMAND: &str = "simulate s.toml --log none --set duration=1e7 --live=127.0.0.1:0 --speed 50";
/// Time within which a run is served and a correct viewer answered, while others may keep the processor busy.
const PATIENCE: Duration = Duration::from_secs(60);
/// Closing frame of a viewer.
const FAREWELL: [u8; 6] = [0x88, 0x80, 0, 0, 0, 0];

pub fn make(chance: &mut Chance) -> Case {
    let mut sent = greeting(chance);
    for _ in 0..=chance.below(8) {
        frame(&mut sent, chance);
    }
    if chance.percent(15) {
        mutate::bytes(&mut sent, chance);
    }
    // A flood of bytes is another case than wrong bytes.
    sent.truncate(1 << 22);
    Case::new(COMMAND, vec![("s.toml".to_owned(), RUN.as_bytes().to_vec()), (SENT.to_owned(), sent)])
}

/// Returns a correct request to upgrade.
fn hello() -> String {
    "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
     Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
        .to_owned()
}

fn greeting(chance: &mut Chance) -> Vec<u8> {
    let mut text = hello();
    if chance.percent(80) {
        return text.into_bytes();
    }
    let more = |line: &str| format!("\r\n{line}\r\n\r\n");
    let (old, new) = match chance.below(6) {
        0 => {
            let names = ["", "x", "foxglove.websocket.v1", "a, foxglove.sdk.v1,", "\u{e9}"];
            ("foxglove.sdk.v1", chance.one(&names).to_owned())
        }
        1 => {
            let hosts = ["", "example.org", "localhost:1", "[::1]:99999", "a b", "127.0.0.1:"];
            ("127.0.0.1", chance.one(&hosts).to_owned())
        }
        2 => {
            let origins = ["null", "https://example.org", "http://localhost", "://", ""];
            ("\r\n\r\n", more(&format!("Origin: {}", chance.one(&origins))))
        }
        3 => ("\r\n\r\n", more(&vec!["X-Y: z"; [10, 124, 2000, 60_000][chance.below(4)]].join("\r\n"))),
        4 => ("GET /", format!("GET /{}", "a".repeat([10, 5000, 200_000][chance.below(3)]))),
        _ => ("", String::new()),
    };
    if !old.is_empty() {
        text = text.replacen(old, &new, 1);
    }
    let mut bytes = text.into_bytes();
    if chance.percent(60) {
        mutate::bytes(&mut bytes, chance);
    }
    bytes
}

/// A frame, most often a right one around odd words.
fn frame(sent: &mut Vec<u8>, chance: &mut Chance) {
    let (mut opcode, mut payload) = match chance.below(10) {
        0..6 => (1, words(chance)),
        6 | 7 => (2, call(chance)),
        8 => ([8, 9, 10][chance.below(3)], (0..chance.below(140)).map(|_| chance.number() as u8).collect()),
        _ => (chance.below(16) as u8, words(chance)),
    };
    if chance.percent(5) {
        opcode = chance.below(16) as u8;
    }
    if chance.percent(10) {
        mutate::bytes(&mut payload, chance);
    }
    let finished = if chance.percent(93) { 0x80 } else { [0, 0x40, 0xf0][chance.below(3)] };
    sent.push(finished | opcode);
    let mut length = payload.len() as u64;
    if chance.percent(4) {
        length = nasty::whole(chance, length);
    }
    let mask = if chance.percent(97) { 0x80 } else { 0 };
    match length {
        0..126 if chance.percent(97) => sent.push(mask | length as u8),
        0..0x1_0000 if chance.percent(97) => {
            sent.push(mask | 0x7e);
            sent.extend((length as u16).to_be_bytes());
        }
        _ => {
            sent.push(mask | 0x7f);
            sent.extend(length.to_be_bytes());
        }
    }
    if mask != 0 {
        let key = (chance.number() as u32).to_le_bytes();
        sent.extend(key);
        payload.iter_mut().zip(key.iter().cycle()).for_each(|(byte, key)| *byte ^= key);
    }
    sent.extend(payload);
}

/// A call of a service: its number, that of the call, the name of the encoding, and what it is called with.
fn call(chance: &mut Chance) -> Vec<u8> {
    let mut bytes = vec![if chance.percent(85) { 2 } else { chance.below(6) as u8 }];
    bytes.extend((chance.below(5) as u32).to_le_bytes());
    bytes.extend((nasty::whole(chance, 1) as u32).to_le_bytes());
    bytes.extend((if chance.percent(80) { 4 } else { nasty::whole(chance, 4) as u32 }).to_le_bytes());
    bytes.extend(b"json{}");
    bytes
}

fn words(chance: &mut Chance) -> Vec<u8> {
    let id = || json!("x");
    let mut list: Vec<Json> = Vec::new();
    for _ in 0..[1, 1, 2, 20, 3000][chance.below(5)] {
        list.push(json!({"id": chance.below(9), "channelId": chance.below(30)}));
    }
    let ids: Vec<usize> = (0..list.len()).collect();
    let names = json!(["/paused", "/speed", "/x"]);
    let (speed, paused) = ([0.5, 1.0, 2.0, 1e3, 1e9][chance.below(5)], chance.percent(50));
    let other =
        chance.one(&["advertise", "fetchAsset", "subscribeConnectionGraph", "", "playbackControlRequest"]);
    let said = match chance.below(10) {
        0..3 => json!({"op": "subscribe", "subscriptions": list}),
        3 => json!({"op": "unsubscribe", "subscriptionIds": ids}),
        4 => json!({"op": "getParameters", "parameterNames": names, "id": id()}),
        5 => {
            json!({"op": "setParameters", "parameters": [{"name": "/speed", "value": speed}], "id": id()})
        }
        6 => json!({"op": "setParameters", "parameters": [{"name": "/paused", "value": paused}]}),
        7 => json!({"op": "subscribeParameterUpdates", "parameterNames": names}),
        8 => json!({"op": "unsubscribeParameterUpdates", "parameterNames": names}),
        _ => {
            json!({"op": other, "channels": [], "requestId": 1, "uri": "file:///etc/passwd"})
        }
    };
    let mut tree = Node::from(&said);
    if chance.percent(60) {
        for _ in 0..chance.times() {
            mutate::tree(&mut tree, &[], chance);
        }
    }
    tree.json().into_bytes()
}

/// A live run in this process.
pub struct Server {
    run: JoinHandle<u8>,
    address: String,
}

impl Server {
    /// Starts the run of an input in the present directory; its messages come in a file.
    pub fn start(case: &Case, messages: &Path) -> io::Result<Self> {
        case.lay_out(Path::new("."))?;
        std::fs::OpenOptions::new().write(true).open(messages)?.set_len(0)?;
        let arguments = ["flexsc"].into_iter().chain(case.arguments.iter().map(String::as_str));
        let arguments: Vec<OsString> = arguments.map(OsString::from).collect();
        let run = thread::Builder::new().stack_size(8 << 20).spawn(|| flexsc_cli::main(arguments))?;
        let began = Instant::now();
        while began.elapsed() < PATIENCE && !run.is_finished() {
            let said = std::fs::read_to_string(messages).unwrap_or_default();
            let address = said.split_once("ws://").and_then(|(_, rest)| rest.split_once(','));
            if let Some((address, _)) = address {
                return Ok(Self { run, address: address.to_owned() });
            }
            thread::sleep(Duration::from_millis(2));
        }
        Err(io::Error::other("the run does not say where it is served"))
    }

    /// Returns true if the run has ended, which a viewer may cause.
    pub fn has_ended(&self) -> bool {
        self.run.is_finished()
    }

    /// Sends the bytes of a viewer, and reads the answers.
    pub fn receive(&self, sent: &[u8]) {
        let Ok(mut stream) = TcpStream::connect(&self.address) else { return };
        let _ = stream.set_write_timeout(Some(Duration::from_millis(200)));
        let _ = stream.set_read_timeout(Some(Duration::from_millis(3)));
        let mut taken = vec![0; 1 << 16];
        // In pieces, between which answers are read, so that neither side blocks.
        for part in sent.chunks(1 << 15) {
            if stream.write_all(part).is_err() {
                break;
            }
            let _ = stream.read(&mut taken);
        }
        let began = Instant::now();
        while began.elapsed() < Duration::from_millis(10) && stream.read(&mut taken).is_ok_and(|n| n > 0) {}
    }

    /// Returns true if a correct viewer is served.
    pub fn serves(&self) -> bool {
        let began = Instant::now();
        while began.elapsed() < PATIENCE && !self.has_ended() {
            if self.greets() {
                return true;
            }
            // It may have as many viewers as it takes until those who left are noticed.
            thread::sleep(Duration::from_millis(20));
        }
        self.has_ended()
    }

    fn greets(&self) -> bool {
        let Ok(mut stream) = TcpStream::connect(&self.address) else { return false };
        let _ = stream.set_read_timeout(Some(PATIENCE));
        if stream.write_all(hello().as_bytes()).is_err() {
            return false;
        }
        let (mut heard, mut part) = (Vec::new(), [0; 4096]);
        while let Ok(count @ 1..) = stream.read(&mut part) {
            heard.extend(&part[..count]);
            if String::from_utf8_lossy(&heard).contains("serverInfo") {
                let _ = stream.write_all(&FAREWELL);
                return true;
            }
        }
        false
    }
}
