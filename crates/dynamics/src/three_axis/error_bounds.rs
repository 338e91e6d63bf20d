//! Bounds of the derivatives of the hub's rate over a step, from norms in the equations of motion.
//!
//! A mode's amplitude sqrt(q'² + W² q²) grows at most by its forcing; |H| at most by the torque. With bounds of both
//! and of |w|, each derivative of the equations of motion bounds the next derivative of w by Leibniz's rule. The
//! assumed bounds are enlarged until the values implied at the end of the step are within them.

use super::constants::tensor;
use super::motion::ThreeAxisMotion;
use super::rotors::{BearingLoads, HarmonicLine};
use super::surroundings::TimedSurroundings;

/// Bounds of derivatives over a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Bounds {
    /// Bounds of |w''| and |w'''| (rad/s³, rad/s⁴).
    pub second: f64,
    pub third: f64,
    /// Bound of the part of |Omega''| due to friction (rad/s³), in addition to |w''|, for each rotor.
    friction: Vec<f64>,
}

impl Bounds {
    /// Returns the bound of |Omega''| of a rotor (rad/s³).
    pub fn jerk_bound(&self, index: usize) -> f64 {
        self.second + self.friction[index]
    }
}

/// Assumed bounds over the step: amplitudes of the modes, |w| and speeds of the rotors.
#[derive(Clone)]
struct Assumed {
    modes: Vec<f64>,
    rate: f64,
    speeds: Vec<f64>,
}

/// Limit on the enlargements; beyond it the bounds are infinite, and steps are searched down to their ticks.
const MAX_ENLARGEMENTS: u32 = 40;

impl ThreeAxisMotion {
    /// Returns the bounds over a step of `h` (s) from the current instant.
    pub(super) fn bounds(&self, h: f64, surroundings: TimedSurroundings) -> Bounds {
        let (model, view) = (&self.model, &self.view);
        let amplitude = |index: usize| {
            let stretch = model.modes[index].frequency * view.displacements[index];
            libm::hypot(view.rates[index], stretch)
        };
        let bearings_now = self.current_bearings(&self.slips);
        let speed = |index: usize| {
            bearings_now.speed(index, self.current.rotor_states[index].values.x, &view.rate).abs()
        };
        let start = Assumed {
            modes: (0..model.modes.len()).map(amplitude).collect(),
            rate: view.rate.norm(),
            speeds: (0..bearings_now.rotors.len()).map(speed).collect(),
        };
        let tide = surroundings.and_then(|(surroundings, since)| {
            surroundings.tidal_tensor(&surroundings.sky_at(since + self.time), &view.attitude)
        });
        let tide = 2.0 * tide.map_or(0.0, |tide| tide.norm());
        let mut assumed = start.clone();
        for _ in 0..MAX_ENLARGEMENTS {
            let (bounds, reached_values) = self.implied(&assumed, &start, h, surroundings, tide);
            let mut holds = true;
            let mut enlarge = |assumed: &mut f64, reached_values: f64| {
                if reached_values > *assumed {
                    (*assumed, holds) = (1.5 * reached_values, false);
                }
            };
            assumed
                .modes
                .iter_mut()
                .zip(reached_values.modes)
                .for_each(|(own, reached_values)| enlarge(own, reached_values));
            assumed
                .speeds
                .iter_mut()
                .zip(reached_values.speeds)
                .for_each(|(own, reached_values)| enlarge(own, reached_values));
            enlarge(&mut assumed.rate, reached_values.rate);
            if holds {
                return bounds;
            }
        }
        let friction = vec![f64::INFINITY; start.speeds.len()];
        Bounds { second: f64::INFINITY, third: f64::INFINITY, friction }
    }

    /// Returns the bounds that follow from the assumed values and twice the norm `tide` of the tidal tensor (1/s²), and the
    /// largest values then implied within `h` (s).
    fn implied(
        &self,
        assumed: &Assumed,
        start: &Assumed,
        h: f64,
        surroundings: TimedSurroundings,
        tide: f64,
    ) -> (Bounds, Assumed) {
        let model = &self.model;
        let rotors = self.current_bearings(&self.slips);
        let [w0, stuck_inertia] = [assumed.rate, rotors.stuck_inertia().norm()];
        // Torques, and their rates of change.
        let [constant, bound, slow] = [
            self.loads.torque.norm(),
            surroundings.map_or(0.0, |(surroundings, _)| surroundings.bound()),
            surroundings.map_or(0.0, |(around, since)| around.frequency_at(since + self.time)) + 2.0 * w0,
        ];
        let each = || rotors.bearings.iter().zip(rotors.rotors).zip(&assumed.speeds);
        let (imbalance, imbalance_torque) = imbalance_waves(&rotors, &assumed.speeds);
        let torque = [
            constant + bound + imbalance_torque[0],
            bound * slow + imbalance_torque[1],
            bound * slow * slow + imbalance_torque[2],
        ];
        let size = |index: usize| tensor(model.modes[index].moments).norm();
        let inertia_rate = |of: &[f64]| (0..of.len()).map(|index| size(index) * of[index]).sum::<f64>();
        let imbalance_force = |index: usize, order: usize| {
            let of = |forces: &[Vec<f64>; 2]| forces[0][index].abs() + forces[1][index].abs();
            imbalance.iter().map(|(line, wave)| of(&line.forces) * wave[order]).sum::<f64>()
        };
        let coupled = |index: usize, of: &[f64]| {
            let row = |damping: &nalgebra::DMatrix<f64>| {
                of.iter().enumerate().map(|(other, of)| damping[(index, other)].abs() * of).sum::<f64>()
            };
            model.coupled_damping.as_ref().map_or(0.0, row)
        };
        let (modes, count) = (&model.modes, model.modes.len());
        let displacements: Vec<f64> = (0..count).map(|of| assumed.modes[of] / modes[of].frequency).collect();
        let q1 = &assumed.modes;
        let [c0, c1] = [inertia_rate(&displacements), inertia_rate(q1)];
        // Norm of (J_left + J1)^-1, and the momentum due to elastic rates.
        let stiff = 1.0 / ((model.inverse + model.bending).norm());
        let mobility = if c0 < 0.5 * stiff { 1.0 / (stiff - c0) } else { f64::INFINITY };
        let residual = model.residual_inertia.norm();
        let momentum_of = |of: &[f64]| {
            residual * modes.iter().zip(of).map(|(mode, p)| mode.rotation.norm() * p).sum::<f64>()
        };
        let h0 = self.view.momentum.norm() + h * torque[0];
        let h1 = torque[0] + w0 * h0;
        // Each derivative multiplies the gimbals' momentum by the gimbal rate.
        let gimbals = &self.loads.gimbals;
        let gimbal_rates = |of: fn(f64) -> f64| -> f64 {
            gimbals.iter().map(|gimbal| gimbal.momentum * of(gimbal.rate)).map(f64::abs).sum()
        };
        // First derivatives.
        let u0: Vec<f64> =
            each().map(|((of, rotor), speed)| rotor.torque.abs() + of.coulomb + of.viscous * speed).collect();
        let g1 = h1 + u0.iter().sum::<f64>() + gimbal_rates(|rate| rate);
        let given = |index: usize| self.loads.forces.get(index).map_or(0.0, |force| force.abs());
        let f0: Vec<f64> = (0..count)
            .map(|of| {
                given(of) + size(of) * (0.5 * w0 * w0 + tide) + imbalance_force(of, 0) + coupled(of, q1)
            })
            .collect();
        let damped = |of: usize| 2.0 * modes[of].damping * modes[of].frequency;
        let square = |of: usize| modes[of].frequency * modes[of].frequency;
        let p1: Vec<f64> =
            (0..count).map(|of| square(of) * displacements[of] + damped(of) * q1[of] + f0[of]).collect();
        let w1 = mobility * (g1 + momentum_of(&p1) + c1 * w0);
        let rigid_momentum_first = g1 + c1 * w0 + (c0 + stuck_inertia) * w1;
        let q2: Vec<f64> =
            (0..count).map(|of| p1[of] + modes[of].rotation.norm() * rigid_momentum_first).collect();
        // Second derivatives.
        let h2 = torque[1] + w1 * h0 + w0 * h1;
        let u1: Vec<f64> =
            each().zip(&u0).map(|(((of, _), _), u)| of.viscous * (u / of.inertia + w1)).collect();
        let g2 = h2 + u1.iter().sum::<f64>() + gimbal_rates(|rate| rate * rate);
        let f1: Vec<f64> = (0..count)
            .map(|of| size(of) * (w0 * w1 + tide * slow) + imbalance_force(of, 1) + coupled(of, &q2))
            .collect();
        let p2: Vec<f64> = (0..count).map(|of| square(of) * q1[of] + damped(of) * q2[of] + f1[of]).collect();
        let c2 = inertia_rate(&q2);
        let w2 = mobility * (g2 + momentum_of(&p2) + 2.0 * c1 * w1 + c2 * w0);
        let rigid_momentum_second = g2 + c2 * w0 + 2.0 * c1 * w1 + (c0 + stuck_inertia) * w2;
        let q3: Vec<f64> =
            (0..count).map(|of| p2[of] + modes[of].rotation.norm() * rigid_momentum_second).collect();
        // Third derivatives.
        let u2 = each().zip(&u1).map(|(((of, _), _), u)| of.viscous * (u / of.inertia + w2)).sum::<f64>();
        let g3 = torque[2] + w2 * h0 + 2.0 * w1 * h1 + w0 * h2 + u2 + gimbal_rates(|rate| rate * rate * rate);
        let f2 = |of: usize| {
            size(of) * (w1 * w1 + w0 * w2 + tide * slow * slow) + imbalance_force(of, 2) + coupled(of, &q3)
        };
        let p3: Vec<f64> = (0..count).map(|of| square(of) * q2[of] + damped(of) * q3[of] + f2(of)).collect();
        let third =
            mobility * (g3 + momentum_of(&p3) + 3.0 * c1 * w2 + 3.0 * c2 * w1 + inertia_rate(&q3) * w0);
        let reached_values = Assumed {
            modes: (0..count)
                .map(|of| start.modes[of] + h * (modes[of].rotation.norm() * rigid_momentum_first + f0[of]))
                .collect(),
            rate: start.rate + h * w1,
            speeds: each()
                .zip(&u0)
                .zip(&start.speeds)
                .map(|((((of, _), _), u), speed)| speed + h * (u / of.inertia + w1))
                .collect(),
        };
        let friction = each().zip(&u1).map(|(((of, _), _), u)| u / of.inertia).collect();
        (Bounds { second: w2, third, friction }, reached_values)
    }
}

/// Returns the harmonics of the imbalance of rotors at given speeds (rad/s), each with the bounds of its force per unit
/// and of two derivatives of it, and the bounds of the torque of all (N m) and of its derivatives.
fn imbalance_waves<'a>(
    rotors: &BearingLoads<'a>,
    speeds: &[f64],
) -> (Vec<(&'a HarmonicLine, [f64; 3])>, [f64; 3]) {
    let mut imbalance = Vec::new();
    let mut torque = [0.0; 3];
    for ((bearing, rotor), speed) in rotors.bearings.iter().zip(rotors.rotors).zip(speeds) {
        let change = (rotor.torque.abs() + bearing.coulomb + bearing.viscous * speed) / bearing.inertia;
        for line in &bearing.lines {
            let [k, s] = [line.order, *speed];
            let wave = [
                s * s,
                k * s * s * s + 2.0 * s * change,
                k * k * s * s * s * s + 5.0 * k * s * s * change + 2.0 * change * change,
            ];
            let size = line.torque[0].norm() + line.torque[1].norm();
            torque.iter_mut().zip(wave).for_each(|(sum, wave)| *sum += size * wave);
            imbalance.push((line, wave));
        }
    }
    (imbalance, torque)
}
