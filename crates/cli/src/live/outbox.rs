//! What a client has yet to be sent, and how much of it there may be.

use std::collections::VecDeque;

/// The run waits for a client that has so much yet to take (bytes).
const FULL: usize = 4 << 20;
/// What is no message of the run does not wait: a client with so much (bytes) is sent away.
const OVERFULL: usize = 2 * FULL;
/// So much is sent at a time (bytes).
const BATCH: usize = 256 << 10;
/// What a frame costs beside its content (bytes).
const FRAME: usize = 64;

/// A frame of the protocol.
pub type Frame = tungstenite::Message;

/// Frames in their order.
#[derive(Default)]
pub struct Outbox {
    frames: VecDeque<Frame>,
    bytes: usize,
    /// Whether it was overfull.
    overflowed: bool,
}

impl Outbox {
    /// Adds a frame.
    pub fn push(&mut self, frame: Frame) {
        if self.overflowed {
            return;
        }
        self.bytes += frame.len() + FRAME;
        // A single frame may be as large as it is.
        self.overflowed = self.bytes > OVERFULL && !self.frames.is_empty();
        self.frames.push_back(frame);
        if self.overflowed {
            (self.frames, self.bytes) = (VecDeque::new(), 0);
        }
    }

    /// The first frames; nothing if it was overfull.
    pub fn take(&mut self) -> Option<VecDeque<Frame>> {
        let (mut count, mut bytes) = (0, 0);
        while let Some(frame) = self.frames.get(count).filter(|_| bytes < BATCH) {
            bytes += frame.len() + FRAME;
            count += 1;
        }
        self.bytes -= bytes;
        let rest = self.frames.split_off(count);
        (!self.overflowed).then(|| std::mem::replace(&mut self.frames, rest))
    }

    /// Whether the run has to wait.
    pub fn is_full(&self) -> bool {
        self.bytes >= FULL
    }

    /// Whether there is nothing.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_waits_is_bounded() {
        let frame = |bytes: usize| Frame::binary(vec![0; bytes - FRAME]);
        let mut outbox = Outbox::default();
        for _ in 0..31 {
            outbox.push(frame(FULL / 32));
        }
        assert!(!outbox.is_full());
        outbox.push(frame(FULL / 32));
        assert!(outbox.is_full());
        let taken = outbox.take().expect("frames");
        assert_eq!(taken.len(), 2, "a batch");
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
