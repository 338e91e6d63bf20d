//! Residual F v - lambda v in twice the digits of a double, to polish poles.

use flexsc_numerics::phasor::Phasor;
use nalgebra::{DMatrix, DVector, DVectorView};

/// Sum of products as a double and its rounding error.
#[derive(Copy, Clone, Default)]
struct Sum {
    high: f64,
    low: f64,
}

impl Sum {
    fn add(&mut self, a: f64, b: f64) {
        let product = a * b;
        let (a, b) = (halves(a), halves(b));
        let rest = ((a[0] * b[0] - product) + a[0] * b[1] + a[1] * b[0]) + a[1] * b[1];
        let sum = self.high + product;
        let part = sum - self.high;
        self.low += (self.high - (sum - part)) + (product - part) + rest;
        self.high = sum;
    }

    fn value(self) -> f64 {
        self.high + self.low
    }
}

/// Splits a number into two of half its digits, whose products are exact.
fn halves(a: f64) -> [f64; 2] {
    let scaled = 134_217_729.0 * a; // 2^27 + 1
    let high = scaled - (scaled - a);
    [high, a - high]
}

/// Computes F v - lambda v.
pub fn residual(f: &DMatrix<f64>, v: DVectorView<Phasor>, lambda: Phasor) -> DVector<Phasor> {
    DVector::from_fn(f.nrows(), |i, _| {
        let (mut re, mut im) = (Sum::default(), Sum::default());
        for (f, v) in f.row(i).iter().zip(v.iter()) {
            re.add(*f, v.re);
            im.add(*f, v.im);
        }
        re.add(-lambda.re, v[i].re);
        re.add(lambda.im, v[i].im);
        im.add(-lambda.re, v[i].im);
        im.add(-lambda.im, v[i].re);
        Phasor { re: re.value(), im: im.value() }
    })
}
