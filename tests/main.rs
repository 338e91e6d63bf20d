//! All integration tests of flexsc, one binary.

mod relay;
