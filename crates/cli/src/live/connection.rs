//! Connection to a client with time limits and a count of the bytes sent.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant as WallInstant};

/// Time limit of a read, after which the queue of frames is checked.
const LISTEN: Duration = Duration::from_millis(5);
/// Time limit of a write, after which the client's patience limit is checked.
const PUSH: Duration = Duration::from_millis(50);
/// Least data (bytes) that a client must receive within [`PROGRESS_TIMEOUT`] while frames are waiting, unless it receives all.
const LEAST: u64 = 64 << 10;
const PROGRESS_TIMEOUT: Duration = Duration::from_secs(10);

/// Connection to a client.
pub struct Connection {
    stream: TcpStream,
    /// Deadline of the handshake, while it is in progress.
    until: Option<WallInstant>,
    /// Number of bytes sent.
    sent: u64,
    /// Time since when data is waiting, and the bytes sent by then.
    waiting: Option<(WallInstant, u64)>,
}

impl Connection {
    /// Returns a connection whose handshake must end within `greeting`.
    pub fn new(stream: TcpStream, greeting: Duration) -> io::Result<Self> {
        // The listener is non-blocking, which accepted sockets inherit on some systems.
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        Ok(Self { stream, until: Some(WallInstant::now() + greeting), sent: 0, waiting: None })
    }

    /// Ends the handshake phase.
    pub fn greeted(&mut self) -> io::Result<()> {
        self.until = None;
        self.stream.set_read_timeout(Some(LISTEN))?;
        self.stream.set_write_timeout(Some(PUSH))
    }

    /// Notes that the client has received all data.
    pub fn all_sent(&mut self) {
        self.waiting = None;
    }

    /// Notes that data is waiting; returns an error if the client has received too little for too long.
    pub fn wait(&mut self) -> io::Result<()> {
        let now = WallInstant::now();
        let (since, sent) = *self.waiting.get_or_insert((now, self.sent));
        if self.sent - sent >= LEAST {
            self.waiting = Some((now, self.sent));
        } else if now.duration_since(since) >= PROGRESS_TIMEOUT {
            return Err(io::Error::other("the client takes nothing"));
        }
        Ok(())
    }

    /// Returns the time left for the handshake; an error if it is over.
    fn remaining(&self) -> io::Result<Option<Duration>> {
        let Some(until) = self.until else { return Ok(None) };
        let remaining = until.saturating_duration_since(WallInstant::now());
        if remaining.is_zero() {
            Err(io::Error::other("the greeting takes too long"))
        } else {
            Ok(Some(remaining))
        }
    }
}

impl Read for Connection {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if let Some(remaining) = self.remaining()? {
            self.stream.set_read_timeout(Some(remaining))?;
        }
        self.stream.read(buffer)
    }
}

impl Write for Connection {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        if let Some(remaining) = self.remaining()? {
            self.stream.set_write_timeout(Some(remaining))?;
        }
        let written = self.stream.write(buffer)?;
        self.sent += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// Returns true if there was only no data to read, or no room to write.
pub fn would_block(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}
