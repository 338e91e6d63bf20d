//! Connection of a client of a live run, on a thread of its own.

use std::collections::VecDeque;
use std::net::TcpStream;
use std::time::{Duration, Instant as WallInstant};

use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{CloseFrame, WebSocketConfig};
use tungstenite::{Error, WebSocket};

use super::access::AccessControl;
use super::connection::{Connection, would_block};
use super::hub::{ClientSlot, Hub, MOST_CLIENTS};
use super::outbox::OutgoingFrame;
use super::protocol::SUBPROTOCOLS;

const SUBPROTOCOL: &str = "sec-websocket-protocol";
/// Time limit for a client's request, and for its closing handshake.
const GREETING: Duration = Duration::from_secs(5);
const FAREWELL: Duration = Duration::from_secs(1);
/// Largest message of a client (bytes): clients send only requests.
const LARGEST: usize = 64 << 10;

/// Accepts a client, and returns its connection and its seat.
pub fn greet(
    hub: &Hub,
    gate: &AccessControl,
    stream: TcpStream,
) -> Option<(WebSocket<Connection>, ClientSlot)> {
    let wire = Connection::new(stream, GREETING).ok()?;
    let config = WebSocketConfig::default().max_message_size(Some(LARGEST)).max_frame_size(Some(LARGEST));
    let mut seat = None;
    #[expect(clippy::result_large_err, reason = "the signature is the library's")]
    let agree = |request: &Request, response| agree(hub, gate, &mut seat, request, response);
    let mut socket = tungstenite::accept_hdr_with_config(wire, agree, Some(config)).ok()?;
    socket.get_mut().greeted().ok()?;
    Some((socket, seat?))
}

/// Agrees with a client on the protocol if it may connect and a seat is free.
#[expect(clippy::result_large_err, reason = "the signature is the library's")]
fn agree(
    hub: &Hub,
    gate: &AccessControl,
    seat: &mut Option<ClientSlot>,
    request: &Request,
    mut response: Response,
) -> Result<Response, ErrorResponse> {
    let refuse = |status: StatusCode, why: String| {
        let mut response = ErrorResponse::new(Some(why));
        *response.status_mut() = status;
        Err(response)
    };
    if let Err(why) = gate.admit(request.headers()) {
        return refuse(StatusCode::FORBIDDEN, why);
    }
    let requested = request.headers().get_all(SUBPROTOCOL).iter().filter_map(|value| value.to_str().ok());
    let requested: Vec<&str> = requested.flat_map(|names| names.split(',')).map(str::trim).collect();
    let Some(name) = SUBPROTOCOLS.into_iter().find(|name| requested.contains(name)) else {
        return refuse(
            StatusCode::BAD_REQUEST,
            format!("ask for the subprotocol {}", SUBPROTOCOLS.join(" or ")),
        );
    };
    *seat = hub.seat();
    if seat.is_none() {
        return refuse(
            StatusCode::SERVICE_UNAVAILABLE,
            format!("there are {MOST_CLIENTS} viewers already, and no more may connect"),
        );
    }
    response.headers_mut().insert(SUBPROTOCOL, HeaderValue::from_static(name));
    Ok(response)
}

/// Serves a client until it disconnects or is disconnected.
pub fn serve(hub: &Hub, mut socket: WebSocket<Connection>) {
    let id = hub.join();
    // A broken connection is a client that has disconnected.
    let _ = converse(hub, id, &mut socket);
    hub.leave(id);
}

fn converse(hub: &Hub, id: u64, socket: &mut WebSocket<Connection>) -> Result<(), Error> {
    let mut frames = VecDeque::new();
    let mut last = false;
    loop {
        if frames.is_empty() {
            let Some(next) = hub.frames(id) else { return Ok(()) };
            (frames, last) = next;
        }
        match send(socket, &mut frames) {
            Ok(()) => socket.get_mut().all_sent(),
            Err(Error::Io(error)) if would_block(&error) => {
                // A client that does not read what it was sent may not send requests, which would grow without limit.
                socket.get_mut().wait()?;
                continue;
            }
            Err(error) => return Err(error),
        }
        if last {
            return part(socket, None);
        }
        match socket.read() {
            Ok(frame) => hub.answer(id, &frame),
            Err(Error::Io(error)) if would_block(&error) => {}
            Err(Error::Capacity(_)) => {
                let reason = format!("no message may have more than {LARGEST} bytes").into();
                return part(socket, Some(CloseFrame { code: CloseCode::Size, reason }));
            }
            Err(error) => return Err(error),
        }
    }
}

/// Sends frames; frames that were not sent stay in the queue.
fn send(socket: &mut WebSocket<Connection>, frames: &mut VecDeque<OutgoingFrame>) -> Result<(), Error> {
    // Flushed first, since the connection's own buffer would grow without limit.
    socket.flush()?;
    // A frame is buffered even if the connection cannot send it now.
    while let Some(frame) = frames.pop_front() {
        socket.write(frame)?;
    }
    socket.flush()
}

/// Closes the connection and waits for the client, since a connection that is cut may lose data in transit.
fn part(socket: &mut WebSocket<Connection>, why: Option<CloseFrame>) -> Result<(), Error> {
    let began = WallInstant::now();
    let silent = |result: Result<(), Error>| match result {
        Err(Error::Io(error)) if would_block(&error) => Ok(()),
        result => result,
    };
    silent(socket.close(why))?;
    while began.elapsed() < FAREWELL {
        silent(socket.read().map(drop))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use tungstenite::protocol::Role;

    use super::*;

    #[test]
    fn a_client_that_takes_nothing_is_handed_no_more() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let _silent = TcpStream::connect(listener.local_addr().expect("bound")).expect("connected");
        let mut wire = Connection::new(listener.accept().expect("a client").0, GREETING).expect("set");
        wire.greeted().expect("set");
        let mut socket = WebSocket::from_raw_socket(wire, Role::Server, None);
        // More data than the system buffers between server and client.
        let mut frames: VecDeque<_> = (0..256).map(|_| OutgoingFrame::binary(vec![0; 1 << 16])).collect();
        let is_full = |sent: Result<(), Error>| matches!(sent, Err(Error::Io(error)) if would_block(&error));
        assert!(is_full(send(&mut socket, &mut frames)));
        let frame_count = frames.len();
        for _ in 0..3 {
            assert!(is_full(send(&mut socket, &mut frames)));
        }
        assert!(
            frame_count > 0 && frames.len() == frame_count,
            "{} of {frame_count} frames left",
            frames.len()
        );
    }
}
