//! Session of a client: the agreement on the packets, the exchange of each cycle, and the end.

use std::io::{self, Write};
use std::net::SocketAddr;
use std::process;
use std::time::{Duration, Instant as WallInstant, SystemTime, UNIX_EPOCH};

use flexsc_core::Telemetry;
use flexsc_core::control::law::Command;
use flexsc_core::numerics::time::Instant;

use super::layout::{PacketLayout, VERSION, cycle_content};
use super::link::{Link, Received, WRITE_TIMEOUT};
use super::pace::Pace;
use super::packet::{ContentReader, PacketKind, PacketWriter, open};
use crate::{say, stop};

/// Time after which a packet without an answer is repeated on a link that loses packets.
const REPEAT: Duration = Duration::from_millis(20);
/// Number of times that the end of the run is sent to a client that does not confirm it.
const LAST_REPEATS: u32 = 25;
/// Silence after its welcome with which a client that has sent no command leaves its place to another one.
const HESITATION: Duration = Duration::from_secs(1);

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
    /// Time of the client's welcome.
    welcomed: WallInstant,
    /// True from the client's first command or request on, with which the run begins.
    has_begun: bool,
    /// True once the end of the run is reported, which Ctrl-C does not shorten.
    is_ending: bool,
    pub counts: PacketCounts,
}

/// Packet of the client, as far as it belongs to the session.
enum Message {
    Request(u64),
    Commands(u64, Result<Option<[Command; 3]>, String>),
    Farewell,
    /// Hello that is repeated, because its answer was lost.
    Hello,
}

impl Session {
    /// Creates the session of a client that agrees on the packets, for which it waits.
    pub fn begin(
        mut link: Link,
        layout: PacketLayout,
        pace: Pace,
        timeout: Option<Duration>,
    ) -> Result<Self, SessionEnd> {
        let mut writer = PacketWriter::default();
        link.busy = refusal(&mut writer, 0, "another client controls this run");
        link.patience = timeout.map_or(WRITE_TIMEOUT, |timeout| timeout.min(WRITE_TIMEOUT));
        let client = SocketAddr::from(([0; 4], 0));
        let counts = PacketCounts::default();
        let (number, nonce, welcomed) = (0, 0, WallInstant::now());
        let (has_begun, is_ending) = (false, false);
        let mut session = Self {
            link,
            layout,
            writer,
            client,
            number,
            nonce,
            pace,
            timeout,
            welcomed,
            has_begun,
            is_ending,
            counts,
        };
        session.wait_for_client()?;
        Ok(session)
    }

    /// Waits for a client that agrees on the packets, and welcomes it.
    fn wait_for_client(&mut self) -> Result<(), SessionEnd> {
        loop {
            if stop::stop_requested() {
                return Err(SessionEnd::Interrupted);
            }
            let Received::Packet(packet, from) = self.link.receive(REPEAT)? else { continue };
            if self.greet(&packet, from)? {
                return Ok(());
            }
        }
    }

    /// Welcomes the sender of a hello that agrees on the packets; returns false for any other packet.
    fn greet(&mut self, packet: &[u8], from: SocketAddr) -> Result<bool, SessionEnd> {
        let Some((nonce, version, expected)) = hello(packet) else {
            self.link.dismiss(from);
            return Ok(false);
        };
        if let Some(why) = disagreement(&self.layout, version, expected) {
            self.link.send(&refusal(&mut self.writer, nonce, &why), from);
            self.link.dismiss(from);
            return Ok(false);
        }
        self.link.choose(from)?;
        (self.client, self.number, self.nonce) = (from, session_number(), nonce);
        self.welcomed = WallInstant::now();
        say!("  client         {from}");
        self.welcome();
        Ok(true)
    }

    /// Waits for another client in the place of one that has ended before its first command; any other end is that of the session.
    fn replace_client(&mut self, end: SessionEnd) -> Result<(), SessionEnd> {
        match end {
            SessionEnd::Silent(_) | SessionEnd::Closed if !self.has_begun => {
                self.link.dismiss(self.client);
                self.wait_for_client()
            }
            end => Err(end),
        }
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
                    match self.message(REPEAT).and_then(|message| self.check_silence(began).map(|()| message))
                    {
                        Ok(Some(Message::Request(requested))) if requested == cycle => return Ok(()),
                        Ok(Some(Message::Hello)) => self.welcome(),
                        Ok(Some(_)) => self.counts.ignored += 1,
                        Ok(None) => {}
                        Err(end) => self.replace_client(end)?,
                    }
                }
            }
        }
    }

    /// Sends the sensors of a cycle, and returns the commands with which the client answers; `None` if those in force stay.
    pub fn exchange(
        &mut self,
        cycle: u64,
        now: Instant,
        before: Option<Instant>,
        telemetry: &Telemetry,
    ) -> Result<Option<[Command; 3]>, SessionEnd> {
        let mut number = self.number;
        let mut content = self.layout.sensor_content([number.into(), cycle], now, before, telemetry);
        let began = WallInstant::now();
        let mut sent = began;
        self.send(PacketKind::Sensors, &content);
        loop {
            let mut repeat = false;
            let wait = REPEAT.saturating_sub(sent.elapsed());
            match self.message(wait).and_then(|message| self.check_silence(began).map(|()| message)) {
                Ok(Some(Message::Commands(answered, commands))) if answered == cycle => {
                    return commands.map_err(|why| self.refuse(why));
                }
                Ok(Some(Message::Hello)) => {
                    self.welcome();
                    repeat = true;
                }
                Ok(Some(Message::Request(requested))) if requested == cycle => repeat = true,
                Ok(Some(_)) => self.counts.ignored += 1,
                Ok(None) => {}
                Err(end) => self.replace_client(end)?,
            }
            if number != self.number {
                // Another client has taken the place.
                number = self.number;
                content = self.layout.sensor_content([number.into(), cycle], now, before, telemetry);
                repeat = true;
            }
            if repeat || self.link.is_lossy() && sent.elapsed() >= REPEAT {
                self.send(PacketKind::Sensors, &content);
                self.counts.repeated += 1;
                sent = WallInstant::now();
            }
        }
    }

    /// Sends the client the reason why its commands are refused, and returns the end of the session.
    pub fn refuse(&mut self, why: String) -> SessionEnd {
        let packet = refusal(&mut self.writer, self.nonce, &why);
        self.link.send(&packet, self.client);
        SessionEnd::Refused(why)
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

    /// Fails if a client that was asked at a time, or was welcomed later, has not answered for too long.
    fn check_silence(&self, asked: WallInstant) -> Result<(), SessionEnd> {
        match self.timeout {
            Some(timeout) if asked.max(self.welcomed).elapsed() >= timeout => {
                Err(SessionEnd::Silent(timeout))
            }
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
            let is_free = !self.has_begun && self.welcomed.elapsed() >= HESITATION;
            if hello(&packet).is_some() && is_free {
                self.greet(&packet, from)?;
            } else if hello(&packet).is_some() {
                let busy = self.link.busy.clone();
                self.link.send(&busy, from);
            }
            self.counts.ignored += 1;
            return Ok(None);
        }
        let message = self.parse(&packet);
        self.has_begun |= matches!(message, Some(Message::Commands(..) | Message::Request(_)));
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
