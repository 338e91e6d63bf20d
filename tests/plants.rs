//! Coupled plants, and the relay law of the study flown on any of their axes.

use std::cell::Cell;
use std::convert::Infallible;
use std::sync::Arc;

use flexsc_core::dynamics::crossing::{BoundedMotion, first_crossing};
use flexsc_core::dynamics::guard::Guard;
use flexsc_core::dynamics::linear::{
    LinearFlow, LinearOutput, LinearPlant, LinearSegment, ModalState, OutputGuard, SecondOrderPlant,
    SplitPlant,
};
use flexsc_core::numerics::time::{Instant, Span};
use nalgebra::{DMatrix, DVector, dmatrix, dvector};

/// Half width of the dead zone, hysteresis (rad), strong and weak moment (rad/s²).
const LAW: [f64; 4] = [5e-4, 1e-4, 4e-5, 1e-6];

/// The relay law on one axis.
struct Relay {
    state: &'static str,
    pushed: Instant,
    moment: f64,
    until: Option<Instant>,
    guards: Vec<Guard>,
}

impl Relay {
    fn new() -> Self {
        let mut relay =
            Self { state: "W0", pushed: Instant::START, moment: 0.0, until: None, guards: Vec::new() };
        relay.enter("W0", Instant::START, 0.0);
        relay
    }

    fn enter(&mut self, state: &'static str, now: Instant, k_t: f64) {
        let [eps, gamma, strong, weak] = LAW;
        self.state = state;
        self.until = None;
        self.guards.clear();
        match state {
            "RACC" | "LACC" => {
                self.pushed = now;
                let right = state == "RACC";
                self.moment = if right { -strong } else { strong };
                let back = eps - gamma;
                self.guards.push(if right { Guard::at_most(back) } else { Guard::at_least(-back) });
            }
            "RBRK" | "LBRK" => {
                self.moment = if state == "RBRK" { strong } else { -strong };
                self.until = Some(now + Span::from_seconds(k_t * now.since(self.pushed).seconds()));
            }
            _ => {
                self.moment = if state == "W-" { -weak } else { weak };
                self.guards.extend([Guard::at_least(eps), Guard::at_most(-eps)]);
            }
        }
    }

    fn next(&self, guard: Option<usize>) -> &'static str {
        match (self.state, guard) {
            ("RACC", _) => "RBRK",
            ("LACC", _) => "LBRK",
            ("RBRK", _) => "W+",
            ("LBRK", _) => "W-",
            (_, Some(1)) => "LACC",
            _ => "RACC",
        }
    }
}

/// Segment that counts its evaluations.
pub struct Counted<'a>(pub &'a LinearSegment, pub &'a Cell<u32>);

impl BoundedMotion for Counted<'_> {
    type Guard = OutputGuard;
    type State = LinearOutput;
    type Observation = ();

    fn initial(&self, seen: &mut LinearOutput) {
        self.1.set(self.1.get() + 1);
        self.0.initial(seen);
    }
    fn evaluate(&self, h: f64, seen: &mut LinearOutput) {
        self.1.set(self.1.get() + 1);
        self.0.evaluate(h, seen);
    }
    fn is_finite(seen: &LinearOutput, (): ()) -> bool {
        LinearSegment::is_finite(seen, ())
    }
    fn holds(guard: OutputGuard, seen: &LinearOutput, (): ()) -> bool {
        LinearSegment::holds(guard, seen, ())
    }
    fn bounds_valid_for(seen: &LinearOutput) -> f64 {
        LinearSegment::bounds_valid_for(seen)
    }
    fn earliest_crossing(&self, guard: OutputGuard, horizon: Span, seen: &LinearOutput) -> f64 {
        self.0.earliest_crossing(guard, horizon, seen)
    }
    fn safe_stride(&self, guard: OutputGuard, seen: &LinearOutput, (): ()) -> f64 {
        self.0.safe_stride(guard, seen, ())
    }
    fn has_no_crossing(&self, guard: OutputGuard, seen: &LinearOutput, (): (), time: f64) -> bool {
        self.0.has_no_crossing(guard, seen, (), time)
    }
}

/// Result of a run: switchings (axis, state, instant), evaluations of each guarded arc, and states at some times.
pub struct Flight {
    pub switchings: Vec<(usize, &'static str, Instant)>,
    pub evaluations: f64,
    pub states: Vec<DVector<f64>>,
}

/// Flies a plant whose outputs are the axes and whose inputs are moments times these inertias.
pub fn fly(
    form: SplitPlant,
    start: &DVector<f64>,
    inertias: &[f64],
    k_t: f64,
    times: &[f64],
    count: usize,
) -> Flight {
    let flow = Arc::new(LinearFlow::new(form).expect("a flow"));
    let mut here: ModalState = flow.to_modal(start);
    let mut segment = LinearSegment::new(Arc::clone(&flow));
    let mut relays: Vec<Relay> = inertias.iter().map(|_| Relay::new()).collect();
    let (mut now, mut seen, counter) = (Instant::START, LinearOutput::default(), Cell::new(0));
    let (mut arcs, mut flight) = (0, Flight { switchings: Vec::new(), evaluations: 0.0, states: Vec::new() });
    while flight.switchings.len() < count || flight.states.len() < times.len() {
        let input: Vec<f64> = relays.iter().zip(inertias).map(|(relay, j)| j * relay.moment).collect();
        segment.depart(&here, &input);
        let end = relays.iter().filter_map(|relay| relay.until).min();
        let horizon = end.map_or(Span::from_seconds(1e4), |end| end.since(now));
        let guards: Vec<(OutputGuard, usize)> = relays
            .iter()
            .enumerate()
            .flat_map(|(output, relay)| {
                relay
                    .guards
                    .iter()
                    .enumerate()
                    .map(move |(index, guard)| (OutputGuard { output, guard: *guard }, index))
            })
            .collect();
        let levels: Vec<OutputGuard> = guards.iter().map(|(level, _)| *level).collect();
        arcs += u32::from(!levels.is_empty());
        let trip = if levels.is_empty() {
            None
        } else {
            first_crossing(&Counted(&segment, &counter), &levels, horizon, &mut seen, || {
                Ok::<_, Infallible>(())
            })
            .expect("not stopped")
        };
        let after = trip.map_or(horizon, |trip| trip.after);
        while flight.states.len() < times.len() && times[flight.states.len()] <= (now + after).seconds() {
            let mut state = here.clone();
            let at = Instant::START + Span::from_seconds(times[flight.states.len()]);
            segment.state_at(at.since(now).seconds(), &mut state);
            flight.states.push(flow.to_state(&state));
        }
        segment.state_at(after.seconds(), &mut here);
        now += after;
        let (axis, guard) = match trip {
            Some(trip) => (guards[trip.guard].0.output, Some(guards[trip.guard].1)),
            None => (relays.iter().position(|relay| relay.until == Some(now)).expect("a timer"), None),
        };
        let next = relays[axis].next(guard);
        relays[axis].enter(next, now, k_t);
        flight.switchings.push((axis, next, now));
    }
    flight.evaluations = f64::from(counter.get()) / f64::from(arcs);
    flight
}

/// A file of golden numbers, cell by cell.
pub fn golden(name: &str) -> Vec<Vec<String>> {
    let path = format!("{}/../../tests/golden/linear/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a file of golden numbers");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.records().map(|row| row.expect("a row").iter().map(str::to_owned).collect()).collect()
}

/// The error (s) of an instant against a time of many decimals.
pub fn off(at: Instant, exact: &str) -> f64 {
    let (whole, part) = exact.split_once('.').expect("decimals");
    let (whole, part): (i64, f64) =
        (whole.parse().expect("a number"), format!("0.{part}").parse().expect("a number"));
    let (seconds, femtoseconds) = at.parts();
    (seconds as i64 - whole) as f64 + (femtoseconds as f64 / 1e15 - part)
}

pub const W: [f64; 2] = [0.44, 0.755];
pub const K: [f64; 2] = [0.0213, 0.0216];

/// Plant (a) with this back-EMF (1/s).
pub fn wheel(back_emf: f64) -> LinearPlant {
    let mut matrix = DMatrix::zeros(6, 6);
    for i in 0..3 {
        matrix[(2 * i, 2 * i + 1)] = 1.0;
        let gain = if i == 0 { 1.0 } else { K[i - 1] };
        for j in 0..3 {
            matrix[(2 * i + 1, 2 * j + 1)] = -back_emf * gain;
        }
        if i > 0 {
            matrix[(2 * i + 1, 2 * i)] = -W[i - 1] * W[i - 1];
        }
    }
    let input = dmatrix![0.0; 1.0; 0.0; K[0]; 0.0; K[1]];
    LinearPlant { matrix, input, output: dmatrix![1.0, 0.0, 1.0, 0.0, 1.0, 0.0] }
}

pub fn wheel_start() -> DVector<f64> {
    dvector![4.5e-4, 2.2e-5, 2.75e-6, 0.0, 0.0, 0.0]
}

/// Plant (b): a dashpot beside the wheel.
pub fn dashpot() -> LinearPlant {
    let mut system = wheel(2e-4);
    for (at, value) in [((3, 3), -0.0061), ((3, 5), 0.005_964), ((5, 5), -0.0061), ((5, 3), 0.006_048)] {
        system.matrix[at] += value;
    }
    system
}

/// Plant (d): a low-pass and a notch between the angle and the law.
pub fn filters(back_emf: f64) -> LinearPlant {
    let plain = wheel(back_emf);
    let mut matrix = DMatrix::zeros(9, 9);
    matrix.view_mut((0, 0), (6, 6)).copy_from(&plain.matrix);
    for j in [0, 2, 4] {
        matrix[(6, j)] = 2.0;
    }
    matrix[(6, 6)] = -2.0;
    let wn = 0.755;
    (matrix[(7, 8)], matrix[(8, 7)], matrix[(8, 8)], matrix[(8, 6)]) = (1.0, -wn * wn, -1.4 * wn, 1.0);
    let output = DMatrix::from_fn(1, 9, |_, j| {
        [1.0, 0.0, -1.3 * wn][j.saturating_sub(6)] * f64::from(u8::from(j >= 6))
    });
    LinearPlant { matrix, input: plain.input.resize_vertically(9, 0.0), output }
}

pub fn filters_start() -> DVector<f64> {
    let mut start = wheel_start().resize_vertically(9, 0.0);
    start[6] = 4.5275e-4;
    start
}

/// Plant (g): a disturbance of this frequency (rad/s), by two more states.
pub fn forced(nu: f64) -> LinearPlant {
    let plain = wheel(2e-4);
    let mut matrix = DMatrix::zeros(8, 8);
    matrix.view_mut((0, 0), (6, 6)).copy_from(&plain.matrix);
    for (row, gain) in [(1, 1.0), (3, K[0]), (5, K[1])] {
        matrix[(row, 6)] = 2e-7 * gain;
    }
    (matrix[(6, 7)], matrix[(7, 6)]) = (nu, -nu);
    LinearPlant {
        matrix,
        input: plain.input.resize_vertically(8, 0.0),
        output: plain.output.resize_horizontally(8, 0.0),
    }
}

pub fn forced_start() -> DVector<f64> {
    let mut start = wheel_start().resize_vertically(8, 0.0);
    start[7] = 1.0;
    start
}

pub const INERTIAS: [f64; 3] = [900.0, 1000.0, 600.0];

/// Plant (c): three axes and three modes, with this orbital rate (rad/s) and momentum bias (N m s).
pub fn three_axes(n: f64, h: f64) -> SecondOrderPlant {
    let [j1, j2, j3] = INERTIAS;
    let delta = [[8.0, 0.5, -1.0], [0.7, 7.0, 2.0], [-0.4, 1.5, 5.0]];
    let (w, zeta) = ([0.37, 0.62, 1.1], [0.002, 0.003, 0.002]);
    let mut mass = DMatrix::from_diagonal(&dvector![j1, j2, j3, 1.0, 1.0, 1.0]);
    let mut damping = DMatrix::zeros(6, 6);
    let mut stiffness = DMatrix::zeros(6, 6);
    for i in 0..3 {
        for j in 0..3 {
            (mass[(i, 3 + j)], mass[(3 + j, i)]) = (delta[i][j], delta[i][j]);
        }
        damping[(3 + i, 3 + i)] = 2.0 * zeta[i] * w[i];
        stiffness[(3 + i, 3 + i)] = w[i] * w[i];
    }
    let gyroscopic = h - n * (j1 - j2 + j3);
    (damping[(0, 2)], damping[(2, 0)]) = (gyroscopic, -gyroscopic);
    let hub = [4.0 * n * n * (j2 - j3) + n * h, 3.0 * n * n * (j1 - j3), n * n * (j2 - j1) + n * h];
    for (i, k) in hub.into_iter().enumerate() {
        stiffness[(i, i)] = k;
    }
    let output = DMatrix::from_fn(3, 6, |i, j| f64::from(u8::from(i == j)));
    SecondOrderPlant { mass, damping, stiffness, input: output.transpose(), output }
}

pub fn three_start() -> DVector<f64> {
    dvector![4.5e-4, -3e-4, 1e-4, 1e-3, 0.0, 0.0, 2.2e-5, -1.5e-5, 3e-5, 0.0, 0.0, 0.0]
}
