//! State shared by the run and the clients of a live run.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{LogTopic, Message, MessageSink, RecordError};

use super::clock::{Clock, POLL_PERIOD};
use super::outbox::OutgoingFrame;
use super::protocol::{self, Request, StatusLevel};
use super::server_state::ServerState;
use crate::stop;

/// Largest number of clients.
pub const MOST_CLIENTS: usize = 16;

/// State shared by the run and its clients.
pub struct Hub {
    greeting: OutgoingFrame,
    state: Mutex<ServerState>,
    changed: Condvar,
    seats: Arc<AtomicUsize>,
}

/// One of the places for clients, which is free again when this is dropped.
pub struct ClientSlot(Arc<AtomicUsize>);

impl ClientSlot {
    fn new(count: &Arc<AtomicUsize>, most: usize) -> Option<Self> {
        let more = |clients: usize| (clients < most).then_some(clients + 1);
        let seat = count.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more);
        seat.is_ok().then(|| Self(count.clone()))
    }
}

impl Drop for ClientSlot {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Hub {
    /// Creates a hub for a run of this name.
    pub fn new(name: &str, state: ServerState) -> Self {
        let session = format!("{name}-{}", std::process::id());
        let greeting = protocol::server_info(name, &session);
        Self { greeting, state: Mutex::new(state), changed: Condvar::new(), seats: Arc::default() }
    }

    /// Returns a place for a client if one is free.
    pub fn seat(&self) -> Option<ClientSlot> {
        ClientSlot::new(&self.seats, MOST_CLIENTS)
    }

    fn lock(&self) -> MutexGuard<'_, ServerState> {
        // The state is consistent after every statement, so that a poisoned lock can be used.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, state: MutexGuard<'a, ServerState>, at_most: Duration) -> MutexGuard<'a, ServerState> {
        let woken = self.changed.wait_timeout(state, at_most);
        woken.unwrap_or_else(PoisonError::into_inner).0
    }

    /// Blocks the run until its clock releases an instant.
    pub fn pace(&self, time: Instant) -> Result<(), RecordError> {
        let mut state = self.lock();
        while let Some(time) = state.clock.wait(time, WallInstant::now()) {
            if stop::stop_requested() {
                return Err(RecordError::Interrupted);
            }
            state = self.wait(state, time);
        }
        Ok(())
    }

    /// Changes the clock, notifies the clients that subscribed to it, and returns it.
    pub fn change(&self, change: impl FnOnce(&mut Clock)) -> Clock {
        let mut state = self.lock();
        state.change(change);
        self.changed.notify_all();
        state.clock.clone()
    }

    /// Registers a client, and returns its number.
    pub fn join(&self) -> u64 {
        self.lock().join(self.greeting.clone())
    }

    /// Removes a client.
    pub fn leave(&self, id: u64) {
        self.lock().clients.remove(&id);
        self.changed.notify_all();
    }

    /// Returns the next frames for a client, and true if they are the last; `None` if the client is to be disconnected.
    pub fn frames(&self, id: u64) -> Option<(VecDeque<OutgoingFrame>, bool)> {
        let mut state = self.lock();
        let closing = state.closing;
        let outbox = &mut state.clients.get_mut(&id)?.outbox;
        let frames = outbox.take()?;
        let last = closing && outbox.is_empty();
        self.changed.notify_all();
        Some((frames, last))
    }

    /// Handles a request of a client.
    pub fn answer(&self, id: u64, frame: &OutgoingFrame) {
        let mut state = self.lock();
        match Request::read(frame) {
            Ok(request) => state.answer(id, request),
            Err(why) => state.send(id, protocol::status(StatusLevel::Error, &why)),
        }
        self.changed.notify_all();
    }

    /// Marks the run as ended.
    pub fn end(&self) {
        self.lock().ended = true;
    }

    /// Returns true if the run has ended.
    pub fn ended(&self) -> bool {
        self.lock().ended
    }

    /// Returns the number of clients.
    pub fn clients(&self) -> usize {
        self.lock().clients.len()
    }

    /// Returns true if the clients are being disconnected.
    pub fn closing(&self) -> bool {
        self.lock().closing
    }

    /// Sends the clients the remaining frames, disconnects them, and waits for at most `at_most`.
    pub fn close(&self, at_most: Duration) {
        let began = WallInstant::now();
        let mut state = self.lock();
        state.closing = true;
        while !state.clients.is_empty() && began.elapsed() < at_most {
            state = self.wait(state, POLL_PERIOD);
        }
    }
}

/// Record that sends a run's messages to all subscribed clients, without loss: the run waits for the slowest client.
pub struct Publisher(pub Arc<Hub>);

impl MessageSink for Publisher {
    fn declare(&mut self, _: usize, topic: LogTopic<'_>) -> Result<(), RecordError> {
        self.0.lock().declare(topic);
        Ok(())
    }

    fn push(&mut self, message: Message<'_>) -> Result<(), RecordError> {
        let mut state = self.0.lock();
        while state.clients.values().any(|client| client.outbox.is_full()) && !stop::stop_requested() {
            state = self.0.wait(state, POLL_PERIOD);
        }
        state.publish(message);
        Ok(())
    }
}
