//! Inputs and outputs of the step of laws of modes: the union of those of the laws of each mode.

use flexsc_core::control::flight_quantity::FlightQuantity;

use super::actuation::Actuation;
use super::mode_laws::LawsOfMode;
use super::{CallLayout, Channel};

/// Inputs and outputs of a step: every call looks words up by their names.
#[derive(Debug)]
pub(super) struct StepLayout {
    /// Inputs of the laws of all modes, with the target attitude in place of estimates that the attitude filter gives.
    pub inputs: Vec<Channel>,
    /// Outputs of the laws of all modes.
    pub outputs: Vec<Channel>,
    /// Function of the laws of each mode; `None` of an open loop.
    pub laws: Vec<Option<CallLayout>>,
}

impl StepLayout {
    pub(super) fn new(modes: &[LawsOfMode], has_estimator: bool, actuation: &Actuation) -> Self {
        let laws: Vec<Option<CallLayout>> = modes.iter().map(|mode| mode.start.layout()).collect();
        let mut inputs = each_once(laws.iter().flatten().flat_map(|layout| &layout.inputs));
        if has_estimator {
            let estimates = [FlightQuantity::Angle, FlightQuantity::Rate];
            inputs.retain(|channel| !channel.quantity.is_some_and(|own| estimates.contains(&own)));
            inputs.insert(0, Channel::from_quantity(FlightQuantity::TargetAttitude, 4, 1.0));
        }
        let mut outputs = each_once(laws.iter().flatten().flat_map(|layout| &layout.outputs));
        outputs.extend(actuation.channels());
        Self { inputs, outputs, laws }
    }
}

/// Returns the first channel of each name.
fn each_once<'a>(channels: impl Iterator<Item = &'a Channel>) -> Vec<Channel> {
    let mut all: Vec<Channel> = Vec::new();
    for channel in channels {
        if !all.iter().any(|known| known.name == channel.name) {
            all.push(channel.clone());
        }
    }
    all
}

/// Returns the index of the first word of a channel.
pub(super) fn first_word(channels: &[Channel], name: &str) -> usize {
    channels.iter().take_while(|channel| channel.name != name).map(|channel| channel.count).sum()
}

/// Returns the words of a channel.
pub(super) fn words_of<'a>(channels: &[Channel], words: &'a [u64], name: &str) -> &'a [u64] {
    let count = channels.iter().find(|channel| channel.name == name).map_or(0, |channel| channel.count);
    let from = first_word(channels, name);
    words.get(from..from + count).unwrap_or_default()
}
