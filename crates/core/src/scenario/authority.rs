//! Authority of the actuators about each axis, and the error bands that laws keep with it.

use super::Written;
use super::study::Study;
use crate::actuator::{Actuator, PulseWidth};
use crate::attitude::rotation_vector;
use crate::body::Spatial;
use crate::document::Fault;
use crate::estimator::adaptive;
use crate::law::{ActiveDamping, Authority, Law, PhasePlane, Promise, band};
use crate::quantity::Positive;
use crate::time::Instant;

/// Elastic rate that no structure reaches (rad/s).
const NO_MOTION: f64 = 1.0;

impl Study {
    /// Returns the authority of all actuators about an axis, until the first of them is at its limit with its share.
    pub(super) fn authority(&self, written: &Written, axis: usize) -> Authority {
        let members = written.actuator.members();
        let acting: Vec<_> = members.iter().filter(|member| member.share(axis) > 0.0).collect();
        let (accelerations, width, delay) = match &acting[..] {
            [] => ([0.0; 2], PulseWidth::default(), 0.0),
            [only] => self.authority_of(&only.kind, axis),
            several => {
                let each = several.iter().map(|member| {
                    let (most, _, delay) = self.authority_of(&member.kind, axis);
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
    fn authority_of(&self, kind: &Actuator, axis: usize) -> ([f64; 2], PulseWidth, f64) {
        let inertia = self.axes[axis].commanded_inertia();
        match kind {
            Actuator::Ideal(_) | Actuator::Hold(_) => ([f64::INFINITY; 2], PulseWidth::default(), 0.0),
            Actuator::Own(own) => {
                let most = own.limit(axis).map_or(f64::INFINITY, |limit| limit / inertia);
                ([most; 2], PulseWidth::default(), 0.0)
            }
            Actuator::Thrusters(thrusters) => {
                ([thrusters.torque.about(axis).get() / inertia; 2], thrusters.width(), 0.0)
            }
            Actuator::Wheel(wheel) => {
                let most = wheel.limit.map_or(f64::INFINITY, Positive::get) * wheel.gain.get() / inertia;
                ([most; 2], PulseWidth::default(), wheel.delay.get())
            }
            Actuator::Wheels(wheels) => {
                let limit = wheels.torque.map_or(f64::INFINITY, Positive::get);
                let most = self.wheels.as_ref().map_or(f64::INFINITY, |wheels| wheels.most(axis, limit));
                ([most / inertia; 2], PulseWidth::default(), 0.0)
            }
            Actuator::ControlMomentGyros(gyros) => {
                ([gyros.most(&self.gimbals, axis) / inertia; 2], PulseWidth::default(), 0.0)
            }
            Actuator::Magnetorquers(torquers) => {
                let field = self.around.as_ref().map_or(0.0, |around| around.sky().field_bound());
                ([torquers.largest() * field / inertia; 2], PulseWidth::default(), 0.0)
            }
            Actuator::Jets(jets) => {
                let groups = self.groups.as_ref().map(|groups| &groups[axis]);
                let of = |sign: usize| groups.map_or(f64::INFINITY, |groups| groups[sign].acceleration);
                let period = jets.period.or(self.cycle).unwrap_or(self.tick);
                ([of(0), of(1)], jets.width(), f64::from(jets.delay) * period.seconds())
            }
        }
    }

    /// Returns the elastic rate above which the active damping of an axis acts (rad/s); 0 for a law without it.
    pub(super) fn threshold(&self, written: &Written, axis: usize) -> Result<f64, Fault> {
        let Law::PhasePlane(PhasePlane { damping: Some(damping), .. }) = written.law.about(axis) else {
            return Ok(0.0);
        };
        let key = format!("{}.damping", written.law_key(axis));
        let Some(plan) = &self.adaptive else {
            let why = "needs the elastic rates of an `[estimator.adaptive]`, and there is none";
            return Err(Fault::new(key, why));
        };
        let threshold = threshold(damping, plan, &self.authorities[axis], axis);
        if damping.threshold.is_none() && threshold >= NO_MOTION {
            let name = if self.axes.len() == 1 { "the law" } else { crate::attitude::AXES[axis] };
            return Err(Fault::new(
                key,
                format!(
                    "gives {name} a threshold of {threshold:e} rad/s, which is never reached: with this delay an undamped mode \
                     has no stable gain; give `threshold`, or the estimator a damping ratio above 0"
                ),
            ));
        }
        Ok(threshold)
    }

    pub(super) fn band(&self, written: &Written, body: Option<&Spatial>, axis: usize) -> Option<f64> {
        match (written.law.about(axis), body) {
            (Law::PhasePlane(law), _) => Some(band(law, &self.authorities[axis])),
            (law, Some(body)) => match law.promise() {
                Promise::Nothing => None,
                Promise::Within(band) => Some(band),
                Promise::Part(part) => {
                    // Relative to the whole rotation to the last target.
                    let end = Instant::START + written.duration;
                    let goal = self.way.target(written.last_target(end));
                    let before = written.targets().iter().rev().nth(1);
                    let from =
                        before.map_or_else(|| body.attitude.get(), |target| self.way.target(target.begins()));
                    let distance = rotation_vector(&goal, &from).norm();
                    (distance > 0.0).then_some(part * distance)
                }
            },
            _ => None,
        }
    }

    /// Returns the arrival band about a target, for each axis (rad); NaN without one.
    pub fn zones(&self, written: &Written) -> [f64; 3] {
        let mut zones = [f64::NAN; 3];
        for (axis, (zone, band)) in zones.iter_mut().zip(&self.bands).enumerate() {
            *zone = match written.law.about(axis) {
                Law::PhasePlane(law) => law.dead_zone.get(),
                _ => band.unwrap_or(f64::NAN),
            };
        }
        zones
    }
}

/// Returns the threshold of active damping about an axis (rad/s), for the modes of the observer's design.
fn threshold(
    damping: &ActiveDamping,
    plan: &adaptive::ObserverDesign,
    authority: &Authority,
    axis: usize,
) -> f64 {
    let ratio = match &plan.form {
        adaptive::Form::Gradient(form) => form.damping.get(),
        adaptive::Form::Recurrence(form) => form.damping.get(),
    };
    let design = &plan.axes[axis];
    let own = design.own(axis);
    let mode = |mode: &adaptive::Merged| {
        let influence = mode.tracker.influence.get(own).map_or(0.0, |influence| influence.get());
        [mode.tracker.frequency.get(), influence.max(0.0) * authority.accelerations[0]]
    };
    let modes: Vec<_> = design.modes.iter().map(mode).collect();
    damping.threshold(axis, &modes, plan.period, authority.delay, ratio)
}
