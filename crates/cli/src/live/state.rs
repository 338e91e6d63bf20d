//! What of a live run changes: its clock, its topics, and what each client has yet to be sent.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::time::Instant as WallInstant;

use flexsc_core::record::{Message, TOPICS};
use serde_json::Value as Json;

use super::clock::{Clock, Speed};
use super::protocol::{self, Level, PARAMETERS, Request};

/// A frame of the protocol.
pub type Frame = tungstenite::Message;

/// What of a live run changes.
pub struct State {
    /// When the run may go on.
    pub clock: Clock,
    /// The topics, in the order of [`TOPICS`].
    topics: Vec<Topic>,
    /// The time that was told last (ns).
    time_ns: u64,
    /// The clients by their numbers.
    pub clients: BTreeMap<u64, Client>,
    /// How many clients there have been.
    joined: u64,
    /// Whether the clients are being sent away.
    pub closing: bool,
}

/// A topic of the run.
#[derive(Clone, Default)]
struct Topic {
    advertised: bool,
    /// Time and data of its latest message, for clients that come late.
    latest: Option<(u64, Vec<u8>)>,
}

/// A client.
#[derive(Default)]
pub struct Client {
    /// What it has yet to be sent.
    pub frames: VecDeque<Frame>,
    /// The subscription of each channel.
    subscriptions: BTreeMap<u32, u32>,
    /// The parameters of whose changes it is told.
    follows: BTreeSet<String>,
}

impl State {
    /// The state of a run whose topics will be these, as indices into [`TOPICS`].
    pub fn new(clock: Clock, topics: impl IntoIterator<Item = usize>) -> Self {
        let mut all = vec![Topic::default(); TOPICS.len()];
        for index in topics {
            all[index].advertised = true;
        }
        Self { clock, topics: all, time_ns: 0, clients: BTreeMap::new(), joined: 0, closing: false }
    }

    /// A client has come, to be greeted so; its number.
    pub fn join(&mut self, greeting: Frame) -> u64 {
        let advertised = self.topics.iter().enumerate().filter(|(_, topic)| topic.advertised);
        let frames = [
            greeting,
            protocol::time(self.time_ns),
            protocol::advertise(advertised.map(|(index, _)| (index, &TOPICS[index]))),
            protocol::advertise_services(),
        ];
        self.joined += 1;
        self.clients.insert(self.joined, Client { frames: frames.into(), ..Client::default() });
        self.joined
    }

    /// Changes the clock, and tells the clients who follow it.
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
                client.frames.push_back(protocol::parameter_values(&followed, None, &self.clock));
            }
        }
    }

    /// Gives a message to the clients who subscribed to its topic.
    pub fn publish(&mut self, message: Message<'_>) {
        let Message { topic: index, time_ns, data } = message;
        let topic = &mut self.topics[index];
        if !topic.advertised {
            topic.advertised = true;
            let frame = protocol::advertise([(index, &TOPICS[index])].into_iter());
            self.clients.values_mut().for_each(|client| client.frames.push_back(frame.clone()));
        }
        // Viewers give a message the time that they were told last: it must come first.
        let moved = std::mem::replace(&mut self.time_ns, time_ns) != time_ns;
        for client in self.clients.values_mut() {
            if moved {
                client.frames.push_back(protocol::time(time_ns));
            }
            if let Some(subscription) = client.subscriptions.get(&protocol::channel_of(index)) {
                client.frames.push_back(protocol::data(*subscription, time_ns, data));
            }
        }
        topic.latest = Some((time_ns, data.to_owned()));
    }

    /// Sends a client something.
    pub fn send(&mut self, id: u64, frame: Frame) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.frames.push_back(frame);
        }
    }

    /// Does what a client asks.
    pub fn answer(&mut self, id: u64, request: Request) {
        match request {
            Request::Subscribe(pairs) => self.subscribe(id, &pairs),
            Request::Unsubscribe(gone) => {
                if let Some(client) = self.clients.get_mut(&id) {
                    client.subscriptions.retain(|_, subscription| !gone.contains(subscription));
                }
            }
            Request::GetParameters(names, request) => {
                let asked = |name: &&str| names.is_empty() || names.iter().any(|n| n == name);
                let known: Vec<_> = PARAMETERS.into_iter().filter(asked).collect();
                self.send(id, protocol::parameter_values(&known, request, &self.clock));
            }
            Request::SetParameters(values, request) => {
                for (name, value) in values {
                    if let Err(why) = self.set(&name, &value) {
                        self.send(id, protocol::status(Level::Error, &why));
                    }
                }
                if request.is_some() {
                    self.send(id, protocol::parameter_values(&PARAMETERS, request, &self.clock));
                }
            }
            Request::Follow(names) => {
                self.clients.entry(id).and_modify(|client| client.follows.extend(names));
            }
            Request::Unfollow(names) => {
                self.clients
                    .entry(id)
                    .and_modify(|client| client.follows.retain(|name| !names.contains(name)));
            }
            Request::Call(service, call) => {
                let answer = match protocol::service(service) {
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
                client.frames.push_back(protocol::status(Level::Error, &why));
                continue;
            };
            if client.subscriptions.contains_key(&channel) {
                let why = format!("channel {channel} is subscribed to already");
                client.frames.push_back(protocol::status(Level::Warning, &why));
                continue;
            }
            client.subscriptions.insert(channel, subscription);
            // What was said before: parameters, and the state of a paused run.
            if let Some((time_ns, data)) = &topic.latest {
                client.frames.push_back(protocol::data(subscription, *time_ns, data));
            }
            self.clock.begin(WallInstant::now());
        }
    }

    fn set(&mut self, name: &str, value: &Json) -> Result<(), String> {
        let wall = WallInstant::now();
        match (name, value) {
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
