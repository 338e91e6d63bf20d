//! All integration tests of flexsc, one binary.

mod events;
mod relay;
