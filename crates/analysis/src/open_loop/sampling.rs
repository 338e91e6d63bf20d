//! Exact sampling of a linear system whose inputs are held over a period and act late (\[FranklinPowell98\]).

use std::cell::RefCell;
use std::collections::HashMap;

use flexsc_numerics::exponential::exponential;
use nalgebra::DMatrix;
use nalgebra::linalg::balancing::balance_parlett_reinsch;

use crate::linear_model::Signal;

/// Delay as whole periods and the rest.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Lateness {
    /// Whole periods of the delay.
    pub whole: usize,
    /// Rest of the delay (s), less than a period.
    pub rest: f64,
}

impl Lateness {
    /// Divides a delay (s) by a period (s).
    pub fn new(period: f64, delay: f64) -> Self {
        // A delay of whole periods remains one in spite of rounding.
        let whole = libm::floor(delay / period + 1e-9);
        let rest = (delay - whole * period).max(0.0);
        Self { whole: whole as usize, rest: if rest > 1e-9 * period { rest } else { 0.0 } }
    }

    /// Returns the part of a period in which the inputs of each sample act: pairs of the age of the input, in samples,
    /// and its part.
    pub fn shares(self, period: f64) -> [(usize, f64); 2] {
        let rest = self.rest / period;
        [(self.whole, 1.0 - rest), (self.whole + 1, rest)]
    }
}

/// System `x[k+1] = a x[k] + b u[k]`, whose last states are the inputs of earlier samples, the latest first.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledSystem {
    /// State matrix.
    pub a: DMatrix<f64>,
    /// Input matrix.
    pub b: DMatrix<f64>,
    /// Number of earlier samples whose inputs are states.
    pub waiting: usize,
}

impl SampledSystem {
    /// Samples x' = a x + b u with samples `period` (s) apart and inputs that act `delay` (s) late.
    pub fn new(a: &DMatrix<f64>, b: &DMatrix<f64>, period: f64, delay: f64) -> Self {
        let (order, count) = b.shape();
        let Lateness { whole, rest } = Lateness::new(period, delay);
        let (flow, now) = held(a, b, period);
        let forced = if rest > 0.0 {
            let (after, new) = held(a, b, period - rest);
            vec![new, after * held(a, b, rest).1]
        } else {
            vec![now]
        };
        let waiting = whole + forced.len() - 1;
        let size = order + count * waiting;
        let (mut big, mut into) = (DMatrix::zeros(size, size), DMatrix::zeros(size, count));
        big.view_mut((0, 0), (order, order)).copy_from(&flow);
        for (k, columns) in forced.iter().enumerate() {
            match whole + k {
                0 => into.view_mut((0, 0), (order, count)).copy_from(columns),
                back => big.view_mut((0, order + count * (back - 1)), (order, count)).copy_from(columns),
            }
        }
        for k in 0..waiting {
            let row = order + count * k;
            for column in 0..count {
                if k == 0 {
                    into[(row + column, column)] = 1.0;
                } else {
                    big[(row + column, row - count + column)] = 1.0;
                }
            }
        }
        Self { a: big, b: into, waiting }
    }

    /// Returns the states that are inputs of earlier samples, the latest first.
    pub fn waiting_inputs(&self, inputs: &[Signal]) -> Vec<Signal> {
        let earlier = |input: &Signal, age| Signal {
            name: format!("{}_{age}_ago", input.name),
            unit: input.unit.clone(),
        };
        (1..=self.waiting).flat_map(|age| inputs.iter().map(move |input| earlier(input, age))).collect()
    }
}

/// Transition of a state over a time, and the response to inputs that are held.
pub type HeldMotion = (DMatrix<f64>, DMatrix<f64>);

/// Largest number of numbers of the motions that a thread keeps.
const MOST_KEPT: usize = 1_000_000;

thread_local! {
    /// Latest motions, by the bits of the system and the time. A tuning forms the loop of one body with many laws.
    static KEPT: RefCell<HashMap<Vec<u64>, HeldMotion>> = RefCell::default();
}

/// Returns the motion over a time (s): the transition of the state, and the response to inputs that are held.
///
/// The system is balanced first, by powers of 2: an exponential loses the digits by which its norm exceeds the
/// frequencies.
pub fn held(a: &DMatrix<f64>, b: &DMatrix<f64>, time: f64) -> HeldMotion {
    let sizes = [a.nrows() as u64, b.ncols() as u64, time.to_bits()];
    let key: Vec<u64> = sizes.into_iter().chain(a.iter().chain(b).map(|entry| entry.to_bits())).collect();
    KEPT.with_borrow_mut(|kept| {
        if kept.len() * key.len() >= MOST_KEPT {
            kept.clear();
        }
        kept.entry(key).or_insert_with(|| motion_over(a, b, time)).clone()
    })
}

/// Computes the motion over a time (s).
fn motion_over(a: &DMatrix<f64>, b: &DMatrix<f64>, time: f64) -> HeldMotion {
    let (order, count) = b.shape();
    let mut balanced = a * time;
    let units = balance_parlett_reinsch(&mut balanced);
    let mut forced = DMatrix::from_fn(order, count, |row, column| b[(row, column)] * time / units[row]);
    let size = forced.amax();
    let scale = if size > 0.0 && size.is_finite() { libm::exp2(libm::floor(libm::log2(size))) } else { 1.0 };
    forced /= scale;
    let mut whole = DMatrix::zeros(order + count, order + count);
    whole.view_mut((0, 0), (order, order)).copy_from(&balanced);
    whole.view_mut((0, order), (order, count)).copy_from(&forced);
    let whole = exponential(&whole);
    let flow =
        DMatrix::from_fn(order, order, |row, column| whole[(row, column)] * units[row] / units[column]);
    let forced =
        DMatrix::from_fn(order, count, |row, column| whole[(row, order + column)] * units[row] * scale);
    (flow, forced)
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    /// A double integrator under torques that act 1.25 periods late: the closed form of each term.
    #[test]
    fn a_late_double_integrator() {
        let (a, b) = (dmatrix![0.0, 1.0; 0.0, 0.0], dmatrix![0.0; 1.0]);
        let (h, rest) = (2.0, 0.5);
        let sampled = SampledSystem::new(&a, &b, h, 2.5);
        let (new, old) = (h - rest, rest);
        let expected = dmatrix![
            1.0, h, new * new / 2.0, old * new + old * old / 2.0;
            0.0, 1.0, new, old;
            0.0, 0.0, 0.0, 0.0;
            0.0, 0.0, 1.0, 0.0
        ];
        assert_eq!(sampled.waiting, 2);
        assert!((&sampled.a - expected).amax() < 1e-15, "{}", sampled.a);
        assert_eq!(sampled.b, dmatrix![0.0; 0.0; 1.0; 0.0]);
    }

    #[test]
    fn a_delay_of_whole_periods_in_spite_of_rounding() {
        assert_eq!(Lateness::new(0.1, 0.1 + 0.2), Lateness { whole: 3, rest: 0.0 });
        let late = Lateness::new(0.3, 0.12);
        assert_eq!((late.whole, late.rest), (0, 0.12));
        let [(now, most), (before, less)] = late.shares(0.3);
        assert_eq!((now, before), (0, 1));
        assert!((most - 0.6).abs() < 1e-15 && (less - 0.4).abs() < 1e-15);
    }
}
