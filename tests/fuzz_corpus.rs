//! Former findings of the fuzzer: none of them crashes, hangs, exhausts memory or leaves half a file any more.

use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::util::{Dir, FLEXSC};
use crate::viewer::connect;

#[path = "fuzz/src/lockstep_client.rs"]
mod lockstep_client;

use lockstep_client::LockstepClient;

/// Inputs by surface: the command's arguments, and the files in its directory.
const CORPUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fuzz/corpus");
/// Limits of a command: memory (kB), and time while other tests run.
const MEMORY: u64 = 1_000_000;
const TIME: Duration = Duration::from_secs(15);
/// Length above which a message is of no use (bytes).
const LONGEST_MESSAGE: usize = 64 << 10;
/// Time after which a run is stopped that may take as long as its scenario requires.
const ENOUGH: Duration = Duration::from_secs(1);

struct Input {
    name: String,
    arguments: Vec<String>,
    dir: Dir,
}

fn inputs() -> Vec<Input> {
    let within = |path: &Path| -> Vec<PathBuf> {
        let mut paths: Vec<_> =
            fs::read_dir(path).expect("there").map(|entry| entry.expect("readable").path()).collect();
        paths.sort();
        paths
    };
    let surfaces = within(Path::new(CORPUS));
    let inputs = surfaces.iter().flat_map(|surface| within(surface)).map(|path| {
        let arguments = fs::read(path.join("arguments.json")).expect("arguments");
        let dir = Dir::new();
        copy(&path.join("files"), &dir.path(""));
        Input {
            name: path.strip_prefix(CORPUS).expect("within").display().to_string(),
            arguments: serde_json::from_slice(&arguments).expect("strings"),
            dir,
        }
    });
    inputs.collect()
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("made");
    // An input may have no files.
    for entry in fs::read_dir(from).into_iter().flatten().map(|entry| entry.expect("readable")) {
        let to = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &to);
        } else {
            fs::copy(entry.path(), to).expect("copied");
        }
    }
}

/// All files within a directory.
fn files(directory: &Path) -> BTreeSet<PathBuf> {
    let entries = fs::read_dir(directory).expect("there").map(|entry| entry.expect("readable").path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { BTreeSet::from([path]) }).collect()
}

fn start(input: &Input) -> Child {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\""), FLEXSC]).args(&input.arguments);
    command.envs([("RAYON_NUM_THREADS", "2"), ("MALLOC_ARENA_MAX", "2")]).current_dir(input.dir.path(""));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("started")
}

fn interrupt(child: &Child) {
    let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(sent.expect("kill starts").success());
}

/// Waits for the end; commands that may work for long are asked to stop.
fn end(child: &mut Child, name: &str, stops: bool) -> ExitStatus {
    let (began, mut asked) = (Instant::now(), false);
    loop {
        if let Some(status) = child.try_wait().expect("waited for") {
            return status;
        }
        if stops && !asked && began.elapsed() > ENOUGH {
            interrupt(child);
            asked = true;
        }
        if began.elapsed() > TIME {
            child.kill().expect("killed");
            panic!("{name} takes more than {TIME:?}");
        }
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn what_the_fuzzer_found_is_mended() {
    let inputs = inputs();
    assert!(!inputs.is_empty(), "the corpus is gone");
    for input in inputs.iter().filter(|input| !input.dir.has("sent") && !input.dir.has("packets")) {
        let given = files(&input.dir.path(""));
        let mut child = start(input);
        let stops = !["export", "plot", "log", "check", "modes"].contains(&&*input.arguments[0]);
        let mut err = child.stderr.take().expect("piped");
        let said = thread::spawn(move || {
            let mut said = String::new();
            err.read_to_string(&mut said).map(|_| said)
        });
        let status = end(&mut child, &input.name, stops);
        let said = said.join().expect("read").expect("text");
        assert!(said.len() <= LONGEST_MESSAGE, "{}: messages of {} bytes", input.name, said.len());
        // Analyses that make no files end by the signal itself.
        let code = status.code().unwrap_or(if stops { 130 } else { -1 });
        assert!([0, 1, 2, 3, 130].contains(&code), "{}: {status}\n{said}", input.name);
        assert!(code == 0 || code == 130 || said.contains("error"), "{}: {status}\n{said}", input.name);
        let left = files(&input.dir.path(""));
        assert!(code != 2 || left == given, "{}: {status}, but there are {left:?}", input.name);
    }
}

#[test]
fn what_the_fuzzer_sent_to_a_live_run_is_survived() {
    for input in inputs().iter().filter(|input| input.dir.has("sent")) {
        let mut child = start(input);
        let mut err = BufReader::new(child.stderr.take().expect("piped"));
        let mut line = String::new();
        while !line.contains("ws://") {
            line.clear();
            assert!(err.read_line(&mut line).expect("text") > 0, "{}: it is not served", input.name);
        }
        let address = line.split("ws://").nth(1).and_then(|rest| rest.split(',').next()).expect("an address");
        let mut stream = TcpStream::connect(address).expect("a connection");
        let _ = stream.set_read_timeout(Some(Duration::from_millis(50)));
        // It may be cut off.
        let _ = stream.write_all(&input.dir.read("sent"));
        let _ = stream.read(&mut [0; 4096]);
        drop(stream);
        let began = Instant::now();
        while connect(address, "foxglove.sdk.v1").is_none() {
            assert!(child.try_wait().expect("waited for").is_none(), "{}: the run has ended", input.name);
            assert!(began.elapsed() < TIME, "{}: nobody is served", input.name);
        }
        interrupt(&child);
        assert_eq!(end(&mut child, &input.name, true).code(), Some(130), "{}", input.name);
    }
}

#[test]
fn a_run_in_lockstep_survives_the_packets_of_the_fuzzer() {
    for input in inputs().iter().filter(|input| input.dir.has("packets")) {
        let mut child = start(input);
        let mut err = BufReader::new(child.stderr.take().expect("piped"));
        let mut line = String::new();
        while !line.starts_with("  serve ") {
            line.clear();
            assert!(err.read_line(&mut line).expect("text") > 0, "{}: it is not served", input.name);
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        let (transport, address) = (words[1], words[2].trim_end_matches(','));
        let has_ended = AtomicBool::new(false);
        let script = input.dir.text("packets");
        let status = thread::scope(|scope| {
            scope.spawn(|| LockstepClient::new(transport, address).control(&script, &has_ended));
            // Messages that are not read would stop the run.
            scope.spawn(|| err.read_to_string(&mut String::new()));
            let status = end(&mut child, &input.name, false);
            has_ended.store(true, Ordering::Relaxed);
            status
        });
        assert!(status.code().is_some_and(|code| code <= 3), "{}: {status}", input.name);
    }
}
