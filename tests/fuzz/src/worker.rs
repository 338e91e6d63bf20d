//! Process in which inputs run, one after another. It announces each step to its parent, line by line.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::fd::AsFd;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::case::{self, Case, Stop};
use crate::fmu_importer::play;
use crate::lockstep_client::LockstepClient;
use crate::surface::{Maker, Server, Surface};
use crate::watch::processor;

/// Name of the file of a worker's messages, which the parent creates.
pub const MESSAGES: &str = "messages";
/// Length above which a message is of no use (bytes).
const LONGEST_MESSAGE: usize = 64 << 10;

/// The processor's time is counted in these.
const TICK: Duration = Duration::from_millis(10);

/// Number of viewers' inputs after which the run is checked to serve others; after a saved input it always is.
const CHECK: u64 = 5;

/// Inputs that a worker runs.
pub enum Work<'a> {
    /// Inputs by their numbers.
    Numbers(Surface, u64, std::ops::Range<u64>),
    /// Saved input.
    Kept(&'a Path),
}

/// Runner of the inputs.
struct Worker {
    /// Line to the parent, which was standard input.
    parent: File,
    server: Option<Server>,
}

/// Runs inputs in the present directory.
pub fn work(work: &Work<'_>) -> io::Result<()> {
    let parent = File::from(io::stdin().as_fd().try_clone_to_owned()?);
    // A command that reads standard input gets an empty file instead of that line.
    rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
    let told = parent.try_clone()?;
    std::panic::set_hook(Box::new(move |panic| {
        let text = panic.to_string().replace('\n', " ");
        // A panic ends the process, wherever it is caught.
        let _ = writeln!(&told, "panic {text}");
        std::process::abort();
    }));
    let mut worker = Worker { parent, server: None };
    match work {
        Work::Numbers(surface, seed, numbers) => {
            let maker = Maker::new(*surface, *seed)?;
            for number in numbers.clone() {
                writeln!(worker.parent, "make {number}")?;
                if !worker.run(number, &maker.make(number))? {
                    break;
                }
            }
        }
        Work::Kept(directory) => {
            worker.run(0, &Case::load(directory)?)?;
        }
    }
    // A server's threads end with the process.
    std::process::exit(0)
}

impl Worker {
    /// Runs an input, and returns true if others can follow in this process.
    fn run(&mut self, number: u64, case: &Case) -> io::Result<bool> {
        let stop = match case.stop() {
            Stop::Never => "never",
            Stop::Asked => "asked",
            Stop::Ended => "ended",
        };
        OpenOptions::new().write(true).open(MESSAGES)?.set_len(0)?;
        if case.is_live() && self.server.as_ref().is_none_or(Server::has_ended) {
            self.server = Some(Server::start(case, Path::new(MESSAGES))?);
        }
        writeln!(self.parent, "run {number} {stop}")?;
        // Where the system can: the largest memory from here on.
        let _ = fs::write("/proc/self/clear_refs", "5");
        let (began, used) = (Instant::now(), processor(std::process::id()));
        let (code, wrong) = match (&self.server, case.file(case::SENT)) {
            (Some(server), Some(sent)) => {
                server.receive(sent);
                let well = !number.is_multiple_of(CHECK) || server.serves();
                (0, (!well).then(|| "the server answers nobody".to_owned()))
            }
            _ => run(case)?,
        };
        // Where others keep the processor busy, an input takes no longer than it has the processor.
        let used = processor(std::process::id()).saturating_sub(used) + TICK;
        let (micros, memory) = (began.elapsed().min(used).as_micros(), memory());
        writeln!(self.parent, "done {number} {code} {memory} {micros} {}", wrong.unwrap_or_default())?;
        Ok(code != 130)
    }
}

/// Runs the command in a directory of its own, and returns its exit code and the fault of its outcome.
fn run(case: &Case) -> io::Result<(u8, Option<String>)> {
    let directory = Path::new("run");
    fs::create_dir(directory)?;
    case.lay_out(directory)?;
    std::env::set_current_dir(directory)?;
    let played =
        case.file(case::CALLS).map(|calls| play(&String::from_utf8_lossy(calls), Path::new("resources")));
    let (code, wrong_call) = match played {
        Some(wrong) => (0, wrong),
        None => (command(case), None),
    };
    std::env::set_current_dir("..")?;
    if code == 130 {
        // Work that could not be stopped may continue; it ends with this process.
        return Ok((code, None));
    }
    let wrong = match wrong_call {
        Some(wrong) => Some(wrong),
        None => wrong(case, code, directory)?,
    };
    fs::remove_dir_all(directory)?;
    Ok((code, wrong))
}

/// Runs the command, and beside it the client of a run in lockstep, if there is one; returns the exit code.
fn command(case: &Case) -> u8 {
    let arguments = ["flexsc"].into_iter().chain(case.arguments.iter().map(String::as_str));
    let run = || flexsc_cli::main(arguments.map(OsString::from));
    let Some(script) = case.file(case::PACKETS) else { return run() };
    let has_ended = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            if let Some((transport, address)) = announced(&Path::new("..").join(MESSAGES), &has_ended) {
                LockstepClient::new(&transport, &address)
                    .control(&String::from_utf8_lossy(script), &has_ended);
            }
        });
        let code = run();
        has_ended.store(true, Ordering::Relaxed);
        code
    })
}

/// Waits for the transport and the address that a server announces; returns none if it ends before.
fn announced(messages: &Path, has_ended: &AtomicBool) -> Option<(String, String)> {
    while !has_ended.load(Ordering::Relaxed) {
        let said = fs::read_to_string(messages).unwrap_or_default();
        let line = said.lines().find_map(|line| line.trim_start().strip_prefix("serve "));
        if let Some((transport, rest)) = line.and_then(|line| line.trim_start().split_once(' '))
            && let Some((address, _)) = rest.split_once(',')
        {
            return Some((transport.to_owned(), address.to_owned()));
        }
        thread::sleep(TICK / 10);
    }
    None
}

/// Returns the first violation of the rules for every command.
fn wrong(case: &Case, code: u8, directory: &Path) -> io::Result<Option<String>> {
    if ![0, 1, 2, 3].contains(&code) {
        return Ok(Some(format!("exit code {code}")));
    }
    let said = fs::read(MESSAGES)?;
    // With `--json`, `check` prints the mistakes where programs read them.
    let has = |word: &str| case.arguments.iter().any(|argument| argument == word);
    if code != 0 && said.is_empty() && !(has("check") && has("--json")) {
        return Ok(Some(format!("exit code {code} without a word")));
    }
    if said.len() > LONGEST_MESSAGE {
        return Ok(Some(format!("messages of {} kB", said.len() / 1000)));
    }
    let Ok(said) = String::from_utf8(said) else { return Ok(Some("messages that are no text".to_owned())) };
    if said.contains('\u{1b}') || said.contains('\0') {
        return Ok(Some("control characters in messages".to_owned()));
    }
    let mut files = Vec::new();
    case::gather(directory, "", &mut files)?;
    // The lock of a campaign's directory stays in it, and the kernel releases it.
    let new = |(name, _): &&(String, Vec<u8>)| {
        case.file(name).is_none() && name.rsplit('/').next() != Some(".lock")
    };
    if let Some((name, _)) = files.iter().filter(new).find(|(name, _)| code == 2 || name.contains(".partial"))
    {
        return Ok(Some(format!(
            "exit code {code}, but left {}",
            name.rsplit('.').next().unwrap_or_default()
        )));
    }
    if code == 2
        && let Some(new) = new_directory(case, directory)?
    {
        return Ok(Some(format!("exit code 2, but left the directory {new}")));
    }
    let tables = files.iter().filter(|(name, _)| name.ends_with("statistics.csv"));
    let infinite = |bytes: &[u8]| {
        let is_infinite = |cell: &str| cell.parse().is_ok_and(|number: f64| !number.is_finite());
        String::from_utf8_lossy(bytes).split([',', '\n']).any(is_infinite)
    };
    if tables.into_iter().any(|(_, bytes)| infinite(bytes)) {
        return Ok(Some("inf or NaN in statistics.csv".to_owned()));
    }
    Ok(None)
}

/// Returns a directory that the command has made.
fn new_directory(case: &Case, directory: &Path) -> io::Result<Option<String>> {
    for entry in fs::read_dir(directory)? {
        let entry = entry?;
        let within = format!("{}/", entry.file_name().to_string_lossy());
        let is_given = case.files.iter().any(|(name, _)| name.starts_with(&within));
        if entry.file_type()?.is_dir() && !is_given {
            return Ok(Some(within));
        }
    }
    Ok(None)
}

/// Returns the largest memory of this process since the last call (kB), where the system provides it.
fn memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}
