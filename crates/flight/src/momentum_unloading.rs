//! Unloading of wheels or gyros: above a limit of their momentum, a torque that reduces it until it is below another limit.

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
}
