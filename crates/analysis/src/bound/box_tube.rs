//! Range of an output over boxes of natural frequencies and damping ratios, besides those of states and inputs.
//!
//! Each mode has its own enclosure of the phase and the decay, so that its responses are enclosed, and their sums
//! enclose those of every body of the box. With a = asin zeta, D = exp(-zeta w t) and p = w cos(a) t, a position 1 moves as
//! D cos(p - a)/cos a, a rate 1 as D sin p/(w cos a).

use flexsc_numerics::enclosure::Enclosure;

use super::modal_form::{ModalForm, StatePair};
use super::reach::{Tube, TubeInstant};
use super::response::SUMMATION;
use super::sets::{InputSets, middle, products};

/// Range of an output over all bodies of a box.
pub struct BoxTube<'a> {
    sets: &'a InputSets,
    pairs: Vec<BoxPair<'a>>,
}

/// Pair of states of all bodies of a box.
struct BoxPair<'a> {
    pair: &'a StatePair,
    frequency: Enclosure,
    /// Damping ratio times the natural frequency (1/s).
    decay: Enclosure,
    /// Arc sine of the damping ratio, and its cosine.
    angle: Enclosure,
    cosine: Enclosure,
    /// Bound of the second derivative of its part of the range, without the decay.
    curvature: f64,
}

/// Responses of the output to the position, to the rate and to a step, at one time.
struct Enclosures {
    position: Enclosure,
    rate: Enclosure,
    step: Enclosure,
}

/// Largest magnitude of the impulse response to each input, its integral, and the bound of its second derivative.
#[derive(Clone, Debug)]
pub struct BoxIntegrals(Vec<[f64; 3]>);

impl<'a> BoxTube<'a> {
    /// Creates the range for boxes of the given relative half-widths about a body.
    pub fn new(body: &'a ModalForm, sets: &'a InputSets, frequency_error: f64, damping_error: f64) -> Self {
        let around = |value: f64, part: f64| {
            Enclosure::exact(value) * Enclosure::new(1.0 - part, 1.0 + part).widened()
        };
        let one = Enclosure::exact(1.0);
        let pair = |pair: &'a StatePair| {
            let (frequency, damping) =
                (around(pair.frequency, frequency_error), around(pair.damping, damping_error));
            let damping = Enclosure::new(damping.low.max(0.0), damping.high);
            let mut all = BoxPair {
                pair,
                frequency,
                decay: frequency * damping,
                angle: damping.asin(),
                cosine: (one - damping * damping).sqrt(),
                curvature: 0.0,
            };
            all.curvature = all.curvature(sets);
            all
        };
        Self { sets, pairs: body.pairs.iter().map(pair).collect() }
    }

    /// Returns the enclosure of the responses of an output to an input.
    fn to_input(
        &self,
        responses: &[Enclosures],
        input: usize,
        of: fn(&Enclosures) -> Enclosure,
    ) -> Enclosure {
        let parts = self.pairs.iter().zip(responses);
        parts.fold(Enclosure::default(), |sum, (pair, responses)| {
            let weight = pair.pair.inputs[input];
            if weight == 0.0 { sum } else { sum + of(responses) * Enclosure::exact(weight) }
        })
    }

    fn instant(&self, t: f64, before: Option<&TubeInstant<BoxIntegrals>>) -> TubeInstant<BoxIntegrals> {
        let responses: Vec<Enclosures> = self.pairs.iter().map(|pair| pair.responses(t)).collect();
        let (mut sum, mut sizes) = (Enclosure::default(), 0.0);
        let mut add = |[low, high]: [f64; 2]| {
            sum = sum + Enclosure::new(low, high);
            sizes += low.abs().max(high.abs());
        };
        for (pair, responses) in self.pairs.iter().zip(&responses) {
            for (state, response) in pair.pair.states.into_iter().zip([responses.position, responses.rate]) {
                add(products(response, self.sets.start[state]));
            }
        }
        let mut integrals = Vec::new();
        for input in 0..self.sets.varying.len() {
            let step = self.to_input(&responses, input, |of| of.step);
            add(products(step, self.sets.constant[input]));
            let [mean, half] = middle(self.sets.varying[input]);
            add(products(step, Enclosure::exact(mean)));
            let mut integral = [0.0; 3];
            if half > 0.0 {
                integral = self.integral(&responses, input, t, before);
                add([-half * integral[1], half * integral[1]]);
            }
            integrals.push(integral);
        }
        let size = SUMMATION * sizes;
        let curvature = self.pairs.iter().map(|pair| pair.curvature * pair.decayed(t)).sum::<f64>();
        TubeInstant {
            t,
            bounds: [sum.low - size, sum.high + size],
            // No body of the box is known to attain them.
            attained: [f64::INFINITY, f64::NEG_INFINITY],
            curvature: curvature * (1.0 + SUMMATION),
            state: BoxIntegrals(integrals),
        }
    }

    /// Returns the largest magnitude of an impulse response, the bound of its integral, and of its second derivative.
    fn integral(
        &self,
        responses: &[Enclosures],
        input: usize,
        t: f64,
        before: Option<&TubeInstant<BoxIntegrals>>,
    ) -> [f64; 3] {
        let magnitude = self.to_input(responses, input, |of| of.rate).magnitude();
        let bends = self.pairs.iter().map(|pair| pair.bend(input) * pair.decayed(t));
        let bend = bends.sum::<f64>() * (1.0 + SUMMATION);
        let Some(before) = before else { return [magnitude, 0.0, bend] };
        let (width, [from, sum, bent]) = (t - before.t, before.state.0[input]);
        // The magnitude lies below its chord plus h²/8 times the second derivative.
        let part = 0.5 * width * (from + magnitude) + width * width * width / 12.0 * bent;
        [magnitude, (sum + part) * (1.0 + SUMMATION), bend]
    }
}

impl BoxPair<'_> {
    /// Returns the largest decay at a time (s).
    fn decayed(&self, t: f64) -> f64 {
        if self.pair.is_elastic() {
            (Enclosure::exact(-self.decay.low) * Enclosure::exact(t)).exp().high
        } else {
            1.0
        }
    }

    /// Returns the bound of the magnitude of a derivative of the response to a rate, without the decay.
    fn rate_bound(&self, degree: i32) -> f64 {
        let [by_position, by_rate] = self.pair.weights.map(f64::abs);
        let w = self.frequency.high;
        let power = (1..degree).fold(1.0, |power, _| power * w);
        (by_position * power + by_rate * (power * w)) / self.cosine.low
    }

    /// Returns the bound of the second derivative of the impulse response to an input, without the decay.
    fn bend(&self, input: usize) -> f64 {
        if self.pair.is_elastic() { self.pair.inputs[input].abs() * self.rate_bound(2) } else { 0.0 }
    }

    /// Returns the bound of the second derivative of its part of the range, without the decay.
    fn curvature(&self, sets: &InputSets) -> f64 {
        let [position, rate] = self.pair.states.map(|state| sets.start[state].magnitude());
        let inputs = self.pair.inputs.iter().enumerate();
        let pushes = inputs.map(|(input, weight)| {
            let [mean, half] = middle(sets.varying[input]);
            weight.abs() * (sets.constant[input].magnitude() + mean.abs() + half)
        });
        let push = pushes.sum::<f64>();
        if !self.pair.is_elastic() {
            return push * self.pair.weights[0].abs();
        }
        let [by_position, by_rate] = self.pair.weights.map(f64::abs);
        let w = self.frequency.high;
        let moved = (by_position * (w * w) + by_rate * (w * w * w)) / self.cosine.low;
        (position * moved + rate * self.rate_bound(2) + push * self.rate_bound(1)) * (1.0 + SUMMATION)
    }

    /// Returns the responses at a time (s).
    fn responses(&self, t: f64) -> Enclosures {
        let [by_position, by_rate] = self.pair.weights.map(Enclosure::exact);
        let t = Enclosure::exact(t);
        if !self.pair.is_elastic() {
            let half = Enclosure::exact(0.5);
            return Enclosures {
                position: by_position,
                rate: by_rate + by_position * t,
                step: by_rate * t + by_position * half * t * t,
            };
        }
        let w = self.frequency;
        let phase = w * self.cosine * t;
        let decay = (-(self.decay * t)).exp();
        let over = |value: Enclosure| (decay * value).over_positive(self.cosine);
        let moved = over((phase - self.angle).cos());
        let sine = over(phase.sin());
        let turned = over((phase + self.angle).cos());
        let pushed = sine.over_positive(w);
        let rest = (Enclosure::exact(1.0) - moved).over_positive(w).over_positive(w);
        Enclosures {
            position: by_position * moved - by_rate * w * sine,
            rate: by_position * pushed + by_rate * turned,
            step: by_position * rest + by_rate * pushed,
        }
    }
}

impl Tube for BoxTube<'_> {
    type State = BoxIntegrals;

    fn start(&self) -> TubeInstant<BoxIntegrals> {
        self.instant(0.0, None)
    }

    fn later(&self, before: &TubeInstant<BoxIntegrals>, t: f64) -> TubeInstant<BoxIntegrals> {
        self.instant(t, Some(before))
    }
}
