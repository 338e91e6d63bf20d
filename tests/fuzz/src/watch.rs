//! Watching workers: their clock, their memory, and how they end.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::worker::MESSAGES;

/// Limits of a process (kB): memory as `ulimit -v` counts it, and the size of a file.
const MEMORY: u64 = 1_000_000;
const FILE: u64 = 4_000_000;
/// Time limits of an input: of the processor's time, and of elapsed time if the processor is busy.
const TIME: Duration = Duration::from_secs(5);
const WALL: Duration = Duration::from_secs(120);
/// Time after which a command that may take long is stopped, and the time limit of its end.
const ENOUGH: Duration = Duration::from_millis(200);
const GONE: Duration = Duration::from_secs(3);
const LOOK: Duration = Duration::from_millis(20);

/// Message of a worker.
pub enum News {
    /// An input is done: its number, exit code, memory (kB), time, and what is wrong.
    Done { number: u64, code: u8, memory: u64, time: Duration, wrong: Option<String> },
    /// An input ended its process, or was ended, and that is no finding.
    Ended { number: u64 },
    /// An input ended its process: why.
    Broken { number: u64, why: String },
}

/// Beginning of the fault of an input that has not begun: in the fuzzer itself, or between inputs.
pub const BETWEEN: &str = "before it ran: ";
/// Stop method of an input that is being made: none.
const MAKING: &str = "make";

/// The input that runs.
struct Running {
    number: u64,
    stop: String,
    began: Instant,
    /// Processor time of the process at the start of the input.
    used: Duration,
    /// Instant of the request to stop, and the processor time then.
    asked: Option<(Instant, Duration)>,
}

impl Running {
    /// Creates the state of an input that begins now, in a process.
    fn new(number: &str, stop: &str, id: u32) -> Self {
        Self {
            number: number.parse().unwrap_or(0),
            stop: stop.to_owned(),
            began: Instant::now(),
            used: processor(id),
            asked: None,
        }
    }

    /// Returns the message of a broken input.
    fn broken(&self, why: String) -> News {
        let why = if self.stop == MAKING { format!("{BETWEEN}{why}") } else { why };
        News::Broken { number: self.number, why }
    }
}

/// Runs a worker with these arguments in a directory until it ends or the deadline comes, and passes on its messages.
pub fn watch(
    arguments: &[String],
    directory: &Path,
    deadline: Instant,
    mut report: impl FnMut(News),
) -> io::Result<()> {
    let _ = fs::remove_dir_all(directory);
    fs::create_dir_all(directory)?;
    let (ours, theirs) = UnixStream::pair()?;
    let messages = File::options().append(true).create(true).open(directory.join(MESSAGES))?;
    let mut child = Command::new("sh")
        .args(["-c", &format!("ulimit -v {MEMORY}; ulimit -f {}; ulimit -c 0; exec \"$0\" \"$@\"", 2 * FILE)])
        .arg(std::env::current_exe()?)
        .args(arguments)
        .current_dir(directory)
        // As many threads and arenas as a small machine has: what is measured is the input's memory.
        .envs([
            ("RAYON_NUM_THREADS", "2"),
            ("MALLOC_ARENA_MAX", "2"),
            ("NO_COLOR", "1"),
            ("RUST_BACKTRACE", "0"),
        ])
        .stdin(OwnedFd::from(theirs))
        .stdout(Stdio::null())
        .stderr(messages)
        .spawn()?;
    let lines = lines(ours);
    let (mut running, mut panic) = (None::<Running>, None);
    loop {
        match lines.recv_timeout(LOOK) {
            Ok(line) => {
                let words: Vec<&str> = line.splitn(6, ' ').collect();
                match words[..] {
                    ["make", number] => running = Some(Running::new(number, MAKING, child.id())),
                    ["run", number, stop] => running = Some(Running::new(number, stop, child.id())),
                    ["done", number, code, memory, micros, wrong] => {
                        running = None;
                        report(News::Done {
                            number: number.parse().unwrap_or(0),
                            code: code.parse().unwrap_or(u8::MAX),
                            memory: memory.parse().unwrap_or(0),
                            time: Duration::from_micros(micros.parse().unwrap_or(0)),
                            wrong: (!wrong.is_empty()).then(|| wrong.to_owned()),
                        });
                    }
                    _ => panic = line.strip_prefix("panic ").map(str::to_owned),
                }
                if Instant::now() < deadline {
                    continue;
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                let status = child.wait()?;
                return end(status, running.as_ref(), panic, &directory.join(MESSAGES), report);
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        if Instant::now() >= deadline {
            return kill(&mut child);
        }
        let Some(now) = &mut running else { continue };
        match late(now, child.id()) {
            Late::No => {}
            Late::Ended => {
                report(News::Ended { number: now.number });
                return kill(&mut child);
            }
            Late::Hangs(why) => {
                report(now.broken(why));
                return kill(&mut child);
            }
        }
    }
}

/// Limit that an input has exceeded.
enum Late {
    No,
    Ended,
    Hangs(String),
}

fn late(now: &mut Running, id: u32) -> Late {
    let wall = now.began.elapsed();
    if wall < ENOUGH {
        return Late::No;
    }
    let used = processor(id).saturating_sub(now.used);
    let beyond =
        |wall: Duration, used: Duration, limit: Duration| wall > limit && used > limit || wall > WALL;
    match (&*now.stop, now.asked) {
        ("ended", _) if used > ENOUGH || wall > WALL => Late::Ended,
        // A run that waits for viewers needs the processor for next to nothing.
        ("asked", None) if used > ENOUGH || wall > TIME => {
            // Not SIGINT, which what is started in the background ignores.
            let _ = Command::new("kill").args(["-TERM", &id.to_string()]).status();
            now.asked = Some((Instant::now(), used));
            Late::No
        }
        ("asked", Some((at, then))) if beyond(at.elapsed(), used.saturating_sub(then), GONE) => {
            Late::Hangs("does not stop when asked".to_owned())
        }
        _ if beyond(wall, used, TIME) => Late::Hangs(format!("takes more than {} s", TIME.as_secs())),
        _ => Late::No,
    }
}

/// Returns the lines that a worker writes.
fn lines(from: UnixStream) -> Receiver<String> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        for line in BufReader::new(from).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    receiver
}

fn kill(child: &mut Child) -> io::Result<()> {
    child.kill()?;
    child.wait().map(drop)
}

/// Handles the end of a worker.
fn end(
    status: ExitStatus,
    running: Option<&Running>,
    panic: Option<String>,
    messages: &Path,
    mut report: impl FnMut(News),
) -> io::Result<()> {
    let said = String::from_utf8_lossy(&fs::read(messages).unwrap_or_default()).into_owned();
    let Some(running) = running else {
        return if status.success() {
            Ok(())
        } else {
            Err(io::Error::other(format!("a worker failed, {status}: {said}")))
        };
    };
    if running.stop == MAKING && status.code().is_some() {
        // The worker's message has the reason.
        return Err(io::Error::other(format!("a worker failed, {status}: {said}")));
    }
    if running.asked.is_some() && (status.signal() == Some(15) || status.code() == Some(130)) {
        report(News::Ended { number: running.number });
        return Ok(());
    }
    // What the system says as it gives up: of memory, of the stack.
    let last =
        said.lines().rev().find(|line| line.contains("memory allocation") || line.contains("overflow"));
    let why = panic.unwrap_or_else(|| format!("{status}: {}", last.unwrap_or_default()));
    report(running.broken(why));
    Ok(())
}

/// Returns the processor time of a process, where the system provides it.
pub fn processor(id: u32) -> Duration {
    let stat = fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
    // After the name, which may hold anything, in parentheses.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |at: usize| fields.get(at).and_then(|field| field.parse().ok()).unwrap_or(0);
    Duration::from_millis(10 * (ticks(11) + ticks(12)))
}
