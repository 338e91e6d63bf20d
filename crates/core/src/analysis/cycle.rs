//! The limit cycle that a run of the relay law ends in, and its Floquet multipliers.
//!
//! The Poincaré section is the entry into a strong push, where the angle is at its boundary. The fundamental
//! matrix of one cycle is the product of exact derivatives: the flow's between switchings, and at each switching
//! that of its time. A guard's time moves so that the angle stays on its level; a brake lasts k_t times the push
//! before it, so its duration moves k_t times as much.

use nalgebra::{DMatrix, RowDVector, Schur};

use crate::body::Planar;
use crate::flow::{ForcedInput, Segment};
use crate::law::Phase;
use crate::motion::{self, State};
use crate::record::{Command, Record, RecordError, Sample, Trigger};
use crate::time::Instant;

/// Cycles of more pushes than this are not looked for.
const LONGEST: usize = 16;
/// Switchings that are kept: enough for two of the longest cycles.
const KEPT: usize = 16 * LONGEST;
/// Two passes of the section are the same cycle if they agree so well, relative to the motion.
const SAME: f64 = 1e-6;
/// Multipliers are not computed for more modes: the eigenproblem grows with the third power.
const MOST_MODES: usize = 64;

/// A limit cycle of a simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitCycle {
    /// Which boundaries push back.
    pub kind: CycleKind,
    /// Period (s).
    pub period: f64,
    /// Pushes from the section's boundary in one period.
    pub order: usize,
    /// Whether the second half mirrors the first.
    pub symmetric: bool,
    /// Fraction of the time under strong torque.
    pub duty: f64,
    /// Integral of the absolute torque over one period (N m s).
    pub impulse: f64,
    /// Floquet multipliers: absolute value and argument (rad), largest first. Empty where they are not defined
    /// (sampled measurement) or too many.
    pub multipliers: Vec<(f64, f64)>,
}

/// Which boundaries push back in a cycle.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum CycleKind {
    /// Both, as often.
    TwoSided,
    /// One.
    OneSided,
    /// Both, one more often.
    Mixed,
}

impl CycleKind {
    /// The kind as a word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::TwoSided => "two-sided",
            Self::OneSided => "one-sided",
            Self::Mixed => "mixed",
        }
    }
}

/// Watches a run for its limit cycle.
#[derive(Clone, Debug)]
pub struct CycleWatch {
    segment: Segment,
    excitations: usize,
    smooth: bool,
    /// The last switchings, and their states one after the other; the oldest is overwritten next.
    kept: Vec<Kept>,
    states: Vec<f64>,
    next: usize,
}

/// A switching without its state.
#[derive(Copy, Clone, Debug)]
struct Kept {
    at: Instant,
    phase: Phase,
    trigger: Trigger,
    torque: f64,
    gain: f64,
}

#[derive(Clone, Debug)]
struct Switching {
    of: Kept,
    state: State,
}

impl CycleWatch {
    /// A watch over a body whose angle is measured continuously (`smooth`) or not.
    pub fn new(body: &Planar, smooth: bool) -> Self {
        let excitations = body.modes.len();
        Self {
            segment: Segment::new(body),
            excitations,
            smooth,
            kept: Vec::with_capacity(KEPT),
            states: Vec::with_capacity(KEPT * (2 + 2 * excitations)),
            next: 0,
        }
    }

    /// Keeps a switching in the place of the oldest one: a watch of a long run allocates nothing.
    fn keep(&mut self, switching: Kept, state: &State) {
        let modes = state.modes.iter().flat_map(|mode| [mode.displacement, mode.quadrature]);
        let numbers = [state.rigid_angle, state.rigid_rate].into_iter().chain(modes);
        if self.kept.len() < KEPT {
            self.kept.push(switching);
            self.states.extend(numbers);
            return;
        }
        let size = self.states.len() / KEPT;
        self.kept[self.next] = switching;
        let place = &mut self.states[size * self.next..][..size];
        place.iter_mut().zip(numbers).for_each(|(old, new)| *old = new);
        self.next = (self.next + 1) % KEPT;
    }

    /// Where a switching is kept, counted from the oldest one.
    fn place(&self, index: usize) -> usize {
        (self.next + index) % self.kept.len()
    }

    /// A switching with its state, counted from the oldest one.
    fn switching(&self, index: usize) -> Switching {
        let (place, size) = (self.place(index), self.states.len() / self.kept.len());
        let numbers = &self.states[size * place..][..size];
        let mode = |pair: &[f64]| motion::Phase { displacement: pair[0], quadrature: pair[1] };
        Switching {
            of: self.kept[place],
            state: State {
                rigid_angle: numbers[0],
                rigid_rate: numbers[1],
                modes: numbers[2..].chunks_exact(2).map(mode).collect(),
            },
        }
    }

    /// The cycle that the run ended in, if it did.
    pub fn cycle(mut self) -> Option<LimitCycle> {
        let sections_of = |phase: Phase| -> Vec<usize> {
            (0..self.kept.len()).filter(|&index| self.kept[self.place(index)].phase == phase).collect()
        };
        let right = sections_of(Phase::RightPush);
        let sections = if right.len() > 1 { right } else { sections_of(Phase::LeftPush) };
        let last = *sections.last()?;
        let end = self.switching(last).state;
        let order = (1..=LONGEST.min(sections.len() - 1)).find(|order| {
            let first = sections[sections.len() - 1 - order];
            same(&self.switching(first).state, &end)
        })?;
        let first = sections[sections.len() - 1 - order];
        let one: Vec<Switching> = (first..=last).map(|index| self.switching(index)).collect();
        let one = &one[..];
        let span = |pair: &[Switching]| pair[1].of.at.since(pair[0].of.at).seconds();
        let period = one[one.len() - 1].of.at.since(one[0].of.at).seconds();
        let count = |phase| one[1..].iter().filter(|s| s.of.phase == phase).count();
        let kind = match (count(Phase::RightPush), count(Phase::LeftPush)) {
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
            duty: pairs().filter(|pair| pair[0].of.phase.is_strong()).map(span).sum::<f64>() / period,
            impulse: pairs().map(|pair| pair[0].of.torque.abs() * span(pair)).sum(),
            multipliers: if self.smooth && self.excitations <= MOST_MODES {
                multipliers(&mut self.segment, one)
            } else {
                Vec::new()
            },
        })
    }
}

impl Record for CycleWatch {
    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        if let Sample::Switching(command, state) = sample {
            let Command { state: phase, cause: trigger, torque_nm: torque, gain, .. } = *command;
            self.keep(Kept { at: now, phase, trigger, torque, gain }, state);
        }
        Ok(())
    }
}

/// Whether two passes of the section are the same: rates and modes agree relative to their size.
fn same(a: &State, b: &State) -> bool {
    let size: f64 = b.modes.iter().map(|m| m.displacement.abs() + m.quadrature.abs()).sum();
    let rate = b.rigid_rate.abs();
    let modes = a.modes.iter().zip(&b.modes).all(|(p, q)| {
        (p.displacement - q.displacement).abs() <= SAME * size
            && (p.quadrature - q.quadrature).abs() <= SAME * size
    });
    modes && (a.rigid_rate - b.rigid_rate).abs() <= SAME * rate
}

/// Whether the second half of a cycle mirrors its first.
fn symmetric(one: &[Switching]) -> bool {
    let middle = (one.len() - 1) / 2;
    let (first, half) = (&one[0], &one[middle]);
    if first.of.torque != -half.of.torque {
        return false;
    }
    let mirrored = State {
        rigid_angle: -half.state.rigid_angle,
        rigid_rate: -half.state.rigid_rate,
        modes: half
            .state
            .modes
            .iter()
            .map(|m| motion::Phase { displacement: -m.displacement, quadrature: -m.quadrature })
            .collect(),
    };
    same(&mirrored, &first.state)
}

/// The eigenvalues of the cycle's fundamental matrix on the section, largest first.
fn multipliers(segment: &mut Segment, one: &[Switching]) -> Vec<(f64, f64)> {
    let size = 2 + 2 * one[0].state.modes.len();
    let mut fundamental = DMatrix::<f64>::identity(size, size);
    // How the duration of the last push moves with the state on the section.
    let mut push = RowDVector::<f64>::zeros(size);
    let mut end = one[0].state.clone();
    for pair in one.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        let h = to.of.at.since(from.of.at).seconds();
        segment.depart(&from.state, &ForcedInput::constant(from.of.torque));
        let sensed = segment.at(h, &mut end);
        for mut column in fundamental.column_iter_mut() {
            segment.carry(h, column.as_mut_slice());
        }
        let duration = match to.of.trigger {
            Trigger::Timeout => &push * from.of.gain,
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
    let Some(schur) = Schur::try_new(fundamental, f64::EPSILON, 10_000) else { return Vec::new() };
    let mut eigenvalues: Vec<(f64, f64)> = schur
        .complex_eigenvalues()
        .iter()
        .map(|z| (crate::numerics::phasor::abs(*z), crate::numerics::phasor::arg(*z)))
        .collect();
    eigenvalues.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
    // Off the section nothing is left after a cycle: one eigenvalue is zero, and has no meaning.
    eigenvalues.pop();
    eigenvalues
}
