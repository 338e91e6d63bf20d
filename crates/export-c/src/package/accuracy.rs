//! Accuracy of a control system in single precision: its outputs beside those in double precision, for the same inputs.

use std::fmt::Write as _;

use flexsc_core::Scenario;
use flexsc_flight_precision::Precision;

use crate::control_system::{CallLayout, ControlSystem, NotExportable, NumberKind};
use crate::vectors::CallVector;

/// Output in single precision beside that in double precision.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputAccuracy {
    /// Name of the function.
    pub function: &'static str,
    /// Name of the output.
    pub output: String,
    /// Unit.
    pub unit: String,
    /// Largest size of the output in double precision; 0 of an attitude.
    pub largest: f64,
    /// Largest difference from it; of an attitude, the angle of the rotation between both.
    pub difference: f64,
}

/// Returns the accuracy of each output over the calls of a run; nothing in double precision.
///
/// # Errors
/// Fails if the control system cannot compute in double precision.
pub fn output_accuracies(
    scenario: &Scenario,
    vectors: &[CallVector],
) -> Result<Vec<OutputAccuracy>, NotExportable> {
    if scenario.flight_precision.is_double() {
        return Ok(Vec::new());
    }
    let double = scenario.clone().with(|written| written.flight_precision = Precision::Double);
    let double = double.map_err(|error| {
        let reason = format!("has no double precision beside it, for the accuracy of the outputs: {error}");
        NotExportable::new("flight_precision", reason)
    })?;
    let mut system = ControlSystem::new(&double)?;
    let calls = system.calls();
    let mut all: Vec<Vec<OutputAccuracy>> = calls.iter().map(untested_outputs).collect();
    for vector in vectors {
        let outputs = system.call(vector.call, vector.now, &vector.inputs);
        let mut place = 0;
        for (channel, own) in calls[vector.call].outputs.iter().zip(&mut all[vector.call]) {
            let words = |all: &[u64]| -> Vec<f64> {
                all[place..place + channel.count].iter().map(|word| f64::from_bits(*word)).collect()
            };
            if channel.kind == NumberKind::Real {
                own.take(&words(&outputs), &words(&vector.outputs), channel.is_unit);
            }
            place += channel.count;
        }
    }
    let is_moving = |own: &OutputAccuracy| own.difference > 0.0;
    Ok(all.into_iter().flatten().filter(is_moving).collect())
}

/// Returns the accuracies of the outputs of a function, before its first call.
fn untested_outputs(call: &CallLayout) -> Vec<OutputAccuracy> {
    let each = call.outputs.iter().map(|channel| OutputAccuracy {
        function: call.name,
        output: channel.name.clone(),
        unit: if channel.is_unit { "rad".to_owned() } else { channel.unit_of_numbers().to_owned() },
        largest: 0.0,
        difference: 0.0,
    });
    each.collect()
}

impl OutputAccuracy {
    /// Takes the outputs of a call in double and in single precision.
    fn take(&mut self, double: &[f64], single: &[f64], is_unit: bool) {
        let each = || double.iter().zip(single);
        if let (true, [_, _, _, _]) = (is_unit, double) {
            // The chord of half the angle: both signs of a quaternion are one attitude.
            let square =
                |sign: f64| each().map(|(double, single)| (double - sign * single).powi(2)).sum::<f64>();
            self.difference = self.difference.max(2.0 * square(1.0).min(square(-1.0)).sqrt());
            return;
        }
        self.largest = double.iter().fold(self.largest, |most, number| most.max(number.abs()));
        let differences = each().map(|(double, single)| (double - single).abs());
        self.difference = differences.fold(self.difference, f64::max);
    }
}

/// Returns the table of the accuracies in Markdown; empty in double precision.
pub fn table(accuracy: &[OutputAccuracy], calls: usize) -> String {
    if accuracy.is_empty() {
        return String::new();
    }
    let mut text = format!(
        "\n## Accuracy\n\nThe code computes in single precision, as the study did (`flight_precision`). For the inputs of the {calls} calls, its outputs \
         differ from those in double precision by at most:\n\n| function | output | largest | difference |\n|---|---|---|---|\n"
    );
    for OutputAccuracy { function, output, unit, largest, difference } in accuracy {
        let _ =
            writeln!(text, "| `{function}` | `{output}` | {largest:.2e} {unit} | {difference:.1e} {unit} |");
    }
    text
}
