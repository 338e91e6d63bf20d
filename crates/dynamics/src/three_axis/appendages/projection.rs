//! View of an articulated body at an instant, and transfer of its state between the modes of two configurations.

use std::sync::Arc;

use flexsc_numerics::attitude::{Vector, rotation};
use nalgebra::Quaternion;

use super::ArticulatedMotion;
use super::configuration::Configuration;
use crate::three_axis::constants::BodyConstants;
use crate::three_axis::motion::ThreeAxisMotion;
use crate::three_axis::small_rotation::SmallRotation;
use crate::three_axis::state::{BodyView, IntegratorState};
use crate::three_axis::step_levels::StepLevels;

/// State reduced to quantities that do not depend on the basis: hub attitude, momentum and clamped modes.
struct ReducedState {
    /// Attitude of the hub, and total momentum in its axes (N m s).
    attitude: Quaternion<f64>,
    momentum: Vector,
    eta: Vec<f64>,
    pi: Vec<f64>,
    elastic_rotation: Vector,
}

impl ArticulatedMotion {
    fn reduce(&self, state: &IntegratorState) -> ReducedState {
        let q: Vec<f64> = state.modes.iter().map(|[q, _, rounding, _]| q + rounding).collect();
        let p = state
            .modes
            .iter()
            .zip(&self.basis.frequencies)
            .map(|([_, p, _, rounding], w)| w * (p + rounding));
        let p: Vec<f64> = p.collect();
        let elastic_rotation = self.basis.hub_rotation(&q);
        ReducedState {
            attitude: state.mean_attitude * rotation(&elastic_rotation),
            momentum: SmallRotation::new(elastic_rotation)
                .to_hub_axes(&(state.mean_momentum + state.rounding.1)),
            eta: self.basis.to_clamped(&q),
            pi: self.basis.to_clamped_momenta(&p),
            elastic_rotation,
        }
    }

    /// Computes the view of a state `now` (s) after the start of the segment, given the momentum of the rotors (N m
    /// s), in the free modes of that instant.
    pub(in crate::three_axis) fn view(
        &self,
        now: f64,
        state: &IntegratorState,
        rotors: &Vector,
        view: &mut BodyView,
    ) {
        let mut configuration = Configuration::default();
        let ReducedState { attitude, momentum, mut eta, mut pi, .. } = self.reduce(state);
        // The free modes are those with hinges at angle 0.
        self.configuration(self.segment_start + now, &[], &mut configuration);
        let Some(free) = configuration.free_modes(&self.body) else { return };
        if self.hinged {
            self.configuration(self.segment_start + now, &eta, &mut configuration);
        }
        let all = eta.clone();
        configuration.without_hinges(&mut eta);
        let rate = configuration.rates(&(momentum - rotors), &eta, &mut pi);
        let rates = pi;
        let free = self.basis.reordered(&free);
        let inverse = super::modal_basis::inverse(&self.body, &free);
        let of = |held: &[f64]| -> Vec<f64> {
            let rows = inverse.row_iter();
            rows.map(|row| row.iter().zip(held).map(|(part, held)| part * held).sum()).collect()
        };
        (view.displacements, view.rates) = (of(&all), of(&rates));
        view.hinges = configuration.hinge_motion(&all, &rates);
        view.rotations = (0..free.frequencies.len()).map(|mode| free.rotation(mode)).collect();
        let sum = |of: &[Vector], by: &[f64]| -> Vector {
            of.iter().zip(by).fold(Vector::zeros(), |sum, (of, by)| sum + of * *by)
        };
        let (elastic_rotation, elastic_rate) =
            (sum(&view.rotations, &view.displacements), sum(&view.rotations, &view.rates));
        let panel_momentum = configuration.panel_momentum
            + sum(&configuration.panel_momentum_per_mode, &eta)
            + sum(&configuration.translations, &rates);
        view.attitude = attitude;
        view.mean_attitude = attitude * rotation(&-elastic_rotation);
        (view.rate, view.rigid_rate, view.momentum) = (rate, rate - elastic_rate, momentum);
        let modal: f64 = view.rates.iter().map(|rate| rate * rate).sum();
        view.rotational_energy = configuration.kinetic(&rate, &eta, &rates) - 0.5 * modal;
        view.rigid_angle = state.rigid_angle + self.mean_axes_rotation(state) - elastic_rotation;
        view.com = state.com;
        view.frequencies = free.frequencies;
        view.panels = (configuration.centre, configuration.panel_axes.clone());
        view.shift = Some([self.centre_shift(&configuration, &eta), -panel_momentum / configuration.mass]);
        view.inertia = Some(configuration.inertia + configuration.inertia_change(&eta));
    }

    /// Returns the elastic rotation of the hub from the mean axes of the state (rad).
    fn mean_axes_rotation(&self, state: &IntegratorState) -> Vector {
        let q: Vec<f64> = state.modes.iter().map(|[q, ..]| *q).collect();
        self.basis.hub_rotation(&q)
    }

    /// Sets the state from the attitude and momentum of the hub and the clamped modes.
    fn restore(&self, reduced: &ReducedState, state: &mut IntegratorState) {
        let (q, p) = (self.basis.to_free(&reduced.eta), self.basis.force_to_free(&reduced.pi));
        let elastic_rotation = self.basis.hub_rotation(&q);
        state.mean_attitude = reduced.attitude * rotation(&-elastic_rotation);
        state.mean_momentum = SmallRotation::new(elastic_rotation).to_mean_axes(&reduced.momentum);
        state.rounding.0 = Quaternion::default();
        state.rounding.1 = Vector::zeros();
        state.rigid_angle += reduced.elastic_rotation - elastic_rotation;
        for ((mode, (q, p)), w) in state.modes.iter_mut().zip(q.iter().zip(&p)).zip(&self.basis.frequencies) {
            *mode = [*q, p / w, 0.0, 0.0];
        }
    }
}

impl ThreeAxisMotion {
    /// Installs the articulated appendages at the start of the run, before any other call.
    pub fn start_drives(&mut self, appendages: ArticulatedMotion) {
        let mut configuration = Configuration::default();
        let (eta, rates) = (
            appendages.basis.to_clamped(&self.view.displacements),
            appendages.basis.to_clamped(&self.view.rates),
        );
        appendages.configuration(0.0, &eta, &mut configuration);
        let mut small = eta.clone();
        configuration.without_hinges(&mut small);
        // Initial hinge angles and rates do not contribute to the hub's initial attitude and rate.
        let (mut attitude, mut rate) = (self.view.attitude, self.view.rate);
        if appendages.hinged {
            let elastic_rotation =
                |eta: &[f64]| appendages.basis.hub_rotation(&appendages.basis.to_free(eta));
            let mut others = rates.clone();
            configuration.without_hinges(&mut others);
            attitude = self.view.mean_attitude * rotation(&elastic_rotation(&small));
            rate += elastic_rotation(&others) - elastic_rotation(&rates);
        }
        let (momentum, pi) = configuration.momenta(&rate, &small, &rates);
        let reduced = ReducedState {
            attitude,
            momentum,
            elastic_rotation: appendages.basis.hub_rotation(&self.view.displacements),
            eta,
            pi,
        };
        appendages.restore(&reduced, &mut self.current);
        self.appendages = Some(Box::new(appendages));
        self.update_constants();
        self.initial.copy_from(&self.current);
        self.grid.copy_from(&self.current);
        self.update_view();
    }

    /// Sets the start of the next segment, as time since the start of the run (s).
    pub fn set_segment_start(&mut self, at: f64) {
        if let Some(appendages) = &mut self.appendages {
            appendages.segment_start = at;
        }
    }

    /// Changes the basis of the state to the free modes at a time `t` since the start (s); a new segment must begin
    /// next.
    pub fn change_basis(&mut self, t: f64) {
        let Some(appendages) = &mut self.appendages else { return };
        let Some(basis) = appendages.basis.at(&appendages.body, &*appendages.angles, t) else { return };
        let reduced = appendages.reduce(&self.current);
        appendages.basis = basis;
        appendages.restore(&reduced, &mut self.current);
        self.update_constants();
    }

    /// Updates the integrator's constants to the modes in which the state is carried.
    fn update_constants(&mut self) {
        let Some(appendages) = &self.appendages else { return };
        let model = BodyConstants::new(&appendages.flexible());
        self.levels = Arc::new(StepLevels::new(&model));
        self.model = Arc::new(model);
        self.shared = None;
        self.grid_responses.clear();
        self.extra_responses.clear();
        self.next_extra = 0;
        self.next_step = None;
        self.invalidate_step();
    }
}
