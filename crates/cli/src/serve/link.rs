//! Links to clients: datagrams of UDP, or a stream of TCP.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::time::{Duration, Instant as WallInstant};

use super::packet::{LONGEST_PACKET, length};
use crate::stop;

/// Longest time limit for a client to take a packet.
pub const WRITE_TIMEOUT: Duration = Duration::from_secs(5);
/// Time limit of one write, after which the user's wish to stop is checked.
const PUSH: Duration = Duration::from_millis(50);
/// Time limit for the first packet of a connection.
const GREETING: Duration = Duration::from_secs(5);
/// Largest number of connections that have not been chosen.
const MOST_WAITING: usize = 32;
/// Period in which a connection is waited for.
const POLL_PERIOD: Duration = Duration::from_millis(2);
/// Longest datagram of UDP (bytes).
const DATAGRAM: usize = 65_535;

/// Transport of packets.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Transport {
    /// Datagrams, each with a packet; they may be lost.
    Udp,
    /// Stream of packets.
    Tcp,
}

impl Transport {
    /// Returns the name of the transport.
    pub fn name(self) -> &'static str {
        match self {
            Self::Udp => "udp",
            Self::Tcp => "tcp",
        }
    }
}

/// Outcome of waiting for a packet.
pub enum Received {
    /// Packet from this address.
    Packet(Vec<u8>, SocketAddr),
    /// No packet within the time.
    Nothing,
    /// End of the client's connection.
    Closed,
}

/// Socket with which clients communicate.
pub struct Link {
    socket: Socket,
    /// Answer to further clients of TCP.
    pub busy: Vec<u8>,
    /// Time limit for a client of TCP to take a packet.
    pub patience: Duration,
    /// Time limit that the socket has.
    wait: Duration,
}

enum Socket {
    Udp(UdpSocket),
    Tcp {
        listener: TcpListener,
        /// Connections that have not been chosen, the oldest first.
        waiting: Vec<Connection>,
        client: Option<Connection>,
    },
}

/// Connection of TCP.
struct Connection {
    stream: TcpStream,
    from: SocketAddr,
    buffer: Vec<u8>,
    since: WallInstant,
    /// True after a packet that was not taken whole: what follows it would be no packet.
    is_broken: bool,
}

impl Link {
    /// Binds the address of a server.
    pub fn bind(transport: Transport, address: SocketAddr) -> io::Result<Self> {
        let socket = match transport {
            Transport::Udp => Socket::Udp(UdpSocket::bind(address)?),
            Transport::Tcp => {
                let listener = TcpListener::bind(address)?;
                listener.set_nonblocking(true)?;
                Socket::Tcp { listener, waiting: Vec::new(), client: None }
            }
        };
        Ok(Self { socket, busy: Vec::new(), patience: WRITE_TIMEOUT, wait: Duration::ZERO })
    }

    /// Returns the address of the server.
    pub fn address(&self) -> io::Result<SocketAddr> {
        match &self.socket {
            Socket::Udp(socket) => socket.local_addr(),
            Socket::Tcp { listener, .. } => listener.local_addr(),
        }
    }

    /// Returns true if packets may be lost, so that they have to be repeated.
    pub fn is_lossy(&self) -> bool {
        matches!(self.socket, Socket::Udp(_))
    }

    /// Returns the next packet, if one comes within a time.
    pub fn receive(&mut self, wait: Duration) -> io::Result<Received> {
        let wait = wait.max(Duration::from_millis(1));
        match &mut self.socket {
            Socket::Udp(socket) => {
                if self.wait != wait {
                    socket.set_read_timeout(Some(wait))?;
                    self.wait = wait;
                }
                let mut datagram = vec![0; DATAGRAM];
                match socket.recv_from(&mut datagram) {
                    Ok((count, from)) => {
                        datagram.truncate(count);
                        Ok(Received::Packet(datagram, from))
                    }
                    Err(error) if is_silence(&error) => Ok(Received::Nothing),
                    Err(error) => Err(error),
                }
            }
            Socket::Tcp { listener, waiting, client } => {
                accept(listener, waiting, client.is_some().then_some(&*self.busy));
                let Some(client) = client else {
                    let received = greeted(waiting);
                    if let Received::Nothing = received {
                        std::thread::sleep(wait.min(POLL_PERIOD));
                    }
                    return Ok(received);
                };
                if client.is_broken {
                    return Ok(Received::Closed);
                }
                if self.wait != wait {
                    client.stream.set_read_timeout(Some(wait))?;
                    self.wait = wait;
                }
                Ok(client.read_packet())
            }
        }
    }

    /// Sends a packet to a client; one that cannot be sent is lost. A stream that does not take it whole in time has ended.
    pub fn send(&mut self, packet: &[u8], to: SocketAddr) {
        match &mut self.socket {
            Socket::Udp(socket) => {
                // A client that has gone is noticed by its silence.
                let _ = socket.send_to(packet, to);
            }
            Socket::Tcp { waiting, client, .. } => {
                if let Some(own) = client.iter_mut().chain(waiting).find(|own| own.from == to) {
                    own.send(packet, self.patience);
                }
            }
        }
    }

    /// Makes a connection that of the client; further ones get the answer that it controls the run.
    pub fn choose(&mut self, from: SocketAddr) -> io::Result<()> {
        let Socket::Tcp { waiting, client, .. } = &mut self.socket else { return Ok(()) };
        if let Some(place) = waiting.iter().position(|own| own.from == from) {
            let chosen = waiting.remove(place);
            chosen.stream.set_nonblocking(false)?;
            *client = Some(chosen);
            self.wait = Duration::ZERO;
        }
        for mut other in waiting.drain(..) {
            other.send(&self.busy, PUSH);
        }
        Ok(())
    }

    /// Closes the connection of a client.
    pub fn dismiss(&mut self, from: SocketAddr) {
        if let Socket::Tcp { waiting, client, .. } = &mut self.socket {
            waiting.retain(|own| own.from != from);
            client.take_if(|own| own.from == from);
        }
    }
}

/// Accepts the connections that have come. With a client, they only get the answer `busy`.
fn accept(listener: &TcpListener, waiting: &mut Vec<Connection>, busy: Option<&[u8]>) {
    for _ in 0..MOST_WAITING {
        let Ok((stream, from)) = listener.accept() else { return };
        let prepared = stream
            .set_nodelay(true)
            .and_then(|()| stream.set_write_timeout(Some(PUSH)))
            .and_then(|()| stream.set_nonblocking(busy.is_none()));
        if prepared.is_err() {
            // The connection has ended.
            continue;
        }
        let since = WallInstant::now();
        let mut connection = Connection { stream, from, buffer: Vec::new(), since, is_broken: false };
        if let Some(busy) = busy {
            connection.send(busy, PUSH);
            return;
        }
        if waiting.len() == MOST_WAITING {
            waiting.remove(0);
        }
        waiting.push(connection);
    }
}

/// Returns the first packet of a connection that has one; closes those that have ended or sent none in time.
fn greeted(waiting: &mut Vec<Connection>) -> Received {
    waiting.retain(|own| own.since.elapsed() < GREETING);
    let mut place = 0;
    while place < waiting.len() {
        match waiting[place].read_packet() {
            Received::Nothing => place += 1,
            Received::Closed => drop(waiting.remove(place)),
            packet @ Received::Packet(..) => return packet,
        }
    }
    Received::Nothing
}

impl Connection {
    /// Sends a packet within a time. A stream that does not take it whole is broken.
    fn send(&mut self, mut packet: &[u8], patience: Duration) {
        let began = WallInstant::now();
        while !packet.is_empty() && !self.is_broken {
            match self.stream.write(packet) {
                Ok(0) => self.is_broken = true,
                Ok(count) => packet = &packet[count..],
                Err(error) if is_silence(&error) && !stop::stop_requested() && began.elapsed() < patience => {
                    std::thread::sleep(POLL_PERIOD);
                }
                Err(_) => self.is_broken = true,
            }
        }
    }

    /// Returns the next packet of the stream; one that does not hold packets counts as closed.
    fn read_packet(&mut self) -> Received {
        let mut piece = [0; 4096];
        loop {
            if let Some(length) = length(&self.buffer) {
                if length > LONGEST_PACKET {
                    return Received::Closed;
                }
                if self.buffer.len() >= length {
                    let rest = self.buffer.split_off(length);
                    return Received::Packet(std::mem::replace(&mut self.buffer, rest), self.from);
                }
            }
            match self.stream.read(&mut piece) {
                Ok(0) => return Received::Closed,
                Ok(count) => self.buffer.extend(&piece[..count]),
                Err(error) if is_silence(&error) => return Received::Nothing,
                Err(_) => return Received::Closed,
            }
        }
    }
}

/// Returns true if an error means that nothing was received, or taken.
fn is_silence(error: &io::Error) -> bool {
    // The others are reports about an earlier datagram.
    matches!(
        error.kind(),
        ErrorKind::WouldBlock
            | ErrorKind::TimedOut
            | ErrorKind::Interrupted
            | ErrorKind::ConnectionReset
            | ErrorKind::ConnectionRefused
    )
}
