//! The loop about three axes that a scenario describes: its parts, which fit each other.

use super::Scenario;
use crate::actuator::{Actuator, Group, Jets};
use crate::body::{Body, Spatial};
use crate::estimator::{Estimator, RigidRate, adaptive};
use crate::law::{Damping, Law, PhasePlane, band as law_band};
use crate::sensor::{Gyro, Sensor};
use crate::structure::Fault;

/// A spatial body, its gyro, its estimator, its law and its jets.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialLoop {
    /// What is controlled.
    pub body: Spatial,
    /// What is measured.
    pub gyro: Gyro,
    /// What is estimated; without it the law reads the gyro.
    pub estimator: Option<AxesEstimator>,
    /// What commands the jets.
    pub law: PhasePlane,
    /// What pushes.
    pub jets: Jets,
    /// What each group of jets does: for each axis, plus and minus.
    pub groups: [[Group; 2]; 3],
    /// Elastic rates beyond which the law damps actively (rad/s).
    pub thresholds: [f64; 3],
    /// How near to its target the law keeps the body about each axis (rad).
    pub bands: [f64; 3],
}

/// The estimators of a spatial body.
#[derive(Clone, Debug, PartialEq)]
pub enum AxesEstimator {
    /// Rigid rates alone.
    RigidRate(RigidRate),
    /// Adaptive observers.
    Adaptive(Box<adaptive::Plan>),
}

impl SpatialLoop {
    /// The loop of a scenario; none if its body has one angle.
    ///
    /// # Errors
    /// A key that does not fit the others, and why.
    pub fn of(scenario: &Scenario) -> Result<Option<Self>, Fault> {
        let Body::Spatial(body) = &scenario.body else {
            return planar_only(scenario).map_or(Ok(None), Err);
        };
        let refused = |key: &str, why: &str| Err((key.to_owned(), why.to_owned()));
        let Law::PhasePlane(law) = &scenario.law else {
            return refused("law", "must be `phase_plane` for a `[body.spatial]`");
        };
        let Sensor::Gyro(gyro) = &scenario.sensor else {
            return refused("sensor", "must be `gyro` for a `[body.spatial]`");
        };
        let Actuator::Jets(jets) = &scenario.actuator else {
            return refused("actuator", "must be `jets` for a `[body.spatial]`");
        };
        for (there, key) in [
            (scenario.adaptation.is_some(), "adaptation"),
            (scenario.drift.is_some(), "drift"),
            (scenario.manoeuvre.is_some(), "manoeuvre"),
            (!scenario.disturbance.is_empty(), "disturbance"),
        ] {
            if there {
                let instead = match key {
                    "manoeuvre" => ": its law has `targets`",
                    "disturbance" => ": it has a `body.spatial.disturbance`",
                    _ => "",
                };
                return refused(
                    key,
                    &format!("is for bodies with one angle, not for a `[body.spatial]`{instead}"),
                );
            }
        }
        if body.point(&gyro.point).is_none() {
            let (points, found) = (body.point_names(), &gyro.point);
            let why = format!("must be one of the body's points, {points}, got `{found}`");
            return refused("sensor.gyro.point", &why);
        }
        let within = |kind: &'static str| move |(key, why): Fault| (format!("{kind}.{key}"), why);
        if let Some(fault) = law.inconsistency().map(within("law.phase_plane")) {
            return Err(fault);
        }
        let period = law.period.seconds();
        for (key, value) in [("minimum_on", jets.minimum_on.get()), ("quantum", jets.quantum.get())] {
            if value > period {
                let why = format!("must be at most the law's period of {period} s, got {value}");
                return refused(&format!("actuator.jets.{key}"), &why);
            }
        }
        if jets.delay > 1 {
            return refused("actuator.jets.delay", &format!("must be 0 or 1 cycles, got {}", jets.delay));
        }
        let groups = jets.groups_on(body).map_err(within("actuator.jets"))?;
        let estimator = match &scenario.estimator {
            None => None,
            Some(Estimator::RigidRate(estimator)) => Some(AxesEstimator::RigidRate(estimator.clone())),
            Some(Estimator::Adaptive(spec)) => {
                let plan = adaptive::Plan::of(spec, body, &gyro.point, &groups, period);
                let fault = |(key, why): Fault| match key.as_str() {
                    "" => ("estimator.adaptive".to_owned(), why),
                    key => (format!("estimator.adaptive.{key}"), why),
                };
                Some(AxesEstimator::Adaptive(Box::new(plan.map_err(fault)?)))
            }
            Some(_) => {
                let why = "must be `rigid_rate`, `adaptive` or left out for a `[body.spatial]`";
                return refused("estimator", why);
            }
        };
        let thresholds = match (&law.damping, &estimator) {
            (None, _) => [0.0; 3],
            (Some(damping), Some(AxesEstimator::Adaptive(plan))) => {
                thresholds(damping, plan, &groups, f64::from(jets.delay) * period)
            }
            (Some(_), _) => {
                let why = "acts on elastic rates, which an `[estimator.adaptive]` tells, and there is none";
                return refused("law.phase_plane.damping", why);
            }
        };
        let by_rule = law.damping.as_ref().is_some_and(|damping| damping.threshold.is_none());
        if let Some(axis) = thresholds.iter().position(|threshold| by_rule && *threshold >= NO_MOTION) {
            let why = format!(
                "gives {} a threshold of {:e} rad/s, which nothing reaches: the delay leaves an undamped mode no stable \
                 gain; give `threshold`, or the estimator a damping ratio above 0",
                ["roll", "pitch", "yaw"][axis],
                thresholds[axis]
            );
            return refused("law.phase_plane.damping", &why);
        }
        Ok(Some(Self {
            body: body.clone(),
            gyro: gyro.clone(),
            estimator,
            law: law.clone(),
            jets: jets.clone(),
            bands: [0, 1, 2].map(|axis| law_band(law, jets, accelerations(&groups, axis))),
            groups,
            thresholds,
        }))
    }
}

/// Accelerations of plus and minus about an axis (rad/s²).
fn accelerations(groups: &[[Group; 2]; 3], axis: usize) -> [f64; 2] {
    [0, 1].map(|sign| groups[axis][sign].acceleration)
}

/// No structure has elastic rates like this (rad/s).
const NO_MOTION: f64 = 1.0;

/// The thresholds of active damping about each axis, for the modes of the design and a delay (s).
fn thresholds(damping: &Damping, plan: &adaptive::Plan, groups: &[[Group; 2]; 3], delay: f64) -> [f64; 3] {
    let ratio = match &plan.form {
        adaptive::Form::Gradient(form) => form.damping.get(),
        adaptive::Form::Recurrence(form) => form.damping.get(),
    };
    std::array::from_fn(|axis| {
        let design = &plan.axes[axis];
        let own = design.own(axis);
        let mode = |mode: &adaptive::Merged| {
            let influence = mode.tracker.influence.get(own).map_or(0.0, |influence| influence.get());
            [mode.tracker.frequency.get(), influence.max(0.0) * groups[axis][0].acceleration]
        };
        let modes: Vec<_> = design.modes.iter().map(mode).collect();
        damping.threshold(axis, &modes, plan.period, delay, ratio)
    })
}

/// A part that only a spatial body can have, of a scenario with another.
fn planar_only(scenario: &Scenario) -> Option<Fault> {
    let key = if matches!(scenario.law, Law::PhasePlane(_)) {
        "law.phase_plane"
    } else if matches!(scenario.sensor, Sensor::Gyro(_)) {
        "sensor.gyro"
    } else if matches!(scenario.actuator, Actuator::Jets(_)) {
        "actuator.jets"
    } else if matches!(scenario.estimator, Some(Estimator::RigidRate(_))) {
        "estimator.rigid_rate"
    } else if matches!(scenario.estimator, Some(Estimator::Adaptive(_))) {
        "estimator.adaptive"
    } else {
        return None;
    };
    let why = format!("is for a `[body.spatial]`, and the body is `{}`", scenario.body.kind());
    Some((key.to_owned(), why))
}
