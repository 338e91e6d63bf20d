//! Where the run and the clients of a live run meet.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::record::{Message, Messages, RecordError};
use flexsc_core::time::Instant;

use super::clock::{Clock, LOOK};
use super::outbox::Frame;
use super::protocol::{self, Level, Request};
use super::state::State;
use crate::stop;

/// There are at most so many clients.
pub const MOST_CLIENTS: usize = 16;

/// What the run and the clients share.
pub struct Hub {
    greeting: Frame,
    state: Mutex<State>,
    changed: Condvar,
    seats: Arc<AtomicUsize>,
}

/// One of the places for clients: free again when it is dropped.
pub struct Seat(Arc<AtomicUsize>);

impl Seat {
    fn of(count: &Arc<AtomicUsize>, most: usize) -> Option<Self> {
        let more = |taken: usize| (taken < most).then_some(taken + 1);
        let taken = count.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more);
        taken.is_ok().then(|| Self(count.clone()))
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Hub {
    /// A hub for a run of this name.
    pub fn new(name: &str, state: State) -> Self {
        let session = format!("{name}-{}", std::process::id());
        let greeting = protocol::server_info(name, &session);
        Self { greeting, state: Mutex::new(state), changed: Condvar::new(), seats: Arc::default() }
    }

    /// A place for a client, if there is one.
    pub fn seat(&self) -> Option<Seat> {
        Seat::of(&self.seats, MOST_CLIENTS)
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

    /// Changes the clock, notifies the clients who follow it, and returns it.
    pub fn change(&self, change: impl FnOnce(&mut Clock)) -> Clock {
        let mut state = self.lock();
        state.change(change);
        self.changed.notify_all();
        state.clock.clone()
    }

    /// A client has come; its number.
    pub fn join(&self) -> u64 {
        self.lock().join(self.greeting.clone())
    }

    /// A client has gone.
    pub fn leave(&self, id: u64) {
        self.lock().clients.remove(&id);
        self.changed.notify_all();
    }

    /// The next frames that a client is to be sent, and whether they are the last; nothing for one that is sent away.
    pub fn frames(&self, id: u64) -> Option<(VecDeque<Frame>, bool)> {
        let mut state = self.lock();
        let closing = state.closing;
        let outbox = &mut state.clients.get_mut(&id)?.outbox;
        let frames = outbox.take()?;
        let last = closing && outbox.is_empty();
        self.changed.notify_all();
        Some((frames, last))
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

    /// The run has ended.
    pub fn end(&self) {
        self.lock().ended = true;
    }

    /// Whether the run has ended.
    pub fn ended(&self) -> bool {
        self.lock().ended
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
        while state.clients.values().any(|client| client.outbox.is_full()) && !stop::asked() {
            state = self.0.wait(state, LOOK);
        }
        state.publish(message);
        Ok(())
    }
}
