//! Unloading of wheels or gyros: above a limit of their momentum, a torque that reduces it until it is below another limit.

use crate::jet_pulses::{JetPair, JetTorques};
use crate::magnetorquers::{moment_of_torque, torque_of_moment};
use crate::vector3::Vector3;

/// Law that unloads wheels or gyros.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct MomentumUnloading {
    /// Momentum above which unloading begins (N m s).
    pub above: f64,
    /// Momentum below which it ends (N m s).
    pub below: f64,
    /// True for magnetorquers, false for jets.
    pub is_magnetic: bool,
    /// For magnetorquers: the part of the momentum that is removed in a second (1/s).
    pub gain: f64,
    /// For jets: the time in which the momentum would be removed (s).
    pub period: f64,
    /// For jets: the largest torque about an axis (N m).
    pub most: f64,
    /// True while the momentum is reduced.
    pub is_active: bool,
}

impl MomentumUnloading {
    /// Returns the torque (N m) of a cycle that reduces the stored momentum (N m s); 0 for a momentum that is not finite.
    pub fn torque(&mut self, stored: &Vector3) -> Vector3 {
        let limit: f64 = if self.is_active { self.below } else { self.above };
        let momentum: f64 = stored.norm();
        self.is_active = momentum > limit && momentum.is_finite();
        if !self.is_active {
            return Vector3::ZERO;
        }
        if self.is_magnetic {
            return stored.scaled(-self.gain);
        }
        let demanded: Vector3 = stored.divided(-self.period);
        // The direction is kept if one axis exceeds the limit of the jets.
        let largest: f64 = demanded.largest_size();
        if largest > self.most { demanded.scaled(self.most / largest) } else { demanded }
    }

    /// Begins a cycle of magnetorquers in a field (T), with the stored momentum (N m s): writes their moment (A m²) within limits, and
    /// returns the torque (N m) that the wheels counteract.
    pub fn begin_magnetic(
        &mut self,
        stored: &Vector3,
        field: &Vector3,
        limits: &Vector3,
        moment: &mut Vector3,
    ) -> Vector3 {
        let torque: Vector3 = self.torque(stored);
        *moment = moment_of_torque(&torque, field, limits);
        torque_of_moment(moment, field)
    }

    /// Begins a cycle of groups of jets about the three axes, with the stored momentum (N m s): writes their on-times (s), and returns
    /// the torque (N m) that the wheels counteract.
    pub fn begin_jets(
        &mut self,
        stored: &Vector3,
        pairs: &[JetPair; 3],
        torques: &[JetTorques; 3],
        on_times: &mut [f64; 3],
    ) -> Vector3 {
        let torque: Vector3 = self.torque(stored);
        on_times[0] = pairs[0].on_time_of_torque(torque.x);
        on_times[1] = pairs[1].on_time_of_torque(torque.y);
        on_times[2] = pairs[2].on_time_of_torque(torque.z);
        let roll: Vector3 = torques[0].impulse(on_times[0]);
        let pitch: Vector3 = torques[1].impulse(on_times[1]);
        let yaw: Vector3 = torques[2].impulse(on_times[2]);
        let both: Vector3 = roll.plus(&pitch);
        let impulse: Vector3 = both.plus(&yaw);
        impulse.divided(self.period)
    }
}
