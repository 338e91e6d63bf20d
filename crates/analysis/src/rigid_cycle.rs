//! Limit cycle of the relay law on a rigid body, in closed form.
//!
//! With q = sqrt(2 m_u gamma), r = m_eps/m_u and v0 the speed at which a boundary is reached, z =
//! (v0 + sqrt(v0² + q²))/q describes the cycle; beta = k_t (1 - k_t)(1 - r). Derived from the corrected law (2) of
//! \[Silaev\], which refers to relations published elsewhere.

use flexsc_control::law::{Relay, RelaySides};
use flexsc_dynamics::axis_model::{AxisMode, AxisModel};
use schemars::JsonSchema;
use serde::Serialize;

/// A limit cycle of the relay law on a rigid body.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct RigidCycle {
    /// How many boundaries push back in a cycle.
    pub sides: RelaySides,
    /// Speed at which a boundary is reached (rad/s).
    pub entry_rate_rad_s: f64,
    /// Duration of a strong push, tau_1 (s).
    pub push_s: f64,
    /// Duration of a strong brake, tau_2 (s).
    pub brake_s: f64,
    /// Duration of the coast under the weak torque (s).
    pub coast_s: f64,
    /// Period, T_0 (s).
    pub period_s: f64,
    /// Largest angle (rad).
    pub angle_max_rad: f64,
    /// Least angle (rad).
    pub angle_min_rad: f64,
    /// Fraction of the time under strong torque.
    pub duty: f64,
    /// Torque impulse, strong and weak, per hour (N m s; rad/s on a body without inertia).
    pub impulse_per_hour_nm_s: f64,
    /// Multiplier of a small deviation over a half cycle (two-sided) or a cycle (one-sided).
    pub multiplier: f64,
    /// Whether deviations die out.
    pub stable: bool,
}

/// A gain at which a harmonic of the cycle meets a mode.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Resonance {
    /// Index of the mode.
    pub mode: usize,
    /// Number of the harmonic; odd in a two-sided cycle, whose even harmonics vanish by symmetry.
    pub harmonic: u32,
    /// Period of the cycle there (s).
    pub period_s: f64,
    /// Braking gain there.
    pub k_t: f64,
}

/// Parameters of the relay law on a rigid body, as accelerations.
struct RigidRelay {
    strong: f64,
    weak: f64,
    eps: f64,
    gamma: f64,
    inertia: f64,
    /// Angle of the left boundary (rad); minus infinity if it does not push back.
    left_boundary: f64,
}

impl RigidRelay {
    fn new(law: &Relay, inertia: f64) -> Self {
        Self {
            strong: law.strong.get() / inertia,
            weak: law.weak.get() / inertia,
            eps: law.dead_zone.get(),
            gamma: law.hysteresis.get(),
            inertia,
            left_boundary: match law.sides {
                RelaySides::Two => -law.dead_zone.get(),
                RelaySides::One => f64::NEG_INFINITY,
            },
        }
    }

    fn cycle(&self, sides: RelaySides, k_t: f64) -> Option<RigidCycle> {
        let Self { strong, weak, eps, gamma, inertia, left_boundary } = *self;
        // Without a weak torque nothing returns a body to the boundary that it left.
        if weak <= 0.0 && sides == RelaySides::One {
            return None;
        }
        let q = f64::sqrt(2.0 * strong * gamma);
        let r = weak / strong;
        let width = 2.0 * weak * (2.0 * eps - gamma) / (q * q);
        let beta = k_t * (1.0 - k_t) * (1.0 - r);
        let numerator = match sides {
            RelaySides::Two => 1.0 - k_t - width + r * k_t,
            RelaySides::One => 1.0 - k_t + r + r * k_t,
        };
        let z2 = numerator / beta;
        if z2 <= 1.0 || !z2.is_finite() {
            return None;
        }
        let z = f64::sqrt(z2);
        let entry = 0.5 * q * (z - 1.0 / z);
        let (push, angle_max) = (q * z / strong, eps + entry * entry / (2.0 * strong));
        let brake = k_t * push;
        let exit = -0.5 * q * ((1.0 - 2.0 * k_t) * z + 1.0 / z);
        let (coast, halves, angle_min) = match sides {
            // (-exit - entry)/weak, without the difference of two numbers that a weak torque of 0 makes equal.
            RelaySides::Two => {
                let crossing = 2.0 * (2.0 * eps - gamma) / (q * q) - 1.0 / strong;
                (q * crossing / (z * (1.0 - k_t) * (1.0 - r)), 2.0, -angle_max)
            }
            RelaySides::One => ((entry - exit) / weak, 1.0, eps - entry * entry / (2.0 * weak)),
        };
        // A two-sided coast that would reverse, or a one-sided one that reaches the left boundary, is no cycle.
        if coast <= 0.0 || (sides == RelaySides::One && angle_min <= left_boundary) {
            return None;
        }
        let multiplier = 1.0 - 4.0 * beta * z2 * z2 / (z2 * z2 - 1.0);
        let half = push + brake + coast;
        let impulse = strong * (push + brake) + weak * coast;
        Some(RigidCycle {
            sides,
            entry_rate_rad_s: entry,
            push_s: push,
            brake_s: brake,
            coast_s: coast,
            period_s: halves * half,
            angle_max_rad: angle_max,
            angle_min_rad: angle_min,
            duty: (push + brake) / half,
            impulse_per_hour_nm_s: inertia * impulse / half * 3600.0,
            multiplier,
            stable: multiplier.abs() < 1.0,
        })
    }
}

/// Returns the limit cycles of a relay law on a body without its modes at the gain `k_t`, two-sided first. A law with
/// one side has only the one-sided cycle, which then has no left boundary to avoid.
pub fn cycles(law: &Relay, body: &AxisModel, k_t: f64) -> Vec<RigidCycle> {
    let rigid = RigidRelay::new(law, body.inertia.get());
    let candidates: &[RelaySides] = match law.sides {
        RelaySides::Two => &[RelaySides::Two, RelaySides::One],
        RelaySides::One => &[RelaySides::One],
    };
    candidates.iter().filter_map(|&sides| rigid.cycle(sides, k_t)).collect()
}

/// Harmonics above this one are too weak for a resonance: the n-th falls as 1/n² at least.
const HIGHEST: u32 = 9_999;

/// Returns the gains from 0.02 to 1 at which a harmonic of the cycle with the law's sides meets a mode, by mode and gain.
/// The even harmonics of a two-sided cycle vanish by symmetry.
pub fn resonances(law: &Relay, body: &AxisModel) -> Vec<Resonance> {
    /// Number of cells of the grid of gains: the period is monotonic between neighbours.
    const GRID: u32 = 4096;
    let rigid = RigidRelay::new(law, body.inertia.get());
    let period = |k_t: f64| rigid.cycle(law.sides, k_t).map(|cycle| cycle.period_s);
    let acts = |harmonic: &u32| law.sides == RelaySides::One || harmonic % 2 == 1;
    let mut found = Vec::new();
    for (mode, w) in body.modes.iter().map(|mode: &AxisMode| mode.frequency.get()).enumerate() {
        let turns = |period: f64| w * period / (2.0 * std::f64::consts::PI);
        for cell in 0..GRID {
            let gain = |edge: u32| 0.02 + 0.98 * f64::from(edge) / f64::from(GRID);
            let (low, high) = (gain(cell), gain(cell + 1));
            let (Some(from), Some(to)) = (period(low).map(turns), period(high).map(turns)) else { continue };
            let between = (libm::ceil(from.min(to)) as u32)..=(libm::floor(from.max(to)) as u32).min(HIGHEST);
            for harmonic in between.filter(acts) {
                let rising = if to > from { 1.0 } else { -1.0 };
                let short = |k_t| rising * (period(k_t).map_or(from, turns) - f64::from(harmonic));
                let k_t = bisect(low, high, short);
                let period_s = 2.0 * std::f64::consts::PI * f64::from(harmonic) / w;
                found.push(Resonance { mode, harmonic, period_s, k_t });
            }
        }
    }
    found
}

/// Returns the root of an increasing function, to the last bit.
fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}
