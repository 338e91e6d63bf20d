//! Detection of the limit cycle in which a run of the relay law ends, and its Floquet multipliers.
//!
//! The Poincaré section is the entry into a strong push, where the angle is at its boundary. The fundamental matrix of
//! one cycle is a product of exact derivatives: those of the flow between switchings, and those of the switching times.
//! The time of a guard crossing changes so that the angle stays on the guard's level; a brake lasts k_t times the push
//! before it, so its duration changes k_t times as much.

use flexsc_control::law::Phase;
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::flow::{SegmentInput, UncoupledSegment};
use flexsc_dynamics::{self, AxisState};
use flexsc_numerics::time::Instant;
use flexsc_record::{Command, Record, RecordError, Sample, Trigger};
use nalgebra::{Complex, DMatrix, RowDVector};

use super::eigenvalues::schur_eigenvalues;

/// Largest number of pushes per cycle that the detector considers.
const LONGEST: usize = 16;
/// Number of switchings that are kept: enough for two of the longest cycles.
const KEPT: usize = 16 * LONGEST;
/// Tolerance, relative to the motion, within which two passes of the section are the same cycle.
const SAME: f64 = 1e-6;
/// Largest number of modes for which multipliers are computed: the cost of the eigenproblem grows with its third power.
const MOST_MODES: usize = 64;

/// Limit cycle of a simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitCycle {
    /// Boundaries that push back.
    pub kind: CycleKind,
    /// Period (s).
    pub period: f64,
    /// Number of pushes from the section's boundary in one period.
    pub order: usize,
    /// True if the second half of the cycle mirrors the first.
    pub symmetric: bool,
    /// Fraction of the time under strong torque.
    pub duty: f64,
    /// Integral of the absolute torque over one period (N m s).
    pub impulse: f64,
    /// Floquet multipliers: absolute value and argument (rad), largest first. Empty where they are not defined (sampled
    /// measurement) or where there are too many modes.
    pub multipliers: Vec<(f64, f64)>,
}

/// Boundaries that push back in a cycle.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum CycleKind {
    /// Both boundaries push back, equally often.
    TwoSided,
    /// One boundary pushes back.
    OneSided,
    /// Both boundaries push back, one more often than the other.
    Mixed,
}

impl CycleKind {
    /// Returns the kind as a word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::TwoSided => "two-sided",
            Self::OneSided => "one-sided",
            Self::Mixed => "mixed",
        }
    }
}

/// Recorder that keeps the last switchings of a run, to detect its limit cycle.
#[derive(Clone, Debug)]
pub struct LimitCycleDetector {
    segment: UncoupledSegment,
    excitations: usize,
    smooth: bool,
    /// Ring of the last switchings, with their states in `states`; the oldest is overwritten next.
    switchings: Vec<CompactSwitching>,
    states: Vec<f64>,
    next: usize,
}

/// Switching without the state of the motion.
#[derive(Copy, Clone, Debug)]
struct CompactSwitching {
    time: Instant,
    phase: Phase,
    trigger: Trigger,
    torque: f64,
    gain: f64,
}

#[derive(Clone, Debug)]
struct Switching {
    switching: CompactSwitching,
    state: AxisState,
}

impl LimitCycleDetector {
    /// Creates a detector for a body whose angle is measured continuously (`smooth`) or at samples.
    pub fn new(body: &AxisModel, smooth: bool) -> Self {
        let excitations = body.modes.len();
        Self {
            segment: UncoupledSegment::new(body),
            excitations,
            smooth,
            switchings: Vec::with_capacity(KEPT),
            states: Vec::with_capacity(KEPT * (2 + 2 * excitations)),
            next: 0,
        }
    }

    /// Observes a switching, with the body in this state.
    pub fn observe(&mut self, now: Instant, command: &Command, state: &AxisState) {
        let Command { state: phase, cause: trigger, torque_nm: torque, gain, .. } = *command;
        self.keep(CompactSwitching { time: now, phase, trigger, torque, gain }, state);
    }

    /// Keeps a switching in place of the oldest one, so that a long run allocates no memory.
    fn keep(&mut self, switching: CompactSwitching, state: &AxisState) {
        let modes = state.modes.iter().flat_map(|mode| [mode.displacement, mode.quadrature]);
        let numbers = [state.rigid_angle, state.rigid_rate].into_iter().chain(modes);
        if self.switchings.len() < KEPT {
            self.switchings.push(switching);
            self.states.extend(numbers);
            return;
        }
        let size = self.states.len() / KEPT;
        self.switchings[self.next] = switching;
        let place = &mut self.states[size * self.next..][..size];
        place.iter_mut().zip(numbers).for_each(|(old, new)| *old = new);
        self.next = (self.next + 1) % KEPT;
    }

    /// Returns the place of a switching in `switchings`; `index` counts from the oldest one.
    fn place(&self, index: usize) -> usize {
        (self.next + index) % self.switchings.len()
    }

    /// Returns a switching with its state; `index` counts from the oldest one.
    fn switching(&self, index: usize) -> Switching {
        let (place, size) = (self.place(index), self.states.len() / self.switchings.len());
        let numbers = &self.states[size * place..][..size];
        let mode = |pair: &[f64]| flexsc_dynamics::ModeState { displacement: pair[0], quadrature: pair[1] };
        Switching {
            switching: self.switchings[place],
            state: AxisState {
                rigid_angle: numbers[0],
                rigid_rate: numbers[1],
                modes: numbers[2..].chunks_exact(2).map(mode).collect(),
            },
        }
    }

    /// Returns the limit cycle in which the run ended; `None` if it ended in no cycle.
    pub fn cycle(mut self) -> Option<LimitCycle> {
        let sections_of = |phase: Phase| -> Vec<usize> {
            (0..self.switchings.len())
                .filter(|&index| self.switchings[self.place(index)].phase == phase)
                .collect()
        };
        let right_pushes = sections_of(Phase::PushFromRight);
        let sections = if right_pushes.len() > 1 { right_pushes } else { sections_of(Phase::PushFromLeft) };
        let last = *sections.last()?;
        let end = self.switching(last).state;
        let order = (1..=LONGEST.min(sections.len() - 1)).find(|order| {
            let first = sections[sections.len() - 1 - order];
            same(&self.switching(first).state, &end)
        })?;
        let first = sections[sections.len() - 1 - order];
        let one: Vec<Switching> = (first..=last).map(|index| self.switching(index)).collect();
        let one = &one[..];
        let span = |pair: &[Switching]| pair[1].switching.time.since(pair[0].switching.time).seconds();
        let period = one[one.len() - 1].switching.time.since(one[0].switching.time).seconds();
        let count = |phase| one[1..].iter().filter(|s| s.switching.phase == phase).count();
        let kind = match (count(Phase::PushFromRight), count(Phase::PushFromLeft)) {
            (0, _) | (_, 0) => CycleKind::OneSided,
            (right, left) if right == left => CycleKind::TwoSided,
            _ => CycleKind::Mixed,
        };
        let pairs = || one.windows(2);
        Some(LimitCycle {
            kind,
            period,
            order,
            symmetric: symmetric(one),
            duty: pairs().filter(|pair| pair[0].switching.phase.is_strong()).map(span).sum::<f64>() / period,
            impulse: pairs().map(|pair| pair[0].switching.torque.abs() * span(pair)).sum(),
            multipliers: if self.smooth && self.excitations <= MOST_MODES {
                multipliers(&mut self.segment, one)
            } else {
                Vec::new()
            },
        })
    }
}

impl Record for LimitCycleDetector {
    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        if let Sample::Switching(command, state) = sample {
            self.observe(now, command, state);
        }
        Ok(())
    }
}

/// Returns true if two passes of the section are the same: rates and modes agree relative to their size.
fn same(a: &AxisState, b: &AxisState) -> bool {
    let size: f64 = b.modes.iter().map(|m| m.displacement.abs() + m.quadrature.abs()).sum();
    let rate = b.rigid_rate.abs();
    let modes = a.modes.iter().zip(&b.modes).all(|(p, q)| {
        (p.displacement - q.displacement).abs() <= SAME * size
            && (p.quadrature - q.quadrature).abs() <= SAME * size
    });
    modes && (a.rigid_rate - b.rigid_rate).abs() <= SAME * rate
}

/// Returns true if the second half of a cycle mirrors its first.
fn symmetric(one: &[Switching]) -> bool {
    let middle = (one.len() - 1) / 2;
    let (first, half) = (&one[0], &one[middle]);
    if first.switching.torque != -half.switching.torque {
        return false;
    }
    let mirrored = AxisState {
        rigid_angle: -half.state.rigid_angle,
        rigid_rate: -half.state.rigid_rate,
        modes: half
            .state
            .modes
            .iter()
            .map(|m| flexsc_dynamics::ModeState { displacement: -m.displacement, quadrature: -m.quadrature })
            .collect(),
    };
    same(&mirrored, &first.state)
}

/// Returns the eigenvalues of the cycle's fundamental matrix on the section (absolute value and argument), largest
/// first.
fn multipliers(segment: &mut UncoupledSegment, one: &[Switching]) -> Vec<(f64, f64)> {
    let size = 2 + 2 * one[0].state.modes.len();
    let mut fundamental = DMatrix::<f64>::identity(size, size);
    // Derivative of the last push's duration with respect to the state on the section.
    let mut push = RowDVector::<f64>::zeros(size);
    let mut end = one[0].state.clone();
    for pair in one.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        let h = to.switching.time.since(from.switching.time).seconds();
        segment.depart(&from.state, &SegmentInput::constant(from.switching.torque));
        let sensed = segment.at(h, &mut end);
        for mut column in fundamental.column_iter_mut() {
            segment.propagate_deviation(h, column.as_mut_slice());
        }
        let duration = match to.switching.trigger {
            Trigger::Timeout => &push * from.switching.gain,
            // The angle is the sum of the rigid angle and all displacements: every second component.
            Trigger::Guard => {
                let mut angle = RowDVector::<f64>::zeros(size);
                for component in (0..size).step_by(2) {
                    angle += fundamental.row(component);
                }
                angle * (-1.0 / sensed.rate)
            }
        };
        fundamental += segment.velocity(&end) * &duration;
        push = duration;
    }
    let values = schur_eigenvalues(&fundamental).unwrap_or_default();
    let polar = |z: Complex<f64>| (flexsc_numerics::phasor::abs(z), flexsc_numerics::phasor::arg(z));
    let mut eigenvalues: Vec<(f64, f64)> = values.into_iter().map(polar).collect();
    eigenvalues.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
    // The motion off the section dies out within a cycle: one eigenvalue is zero, and has no meaning.
    eigenvalues.pop();
    eigenvalues
}
