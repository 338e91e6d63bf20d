//! Flow of a three-axis body whose modes act back on its rotation: the integrator's motion, seen as a flow.

use std::borrow::Cow;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::AxisState;
use flexsc_dynamics::three_axis::FlexibleBody;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};
use flexsc_spacecraft::environment::SurroundingsState;
use nalgebra::Quaternion;

use super::flow::{Flow, FlowQuantities};
use super::three_axis_body::{ThreeAxisBody, ThreeAxisQuantities};
use super::two_way_motion::{TwoWayMotion, TwoWaySegment};
use flexsc_scenario::ResolvedScenario;

/// Flow of a three-axis body whose modes act back on its rotation.
#[derive(Clone, Debug)]
pub struct TwoWayFlow {
    body: ThreeAxisBody,
    motion: TwoWayMotion,
    /// Start of the motion segment.
    segment_start: Instant,
}

impl TwoWayFlow {
    /// Creates the flow at the start, without loads.
    pub fn new(spec: &ThreeAxisModel, flexible: &FlexibleBody, study: &ResolvedScenario) -> Self {
        let body = ThreeAxisBody::new(spec, study);
        let motion = TwoWayMotion::new(
            spec,
            flexible,
            study.surroundings.clone(),
            study.translation.clone(),
            [&body.sensor_rotations[..], &body.torque_rotations],
            (&study.bearings, &study.shared_steps),
        );
        let motion = motion.with_appendages(study.drives.as_ref());
        Self { body, motion, segment_start: Instant::START }
    }
}

impl Flow for TwoWayFlow {
    fn begin_segment(&mut self, wrench: &Wrench) {
        self.segment_start = self.body.evaluated_at;
        self.motion.depart(wrench, self.segment_start.seconds());
        self.motion.write_state(&self.body.rigid, &mut self.body.state);
    }

    fn advance(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError> {
        record.poll()?;
        let body = &mut self.body;
        if body.evaluated_at == now {
            return Ok(None);
        }
        let h = now.since(self.segment_start).seconds();
        let began = self.segment_start.seconds();
        let mut met = None;
        if let Some(h) = self.motion.advance(h, began, || record.poll())? {
            let at = (self.segment_start + Span::from_seconds(h)).min(now);
            self.motion.stop_at_bearing_event(at.since(self.segment_start).seconds(), began);
            met = Some(at);
        }
        self.motion.write_state(&body.rigid, &mut body.state);
        if let Some((_, rotations)) = self.motion.modes() {
            // The modes change with the angles of drives. Sensors are then on the hub (`Rule::FixedSensors`).
            body.sensor_rotations.copy_from_slice(rotations);
        }
        body.evaluated_at = met.unwrap_or(now);
        body.has_truth = false;
        Ok(met)
    }

    fn evaluate(&mut self, _now: Instant, truth: &mut Truth) -> bool {
        let body = &mut self.body;
        if body.has_truth {
            return true;
        }
        if !body.state.is_finite() {
            return false;
        }
        let elastic = self.motion.write_truth(&body.sensor_rotations, truth);
        body.rates = (truth.rigid_rate.into(), elastic);
        if let Some(around) = self.motion.surroundings() {
            truth.environment = around.observation(body.evaluated_at.seconds());
        }
        body.has_truth = true;
        true
    }

    fn about_axis(&self, axis: usize, target: &Orientation) -> Cow<'_, AxisState> {
        Cow::Owned(self.body.about_axis(axis, target))
    }

    fn modal_state(&self) -> Cow<'_, AxisState> {
        Cow::Owned(self.body.modal_state())
    }

    fn update_monitor(
        &self,
        monitor: &mut WindowedEnvelope,
        now: Instant,
        _torque: f64,
        commanded: &dyn Fn() -> Wrench,
    ) {
        monitor.push(now, &self.body.modal_state(), &self.body.modal_forces(&commanded()));
    }

    fn quantities(&self) -> FlowQuantities<'_> {
        FlowQuantities::ThreeAxis(self)
    }

    fn copy(&self) -> Box<dyn Flow> {
        Box::new(self.clone())
    }
}

impl ThreeAxisQuantities for TwoWayFlow {
    fn body(&self) -> &ThreeAxisBody {
        &self.body
    }

    fn surroundings(&self) -> Option<&SurroundingsState> {
        self.motion.surroundings()
    }

    fn attitude(&self) -> &Quaternion<f64> {
        self.motion.attitude()
    }

    fn external_torque(&self) -> Option<Vector> {
        self.motion.environment_torque(self.body.evaluated_at.seconds())
    }

    fn rotational_energy(&self) -> (f64, f64) {
        self.motion.energy()
    }

    fn modal_energies(&self) -> Vec<f64> {
        if self.motion.modes().is_some() {
            self.motion.modal_energies().collect()
        } else {
            self.body.elastic.energies(&self.body.state.modes).collect()
        }
    }

    fn elastic_energies(&self) -> (f64, f64) {
        if self.motion.modes().is_some() {
            self.body.sum_energies(self.motion.modal_energies())
        } else {
            self.body.sum_energies(self.body.elastic.energies(&self.body.state.modes))
        }
    }

    fn fastest_frequency(&self) -> f64 {
        self.motion.fastest()
    }

    fn two_way(&self) -> Option<TwoWaySegment<'_>> {
        Some(TwoWaySegment { motion: &self.motion, start: self.segment_start.seconds() })
    }
}
