//! Three-axis dynamics of a flexible body with rotors, with two-way coupling between body and modes.
//!
//! With free modes W, phi, the total angular momentum H about the centre of mass in the hub's axes, rotors a h, the
//! change J1 of the inertia and the canonical rates P of the modes, in which torques, rotors and w x H do not appear:
//!
//! ```text
//! G = H - sum a h,   Gt = G - J1(q) w,   w = J^-1 Gt + phi q',   H' = T - w x H,
//! q' = P + phi' Gt,   P' = -W² q - D q' + 1/2 [w' J1_i w] + f.
//! ```
//!
//! The state is integrated in mean axes, which the modes do not rotate: Q = Q_m o exp(th) and H = exp(-\[th\]) H_m with
//! th = sum phi q. The method is Gauss-Legendre of order 6, which preserves |H| and |Q|, with the modes as exact
//! oscillators between the nodes (\[HairerLubichWanner06\], \[Likins70\]). Steps lie on a grid that depends only on the
//! start of the segment; an instant between grid points is reached by one shorter off-grid step, so that observation
//! does not change the motion.
//!
//! A prime at a state (q', P', H', th', h') is a time derivative; at a factor in front of another (phi' Gt, w' J1 w) it
//! is a transpose. `x` is the cross product and \[v\] its matrix, \[v\] u = v x u; \[c_i\] is the vector of the values c_i of
//! all modes; `o` is the product of quaternions.
//!
//! | symbol | name in the code | unit |
//! |---|---|---|
//! | G = H - sum a h | `body_momentum` | N m s |
//! | Gr, with Gr th' the rate of the hub against the mean axes | `rate_correction` of `small_rotation.rs` returns (1 - Gr) th' | - |
//! | A, b; h of a step | `MATRIX`, `WEIGHTS` of `gauss_legendre`; `h` | -; s |
//! | D = 2 zeta W on the diagonal | `damping` of a mode | 1/s |
//! | u = h', torque on a rotor | `torque` of a `Rotor` | N m |
//! | Q_m; Q | `mean_attitude`; `attitude` of the view | unit quaternion |
//! | H_m; H_m'; H | `mean_momentum`; `momentum_rate`; `momentum` of the view | N m s; N m; N m s |
//! | w; w_m; J^-1 Gt | `rate` of the hub; `mean_rate`; `rigid_rate` | rad/s |
//! | Gt; integral of J^-1 Gt | `rigid_momentum`; `rigid_angle` | N m s; rad |
//! | J; J^-1; J_left | `inertia`; `inverse`; `residual_inertia` | kg m²; 1/(kg m²); kg m² |
//! | J1(q); J1_i | `inertia_change`; `moments` of a mode | kg m²; sqrt(kg) m |
//! | W; zeta; phi; sum phi phi' | `frequency`; `damping`; `rotation` of a mode; `bending` | rad/s; -; rad/(m sqrt(kg)); 1/(kg m²) |
//! | q; q'; P | `displacements`; `rates`; state of a mode as (q, P/W) | m sqrt(kg); m sqrt(kg)/s |
//! | th = sum phi q; sum phi P; sum phi q' = w - J^-1 Gt | `elastic_rotation`; `canonical_elastic_rate`; `elastic_rate` | rad; rad/s; rad/s |
//! | g = phi' Gt; s | `g`; `s` of a mode at the nodes: imposed rate, force that varies over a step | m sqrt(kg)/s; N/sqrt(kg) |
//! | off-diagonal D; f | `coupled_damping`; `forces` | 1/s; N/sqrt(kg) |
//! | a, h; h of gimbals | `rotors`; `gimbal_momentum` | N m s |
//! | T; torque per q of a moving point of application | `torque`; `force_arms` | N m; N/sqrt(kg) |
//! | position and velocity of the centre of mass; F/m | `com`; `com_acceleration` | m, m/s; m/s² |
//!
//! One step of `h`:
//!
//! ```text
//! start    sums over the modes -> Gt, w, w_m, H_m' at the start; g and s of each mode     (kept until the state changes)
//! predict  q and P at the three nodes and the end, freely and under constant forces; Gt grows by its rate at the start
//! repeat   q, P at the nodes += exact response to the parabolas through g and s at the nodes
//!          th, sum phi P, J1 = sums over the modes; H_m at the nodes = H_m + h A H_m'
//!          G = exp(-[th]) H_m - sum a h;  solve (J_left + J1) w = G + J_left phi P;  Gt = G - J1 w
//!          w_m = exp([th]) (J^-1 Gt + (1 - Gr)(w - J^-1 Gt));  H_m' = exp([th]) T - w_m x H_m
//!          g = phi' Gt;  s = 1/2 [w' J1_i w] + tides + damping + heat;  attitude at the nodes if T depends on it
//! until    the next iteration would change less than 1e-18 of the state
//! end      Q_m, H_m, angle += h b'(rates at the nodes), with compensated sums; q, P/W by the exact response
//! ```
//!
//! Order of reading:
//!
//! 1. `body.rs`, `surroundings.rs`, `free_modes.rs`: the body and what acts on it; `constants.rs`, `state.rs`: what is
//!    derived from it and what is integrated.
//! 2. `step/`: one step: `mod.rs`, `mode_response.rs`, `predictor.rs`, `iterate.rs` (all nodes at once, SIMD),
//!    `iterate_scalar.rs` (node by node, for rotors in bearings and articulated appendages), `modal_forces.rs`,
//!    `attitude_nodes.rs`, `convergence.rs`.
//! 3. `motion.rs`: segments, with their loads in `segment_loads.rs`, and the grid of steps; `step_levels.rs` and `step_size.rs`: how long a step is; `shared.rs`:
//!    what the runs of a campaign share; `accelerations.rs`: the right-hand side at an instant.
//! 4. `rotors/`: bearings with friction and imbalance, stick-slip and its search (with `error_bounds.rs`), gimbals.
//! 5. `appendages/`: panels on drives and hinges, whose angles change all coefficients.
//!
//! `small_rotation.rs` and `vectors.rs` are the arithmetic below them.

mod accelerations;
mod appendages;
mod body;
mod constants;
mod error_bounds;
mod free_modes;
mod motion;
mod rotors;
mod segment_loads;
mod shared;
mod small_rotation;
mod state;
mod step;
mod step_levels;
mod step_size;
mod surroundings;
#[cfg(test)]
mod tests;
mod vectors;

pub use accelerations::Accelerations;
pub use appendages::{
    ArticulatedBody, ArticulatedMotion, ArticulatedPanel, DriveAngles, HingeGeometry, PanelMode,
};
pub use body::{FlexibleBody, FreeMode, Rotor};
pub use free_modes::{ClampedModes, FreeModes};
pub use motion::{StepCounts, ThreeAxisMotion};
pub use rotors::{Bearing, Gimbal, HarmonicLine, RotorObservation, SlipDirection};
pub use segment_loads::SegmentLoads;
pub use shared::SharedSteps;
pub use state::BodyView;
pub use step_levels::IMBALANCE_PHASE;
pub use surroundings::{PanelPlaces, SkyAt, Surroundings, ThermalForces, TimedSurroundings};
