//! Laws that decide at their period, with their estimators and actuators.

use super::law_scope::LawScope;
use super::text::{local, words};
use super::{Glue, actuation, attitude, kalman, momentum, rate};
use crate::control_system::SampledLaws;

/// Adds the laws.
pub fn add(glue: &mut Glue<'_>, laws: &SampledLaws) {
    let (actuation, estimator) = (&laws.actuation, laws.estimator.as_ref());
    let own = LawScope { laws, mode: None, has_attitude: estimator.is_some() };
    glue.members.extend(own.members());
    own.add_constants(glue);
    if let Some(unit) = estimator {
        attitude::add(glue, unit, "Ticks { whole: 0, part: 0 }");
    }
    if let Some(unit) = &laws.rate_filter {
        rate::add(glue, unit);
    }
    if let Some(unit) = &laws.filter {
        kalman::add(glue, unit);
    }
    actuation::add(glue, actuation);
    let tuned = own.tuned(glue);
    glue.init.push_str(&tuned);
    actuation::add_unload(glue, actuation, &laws.stored, estimator, None);
    let mut body = String::new();
    if estimator.is_some() {
        body += &attitude::attitudes();
        body += &local("Vector3", "angle", "target.rotation_to(&attitude)");
    }
    let step = own.step(glue);
    if estimator.is_some() && words(&step).contains("rate") {
        body += &local("Vector3", "rate", attitude::RATE);
    }
    body += &step;
    body += &actuation::wheels(glue, actuation, &[0, 1, 2].map(|axis| format!("output.torque[{axis}]")));
    if actuation.jets.is_some() {
        body.push_str("\n    // pulses of the jets\n");
        body += &actuation::jets(actuation, laws.commands_changes());
    }
    glue.call("step", &body);
    momentum::add_axes(glue, &laws.stored);
}
