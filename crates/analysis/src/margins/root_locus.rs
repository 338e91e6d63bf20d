//! Root locus: poles of the closed loop as the gain of all its loops changes.

use std::f64::consts::PI;

use nalgebra::Complex;
use rayon::prelude::*;

use super::frequency_response::modulus;
use crate::eigenvalues::eigenvalues;
use crate::open_loop::{OpenLoop, TransferMatrices};

/// Magnitude below which a pole is a state of one sample, without a frequency.
const SHORT: f64 = 1e-12;

/// Poles of the closed loop at a gain.
#[derive(Clone, Debug, PartialEq)]
pub struct GainPoles {
    /// Factor on the gain of all loops.
    pub factor: f64,
    /// Poles ln(z)/T of continuous time (rad/s), without the lower ones of pairs.
    pub poles: Vec<Complex<f64>>,
}

/// Returns the poles of the closed loop with these factors on the gain of all loops; a factor for which there are none is
/// left out.
pub fn root_locus(opened: &OpenLoop, factors: &[f64]) -> Vec<GainPoles> {
    let TransferMatrices { a, b, c, d } = &opened.transfer;
    let at = |factor: &f64| {
        let loops = TransferMatrices { a: a.clone(), b: b.clone(), c: c * *factor, d: d * *factor };
        let closed = eigenvalues(&loops.sensitivity()?.a)?;
        let continuous = |pole: &Complex<f64>| {
            let log = Complex::new(libm::log(modulus(*pole)), libm::atan2(pole.im, pole.re));
            log / opened.period
        };
        let shown = closed.iter().filter(|pole| modulus(**pole) > SHORT && pole.im >= 0.0);
        // A negative real pole has no pole of its own in continuous time: its frequency is half that of the samples.
        let poles = shown.map(continuous).filter(|pole| pole.im <= PI / opened.period).collect();
        Some(GainPoles { factor: *factor, poles })
    };
    let all: Vec<Option<GainPoles>> = factors.par_iter().map(at).collect();
    all.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;
    use crate::linear_model::Signal;
    use crate::open_loop::LoopBreak;

    /// An integrator with a gain g of the sample of 0.5 s: z = 1 - k g.
    #[test]
    fn the_pole_of_an_integrator() {
        let signal = |name: &str| Signal { name: name.to_owned(), unit: String::new() };
        let opened = OpenLoop {
            opened: LoopBreak::Command,
            period: 0.5,
            samples: 1,
            states: vec![signal("angle")],
            signals: vec![signal("command")],
            transfer: TransferMatrices {
                a: dmatrix![1.0],
                b: dmatrix![0.2],
                c: dmatrix![1.0],
                d: dmatrix![0.0],
            },
        };
        let found = root_locus(&opened, &[0.0, 1.0, 4.0]);
        let poles: Vec<Complex<f64>> = found.iter().map(|at| at.poles[0]).collect();
        for (pole, expected) in poles.iter().zip([0.0, libm::log(0.8) / 0.5, libm::log(0.2) / 0.5]) {
            assert!((pole.re - expected).abs() < 1e-14 && pole.im == 0.0, "{pole}");
        }
    }
}
