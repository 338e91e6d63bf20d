//! Laws about the axes of a scenario as plain code, and the wheels that give their torques.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::{ActuatorKind, FiringMethod, jet_pair};
use flexsc_core::control::law::{Authority, Compensator, LawKind};
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::numerics::time::Span;
use flexsc_flight::attitude_law::AttitudeFeedback;
use flexsc_flight::axis_motion::{AxisMotion, AxisReference};
use flexsc_flight::biquad::BiquadFilter;
use flexsc_flight::gain_schedule::SchedulePoint;
use flexsc_flight::jet_pulses::JetPair;
use flexsc_flight::pd::PdLaw;
use flexsc_flight::phase_plane::PhasePlaneLaw;
use flexsc_flight::vector3::Vector3;
use flexsc_flight::wheel_allocation::AllocatedWheel;

use super::{NotExportable, all_of_kind};

/// Laws about the axes, all of one kind.
#[derive(Clone, Debug)]
pub enum LawsOfAxes {
    /// PD laws, each with the points of the gain of its extra loop.
    Pd(Vec<(PdLaw, Vec<SchedulePoint>)>),
    /// Phase-plane laws, and the largest number of modes that active damping reads about an axis.
    PhasePlane(Vec<PhasePlaneLaw>, usize),
    /// Attitude laws, each with its filters.
    Attitude(Vec<(AttitudeFeedback, Vec<BiquadFilter>)>),
    /// Compensators: one about each axis, or one about three axes together.
    StateSpace(Vec<Compensator>),
}

/// Distribution of torques to reaction wheels.
#[derive(Clone, Debug)]
pub struct WheelDistribution {
    /// Wheels.
    pub wheels: Vec<AllocatedWheel>,
    /// Largest torque of a wheel (N m).
    pub limit: f64,
    /// True if the largest torque is minimised.
    pub is_least_largest: bool,
}

/// Returns the laws about the axes.
pub(super) fn laws_of_axes(
    laws: &[&LawKind],
    authorities: &[Authority],
    scenario: &Scenario,
) -> Result<LawsOfAxes, NotExportable> {
    let about = |axis: usize| &authorities[axis];
    match laws.first() {
        Some(LawKind::Pd(_)) => Ok(LawsOfAxes::Pd(all_of_kind(laws, |law| {
            if let LawKind::Pd(law) = law { Some((law.flight_law(), law.schedule())) } else { None }
        })?)),
        Some(LawKind::PhasePlane(_)) => {
            let all =
                all_of_kind(
                    laws,
                    |law| if let LawKind::PhasePlane(law) = law { Some(law.clone()) } else { None },
                )?;
            let has_damping = all.iter().any(|law| law.damping.is_some());
            let observers = scenario.study.adaptive.as_deref().filter(|_| has_damping);
            let modes = observers
                .and_then(|design| design.axes.iter().map(|axis| axis.start.len()).max())
                .unwrap_or(0);
            let each = all.iter().enumerate().map(|(axis, law)| law.flight_law(about(axis)));
            Ok(LawsOfAxes::PhasePlane(each.collect(), modes))
        }
        Some(LawKind::Attitude(_)) => {
            let all =
                all_of_kind(
                    laws,
                    |law| if let LawKind::Attitude(law) = law { Some(law.clone()) } else { None },
                )?;
            let each =
                all.iter().enumerate().map(|(axis, law)| (law.flight_law(about(axis)), law.flight_filters()));
            Ok(LawsOfAxes::Attitude(each.collect()))
        }
        Some(LawKind::StateSpace(_)) => {
            let all = all_of_kind(laws, |law| {
                if let LawKind::StateSpace(law) = law { Some(law.flight_law()) } else { None }
            })?;
            if all.iter().any(|law| law.is_acceleration != all[0].is_acceleration) {
                let reason = "differs between the axes: export laws that command one quantity";
                return Err(NotExportable::new("law.per_axis", reason));
            }
            // One law about three axes together is that of each axis.
            let is_together = all.iter().any(|law| !law.sources.is_empty());
            Ok(LawsOfAxes::StateSpace(if is_together { all[..1].to_vec() } else { all }))
        }
        law => {
            let kind = law.map_or("open", |law| law.kind());
            let reason = "has no code for flight: the laws `relay`, `pd`, `phase_plane`, `attitude`, `state_space` and `b_dot` have";
            Err(NotExportable::new(format!("law.{kind}"), reason))
        }
    }
}

/// Returns the distribution of torques to the wheels of a scenario; `None` if other actuators act too, or if the drives add
/// torques of their own.
pub(super) fn wheels(scenario: &Scenario) -> Option<WheelDistribution> {
    let ActuatorKind::Wheels(wheels) = scenario.actuator.only_actuator()? else { return None };
    let allocation = scenario.study.wheels.as_ref()?;
    if wheels.speed_bias.is_some() || wheels.compensation.is_some() || wheels.unloading.is_some() {
        return None;
    }
    Some(WheelDistribution {
        wheels: allocation.flight_wheels().to_vec(),
        limit: wheels.torque.map_or(f64::INFINITY, Positive::get),
        is_least_largest: allocation.is_least_largest(),
    })
}

/// Returns the groups of jets about the axes of a scenario; `None` if other actuators act too, if their thrusters are commanded one
/// by one, or if their period is not the law's.
pub(super) fn jets(scenario: &Scenario, period: Span) -> Option<Vec<JetPair>> {
    let ActuatorKind::Jets(jets) = scenario.actuator.only_actuator()? else { return None };
    let groups = scenario.study.groups.as_ref()?;
    if jets.allocation != FiringMethod::Groups || jets.period.is_some() {
        return None;
    }
    Some([0, 1, 2].map(|axis| jet_pair(groups, axis, period, jets.pulse_width())).to_vec())
}

/// Returns the commands of compensators: torques, or accelerations with those of the reference.
pub(super) fn compensator_commands(
    laws: &mut [Compensator],
    motions: &[AxisMotion],
    references: &[AxisReference],
    speeds: &[f64],
) -> Vec<f64> {
    let errors: Vec<[f64; 2]> = motions
        .iter()
        .zip(references)
        .map(|(motion, reference)| [reference.angle - motion.angle, reference.rate - motion.rate])
        .collect();
    let mut commands = vec![0.0; motions.len()];
    for (index, law) in laws.iter_mut().enumerate() {
        if law.sources.is_empty() {
            law.set_errors(errors[index]);
            law.advance();
            commands[index] = law.outputs[0];
        } else {
            let [angle, rate] =
                [0, 1].map(|part| Vector3 { x: errors[0][part], y: errors[1][part], z: errors[2][part] });
            law.read(&angle, &rate, speeds);
            law.advance();
            law.axes.iter().zip(&law.outputs).for_each(|(axis, output)| commands[*axis] = *output);
        }
        if law.is_acceleration {
            let reference = |(axis, command): (usize, &mut f64)| *command += references[axis].acceleration;
            if law.sources.is_empty() {
                commands[index] += references[index].acceleration;
            } else {
                commands.iter_mut().enumerate().for_each(reference);
            }
        }
    }
    commands
}
