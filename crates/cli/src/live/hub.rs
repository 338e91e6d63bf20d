//! What the run and the clients of a live run share: the clock, the topics and what is yet to be sent.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::record::{Message, Messages, RecordError, TOPICS};
use flexsc_core::time::Instant;
use serde_json::Value as Json;

use super::clock::{Clock, LOOK, Speed};
use super::protocol::{self, Level, PARAMETERS, Request};
use crate::stop;

/// The run waits for a client that has so many frames yet to take.
const MOST_FRAMES: usize = 8192;

/// A frame of the protocol.
pub type Frame = tungstenite::Message;

/// What the run and the clients share.
pub struct Hub {
    name: String,
    session: String,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    clock: Clock,
    topics: Vec<Topic>,
    time_ns: u64,
    clients: BTreeMap<u64, Client>,
    joined: u64,
    closing: bool,
}

/// A topic of the run, in the order of [`TOPICS`].
#[derive(Clone, Default)]
struct Topic {
    advertised: bool,
    /// Time and data of its latest message, for clients that come late.
    latest: Option<(u64, Vec<u8>)>,
}

/// What the hub knows of a client.
#[derive(Default)]
struct Client {
    frames: VecDeque<Frame>,
    /// The subscription of each channel.
    subscriptions: BTreeMap<u32, u32>,
    /// The parameters of whose changes it is told.
    follows: BTreeSet<String>,
}

impl Hub {
    /// A hub for a run whose topics will be these, as indices into [`TOPICS`].
    pub fn new(name: String, clock: Clock, topics: impl IntoIterator<Item = usize>) -> Self {
        let mut all = vec![Topic::default(); TOPICS.len()];
        for index in topics {
            all[index].advertised = true;
        }
        let session = format!("{name}-{}", std::process::id());
        let (clients, joined, closing) = (BTreeMap::new(), 0, false);
        let state = Mutex::new(State { clock, topics: all, time_ns: 0, clients, joined, closing });
        Self { name, session, state, changed: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // What is shared is whole after every statement.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, state: MutexGuard<'a, State>, at_most: Duration) -> MutexGuard<'a, State> {
        let woken = self.changed.wait_timeout(state, at_most);
        woken.unwrap_or_else(PoisonError::into_inner).0
    }

    /// Holds the run until its clock lets an instant through.
    pub fn pace(&self, at: Instant) -> Result<(), RecordError> {
        let mut state = self.lock();
        while let Some(time) = state.clock.wait(at, WallInstant::now()) {
            if stop::asked() {
                return Err(RecordError::Interrupted);
            }
            state = self.wait(state, time);
        }
        Ok(())
    }

    /// Changes the clock, tells the clients who follow it, and returns it.
    pub fn change(&self, change: impl FnOnce(&mut Clock)) -> Clock {
        let mut state = self.lock();
        state.change(change);
        self.changed.notify_all();
        state.clock.clone()
    }

    /// A client has come; its number.
    pub fn join(&self) -> u64 {
        let mut state = self.lock();
        let advertised = state.topics.iter().enumerate().filter(|(_, topic)| topic.advertised);
        let frames = [
            protocol::server_info(&self.name, &self.session),
            protocol::time(state.time_ns),
            protocol::advertise(advertised.map(|(index, _)| (index, &TOPICS[index]))),
            protocol::advertise_services(),
        ];
        state.joined += 1;
        let id = state.joined;
        state.clients.insert(id, Client { frames: frames.into(), ..Client::default() });
        id
    }

    /// A client has gone.
    pub fn leave(&self, id: u64) {
        self.lock().clients.remove(&id);
        self.changed.notify_all();
    }

    /// The frames that a client has yet to be sent, and whether these are the last.
    pub fn frames(&self, id: u64) -> (VecDeque<Frame>, bool) {
        let mut state = self.lock();
        let closing = state.closing;
        let frames = state.clients.get_mut(&id).map(|client| std::mem::take(&mut client.frames));
        self.changed.notify_all();
        (frames.unwrap_or_default(), closing)
    }

    /// Does what a client asks.
    pub fn answer(&self, id: u64, frame: &Frame) {
        let mut state = self.lock();
        match Request::read(frame) {
            Ok(request) => state.answer(id, request),
            Err(why) => state.send(id, protocol::status(Level::Error, &why)),
        }
        self.changed.notify_all();
    }

    /// How many clients there are.
    pub fn clients(&self) -> usize {
        self.lock().clients.len()
    }

    /// Whether the clients are being sent away.
    pub fn closing(&self) -> bool {
        self.lock().closing
    }

    /// Sends the clients what is left, then away, and waits some time for them to go.
    pub fn close(&self, at_most: Duration) {
        let began = WallInstant::now();
        let mut state = self.lock();
        state.closing = true;
        while !state.clients.is_empty() && began.elapsed() < at_most {
            state = self.wait(state, LOOK);
        }
    }
}

/// Gives the messages of the run to all clients who subscribed to them. None is lost: the run waits for the slowest.
pub struct Publisher(pub Arc<Hub>);

impl Messages for Publisher {
    fn take(&mut self, message: Message<'_>) -> Result<(), RecordError> {
        let mut state = self.0.lock();
        while state.clients.values().any(|client| client.frames.len() >= MOST_FRAMES) && !stop::asked() {
            state = self.0.wait(state, LOOK);
        }
        state.publish(message);
        Ok(())
    }
}

impl State {
    fn change(&mut self, change: impl FnOnce(&mut Clock)) {
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

    fn publish(&mut self, message: Message<'_>) {
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

    fn send(&mut self, id: u64, frame: Frame) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.frames.push_back(frame);
        }
    }

    fn answer(&mut self, id: u64, request: Request) {
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
