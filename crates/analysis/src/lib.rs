//! Analyses of a scenario or a run: linear models, mode tables, limit cycles, stability.

pub mod body_poles;
pub mod bound;
pub mod budget;
pub mod damping;
pub mod describing_function;
pub mod eigenvalues;
pub mod fine_mirror;
pub mod identification;
pub mod limit_cycle;
pub mod linear_attitude_filter;
pub mod linear_loop;
pub mod linear_model;
pub mod margins;
pub mod mode_influence;
pub mod noise;
pub mod one_axis_modes;
pub mod open_loop;
pub mod pulse_describing_function;
pub mod rigid_cycle;
pub mod sampled_loop;
pub mod scenario_margins;
pub mod settling_time;
pub mod spacecraft_modes;
pub mod state_space;
pub mod structured_tuning;
