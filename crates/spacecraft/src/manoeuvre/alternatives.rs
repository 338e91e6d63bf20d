//! Alternatives: the commands that a planned manoeuvre is compared with, on the same body.

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Fraction, Positive};
use flexsc_numerics::time::Span;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::command::{BangBang, ManoeuvreCommand, MinimumPeak, PolynomialCommand};
use super::effort::PlanEffort;
use super::polynomial::DEGREES;
use super::report::residuals_to_json;
use super::residual::{FinalResidual, residuals};
use super::shaper::{ExtraInsensitive, ShapedModes, Shaper};
use super::suppression::{SuppressedMode, Suppression};
use super::{Manoeuvre, Plan};

/// Largest number of modes that an alternative suppresses.
const MOST: usize = 8;

/// Alternative command of the comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// Name, with modes counted from 1.
    pub name: String,
    /// Command that turns the body.
    pub command: ManoeuvreCommand,
    /// Shaper with which the command is convolved.
    pub shaper: Option<Shaper>,
}

/// Result of one alternative.
#[derive(Clone, Debug)]
pub struct CommandCost {
    /// Name of the alternative.
    pub name: String,
    /// Result of its plan, or the key and the reason why there is none.
    pub outcome: Result<AlternativeOutcome, ConfigError>,
}

/// Plan of an alternative, with its effort and residuals.
#[derive(Clone, Debug)]
pub struct AlternativeOutcome {
    /// Plan of the alternative.
    pub plan: Plan,
    /// Effort of the torque on the hub (N m).
    pub torque: PlanEffort,
    /// Residual in each coordinate.
    pub residuals: Vec<FinalResidual>,
}

/// Quantity that is the same for all alternatives.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum ComparisonBasis {
    /// Time of the manoeuvre (s).
    Time(Span),
    /// Peak torque (N m): each command has its own time.
    PeakTorque(Positive),
}

impl ComparisonBasis {
    /// Returns the peak torque `asked`, if any, else the manoeuvre's time, else the peak torque from which its time
    /// follows.
    pub fn from_manoeuvre(manoeuvre: &Manoeuvre, duration: Option<Positive>, plan: &Plan) -> Self {
        match (duration, manoeuvre.time, manoeuvre.peak_torque) {
            (Some(peak), _, _) | (None, None, Some(peak)) => Self::PeakTorque(peak),
            (None, time, _) => Self::Time(time.unwrap_or_else(|| Span::from_seconds(plan.time))),
        }
    }
}

/// Returns the alternative commands that a body's modes allow.
pub fn alternatives(body: &AxisModel) -> Vec<Alternative> {
    // Indices of the modes, by frequency.
    let mut order: Vec<usize> = (0..body.modes.len()).collect();
    order.sort_by(|a, b| body.modes[*a].frequency.get().total_cmp(&body.modes[*b].frequency.get()));
    order.truncate(MOST);
    let modes = order.len();
    let mut field = Vec::new();
    let mut add = |name: String, command| field.push(Alternative { name, command, shaper: None });
    for (kind, series) in [
        ("sine", ManoeuvreCommand::Sine as fn(Suppression) -> ManoeuvreCommand),
        ("cosine", ManoeuvreCommand::Cosine),
    ] {
        for p in 0..=modes {
            add(format!("{kind} p={p}"), series(lowest(p)));
        }
        for (words, zeros) in robust(kind, &order) {
            add(format!("{kind} {words}"), series(zeros));
        }
    }
    add("bang-bang, rigid".to_owned(), ManoeuvreCommand::BangBang(BangBang {}));
    for p in 0..=modes {
        let words = if p == 0 { "rigid".to_owned() } else { format!("p={p}") };
        add(format!("minimum energy, {words}"), ManoeuvreCommand::MinimumEnergy(lowest(p)));
    }
    for count in twice(modes) {
        let zeros = Suppression {
            suppress: 0,
            zeros: order[..count].iter().map(|mode| target(*mode, 0.0, 2)).collect(),
        };
        add(format!("minimum energy, {}", squares(count)), ManoeuvreCommand::MinimumEnergy(zeros));
    }
    for p in 1..=modes {
        add(format!("minimum peak, p={p}"), ManoeuvreCommand::MinimumPeak(MinimumPeak { suppress: p }));
    }
    for (words, shaper) in shapers(&order) {
        let command = ManoeuvreCommand::BangBang(BangBang {});
        field.push(Alternative { name: format!("{words} on bang-bang"), command, shaper: Some(shaper) });
    }
    for (words, shaper) in shapers(&order[..modes.min(1)]) {
        if !matches!(shaper, Shaper::Zvdd(_)) {
            let command = ManoeuvreCommand::Sine(lowest(0));
            field.push(Alternative { name: format!("{words} on sine p=0"), command, shaper: Some(shaper) });
        }
    }
    for degree in DEGREES {
        let command = ManoeuvreCommand::Polynomial(PolynomialCommand { degree });
        field.push(Alternative { name: format!("polynomial of degree {degree}"), command, shaper: None });
    }
    field
}

fn lowest(suppress: usize) -> Suppression {
    Suppression { suppress, zeros: Vec::new() }
}

fn target(mode: usize, shift: f64, times: u32) -> SuppressedMode {
    SuppressedMode { mode, shift: Finite::new(shift).unwrap_or_default(), times }
}

/// Returns the numbers of lowest modes that get double zeros: the first, the first two, all.
fn twice(modes: usize) -> Vec<usize> {
    let mut counts: Vec<usize> =
        [1, 2, modes].into_iter().filter(|count| *count <= modes && *count > 0).collect();
    counts.dedup();
    counts
}

fn squares(count: usize) -> String {
    match count {
        1 => "w1²".to_owned(),
        2 => "w1² w2²".to_owned(),
        count => format!("w1² to w{count}²"),
    }
}

/// Returns the robust series for the modes of these indices, which are in order of frequency.
fn robust(kind: &str, modes: &[usize]) -> Vec<(&'static str, Suppression)> {
    // Zeros at the Chebyshev points of a band of 10 %.
    let side = 0.1 / std::f64::consts::SQRT_2;
    let mut robust = Vec::new();
    let mut add = |words, zeros| robust.push((words, Suppression { suppress: 0, zeros }));
    if let &[first, ..] = modes {
        add("w1²", vec![target(first, 0.0, 2)]);
    }
    if let &[first, second, ..] = modes {
        if kind == "sine" {
            add("w1² w2", vec![target(first, 0.0, 2), target(second, 0.0, 1)]);
        }
        add("w1² w2²", vec![target(first, 0.0, 2), target(second, 0.0, 2)]);
    }
    if let &[first, ..] = modes {
        if kind == "sine" {
            add("w1³", vec![target(first, 0.0, 3)]);
        }
        add("w1 (1 ± 7.07 %)", vec![target(first, -side, 1), target(first, side, 1)]);
    }
    robust
}

/// Returns the shapers for the modes of these indices, which are in order of frequency.
fn shapers(modes: &[usize]) -> Vec<(&'static str, Shaper)> {
    let on = |count: usize| ShapedModes { modes: modes[..count].to_vec() };
    let ei = |count: usize| {
        let vibration = Fraction::new(0.05).expect("between 0 and 1");
        Shaper::Ei(ExtraInsensitive { modes: modes[..count].to_vec(), vibration })
    };
    let mut shapers = Vec::new();
    if !modes.is_empty() {
        shapers.push(("ZV(w1)", Shaper::Zv(on(1))));
        shapers.push(("ZVD(w1)", Shaper::Zvd(on(1))));
        shapers.push(("EI(w1)", ei(1)));
        shapers.push(("ZVDD(w1)", Shaper::Zvdd(on(1))));
    }
    if modes.len() >= 2 {
        shapers.push(("ZV(w1, w2)", Shaper::Zv(on(2))));
        shapers.push(("ZVD(w1, w2)", Shaper::Zvd(on(2))));
        shapers.push(("EI(w1, w2)", ei(2)));
    }
    shapers
}

/// Computes the results of all alternatives on a body: the manoeuvre with each command in turn.
pub fn compare(
    manoeuvre: &Manoeuvre,
    common: ComparisonBasis,
    body: &AxisModel,
    band: f64,
) -> Vec<CommandCost> {
    let (time, peak_torque) = match common {
        ComparisonBasis::Time(time) => (Some(time), None),
        ComparisonBasis::PeakTorque(peak) => (None, Some(peak)),
    };
    let row = |rival: Alternative| {
        let Alternative { name, command, shaper } = rival;
        let outcome = Manoeuvre { time, peak_torque, command, shaper, ..manoeuvre.clone() }.plan(body);
        let outcome = outcome.map(|plan| AlternativeOutcome {
            torque: PlanEffort::from_torque(&plan, body),
            residuals: residuals(&plan, body, band),
            plan,
        });
        CommandCost { name, outcome }
    };
    alternatives(body).into_par_iter().map(row).collect()
}

impl CommandCost {
    /// Returns the result as a JSON object whose keys end with their units.
    pub fn to_json(&self) -> Value {
        match &self.outcome {
            Err(fault) => json!({"command": self.name, "refused": fault.to_string()}),
            Ok(AlternativeOutcome { plan, torque, residuals }) => {
                let mut object = json!({
                    "command": self.name,
                    "time_s": plan.time,
                    "peak_torque_nm": torque.peak.value,
                    "rms_torque_nm": torque.rms,
                    "energy_nm2_s": torque.square,
                    "initial_torque_nm": torque.initial,
                });
                residuals_to_json(&mut object, residuals);
                object
            }
        }
    }
}
