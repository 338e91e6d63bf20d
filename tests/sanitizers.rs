//! C code under sanitizers of addresses and of undefined behaviour: the client of `flexsc serve`, against servers that keep to the
//! packets and servers that do not, and exported control systems.

use std::io::Write as _;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use flexsc_core::numerics::random::{Seed, Stream};

use crate::control_client::{COMMAND, END, REFUSAL, SENSORS, WELCOME, packet};
use crate::serve::serve;
use crate::util::Dir;

/// Options of a compiler for the sanitizers: the first fault ends the program.
const SANITIZERS: &str = "-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all";
/// Sessions with servers that do not keep to the packets.
const SESSIONS: u32 = 120;
/// Time limit of a session.
const PATIENCE: Duration = Duration::from_secs(30);

/// Compiles the client of C with sanitizers; `None` on a machine without them, which is reported.
fn client(dir: &Dir) -> Option<PathBuf> {
    if !has_sanitizers(dir) {
        return None;
    }
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../clients/c");
    let program = dir.path("attitude_law");
    let mut compiler = Command::new("cc");
    compiler.args(["-std=c99", "-ffp-contract=off"]).args(SANITIZERS.split(' ')).arg("-o").arg(&program);
    compiler.args(["attitude_law.c", "flexsc_lockstep.c"].map(|name| sources.join(name))).arg("-lm");
    let done = compiler.output().expect("cc starts");
    assert!(done.status.success(), "{}", text(&done));
    Some(program)
}

/// True if programs with sanitizers can be compiled and run; else it says aloud what is skipped.
fn has_sanitizers(dir: &Dir) -> bool {
    dir.write("nothing.c", "int main(void) { return 0; }\n");
    let program = dir.path("nothing");
    let compiled = Command::new("cc")
        .args(SANITIZERS.split(' '))
        .arg("-o")
        .arg(&program)
        .arg(dir.path("nothing.c"))
        .output()
        .is_ok_and(|done| done.status.success());
    let runs = compiled && Command::new(&program).status().is_ok_and(|status| status.success());
    if !runs {
        eprintln!("skipped: `cc` has no sanitizers on this machine");
    }
    runs
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

#[test]
fn the_client_in_c_has_no_fault_in_a_run() {
    let dir = Dir::with(&["earth-observer"]);
    let Some(program) = client(&dir) else { return };
    for transport in ["udp", "tcp"] {
        let (server, _, address) =
            serve(&dir, &format!("earth-observer.toml --{transport} --set duration=20 --log none"));
        let (host, port) = address.split_once(':').expect("a port");
        let done = Command::new(&program).args([host, port, transport]).output().expect("the client starts");
        assert_eq!(text(&done), "80 cycles, complete\n");
        server.wait().exits(0);
    }
}

/// Returns a text of a layout: that of a server with something else in it.
fn layout(random: &mut Stream) -> Vec<u8> {
    let right = "flexsc-lockstep 1 axes 3 period 0 250000000000000\nsession u32 - -\ncycle u64 - -\ntime_s i64 - s\n\
                 time_fs i64 - fs\nestimate.error f64 x,y,z -\nestimate.rate f64 x,y,z rad/s\n";
    let mut lines: Vec<String> = right.lines().map(str::to_owned).collect();
    let place = 1 + random.index(lines.len() - 1);
    let long = [1, 15, 16, 17, 62, 63, 64, 65, 1000, 50_000][random.index(10)];
    match random.index(12) {
        0 => lines.truncate(place),
        1 => lines[place] = format!("{} f64 - -", "a".repeat(long)),
        2 => lines[place] = format!("n f64 {} -", vec!["x"; long].join(",")),
        3 => {
            lines[place] =
                format!("n {} - {}", ["f64", "u8", "zzz", "ffffffff"][random.index(4)], "u".repeat(long));
        }
        4 => lines[place] = String::new(),
        5 => lines.extend(vec!["a u8 - -".to_owned(); [1, 505, 506, 507, 6000][random.index(5)]]),
        6 => {
            let axes = ["0", "-1", "2", "4", "2147483648", "9223372036854775808", "x"][random.index(7)];
            lines[0] = format!(
                "flexsc-lockstep 1 axes {axes} period 0 {}",
                ["-1", "0", "99999999999999999999"][random.index(3)]
            );
        }
        7 => return Vec::new(),
        8 => return right.trim_end().as_bytes().to_vec(),
        9 => {
            let mut bytes = right.as_bytes().to_vec();
            for _ in 0..10 {
                let place = random.index(bytes.len());
                bytes[place] = 1 + random.index(255) as u8;
            }
            return bytes;
        }
        _ => {}
    }
    (lines.join("\n") + "\n").into_bytes()
}

/// Returns packets of a server that does not keep to them, for a hello with this nonce.
fn lies(nonce: [u8; 4], random: &mut Stream) -> Vec<Vec<u8>> {
    let noise = |length: usize, random: &mut Stream| -> Vec<u8> {
        (0..length).map(|_| random.index(256) as u8).collect()
    };
    let session = [0, 0, 0, 7];
    let pace = [0, 0, 1, 2, 255][random.index(5)];
    let layout = layout(random);
    let mut content = [&session[..], &nonce, &[0, 1], &noise(8, random), &[pace]].concat();
    content.extend(layout);
    content.truncate([content.len(), content.len(), content.len(), 18, 19, 4][random.index(6)].min(59_000));
    let mut packets = vec![packet(WELCOME, 0, &content)];
    for cycle in 0..random.index(12) as u64 {
        // Most are those of the right layout.
        let length = [64, 64, 64, 64, 64, 64, 0, 4, 12, 63, 65, 28, 29, 76, 500, 59_000][random.index(16)];
        let mut body = [&session[..], &cycle.to_be_bytes()].concat();
        body.extend(noise(length, random));
        packets.push(match random.index(20) {
            0 => packet(REFUSAL, 0, &noise(length % 300, random)),
            1 => packet(WELCOME, 0, &body),
            2 => packet(END, 0, &body[..body.len().min(29)]),
            3 => packet(COMMAND, 0, &body),
            4 => noise(length, random),
            5 => packet(SENSORS, 0, &body[..length.min(body.len())]),
            _ => packet(SENSORS, 0, &body),
        });
    }
    packets
}

#[test]
fn the_client_in_c_has_no_fault_with_lying_servers() {
    let dir = Dir::new();
    let Some(program) = client(&dir) else { return };
    let mut random = Seed { scenario: 58, run: 0 }.stream("lies");
    for session in 0..SESSIONS {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let port = listener.local_addr().expect("an address").port().to_string();
        let client = Command::new(&program)
            .args(["127.0.0.1", &port, "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the client starts");
        let (mut stream, _) = listener.accept().expect("a client");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        let mut hello = [0; 26];
        std::io::Read::read_exact(&mut stream, &mut hello).expect("a hello");
        for packet in lies([hello[10], hello[11], hello[12], hello[13]], &mut random) {
            // A client that has ended takes no more.
            let _ = stream.write_all(&packet);
        }
        let _ = stream.shutdown(std::net::Shutdown::Write);
        let began = Instant::now();
        let done = client.wait_with_output().expect("waited for");
        assert!(began.elapsed() < PATIENCE, "session {session}: the client does not end");
        let said = text(&done);
        assert!(!said.contains("Sanitizer") && !said.contains("runtime error"), "session {session}: {said}");
        assert!(
            done.status.code().is_some_and(|code| code <= 1),
            "session {session}: {:?} {said}",
            done.status
        );
    }
}

#[test]
#[cfg(feature = "flight-code")]
fn exported_control_systems_have_no_fault() {
    use crate::flight_exports::{exported, hashes, is_installed, make};

    /// Cycles of the self-test, whose hash an export has.
    const CYCLES: u64 = 20_000;

    if !is_installed("make") || !has_sanitizers(&Dir::new()) {
        return;
    }
    for name in ["earth-observer", "safe-mode --mode detumble", "iss-ringdown"] {
        let dir = exported(name);
        let built = make(
            &dir,
            "out",
            &["driver", "CC=cc", &format!("CFLAGS={SANITIZERS} -fsanitize=float-cast-overflow")],
        );
        assert!(built.status.success(), "{name}: {}", text(&built));
        let driver = |arguments: &[&str]| {
            let done =
                Command::new(dir.path("out/driver")).args(arguments).current_dir(dir.path("out")).output();
            let done = done.expect("the driver starts");
            assert!(done.status.success(), "{name}: {}", text(&done));
            text(&done)
        };
        assert!(driver(&["vectors.bin"]).contains(" calls equal"), "{name}");
        assert_eq!(driver(&["--hash", &CYCLES.to_string()]).trim(), hashes(&dir, "out")[&CYCLES], "{name}");
    }
}
