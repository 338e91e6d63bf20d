//! Client of `flexsc serve` that sends the packets of a script, and then controls the run to its end.
//!
//! A line of the script is `hello`, `answer QUANTITY VALUE` (correct commands of the present cycle), `request`, `farewell`, `wait`
//! (for a packet), `open` (a new socket), `raw BYTES` or `packet BYTES`: the last one gets the session behind its header, its length
//! and its checksum. Bytes are hexadecimal; a word `S` stands for the session, and `C` for the number of the present cycle.

use std::io::{ErrorKind, Read, Write};
use std::net::{TcpStream, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

const HELLO: u16 = 0x12F0;
const WELCOME: u16 = 0x02F1;
const REFUSAL: u16 = 0x02F2;
const REQUEST: u16 = 0x12F3;
const SENSORS: u16 = 0x02F4;
const COMMAND: u16 = 0x12F5;
const END: u16 = 0x02F6;
const FAREWELL: u16 = 0x12F7;

/// Bytes of the header of a packet.
const HEADER: usize = 6;
/// Pace of a server that waits for requests.
const STEP_PACE: u8 = 2;
/// Time for which a packet is waited for.
const WAIT: Duration = Duration::from_millis(5);
/// Number of times without a packet after which a stream is closed.
const MOST_SILENT: u32 = 10;

enum Socket {
    Udp(UdpSocket),
    Tcp(TcpStream),
}

/// Client.
pub struct LockstepClient<'a> {
    transport: &'a str,
    address: &'a str,
    socket: Option<Socket>,
    /// Received bytes of a stream that are no whole packet.
    stream: Vec<u8>,
    session: Option<u32>,
    pace: u8,
    axes: usize,
    /// Present cycle; none before the first one.
    cycle: Option<u64>,
    count: u16,
}

impl<'a> LockstepClient<'a> {
    /// Creates a client for a server, by the transport and the address that it prints.
    pub fn new(transport: &'a str, address: &'a str) -> Self {
        let (socket, stream, session, cycle) = (None, Vec::new(), None, None);
        let mut client =
            Self { transport, address, socket, stream, session, pace: 0, axes: 1, cycle, count: 0 };
        client.open();
        client
    }

    /// Sends the packets of a script, and then correct commands until the server has ended.
    pub fn control(&mut self, script: &str, has_ended: &AtomicBool) {
        for line in script.lines() {
            self.perform(line);
        }
        let mut silent = 0;
        while !has_ended.load(Ordering::Relaxed) {
            if self.socket.is_none() {
                self.open();
            }
            if self.session.is_none() {
                self.perform("hello");
            }
            if self.pace == STEP_PACE {
                let next = self.cycle.map_or(0, |cycle| cycle + 1);
                self.send(&self.content(REQUEST, next));
            }
            silent += 1;
            if let Some(kind) = self.receive() {
                silent = 0;
                if kind == SENSORS {
                    self.perform("answer 0 0");
                }
            }
            // A server that still waits for the rest of a packet hears that there is none.
            if silent > MOST_SILENT && self.transport == "tcp" {
                self.close();
                silent = 0;
            }
        }
    }

    fn open(&mut self) {
        self.socket = None;
        self.stream.clear();
        self.session = None;
        self.socket = if self.transport == "udp" {
            let socket = UdpSocket::bind("127.0.0.1:0").ok();
            let socket = socket.filter(|socket| socket.connect(self.address).is_ok());
            socket.filter(|socket| socket.set_read_timeout(Some(WAIT)).is_ok()).map(Socket::Udp)
        } else {
            let stream = TcpStream::connect(self.address).ok();
            let limited = |stream: &TcpStream| {
                stream.set_read_timeout(Some(WAIT)).is_ok()
                    && stream.set_write_timeout(Some(10 * WAIT)).is_ok()
            };
            stream.filter(limited).map(Socket::Tcp)
        };
        if self.socket.is_none() {
            std::thread::sleep(WAIT);
        }
    }

    fn perform(&mut self, line: &str) {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        match word {
            "hello" => {
                let nonce = u64::from(std::process::id() ^ 0x5A5A_0000);
                let content = [&[0; 4], &nonce.to_be_bytes()[4..], &[0, 1], &[0; 8]].concat();
                self.send(&[&HELLO.to_be_bytes()[..], &[0; 4], &content].concat());
                self.receive();
            }
            "answer" => {
                let (quantity, value) = rest.split_once(' ').unwrap_or(("0", "0"));
                let quantity = quantity.parse().unwrap_or(0_u8);
                let value: f64 = value.parse().unwrap_or(0.0);
                let mut packet = self.content(COMMAND, self.cycle.unwrap_or(0));
                packet.extend(vec![quantity; self.axes]);
                packet.extend(value.to_be_bytes().repeat(self.axes));
                self.send(&packet);
            }
            "request" => self.send(&self.content(REQUEST, self.cycle.map_or(0, |cycle| cycle + 1))),
            "farewell" => {
                let packet = self.content(FAREWELL, 0);
                self.send(&packet[..HEADER + 4]);
            }
            "wait" => drop(self.receive()),
            "open" => self.open(),
            "raw" => self.send_bytes(&self.bytes(rest)),
            _ => {
                let mut packet = self.bytes(rest);
                let session = self.session.unwrap_or(0).to_be_bytes();
                if let Some(place) = packet.get_mut(HEADER..HEADER + 4) {
                    place.copy_from_slice(&session);
                }
                packet.resize(packet.len().max(HEADER), 0);
                self.send(&packet);
            }
        }
    }

    /// Returns the bytes of hexadecimal words.
    fn bytes(&self, words: &str) -> Vec<u8> {
        let mut bytes = Vec::new();
        for word in words.split(' ') {
            match word {
                "S" => bytes.extend(self.session.unwrap_or(0).to_be_bytes()),
                "C" => bytes.extend(self.cycle.unwrap_or(0).to_be_bytes()),
                _ => bytes.extend(
                    word.as_bytes()
                        .chunks(2)
                        .filter_map(|digits| u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()),
                ),
            }
        }
        bytes
    }

    /// Returns the header, the session and the cycle of a packet.
    fn content(&self, kind: u16, cycle: u64) -> Vec<u8> {
        let session = self.session.unwrap_or(0).to_be_bytes();
        [&kind.to_be_bytes()[..], &[0; 4], &session, &cycle.to_be_bytes()].concat()
    }

    /// Sends a packet with this kind and content, with its count, length and checksum.
    fn send(&mut self, packet: &[u8]) {
        let mut packet = packet.to_vec();
        packet[2..4].copy_from_slice(&(0xC000 | self.count).to_be_bytes());
        self.count = (self.count + 1) & 0x3FFF;
        let length = (packet.len() + 1 - HEADER) as u16;
        packet[4..HEADER].copy_from_slice(&length.to_be_bytes());
        packet.extend(checksum(&packet).to_be_bytes());
        self.send_bytes(&packet);
    }

    fn send_bytes(&mut self, bytes: &[u8]) {
        let is_sent = match &mut self.socket {
            // Nothing is heard of a datagram that is too long, or for which there is no server.
            Some(Socket::Udp(socket)) => socket.send(bytes).map_or(true, |_| true),
            Some(Socket::Tcp(stream)) => stream.write_all(bytes).is_ok(),
            None => true,
        };
        if !is_sent {
            self.close();
        }
    }

    fn close(&mut self) {
        (self.socket, self.session) = (None, None);
    }

    /// Takes the next packet, if one comes within a time, and returns its kind.
    fn receive(&mut self) -> Option<u16> {
        let packet = match &mut self.socket {
            Some(Socket::Udp(socket)) => {
                let mut bytes = vec![0; 65_535];
                let length = socket.recv(&mut bytes).ok()?;
                bytes.truncate(length);
                bytes
            }
            Some(Socket::Tcp(_)) => self.next_of_stream()?,
            None => return None,
        };
        let number = |from: usize, length: usize| {
            let bytes = packet.get(from..from + length)?;
            Some(bytes.iter().fold(0, |number, byte| number << 8 | u64::from(*byte)))
        };
        let kind = number(0, 2)? as u16;
        match kind {
            WELCOME => {
                self.session = number(HEADER, 4).map(|session| session as u32);
                self.pace = *packet.get(HEADER + 18)?;
                let text = String::from_utf8_lossy(&packet[HEADER + 19..]).into_owned();
                self.axes = text.split(' ').nth(3).and_then(|axes| axes.parse().ok()).unwrap_or(1);
                self.cycle = None;
            }
            SENSORS => self.cycle = number(HEADER + 4, 8),
            END => self.perform("farewell"),
            // Another client, that of an earlier socket, controls the run until it has been silent for too long.
            REFUSAL => std::thread::sleep(WAIT),
            _ => {}
        }
        Some(kind)
    }

    fn next_of_stream(&mut self) -> Option<Vec<u8>> {
        let Some(Socket::Tcp(stream)) = &mut self.socket else { return None };
        let mut piece = [0; 4096];
        loop {
            let length =
                self.stream.get(4..HEADER).map(|bytes| usize::from(bytes[0]) << 8 | usize::from(bytes[1]));
            if let Some(length) =
                length.map(|length| HEADER + 1 + length).filter(|length| *length <= self.stream.len())
            {
                let rest = self.stream.split_off(length);
                return Some(std::mem::replace(&mut self.stream, rest));
            }
            match stream.read(&mut piece) {
                Ok(count @ 1..) => self.stream.extend(&piece[..count]),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    return None;
                }
                _ => {
                    self.close();
                    return None;
                }
            }
        }
    }
}

/// Returns the cyclic redundancy check of a packet: the polynomial x^16 + x^12 + x^5 + 1 from all ones.
fn checksum(data: &[u8]) -> u16 {
    data.iter().fold(0xFFFF, |sum, byte| {
        (0..8).fold(sum ^ u16::from(*byte) << 8, |sum: u16, _| {
            sum << 1 ^ if sum & 0x8000 == 0 { 0 } else { 0x1021 }
        })
    })
}
