//! A client of a live run: its connection, on a thread of its own.

use std::io;
use std::net::TcpStream;
use std::time::{Duration, Instant as WallInstant};

use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, WebSocket};

use super::hub::Hub;
use super::protocol::SUBPROTOCOLS;

const SUBPROTOCOL: &str = "sec-websocket-protocol";
/// How long a client may take to say what it wants, and to say farewell.
const GREETING: Duration = Duration::from_secs(5);
const FAREWELL: Duration = Duration::from_secs(1);
/// How long a client may take nothing that is sent before it counts as gone.
const PATIENCE: Duration = Duration::from_secs(10);
/// How long to listen before looking whether there is something to send.
const LISTEN: Duration = Duration::from_millis(5);
/// Clients only ask: no frame of theirs is larger (bytes).
const LARGEST: usize = 1 << 20;

/// Serves a client until it goes or is sent away.
pub fn serve(hub: &Hub, stream: TcpStream) {
    let Ok(mut socket) = greet(stream) else { return };
    let id = hub.join();
    // A connection that breaks is a client that has gone.
    let _ = converse(hub, id, &mut socket);
    hub.leave(id);
}

fn greet(stream: TcpStream) -> Result<WebSocket<TcpStream>, Error> {
    // The listener does not block, and on some systems what it accepts inherits that.
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(GREETING))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let config = WebSocketConfig::default().max_message_size(Some(LARGEST)).max_frame_size(Some(LARGEST));
    let socket = tungstenite::accept_hdr_with_config(stream, agree, Some(config));
    let socket = socket.map_err(|error| Error::Io(io::Error::other(error.to_string())))?;
    socket.get_ref().set_read_timeout(Some(LISTEN))?;
    Ok(socket)
}

/// Agrees with a client on the protocol.
#[expect(clippy::result_large_err, reason = "the signature is the library's")]
fn agree(request: &Request, mut response: Response) -> Result<Response, ErrorResponse> {
    let asked = request.headers().get_all(SUBPROTOCOL).iter().filter_map(|value| value.to_str().ok());
    let asked: Vec<&str> = asked.flat_map(|names| names.split(',')).map(str::trim).collect();
    if let Some(name) = SUBPROTOCOLS.into_iter().find(|name| asked.contains(name)) {
        response.headers_mut().insert(SUBPROTOCOL, HeaderValue::from_static(name));
        return Ok(response);
    }
    let why = format!("ask for the subprotocol {}", SUBPROTOCOLS.join(" or "));
    let mut response = ErrorResponse::new(Some(why));
    *response.status_mut() = StatusCode::BAD_REQUEST;
    Err(response)
}

fn converse(hub: &Hub, id: u64, socket: &mut WebSocket<TcpStream>) -> Result<(), Error> {
    loop {
        let (frames, last) = hub.frames(id);
        for frame in frames {
            socket.write(frame)?;
        }
        socket.flush()?;
        if last {
            return part(socket);
        }
        match socket.read() {
            Ok(frame) => hub.answer(id, &frame),
            Err(error) if is_silence(&error) => {}
            Err(error) => return Err(error),
        }
    }
}

/// Says farewell, and waits for the client's: a connection that is cut while something is on its way may lose it.
fn part(socket: &mut WebSocket<TcpStream>) -> Result<(), Error> {
    let began = WallInstant::now();
    socket.close(None)?;
    while began.elapsed() < FAREWELL {
        match socket.read() {
            Ok(_) => {}
            Err(error) if is_silence(&error) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// Whether there was nothing to read, which is no error.
fn is_silence(error: &Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error, Error::Io(error) if matches!(error.kind(), WouldBlock | TimedOut | Interrupted))
}
