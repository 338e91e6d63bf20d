//! Evaluation of an articulated body at a stage of a step.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::gauss_legendre::NODES;
use nalgebra::Matrix3;

use super::ArticulatedMotion;
use super::configuration::Configuration;
use crate::three_axis::surroundings::{PanelPlaces, TimedSurroundings};

/// Working memory of the steps of an articulated body.
#[derive(Clone, Debug, Default)]
pub struct StageScratch {
    /// Configurations at the start of the step and at its nodes, and their times since the start of the run (s).
    configuration: [Configuration; 4],
    times: [f64; 4],
    /// Displacements q and canonical rates P of the free modes.
    pub q: Vec<f64>,
    pub p: Vec<f64>,
    /// Displacements of the clamped modes without those of hinges, and rates of all clamped modes.
    eta: Vec<f64>,
    rates: Vec<f64>,
    /// Rates q', and forces on the free modes (N/sqrt(kg)).
    pub modal_rates: Vec<f64>,
    pub forces: Vec<f64>,
}

/// Motion of an articulated body at a stage.
pub struct StageRates {
    /// Rate w of the hub (rad/s).
    pub rate: Vector,
    /// Elastic part sum phi q' of the rate (rad/s).
    pub elastic_rate: Vector,
    /// Inertia of the deformed body (kg m²).
    pub inertia: Matrix3<f64>,
    /// Torque on the hub by forces, as their points of application and the centre of mass move (N m).
    pub arm_torque: Vector,
}

/// Sources of modal forces on an articulated body.
pub struct StageForces<'a> {
    pub surroundings: TimedSurroundings<'a>,
    pub tide: Option<Matrix3<f64>>,
    /// Acceleration of the centre of mass (m/s²).
    pub com_acceleration: Option<Vector>,
}

impl StageScratch {
    /// Returns the places of the appendages at a stage.
    pub fn panel_places(&self, stage: usize) -> PanelPlaces<'_> {
        let configuration = &self.configuration[stage];
        PanelPlaces { centre: configuration.centre, axes: &configuration.panel_axes }
    }
}

impl ArticulatedMotion {
    /// Computes the configurations for a step of `h` (s) that begins `t` (s) after the start of the segment.
    pub fn prepare(&self, t: f64, h: f64, scratch: &mut StageScratch) {
        let modes = self.basis.frequencies.len();
        scratch.q.resize(modes, 0.0);
        scratch.p.resize(modes, 0.0);
        let StageScratch { configuration, times, .. } = scratch;
        for ((configuration, at), part) in
            configuration.iter_mut().zip(times).zip([0.0].into_iter().chain(NODES))
        {
            // Angles are continuous within the segment, even if they jump at its start.
            *at = self.segment_start + (t + part * h);
            if !self.hinged {
                self.configuration(*at, &[], configuration);
            }
        }
    }

    /// Evaluates the motion at a stage for the momentum G = H - sum a h without rotors (N m s); `scratch` holds q and P.
    pub fn stage_rates(
        &self,
        stage: usize,
        body_momentum: &Vector,
        com_acceleration: Option<Vector>,
        scratch: &mut StageScratch,
    ) -> StageRates {
        scratch.eta = self.basis.to_clamped(&scratch.q);
        if self.hinged {
            self.configuration(scratch.times[stage], &scratch.eta, &mut scratch.configuration[stage]);
        }
        let configuration = &scratch.configuration[stage];
        configuration.without_hinges(&mut scratch.eta);
        // The momenta pi, which the next call replaces by the rates eta'.
        scratch.rates = self.basis.to_clamped_momenta(&scratch.p);
        let rate = configuration.rates(body_momentum, &scratch.eta, &mut scratch.rates);
        scratch.modal_rates = self.basis.to_free(&scratch.rates);
        let arm_torque = com_acceleration.map_or_else(Vector::zeros, |com_acceleration| {
            let shift = self.centre_shift(configuration, &scratch.eta);
            shift.cross(&(com_acceleration * configuration.mass))
        });
        StageRates {
            rate,
            elastic_rate: self.basis.hub_rotation(&scratch.modal_rates),
            inertia: configuration.inertia + configuration.inertia_change(&scratch.eta),
            arm_torque,
        }
    }

    /// Returns the shift of the hub's points relative to the centre of mass since the start (m).
    pub fn centre_shift(&self, configuration: &Configuration, eta: &[f64]) -> Vector {
        let elastic_rotation =
            configuration.translations.iter().zip(eta).fold(Vector::zeros(), |sum, (t, eta)| sum + t * *eta);
        self.basis.first_centre - configuration.centre - elastic_rotation / configuration.mass
    }

    /// Computes the forces on the modes at a stage, `t` (s) after the start of the step, for the hub's rate (rad/s).
    pub fn compute_forces(
        &self,
        (stage, t): (usize, f64),
        rate: &Vector,
        sources: &StageForces<'_>,
        scratch: &mut StageScratch,
    ) {
        let configuration = &scratch.configuration[stage];
        let kinetic = |index: usize| {
            0.5 * rate.dot(&(configuration.moments[index] * rate))
                + configuration.momenta[index].dot(rate)
                + configuration.modal_forces[index]
        };
        let mut forces: Vec<f64> = (0..configuration.moments.len()).map(kinetic).collect();
        configuration.add_hinge_terms(rate, &scratch.eta, &scratch.rates, &mut forces);
        for (index, force) in forces.iter_mut().enumerate() {
            if let Some(tide) = &sources.tide {
                *force += configuration.moments[index].component_mul(tide).sum();
            }
            if let Some(com_acceleration) = &sources.com_acceleration {
                *force -= configuration.translations[index].dot(com_acceleration);
            }
        }
        scratch.forces = self.basis.force_to_free(&forces);
        let Some((surroundings, since)) = sources.surroundings else { return };
        for (index, thermal) in surroundings.thermal_forces().iter().enumerate() {
            let level = surroundings.thermal_level(index, since + t);
            for (index, force) in scratch.forces.iter_mut().enumerate() {
                let row = self.basis.from_start.row(index);
                *force += level * row.iter().zip(&thermal.forces).map(|(part, own)| part * own).sum::<f64>();
            }
        }
    }
}
