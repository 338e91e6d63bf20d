//! Rights and limits of viewers of a live run.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use serde_json::json;
use tungstenite::Message;

use crate::util::{Dir, Started};
use crate::viewer::{PATIENCE, Said, Viewer, connect_with};

const PROTOCOL: (&str, &str) = ("Sec-WebSocket-Protocol", "foxglove.sdk.v1");
/// Longest time for which a viewer that reads nothing holds a run, as in `docs/live.md`.
const HELD: Duration = Duration::from_secs(10);

/// Starts a run that lasts as long as a test, and returns the address where it is served.
fn endless(dir: &Dir, options: &str) -> (Started, String) {
    let set = "--log none --set duration=1e7 --set log.period=0.01 --live=127.0.0.1:0";
    let mut run = dir.start(&format!("simulate relay-fixed.toml {set} {options}"));
    let line = run.line("ws://");
    let address = line.split("ws://").nth(1).and_then(|rest| rest.split(',').next()).expect("an address");
    (run, address.to_owned())
}

#[cfg(unix)]
#[test]
fn pages_connect_from_known_origins_and_to_this_host_only() {
    let dir = Dir::with(&["relay-fixed"]);
    let (mut run, address) = endless(&dir, "--speed 1 --allow-origin https://viewer.example");
    let port = address.rsplit(':').next().expect("a port").to_owned();
    let own = format!("localhost:{port}");
    let with = |headers: &[(&'static str, &str)]| {
        let all: Vec<_> = [PROTOCOL].into_iter().chain(headers.iter().copied()).collect();
        connect_with(&address, &all).map(drop)
    };
    let local = format!("http://localhost:{port}");
    for origin in [
        "https://app.foxglove.dev",
        "https://studio.foxglove.dev",
        "https://lichtblick-suite.github.io",
        "https://viewer.example",
        "http://127.0.0.1:8080",
        "http://[::1]:8080",
        "file://",
        local.as_str(),
    ] {
        assert_eq!(with(&[("Origin", origin)]), Ok(()), "{origin}");
    }
    assert_eq!(with(&[]), Ok(()), "no page");
    assert_eq!(with(&[("Host", &own)]), Ok(()));
    for origin in
        ["https://evil.example", "null", "https://viewer.example.evil.example", "http://192.168.0.9"]
    {
        let (status, why) = with(&[("Origin", origin)]).expect_err(origin);
        assert_eq!(status, 403, "{origin}");
        assert!(why.contains(origin) && why.contains("--allow-origin"), "{why}");
    }
    // A host name that another party has pointed here, whatever origin the page claims.
    for origin in [&[][..], &[("Origin", "https://app.foxglove.dev")]] {
        let headers: Vec<_> =
            [("Host", "evil.example:8765")].into_iter().chain(origin.iter().copied()).collect();
        let (status, why) = with(&headers).expect_err("a stranger");
        assert_eq!(status, 403);
        assert!(why.contains("this server is not `evil.example:8765`"), "{why}");
    }
    run.line("refused a page of https://evil.example; --allow-origin lets it in");
    run.signal("INT").exits(130);
}

#[cfg(unix)]
#[test]
fn a_silent_viewer_holds_the_run_for_ten_seconds_at_most() {
    let dir = Dir::with(&["relay-fixed"]);
    let (run, address) = endless(&dir, "--speed max");
    let mut silent = Viewer::connect(&address);
    let mut viewer = Viewer::connect(&address);
    viewer.subscribe(&["/attitude"]);
    viewer.row("/attitude");
    silent.subscribe(&[]);
    // The other viewer measures how long the run stands still.
    let (began, mut last, mut longest) = (Instant::now(), Instant::now(), Duration::ZERO);
    while longest < HELD / 2 {
        assert!(began.elapsed() < 6 * HELD, "the run was never held");
        match viewer.next(PATIENCE) {
            Said::Nothing | Said::Farewell => panic!("the run stands still after {:?}", began.elapsed()),
            _ => {
                longest = longest.max(last.elapsed());
                last = Instant::now();
            }
        }
    }
    assert!(longest > Duration::from_secs(9) && longest < HELD + Duration::from_secs(2), "{longest:?}");
    // The viewer was disconnected, and the rest of what it had not read is all that it gets.
    silent.socket.get_ref().set_read_timeout(Some(PATIENCE)).expect("set");
    let gone = std::iter::from_fn(|| Some(silent.socket.read())).find_map(Result::err).expect("an end");
    assert!(
        !matches!(&gone, tungstenite::Error::Io(error) if error.kind() == std::io::ErrorKind::WouldBlock)
    );
    run.signal("INT").exits(130);
}

#[cfg(unix)]
#[test]
fn there_are_sixteen_viewers_at_most() {
    let dir = Dir::with(&["relay-fixed"]);
    let (run, address) = endless(&dir, "--speed 1");
    let mut viewers: Vec<Viewer> = (0..16).map(|_| Viewer::connect(&address)).collect();
    let (status, why) = connect_with(&address, &[PROTOCOL]).map(drop).expect_err("one too many");
    assert_eq!((status, why.as_str()), (503, "there are 16 viewers already, and no more may connect"));
    viewers.pop();
    let began = Instant::now();
    while connect_with(&address, &[PROTOCOL]).is_err() {
        assert!(began.elapsed() < PATIENCE, "the place is not free again");
        std::thread::sleep(Duration::from_millis(20));
    }
    run.signal("INT").exits(130);
}

#[cfg(unix)]
#[test]
fn who_does_not_say_what_it_wants_keeps_nobody_out() {
    let dir = Dir::with(&["relay-fixed"]);
    let (run, address) = endless(&dir, "--speed 1");
    let mut idle: Vec<TcpStream> =
        (0..24).map(|_| TcpStream::connect(&address).expect("a listener")).collect();
    // One of them says a little now and then, which takes no longer.
    let mut slow = idle.pop().expect("a connection");
    let dripping = std::thread::spawn(move || {
        let began = Instant::now();
        while slow.write_all(b"G").is_ok() && began.elapsed() < 4 * HELD {
            std::thread::sleep(Duration::from_millis(300));
        }
        began.elapsed()
    });
    let began = Instant::now();
    Viewer::connect(&address);
    // None waits for another one.
    assert!(began.elapsed() < Duration::from_secs(3), "{:?}", began.elapsed());
    let crowd: Vec<TcpStream> = (0..300).map(|_| TcpStream::connect(&address).expect("a listener")).collect();
    let began = Instant::now();
    Viewer::connect(&address);
    assert!(began.elapsed() < Duration::from_secs(3), "{:?}", began.elapsed());
    drop(crowd);
    assert!(dripping.join().expect("ended") < Duration::from_secs(16));
    for mut stream in idle {
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        assert_eq!(stream.read(&mut [0; 1]).unwrap_or(0), 0, "it is cut off");
    }
    run.signal("INT").exits(130);
}

#[cfg(unix)]
#[test]
fn requests_have_limits() {
    let dir = Dir::with(&["relay-fixed"]);
    let (run, address) = endless(&dir, "--speed 1");
    let mut viewer = Viewer::connect(&address);
    let pairs: Vec<_> = (0..257).map(|id| json!({"id": id, "channelId": 1})).collect();
    viewer.ask(&json!({"op": "subscribe", "subscriptions": pairs}));
    assert_eq!(viewer.text("status")["message"], "a request may name at most 256 things");
    // One subscription to a channel, however often it is asked for.
    let pairs: Vec<_> = (0..256).map(|id| json!({"id": id, "channelId": 1})).collect();
    viewer.ask(&json!({"op": "subscribe", "subscriptions": pairs}));
    assert_eq!(viewer.text("status")["message"], "channel 1 is subscribed to already");
    viewer.ask(&json!({"op": "what", "why": "?".repeat(60_000)}));
    viewer.ask(&json!(["?".repeat(60_000)]));
    let status = loop {
        let status = viewer.text("status");
        if !status["message"].as_str().expect("a text").contains("already") {
            break status;
        }
    };
    let reported = status["message"].as_str().expect("a text");
    assert!(reported.starts_with("not understood: ") && reported.len() < 300, "{} bytes", reported.len());
    let mut large = Viewer::connect(&address);
    large.socket.send(Message::text(" ".repeat((64 << 10) + 1))).expect("sent");
    loop {
        match large.socket.read() {
            Ok(Message::Close(Some(frame))) => {
                assert_eq!(frame.reason.as_str(), "no message may have more than 65536 bytes");
                break;
            }
            // The farewell may be lost with what the server did not read.
            Err(error) if !matches!(&error, tungstenite::Error::Io(e) if e.kind() == std::io::ErrorKind::WouldBlock) =>
            {
                break;
            }
            _ => {}
        }
    }
    viewer.subscribe(&["/attitude"]);
    viewer.row("/attitude");
    run.signal("INT").exits(130);
}

#[test]
fn after_the_end_nothing_pauses() {
    let dir = Dir::with(&["relay-fixed"]);
    let mut run = dir
        .start("simulate relay-fixed.toml --log none --set duration=5 --live=127.0.0.1:0 --wait --speed max");
    let (mut viewer, _) = Viewer::open(&mut run);
    viewer.subscribe(&["/metrics"]);
    run.line("the run has ended");
    viewer.ask_for(0);
    let failure = viewer.text("serviceCallFailure");
    assert_eq!(failure["message"], "the run has ended");
    viewer.ask(&json!({"op": "setParameters", "parameters": [{"name": "/paused", "value": true}]}));
    assert_eq!(viewer.text("status")["message"], "the run has ended");
    viewer.ask(&json!({"op": "getParameters", "parameterNames": ["/paused"], "id": "all"}));
    assert_eq!(viewer.text("parameterValues")["parameters"], json!([{"name": "/paused", "value": false}]));
    drop(viewer);
    run.wait().exits(0);
}

#[test]
fn connections_that_are_refused_or_fail_are_closed_at_once() {
    let dir = Dir::with(&["relay-fixed"]);
    let (_run, address) = endless(&dir, "--speed 1");
    let closes = |stream: &mut TcpStream, what: &str| {
        let began = Instant::now();
        stream.set_read_timeout(Some(Duration::from_secs(8))).expect("set");
        let mut rest = Vec::new();
        // A reset is an end, too.
        if let Err(error) = stream.read_to_end(&mut rest) {
            assert_eq!(error.kind(), std::io::ErrorKind::ConnectionReset, "{what}");
        }
        assert!(began.elapsed() < Duration::from_secs(3), "{what}: {:?}", began.elapsed());
    };
    let connected = || TcpStream::connect(&address).expect("connected");
    for request in ["GET / HTTP/1.1\r\nHost: x\r\n\r\n", "nonsense\r\n\r\n"] {
        let mut stream = connected();
        stream.write_all(request.as_bytes()).expect("sent");
        closes(&mut stream, request);
    }
    // Without a mask, with a reserved bit, and with text that is not UTF-8.
    for frame in
        [&[0x81, 2, b'{', b'}'][..], &[0xC1, 0x80, 0, 0, 0, 0], &[0x81, 0x82, 0, 0, 0, 0, 0xFF, 0xFF]]
    {
        let mut stream = connected();
        let key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13";
        let (name, protocol) = PROTOCOL;
        let upgrade = format!("Upgrade: websocket\r\nConnection: Upgrade\r\n{key}\r\n{name}: {protocol}");
        stream
            .write_all(format!("GET / HTTP/1.1\r\nHost: {address}\r\n{upgrade}\r\n\r\n").as_bytes())
            .expect("sent");
        stream.write_all(frame).expect("sent");
        closes(&mut stream, &format!("{frame:?}"));
    }
}
