//! All integration tests of flexsc, one binary.

mod accelerometers;
mod active_damping;
mod adaptation;
mod adaptive;
mod attitude_filter;
mod axes;
mod bad_files;
mod bad_manoeuvres;
mod bad_scenarios;
mod bad_spatial;
mod bad_structures;
mod bearings;
mod beside;
mod calculix;
mod campaign_figures;
mod campaigns;
mod cli;
mod combinations;
mod convergence;
#[cfg(target_os = "linux")]
mod costs;
mod coupled;
mod craft;
mod craft_written;
mod cycles;
mod damping;
mod damping_relay;
mod determinism;
mod documented;
mod drawing;
mod drifting_axes;
mod drives;
mod earth_observer;
mod envelopes;
mod environment;
mod events;
mod exact;
mod exposure;
mod extending;
mod extremes;
mod failures;
mod filters;
mod forces;
mod foreign;
#[cfg(feature = "full")]
mod foreign_campaigns;
mod foreign_logs;
mod frozen;
#[cfg(all(unix, feature = "live"))]
mod fuzz_corpus;
mod gimbals;
mod habits;
mod help;
mod hinges;
mod imbalance;
mod jets;
mod layout;
#[cfg(not(feature = "full"))]
mod light;
mod linear;
mod linear_poles;
#[cfg(feature = "live")]
mod live;
#[cfg(feature = "live")]
mod live_limits;
mod logs;
mod loops;
mod lqg;
mod magnetic;
mod manoeuvres;
mod model;
mod newcomers;
mod objectives;
mod outside;
mod own_parts;
#[cfg(feature = "parquet")]
mod paper_figures;
mod parts;
#[cfg(all(unix, feature = "parquet"))]
mod parts_killed;
mod places;
mod plan;
mod plan_figures;
mod plants;
mod plot;
mod relay;
mod reproduce;
mod results;
mod rivals;
mod rooms;
mod rotation;
mod saturation;
mod scene;
mod several_actuators;
mod several_sensors;
mod shaped;
mod sheets;
mod spacecraft;
mod spatial;
mod state_space;
mod station;
mod stepping;
mod stops;
#[cfg(unix)]
mod stops_soon;
mod structure;
mod study;
mod summaries;
mod swinging;
mod traces;
mod tuning;
mod typos;
mod units;
mod unloading;
mod unwatched;
mod util;
#[cfg(feature = "live")]
mod viewer;
mod waveforms;
mod wheel;
mod wheel_figures;
mod words;
