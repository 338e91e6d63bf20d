//! Amplitudes of the modes at the start of a step, four modes per SIMD register.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::lanes::{LaneFloat, SimdTask};

use crate::three_axis::model::BodyConstants;
use crate::three_axis::pace::ModeAmplitude;

/// SIMD task that computes the amplitudes of the modes from their states and the loads.
pub(super) struct Amplitudes<'a> {
    pub model: &'a BodyConstants,
    /// States of the modes: q and P/W of each.
    pub modes: &'a [[f64; 4]],
    /// Modal forces other than those of the torque (N/sqrt(kg)); empty or one per mode.
    pub forces: &'a [f64],
    /// Rigid momentum Gt (N m s).
    pub turning: Vector,
    /// Torque on the hub less the reaction of the rotors, without and with the gyroscopic torque (N m).
    pub pushed: Vector,
    pub net: Vector,
    /// Centrifugal terms of the rotation (rad²/s²), as `centrifugal_terms` returns them.
    pub spun: [f64; 6],
    pub found: &'a mut [ModeAmplitude],
}

impl SimdTask for Amplitudes<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        let Self { model, modes, forces, turning, pushed, net, spun, found } = self;
        for group in 0..model.abreast.len() {
            let (of, first) = (&model.abreast[group], 4 * group);
            let (mut q, mut p, mut forced) = ([0.0; 4], [0.0; 4], [0.0; 4]);
            for lane in 0..4 {
                if let Some([displacement, rate, ..]) = modes.get(first + lane) {
                    (q[lane], p[lane]) = (*displacement, *rate);
                }
                if let Some(force) = forces.get(first + lane) {
                    forced[lane] = *force;
                }
            }
            let (q, p, forced) = (kind.load(&q), kind.load(&p), kind.load(&forced));
            let w = kind.load(&of.frequency);
            let held = (of.along(kind, &net) + of.centrifugal_force(kind, &spun) + forced) / (w * w);
            let speed = (p + of.along(kind, &turning) / w).abs();
            let most = ((of.along(kind, &pushed) + forced).abs() / (w * w)).max(held.abs());
            // Bounds each of the displacement, the rate and the static deflection by torque or rotation.
            let most = q.abs() + speed + most;
            let swings = most.min((q - held).abs() + speed);
            let mut kept = [[0.0; 4]; 2];
            most.store(&mut kept[0]);
            swings.store(&mut kept[1]);
            for lane in 0..4 {
                if let Some(amplitude) = found.get_mut(first + lane) {
                    *amplitude = ModeAmplitude { most: kept[0][lane], swings: kept[1][lane] };
                }
            }
        }
    }
}
