//! All integration tests of flexsc, one binary.
//!
//! The modules by topic, in the order below:
//!
//! - motion: physics against oracles, closed forms and invariants;
//! - control: laws, estimators, actuators, adaptation and manoeuvres, alone and in the loop;
//! - semantics of the loop: instants, records, pieces, batches, failures, custom parts, every combination;
//! - formats: scenarios, structures, results and logs, and what is refused;
//! - command: verbs, campaigns, figures, limits and live runs;
//! - rules of the house: sources, words, habits, and bytes that do not change;
//! - helpers of the tests.

// Motion: physics against oracles, closed forms and invariants.
mod accelerometers;
mod axes;
mod calculix;
mod coupled;
mod craft;
mod crossings;
mod day_balance;
mod drifting_axes;
mod drives;
mod eclipses;
mod environment;
mod field_models;
mod forces;
mod frequency_factor;
mod gimbals;
mod hinges;
mod image_requirements;
mod imbalance;
mod import_page;
mod initial_motion;
mod invariants;
mod line_of_sight;
mod linear;
mod linear_poles;
mod model;
mod mounts;
mod orbit_rows;
mod orbits;
mod outside;
mod rotation;
mod small_angle_readings;
mod small_angles;
mod spacecraft;
mod spatial;
mod structure;
mod waveforms;
mod wheel;

// Control: laws, estimators, actuators, adaptation and manoeuvres, alone and in the loop.
mod active_damping;
mod adaptation;
mod adaptive;
mod attitude_filter;
mod bearings;
mod blinding;
mod budget_levels;
mod conflicts;
mod convergence;
mod cycles;
mod damaged_fe_results;
mod damping;
mod damping_relay;
mod earth_observer;
mod envelopes;
mod exposure;
mod filters;
mod fine_mirror;
mod goals;
mod isolators;
mod jets;
mod linear_budgets;
mod loads;
mod loops;
mod lqg;
mod machines;
mod magnetic;
mod manoeuvres;
mod margins;
mod measured_paths;
mod mode_conditions;
mod mode_laws;
mod objectives;
mod open_loops;
mod operation;
mod plants;
mod pulse_cycles;
mod relay;
mod rivals;
mod saturation;
mod settling_times;
mod several_actuators;
mod several_sensors;
mod shaped;
mod spectra;
mod stability_limit;
mod stage_actuators;
mod state_space;
mod station;
mod structured_tuning;
mod swinging;
mod target_losses;
mod tuning;
mod unloading;

// Semantics of the loop: instants, records, pieces, batches, failures, custom parts, every combination.
mod beside;
mod bound;
mod combination_tables;
mod combinations;
mod compare;
mod determinism;
mod events;
mod exact;
mod failures;
mod fault_campaigns;
mod kinds;
mod own_parts;
mod properties;
mod public_files;
mod stepping;
mod unwatched;

// Formats: scenarios, structures, results and logs, and what is refused.
mod bad_arguments;
mod bad_files;
mod bad_manoeuvres;
mod bad_results;
mod bad_scenarios;
mod bad_spatial;
mod bad_structures;
mod boundary_values;
mod craft_written;
mod documented;
#[cfg(feature = "flight-code")]
mod flight_analysis;
#[cfg(feature = "flight-code")]
mod flight_code;
#[cfg(feature = "flight-code")]
mod flight_cubesat;
#[cfg(feature = "flight-code")]
mod flight_exports;
#[cfg(feature = "flight-code")]
mod flight_guests;
#[cfg(feature = "flight-code")]
mod flight_lockstep;
#[cfg(feature = "flight-code")]
mod flight_pages;
#[cfg(feature = "flight-code")]
mod flight_parameters;
#[cfg(feature = "flight-code")]
mod flight_rust;
#[cfg(feature = "flight-code")]
mod flight_single;
mod foreign;
#[cfg(feature = "full")]
mod foreign_campaigns;
mod foreign_logs;
#[cfg(all(unix, feature = "live"))]
mod fuzz_corpus;
mod layout;
mod logs;
mod magnitudes;
mod misspelt_units;
mod results;
mod scene;
mod typos;
mod units;

// Command: verbs, campaigns, figures, limits and live runs.
mod answers;
mod campaign_figures;
mod campaigns;
mod check;
mod cli;
#[cfg(target_os = "linux")]
mod correlated_loads;
mod costs;
mod cubesat;
mod density_tables;
mod extremes;
mod help;
#[cfg(all(target_os = "linux", feature = "parquet"))]
mod io_faults;
#[cfg(not(feature = "full"))]
mod light;
#[cfg(feature = "live")]
mod live;
#[cfg(feature = "live")]
mod live_limits;
mod newcomers;
mod optics;
mod option_units;
#[cfg(feature = "parquet")]
mod paper_figures;
mod parts;
#[cfg(all(unix, feature = "parquet"))]
mod parts_killed;
mod places;
mod plan;
mod plan_figures;
mod plate_mode;
mod plates;
mod plot;
mod point_noise;
#[cfg(feature = "full")]
mod repeated_runs;
mod report;
mod reproduce;
mod requirements;
mod requirements_over_time;
mod run_figures;
#[cfg(unix)]
mod sanitizers;
#[cfg(all(unix, feature = "parquet"))]
mod scheduler;
mod serve;
mod serve_clients;
mod serve_faults;
mod sheets;
mod sky_combinations;
mod stops;
#[cfg(unix)]
mod stops_soon;
mod summaries;
mod verb_figures;
mod wheel_figures;

// Rules of the house: sources, words, habits, and bytes that do not change.
#[cfg(feature = "fmu")]
mod export_fmu;
mod extending;
mod extending_verbs;
mod frames;
mod frozen;
mod habits;
#[cfg(feature = "handover")]
mod handover;
#[cfg(feature = "handover")]
mod handover_glb;
#[cfg(feature = "handover")]
mod handover_vizard;
mod rooms;
mod words;
mod worst;

// Helpers of the tests.
mod control_client;
mod drawing;
mod study;
mod traces;
mod util;
#[cfg(feature = "live")]
mod viewer;
