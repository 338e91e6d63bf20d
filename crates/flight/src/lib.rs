//! Plain control laws, filters and their mathematics: no heap, no unsafe code, and no panic that can be reached.
//!
//! The engine calls these functions, and `flexsc export-c` translates them to C99, so that a law that was studied is the law that
//! flies, to the bit. For that every file directly in `src` but this one is written in a subset of Rust: structs of numbers,
//! arrays and such structs, enums without data, plain loops and branches. `docs/flight-code.md` describes it, and the
//! translator refuses whatever is outside of it. Functions of mathematics return the bits of the crate `libm` on every
//! processor that rounds as IEEE 754 prescribes; NaN counts as one value.

#![no_std]
#![allow(
    clippy::manual_memcpy,
    clippy::neg_cmp_op_on_partial_ord,
    clippy::range_plus_one,
    clippy::return_self_not_must_use,
    clippy::struct_excessive_bools,
    clippy::trivially_copy_pass_by_ref,
    reason = "plain structs and comparisons that also stop at NaN translate to plain C"
)]

#[cfg(any(test, feature = "std"))]
extern crate std;

pub mod active_damping;
pub mod argument_reduction;
pub mod attitude_estimator;
pub mod attitude_filter;
pub mod attitude_gate;
pub mod attitude_history;
pub mod attitude_law;
pub mod attitude_observation;
pub mod axis_motion;
pub mod b_dot;
pub mod binary64;
pub mod biquad;
pub mod compensator;
pub mod covariance_propagation;
pub mod delayed_observation;
pub mod error_measure;
pub mod exponentials;
pub mod filter_lock;
pub mod gain_schedule;
pub mod guard;
pub mod hypotenuse;
pub mod integer_square_root;
pub mod inverse_trigonometry;
pub mod jet_pulses;
pub mod kalman;
pub mod kalman_axis;
pub mod magnetorquers;
pub mod maths;
pub mod matrix3;
pub mod matrix6;
pub mod mode_condition;
pub mod mode_readings;
pub mod mode_supervisor;
pub mod momentum_unloading;
pub mod payne_hanek;
pub mod pd;
pub mod phase_plane;
pub mod pulse_timing;
pub mod pulse_width;
pub mod quaternion;
pub mod reading_judgement;
pub mod reading_status;
pub mod relay;
pub mod rigid_rate;
// The translator takes `square_root.rs`.
#[cfg_attr(feature = "std", path = "processor/square_root.rs")]
pub mod square_root;
pub mod stumpff;
pub mod supervised_mode;
pub mod switching_lines;
pub mod ticks;
pub mod torque_distribution;
pub mod trigonometry;
pub mod vector3;
pub mod wheel_allocation;
pub mod wheel_momentum;

#[cfg(test)]
mod comparison;
