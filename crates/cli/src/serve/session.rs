//! Session of a client: the agreement on the packets, the exchange of each cycle, and the end.

use std::io;
use std::net::SocketAddr;
use std::process;
use std::time::{Duration, Instant as WallInstant, SystemTime, UNIX_EPOCH};

use flexsc_core::Telemetry;
use flexsc_core::control::law::Command;
use flexsc_core::numerics::time::Instant;

use super::layout::{PacketLayout, VERSION, cycle_content};
use super::link::{Link, Received};
use super::pace::Pace;
use super::packet::{ContentReader, PacketKind, PacketWriter, open};
use crate::stop;

/// Time after which a packet without an answer is repeated on a link that loses packets.
const REPEAT: Duration = Duration::from_millis(20);
/// Number of times that the end of the run is sent to a client that does not confirm it.
const LAST_REPEATS: u32 = 25;
/// Time limit for the hello of a connection.
const GREETING: Duration = Duration::from_secs(5);

/// Reason why a session ends before its run does.
#[derive(Debug)]
pub enum SessionEnd {
    /// Ctrl-C.
    Interrupted,
    /// Silence of the client for longer than the time limit.
    Silent(Duration),
    /// End of the client's connection.
    Closed,
    /// Commands that are none.
    Refused(String),
    /// Failure of the socket.
    Io(io::Error),
}

impl From<io::Error> for SessionEnd {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Numbers of packets of a session.
#[derive(Copy, Clone, Debug, Default)]
pub struct PacketCounts {
    /// Packets that were sent again.
    pub repeated: u64,
    /// Received packets that were damaged, foreign, or of another cycle.
    pub ignored: u64,
}

/// Session of a client.
pub struct Session {
    link: Link,
    layout: PacketLayout,
    writer: PacketWriter,
    client: SocketAddr,
    number: u32,
    nonce: u32,
    pace: Pace,
    timeout: Option<Duration>,
    /// True once the end of the run is reported, which Ctrl-C does not shorten.
    is_ending: bool,
    pub counts: PacketCounts,
}

/// Packet of the client, as far as it belongs to the session.
enum Message {
    Request(u64),
    Commands(u64, Result<[Command; 3], String>),
    Farewell,
    /// Hello that is repeated, because its answer was lost.
    Hello,
}

impl Session {
    /// Waits for a client that agrees on the packets.
    pub fn begin(
        mut link: Link,
        layout: PacketLayout,
        pace: Pace,
        timeout: Option<Duration>,
    ) -> Result<Self, SessionEnd> {
        let mut writer = PacketWriter::default();
        link.busy = refusal(&mut writer, 0, "another client controls this run");
        let mut silent_since = WallInstant::now();
        loop {
            if stop::stop_requested() {
                return Err(SessionEnd::Interrupted);
            }
            let (packet, from) = match link.receive(REPEAT)? {
                Received::Packet(packet, from) => (packet, from),
                Received::Nothing if !link.is_connected() => {
                    silent_since = WallInstant::now();
                    continue;
                }
                Received::Nothing if silent_since.elapsed() < GREETING => continue,
                Received::Nothing | Received::Closed => {
                    link.dismiss();
                    silent_since = WallInstant::now();
                    continue;
                }
            };
            let Some((nonce, version, expected)) = hello(&packet) else { continue };
            if let Some(why) = disagreement(&layout, version, expected) {
                link.send(&refusal(&mut writer, nonce, &why), from);
                link.dismiss();
                continue;
            }
            let number = session_number();
            let counts = PacketCounts::default();
            let is_ending = false;
            let mut session =
                Self { link, layout, writer, client: from, number, nonce, pace, timeout, is_ending, counts };
            session.welcome();
            return Ok(session);
        }
    }

    /// Returns the address of the client.
    pub fn client(&self) -> SocketAddr {
        self.client
    }

    /// Returns the layout of the packets.
    pub fn layout(&self) -> &PacketLayout {
        &self.layout
    }

    fn welcome(&mut self) {
        let mut content = self.number.to_be_bytes().to_vec();
        content.extend(self.nonce.to_be_bytes());
        content.extend(VERSION.to_be_bytes());
        content.extend(self.layout.hash().to_be_bytes());
        content.push(self.pace.code());
        content.extend(self.layout.text().bytes());
        self.send(PacketKind::Welcome, &content);
    }

    fn send(&mut self, kind: PacketKind, content: &[u8]) {
        let packet = self.writer.packet(kind, content);
        self.link.send(&packet, self.client);
    }

    /// Waits until the wall clock, or the client, lets a cycle begin.
    pub fn wait_for_cycle(&mut self, cycle: u64, now: Instant) -> Result<(), SessionEnd> {
        match self.pace {
            Pace::Free => Ok(()),
            Pace::RealTime(_) => loop {
                let Some(wait) = self.pace.wait(now) else { return Ok(()) };
                if let Some(Message::Hello) = self.message(wait.min(REPEAT))? {
                    self.welcome();
                }
            },
            Pace::Step => {
                let began = WallInstant::now();
                loop {
                    match self.message(REPEAT)? {
                        Some(Message::Request(requested)) if requested == cycle => return Ok(()),
                        Some(Message::Hello) => self.welcome(),
                        Some(_) => self.counts.ignored += 1,
                        None => self.check_silence(began)?,
                    }
                }
            }
        }
    }

    /// Sends the sensors of a cycle, and returns the commands with which the client answers.
    pub fn exchange(
        &mut self,
        cycle: u64,
        now: Instant,
        before: Option<Instant>,
        telemetry: &Telemetry,
    ) -> Result<[Command; 3], SessionEnd> {
        let content = self.layout.sensor_content([self.number.into(), cycle], now, before, telemetry);
        let began = WallInstant::now();
        let mut sent = began;
        self.send(PacketKind::Sensors, &content);
        loop {
            let mut repeat = false;
            match self.message(REPEAT.saturating_sub(sent.elapsed()))? {
                Some(Message::Commands(answered, commands)) if answered == cycle => {
                    return commands.map_err(|why| {
                        let packet = refusal(&mut self.writer, self.nonce, &why);
                        self.link.send(&packet, self.client);
                        SessionEnd::Refused(why)
                    });
                }
                Some(Message::Hello) => {
                    self.welcome();
                    repeat = true;
                }
                Some(Message::Request(requested)) if requested == cycle => repeat = true,
                Some(_) => self.counts.ignored += 1,
                None => self.check_silence(began)?,
            }
            if repeat || self.link.is_lossy() && sent.elapsed() >= REPEAT {
                self.send(PacketKind::Sensors, &content);
                self.counts.repeated += 1;
                sent = WallInstant::now();
            }
        }
    }

    /// Reports the end of the run to the client, until it confirms it.
    pub fn end(&mut self, cycle: u64, now: Instant, code: u8) {
        let mut content = cycle_content([self.number.into(), cycle], now);
        content.push(code);
        self.is_ending = true;
        for _ in 0..LAST_REPEATS {
            self.send(PacketKind::End, &content);
            let sent = WallInstant::now();
            while sent.elapsed() < REPEAT {
                match self.message(REPEAT.saturating_sub(sent.elapsed())) {
                    Ok(Some(Message::Farewell)) | Err(_) => return,
                    Ok(_) => {}
                }
            }
        }
    }

    /// Fails if a client has been silent for too long, or the user asks to stop.
    fn check_silence(&self, began: WallInstant) -> Result<(), SessionEnd> {
        match self.timeout {
            Some(timeout) if began.elapsed() >= timeout => Err(SessionEnd::Silent(timeout)),
            _ => Ok(()),
        }
    }

    /// Returns the next message of the client, if one comes within a time.
    fn message(&mut self, wait: Duration) -> Result<Option<Message>, SessionEnd> {
        if stop::stop_requested() && !self.is_ending {
            return Err(SessionEnd::Interrupted);
        }
        let (packet, from) = match self.link.receive(wait)? {
            Received::Packet(packet, from) => (packet, from),
            Received::Nothing => return Ok(None),
            Received::Closed => return Err(SessionEnd::Closed),
        };
        if from != self.client {
            if hello(&packet).is_some() {
                let busy = self.link.busy.clone();
                self.link.send(&busy, from);
            }
            self.counts.ignored += 1;
            return Ok(None);
        }
        let message = self.parse(&packet);
        self.counts.ignored += u64::from(message.is_none());
        Ok(message)
    }

    fn parse(&self, packet: &[u8]) -> Option<Message> {
        let (kind, content) = open(packet).ok()?;
        if kind == PacketKind::Hello {
            let (nonce, ..) = hello(packet)?;
            return (nonce == self.nonce).then_some(Message::Hello);
        }
        let mut content = ContentReader(content);
        if content.u32()? != self.number {
            return None;
        }
        match kind {
            PacketKind::Request => {
                let cycle = content.u64()?;
                content.0.is_empty().then_some(Message::Request(cycle))
            }
            PacketKind::Command => {
                let cycle = content.u64()?;
                Some(Message::Commands(cycle, self.layout.commands(content)?))
            }
            PacketKind::Farewell => content.0.is_empty().then_some(Message::Farewell),
            _ => None,
        }
    }
}

/// Returns the nonce, the version and the expected layout of a hello.
fn hello(packet: &[u8]) -> Option<(u32, u16, u64)> {
    let (PacketKind::Hello, content) = open(packet).ok()? else { return None };
    let mut content = ContentReader(content);
    let _session = content.u32()?;
    let hello = (content.u32()?, content.u16()?, content.u64()?);
    content.0.is_empty().then_some(hello)
}

/// Returns the reason why a client and the server do not agree on the packets; a client without an expected layout takes any.
fn disagreement(layout: &PacketLayout, version: u16, expected: u64) -> Option<String> {
    if version != VERSION {
        return Some(format!("the server has version {VERSION} of the packets, and the client {version}"));
    }
    let hash = layout.hash();
    (expected != 0 && expected != hash).then(|| {
        format!(
            "the packets of this scenario have the layout {hash:016x}, and the client expects {expected:016x}"
        )
    })
}

fn refusal(writer: &mut PacketWriter, nonce: u32, why: &str) -> Vec<u8> {
    let mut content = vec![0; 4];
    content.extend(nonce.to_be_bytes());
    content.extend(why.bytes());
    writer.packet(PacketKind::Refusal, &content)
}

/// Returns a number that earlier runs on this port did not have, in all likelihood.
fn session_number() -> u32 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    (since.as_nanos() as u32 ^ process::id().rotate_left(16)).max(1)
}
