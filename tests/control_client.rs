//! A control program for tests of `flexsc serve`, written from the page about its packets alone, and a link that loses,
//! repeats, reorders and damages packets.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::net::{TcpStream, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

pub const HELLO: u16 = 0x2F0;
pub const WELCOME: u16 = 0x2F1;
pub const REFUSAL: u16 = 0x2F2;
pub const REQUEST: u16 = 0x2F3;
pub const SENSORS: u16 = 0x2F4;
pub const COMMAND: u16 = 0x2F5;
pub const END: u16 = 0x2F6;
pub const FAREWELL: u16 = 0x2F7;

/// Time without a packet after which a test fails.
const PATIENCE: Duration = Duration::from_secs(20);

/// Returns a packet with this content.
pub fn packet(apid: u16, count: u16, content: &[u8]) -> Vec<u8> {
    let telecommand = [HELLO, REQUEST, COMMAND, FAREWELL].contains(&apid);
    let mut packet = Vec::new();
    for word in [u16::from(telecommand) << 12 | apid, 0xC000 | count & 0x3FFF, (content.len() + 1) as u16] {
        packet.extend(word.to_be_bytes());
    }
    packet.extend(content);
    packet.extend(checksum(&packet).to_be_bytes());
    packet
}

fn checksum(data: &[u8]) -> u16 {
    data.iter().fold(0xFFFF, |sum, byte| {
        (0..8).rev().fold(sum, |sum: u16, bit| {
            let carry = sum >> 15 ^ u16::from(byte >> bit & 1);
            (sum << 1) ^ (carry * 0x1021)
        })
    })
}

/// Returns the identifier and the content of a packet.
pub fn open(packet: &[u8]) -> Option<(u16, &[u8])> {
    let (data, sum) = packet.split_at_checked(packet.len().checked_sub(2)?)?;
    let length = usize::from(u16::from_be_bytes([*data.get(4)?, *data.get(5)?])) + 7;
    (length == packet.len() && checksum(data).to_be_bytes() == sum)
        .then(|| (u16::from_be_bytes([data[0], data[1]]) & 0x7FF, &data[6..]))
}

/// Returns the content of a hello.
pub fn hello(nonce: u32, version: u16, layout: u64) -> Vec<u8> {
    let mut content = vec![0; 4];
    content.extend(nonce.to_be_bytes());
    content.extend(version.to_be_bytes());
    content.extend(layout.to_be_bytes());
    content
}

enum Socket {
    Udp(UdpSocket),
    Tcp(TcpStream),
}

/// Control program.
pub struct ControlClient {
    socket: Socket,
    count: u16,
    session: u32,
    pub layout: u64,
    pub pace: u8,
    pub axes: usize,
    /// Offset, size and number of values of each field.
    fields: BTreeMap<String, (usize, usize, usize)>,
}

/// Sensors of a cycle.
pub struct Sensed<'a> {
    client: &'a ControlClient,
    content: &'a [u8],
    pub cycle: u64,
}

impl Sensed<'_> {
    /// Returns the numbers of a field.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        let (offset, size, count) = self.client.fields[name];
        assert_eq!(size, 8, "{name}");
        let each = self.content[offset..offset + size * count].chunks(8);
        each.map(|bytes| f64::from_be_bytes(bytes.try_into().expect("eight"))).collect()
    }

    /// Returns the value of a field of one integer.
    pub fn integer(&self, name: &str) -> u64 {
        let (offset, size, _) = self.client.fields[name];
        self.content[offset..offset + size].iter().fold(0, |value, byte| value << 8 | u64::from(*byte))
    }
}

impl ControlClient {
    /// Connects to a server by the address that it prints, such as `udp 127.0.0.1:5010`.
    pub fn connect(transport: &str, address: &str) -> Result<Self, String> {
        Self::expecting(transport, address, 1, 0)
    }

    /// Connects with this version and expected layout; returns the text of a refusal.
    pub fn expecting(transport: &str, address: &str, version: u16, layout: u64) -> Result<Self, String> {
        let socket = if transport == "udp" {
            let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
            socket.connect(address).expect("connected");
            socket.set_read_timeout(Some(Duration::from_millis(50))).expect("set");
            Socket::Udp(socket)
        } else {
            let stream = TcpStream::connect(address).expect("connected");
            stream.set_nodelay(true).expect("set");
            stream.set_read_timeout(Some(PATIENCE)).expect("set");
            Socket::Tcp(stream)
        };
        let (count, session, pace, axes, fields) = (0, 0, 0, 0, BTreeMap::new());
        let mut client = Self { socket, count, session, layout: 0, pace, axes, fields };
        let nonce = std::process::id() ^ 0x5A5A_0000;
        let began = Instant::now();
        while began.elapsed() < PATIENCE {
            client.send(HELLO, &hello(nonce, version, layout));
            let Some(answer) = client.receive() else { continue };
            match open(&answer) {
                Some((REFUSAL, content)) => {
                    return Err(String::from_utf8(content[8..].to_vec()).expect("UTF-8"));
                }
                Some((WELCOME, content)) => {
                    client.agree(content);
                    return Ok(client);
                }
                _ => {}
            }
        }
        panic!("no welcome from {address}")
    }

    fn agree(&mut self, content: &[u8]) {
        self.session = u32::from_be_bytes(content[..4].try_into().expect("four"));
        self.layout = u64::from_be_bytes(content[10..18].try_into().expect("eight"));
        self.pace = content[18];
        let text = std::str::from_utf8(&content[19..]).expect("UTF-8");
        let mut lines = text.lines();
        let head: Vec<&str> = lines.next().expect("a head").split(' ').collect();
        assert_eq!(head[..2], ["flexsc-lockstep", "1"]);
        self.axes = head[3].parse().expect("a number");
        let mut offset = 0;
        for line in lines {
            let words: Vec<&str> = line.split(' ').collect();
            let size = match words[1] {
                "u8" => 1,
                "u32" => 4,
                _ => 8,
            };
            let count = words[2].split(',').count();
            self.fields.insert(words[0].to_owned(), (offset, size, count));
            offset += size * count;
        }
    }

    pub fn send(&mut self, apid: u16, content: &[u8]) {
        let packet = packet(apid, self.count, content);
        self.count = self.count.wrapping_add(1);
        self.send_bytes(&packet);
    }

    pub fn send_bytes(&mut self, bytes: &[u8]) {
        // A server that has gone is noticed by its silence.
        let _ = match &mut self.socket {
            Socket::Udp(socket) => socket.send(bytes).map(drop),
            Socket::Tcp(stream) => stream.write_all(bytes),
        };
    }

    /// Returns the bytes of the next packet; `None` if none has come within a short time.
    pub fn receive(&mut self) -> Option<Vec<u8>> {
        match &mut self.socket {
            Socket::Udp(socket) => {
                let mut bytes = vec![0; 65_535];
                let count = socket.recv(&mut bytes).ok()?;
                bytes.truncate(count);
                Some(bytes)
            }
            Socket::Tcp(stream) => {
                let mut bytes = vec![0; 6];
                stream.read_exact(&mut bytes).ok()?;
                let rest = usize::from(u16::from_be_bytes([bytes[4], bytes[5]])) + 1;
                bytes.resize(6 + rest, 0);
                stream.read_exact(&mut bytes[6..]).ok()?;
                Some(bytes)
            }
        }
    }

    /// Returns the content of a packet of a cycle, with its session.
    pub fn content(&self, cycle: u64) -> Vec<u8> {
        let mut content = self.session.to_be_bytes().to_vec();
        content.extend(cycle.to_be_bytes());
        content
    }

    /// Returns the content of commands with a quantity about all axes.
    pub fn answer(&self, cycle: u64, quantity: u8, values: &[f64]) -> Vec<u8> {
        let mut content = self.content(cycle);
        content.extend(vec![quantity; self.axes]);
        content.extend(values.iter().take(self.axes).flat_map(|value| value.to_be_bytes()));
        content
    }

    /// Answers each cycle once with the law's commands of a quantity, and repeats an answer that was lost; at most `cycles`
    /// cycles. Returns the code of the run's end, or the text of a refusal.
    pub fn control(
        &mut self,
        cycles: u64,
        quantity: u8,
        mut law: impl FnMut(&Sensed<'_>) -> Vec<f64>,
    ) -> Result<Option<u8>, String> {
        let (mut expected, mut answer) = (0, Vec::new());
        let mut heard = Instant::now();
        loop {
            if self.pace == 2 && heard.elapsed() < PATIENCE {
                self.send(REQUEST, &self.content(expected));
            }
            let Some(bytes) = self.receive() else {
                assert!(heard.elapsed() < PATIENCE, "the server is silent");
                continue;
            };
            let Some((apid, content)) = open(&bytes) else { continue };
            if apid == REFUSAL {
                return Err(String::from_utf8(content[8..].to_vec()).expect("UTF-8"));
            }
            if content[..4] != self.session.to_be_bytes() {
                continue;
            }
            heard = Instant::now();
            if apid == END {
                self.send(FAREWELL, &content[..4]);
                return Ok(content.last().copied());
            }
            if apid != SENSORS {
                continue;
            }
            let cycle = u64::from_be_bytes(content[4..12].try_into().expect("eight"));
            if cycle == expected {
                if cycle == cycles {
                    return Ok(None);
                }
                let values = law(&Sensed { client: self, content, cycle });
                answer = self.answer(cycle, quantity, &values);
                expected += 1;
            }
            if cycle + 1 == expected {
                self.send(COMMAND, &answer);
            }
        }
    }
}

/// Faults of a link: the share of packets that each concerns, in each direction.
#[derive(Copy, Clone, Default)]
pub struct Faults {
    pub lost: f64,
    pub repeated: f64,
    pub damaged: f64,
    /// Packets that arrive after the next one.
    pub late: f64,
    /// Packets of another program beside those of the link.
    pub foreign: f64,
}

/// Link with faults between a client and a server. It ends when it is dropped.
pub struct FaultyLink {
    pub address: String,
    pub faults: Arc<AtomicUsize>,
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl FaultyLink {
    /// Creates a link to a server; the faults follow from the seed and the order of the packets.
    pub fn new(server: &str, faults: Faults, seed: u64) -> Self {
        let [near, far] = [0, 1].map(|_| UdpSocket::bind("127.0.0.1:0").expect("a port"));
        far.connect(server).expect("connected");
        for socket in [&near, &far] {
            socket.set_read_timeout(Some(Duration::from_millis(20))).expect("set");
        }
        let address = near.local_addr().expect("bound").to_string();
        let (stop, count) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
        let client = Arc::new(std::sync::Mutex::new(None));
        let clone = |socket: &UdpSocket| socket.try_clone().expect("cloned");
        let threads = [(clone(&near), clone(&far), true), (far, near, false)].map(|(from, to, is_up)| {
            let (stop, count, client) = (stop.clone(), count.clone(), client.clone());
            let mut random = seed * 2 + u64::from(is_up) + 1;
            thread::spawn(move || {
                let (mut buffer, mut held) = (vec![0; 65_535], None::<Vec<u8>>);
                while !stop.load(Ordering::Relaxed) {
                    let Ok((length, source)) = from.recv_from(&mut buffer) else { continue };
                    if is_up {
                        *client.lock().expect("free") = Some(source);
                    }
                    let target = *client.lock().expect("free");
                    let send = |bytes: &[u8]| {
                        let _ = match (is_up, target) {
                            (true, _) => to.send(bytes),
                            (false, Some(target)) => to.send_to(bytes, target),
                            (false, None) => Ok(0),
                        };
                    };
                    let mut hits = |share: f64| {
                        let hit = share > 0.0 && uniform(&mut random) < share;
                        count.fetch_add(usize::from(hit), Ordering::Relaxed);
                        hit
                    };
                    if hits(faults.foreign) {
                        send(&buffer[..length / 2]);
                        send(b"something else");
                    }
                    if hits(faults.lost) {
                        continue;
                    }
                    let mut bytes = buffer[..length].to_vec();
                    if hits(faults.damaged) {
                        bytes[length / 2] ^= 0x10;
                    }
                    if held.is_none() && hits(faults.late) {
                        held = Some(bytes);
                        continue;
                    }
                    send(&bytes);
                    if hits(faults.repeated) {
                        send(&bytes);
                    }
                    if let Some(late) = held.take() {
                        send(&late);
                    }
                }
            })
        });
        Self { address, faults: count, stop, threads: threads.into() }
    }
}

impl Drop for FaultyLink {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

/// Returns a uniform number between 0 and 1, by a xorshift.
fn uniform(state: &mut u64) -> f64 {
    for _ in 0..2 {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
    }
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}
