//! All integration tests of flexsc, one binary.

mod active_damping;
mod adaptation;
mod adaptive;
mod bad_files;
mod bad_manoeuvres;
mod bad_scenarios;
mod bad_spatial;
mod bad_structures;
mod campaign_figures;
mod campaigns;
mod cli;
mod convergence;
mod cycles;
mod damping;
mod damping_relay;
mod determinism;
mod documented;
mod drawing;
mod events;
mod filters;
#[cfg(all(unix, feature = "live"))]
mod fuzz_corpus;
mod layout;
#[cfg(feature = "live")]
mod live;
mod logs;
mod loops;
mod manoeuvres;
mod plan;
mod plan_figures;
mod plot;
mod relay;
mod reproduce;
mod rivals;
mod rotation;
mod scene;
mod spacecraft;
mod spatial;
mod station;
mod stops;
mod structure;
mod study;
mod tuning;
mod util;
#[cfg(feature = "live")]
mod viewer;
mod waveforms;
mod wheel;
mod wheel_figures;
