//! Plain control laws and filters: no heap, no unsafe code, and no panic that can be reached.
//!
//! The engine calls these functions, and `flexsc export-c` translates them to C99, so that a law that was studied is the law that
//! flies, to the bit. For that every file but this one is written in a subset of Rust: structs of numbers, arrays and
//! such structs, enums without data, plain loops and branches. `docs/flight-code.md` describes it; a test of the translator
//! refuses whatever is outside of it.
#![cfg_attr(not(feature = "std"), no_std)]

pub mod active_damping;
pub mod attitude_filter;
pub mod attitude_history;
pub mod attitude_law;
pub mod attitude_observation;
pub mod biquad;
pub mod covariance_propagation;
pub mod error_measure;
pub mod gain_schedule;
pub mod guard;
pub mod inverse_trigonometry;
pub mod maths;
pub mod matrix3;
pub mod matrix6;
pub mod pd;
pub mod phase_plane;
pub mod pulse_timing;
pub mod pulse_width;
pub mod quaternion;
pub mod relay;
pub mod stumpff;
pub mod switching_lines;
pub mod ticks;
pub mod torque_distribution;
pub mod trigonometry;
pub mod vector3;
pub mod wheel_allocation;
