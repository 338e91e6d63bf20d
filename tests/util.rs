//! Helpers for tests of the command: a directory of its own, the command run in it, and its output.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value as Json;
use tempfile::TempDir;

pub const FLEXSC: &str = env!("CARGO_BIN_EXE_flexsc");

/// Time limit of a command, so that one that waits for ever fails its test.
const LONGEST_RUN: Duration = Duration::from_secs(300);

/// A short scenario with an uncertain gain and rate.
pub const UNCERTAIN: &str = r#"seed = 7
duration = 800.0

[body.planar]
angle = 4.5e-4
rate = 2.2e-5

[[body.planar.modes]]
frequency = 0.44
gain = 0.0213
displacement = 2.75e-6

[law.relay]
dead_zone = 5e-4
hysteresis = 1e-4
strong = 4e-5
weak = 1e-6
k_t = 0.31

[estimator.envelope]
window = 100.0

[uncertain]
"law.relay.k_t" = { uniform = [0.3, 0.32] }
"body.planar.rate" = { relative_normal = 0.1 }
"#;

/// The scenarios that are shipped.
pub const SCENARIOS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios");

/// A directory in which the command runs.
pub struct Dir(TempDir);

impl Dir {
    /// An empty directory.
    pub fn new() -> Self {
        Self(TempDir::new().expect("a temporary directory"))
    }

    /// A directory with some of the shipped scenarios.
    pub fn with(shipped: &[&str]) -> Self {
        let dir = Self::new();
        for name in shipped {
            let name = format!("{name}.toml");
            fs::copy(format!("{SCENARIOS}/{name}"), dir.path(&name)).expect("shipped");
        }
        dir
    }

    /// A directory with one file.
    pub fn holding(name: &str, bytes: impl AsRef<[u8]>) -> Self {
        let dir = Self::new();
        dir.write(name, bytes);
        dir
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).expect("written");
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).expect("UTF-8")
    }

    pub fn has(&self, name: &str) -> bool {
        self.path(name).symlink_metadata().is_ok()
    }

    /// Returns the length of a file in bytes.
    pub fn size(&self, name: &str) -> u64 {
        fs::metadata(self.path(name)).map_or(0, |file| file.len())
    }

    /// Returns the names in a subdirectory, sorted; empty if it does not exist.
    pub fn names(&self, within: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(within)).into_iter().flatten().flatten();
        let mut names: Vec<_> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs the command; its arguments are parted by blanks.
    pub fn run(&self, arguments: &str) -> Ran {
        self.start(arguments).wait()
    }

    /// Runs the command with 1.5 GB of memory and 10 s of time, beyond which it is killed.
    #[cfg(target_os = "linux")]
    pub fn run_bounded(&self, arguments: &str) -> Ran {
        let mut command = Command::new("sh");
        command.args(["-c", "ulimit -v 1500000; exec timeout -s KILL 10 \"$0\" \"$@\"", FLEXSC]);
        command.args(arguments.split_whitespace()).current_dir(self.0.path()).stdin(Stdio::null());
        Ran::new(arguments, command.output().expect("the command starts"))
    }

    /// Starts the command.
    pub fn start(&self, arguments: &str) -> Started {
        Self::started(self.command(arguments), arguments)
    }

    /// Starts the command while signals such as `INT HUP` are ignored.
    #[cfg(unix)]
    pub fn start_ignoring(&self, signals: &str, arguments: &str) -> Started {
        self.start_by(&format!("trap '' {signals}"), arguments)
    }

    /// Starts the command after another command of a shell, such as a limit.
    #[cfg(unix)]
    pub fn start_by(&self, before: &str, arguments: &str) -> Started {
        let mut command = Command::new("sh");
        command.args(["-c", &format!("{before}; exec \"$0\" \"$@\""), FLEXSC]);
        command.args(arguments.split_whitespace()).current_dir(self.0.path());
        Self::started(command, arguments)
    }

    /// Runs the command with a limit of `blocks` blocks of 512 or 1024 bytes for every file: like a full disk.
    #[cfg(unix)]
    pub fn run_within(&self, blocks: u32, arguments: &str) -> Ran {
        let mut command = Command::new("sh");
        command.args(["-c", &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\""), FLEXSC]);
        command.args(arguments.split_whitespace()).current_dir(self.0.path());
        Self::started(command, arguments).wait()
    }

    fn started(mut command: Command, arguments: &str) -> Started {
        let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        Started { child: Some(child.expect("the command starts")), arguments: arguments.to_owned() }
    }

    /// Waits until a file has `bytes` bytes.
    pub fn wait_for(&self, name: &str, bytes: u64) {
        let began = Instant::now();
        while self.size(name) < bytes {
            assert!(began.elapsed() < Duration::from_secs(30), "{name} does not grow to {bytes} bytes");
            thread::sleep(Duration::from_millis(2));
        }
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(FLEXSC);
        command.args(arguments.split_whitespace()).current_dir(self.0.path());
        command
    }
}

/// Returns the output of a command, and fails if it does not end within a time.
fn finished(child: Child, arguments: &str) -> Output {
    let (id, (sender, receiver)) = (child.id(), mpsc::channel());
    thread::spawn(move || sender.send(child.wait_with_output()));
    let Ok(output) = receiver.recv_timeout(LONGEST_RUN) else {
        let _ = Command::new("kill").args(["-KILL", &id.to_string()]).status();
        panic!("flexsc {arguments}: still there after {LONGEST_RUN:?}");
    };
    output.expect("waited for")
}

/// Running command. It is killed at the end of its test.
pub struct Started {
    child: Option<Child>,
    arguments: String,
}

impl Started {
    /// Returns the next line of stderr that contains a word.
    pub fn line(&mut self, word: &str) -> String {
        use std::io::Read;

        let err = self.child.as_mut().and_then(|child| child.stderr.as_mut()).expect("not yet waited for");
        let (mut line, mut byte) = (Vec::new(), [0]);
        // Byte by byte: what follows is left for the end.
        while err.read(&mut byte).expect("readable") == 1 {
            if byte != *b"\n" {
                line.extend(byte);
                continue;
            }
            let text = String::from_utf8(std::mem::take(&mut line)).expect("UTF-8");
            if text.contains(word) {
                return text;
            }
        }
        panic!("flexsc {}: no line with `{word}`", self.arguments);
    }

    /// Waits for the end.
    pub fn wait(mut self) -> Ran {
        let child = self.child.take().expect("not yet waited for");
        Ran::new(&self.arguments, finished(child, &self.arguments))
    }

    /// Sends a signal, such as `INT`, and waits for the end.
    pub fn signal(self, signal: &str) -> Ran {
        self.sends(signal);
        self.wait()
    }

    /// Returns true if the command has not ended.
    #[cfg(unix)]
    pub fn is_alive(&mut self) -> bool {
        let child = self.child.as_mut().expect("not yet waited for");
        child.try_wait().expect("a child").is_none()
    }

    /// Sends a signal, such as `INT`.
    pub fn sends(&self, signal: &str) {
        let child = self.child.as_ref().expect("not yet waited for");
        let sent = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
        assert!(sent.expect("kill starts").success());
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        if let Some(child) = &mut self.child {
            // It may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Result of a command that has ended.
pub struct Ran {
    /// The exit code; none after a signal.
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
    arguments: String,
}

impl Ran {
    fn new(arguments: &str, output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
        Self {
            code: output.status.code(),
            out: text(output.stdout),
            err: text(output.stderr),
            arguments: arguments.to_owned(),
        }
    }

    /// Checks the exit code.
    #[track_caller]
    pub fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "flexsc {}\n{}", self.arguments, self.err);
        self
    }

    /// Checks that stderr contains these words.
    #[track_caller]
    pub fn says(self, words: &[&str]) -> Self {
        for words in words {
            assert!(self.err.contains(words), "flexsc {}: no `{words}` in\n{}", self.arguments, self.err);
        }
        self
    }

    /// Checks that stdout contains these words, and returns it.
    #[track_caller]
    pub fn prints(self, words: &[&str]) -> String {
        for words in words {
            assert!(self.out.contains(words), "flexsc {}: no `{words}` in\n{}", self.arguments, self.out);
        }
        self.out
    }

    /// Checks that the command succeeded and wrote to stdout, and returns that.
    #[track_caller]
    pub fn printed(self) -> String {
        let ran = self.exits(0);
        assert!(!ran.out.is_empty(), "flexsc {}: nothing on stdout, but\n{}", ran.arguments, ran.err);
        ran.out
    }

    /// Returns stdout as JSON.
    #[track_caller]
    pub fn json(self) -> Json {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error} in\n{}", self.out))
    }
}

/// Returns the end of the run as the file's summary has it.
pub fn end(dir: &Dir, log: &str) -> BTreeMap<String, String> {
    let bytes = dir.read(log);
    let summary = mcap::Summary::read(&bytes).expect("whole").expect("a summary");
    let index = summary.metadata_indexes.iter().find(|m| m.name == "flexsc.end").expect("an end");
    mcap::read::metadata(&bytes, index).expect("whole").metadata
}

/// Returns the rows of a table, each by the names of its columns.
pub fn table(dir: &Dir, name: &str) -> Vec<BTreeMap<String, String>> {
    let bytes = dir.read(name);
    csv::Reader::from_reader(&*bytes).deserialize().map(|row| row.expect("a whole row")).collect()
}

/// Returns true if a file's name has this extension.
pub fn has_extension(name: &str, extension: &str) -> bool {
    Path::new(name).extension().is_some_and(|e| e == extension)
}
