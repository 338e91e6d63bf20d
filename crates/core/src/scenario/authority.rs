//! Authority of the actuators about each axis, and the error bands that laws keep with it.

use flexsc_control::actuator::{ActuatorKind, PulseWidth};
use flexsc_control::estimator::adaptive;
use flexsc_control::law::{ActiveDamping, Authority, ErrorBand, LawKind, PhasePlane, error_band};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::rotation_vector;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::body::Spatial;

use super::ScenarioSpec;
use super::resolved::ResolvedScenario;

/// Elastic rate that no structure reaches (rad/s).
const NO_MOTION: f64 = 1.0;

impl ResolvedScenario {
    /// Returns the authority of all actuators about an axis, until the first of them is at its limit with its share.
    pub(super) fn authority(&self, written: &ScenarioSpec, axis: usize) -> Authority {
        let members = written.actuator.members();
        let acting: Vec<_> = members.iter().filter(|member| member.share(axis) > 0.0).collect();
        let (accelerations, width, delay) = match &acting[..] {
            [] => ([0.0; 2], PulseWidth::default(), 0.0),
            [only] => self.actuator_authority(&only.kind, axis),
            several => {
                let each = several.iter().map(|member| {
                    let (most, _, delay) = self.actuator_authority(&member.kind, axis);
                    (most.map(|most| most / member.share(axis)), delay)
                });
                let (most, late) =
                    each.fold(([f64::INFINITY; 2], 0.0_f64), |(least, late), (most, delay)| {
                        ([least[0].min(most[0]), least[1].min(most[1])], late.max(delay))
                    });
                (most, PulseWidth::default(), late)
            }
        };
        Authority { axis, accelerations, width, delay, threshold: 0.0 }
    }

    /// Returns the authority of one actuator acting alone: largest accelerations (rad/s²), pulse widths, and delay (s).
    fn actuator_authority(&self, kind: &ActuatorKind, axis: usize) -> ([f64; 2], PulseWidth, f64) {
        let inertia = self.axes[axis].commanded_inertia();
        match kind {
            ActuatorKind::Ideal(_) | ActuatorKind::Hold(_) => {
                ([f64::INFINITY; 2], PulseWidth::default(), 0.0)
            }
            ActuatorKind::Own(own) => {
                let most = own.limit(axis).map_or(f64::INFINITY, |limit| limit / inertia);
                ([most; 2], PulseWidth::default(), 0.0)
            }
            ActuatorKind::Thrusters(thrusters) => {
                ([thrusters.torque.about(axis).get() / inertia; 2], thrusters.width(), 0.0)
            }
            ActuatorKind::Wheel(wheel) => {
                let most = wheel.limit.map_or(f64::INFINITY, Positive::get) * wheel.gain.get() / inertia;
                ([most; 2], PulseWidth::default(), wheel.delay.get())
            }
            ActuatorKind::Wheels(wheels) => {
                let limit = wheels.torque.map_or(f64::INFINITY, Positive::get);
                let most =
                    self.wheels.as_ref().map_or(f64::INFINITY, |wheels| wheels.largest_torque(axis, limit));
                ([most / inertia; 2], PulseWidth::default(), 0.0)
            }
            ActuatorKind::ControlMomentGyros(gyros) => {
                ([gyros.largest_torque(&self.gimbals, axis) / inertia; 2], PulseWidth::default(), 0.0)
            }
            ActuatorKind::Magnetorquers(torquers) => {
                let field = self.surroundings.as_ref().map_or(0.0, |around| around.sky().field_bound());
                ([torquers.largest_moment() * field / inertia; 2], PulseWidth::default(), 0.0)
            }
            ActuatorKind::Jets(jets) => {
                let groups = self.groups.as_ref().map(|groups| &groups[axis]);
                let of = |sign: usize| groups.map_or(f64::INFINITY, |groups| groups[sign].acceleration);
                let period = jets.period.or(self.law_period).unwrap_or(self.assessment_period);
                ([of(0), of(1)], jets.pulse_width(), f64::from(jets.delay) * period.seconds())
            }
        }
    }

    /// Returns the elastic rate above which the active damping of an axis acts (rad/s); 0 for a law without it.
    pub(super) fn damping_threshold(&self, written: &ScenarioSpec, axis: usize) -> Result<f64, ConfigError> {
        let LawKind::PhasePlane(PhasePlane { damping: Some(damping), .. }) = written.law.about(axis) else {
            return Ok(0.0);
        };
        let key = format!("{}.damping", written.law_key(axis));
        let Some(plan) = &self.adaptive else {
            let why = "needs the elastic rates of an `[estimator.adaptive]`, and there is none";
            return Err(ConfigError::new(key, why));
        };
        let threshold = damping_threshold(damping, plan, &self.authorities[axis], axis);
        if damping.threshold.is_none() && threshold >= NO_MOTION {
            let name = if self.axes.len() == 1 { "the law" } else { flexsc_numerics::attitude::AXES[axis] };
            return Err(ConfigError::new(
                key,
                format!(
                    "gives {name} a threshold of {threshold:e} rad/s, which is never reached: with this delay an undamped mode \
                     has no stable gain; give `threshold`, or the estimator a damping ratio above 0"
                ),
            ));
        }
        Ok(threshold)
    }

    pub(super) fn error_band(
        &self,
        written: &ScenarioSpec,
        body: Option<&Spatial>,
        axis: usize,
    ) -> Option<f64> {
        match (written.law.about(axis), body) {
            (LawKind::PhasePlane(law), _) => Some(error_band(law, &self.authorities[axis])),
            (law, Some(body)) => match law.expected_band() {
                ErrorBand::None => None,
                ErrorBand::Absolute(band) => Some(band),
                ErrorBand::Fraction(part) => {
                    // Relative to the whole rotation to the last target.
                    let end = Instant::START + written.duration;
                    let goal = self.profile.target(written.last_target_start(end));
                    let before = written.targets().iter().rev().nth(1);
                    let from = before
                        .map_or_else(|| body.attitude.get(), |target| self.profile.target(target.starts()));
                    let distance = rotation_vector(&goal, &from).norm();
                    (distance > 0.0).then_some(part * distance)
                }
            },
            _ => None,
        }
    }

    /// Returns the arrival band about a target, for each axis (rad); NaN without one.
    pub fn arrival_bands(&self, written: &ScenarioSpec) -> [f64; 3] {
        let mut zones = [f64::NAN; 3];
        for (axis, (zone, band)) in zones.iter_mut().zip(&self.expected_bands).enumerate() {
            *zone = match written.law.about(axis) {
                LawKind::PhasePlane(law) => law.dead_zone.get(),
                _ => band.unwrap_or(f64::NAN),
            };
        }
        zones
    }
}

/// Returns the threshold of active damping about an axis (rad/s), for the modes of the observer's design.
fn damping_threshold(
    damping: &ActiveDamping,
    plan: &adaptive::ObserverDesign,
    authority: &Authority,
    axis: usize,
) -> f64 {
    let ratio = match &plan.form {
        adaptive::ObserverForm::Gradient(form) => form.damping.get(),
        adaptive::ObserverForm::Recurrence(form) => form.damping.get(),
    };
    let design = &plan.axes[axis];
    let own = design.own_axis_input(axis);
    let mode = |mode: &adaptive::MergedTracker| {
        let influence = mode.tracker.influence.get(own).map_or(0.0, |influence| influence.get());
        [mode.tracker.frequency.get(), influence.max(0.0) * authority.accelerations[0]]
    };
    let modes: Vec<_> = design.modes.iter().map(mode).collect();
    damping.threshold(axis, &modes, plan.period, authority.delay, ratio)
}
