//! Report of a plan on its body.

use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_dynamics::waveform::TermShape;
use serde_json::{Value, json};

use super::Plan;
use super::effort::PlanEffort;
use super::modal_response::ModalResponse;
use super::peak_search::{self, PeakValue};
use super::plan::fastest;
use super::residual::{FinalResidual, coordinates, residuals};
use super::timing::{self, SingleHarmonicTime};

/// Number of modes of the lowest frequencies for which tuned times are reported.
const TUNED: usize = 3;

/// Results of a plan on its body, exact except for rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanReport {
    /// Effort of the command, in its unit.
    pub command: PlanEffort,
    /// Effort of the torque on the hub (N m): equal to `command`, unless the hub's motion is commanded.
    pub torque: PlanEffort,
    /// Hub angle at the end minus the target (rad).
    pub angle_error: f64,
    /// Hub rate at the end minus the target (rad/s).
    pub rate_error: f64,
    /// Elastic energy after the manoeuvre (J).
    pub energy: f64,
    /// Relative uncertainty of the frequencies.
    pub band: f64,
    /// Residual in each coordinate.
    pub residuals: Vec<FinalResidual>,
    /// Largest elastic deflection of each coordinate during the manoeuvre, in the same order.
    pub deflections: Vec<PeakValue>,
    /// Times near the planned one for which a single harmonic leaves a mode at rest.
    pub tuned: Vec<RestTimes>,
}

/// Times nearest to the planned one (s) for which a single harmonic leaves a mode at rest.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RestTimes {
    /// Index of the mode.
    pub mode: usize,
    /// Times for a sine, below and above the planned one.
    pub sine: (Option<f64>, f64),
    /// Times for a cosine, below and above; `None` unless the rates before and after are equal.
    pub cosine: Option<(Option<f64>, f64)>,
}

impl PlanReport {
    /// Computes the report of a plan on a body whose frequencies have a relative uncertainty of `band`.
    pub fn new(plan: &Plan, body: &AxisModel, band: f64) -> Self {
        let command = &plan.waveform;
        let history = ModalResponse::new(body, command, 1.0);
        let end = history.at(plan.time, plan.time);
        let measurement: [f64; 2] = match body.drive {
            CommandedQuantity::Torque => {
                end.iter().fold([0.0; 2], |sum, [x, rate, _]| [sum[0] + x, sum[1] + rate])
            }
            CommandedQuantity::Motion => [0.0; 2],
        };
        let inertia = body.commanded_inertia();
        let angle = plan.start_rate * plan.time + command.travel(0.0, plan.time) / inertia;
        let rate = plan.start_rate + command.impulse(0.0, plan.time) / inertia;
        let energy = body.modes.iter().zip(&end).map(|(mode, [x, rate, _])| {
            // The modal mass is J/k: the gain is J times the square of the mass-normalised shape at the hub.
            let (w, gain) = (mode.frequency.get(), mode.hub_gain.get().abs());
            if gain == 0.0 { 0.0 } else { 0.5 * body.inertia.get() / gain * (rate * rate + w * w * x * x) }
        });
        let step = peak_search::sampling(fastest(body, command)).max(plan.time / 1e4);
        let deflection = |weights: &[f64]| {
            peak_search::largest(&command.breaks(), step, |middle, t| {
                weights.iter().zip(history.at(middle, t)).map(|(weight, [x, _, _])| weight * x).sum()
            })
        };
        Self {
            command: PlanEffort::from_command(plan),
            torque: PlanEffort::from_torque(plan, body),
            angle_error: angle - plan.angle + measurement[0],
            rate_error: rate - plan.end_rate + measurement[1],
            energy: energy.sum(),
            band,
            residuals: residuals(plan, body, band),
            deflections: coordinates(body).iter().map(|c| deflection(&c.weights)).collect(),
            tuned: tuned_times(plan, body),
        }
    }

    /// Returns the report as one JSON object whose keys end with their units.
    pub fn to_json(&self, plan: &Plan, body: &AxisModel) -> Value {
        let motion = body.drive == CommandedQuantity::Motion;
        let unit = if motion { "rad_s2" } else { "nm" };
        let mut object = json!({
            "time_s": plan.time,
            "angle_rad": plan.angle,
            "start_rate_rad_s": plan.start_rate,
            "end_rate_rad_s": plan.end_rate,
        });
        let series = plan.coefficients.as_ref();
        object[format!("coefficients_{unit}")] = json!(series.map(|c| &c.odd));
        object[format!("even_coefficients_{unit}")] = json!(series.map(|c| &c.even));
        object[format!("constant_{unit}")] = json!(series.map(|c| c.constant));
        object[format!("harmonics_{unit}")] = json!(series.map(|_| harmonics(plan)));
        if motion {
            object["peak_acceleration_rad_s2"] = json!(self.command.peak.value);
            object["rms_acceleration_rad_s2"] = json!(self.command.rms);
            object["square_integral_rad2_s3"] = json!(self.command.square);
        }
        object["peak_torque_nm"] = json!(self.torque.peak.value);
        object["peak_torque_time_s"] = json!(self.torque.peak.time);
        object["rms_torque_nm"] = json!(self.torque.rms);
        object["energy_nm2_s"] = json!(self.torque.square);
        object["initial_torque_nm"] = json!(self.torque.initial);
        object["end_angle_error_rad"] = json!(self.angle_error);
        object["end_rate_error_rad_s"] = json!(self.rate_error);
        object["residual_energy_j"] = json!(self.energy);
        object["band"] = json!(self.band);
        residuals_to_json(&mut object, &self.residuals);
        let by_name = self.residuals.iter().zip(&self.deflections);
        let (hub, outputs) = (self.deflections.first(), self.deflections.get(1..).unwrap_or_default());
        object["peak_deflection_rad"] = match (hub, outputs) {
            (_, []) => Value::Null,
            (_, outputs) => json!(outputs.iter().map(|peak| peak.value).fold(0.0, f64::max)),
        };
        object["peak_deflections_rad"] =
            by_name.clone().map(|(r, peak)| (r.name.clone(), json!(peak.value))).collect();
        object["peak_deflection_times_s"] =
            by_name.map(|(r, peak)| (r.name.clone(), json!(peak.time))).collect();
        let both = |(below, above): (Option<f64>, f64)| json!([below, above]);
        object["tuned_times_s"] = self
            .tuned
            .iter()
            .map(|t| json!({"mode": t.mode, "sine": both(t.sine), "cosine": t.cosine.map(both)}))
            .collect();
        object
    }
}

/// Adds the residual in each coordinate to a JSON object.
pub fn residuals_to_json(object: &mut Value, residuals: &[FinalResidual]) {
    let by_name = |value: &dyn Fn(&FinalResidual) -> f64| -> Value {
        residuals.iter().map(|r| (r.name.clone(), json!(value(r)))).collect()
    };
    object["residual_rad"] = by_name(&|r| r.nominal);
    object["residual_worst_5_percent_rad"] = by_name(&|r| r.near);
    object["residual_worst_rad"] = by_name(&|r| r.worst);
}

fn harmonics(plan: &Plan) -> Vec<Value> {
    let harmonic = |shape: &TermShape| match shape {
        TermShape::Harmonic { frequency, cosine, sine } => {
            Some(json!({"frequency_rad_s": frequency, "cosine": cosine, "sine": sine}))
        }
        _ => None,
    };
    plan.waveform.terms.iter().filter_map(|term| harmonic(&term.shape)).collect()
}

fn tuned_times(plan: &Plan, body: &AxisModel) -> Vec<RestTimes> {
    let mut order: Vec<usize> = (0..body.modes.len()).collect();
    order.sort_by(|a, b| body.modes[*a].frequency.get().total_cmp(&body.modes[*b].frequency.get()));
    order.truncate(TUNED);
    let rest = plan.start_rate == plan.end_rate;
    let residual_of = |mode: usize| {
        let w = body.modes[mode].frequency.get();
        RestTimes {
            mode,
            sine: timing::tuned_times(SingleHarmonicTime::Sine, w, plan.time),
            cosine: rest.then(|| timing::tuned_times(SingleHarmonicTime::Cosine, w, plan.time)),
        }
    };
    order.into_iter().map(residual_of).collect()
}
