//! Guaranteed ranges of outputs of the linear body, over sets of initial states, of inputs and of parameters.
//!
//! The range at each instant is a support function in closed form (`exact_tube`, `box_tube`); second derivatives
//! bound it between instants (`reach`); every sum is rounded outwards. A claim that fails has a witness, which a run of
//! the engine repeats (`witness`).

mod box_tube;
mod exact_tube;
mod modal_form;
mod reach;
mod response;
mod sets;
mod variation;
mod witness;
mod witness_run;

use std::collections::BTreeMap;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::enclosure::Enclosure;
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::Serialize;

use crate::linear_model::{LinearModel, Signal};
use box_tube::BoxTube;
use exact_tube::ExactTube;
use flexsc_scenario::{BoundSpec, Scenario};
use modal_form::ModalForm;
use reach::{Extreme, LimitCrossing, Reach, Side, Tube};
use sets::InputSets;
pub use witness::{InputHistory, Witness};

/// Intervals of the grid in each time 1/w of the frequency that matters.
const IN_EACH: f64 = 2.0;
/// Intervals of the grid where parameters have boxes: integrals follow the grid.
const IN_EACH_OF_BOX: f64 = 16.0;
/// Largest number of responses that are evaluated on a grid.
const MOST_RESPONSES: f64 = 2e8;
/// Largest number of instants of a grid, which are kept.
const MOST_INSTANTS: f64 = 1e6;
/// Largest number of rows of the range over time.
const MOST_ROWS: usize = 2000;

/// Outcome of a claim.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The output stays within its limits.
    Proved,
    /// The output passes a limit for a state and inputs of the sets.
    Violated,
    /// The guaranteed range passes a limit, and no state and inputs are known that do.
    Undecided,
    /// No limits are claimed.
    Unlimited,
}

/// Range of an output at one instant.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct RangeRow {
    /// Time (s).
    pub time_s: f64,
    /// Guaranteed lower bound.
    pub low: f64,
    /// Guaranteed upper bound.
    pub high: f64,
}

/// Guaranteed range of an output, and the verdict about its limits.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OutputBound {
    /// Name of the output.
    #[schemars(extend("x-flat" = "{}"))]
    pub output: Signal,
    /// True if the output is without the rigid motion.
    pub elastic: bool,
    /// Limits of the claim, in the unit of the output.
    pub limits: Option<[f64; 2]>,
    /// End of the interval of time (s).
    pub until_s: f64,
    /// Outcome; `unlimited` without limits.
    pub verdict: Verdict,
    /// Guaranteed range over the whole interval, rounded outwards.
    pub range: [f64; 2],
    /// Range that is attained by states and inputs that are known.
    pub attained: [f64; 2],
    /// Times (s) at which the range is attained.
    pub attained_at_s: [f64; 2],
    /// Time (s) before which no limit is passed: the end of the interval if the claim is proved.
    pub safe_until_s: Option<f64>,
    /// First time (s) at which a limit is passed for a state and inputs of the sets.
    pub violated_at_s: Option<f64>,
    /// Largest excess of the guaranteed range over the limits, if the claim is undecided.
    pub gap: Option<f64>,
    /// State and inputs that violate the claim the most.
    pub witness: Option<Witness>,
    /// Range at instants of a grid. The output may leave it between two rows, but not `range`.
    #[serde(skip)]
    pub rows: Vec<RangeRow>,
    /// Linear model of the body, in whose states and inputs the witness is.
    #[serde(skip)]
    pub model: LinearModel,
}

impl OutputBound {
    /// Computes the ranges of all claims of a scenario, in their order.
    ///
    /// # Errors
    /// A scenario without claims, a body that has no modal form, and a claim that names what the body does not have:
    /// the key, and the reason.
    pub fn from_scenario(scenario: &Scenario) -> Result<Vec<Self>, ConfigError> {
        if scenario.bound.is_empty() {
            let why = "is missing: a table `[[bound]]` gives the output, its limits, and the sets of states and inputs";
            return Err(ConfigError::new("bound", why));
        }
        let model = LinearModel::for_runs(scenario)?;
        if let Some(key) = scenario.study.drift.as_ref().map(|_| "drift") {
            return Err(ConfigError::new(
                key,
                "changes the natural frequencies in time: give `frequency_error` in its place",
            ));
        }
        let claims = scenario.bound.iter().enumerate();
        let within = |index: usize| move |fault: ConfigError| fault.within(&format!("bound[{index}]"));
        claims.map(|(index, claim)| Self::new(scenario, &model, claim).map_err(within(index))).collect()
    }

    fn new(scenario: &Scenario, model: &LinearModel, claim: &BoundSpec) -> Result<Self, ConfigError> {
        let output = index_of("output", &claim.output, &model.outputs)?;
        let body = ModalForm::new(model, output, claim.elastic)?;
        let sets = input_sets(claim, model)?;
        let until = claim.until.map_or_else(|| scenario.duration.seconds(), Positive::get);
        let errors = [claim.frequency_error.get(), claim.damping_error.get()];
        let is_box = errors != [0.0; 2];
        let damped = body.pairs.iter().find(|pair| pair.damping * (1.0 + errors[1]) >= 1.0);
        if damped.is_some() {
            let why = "must leave every damping ratio below 1";
            return Err(ConfigError::new("damping_error", why));
        }
        let nominal = ExactTube::new(&body, &sets, until);
        let count = nominal.grid_count(until, if is_box { IN_EACH_OF_BOX } else { IN_EACH });
        let most = (MOST_RESPONSES / model.states.len() as f64).min(MOST_INSTANTS);
        if count > most {
            let why = format!(
                "must be shorter: it needs {count:.0} instants, and {most:.0} are possible, got {until} s"
            );
            return Err(ConfigError::new("until", why));
        }
        let count = count as usize;
        let reach = Reach::new(&nominal, until, count);
        let mut found = Self::found(model, output, claim, until, &reach);
        let mut bodies = vec![(1.0, 1.0)];
        if is_box {
            bodies.extend(
                [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]
                    .map(|(frequency, damping)| (1.0 + frequency * errors[0], 1.0 + damping * errors[1])),
            );
            let tube = BoxTube::new(&body, &sets, errors[0], errors[1]);
            let boxed = Reach::new(&tube, until, count);
            let own = Self::found(model, output, claim, until, &boxed);
            (found.range, found.safe_until_s, found.rows) = (own.range, own.safe_until_s, own.rows);
        }
        let mut extremes: Vec<(f64, f64)> = vec![bodies[0]; 2];
        for factors in &bodies[1..] {
            found.include_corner(&body.scaled(factors.0, factors.1), &sets, *factors, &mut extremes, count);
        }
        found.decide();
        if found.verdict == Verdict::Violated {
            found.witness = Some(found.witnessed(scenario, &body, &sets, &extremes, count));
        }
        Ok(found)
    }

    /// Returns the ranges of a tube, without a verdict.
    fn found<T: Tube>(
        model: &LinearModel,
        output: usize,
        claim: &BoundSpec,
        until: f64,
        reach: &Reach<'_, T>,
    ) -> Self {
        let limits = claim.limits.map(|limits| limits.map(Finite::get));
        let [low, high]: [Extreme; 2] = Side::BOTH.map(|side| reach.extreme(side));
        let crossing = limits.and_then(|limits| reach.first_crossing(limits));
        let step = reach.grid().len().div_ceil(MOST_ROWS).max(1);
        let last = reach.grid().len() - 1;
        let rows = reach.grid().iter().enumerate().filter(|(index, _)| index % step == 0 || *index == last);
        let row = |instant: &reach::TubeInstant<T::State>| RangeRow {
            time_s: instant.t,
            low: instant.bounds[0],
            high: instant.bounds[1],
        };
        Self {
            output: model.outputs[output].clone(),
            elastic: claim.elastic,
            limits,
            until_s: until,
            verdict: Verdict::Unlimited,
            range: [low.bound, high.bound],
            attained: [low.attained, high.attained],
            attained_at_s: [low.time, high.time],
            safe_until_s: limits
                .map(|_| crossing.map_or(until, |crossing: LimitCrossing| crossing.safe_until)),
            violated_at_s: crossing.and_then(|crossing| crossing.passed_at),
            gap: None,
            witness: None,
            rows: rows.map(|(_, instant)| row(instant)).collect(),
            model: model.clone(),
        }
    }

    /// Includes what the body attains at a corner of the box of parameters.
    fn include_corner(
        &mut self,
        body: &ModalForm,
        sets: &InputSets,
        factors: (f64, f64),
        extremes: &mut [(f64, f64)],
        count: usize,
    ) {
        let tube = ExactTube::new(body, sets, self.until_s);
        let reach = Reach::new(&tube, self.until_s, count);
        for side in Side::BOTH {
            let (index, extreme) = (side.index(), reach.extreme(side));
            if side.outwards(extreme.attained) > side.outwards(self.attained[index]) {
                (self.attained[index], self.attained_at_s[index]) = (extreme.attained, extreme.time);
                extremes[index] = factors;
            }
        }
        let passed = self.limits.and_then(|limits| reach.first_crossing(limits)?.passed_at);
        self.violated_at_s = match (self.violated_at_s, passed) {
            (Some(before), Some(passed)) => Some(before.min(passed)),
            (before, passed) => before.or(passed),
        };
    }

    /// Decides about the limits.
    fn decide(&mut self) {
        let Some([low, high]) = self.limits else { return };
        let excess = |range: [f64; 2]| (low - range[0]).max(range[1] - high);
        self.verdict = if excess(self.range) <= 0.0 {
            Verdict::Proved
        } else if excess(self.attained) > 0.0 {
            Verdict::Violated
        } else {
            self.gap = Some(excess(self.range));
            Verdict::Undecided
        };
    }

    /// Returns the state and the inputs that violate the claim the most, with the value of their run.
    fn witnessed(
        &self,
        scenario: &Scenario,
        body: &ModalForm,
        sets: &InputSets,
        extremes: &[(f64, f64)],
        count: usize,
    ) -> Witness {
        let [low, high] = self.limits.unwrap_or(self.attained);
        let is_high = self.attained[1] - high > low - self.attained[0];
        let side = Side::BOTH[usize::from(is_high)];
        let (time, value) = (self.attained_at_s[side.index()], self.attained[side.index()]);
        let (frequency, damping) = extremes[side.index()];
        let body = body.scaled(frequency, damping);
        let tube = ExactTube::new(&body, sets, self.until_s);
        let names: Vec<String> = self.model.inputs.iter().map(|signal| signal.name.clone()).collect();
        let mut witness = witness::extreme_inputs((&tube, &body), sets, &names, (side, time, value), count);
        (witness.frequency_factor, witness.damping_factor) = (frequency, damping);
        witness.states = self.model.states.iter().map(|signal| signal.name.clone()).collect();
        let run = witness_run::scenario(scenario, &self.model, &witness);
        let state = run.and_then(|run| witness_run::final_state(&run, &self.model));
        witness.simulated = state.map(|state| {
            body.pairs
                .iter()
                .flat_map(|pair| pair.states.into_iter().zip(pair.weights))
                .map(|(index, weight)| weight * state[index])
                .sum()
        });
        witness
    }

    /// Returns true if limits are claimed and not proved.
    pub const fn fails(&self) -> bool {
        matches!(self.verdict, Verdict::Violated | Verdict::Undecided)
    }

    /// Returns the scenario file of the witness: the body from its state, under its inputs as disturbances. `None`
    /// without a witness, and if no file can have its state or inputs.
    pub fn witness_text(&self, scenario: &Scenario) -> Option<String> {
        let run = witness_run::scenario(scenario, &self.model, self.witness.as_ref()?)?;
        witness_run::is_written(&run).then(|| run.to_toml())
    }
}

/// Returns the index of a name among signals.
fn index_of(key: &str, name: &str, signals: &[Signal]) -> Result<usize, ConfigError> {
    signals.iter().position(|signal| signal.name == *name).ok_or_else(|| {
        let names: Vec<String> = signals.iter().map(|signal| format!("`{}`", signal.name)).collect();
        ConfigError::new(key, format!("must be one of {}, got `{name}`", names.join(", ")))
    })
}

/// Returns the sets of a claim, for every state and input of the model.
fn input_sets(claim: &BoundSpec, model: &LinearModel) -> Result<InputSets, ConfigError> {
    let range = |range: &[Finite; 2]| Enclosure::new(range[0].get(), range[1].get());
    let mut start = vec![Enclosure::default(); model.states.len()];
    // The ranges of all modes first: those of single states replace them.
    for (all, suffix) in [("displacements", "_displacement"), ("rates", "_rate")] {
        let Some(given) = claim.start.get(all) else { continue };
        for (state, signal) in start.iter_mut().zip(&model.states) {
            if signal.name.starts_with("mode") && signal.name.ends_with(suffix) {
                *state = range(given);
            }
        }
    }
    for (name, given) in
        claim.start.iter().filter(|(name, _)| !["displacements", "rates"].contains(&name.as_str()))
    {
        start[index_of(&format!("start.{name}"), name, &model.states)?] = range(given);
    }
    let inputs = |table: &str, ranges: &BTreeMap<String, [Finite; 2]>| {
        let mut all = vec![Enclosure::default(); model.inputs.len()];
        for (name, given) in ranges {
            all[index_of(&format!("{table}.{name}"), name, &model.inputs)?] = range(given);
        }
        Ok(all)
    };
    Ok(InputSets {
        start,
        constant: inputs("constant_inputs", &claim.constant_inputs)?,
        varying: inputs("varying_inputs", &claim.varying_inputs)?,
    })
}
