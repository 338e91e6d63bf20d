//! The engine of flexsc: attitude control of flexible spacecraft, simulated exactly.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.
//!
//! A [`Scenario`] is the validated input; a [`Simulation`] is the state of one run; a [`record::Record`] receives all
//! output. Within a run data flows in one direction:
//!
//! ```text
//! body --truth--> sensor --reading--> estimator --estimate--> law --hold--> actuator --wrench--> body
//!                                                              ^                ^
//!                        envelope --mean--> adaptation --------+                |
//!                   manoeuvre or target --goal-----------------+--waveform------+
//! ```
//!
//! Modal dynamics live in [`dynamics`], sensors, observers, laws and adaptation in [`control`], the run in [`Simulation`];
//! this crate re-exports them and adds campaigns, batches and metrics.
//!
//! One loop runs one-axis and three-axis bodies (relay runs of one axis may run in the kernel of `flexsc_relay_kernel`
//! instead, with the same records); each axis has an estimate, a law and a goal. Each role is a trait:
//! [`control::sensor::Sensor`], [`control::estimator::Estimator`], [`control::law::Law`],
//! [`control::actuator::Actuator`]. [`prelude`] has the names that most programs need; the other crates of the engine
//! are re-exported under their own names. `docs/extending.md` describes how to add a kind, and `crates/core/examples`
//! has short programs that use this crate.
//!
//! ```
//! use flexsc_core::prelude::*;
//!
//! let scenario = Scenario::parse("relay.toml", r#"
//!     duration = 100.0                  # s
//!     [body.planar]
//!     angle = 4.5e-4                    # rad
//!     rate = 2.2e-5                     # rad/s
//!     [law.relay]
//!     dead_zone = 5e-4                  # rad
//!     hysteresis = 1e-4                 # rad
//!     strong = 4e-5                     # rad/s²
//!     weak = 1e-6                       # rad/s²
//!     k_t = 0.31
//! "#)?;
//! let mut trace = Trace::new(Detail::Events);
//! Simulation::new(&scenario, 0).run(&mut trace)?;
//! let switchings = trace.topic("/command").expect("a topic of every log");
//! assert_eq!(switchings.len(), 15); // six in each cycle of 44 s
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod answer;
pub mod batch;
pub mod campaign;
pub mod frames;
pub mod metrics;
pub mod prelude;
pub mod requirement_verdict;
pub mod statistics;
pub mod worst_case;

#[doc(inline)]
pub use flexsc_analysis as analysis;
#[doc(inline)]
pub use flexsc_control as control;
#[doc(inline)]
pub use flexsc_dynamics as dynamics;
#[doc(inline)]
pub use flexsc_formats as formats;
#[doc(inline)]
pub use flexsc_numerics as numerics;
pub use flexsc_numerics::order_statistics;
#[doc(inline)]
pub use flexsc_record as record;
#[doc(inline)]
pub use flexsc_scenario as scenario;
pub use flexsc_scenario::uncertain;
#[doc(inline)]
pub use flexsc_spacecraft as spacecraft;

pub use flexsc_formats::document::{Diagnostic, Document, LONGEST, ScenarioError, nearest};
pub use flexsc_scenario::Scenario;
pub use flexsc_sim::{
    ControlCall, ControlDecision, KnownRotors, ModeTrial, QuantityField, QuantityGroup, SensorSample,
    SensorTelemetry, Simulation, SimulationError, StopAt, Telemetry, TelemetryLayout, TelemetrySensor,
    UnloadingCall,
};
