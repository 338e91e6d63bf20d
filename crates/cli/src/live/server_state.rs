//! Mutable state of a live run: its clock, its topics, and its clients.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Instant as WallInstant;

use flexsc_core::record::{CustomTopic, LogTopic, Message, TOPICS};
use serde_json::Value as Json;

use super::clock::{Clock, Speed};
use super::outbox::{Outbox, OutgoingFrame};
use super::protocol::{self, PARAMETERS, Request, StatusLevel};

/// Largest number of messages that are kept of a topic's latest instant.
const MOST_LATEST: usize = 64;
/// Error of requests after the end of the run.
const ENDED: &str = "the run has ended";

/// Mutable state of a live run.
pub struct ServerState {
    /// Clock of the run.
    pub clock: Clock,
    /// Topics, in the order of [`TOPICS`] and then of the custom topics.
    topics: Vec<LiveTopic>,
    /// Custom topics that the run has declared.
    custom: Vec<Arc<CustomTopic>>,
    /// Latest time that was sent (ns).
    time_ns: u64,
    /// Clients by their numbers.
    pub clients: BTreeMap<u64, LiveClient>,
    /// Number of clients that have joined since the start.
    joined: u64,
    /// True if the run has ended.
    pub ended: bool,
    /// True if the clients are being disconnected.
    pub closing: bool,
}

/// Topic of the run.
#[derive(Clone, Default)]
struct LiveTopic {
    advertised: bool,
    /// Latest instant (ns) and the data of its messages, for clients that subscribe later.
    latest: (u64, Vec<Vec<u8>>),
}

/// Client of the run.
#[derive(Default)]
pub struct LiveClient {
    /// Queue of frames for the client.
    pub outbox: Outbox,
    /// Subscription of each channel.
    subscriptions: BTreeMap<u32, u32>,
    /// Parameters whose changes the client subscribes to.
    follows: BTreeSet<String>,
}

impl ServerState {
    /// Returns the state of a run with the expected topics, as indices into [`TOPICS`].
    pub fn new(clock: Clock, topics: impl IntoIterator<Item = usize>) -> Self {
        let mut all = vec![LiveTopic::default(); TOPICS.len()];
        for index in topics {
            all[index].advertised = true;
        }
        let clients = BTreeMap::new();
        Self {
            clock,
            topics: all,
            custom: Vec::new(),
            time_ns: 0,
            clients,
            joined: 0,
            ended: false,
            closing: false,
        }
    }

    /// Registers a client and sends it the greeting; returns its number.
    pub fn join(&mut self, greeting: OutgoingFrame) -> u64 {
        let advertised = self.topics.iter().enumerate().filter(|(_, topic)| topic.advertised);
        let frames = [
            greeting,
            protocol::time(self.time_ns),
            protocol::advertise(advertised.map(|(index, _)| (index, self.topic(index)))),
            protocol::advertise_services(),
        ];
        self.joined += 1;
        let client = self.clients.entry(self.joined).or_default();
        for frame in frames {
            client.outbox.push(frame);
        }
        self.joined
    }

    /// Changes the clock, and notifies the clients that subscribed to it.
    pub fn change(&mut self, change: impl FnOnce(&mut Clock)) {
        let before = (self.clock.paused(), self.clock.speed());
        change(&mut self.clock);
        if before == (self.clock.paused(), self.clock.speed()) {
            return;
        }
        for client in self.clients.values_mut() {
            let followed: Vec<_> =
                PARAMETERS.into_iter().filter(|name| client.follows.contains(*name)).collect();
            if !followed.is_empty() {
                client.outbox.push(protocol::parameter_values(&followed, None, &self.clock));
            }
        }
    }

    /// Adds a custom topic, which is advertised with its first message.
    pub fn declare(&mut self, topic: LogTopic<'_>) {
        if let LogTopic::Custom(topic) = topic {
            self.custom.push(Arc::clone(topic));
            self.topics.push(LiveTopic::default());
        }
    }

    /// Returns the topic of an index.
    fn topic(&self, index: usize) -> LogTopic<'_> {
        match index.checked_sub(TOPICS.len()) {
            Some(custom) => LogTopic::Custom(&self.custom[custom]),
            None => LogTopic::Declared(index),
        }
    }

    /// Sends a message to the clients that subscribed to its topic.
    pub fn publish(&mut self, message: Message<'_>) {
        let Message { topic: index, time_ns, data } = message;
        if !std::mem::replace(&mut self.topics[index].advertised, true) {
            let frame = protocol::advertise([(index, self.topic(index))].into_iter());
            self.clients.values_mut().for_each(|client| client.outbox.push(frame.clone()));
        }
        // Viewers date a message by the time that they received last, which therefore precedes it.
        let moved = std::mem::replace(&mut self.time_ns, time_ns) != time_ns;
        for client in self.clients.values_mut() {
            if moved {
                client.outbox.push(protocol::time(time_ns));
            }
            if let Some(subscription) = client.subscriptions.get(&protocol::channel_of(index)) {
                client.outbox.push(protocol::data(*subscription, time_ns, data));
            }
        }
        let (instant, latest) = &mut self.topics[index].latest;
        if *instant != time_ns || latest.len() >= MOST_LATEST {
            latest.clear();
        }
        *instant = time_ns;
        latest.push(data.to_owned());
    }

    /// Queues a frame for a client.
    pub fn send(&mut self, id: u64, frame: OutgoingFrame) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.outbox.push(frame);
        }
    }

    /// Handles a request of a client.
    pub fn answer(&mut self, id: u64, request: Request) {
        match request {
            Request::Subscribe(pairs) => self.subscribe(id, &pairs),
            Request::Unsubscribe(ids) => {
                if let Some(client) = self.clients.get_mut(&id) {
                    client.subscriptions.retain(|_, subscription| !ids.contains(subscription));
                }
            }
            Request::GetParameters(names, request) => {
                let is_requested = |name: &&str| names.is_empty() || names.iter().any(|n| n == name);
                let known: Vec<_> = PARAMETERS.into_iter().filter(is_requested).collect();
                self.send(id, protocol::parameter_values(&known, request, &self.clock));
            }
            Request::SetParameters(values, request) => {
                for (name, value) in values {
                    if let Err(why) = self.set(&name, &value) {
                        self.send(id, protocol::status(StatusLevel::Error, &why));
                    }
                }
                if request.is_some() {
                    self.send(id, protocol::parameter_values(&PARAMETERS, request, &self.clock));
                }
            }
            Request::Follow(names) => {
                let known = names.into_iter().filter(|name| PARAMETERS.contains(&name.as_str()));
                self.clients.entry(id).and_modify(|client| client.follows.extend(known));
            }
            Request::Unfollow(names) => {
                self.clients
                    .entry(id)
                    .and_modify(|client| client.follows.retain(|name| !names.contains(name)));
            }
            Request::Call(service, call) => {
                let answer = match protocol::service(service) {
                    Some(_) if self.ended => protocol::service_failure(service, call, ENDED),
                    Some(name) => {
                        self.change(|clock| match name {
                            "/pause" => clock.pause(),
                            "/resume" => clock.resume(WallInstant::now()),
                            _ => clock.step(),
                        });
                        protocol::service_response(service, call, &self.clock)
                    }
                    None => protocol::service_failure(service, call, "there is no such service"),
                };
                self.send(id, answer);
            }
            Request::Other => {}
        }
    }

    fn subscribe(&mut self, id: u64, pairs: &[(u32, u32)]) {
        let Some(client) = self.clients.get_mut(&id) else { return };
        for &(subscription, channel) in pairs {
            let topic = protocol::topic_of(channel).and_then(|index| self.topics.get(index));
            let Some(topic) = topic.filter(|topic| topic.advertised) else {
                let why = format!("there is no channel {channel}");
                client.outbox.push(protocol::status(StatusLevel::Error, &why));
                continue;
            };
            if client.subscriptions.contains_key(&channel) {
                let why = format!("channel {channel} is subscribed to already");
                client.outbox.push(protocol::status(StatusLevel::Warning, &why));
                continue;
            }
            client.subscriptions.insert(channel, subscription);
            // Values that were published before: parameters, and the state of a paused run.
            let (time_ns, latest) = &topic.latest;
            for data in latest {
                client.outbox.push(protocol::data(subscription, *time_ns, data));
            }
            self.clock.begin(WallInstant::now());
        }
    }

    fn set(&mut self, name: &str, value: &Json) -> Result<(), String> {
        let wall = WallInstant::now();
        match (name, value) {
            ("/paused" | "/speed", _) if self.ended => return Err(ENDED.to_owned()),
            ("/paused", Json::Bool(true)) => self.change(Clock::pause),
            ("/paused", Json::Bool(false)) => self.change(|clock| clock.resume(wall)),
            ("/paused", _) => return Err(format!("/paused must be true or false, got {value}")),
            ("/speed", value) => {
                let speed: Result<Speed, String> = match value {
                    Json::String(text) => text.parse(),
                    value => Speed::factor(value.as_f64().unwrap_or(f64::NAN)),
                };
                let speed = speed.map_err(|why| format!("/speed {why}"))?;
                self.change(|clock| clock.set_speed(speed, wall));
            }
            _ => return Err(format!("there is no parameter {name}; there are {}", PARAMETERS.join(", "))),
        }
        Ok(())
    }
}
