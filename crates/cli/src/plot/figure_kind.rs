//! The kinds of figures, and the conditions for a log to have them.

use clap::ValueEnum;
use flexsc_core::control::estimator::EstimatorKind;
use flexsc_figure::Figure;

use super::cycle_data::CycleData;
use super::motion::MotionData;
use super::run_events::RunEvents;
use super::three_axis;
use super::{
    accelerations, angle, attitude_filter, consistency, dead_zone, deflection, drives, envelope, estimate,
    extra_loop, flywheel, frequency, gain, gimbals, hinges, identified_frequencies, line_of_sight,
    magnetorquers, manoeuvre_torque, modes, orbit, outputs, phase_plane, pointing, torque, torques, wheels,
};

/// A figure.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
pub enum FigureKind {
    /// Rate against angle, with the law's switching lines
    PhasePlane,
    /// Torque; with a switching law, at the end of the run
    Torque,
    /// Angle of the hub, with its goal and settling time; with a switching law, at the end of the run
    Angle,
    /// Each observed coordinate
    Outputs,
    /// Envelope of the elastic modes with its window means, and the elastic angle
    Envelope,
    /// Gain and decisions of the adaptation
    Gain,
    /// Each elastic mode; with a switching law, at the end of the run
    Modes,
    /// Three axes: pointing error, with its goal band and dead zone
    Pointing,
    /// Three axes: rates, rigid and at the gyro
    Rates,
    /// Three axes: torques demanded by the law, given by the actuators, and of disturbances
    Torques,
    /// Three axes: deflection of each point of the structure that modes move
    Deflection,
    /// Three axes: energy of the elastic modes, and propellant
    Energy,
    /// Three axes: position and velocity, where jets or forces move the spacecraft
    Position,
    /// Three axes: firing times of the jets
    Jets,
    /// Three axes: natural frequencies estimated by adaptive observers, and the true ones
    Tracking,
    /// Three axes: elastic rates for active damping, its thresholds and pulses
    Damping,
    /// Speed and momentum of the flywheel, or speed and torque of each wheel, with limits
    Wheel,
    /// Control moment gyros: gimbal angles and rates, singularity measure, momentum
    Gimbals,
    /// Three axes: magnetic moments, and the momentum of the wheels or the rate
    Magnetorquers,
    /// Three axes: readings of the accelerometers
    Accelerations,
    /// Three axes: error of each line of sight, and displacement of its point
    LineOfSight,
    /// Three axes in orbit: magnetic field, nadir and Sun in body axes, and the eclipse
    Orbit,
    /// Rotating appendages: drive angles and natural frequencies
    Drives,
    /// Appendages on hinges: their angles and rates
    Hinges,
    /// Frequency of the dominant mode, or of those that an attitude filter identifies, estimated and true
    Frequency,
    /// Displacement of the dominant mode, estimated and true
    Estimate,
    /// Consistency of a filter: NIS and NEES with 95 % bands; of an attitude filter, errors and NEES
    Consistency,
    /// Gain of the extra loop, and the frequency it is scheduled on
    Extra,
    /// Campaigns: histogram and empirical distribution of each metric, with median, 5 % and 95 %
    Distribution,
    /// Campaigns: each metric against the keys that were drawn
    Scatter,
    /// Campaigns with logs: median, 25 to 75 % and 5 to 95 % of the main signals over time
    Fan,
    /// Sweeps over one key: each metric over the key
    Curve,
    /// Sweeps over two keys: each metric as a map
    Region,
}

impl FigureKind {
    /// Returns the figures that a log has.
    pub fn all_in(story: &RunEvents) -> Vec<Self> {
        Self::value_variants().iter().copied().filter(|kind| kind.is_in(story)).collect()
    }

    /// Returns true if a log has the data of the figure.
    fn is_in(self, story: &RunEvents) -> bool {
        let is_three_axis = story.scenario.axis_count() == 3;
        match self {
            Self::PhasePlane => story.switches() && !is_three_axis,
            Self::Torque | Self::Angle => !is_three_axis,
            Self::Torques => is_three_axis && torques::applies_to(story),
            Self::Deflection => deflection::applies_to(story),
            Self::Outputs => !story.scenario.model.outputs().is_empty() && !story.switches(),
            Self::Envelope => {
                story.scenario.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some())
            }
            Self::Gain => !story.steps.is_empty(),
            Self::Modes => !is_three_axis && story.scenario.mode_count() > 0,
            Self::Pointing | Self::Rates | Self::Energy => is_three_axis,
            Self::Position => story.scenario.study.translation.is_some(),
            Self::Jets => story.scenario.study.fires(),
            Self::Tracking => story.scenario.study.adaptive.is_some() && is_three_axis,
            Self::Damping => {
                is_three_axis
                    && story.scenario.study.authorities.iter().any(|authority| authority.threshold > 0.0)
            }
            Self::Wheel => {
                flywheel::rotor(story).is_some() && !is_three_axis || wheels::wheels(story).is_some()
            }
            Self::Orbit => is_three_axis && orbit::applies_to(story),
            Self::Gimbals => gimbals::applies_to(story),
            Self::Magnetorquers => magnetorquers::applies_to(story),
            Self::Drives => story.scenario.study.articulation().is_some(),
            Self::Hinges => story.scenario.study.hinges() > 0,
            Self::Accelerations => accelerations::applies_to(story),
            Self::LineOfSight => line_of_sight::applies_to(story),
            Self::Consistency if is_three_axis => {
                story.scenario.estimator.as_ref().is_some_and(|estimator| estimator.attitude().is_some())
            }
            Self::Frequency if is_three_axis => identified_frequencies::applies_to(story),
            Self::Frequency | Self::Estimate | Self::Consistency => {
                !is_three_axis
                    && story.scenario.estimator.as_ref().is_some_and(EstimatorKind::filters_measurements)
            }
            Self::Extra => extra_loop::extra(story).is_some(),
            Self::Distribution | Self::Scatter | Self::Fan | Self::Curve | Self::Region => false,
        }
    }

    /// Returns the topics of a three-axis run whose rows the figure shows.
    pub fn topics(self) -> &'static [&'static str] {
        match self {
            Self::Pointing => &["/pointing"],
            Self::Rates => &["/rates"],
            Self::Torques => &["/torques"],
            Self::Deflection => &["/vibrations"],
            Self::Energy => &["/energy", "/jets"],
            Self::Position => &["/position"],
            Self::Jets => &["/jets"],
            Self::Tracking | Self::Damping => &["/tracking"],
            Self::Wheel => &["/wheels", "/bearings", "/pointing"],
            Self::Gimbals => &["/control_moment_gyros"],
            Self::Magnetorquers => &["/magnetorquers", "/wheels", "/rates"],
            Self::Accelerations => &["/accelerations"],
            Self::LineOfSight => &["/line_of_sight"],
            Self::Orbit => &["/orbit"],
            Self::Drives => &["/drives"],
            Self::Hinges => &["/hinges"],
            Self::Frequency => &["/attitude_filter_modes"],
            Self::Consistency => &["/attitude_filter"],
            Self::PhasePlane
            | Self::Torque
            | Self::Angle
            | Self::Outputs
            | Self::Envelope
            | Self::Gain
            | Self::Modes
            | Self::Estimate
            | Self::Extra
            | Self::Distribution
            | Self::Scatter
            | Self::Fan
            | Self::Curve
            | Self::Region => &[],
        }
    }

    /// Returns the figure of a log; `None` for a kind that only campaigns have.
    pub fn figure(self, story: &RunEvents, motion: &MotionData, cycles: &CycleData) -> Option<Figure> {
        Some(match self {
            Self::PhasePlane => phase_plane::figure(story, motion),
            Self::Torque if story.switches() => torque::figure(story),
            Self::Torque => manoeuvre_torque::figure(story, motion),
            Self::Angle if story.switches() => dead_zone::figure(story, motion),
            Self::Angle => angle::figure(story, motion),
            Self::Outputs => outputs::figure(story, motion),
            Self::Envelope if story.scenario.axis_count() == 3 => envelope::over_windows(story),
            Self::Envelope => envelope::figure(story, motion),
            Self::Gain => gain::figure(story),
            Self::Modes => modes::figure(story, motion),
            Self::Pointing => pointing::figure(story, cycles),
            Self::Rates => three_axis::rates(story, cycles),
            Self::Torques => torques::figure(story, cycles),
            Self::Deflection => deflection::figure(story, cycles),
            Self::Energy => three_axis::energy(story, cycles),
            Self::Position => three_axis::position(story, cycles),
            Self::Jets => three_axis::jets(story, cycles),
            Self::Tracking => three_axis::tracking(story, cycles),
            Self::Damping => three_axis::damping(story, cycles),
            Self::Wheel if wheels::wheels(story).is_some() => wheels::figure(story, cycles),
            Self::Wheel => flywheel::figure(story, motion),
            Self::Orbit => orbit::figure(story, cycles),
            Self::Gimbals => gimbals::figure(story, cycles),
            Self::Magnetorquers => magnetorquers::figure(story, cycles),
            Self::Drives => drives::figure(story, cycles),
            Self::Hinges => hinges::figure(story, cycles),
            Self::Accelerations => accelerations::figure(story, cycles),
            Self::LineOfSight => line_of_sight::figure(story, cycles),
            Self::Frequency if story.scenario.axis_count() == 3 => {
                identified_frequencies::figure(story, cycles)
            }
            Self::Frequency => frequency::figure(story, motion),
            Self::Estimate => estimate::figure(story, motion),
            Self::Consistency if story.scenario.axis_count() == 3 => attitude_filter::figure(story, cycles),
            Self::Consistency => consistency::figure(story, motion),
            Self::Extra => extra_loop::figure(story, motion),
            Self::Distribution | Self::Scatter | Self::Fan | Self::Curve | Self::Region => return None,
        })
    }

    /// Returns the name of the figure as `--what` accepts it.
    pub fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
}

/// Returns the requested figures of the existing ones: all if none is requested.
pub fn select(
    requested: &[FigureKind],
    drawable: &[FigureKind],
) -> Result<Vec<FigureKind>, (String, String)> {
    match requested.iter().find(|kind| !drawable.contains(kind)) {
        Some(missing) => {
            let names: Vec<_> = drawable.iter().map(|kind| kind.name()).collect();
            Err((missing.name(), names.join(", ")))
        }
        None if requested.is_empty() => Ok(drawable.to_vec()),
        None => {
            let once =
                |(index, kind): (usize, &FigureKind)| (!requested[..index].contains(kind)).then_some(*kind);
            Ok(requested.iter().enumerate().filter_map(once).collect())
        }
    }
}
