//! `flexsc serve`: a run in lockstep with a control program, which gets the sensors of each cycle and answers with commands.
//!
//! At each sample of the law the run stops between its steps 5 and 6 (`docs/events.md`), the instant at which flight
//! software would be called. The log is that of the same commands in one process, byte for byte.

mod layout;
mod link;
mod lockstep;
mod pace;
mod packet;
mod session;
mod xtce;

use std::io::Write;
use std::net::{SocketAddr, ToSocketAddrs};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant as WallInstant};

use clap::ValueEnum;
use flexsc_core::campaign::{Campaign, CampaignRun, CommandLog};
use flexsc_core::numerics::time::Span;
use flexsc_core::record::{Detail, ExistingLog, LogFile, RecordError, existing_log};
use flexsc_core::{Scenario, Simulation, SimulationError};
use flexsc_view::scene::Scene;
use flexsc_view::with_layout;

use crate::answer::AnswerArgs;
use crate::campaign::logs::LogDetail;
use crate::confirm_cost::CostConfirmation;
use crate::error::CliError;
use crate::out::Out;
use crate::quantity::in_unit;
use crate::{files, print, say, scenario, simulate, stop};
use layout::PacketLayout;
use link::{Link, Transport};
use lockstep::{Served, StopReason};
use pace::Pace;
use session::{Session, SessionEnd};

/// Longest time limit for a client (s).
const LONGEST_TIMEOUT: f64 = 1e6;

#[derive(clap::Args)]
pub struct ServeArgs {
    /// Scenario file
    scenario: PathBuf,
    /// Directory for the log, created if missing, or FILE.mcap [default: the current directory]
    #[arg(short, long, value_name = "DIR|FILE")]
    out: Option<PathBuf>,
    /// Set a key of the scenario, such as law.attitude.period=0.5
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seed [default: the scenario's]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(..=scenario::LARGEST_SEED))]
    seed: Option<u64>,
    #[command(flatten)]
    transport: TransportArgs,
    /// Address of the server; port 0 selects any free port
    #[arg(long, value_name = "HOST:PORT", default_value = "127.0.0.1:5010", value_parser = address)]
    bind: SocketAddr,
    /// Event that begins each cycle
    #[arg(long, value_name = "PACE", default_value = "free")]
    pace: PaceKind,
    /// Period of the cycles in s [default: that of the law]
    #[arg(long, value_name = "S", value_parser = period)]
    period: Option<Span>,
    /// Longest silence of a client in s; 0 for none
    #[arg(long, value_name = "S", default_value = "10", value_parser = timeout)]
    timeout: f64,
    /// Detail of the log [default: events]
    #[arg(long, value_name = "DETAIL")]
    log: Option<LogDetail>,
    /// Replace a log that exists
    #[arg(long)]
    force: bool,
    /// Print the packets of the scenario as XTCE to stdout, and run nothing
    #[arg(long)]
    describe: bool,
    #[command(flatten)]
    answer: AnswerArgs,
    #[command(flatten)]
    consent: CostConfirmation,
}

/// Transport of the packets.
#[derive(clap::Args)]
#[group(skip)]
struct TransportArgs {
    /// Send packets as datagrams of UDP, which are repeated if they are lost [default]
    #[arg(long, conflicts_with = "tcp")]
    udp: bool,
    /// Send packets over a connection of TCP
    #[arg(long)]
    tcp: bool,
}

/// Pace of a run in lockstep.
#[derive(Copy, Clone, PartialEq, ValueEnum)]
enum PaceKind {
    /// The answer to the cycle before
    Free,
    /// The wall clock
    RealTime,
    /// A request of the client
    Step,
}

fn address(text: &str) -> Result<SocketAddr, String> {
    let none = "must be a host and a port, such as 127.0.0.1:5010";
    let mut all = text.to_socket_addrs().map_err(|error| format!("{none}: {error}"))?;
    all.next().ok_or_else(|| none.to_owned())
}

fn period(text: &str) -> Result<Span, String> {
    let seconds = in_unit("s")(text)?;
    if (1e-9..=1e9).contains(&seconds) {
        Ok(Span::from_seconds(seconds))
    } else {
        Err(format!("must be a time of 1e-9 to 1e9 s, got {seconds}"))
    }
}

fn timeout(text: &str) -> Result<f64, String> {
    let seconds = in_unit("s")(text)?;
    if (0.0..=LONGEST_TIMEOUT).contains(&seconds) {
        Ok(seconds)
    } else {
        Err(format!("must be a time of 0 to {LONGEST_TIMEOUT} s, got {seconds}"))
    }
}

pub fn run(args: &ServeArgs) -> Result<(), CliError> {
    let scenario = scenario::load(&args.scenario, &args.set, args.seed)?;
    let campaign = Campaign::new(scenario, &args.scenario.display().to_string(), None)?;
    let run = simulate::scenario_run(&campaign);
    let period = args.cycle_period(&run.scenario)?;
    let telemetry = Simulation::new(&run.scenario, run.noise_run).telemetry_layout(&run.scenario);
    let (axes, epoch_ns) = (run.scenario.axis_count(), run.scenario.epoch_ns());
    let layout = PacketLayout::new(telemetry, axes, period, epoch_ns)
        .map_err(|why| CliError::Arguments(format!("{}: {why}", args.scenario.display())))?;
    if args.describe {
        return print(xtce::document(&run.scenario.name, &layout).as_bytes());
    }
    let detail = args.log.unwrap_or(LogDetail::Events).detail();
    args.consent.check(&run.scenario.cost(detail, false))?;
    let path = detail.map(|_| args.path(&run.scenario.name)).transpose()?;
    let _writing = detail.map(|_| stop::writing());
    let log = match (detail, &path) {
        (Some(detail), Some(path)) => Some(args.create_log(&run, path, detail)?),
        _ => None,
    };
    let link = args.bind_link()?;
    args.announce(&link, &run.scenario, period)?;
    let limit = (args.timeout > 0.0).then(|| Duration::from_secs_f64(args.timeout));
    let mut session = Session::begin(link, layout, args.pace.start(), limit)
        .map_err(|end| ended(StopReason::Session(end), &run, None))?;
    let began = WallInstant::now();
    let scene = detail.and_then(|detail| Scene::for_detail(&run.scenario, detail));
    let served = lockstep::serve(&run, &mut session, period, (log, scene)).map_err(|error| match error {
        RecordError::Io(source) => CliError::write(path.as_deref().unwrap_or(&args.scenario))(source),
        source => CliError::Run { name: run.scenario.name.clone(), source: SimulationError::Record(source) },
    })?;
    let took = began.elapsed().as_secs_f64();
    let Served { metrics, observed, cycles, stopped, bytes } = served;
    if let Some(reason) = stopped {
        return Err(ended(reason, &run, path.as_deref()));
    }
    let answer = args.answer.answer(&run.scenario, &metrics, Some(&observed));
    args.answer.print(&answer, took, path.as_deref().zip(bytes));
    let ratio = run.scenario.duration.seconds() / took;
    let counts = session.counts;
    say!(
        "  lockstep   {cycles} cycles, {ratio:.0} times real time, {} packets repeated, {} ignored",
        counts.repeated,
        counts.ignored
    );
    args.answer.validate(&[(run.scenario.name.clone(), answer)])
}

impl PaceKind {
    fn start(self) -> Pace {
        match self {
            Self::Free => Pace::Free,
            Self::RealTime => Pace::RealTime(None),
            Self::Step => Pace::Step,
        }
    }
}

impl ServeArgs {
    /// Returns the period of the cycles: that of the law, unless another one is given.
    fn cycle_period(&self, scenario: &Scenario) -> Result<Span, CliError> {
        self.period.or(scenario.study.law_period).ok_or_else(|| {
            let (path, kind) = (self.scenario.display(), scenario.law.kind());
            CliError::Arguments(format!(
                "{path}: `law.{kind}` has no period\n\nhint: --period gives one, such as --period 0.1"
            ))
        })
    }

    /// Returns the path of the log, whose directory exists.
    fn path(&self, name: &str) -> Result<PathBuf, CliError> {
        let Some(out) = &self.out else { return Ok(PathBuf::from(format!("{name}.mcap"))) };
        match Out::new(out, &["mcap"], &[&self.scenario])? {
            Out::File(path, _) => {
                files::make_parent(&path)?;
                Ok(path)
            }
            Out::Directory(path) => {
                files::make_directory(&path)?;
                Ok(path.join(format!("{name}.mcap")))
            }
        }
    }

    /// Creates the log of the run, in which the commands follow at the end.
    fn create_log(&self, run: &CampaignRun, path: &Path, detail: Detail) -> Result<LogFile, CliError> {
        let mut provenance = Campaign::provenance(run);
        provenance.attachments.push(CommandLog::default().attachment());
        let provenance = with_layout(provenance, &run.scenario, detail);
        let log = LogFile::create(path, &provenance, detail).map_err(|error| match error {
            RecordError::Io(source) => CliError::write(path)(source),
            source => CliError::Run { name: run.scenario.name.clone(), source: source.into() },
        })?;
        // A run with a client cannot be repeated without it.
        match existing_log(path, &provenance) {
            ExistingLog::Nothing => Ok(log),
            _ if self.force => Ok(log),
            ExistingLog::Same => Ok(log),
            ExistingLog::Other(description) => Err(CliError::Arguments(format!(
                "{}: {description}\n\nhint: give another file with -o, or use --force to replace it",
                path.display()
            ))),
        }
    }

    fn bind_link(&self) -> Result<Link, CliError> {
        let TransportArgs { udp, tcp } = self.transport;
        let transport = if tcp && !udp { Transport::Tcp } else { Transport::Udp };
        Link::bind(transport, self.bind).map_err(|source| self.unbound(source))
    }

    fn unbound(&self, source: std::io::Error) -> CliError {
        CliError::Bind { address: self.bind.to_string(), source }
    }

    /// Prints the address and the cycles.
    fn announce(&self, link: &Link, scenario: &Scenario, period: Span) -> Result<(), CliError> {
        let address = link.address().map_err(|source| self.unbound(source))?;
        let transport = if link.is_lossy() { Transport::Udp } else { Transport::Tcp }.name();
        let pace = match self.pace {
            PaceKind::Free => "",
            PaceKind::RealTime => ", in real time",
            PaceKind::Step => ", at the client's requests",
        };
        say!(
            "  serve          {transport} {address}, {} in cycles of {} s{pace}",
            scenario.name,
            period.seconds()
        );
        if !address.ip().is_loopback() {
            say!("  warning        every program that reaches {address} can control this run");
        }
        Ok(())
    }
}

/// Returns the error of a run that ended early.
fn ended(reason: StopReason, run: &CampaignRun, path: Option<&Path>) -> CliError {
    let held =
        path.map_or_else(String::new, |path| format!("; {} holds the run up to that time", path.display()));
    if reason.is_interruption() {
        return CliError::Interrupted(held);
    }
    let why = match reason {
        StopReason::Simulation(source) => {
            return CliError::Run { name: run.scenario.name.clone(), source };
        }
        StopReason::Session(end) => match end {
            SessionEnd::Silent(limit) => format!("the client has been silent for {} s", limit.as_secs_f64()),
            SessionEnd::Closed => "the client has closed its connection".to_owned(),
            SessionEnd::Refused(why) => why,
            SessionEnd::Io(error) => error.to_string(),
            SessionEnd::Interrupted => String::new(),
        },
    };
    CliError::Lockstep(format!("{}: {why}{held}", run.scenario.name))
}
