//! Waveforms: the exact response of a mode against fine quadrature of its definition.

use flexsc_core::dynamics::waveform::{Term, TermShape, Waveform};
use flexsc_core::numerics::phasor::Phasor;

/// The integral of exp(pole (to - t)) u(t), and of (to - t) u(t), by Gauss's rule of three nodes on many panels between
/// the breaks.
fn quadrature(waveform: &Waveform, pole: Phasor, from: f64, to: f64) -> (Phasor, f64) {
    let mut ends: Vec<f64> = waveform.breaks().into_iter().filter(|t| *t > from && *t < to).collect();
    ends.insert(0, from);
    ends.push(to);
    let (mut driven, mut travel) = (Phasor::default(), 0.0);
    for ends in ends.windows(2) {
        let panels = 20_000;
        let half = 0.5 * (ends[1] - ends[0]) / f64::from(panels);
        for i in 0..panels {
            let centre = ends[0] + half * f64::from(2 * i + 1);
            for (x, weight) in [(-(0.6_f64.sqrt()), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 9.0)]
            {
                let t = centre + half * x;
                let u = waveform.at(t) * weight * half;
                driven +=
                    flexsc_core::numerics::phasor::polar((pole.re * (to - t)).exp(), pole.im * (to - t)) * u;
                travel += (to - t) * u;
            }
        }
    }
    (driven, travel)
}

fn term(from: f64, to: f64, shape: TermShape) -> Waveform {
    Waveform { terms: vec![Term { from, to, shape }] }
}

fn harmonic(frequency: f64) -> Waveform {
    term(0.0, 12.0, TermShape::Harmonic { frequency, cosine: 0.7, sine: -1.3 })
}

/// The response of these poles over these intervals must be that of the definition.
#[track_caller]
fn check(name: &str, waveform: &Waveform, scale: f64) {
    let poles = [(0.0, 0.0), (0.0, 3.3), (-0.01, 0.4), (-0.7, 14.1), (0.0, 22.3), (-3.0, 1e-3)];
    for (re, im) in poles {
        let pole = Phasor::new(re, im);
        for (from, to) in [(0.0, 12.0), (0.0, 30.0), (1.37, 8.2), (-5.0, 0.01), (13.0, 14.0), (3.0, 3.0)] {
            let (driven, travel) = quadrature(waveform, pole, from, to);
            let gap = waveform.response(pole, from, to) - driven;
            assert!(gap.re.hypot(gap.im) < 1e-11 * scale, "{name}, pole {pole}, {from} to {to}: {gap:e}");
            let gap = (waveform.travel(from, to) - travel).abs();
            assert!(gap < 1e-11 * scale * to.abs().max(1.0), "{name}, travel {from} to {to}: {gap:e}");
            assert!(
                (waveform.impulse(from, to) - waveform.response(Phasor::default(), from, to).re).abs() == 0.0
            );
        }
    }
}

#[test]
fn harmonics_far_from_resonance_near_it_and_at_it() {
    for frequency in [0.0, 1e-9, 0.5, 3.3 - 1e-3, 3.3 - 1e-9, 3.3, 3.3 + 1e-12, 14.1, 60.0] {
        check(&format!("harmonic {frequency}"), &harmonic(frequency), 30.0);
    }
    // At resonance, after whole periods: (sin wt - wt cos wt)/(2 w²).
    let w = std::f64::consts::PI;
    let sine = term(0.0, 12.0, TermShape::Harmonic { frequency: w, cosine: 0.0, sine: 1.0 });
    let z = sine.response(Phasor::new(0.0, w), 0.0, 12.0);
    assert!((z.im / w + 12.0 / (2.0 * w)).abs() < 1e-13 && z.re.abs() < 1e-12, "{z}");
}

#[test]
fn polynomials_to_degree_11() {
    for degree in [0, 1, 2, 5, 11] {
        // (t/6 - 1)^degree, in powers of t.
        let mut c = vec![1.0];
        for _ in 0..degree {
            let mut next = vec![0.0; c.len() + 1];
            for (n, c) in c.iter().enumerate() {
                next[n] -= c;
                next[n + 1] += c / 6.0;
            }
            c = next;
        }
        // Their powers cancel by as many digits as the largest has.
        check(&format!("degree {degree}"), &term(0.0, 12.0, TermShape::Polynomial(c.clone())), 1e2);
        check(&format!("degree {degree}, later"), &term(2.5, 9.0, TermShape::Polynomial(c)), 1e2);
    }
}

#[test]
fn exponentials_with_polynomials() {
    for (re, im) in [(0.0, 3.3), (0.05, 3.3), (-0.2, 14.1), (0.1, 0.0)] {
        for coefficients in
            [vec![Phasor::new(0.4, -1.0)], vec![Phasor::new(1.0, 0.2), Phasor::new(-0.1, 0.05)]]
        {
            let shape = TermShape::Exponential { pole: Phasor::new(re, im), coefficients };
            check(&format!("exponential {re} {im}"), &term(0.5, 11.0, shape), 1e2);
        }
    }
}

#[test]
fn sums_shifts_and_breaks() {
    let mut waveform = harmonic(2.0);
    waveform.terms.extend(term(3.0, 5.0, TermShape::Polynomial(vec![1.0, -0.5])).terms);
    check("sum", &waveform, 30.0);
    assert_eq!(waveform.breaks(), [0.0, 3.0, 5.0, 12.0]);
    let later = waveform.shifted(1.5, -2.0);
    assert_eq!(later.end(), 13.5);
    check("shifted", &later, 60.0);
    let pole = Phasor::new(-0.1, 3.3);
    let gap = later.response(pole, 1.5, 13.5) + waveform.response(pole, 0.0, 12.0) * 2.0;
    assert!(gap.re.hypot(gap.im) < 1e-13);
    // Right-continuous, and a limit from either side.
    assert_eq!(waveform.at(12.0), 0.0);
    assert_eq!(waveform.at(3.0) - harmonic(2.0).at(3.0), 1.0);
    assert_eq!(waveform.value_on_piece(1.0, 3.0), harmonic(2.0).at(3.0));
}
