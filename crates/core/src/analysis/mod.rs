//! Analyses of a scenario or a run: linear models, mode tables, limit cycles, stability.

pub mod attitude_parts;
pub mod cycle;
pub mod damping;
pub mod identification;
pub mod influence;
pub mod linear_model;
pub mod loop_parts;
pub mod modal;
pub mod parts;
pub mod rigid_cycle;
pub mod sampled_loop;
