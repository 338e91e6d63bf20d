//! Witness of a violation: a state at the start and inputs over time that bring the output beyond its limits.

use flexsc_numerics::enclosure::Enclosure;
use schemars::JsonSchema;
use serde::Serialize;

use super::exact_tube::ExactTube;
use super::modal_form::ModalForm;
use super::reach::Side;
use super::sets::InputSets;

/// State at the start and inputs that bring the output to an end of its range.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Witness {
    /// Time (s) at which the output has this value.
    pub time_s: f64,
    /// Value of the output, in its unit.
    pub value: f64,
    /// Value in a run of the engine from this state under these inputs, if a run is possible.
    pub simulated: Option<f64>,
    /// Factor on every natural frequency of the scenario.
    pub frequency_factor: f64,
    /// Factor on every damping ratio.
    pub damping_factor: f64,
    /// Names of the states, in the order of the linear model.
    pub states: Vec<String>,
    /// State at the start, of the states in their order.
    pub start: Vec<f64>,
    /// Times (s) from which each value of an input acts, and the values, by the name of the input.
    #[schemars(extend("x-key" = "name"))]
    pub inputs: Vec<InputHistory>,
    /// Scenario of the body from this state, under these inputs as disturbances; none if no file can have them.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-type" = "Scenario"))]
    pub scenario: Option<String>,
}

/// Input that is constant between instants.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-tuple" = true))]
pub struct InputHistory {
    /// Name of the input.
    pub name: String,
    /// Times (s) from which each value acts; the first is 0.
    pub times_s: Vec<f64>,
    /// Values.
    pub values: Vec<f64>,
}

/// Returns the state and the inputs, with the names of the inputs, that bring the output to an end of its range at
/// `time` (s), and the value that it has then. `count` is the number of intervals in which the inputs' signs are sought.
pub fn extreme_inputs(
    (tube, body): (&ExactTube, &ModalForm),
    sets: &InputSets,
    names: &[String],
    (side, time, value): (Side, f64, f64),
    count: usize,
) -> Witness {
    let (start, steps) = tube.signs(body, time);
    let is_high = |response: f64| side.outwards(response) > 0.0;
    let chosen = |range: Enclosure, response: f64| {
        if is_high(response) { range.high } else { range.low }
    };
    let inputs = names.iter().enumerate().map(|(input, name)| {
        let constant = chosen(sets.constant[input], steps[input]);
        let range = sets.varying[input];
        let history = |times_s, values: Vec<f64>| InputHistory { name: name.clone(), times_s, values };
        if range.low == range.high {
            return history(vec![0.0], vec![constant + range.low]);
        }
        let (switchings, begins_positive) = tube.switchings(input, time, count);
        let mut is_upper = begins_positive == (side == Side::High);
        let mut times = vec![0.0];
        times.extend(switchings);
        let values = times.iter().map(|_| {
            let value = if is_upper { range.high } else { range.low };
            is_upper = !is_upper;
            constant + value
        });
        let values = values.collect();
        history(times, values)
    });
    Witness {
        time_s: time,
        value,
        simulated: None,
        frequency_factor: 1.0,
        damping_factor: 1.0,
        states: Vec::new(),
        scenario: None,
        inputs: inputs.collect(),
        start: start.iter().zip(&sets.start).map(|(response, range)| chosen(*range, *response)).collect(),
    }
}
