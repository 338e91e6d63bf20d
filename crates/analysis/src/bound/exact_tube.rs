//! Range of an output over sets of initial states and inputs, for one body: its support function in closed form.
//!
//! y(t) = sum g_i(t) x_i(0) + sum int h_j(t - s) u_j(s) ds, with g and h sums of damped sines. Over independent ranges
//! every term has its own extremes: those of g_i x_i, those of H_j u_j for a constant input, H = int h, and u H +- r int
//! |h| for one that varies within u +- r.

use flexsc_numerics::enclosure::Enclosure;

use super::modal_form::ModalForm;
use super::reach::{Tube, TubeInstant};
use super::response::{ModePole, PairResponses, Phasors, Response, SUMMATION, weighted_sum};
use super::sets::{InputSets, middle, products};
use super::variation::{Impulse, SignChanges, Variation};

/// Response of the output to an input.
struct InputResponse {
    impulse: Response,
    slope: Response,
    step: Response,
    constant: Enclosure,
    /// Middle and half the width of the range within which the input varies.
    varying: [f64; 2],
    /// Bounds of the second and third derivative of the impulse response: part of each pole.
    bends: [Vec<f64>; 2],
}

/// Range of an output of one body.
pub struct ExactTube {
    poles: Vec<ModePole>,
    start: Vec<(Response, Enclosure)>,
    inputs: Vec<InputResponse>,
    /// Bound of the second derivative of the range: part of each pole, and of the rigid motion.
    curvature: (Vec<f64>, f64),
    narrowest: f64,
    /// Gap of an integral that is small enough.
    small: f64,
}

/// Integrals of an instant, of each input that varies, and its impulse response.
#[derive(Clone, Debug)]
pub struct ExactIntegrals(Vec<(Impulse, Variation)>);

impl ExactTube {
    /// Creates the range for sets of initial states and inputs, up to the time `until` (s).
    pub fn new(body: &ModalForm, sets: &InputSets, until: f64) -> Self {
        let poles: Vec<ModePole> = body.pairs.iter().map(ModePole::new).collect();
        let responses = body.pairs.iter().enumerate();
        let responses: Vec<PairResponses> =
            responses.map(|(index, pair)| PairResponses::new(pair, index, &poles)).collect();
        let input = |input: usize| {
            let sum = |of: fn(&PairResponses) -> &Response| {
                let parts = body.pairs.iter().zip(&responses);
                weighted_sum(parts.map(|(pair, part)| (pair.inputs[input], of(part))), &poles)
            };
            let (impulse, step) = (sum(|part| &part.rate), sum(|part| &part.step));
            let mut bends = [vec![0.0; poles.len()], vec![0.0; poles.len()]];
            impulse.add_derivative(2, 1.0, &poles, &mut bends[0]);
            impulse.add_derivative(3, 1.0, &poles, &mut bends[1]);
            let slope = impulse.derivative(&poles);
            let (constant, varying) = (sets.constant[input], middle(sets.varying[input]));
            InputResponse { impulse, slope, step, constant, varying, bends }
        };
        let inputs: Vec<InputResponse> = (0..body.input_count()).map(input).collect();
        let (mut sizes, mut rigid) = (vec![0.0; poles.len()], 0.0);
        let mut start = Vec::new();
        for (pair, part) in body.pairs.iter().zip(responses) {
            for (state, response) in pair.states.into_iter().zip([part.position, part.rate]) {
                let range = sets.start[state];
                if range.magnitude() > 0.0 {
                    rigid += response.add_derivative(2, range.magnitude(), &poles, &mut sizes);
                    start.push((response, range));
                }
            }
        }
        for input in &inputs {
            let most = input.constant.magnitude() + input.varying[0].abs() + input.varying[1];
            rigid += input.impulse.add_derivative(1, most, &poles, &mut sizes);
        }
        let mut tube =
            Self { poles, start, inputs, curvature: (sizes, rigid), narrowest: until * 1e-12, small: 0.0 };
        tube.small = tube.inputs.iter().map(|input| input.bends[0].iter().sum::<f64>()).fold(0.0, f64::max)
            * (until * until * until)
            * 1e-24;
        tube
    }

    /// Returns the number of intervals into which a grid divides the time up to `until` (s): several within each period
    /// of the frequencies that matter.
    pub fn grid_count(&self, until: f64, in_each: f64) -> f64 {
        let (sizes, _) = &self.curvature;
        let parts = sizes.iter().zip(&self.poles).filter(|(size, pole)| **size > 0.0 && pole.frequency > 0.0);
        let (bent, swung) = parts.fold((0.0, 0.0), |(bent, swung), (size, pole)| {
            (bent + size, swung + size / (pole.frequency * pole.frequency))
        });
        let frequency = if swung > 0.0 { f64::sqrt(bent / swung) } else { 0.0 };
        (until * frequency * in_each).max(32.0).ceil()
    }

    fn phasors(&self, t: f64) -> Phasors {
        Phasors::new(&self.poles, t)
    }

    /// Returns the impulse response to an input, of the phasors; the step response alone if the input is constant.
    fn impulse(input: &InputResponse, t: f64, phasors: &Phasors) -> Impulse {
        let step = input.step.value(t, phasors);
        let step_rounding = input.step.rounding(t);
        if input.varying[1] == 0.0 {
            return Impulse { t, step, rounding: step_rounding, ..Impulse::default() };
        }
        Impulse {
            t,
            value: input.impulse.value(t, phasors),
            slope: input.slope.value(t, phasors),
            step,
            bend: phasors.decayed(&input.bends[0]),
            jerk: phasors.decayed(&input.bends[1]),
            rounding: input.impulse.rounding(t).max(step_rounding),
            slope_rounding: input.slope.rounding(t),
        }
    }

    /// Returns the impulse response to an input at a time (s).
    fn impulse_at(&self, input: usize, t: f64) -> Impulse {
        Self::impulse(&self.inputs[input], t, &self.phasors(t))
    }

    fn sign_changes<'a>(&self, impulse: &'a dyn Fn(f64) -> Impulse) -> SignChanges<'a> {
        SignChanges { impulse, narrowest: self.narrowest, small: self.small, roots: Vec::new() }
    }

    /// Returns the range at an instant, of the integrals there.
    fn instant(&self, t: f64, phasors: &Phasors, integrals: ExactIntegrals) -> TubeInstant<ExactIntegrals> {
        // Ends of the range, sum of all magnitudes, and error.
        let (mut ends, mut sizes, mut error) = ([0.0; 2], 0.0, 0.0);
        let mut add = |[low, high]: [f64; 2], inaccuracy: f64| {
            ends[0] += low;
            ends[1] += high;
            sizes += low.abs().max(high.abs());
            error += inaccuracy;
        };
        for (response, range) in &self.start {
            let value = Enclosure::exact(response.value(t, phasors));
            add(products(value, *range), response.rounding(t) * range.magnitude());
        }
        let mut gaps = 0.0;
        for (input, (impulse, variation)) in self.inputs.iter().zip(&integrals.0) {
            let inaccuracy = impulse.rounding * input.constant.magnitude();
            add(products(Enclosure::exact(impulse.step), input.constant), inaccuracy);
            let [mean, half] = input.varying;
            let (shift, reach) = (mean * impulse.step, half * variation.attained);
            let inaccuracy = impulse.rounding * (mean.abs() + half);
            add([shift - reach, shift + reach], inaccuracy);
            gaps += half * variation.gap;
        }
        let error = error + SUMMATION * sizes;
        let (parts, rigid) = &self.curvature;
        TubeInstant {
            t,
            bounds: [ends[0] - error - gaps, ends[1] + error + gaps],
            attained: [ends[0] + error, ends[1] - error],
            curvature: rigid + phasors.decayed(parts),
            state: integrals,
        }
    }

    /// Returns the instants before `end` (s) at which an input that varies has to change its side for the upper end of
    /// the range at `end`, and true if it begins on its upper side.
    pub fn switchings(&self, input: usize, end: f64, count: usize) -> (Vec<f64>, bool) {
        let evaluate = |t: f64| self.impulse_at(input, t);
        let mut changes = self.sign_changes(&evaluate);
        let mut before = evaluate(0.0);
        for index in 1..=count {
            let next = evaluate(end * (index as f64 / count as f64));
            changes.integral(&before, &next);
            before = next;
        }
        let times = changes.roots.iter().rev().map(|root| end - root).filter(|time| *time > 0.0);
        // What acts at the start has the response of the whole time.
        (times.collect(), before.value > 0.0)
    }

    /// Returns the sign of each response at a time (s), for the states and inputs that attain the ends of the range.
    pub fn signs(&self, body: &ModalForm, t: f64) -> (Vec<f64>, Vec<f64>) {
        let phasors = self.phasors(t);
        let states = 2 * body.pairs.len();
        let mut start = vec![0.0; states];
        for (index, pair) in body.pairs.iter().enumerate() {
            let part = PairResponses::new(pair, index, &self.poles);
            let [position, rate] = pair.states;
            start[position] = part.position.value(t, &phasors);
            start[rate] = part.rate.value(t, &phasors);
        }
        let steps = self.inputs.iter().map(|input| input.step.value(t, &phasors));
        (start, steps.collect())
    }
}

impl Tube for ExactTube {
    type State = ExactIntegrals;

    fn start(&self) -> TubeInstant<ExactIntegrals> {
        let phasors = self.phasors(0.0);
        let integrals =
            self.inputs.iter().map(|input| (Self::impulse(input, 0.0, &phasors), Variation::default()));
        self.instant(0.0, &phasors, ExactIntegrals(integrals.collect()))
    }

    fn later(&self, before: &TubeInstant<ExactIntegrals>, t: f64) -> TubeInstant<ExactIntegrals> {
        let phasors = self.phasors(t);
        let integrals = self.inputs.iter().enumerate().map(|(index, input)| {
            let impulse = Self::impulse(input, t, &phasors);
            let (from, mut variation) = before.state.0[index];
            if input.varying[1] > 0.0 {
                let evaluate = |t: f64| self.impulse_at(index, t);
                let part = self.sign_changes(&evaluate).integral(&from, &impulse);
                variation.attained += part.attained;
                variation.gap += part.gap;
            }
            (impulse, variation)
        });
        let integrals = ExactIntegrals(integrals.collect());
        self.instant(t, &phasors, integrals)
    }
}
