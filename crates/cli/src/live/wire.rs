//! The connection to a client: what it takes is counted, and what it may keep us waiting for has an end.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant as WallInstant};

/// How long to listen before looking whether there is something to send.
const LISTEN: Duration = Duration::from_millis(5);
/// How long to wait for a client to take something before looking at the time.
const PUSH: Duration = Duration::from_millis(50);
/// A client for whom there is something has to take this much (bytes), or all, in this time.
const LEAST: u64 = 64 << 10;
const PATIENCE: Duration = Duration::from_secs(10);

/// A connection.
pub struct Wire {
    stream: TcpStream,
    /// When a greeting that is under way has to be over.
    until: Option<WallInstant>,
    /// Bytes that were sent.
    sent: u64,
    /// Since when something waits to be sent, and what was sent by then.
    waiting: Option<(WallInstant, u64)>,
}

impl Wire {
    /// A connection whose greeting may take so long.
    pub fn new(stream: TcpStream, greeting: Duration) -> io::Result<Self> {
        // The listener does not block, and on some systems what it accepts inherits that.
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        Ok(Self { stream, until: Some(WallInstant::now() + greeting), sent: 0, waiting: None })
    }

    /// The greeting is over.
    pub fn greeted(&mut self) -> io::Result<()> {
        self.until = None;
        self.stream.set_read_timeout(Some(LISTEN))?;
        self.stream.set_write_timeout(Some(PUSH))
    }

    /// The client has taken all.
    pub fn settle(&mut self) {
        self.waiting = None;
    }

    /// The client has not taken all: an error if it has taken too little for too long.
    pub fn wait(&mut self) -> io::Result<()> {
        let now = WallInstant::now();
        let (since, sent) = *self.waiting.get_or_insert((now, self.sent));
        if self.sent - sent >= LEAST {
            self.waiting = Some((now, self.sent));
        } else if now.duration_since(since) >= PATIENCE {
            return Err(io::Error::other("the client takes nothing"));
        }
        Ok(())
    }

    /// What is left of the time for a greeting.
    fn left(&self) -> io::Result<Option<Duration>> {
        let Some(until) = self.until else { return Ok(None) };
        let left = until.saturating_duration_since(WallInstant::now());
        if left.is_zero() { Err(io::Error::other("the greeting takes too long")) } else { Ok(Some(left)) }
    }
}

impl Read for Wire {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if let Some(left) = self.left()? {
            self.stream.set_read_timeout(Some(left))?;
        }
        self.stream.read(buffer)
    }
}

impl Write for Wire {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        if let Some(left) = self.left()? {
            self.stream.set_write_timeout(Some(left))?;
        }
        let written = self.stream.write(buffer)?;
        self.sent += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// Whether there was only nothing to read, or no room to write.
pub fn is_silence(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}
