//! Functions of time that are a polynomial and damped sines: the responses of an output to states and inputs.

use nalgebra::Complex;

use super::modal_form::StatePair;

/// Unit roundoff of a double.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Pole -zeta w + i w sqrt(1 - zeta²) of a mode; 0 of a rigid motion.
#[derive(Copy, Clone, Debug)]
pub struct ModePole {
    /// Natural frequency w (rad/s).
    pub frequency: f64,
    /// Pole (1/s).
    pub value: Complex<f64>,
}

impl ModePole {
    /// Returns the pole of a pair.
    pub fn new(pair: &StatePair) -> Self {
        let (w, zeta) = (pair.frequency, pair.damping);
        let value = Complex::new(-zeta * w, w * ((1.0 - zeta) * (1.0 + zeta)).sqrt());
        Self { frequency: w, value }
    }
}

/// Values of exp(s t) of all poles at one time.
pub struct Phasors {
    /// Values.
    pub values: Vec<Complex<f64>>,
    /// Magnitudes.
    pub decays: Vec<f64>,
}

impl Phasors {
    /// Returns the values at a time (s).
    pub fn new(poles: &[ModePole], t: f64) -> Self {
        let decays: Vec<f64> = poles.iter().map(|pole| libm::exp(pole.value.re * t)).collect();
        let value = |(pole, decay): (&ModePole, &f64)| {
            let (sin, cos) = libm::sincos(pole.value.im * t);
            Complex::new(decay * cos, decay * sin)
        };
        Self { values: poles.iter().zip(&decays).map(value).collect(), decays }
    }

    /// Returns a bound of the sum of sizes, each times the decay of its pole.
    pub fn decayed(&self, sizes: &[f64]) -> f64 {
        let sum: f64 = sizes.iter().zip(&self.decays).map(|(size, decay)| size * decay).sum();
        sum * (1.0 + SUMMATION)
    }
}

/// Part of a sum that bounds the rounding of its terms: far more than sums here have terms.
pub const SUMMATION: f64 = 1e-12;

/// Function of time: polynomial plus the real part of a sum of r exp(s t).
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// Coefficients of 1, t and t².
    polynomial: [f64; 3],
    /// Poles, by their indices, and their amplitudes r.
    terms: Vec<(usize, Complex<f64>)>,
    /// Bound of the rounding error of a value: this, and this per second.
    rounding: [f64; 2],
}

impl Response {
    /// Creates a function of its polynomial and its amplitudes at poles.
    ///
    /// Each amplitude is known to 16 roundings; the phase w t, the exponent and the functions of libm add 8 w t + 8, the
    /// sum of n terms n. The bound has all of them twice.
    pub fn new(polynomial: [f64; 3], terms: Vec<(usize, Complex<f64>)>, poles: &[ModePole]) -> Self {
        let count = terms.len() as f64;
        let mut rounding = [0.0; 2];
        for (pole, amplitude) in &terms {
            let size = 2.0 * ROUNDOFF * (amplitude.re.abs() + amplitude.im.abs());
            rounding[0] += size * (28.0 + count);
            rounding[1] += size * 8.0 * poles[*pole].frequency;
        }
        rounding[0] += 16.0 * ROUNDOFF * (count + 4.0) * polynomial[0].abs();
        Self { polynomial, terms, rounding }
    }

    /// Returns the value at a time (s), of the phasors of all poles there.
    pub fn value(&self, t: f64, phasors: &Phasors) -> f64 {
        let [constant, slope, square] = self.polynomial;
        let elastic: f64 = self
            .terms
            .iter()
            .map(|(pole, amplitude)| {
                let phasor = phasors.values[*pole];
                amplitude.re * phasor.re - amplitude.im * phasor.im
            })
            .sum();
        constant + t * (slope + t * square) + elastic
    }

    /// Returns a bound of the rounding error of values up to a time (s).
    pub fn rounding(&self, t: f64) -> f64 {
        let [_, slope, square] = self.polynomial;
        let rigid = 16.0 * ROUNDOFF * t * (slope.abs() + t * square.abs());
        self.rounding[0] + self.rounding[1] * t + rigid
    }

    /// Returns the derivative of the function.
    pub fn derivative(&self, poles: &[ModePole]) -> Self {
        let [_, slope, square] = self.polynomial;
        let terms = self.terms.iter().map(|(pole, amplitude)| (*pole, amplitude * poles[*pole].value));
        Self::new([slope, 2.0 * square, 0.0], terms.collect(), poles)
    }

    /// Adds, for each pole, a factor times the largest magnitude of its part of the derivative of a degree, to `sizes`,
    /// and returns that of the polynomial, if it is constant.
    pub fn add_derivative(&self, degree: i32, factor: f64, poles: &[ModePole], sizes: &mut [f64]) -> f64 {
        for (pole, amplitude) in &self.terms {
            let power = (0..degree).fold(1.0, |power, _| power * poles[*pole].frequency);
            sizes[*pole] += factor * power * libm::hypot(amplitude.re, amplitude.im);
        }
        factor
            * match degree {
                1 => self.polynomial[1].abs(),
                2 => 2.0 * self.polynomial[2].abs(),
                _ => 0.0,
            }
    }
}

/// Responses of the part of an output that a pair of states has.
pub struct PairResponses {
    /// Response to the initial position.
    pub position: Response,
    /// Response to the initial rate, which is that to an impulse.
    pub rate: Response,
    /// Response to a step.
    pub step: Response,
}

impl PairResponses {
    /// Returns the responses of a pair of index `index`: with D = exp(-zeta w t), n = w sqrt(1 - zeta²) and s = -zeta w + i
    /// n, a position 1 moves as Re((1 - i zeta w/n) exp(s t)), a rate 1 as Re(-i exp(s t)/n).
    pub fn new(pair: &StatePair, index: usize, poles: &[ModePole]) -> Self {
        let [by_position, by_rate] = pair.weights;
        if !pair.is_elastic() {
            return Self {
                position: Response::new([by_position, 0.0, 0.0], Vec::new(), poles),
                rate: Response::new([by_rate, by_position, 0.0], Vec::new(), poles),
                step: Response::new([0.0, by_rate, 0.5 * by_position], Vec::new(), poles),
            };
        }
        let pole = poles[index];
        let (s, w) = (pole.value, pole.frequency);
        let pushed = Complex::new(0.0, -1.0 / s.im);
        let moved = Complex::new(1.0, s.re / s.im);
        let impulse = pushed * by_position + s * pushed * by_rate;
        let position = moved * by_position - pushed * (w * w * by_rate);
        // The integral of the impulse response from 0.
        let constant = by_position / (w * w);
        let step = pushed * by_rate - moved * constant;
        let own = |amplitude| Response::new([0.0; 3], vec![(index, amplitude)], poles);
        Self {
            position: own(position),
            rate: own(impulse),
            step: Response::new([constant, 0.0, 0.0], vec![(index, step)], poles),
        }
    }
}

/// Returns the sum of functions with weights.
pub fn weighted_sum<'a>(parts: impl Iterator<Item = (f64, &'a Response)>, poles: &[ModePole]) -> Response {
    let (mut polynomial, mut terms) = ([0.0; 3], Vec::new());
    for (weight, part) in parts.filter(|(weight, _)| *weight != 0.0) {
        for (sum, coefficient) in polynomial.iter_mut().zip(part.polynomial) {
            *sum += weight * coefficient;
        }
        terms.extend(part.terms.iter().map(|(pole, amplitude)| (*pole, amplitude * weight)));
    }
    Response::new(polynomial, terms, poles)
}
