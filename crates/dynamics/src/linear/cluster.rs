//! Nearly coalescing poles in one block: e^(T h) r and its integrals for a triangular T.
//!
//! For two poles a closed form is used, exact for every distance, 0 included; for more, a matrix exponential.

use flexsc_numerics::phasor::{Phasor, abs};
use nalgebra::{DMatrix, DVector};

use super::phi::exponential;

/// Values of e^(T h) r, h phi_1(T h) r and h² phi_2(T h) r.
#[derive(Clone, Debug)]
pub struct ClusterFunctions {
    pub exp: DVector<Phasor>,
    pub first: DVector<Phasor>,
    pub second: DVector<Phasor>,
}

/// Computes the functions of a triangular matrix applied to a vector at the time `h` (s).
pub fn moved(t: &DMatrix<Phasor>, r: &DVector<Phasor>, h: f64) -> ClusterFunctions {
    let diagonal = t.diagonal();
    let sizes = diagonal.iter().map(|z| abs(*z) * h);
    let (least, most) = sizes.fold((f64::INFINITY, 0.0), |(a, b), z| (f64::min(a, z), f64::max(b, z)));
    if most < 1.0 {
        series(t, r, h)
    } else if t.nrows() == 2 && least >= 1.0 {
        two(t, r, h)
    } else {
        augmented(t, r, h)
    }
}

fn series(t: &DMatrix<Phasor>, r: &DVector<Phasor>, h: f64) -> ClusterFunctions {
    let step = t * Phasor { re: h, im: 0.0 };
    let mut second = r.clone();
    for n in (3..40).rev() {
        second = r + &step * second / Phasor { re: f64::from(n), im: 0.0 };
    }
    second *= Phasor { re: 0.5, im: 0.0 };
    let first = r + &step * &second;
    let exp = r + &step * &first;
    let times = |v: DVector<Phasor>, h: f64| v * Phasor { re: h, im: 0.0 };
    ClusterFunctions { exp, first: times(first, h), second: times(second, h * h) }
}

/// Computes the functions for two poles: with m = (l1 + l2)/2 and d = (l1 - l2)/2 the off-diagonal element of the
/// exponential is s h e^(m h) sinh(d h)/(d h).
fn two(t: &DMatrix<Phasor>, r: &DVector<Phasor>, h: f64) -> ClusterFunctions {
    let (l1, l2, s) = (t[(0, 0)], t[(1, 1)], t[(0, 1)]);
    let (e1, e2) = (exponential(l1 * h), exponential(l2 * h));
    let z = (l1 - l2) * (0.5 * h);
    let cross = if abs(z) < 0.5 {
        let square = z * z;
        let mut sum = Phasor { re: 1.0, im: 0.0 };
        for n in (1..10).rev() {
            sum = square * sum / f64::from(2 * n * (2 * n + 1)) + 1.0;
        }
        s * h * exponential((l1 + l2) * (0.5 * h)) * sum
    } else {
        s * (e1 - e2) / (l1 - l2)
    };
    let exp = DVector::from_vec(vec![e1 * r[0] + cross * r[1], e2 * r[1]]);
    let divided = |v: DVector<Phasor>| {
        let lower = v[1] / l2;
        DVector::from_vec(vec![(v[0] - s * lower) / l1, lower])
    };
    let first = divided(&exp - r);
    let second = divided(&first - r * Phasor { re: h, im: 0.0 });
    ClusterFunctions { exp, first, second }
}

/// Computes the functions by the exponential of T h bordered with r, whose last columns are the integrals.
fn augmented(t: &DMatrix<Phasor>, r: &DVector<Phasor>, h: f64) -> ClusterFunctions {
    let count = t.nrows();
    let size = f64::sqrt(r.iter().map(Phasor::norm_sqr).sum());
    let unit = |re: f64| Phasor { re, im: 0.0 };
    let scale = if size > 0.0 { size } else { 1.0 };
    let mut whole = DMatrix::zeros(count + 2, count + 2);
    whole.view_mut((0, 0), (count, count)).copy_from(&(t * unit(h)));
    whole.view_mut((0, count), (count, 1)).copy_from(&(r / unit(scale)));
    whole[(count, count + 1)] = unit(1.0);
    let whole = triangular_exponential(&whole);
    let exp = whole.view((0, 0), (count, count)) * r;
    let column = |j: usize, factor: f64| whole.view((0, j), (count, 1)).column(0) * unit(factor);
    ClusterFunctions { exp, first: column(count, scale * h), second: column(count + 1, scale * h * h) }
}

/// Returns exp(M) of an upper triangular matrix, by scaling, Taylor's series and squaring.
fn triangular_exponential(matrix: &DMatrix<Phasor>) -> DMatrix<Phasor> {
    let order = matrix.nrows();
    let norm = matrix.row_iter().map(|row| row.iter().map(|m| abs(*m)).sum::<f64>()).fold(0.0, f64::max);
    let (mut squarings, mut scale) = (0, 1.0);
    // Non-finite matrices need no scaling.
    while norm * scale > 0.5 && squarings < 60 {
        squarings += 1;
        scale *= 0.5;
    }
    let small = matrix * Phasor { re: scale, im: 0.0 };
    let mut sum = DMatrix::identity(order, order);
    for n in (1..=18).rev() {
        sum = DMatrix::identity(order, order) + &small * sum / Phasor { re: f64::from(n), im: 0.0 };
    }
    for _ in 0..squarings {
        sum = &sum * &sum;
    }
    sum
}
