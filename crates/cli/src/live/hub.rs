//! Where the run and the clients of a live run meet.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::record::{Message, Messages, RecordError};
use flexsc_core::time::Instant;

use super::clock::{Clock, LOOK};
use super::protocol::{self, Level, Request};
use super::state::{Frame, State};
use crate::stop;

/// The run waits for a client that has so many frames yet to take.
const MOST_FRAMES: usize = 8192;

/// What the run and the clients share.
pub struct Hub {
    greeting: Frame,
    state: Mutex<State>,
    changed: Condvar,
}

impl Hub {
    /// A hub for a run of this name.
    pub fn new(name: &str, state: State) -> Self {
        let session = format!("{name}-{}", std::process::id());
        let greeting = protocol::server_info(name, &session);
        Self { greeting, state: Mutex::new(state), changed: Condvar::new() }
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
        self.lock().join(self.greeting.clone())
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
