//! Laws about the axes of a scenario as plain code.

use flexsc_core::Scenario;
use flexsc_core::control::law::{Authority, Compensator, LawKind};
use flexsc_flight::attitude_law::AttitudeFeedback;
use flexsc_flight::axis_motion::{AxisMotion, AxisReference};
use flexsc_flight::biquad::BiquadFilter;
use flexsc_flight::gain_schedule::SchedulePoint;
use flexsc_flight::pd::PdLaw;
use flexsc_flight::phase_plane::PhasePlaneLaw;
use flexsc_flight::vector3::Vector3;

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
