//! Loads of a segment, which are constant between two commands, and the integration step under them.

use flexsc_numerics::attitude::Vector;

use super::appendages::ArticulatedMotion;
use super::body::Rotor;
use super::constants::BodyConstants;
use super::rotors::{Bearing, BearingLoads, Gimbal, GimbalMomentum, SlipDirection};
use super::step::{IntegrationStep, ModeResponse};
use super::surroundings::TimedSurroundings;

/// Loads that act from the start of a segment.
#[derive(Clone, Debug, Default)]
pub struct SegmentLoads {
    /// Torque on the hub in its axes (N m).
    pub torque: Vector,
    /// Modal forces other than phi' times `torque`, which the motion adds itself (N/sqrt(kg)); empty if there are
    /// none.
    pub forces: Vec<f64>,
    /// Torque on the hub per unit of each mode, by forces whose points of application move (N/sqrt(kg)); empty if
    /// none.
    pub force_arms: Vec<Vector>,
    /// Acceleration of the centre of mass, in the hub's axes (m/s²).
    pub com_acceleration: Vector,
    /// Rotors. One that was not present before adds its momentum to the body's.
    pub rotors: Vec<Rotor>,
    /// Rotors in gimbals. One that was not present before adds its momentum to the body's.
    pub gimbals: Vec<Gimbal>,
}

impl SegmentLoads {
    /// Returns the momentum of the rotors `t` (s) after the start of the segment (N m s), and its rate (N m).
    pub(super) fn rotors(&self, t: f64) -> (Vector, Vector) {
        self.rotors.iter().fold((Vector::zeros(), Vector::zeros()), |(sum, rate), rotor| {
            (sum + rotor.axis * (rotor.momentum + rotor.torque * t), rate + rotor.axis * rotor.torque)
        })
    }

    /// Creates the step of `h` (s) that begins `t` (s) after the start of the segment.
    pub(super) fn step<'a>(
        &'a self,
        model: &'a BodyConstants,
        (responses, bearings, slips): (&'a [ModeResponse], &'a [Bearing], &'a [SlipDirection]),
        h: f64,
        t: f64,
        surroundings: TimedSurroundings<'a>,
        appendages: Option<&'a ArticulatedMotion>,
    ) -> IntegrationStep<'a> {
        let count = self.rotors.len().min(bearings.len());
        let loads =
            BearingLoads { bearings: &bearings[..count], rotors: &self.rotors, slips: &slips[..count] };
        IntegrationStep {
            model,
            responses,
            h,
            torque: self.torque,
            com_acceleration: (self.com_acceleration != Vector::zeros()).then_some(self.com_acceleration),
            // With driven appendages, modal forces follow from the force alone.
            forces: if appendages.is_some() { &[] } else { &self.forces },
            force_arms: &self.force_arms,
            rotors: if count > 0 { (Vector::zeros(), Vector::zeros()) } else { self.rotors(t) },
            bearings: (count > 0).then_some(loads),
            gimbal_momentum: GimbalMomentum::over(&self.gimbals, t, h),
            surroundings: surroundings.map(|(surroundings, since)| (surroundings, since + t)),
            appendages: appendages.map(|appendages| (appendages, t)),
        }
    }
}
