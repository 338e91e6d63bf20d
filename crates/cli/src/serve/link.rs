//! Links to clients: datagrams of UDP, or a stream of TCP.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::time::Duration;

use super::packet::{LONGEST_PACKET, length};

/// Time limit for a client to take what it is sent.
const WRITE_TIMEOUT: Duration = Duration::from_secs(5);
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
    /// Time limit that the socket has.
    wait: Duration,
}

enum Socket {
    Udp(UdpSocket),
    Tcp { listener: TcpListener, client: Option<(TcpStream, SocketAddr)>, buffer: Vec<u8> },
}

impl Link {
    /// Binds the address of a server.
    pub fn bind(transport: Transport, address: SocketAddr) -> io::Result<Self> {
        let socket = match transport {
            Transport::Udp => Socket::Udp(UdpSocket::bind(address)?),
            Transport::Tcp => {
                let listener = TcpListener::bind(address)?;
                listener.set_nonblocking(true)?;
                Socket::Tcp { listener, client: None, buffer: Vec::new() }
            }
        };
        Ok(Self { socket, busy: Vec::new(), wait: Duration::ZERO })
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

    /// Returns true if a client has a connection.
    pub fn is_connected(&self) -> bool {
        matches!(self.socket, Socket::Tcp { client: Some(_), .. })
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
            Socket::Tcp { listener, client, buffer } => {
                accept(listener, client, &self.busy)?;
                let Some((stream, from)) = client else {
                    std::thread::sleep(wait.min(POLL_PERIOD));
                    return Ok(Received::Nothing);
                };
                if self.wait != wait {
                    stream.set_read_timeout(Some(wait))?;
                    self.wait = wait;
                }
                Ok(read_packet(stream, buffer, *from))
            }
        }
    }

    /// Sends a packet to a client; one that cannot be sent is lost.
    pub fn send(&mut self, packet: &[u8], to: SocketAddr) {
        // A client that has gone is noticed by its silence.
        let _ = match &mut self.socket {
            Socket::Udp(socket) => socket.send_to(packet, to).map(drop),
            Socket::Tcp { client: Some((stream, _)), .. } => stream.write_all(packet),
            Socket::Tcp { .. } => Ok(()),
        };
    }

    /// Closes the connection of a client that cannot begin.
    pub fn dismiss(&mut self) {
        if let Socket::Tcp { client, buffer, .. } = &mut self.socket {
            *client = None;
            buffer.clear();
            self.wait = Duration::ZERO;
        }
    }
}

/// Accepts a waiting connection: the client if there is none, and another one only to be refused.
fn accept(
    listener: &TcpListener,
    client: &mut Option<(TcpStream, SocketAddr)>,
    busy: &[u8],
) -> io::Result<()> {
    let Ok((mut stream, from)) = listener.accept() else { return Ok(()) };
    stream.set_nonblocking(false)?;
    stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
    if client.is_some() {
        let _ = stream.write_all(busy);
        return Ok(());
    }
    stream.set_nodelay(true)?;
    *client = Some((stream, from));
    Ok(())
}

/// Returns the next packet of a stream; one that does not hold packets counts as closed.
fn read_packet(stream: &mut TcpStream, buffer: &mut Vec<u8>, from: SocketAddr) -> Received {
    let mut piece = [0; 4096];
    loop {
        if let Some(length) = length(buffer) {
            if length > LONGEST_PACKET {
                return Received::Closed;
            }
            if buffer.len() >= length {
                let rest = buffer.split_off(length);
                return Received::Packet(std::mem::replace(buffer, rest), from);
            }
        }
        match stream.read(&mut piece) {
            Ok(0) => return Received::Closed,
            Ok(count) => buffer.extend(&piece[..count]),
            Err(error) if is_silence(&error) => return Received::Nothing,
            Err(_) => return Received::Closed,
        }
    }
}

/// Returns true if an error means that nothing was received.
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
