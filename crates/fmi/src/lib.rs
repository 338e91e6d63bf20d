//! Library of flexsc's FMUs: the C functions of FMI 3.0 and FMI 2.0 for co-simulation, over one run in safe Rust. One
//! library serves every scenario: an instance reads its own from the resources of its FMU.

mod boundary;
mod fmi2;
mod fmi2_values;
mod fmi3;
mod fmi3_clocks;
mod fmi3_states;
mod fmi3_steps;
mod fmi3_values;
mod instance;
mod logger;
mod other_interfaces;
mod resource_location;
