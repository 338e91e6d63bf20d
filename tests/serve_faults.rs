//! `flexsc serve` and clients that do wrong: that read nothing, say nothing, come too early, or command what nothing executes.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream, UdpSocket};
use std::process::{Command as Program, Stdio};
use std::thread;
use std::time::{Duration, Instant as WallInstant};

use crate::control_client::{COMMAND, ControlClient, HELLO, REQUEST, SENSORS, WELCOME, hello, open, packet};
use crate::serve::{ACCELERATION, remote_law, serve};
use crate::serve_clients::c_client;
use crate::util::Dir;

/// Returns the identifier and the content of the next packet of a stream.
fn next_packet(stream: &mut TcpStream) -> (u16, Vec<u8>) {
    let mut bytes = vec![0; 6];
    stream.read_exact(&mut bytes).expect("a header");
    bytes.resize(7 + usize::from(u16::from_be_bytes([bytes[4], bytes[5]])), 0);
    stream.read_exact(&mut bytes[6..]).expect("a packet");
    let (apid, content) = open(&bytes).expect("whole");
    (apid, content.to_vec())
}

#[cfg(unix)]
#[test]
fn a_client_that_reads_nothing_ends_the_run() {
    let dir = Dir::with(&["earth-observer"]);
    let served = "earth-observer.toml --tcp --timeout 1 --set duration=300 -o run.mcap";
    for interrupts in [false, true] {
        let (server, _, address) = serve(&dir, &format!("{served} --force"));
        let mut stream = TcpStream::connect(&address).expect("connected");
        stream.write_all(&packet(HELLO, 0, &hello(7, 1, 0))).expect("sent");
        let (apid, welcome) = next_packet(&mut stream);
        assert_eq!(apid, WELCOME);
        let mut command = welcome[..4].to_vec();
        command.extend(0_u64.to_be_bytes());
        command.extend([ACCELERATION; 3]);
        command.extend([0; 24]);
        stream.write_all(&packet(COMMAND, 0, &command)).expect("sent");
        // Each of these is answered with the layout, until the server's buffer is full.
        let hellos: Vec<u8> = (1..200).flat_map(|count| packet(HELLO, count, &hello(7, 1, 0))).collect();
        stream.set_write_timeout(Some(Duration::from_millis(200))).expect("set");
        while stream.write_all(&hellos).is_ok() {}
        let began = WallInstant::now();
        if interrupts {
            server.sends("INT");
        }
        let ran = server.wait();
        assert!(began.elapsed() < Duration::from_secs(8), "{:?}", began.elapsed());
        let ran = if interrupts { ran.exits(130) } else { ran.exits(1) };
        ran.says(&["run.mcap holds the run up to that time"]);
        assert!(dir.has("run.mcap") && !dir.has("run.mcap.partial"));
    }
}

#[test]
fn connections_without_a_hello_do_not_hold_the_place() {
    let dir = Dir::with(&["earth-observer"]);
    let (server, transport, address) = serve(&dir, "earth-observer.toml --tcp --set duration=2 --log none");
    let silent: Vec<TcpStream> = (0..3).map(|_| TcpStream::connect(&address).expect("connected")).collect();
    let mut babbling = TcpStream::connect(&address).expect("connected");
    babbling.write_all(&packet(COMMAND, 0, &[0; 39])).expect("sent");
    thread::sleep(Duration::from_millis(100));
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)));
    server.wait().exits(0);
    drop((silent, babbling));
}

#[test]
fn a_run_begins_with_the_first_command() {
    let dir = Dir::with(&["earth-observer"]);
    let served = "earth-observer.toml --set duration=2 --log none";
    // The hello of an old client, whose sender does not answer.
    let (server, transport, address) = serve(&dir, &format!("{served} --timeout 2"));
    let old = UdpSocket::bind("127.0.0.1:0").expect("a port");
    old.send_to(&packet(HELLO, 0, &hello(7, 1, 0)), &address).expect("sent");
    thread::sleep(Duration::from_millis(1300));
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)));
    server.wait().exits(0);
    // Clients that end, or are silent, before their first command.
    for options in ["--tcp", "--tcp --pace step", "--udp --timeout 0.3", "--udp --timeout 0.3 --pace step"] {
        let (server, transport, address) = serve(&dir, &format!("{served} {options}"));
        drop(ControlClient::connect(&transport, &address).expect("a welcome"));
        thread::sleep(Duration::from_millis(600));
        let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
        assert_eq!(client.control(u64::MAX, ACCELERATION, remote_law), Ok(Some(0)), "{options}");
        server.wait().exits(0);
    }
}

#[test]
fn a_command_that_no_actuator_executes_is_refused() {
    let dir = Dir::with(&["earth-observer", "magnetic-unloading"]);
    let moment = 3;
    let (server, transport, address) = serve(&dir, "earth-observer.toml --set duration=9 --log none");
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    let why = client.control(u64::MAX, moment, |_| vec![50.0; 3]).expect_err("refused");
    assert_eq!(why, "the command about axis 1 has the quantity moment, which no actuator in use executes");
    server.wait().exits(1).says(&[&why]);
    // Magnetorquers that unload wheels execute it.
    let (server, transport, address) = serve(&dir, "magnetic-unloading.toml --set duration=9 --log none");
    let mut client = ControlClient::connect(&transport, &address).expect("a welcome");
    assert_eq!(client.control(u64::MAX, moment, |_| vec![0.1; 3]), Ok(Some(0)));
    server.wait().exits(0);
}

#[test]
fn the_client_in_c_survives_a_server_that_has_gone() {
    let dir = Dir::new();
    let Some(program) = c_client(&dir) else { return };
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("bound").port().to_string();
    let server = thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("a client");
        let (apid, greeting) = next_packet(&mut stream);
        assert_eq!(apid, HELLO);
        // Session, nonce, version, layout and the pace of a client that requests each cycle.
        let mut welcome = [&9_u32.to_be_bytes()[..], &greeting[4..8], &[0, 1], &[0; 8], &[2]].concat();
        welcome.extend(
            b"flexsc-lockstep 1 axes 3 period 0 250000000000000\nsession u32 - -\ncycle u64 - -\n\
              time_s i64 - s\ntime_fs i64 - fs\nestimate.error f64 x,y,z rad\n",
        );
        stream.write_all(&packet(WELCOME, 0, &welcome)).expect("sent");
        assert_eq!(next_packet(&mut stream).0, REQUEST);
        let sensors = [&9_u32.to_be_bytes()[..], &[0; 48]].concat();
        stream.write_all(&packet(SENSORS, 0, &sensors)).expect("sent");
        // The client sends its command, and then its next request, into a connection that has ended.
    });
    let mut client = Program::new(&program);
    client.args(["127.0.0.1", &port, "tcp"]).stdout(Stdio::null()).stderr(Stdio::piped());
    let ran = client.output().expect("the client starts");
    server.join().expect("served");
    let why = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.code() == Some(1) && why.contains("the server has"), "{:?} {why}", ran.status);
}
