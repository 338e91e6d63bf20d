//! `flexsc simulate --live`: a run in real time for viewers that speak the Foxglove WebSocket protocol.
//!
//! A live run is recorded like any other: the record blocks until the clock releases an instant, and the messages are
//! those of a log, byte for byte.

mod access;
mod client;
mod clock;
mod connection;
mod hub;
mod keys;
mod outbox;
mod protocol;
mod server_state;
mod topics;

use std::collections::VecDeque;
use std::io::{self, Write};
use std::net::{Shutdown, TcpListener, TcpStream, ToSocketAddrs};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread;
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::Metrics;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Detail, MessageEncoder, Record, RecordError, RunEnd, Sample, SceneSource};
use flexsc_view::scene::Scene;
use flexsc_view::with_layout;

use crate::error::CliError;
use crate::{say, stop};
use access::AccessControl;
use clock::{Clock, POLL_PERIOD, Speed};
use hub::{Hub, Publisher};
use server_state::ServerState;

/// Time limit for clients to receive the remaining messages when the server closes.
const FLUSH: Duration = Duration::from_secs(5);

/// Largest number of open connections that have sent no request yet.
const MOST_SILENT: usize = 64;

#[derive(clap::Args)]
#[command(next_help_heading = "Live runs")]
#[group(skip)]
pub struct LiveArgs {
    /// Serve the run to viewers such as Foxglove and Lichtblick while it goes on, in real time
    #[arg(
        long,
        value_name = "HOST:PORT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "127.0.0.1:8765",
        value_parser = address,
        conflicts_with = "runs",
    )]
    pub live: Option<String>,
    /// Speed relative to real time, or max
    #[arg(long, value_name = "FACTOR", requires = "live")]
    speed: Option<Speed>,
    /// Begin when a viewer has subscribed to a topic
    #[arg(long, requires = "live")]
    wait: bool,
    /// Pause at the start, until a viewer or a key lets the run go on
    #[arg(long, requires = "live")]
    paused: bool,
    /// Let pages of this origin connect, such as https://viewer.example
    #[arg(long, value_name = "ORIGIN", requires = "live", value_parser = access::origin)]
    allow_origin: Vec<String>,
}

fn address(text: &str) -> Result<String, String> {
    match text.to_socket_addrs() {
        Ok(_) => Ok(text.to_owned()),
        Err(error) => Err(format!("must be a host and a port, such as 127.0.0.1:8765: {error}")),
    }
}

/// Live run with its server.
pub struct Live {
    hub: Arc<Hub>,
    messages: Option<MessageEncoder<Publisher>>,
    scene: Scene,
}

impl LiveArgs {
    /// Starts the server if a live run is requested.
    pub fn serve(&self, run: &CampaignRun) -> Result<Option<Live>, CliError> {
        let Some(address) = &self.live else { return Ok(None) };
        let failed = |source| CliError::Serve { address: address.clone(), source };
        let listener = TcpListener::bind(address).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        let bound = listener.local_addr().map_err(failed)?;
        let wall = WallInstant::now();
        let speed = self.speed.unwrap_or(Speed::REAL);
        let mut clock = Clock::new(speed, run.scenario.log_period(), wall);
        if self.paused {
            clock.pause();
        }
        if !self.wait {
            clock.begin(wall);
        }
        let provenance = with_layout(Campaign::provenance(run), &run.scenario, Detail::Scene);
        let scene = Scene::new(&run.scenario);
        let state = ServerState::new(clock, topics::expected(run, &provenance, &scene));
        let hub = Arc::new(Hub::new(&run.scenario.name, state));
        let messages = MessageEncoder::new(Publisher(hub.clone()), &provenance, Detail::Scene);
        let messages = messages.map_err(|error| failed(io::Error::other(error)))?;
        let paused = if self.paused { ", paused" } else { "" };
        say!("  live           ws://{bound}, {speed}{paused}");
        let gate = Arc::new(AccessControl::new(address, &self.allow_origin));
        thread::spawn({
            let hub = hub.clone();
            move || accept(&hub, &gate, &listener)
        });
        keys::listen(hub.clone());
        Ok(Some(Live { hub, messages: Some(messages), scene }))
    }
}

impl Live {
    /// Sends the metrics, and continues to serve while viewers are connected.
    pub fn finish(mut self, metrics: &Metrics) {
        if let Some(messages) = self.messages.take() {
            // Messages to viewers cannot fail.
            let _ = messages.finish(metrics, RunEnd::Complete);
        }
        self.hub.end();
        if self.hub.clients() > 0 && !stop::stop_requested() {
            say!(
                "  live           the run has ended; Ctrl-C ends the server, as does the last viewer when it disconnects"
            );
        }
        while self.hub.clients() > 0 && !stop::stop_requested() {
            thread::sleep(POLL_PERIOD);
        }
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.hub.close(FLUSH);
    }
}

impl Record for Live {
    fn wants_motion(&self) -> bool {
        true
    }

    fn scene(&self) -> Option<Box<dyn SceneSource>> {
        self.scene.scene()
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        self.hub.pace(now)?;
        self.messages.record(now, sample)
    }
}

/// Connections that have sent no request yet, the oldest first.
#[derive(Default)]
struct SilentConnections(Mutex<VecDeque<(Weak<()>, TcpStream)>>);

impl SilentConnections {
    fn each(&self) -> MutexGuard<'_, VecDeque<(Weak<()>, TcpStream)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a connection until the returned guard is dropped; of too many, the oldest is closed.
    fn add(&self, stream: TcpStream) -> Arc<()> {
        let greeting = Arc::new(());
        let mut each = self.each();
        if each.len() >= MOST_SILENT
            && let Some((_, oldest)) = each.pop_front()
        {
            // The shutdown ends the connection's thread, unless it has ended.
            let _ = oldest.shutdown(Shutdown::Both);
        }
        each.push_back((Arc::downgrade(&greeting), stream));
        greeting
    }

    /// Removes the connections whose guards were dropped, which closes those that are not served.
    fn remove_ended(&self) {
        self.each().retain(|(greeting, _)| greeting.strong_count() > 0);
    }
}

/// Accepts clients, each on a thread of its own, until the hub closes. Clients do not wait for each other.
fn accept(hub: &Arc<Hub>, gate: &Arc<AccessControl>, listener: &TcpListener) {
    let silent = Arc::new(SilentConnections::default());
    while !hub.closing() {
        let Ok((stream, _)) = listener.accept() else {
            thread::sleep(POLL_PERIOD);
            continue;
        };
        let Ok(other) = stream.try_clone() else { continue };
        let (hub, gate, silent) = (hub.clone(), gate.clone(), silent.clone());
        let greeting = silent.add(other);
        thread::spawn(move || {
            let greeted = client::greet(&hub, &gate, stream);
            drop(greeting);
            silent.remove_ended();
            if let Some((socket, _seat)) = greeted {
                client::serve(&hub, socket);
            }
        });
    }
}
