//! All integration tests of flexsc, one binary.

mod adaptation;
mod bad_manoeuvres;
mod bad_scenarios;
mod campaigns;
mod cli;
mod cycles;
mod determinism;
mod events;
mod filters;
mod layout;
mod logs;
mod loops;
mod manoeuvres;
mod plan;
mod plan_figures;
mod plot;
mod relay;
mod rivals;
mod rotation;
mod spacecraft;
mod stops;
mod structure;
mod study;
mod util;
mod waveforms;
mod wheel;
