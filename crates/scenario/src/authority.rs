//! Authority of the actuators about each axis, and the error bands that laws keep with it.

use flexsc_control::actuator::{
    ActuatorAuthority, ActuatorKind, ActuatorPlacement, AssignedMember, GroupEffect, PulseWidth,
};
use flexsc_control::estimator::adaptive;
use flexsc_control::law::{ActiveDamping, Authority, ErrorBand, LawKind, PlacedLaw, Stage};
use flexsc_control::sensor::Tachometer;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::rotation_vector;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;

use super::ScenarioSpec;
use super::resolved::ResolvedScenario;

/// Elastic rate that no structure reaches (rad/s).
const NO_MOTION: f64 = 1.0;

impl ResolvedScenario {
    /// Returns the authority about an axis of all actuators, or of those in a stage of the law, until the first of them
    /// is at its limit with its share.
    pub(super) fn authority(&self, written: &ScenarioSpec, axis: usize, stage: Option<&Stage>) -> Authority {
        let (placement, inertia) =
            (self.placement(written, self.groups.as_ref(), None), self.axes[axis].commanded_inertia());
        let alone = |kind: &ActuatorKind| kind.authority(axis, inertia, &placement);
        let members = written.actuator.members();
        let acts = |member: &&AssignedMember<'_>| {
            member.share(axis) > 0.0 && stage.is_none_or(|stage| stage.selects(member.kind.kind()))
        };
        let acting: Vec<_> = members.iter().filter(acts).collect();
        let ActuatorAuthority { accelerations, width, delay } = match &acting[..] {
            [] => ActuatorAuthority { accelerations: [0.0; 2], width: PulseWidth::default(), delay: 0.0 },
            [only] => alone(&only.kind),
            several => {
                let each = several.iter().map(|member| {
                    let ActuatorAuthority { accelerations, delay, .. } = alone(&member.kind);
                    (accelerations.map(|most| most / member.share(axis)), delay)
                });
                let (most, late) =
                    each.fold(([f64::INFINITY; 2], 0.0_f64), |(least, late), (most, delay)| {
                        ([least[0].min(most[0]), least[1].min(most[1])], late.max(delay))
                    });
                ActuatorAuthority { accelerations: most, width: PulseWidth::default(), delay: late }
            }
        };
        let precision = written.flight_precision;
        Authority { axis, accelerations, width, delay, threshold: 0.0, precision }
    }

    /// Returns the data of the body that its actuators depend on, with groups of jets.
    pub(super) fn placement<'a>(
        &'a self,
        written: &ScenarioSpec,
        groups: Option<&'a [[GroupEffect; 2]; 3]>,
        tachometer: Option<(&'a Tachometer, Seed)>,
    ) -> ActuatorPlacement<'a> {
        ActuatorPlacement {
            wheels: self.wheels.as_ref(),
            gimbals: &self.gimbals,
            field: self.surroundings.as_ref().map_or(0.0, |around| around.sky().field_bound()),
            groups,
            nozzles: &self.nozzles,
            period: written.law.cycle(0, "jets").unwrap_or(self.assessment_period),
            tachometer,
            precision: written.flight_precision,
        }
    }

    /// Sets the elastic rates above which active damping acts (rad/s), about each axis and in each stage or mode.
    pub(super) fn set_damping_thresholds(&mut self, written: &ScenarioSpec) -> Result<(), ConfigError> {
        for axis in 0..self.axes.len() {
            for (index, placed) in written.law.laws_about(axis).iter().enumerate() {
                let own = self.stage_authorities.get(axis).and_then(|stages| stages.get(index)).copied();
                let threshold =
                    self.damping_threshold(placed, axis, &own.unwrap_or(self.authorities[axis]))?;
                if let Some(own) =
                    self.stage_authorities.get_mut(axis).and_then(|stages| stages.get_mut(index))
                {
                    own.threshold = threshold;
                }
                let common = &mut self.authorities[axis];
                common.threshold = common.threshold.max(threshold);
            }
        }
        Ok(())
    }

    /// Returns the elastic rate above which the active damping of a law about an axis acts (rad/s); 0 for a law without it.
    fn damping_threshold(
        &self,
        placed: &PlacedLaw<'_>,
        axis: usize,
        authority: &Authority,
    ) -> Result<f64, ConfigError> {
        let Some(damping) = placed.law.active_damping() else { return Ok(0.0) };
        let key = format!("{}.damping", placed.key);
        // Without elastic rates the requirement of the law was reported.
        let Some(plan) = &self.adaptive else { return Ok(0.0) };
        let threshold = damping_threshold(damping, plan, authority, axis);
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
        body: Option<&ThreeAxisModel>,
        axis: usize,
    ) -> Option<f64> {
        // Of stages and modes the last one promises the band.
        let law =
            written.law.laws_about(axis).pop().map_or_else(|| written.law.about(axis), |placed| placed.law);
        if let Some(band) = law.band_with(&self.authorities[axis]) {
            return Some(band);
        }
        let body = body?;
        match law.expected_band() {
            ErrorBand::None => None,
            ErrorBand::Absolute(band) => Some(band),
            band @ ErrorBand::Fraction(_) => {
                // Relative to the whole rotation to the last target.
                let end = Instant::START + written.duration;
                let goal = self.profile.target(written.last_target_start(end));
                let before = written.targets().iter().rev().nth(1);
                let from =
                    before.map_or_else(|| body.attitude.get(), |target| self.profile.target(target.starts()));
                let distance = rotation_vector(&goal, &from).norm();
                Some(band.band(distance)).filter(|band| band.is_finite())
            }
        }
    }

    /// Returns the bands about the target of each mode of operation, for each axis, as its law promises them.
    pub(super) fn mode_bands(&self, written: &ScenarioSpec) -> Vec<Vec<ErrorBand>> {
        let about = |mode: usize, axis: usize| {
            let law = written.mode[mode].law.about(axis);
            let authority = self.stage_authorities.get(axis).and_then(|modes| modes.get(mode));
            promised_band(law, authority)
        };
        let axes = self.axes.len();
        (0..written.mode.len()).map(|mode| (0..axes).map(|axis| about(mode, axis)).collect()).collect()
    }

    /// Returns the arrival band about a target, for each axis (rad); NaN without one.
    pub fn arrival_bands(&self, written: &ScenarioSpec) -> [f64; 3] {
        let mut zones = [f64::NAN; 3];
        for (axis, (zone, band)) in zones.iter_mut().zip(&self.expected_bands).enumerate() {
            *zone = written.law.about(axis).coasting_zone().or(*band).unwrap_or(f64::NAN);
        }
        zones
    }
}

/// Returns the band about the target that a law promises, with its authority about an axis.
pub(super) fn promised_band(law: &LawKind, authority: Option<&Authority>) -> ErrorBand {
    let own = authority.and_then(|authority| law.band_with(authority));
    own.map_or_else(|| law.expected_band(), ErrorBand::Absolute)
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
