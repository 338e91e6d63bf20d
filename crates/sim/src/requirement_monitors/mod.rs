//! Requirements over time: the signals that they read, piece by piece, and their robustness at the end of the run.
//!
//! Measured and estimated quantities are constant from one sample or decision to the next, and times grow. The true motion is
//! that of the body over each segment: about one axis the series of its closed form, about three axes polynomials through the
//! motion of a copy of the plant. Instants at which only the record gets rows change neither.

mod motion;

use std::sync::Arc;

use flexsc_control::operation::{ModeQuantity, ModeReadings};
use flexsc_control::robustness::{RequirementMonitor, limit_scale};
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::polynomial::{Polynomial, TERMS};
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::signal::{Curve, PieceValues, SignalPiece, fit};
use flexsc_numerics::time::Instant;
use flexsc_record::{
    Record, RecordError, Report, RequirementRobustness, RequirementSignals, RobustnessOfRequirements, Sample,
};

use super::guidance::Guidance;
use super::loads::Loads;
use super::mode_sky::ModeSky;
use super::motion_limits::{MotionLimits, modal_rotation};
use super::mounted_lines::MountedLines;
use super::plant::Plant;
use super::run_view::RunView;
use flexsc_scenario::{RequirementSource, Scenario};

/// Longest part (s) over which a quantity of the sky is fitted.
const SKY_REACH: f64 = 20.0;
/// Part of a limit to which quantities are fitted, and the least tolerance, by rounding.
const TOLERANCE: f64 = 1e-9;
const ROUNDING: f64 = 4e-15;

/// Requirements over time of a run.
#[derive(Clone, Debug, Default)]
pub struct RequirementMonitors {
    /// Monitors with the indices of their requirements, and for each of their comparisons that of its quantity.
    monitors: Vec<(usize, RequirementMonitor, Vec<usize>)>,
    quantities: Vec<Observed>,
    lines: MountedLines,
    sky: Arc<ModeSky>,
    /// Bounds of the motion about three axes, norm of the modal rotations of the hub (rad/(m sqrt(kg))), and the largest
    /// acceleration of a slew (rad/s²).
    limits: MotionLimits,
    hub_rotation: f64,
    slew_acceleration: f64,
    /// True if nothing that turns in the body, or moves on it, changes its torque by itself.
    is_steady: bool,
    /// True if the motion has bounds: no appendage is on a drive or hinge, and no rotor has imbalance.
    is_bounded: bool,
    /// Start of the motion segment; of three axes also the values there, and the body with its reference unless the body can
    /// return to it.
    since: Instant,
    start: Option<SegmentEnd>,
    copy: Option<Box<(Plant, Guidance)>>,
    /// Points of the signals of the quantities, for a record that wants them.
    kept: Option<Vec<Vec<(f64, f64)>>>,
}

/// Values at an end of a segment about three axes.
#[derive(Clone, Debug)]
struct SegmentEnd {
    /// Vectors whose norms are the quantities.
    errors: Vec<Vector>,
    /// Bound of the rate (rad/s) at which the pointing error turns.
    turning: f64,
    /// Size of the acceleration of the reference (rad/s²).
    reference: f64,
    /// Bounds of the acceleration (rad/s²) by loads, without and with the forces on the modes.
    growth: [f64; 2],
    /// Bound of the acceleration (rad/s²) of the hub by free vibrations, and the highest frequency (rad/s).
    oscillation: f64,
    fastest: f64,
    /// Bound of the second derivative of the rigid rate (rad/s³).
    bend: f64,
}

/// Quantity that a requirement reads.
#[derive(Clone, Debug)]
struct Observed {
    quantity: ModeQuantity,
    /// Accuracy of its polynomials, in its unit.
    tolerance: f64,
    /// Values, each with the time (s) from which on it holds; the first time is at most the start of the segment.
    values: Vec<(f64, f64)>,
    /// True for a quantity of the motion about three axes on which a requirement may depend in the segment.
    counts: bool,
}

impl RequirementMonitors {
    /// Creates the monitors of a scenario's run, before its start.
    pub fn new(scenario: &Scenario, sky: &Arc<ModeSky>) -> Self {
        let mut all = Self { sky: Arc::clone(sky), ..Self::default() };
        for (index, requirement) in scenario.study.requirements.iter().enumerate() {
            let RequirementSource::Formula(formula) = &requirement.source else { continue };
            let monitor = RequirementMonitor::new(&formula.expression, scenario.duration.seconds());
            let limits = formula.expression.leaves().into_iter().map(|(_, limit)| limit.unwrap_or(1.0));
            let places = monitor.quantities().zip(limits);
            let places = places.map(|(quantity, limit)| all.place(quantity, limit)).collect();
            all.monitors.push((index, monitor, places));
        }
        if let Some(body) = scenario.model.three_axis().filter(|_| !all.monitors.is_empty()) {
            all.lines = MountedLines::new(scenario);
            all.limits = MotionLimits::new(scenario, body);
            all.hub_rotation = modal_rotation(body, body.points.first().map_or("", |point| &point.name));
            let of_modes = scenario.mode.iter().filter_map(|mode| mode.target.as_ref()?.acceleration);
            let of_targets = scenario.targets().iter().filter_map(|target| target.acceleration);
            all.is_steady = scenario.study.bearings.is_empty()
                && body.articulation.is_none()
                && body.disturbance.is_none()
                && scenario.appendage.iter().all(|appendage| appendage.thermal.is_none());
            let is_balanced = scenario.study.bearings.iter().all(|bearing| bearing.lines.is_empty());
            all.is_bounded = is_balanced && body.articulation.is_none();
            all.slew_acceleration = of_modes.chain(of_targets).map(Positive::get).fold(0.0, f64::max);
        }
        all
    }

    /// Returns the index of a quantity that is compared with a limit, which is added if it is not among them.
    fn place(&mut self, quantity: ModeQuantity, limit: f64) -> usize {
        let tolerance = (TOLERANCE * limit_scale(limit)).max(ROUNDING);
        if let Some(place) = self.quantities.iter().position(|known| known.quantity == quantity) {
            let known = &mut self.quantities[place];
            known.tolerance = known.tolerance.min(tolerance);
            return place;
        }
        self.quantities.push(Observed { quantity, tolerance, values: Vec::new(), counts: false });
        self.quantities.len() - 1
    }

    /// Returns true if the scenario has no requirement over time.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.monitors.is_empty()
    }

    /// Keeps the signals from now on, for the record at the end of the run.
    pub fn keep_signals(&mut self) {
        self.kept = Some(vec![Vec::new(); self.quantities.len()]);
    }

    /// Takes the values of the quantities that change at instants, at one of them: of those that are measured or estimated only
    /// if there was a sample or a decision.
    pub fn observe(&mut self, run: &RunView<'_>, has_sampled: bool) {
        for observed in &mut self.quantities {
            let quantity = observed.quantity;
            let is_event = quantity.is_boolean() || matches!(quantity, ModeQuantity::Entries(_));
            if quantity.is_of_motion() || quantity.is_of_sky() || !is_event && !has_sampled {
                continue;
            }
            let (now, value) = (run.now.seconds(), run.value(quantity));
            match observed.values.last_mut() {
                Some(last) if last.0 == now => last.1 = value,
                Some(last) if last.1.to_bits() == value.to_bits() && !quantity.grows_with_time() => {}
                _ => observed.values.push((now, value)),
            }
        }
    }

    /// Begins a motion segment at the instant of a run at which its loads have changed.
    pub fn begin_segment(&mut self, run: &RunView<'_>) {
        self.since = run.now;
        self.copy = None;
        // The mode of operation changes between segments alone.
        let range = |observed: &Observed| match observed.quantity {
            quantity @ ModeQuantity::Mode(_) => [run.value(quantity); 2],
            quantity if quantity.is_of_motion() => [0.0, f64::INFINITY],
            quantity @ ModeQuantity::Fault(fault) if !run.sky.has_fault(fault) => [run.value(quantity); 2],
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        };
        let ranges: Vec<[f64; 2]> = self.quantities.iter().map(range).collect();
        self.start = None;
        let quantities = run.plant.quantities();
        let Some(motion) = quantities.three_axis() else { return };
        self.quantities.iter_mut().for_each(|observed| observed.counts = false);
        for (_, monitor, places) in &self.monitors {
            if Self::depends_on_motion(&self.quantities, places)
                && !monitor.ignores(f64::INFINITY, places.iter().map(|place| ranges[*place]))
            {
                for place in places {
                    let observed = &mut self.quantities[*place];
                    observed.counts |= observed.quantity.is_of_motion();
                }
            }
        }
        if self.kept.is_some() {
            self.quantities
                .iter_mut()
                .for_each(|observed| observed.counts = observed.quantity.is_of_motion());
        }
        if self.quantities.iter().any(|observed| observed.counts) {
            self.start = Some(self.at_end(run.plant, run.guidance, run.loads, run.now));
            if !self.is_steady || motion.two_way().is_none() {
                self.copy = Some(Box::new((run.plant.clone(), run.guidance.clone())));
            }
        }
    }

    /// Ends the motion segment at `now`, to which the plant has advanced.
    pub fn end_segment(&mut self, now: Instant, plant: &Plant, guidance: &Guidance, loads: &Loads) {
        let span = [self.since, now];
        let [from, to] = span.map(Instant::seconds);
        if to <= from {
            return;
        }
        let mut pieces: Vec<Vec<SignalPiece>> = vec![Vec::new(); self.quantities.len()];
        let edges = self.sky.edges(from, to);
        for (observed, into) in self.quantities.iter_mut().zip(&mut pieces) {
            let Observed { quantity, tolerance, values, .. } = observed;
            if quantity.is_of_sky() {
                let sky = &self.sky;
                let mut evaluate =
                    |times: &[f64]| Some(times.iter().map(|t| vec![sky.value(*quantity, *t)]).collect());
                let is_flag = quantity.is_boolean();
                if is_flag || edges.is_empty() && sky.is_steady(*quantity, from) {
                    let constant =
                        |[from, to]: [f64; 2]| SignalPiece::constant(from, to, sky.value(*quantity, from));
                    into.extend(parts([from, to], f64::INFINITY, edges).into_iter().map(constant));
                    continue;
                }
                for part in parts([from, to], SKY_REACH, edges) {
                    let mut take = |begin, length, all: &[Polynomial]| {
                        into.extend(curve(begin, length, all[0]));
                    };
                    fit(part, &[*tolerance], &mut evaluate, &mut take);
                }
            } else if !quantity.is_of_motion() {
                let grows = quantity.grows_with_time();
                let ends = values[1..].iter().map(|(at, _)| *at).chain([to]);
                for ((begin, value), end) in values.iter().zip(ends) {
                    into.extend(held_value([*begin, end], *value, grows));
                }
                let last = values.len() - 1;
                values.drain(..last);
                if let Some((begin, value)) = values.first_mut() {
                    *value += if grows { to - *begin } else { 0.0 };
                    *begin = to;
                }
            }
            join(into, [from, to]);
        }
        self.add_motion(span, (plant, guidance, loads), &mut pieces);
        for (pieces, points) in pieces.iter().zip(self.kept.iter_mut().flatten()) {
            for piece in pieces {
                piece.push_points(points);
            }
        }
        for (_, monitor, places) in &mut self.monitors {
            let read: Vec<&[SignalPiece]> = places.iter().map(|place| &pieces[*place][..]).collect();
            monitor.push(&read);
        }
        self.since = now;
    }

    /// Records the robustness of all requirements over time, at the end of the run.
    pub fn finish(&mut self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        if self.is_empty() {
            return Ok(());
        }
        let judged = |(requirement, monitor, _): (usize, RequirementMonitor, _)| {
            let range = monitor.finish(now.seconds());
            RequirementRobustness {
                requirement,
                least: range.low.value,
                largest: range.high.value,
                at: if range.low.value.is_finite() { range.low.at } else { range.high.at },
            }
        };
        let mut report = Report::new();
        if let Some(signals) = self.kept.take() {
            let of_requirements =
                self.monitors.iter().map(|(requirement, _, places)| (*requirement, places.clone())).collect();
            report.add_value(RequirementSignals { signals, of_requirements });
        }
        report.add_value(RobustnessOfRequirements(
            std::mem::take(&mut self.monitors).into_iter().map(judged).collect(),
        ));
        record.record(now, Sample::Report(&report))
    }
}

/// Returns an interval cut at edges and into equal parts of at most a length (s).
fn parts([from, to]: [f64; 2], longest: f64, edges: &[f64]) -> Vec<[f64; 2]> {
    let mut ends: Vec<f64> = edges.iter().copied().filter(|edge| *edge > from && *edge < to).collect();
    ends.push(to);
    let (mut begin, mut all) = (from, Vec::new());
    for end in ends {
        let count = ((end - begin) / longest).ceil().max(1.0);
        let at = |index: f64| if index == count { end } else { begin + (end - begin) * index / count };
        all.extend((0..count as u64).map(|index| [at(index as f64), at(index as f64 + 1.0)]));
        begin = end;
    }
    all
}

/// Returns the piece of a polynomial; none without length.
fn curve(begin: f64, length: f64, polynomial: Polynomial) -> Option<SignalPiece> {
    let curve = Arc::new(Curve { begin, length, polynomial });
    let shape = PieceValues::Curve { curve, gain: 1.0, offset: 0.0, ahead: 0.0 };
    (length > 0.0).then_some(SignalPiece { from: begin, to: begin + length, shape })
}

/// Returns the piece of a value that is constant or, if it `grows`, a time; none without length.
fn held_value([from, to]: [f64; 2], value: f64, grows: bool) -> Option<SignalPiece> {
    if grows {
        let mut terms = [0.0; TERMS];
        (terms[0], terms[1]) = (value, to - from);
        return curve(from, to - from, Polynomial::new(terms));
    }
    (to > from).then(|| SignalPiece::constant(from, to, value))
}

/// Closes gaps by rounding between pieces, from the start of a segment to its end.
fn join(pieces: &mut [SignalPiece], [from, to]: [f64; 2]) {
    let mut begin = from;
    for piece in pieces.iter_mut() {
        piece.from = begin;
        begin = piece.to.max(begin);
        piece.to = begin;
    }
    if let Some(last) = pieces.last_mut() {
        last.to = to;
    }
}
