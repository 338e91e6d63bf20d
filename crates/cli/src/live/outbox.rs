//! Queue of the frames for a client, with limits of its size.

use std::collections::VecDeque;

/// Size of the queue (bytes) above which the run waits for the client.
const FULL: usize = 4 << 20;
/// Size (bytes) above which the client is disconnected: frames that are not messages of the run do not wait.
const OVERFULL: usize = 2 * FULL;
/// Size of a batch of frames (bytes).
const BATCH: usize = 256 << 10;
/// Overhead of a frame in addition to its content (bytes).
const FRAME: usize = 64;

/// Frame of the protocol.
pub type OutgoingFrame = tungstenite::Message;

/// Queue of frames for a client.
#[derive(Default)]
pub struct Outbox {
    frames: VecDeque<OutgoingFrame>,
    bytes: usize,
    /// True if the queue has exceeded [`OVERFULL`].
    overflowed: bool,
}

impl Outbox {
    /// Appends a frame.
    pub fn push(&mut self, frame: OutgoingFrame) {
        if self.overflowed {
            return;
        }
        self.bytes += frame.len() + FRAME;
        // A single frame may have any size.
        self.overflowed = self.bytes > OVERFULL && !self.frames.is_empty();
        self.frames.push_back(frame);
        if self.overflowed {
            (self.frames, self.bytes) = (VecDeque::new(), 0);
        }
    }

    /// Removes and returns the next batch of frames; `None` after an overflow.
    pub fn take(&mut self) -> Option<VecDeque<OutgoingFrame>> {
        let (mut count, mut bytes) = (0, 0);
        while let Some(frame) = self.frames.get(count).filter(|_| bytes < BATCH) {
            bytes += frame.len() + FRAME;
            count += 1;
        }
        self.bytes -= bytes;
        let rest = self.frames.split_off(count);
        (!self.overflowed).then(|| std::mem::replace(&mut self.frames, rest))
    }

    /// Returns true if the run has to wait.
    pub fn is_full(&self) -> bool {
        self.bytes >= FULL
    }

    /// Returns true if the queue is empty.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_waits_is_bounded() {
        let frame = |bytes: usize| OutgoingFrame::binary(vec![0; bytes - FRAME]);
        let mut outbox = Outbox::default();
        for _ in 0..31 {
            outbox.push(frame(FULL / 32));
        }
        assert!(!outbox.is_full());
        outbox.push(frame(FULL / 32));
        assert!(outbox.is_full());
        let frames = outbox.take().expect("frames");
        assert_eq!(frames.len(), 2, "a batch");
        assert!(!outbox.is_full() && !outbox.is_empty());
        for _ in 0..32 {
            outbox.push(frame(FULL / 32));
        }
        assert!(outbox.take().is_some());
        for _ in 0..4 {
            outbox.push(frame(FULL / 32));
        }
        assert!(outbox.take().is_some(), "as much as there may be");
        for _ in 0..3 {
            outbox.push(frame(FULL / 32));
        }
        assert!(outbox.take().is_none() && outbox.is_empty() && !outbox.is_full(), "sent away");
        let mut outbox = Outbox::default();
        outbox.push(frame(2 * OVERFULL));
        assert_eq!(outbox.take().expect("a frame").len(), 1);
    }
}
