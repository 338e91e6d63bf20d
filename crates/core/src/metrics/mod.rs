//! Metrics: results of a run as named numbers with units.

mod adaptation;
mod attitude;
mod blinding;
mod envelope;
mod filter;
pub mod goal;
mod index_record;
mod limits;
mod line_of_sight;
mod mode_bands;
mod operation;
mod pointing_index;
mod requirements;
mod rotation;
mod selection;
mod switchings;
mod three_axis;
mod tracking;

use flexsc_dynamics::MotionPiece;
use flexsc_numerics::time::Instant;
use flexsc_record::{
    self, Estimate, Estimates, Record, RecordError, RequirementScopes, RobustnessOfRequirements, Sample,
};
use flexsc_spacecraft::body::BodyAxes;

use flexsc_scenario::Scenario;
use flexsc_scenario::metric_descriptions;

pub use flexsc_scenario::metric_descriptions::{ALL, is_event_list, list_element};

// All of them: each metric is declared once.
#[allow(clippy::wildcard_imports)]
use flexsc_scenario::metric_descriptions::*;

pub use flexsc_record::metrics::{MetricDescription, MetricValue, Metrics, NamedMetric, NumberWithUnit};

pub use envelope::METRICS as OF_ENVELOPE;
pub use index_record::IndexRecord;
pub use requirements::is_not_exercised;
pub(crate) use requirements::{ErrorStream, metric_value};
pub use selection::Selection;

use adaptation::AdaptationMetrics;
use attitude::AttitudeMetrics;
use blinding::BlindingMetrics;
use envelope::EnvelopeMetrics;
use filter::FilterMetrics;
use line_of_sight::LineOfSightMetrics;
use operation::ModeMetrics;
use requirements::RequirementMetrics;
use rotation::ManoeuvreMetrics;
pub use rotation::{LaneManoeuvreMetrics, LanePiece};
use switchings::RelayMetrics;
use three_axis::ThreeAxisMetrics;
use tracking::ObserverMetrics;

/// Returns the description of a metric by its name, with the units of a scenario if one is given.
pub fn meaning(name: &str, scenario: Option<&Scenario>) -> Option<&'static MetricDescription> {
    let objectives = scenario.and_then(adaptation::descriptions);
    let objective = objectives.and_then(|some| some.iter().find(|meaning| meaning.name == name));
    objective.or_else(|| metric_descriptions::meaning(name, scenario.map(|scenario| &scenario.model)))
}

/// Collector of the metrics of a run.
#[derive(Clone, Debug)]
pub struct MetricsCollector {
    kind: RunKind,
    filter: Option<FilterMetrics>,
    known: Option<AttitudeMetrics>,
    adapted: Option<AdaptationMetrics>,
    windows: Option<EnvelopeMetrics>,
    tracked: ObserverMetrics,
    sights: LineOfSightMetrics,
    operation: Option<ModeMetrics>,
    blinding: BlindingMetrics,
    requirements: RequirementMetrics,
}

/// Collector for the kind of the run.
#[derive(Clone, Debug)]
enum RunKind {
    /// Collector for a relay law.
    Switchings(Box<RelayMetrics>),
    /// Collector for a rotation of a one-axis body, under a manoeuvre or a law without switchings.
    Rotation(Box<ManoeuvreMetrics>),
    /// Collector for a three-axis body.
    ThreeAxis(Box<ThreeAxisMetrics>),
}

impl MetricsCollector {
    /// Creates an empty collector of all metrics for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self::for_selection(scenario, &Selection::ALL)
    }

    /// Creates an empty collector of the selected metrics; values that no selected metric needs are not computed.
    pub fn for_selection(scenario: &Scenario, selection: &Selection) -> Self {
        let requirements = RequirementMetrics::new(scenario);
        let selection = &selection.with(requirements.required_metrics());
        let kind = match scenario.model.axes() {
            BodyAxes::Three(_) => RunKind::ThreeAxis(Box::new(ThreeAxisMetrics::new(scenario))),
            BodyAxes::One(body) if scenario.law.is_switching() => {
                RunKind::Switchings(Box::new(RelayMetrics::new(scenario, body, selection)))
            }
            BodyAxes::One(body) => {
                RunKind::Rotation(Box::new(ManoeuvreMetrics::new(scenario, body, selection)))
            }
        };
        Self {
            kind,
            filter: FilterMetrics::new(scenario).filter(|_| selection.wants_any(filter::METRICS)),
            known: AttitudeMetrics::new(scenario).filter(|_| selection.wants_any(attitude::METRICS)),
            adapted: AdaptationMetrics::new(scenario),
            windows: EnvelopeMetrics::if_not_collected_elsewhere(scenario),
            tracked: ObserverMetrics::new(scenario),
            sights: LineOfSightMetrics::new(scenario),
            operation: ModeMetrics::new(scenario),
            blinding: BlindingMetrics::new(scenario),
            requirements,
        }
    }

    /// Returns the collector of a rotation towards angle 0 from the start on, without observed coordinates; `None` for
    /// other runs.
    pub fn rotation(&mut self) -> Option<&mut ManoeuvreMetrics> {
        match &mut self.kind {
            RunKind::Rotation(rotation) if rotation.needs_angle_only() => Some(rotation),
            _ => None,
        }
    }

    /// Returns true if a filter's estimates at time `t` (s) are assessed.
    pub fn is_assessed(&self, t: f64) -> bool {
        self.filter.as_ref().is_some_and(|filter| filter.is_assessed(t))
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(self, scenario: &Scenario) -> Metrics {
        let mut metrics = match self.kind {
            RunKind::Switchings(switchings) => switchings.finish(scenario),
            RunKind::Rotation(rotation) => rotation.finish(),
            RunKind::ThreeAxis(rotation) => rotation.finish(),
        };
        metrics.extend(self.operation.into_iter().flat_map(ModeMetrics::finish));
        metrics.extend(self.blinding.finish());
        metrics.extend(self.sights.finish());
        metrics.extend(self.tracked.finish());
        metrics.extend(self.filter.into_iter().flat_map(FilterMetrics::finish));
        metrics.extend(self.known.into_iter().flat_map(AttitudeMetrics::finish));
        metrics.extend(self.windows.iter().flat_map(EnvelopeMetrics::finish));
        metrics.extend(self.adapted.into_iter().flat_map(AdaptationMetrics::finish));
        if !scenario.has_goal() {
            goal::remove(&mut metrics);
        }
        let mut metrics = Metrics(metrics);
        metrics.0.extend(self.requirements.finish(&metrics));
        metrics
    }
}

impl Record for MetricsCollector {
    fn wants_estimates(&self, now: Instant) -> bool {
        self.filter.is_some() || self.known.as_ref().is_some_and(|known| known.wants_estimates(now))
    }

    fn wants_journal(&self) -> bool {
        false
    }

    fn wants_switchings(&self) -> bool {
        match &self.kind {
            RunKind::Switchings(switchings) => switchings.wants_switchings(),
            RunKind::Rotation(_) | RunKind::ThreeAxis(_) => true,
        }
    }

    fn piece_demand(&self) -> flexsc_record::PieceDemand {
        match &self.kind {
            RunKind::Switchings(switchings) => switchings.piece_demand(),
            RunKind::Rotation(rotation) => rotation.piece_demand(),
            RunKind::ThreeAxis(_) => flexsc_record::PieceDemand::None,
        }
    }

    fn piece(&mut self, now: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        match &mut self.kind {
            RunKind::Switchings(switchings) => switchings.piece(now, piece),
            RunKind::Rotation(rotation) => rotation.piece(now, piece),
            RunKind::ThreeAxis(_) => Ok(()),
        }
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        // The most frequent samples: a copy of the sample for another call would wait for its parts to be stored.
        if let (RunKind::Switchings(switchings), Sample::Switching(command, state)) = (&mut self.kind, sample)
        {
            switchings.observe_switching(now, command, state);
            return Ok(());
        }
        if let Some(filter) = &mut self.filter {
            let one = sample.get().map(|estimate: &Estimate| std::slice::from_ref(estimate));
            let axes = one.or_else(|| sample.get().map(|estimates: &Estimates| &estimates.axes[..]));
            if let Some(axes) = axes {
                filter.observe(now, axes);
            }
        }
        if let Some(known) = &mut self.known {
            sample.get().into_iter().for_each(|estimate| known.observe(now, estimate));
            sample.get().into_iter().for_each(|estimates| known.observe_modes(estimates));
        }
        if let Some(windows) = &mut self.windows {
            sample.get().into_iter().for_each(|window| windows.observe(window));
        }
        if let Some(adapted) = &mut self.adapted {
            adapted.observe(now, sample);
        }
        if !self.requirements.is_empty() {
            sample.get().into_iter().for_each(|errors| self.requirements.observe(errors));
            sample
                .get()
                .into_iter()
                .for_each(|of: &RequirementScopes| self.requirements.observe_scopes(&of.0));
            let all = sample.get().into_iter();
            all.for_each(|of: &RobustnessOfRequirements| self.requirements.observe_robustness(&of.0));
        }
        if let (Some(operation), Some(event)) = (&mut self.operation, sample.get()) {
            operation.observe(now, event);
        }
        match &mut self.kind {
            RunKind::Switchings(switchings) => switchings.record(now, sample),
            RunKind::Rotation(rotation) => rotation.record(now, sample),
            RunKind::ThreeAxis(rotation) => {
                if let Sample::Report(report) = sample {
                    rotation.observe_cycle(now, report);
                } else {
                    sample.get().into_iter().for_each(|event| rotation.observe_bearing_event(event));
                    sample.get().into_iter().for_each(|row| rotation.observe_acceleration(row));
                    sample.get().into_iter().for_each(|event| self.blinding.observe(event));
                    sample.get().into_iter().for_each(|row| self.sights.observe(now, row));
                    sample.get().into_iter().for_each(|row| self.sights.observe_mirror(now, row));
                    sample.get().into_iter().for_each(|row| self.requirements.observe_line(now, row));
                }
                if self.tracked.has_observers() {
                    sample.get().into_iter().for_each(|tracking| self.tracked.observe(tracking));
                }
                Ok(())
            }
        }
    }
}
