//! Eigendecomposition of one plant configuration: poles, residues and output weights. Computed once.

use flexsc_numerics::phasor::{Phasor, abs};
use nalgebra::{DMatrix, DVector};

use super::phi::Pole;
use super::poles::{PoleBlock, blocks};
use super::split_form::SplitPlant;

/// Limit on the time for which bounds of growing poles are valid (s).
const LONGEST: f64 = 1e6;

/// Linear plant as poles and clusters, ready to compute motions.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearFlow {
    form: SplitPlant,
    pub(super) poles: Vec<SimplePole>,
    pub(super) clusters: Vec<Cluster>,
    /// Matrix C_t of the outputs.
    pub(super) rigid: DMatrix<f64>,
    /// Pairs of poles near enough to beat, with their distance (1/s) and the time (s) for which they are bounded
    /// together.
    pub(super) beats: Vec<(usize, usize, f64, f64)>,
    /// Time for which the bounds of growing poles are valid (s).
    pub(super) window: f64,
}

/// Isolated pole.
#[derive(Clone, Debug, PartialEq)]
pub struct SimplePole {
    pub pole: Pole,
    /// Weight: 2 for a conjugate pair, else 1.
    pub weight: f64,
    /// Factor by which it can grow within the flow's window.
    pub growth: f64,
    /// Modal rate per unit of each input.
    pub push: Vec<Phasor>,
    /// Rate of each cyclic coordinate per unit of w.
    pub carry: Vec<Phasor>,
    /// Contribution to each output.
    pub outputs: Vec<PoleOutput>,
    /// Left eigenvector, which gives w from the coordinates of the form.
    left: DVector<Phasor>,
    right: DVector<Phasor>,
}

/// Contribution of a pole to an output: y per unit of w, y' per unit of w, and y'' per unit of w'.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PoleOutput {
    pub angle: Phasor,
    pub rate: Phasor,
    pub residue: Phasor,
}

/// Cluster of poles that are kept together.
#[derive(Clone, Debug, PartialEq)]
pub struct Cluster {
    pub block: PoleBlock,
    /// Time for which its bounds are valid (s), and the factor by which its rates can grow meanwhile.
    pub window: f64,
    pub growth: f64,
    pub push: DMatrix<Phasor>,
    pub carry: DMatrix<Phasor>,
    /// Contributions to each output (rows): y per unit of w, y' per unit of w, y'' per unit of w', and y''' per unit
    /// of w'.
    pub angle: DMatrix<Phasor>,
    pub rate: DMatrix<Phasor>,
    pub residue: DMatrix<Phasor>,
    pub jerk: DMatrix<Phasor>,
}

/// State in modal coordinates: the cyclic coordinates, and w of the simple poles and of the clusters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModalState {
    pub(super) cyclic: Vec<f64>,
    pub(super) simple: Vec<Phasor>,
    pub(super) clusters: Vec<DVector<Phasor>>,
}

impl LinearFlow {
    /// Creates the flow of a plant; `None` if its numbers leave the range of doubles, or if an input changes the rate
    /// of an output instantaneously.
    pub fn new(form: SplitPlant) -> Option<Self> {
        let [rigid, elastic_output] = form.output.clone();
        if (&elastic_output * &form.input).iter().any(|jump| *jump != 0.0) {
            return None;
        }
        let carried = &rigid * &form.carried;
        let blocks = blocks(&form.matrix, &elastic_output, &carried)?;
        let fastest =
            blocks.iter().flat_map(|b| b.triangle.diagonal().iter().map(|z| z.re).collect::<Vec<_>>());
        let fastest = fastest.fold(0.0, f64::max);
        let window =
            if fastest > 0.0 { (core::f64::consts::LN_2 / fastest).min(LONGEST) } else { f64::INFINITY };
        let (mut poles, mut clusters) = (Vec::new(), Vec::new());
        for block in blocks {
            if block.triangle.nrows() == 1 {
                poles.push(SimplePole::new(&block, &form, (&elastic_output, &carried), window));
            } else {
                clusters.push(Cluster::new(block, &form, (&elastic_output, &carried)));
            }
        }
        let finite =
            |simple: &SimplePole| simple.outputs.iter().all(|s| s.residue.is_finite() && s.angle.is_finite());
        let beats = beats(&poles);
        poles.iter().all(finite).then_some(Self { form, poles, clusters, rigid, beats, window })
    }

    /// Returns the number of outputs.
    pub fn outputs(&self) -> usize {
        self.rigid.nrows()
    }

    /// Returns the poles (1/s), one of each conjugate pair.
    pub fn poles(&self) -> Vec<Phasor> {
        let clustered = self
            .clusters
            .iter()
            .flat_map(|c| c.block.triangle.diagonal().iter().copied().collect::<Vec<_>>());
        self.poles.iter().map(|simple| simple.pole.lambda).chain(clustered).collect()
    }

    /// Returns the largest condition number of a pole or a cluster: the amplification of rounding errors.
    pub fn condition(&self) -> f64 {
        let norm = |v: &DVector<Phasor>| f64::sqrt(v.iter().map(Phasor::norm_sqr).sum());
        let simple = self.poles.iter().map(|simple| norm(&simple.left) * norm(&simple.right));
        simple.chain(self.clusters.iter().map(|cluster| cluster.block.condition())).fold(1.0, f64::max)
    }

    /// Transforms a state x to modal coordinates.
    pub fn to_modal(&self, x: &DVector<f64>) -> ModalState {
        let [cyclic, rest] = &self.form.split;
        let w = (rest * x).map(|re| Phasor { re, im: 0.0 });
        let dot = |row: &DVector<Phasor>| {
            row.iter().zip(w.iter()).fold(Phasor::default(), |sum, (l, w)| sum + l * w)
        };
        ModalState {
            cyclic: (cyclic * x).as_slice().to_vec(),
            simple: self.poles.iter().map(|simple| dot(&simple.left)).collect(),
            clusters: self.clusters.iter().map(|cluster| &cluster.block.left * &w).collect(),
        }
    }

    /// Transforms modal coordinates to the state x.
    pub fn to_state(&self, modal: &ModalState) -> DVector<f64> {
        let mut w = DVector::zeros(self.form.matrix.nrows());
        for (simple, z) in self.poles.iter().zip(&modal.simple) {
            for (w, entry) in w.iter_mut().zip(simple.right.iter()) {
                *w += simple.weight * (entry.re * z.re - entry.im * z.im);
            }
        }
        for (cluster, z) in self.clusters.iter().zip(&modal.clusters) {
            let part = &cluster.block.right * z;
            w.zip_apply(&part, |w, part| *w += cluster.block.weight * part.re);
        }
        let [cyclic, rest] = &self.form.joined;
        let mut x = rest * w;
        for (column, theta) in cyclic.column_iter().zip(&modal.cyclic) {
            x.axpy(*theta, &column, 1.0);
        }
        x
    }
}

impl SimplePole {
    fn new(
        block: &PoleBlock,
        form: &SplitPlant,
        (output, carried): (&DMatrix<f64>, &DMatrix<f64>),
        window: f64,
    ) -> Self {
        let lambda = block.triangle[(0, 0)];
        let (left_factor, right_factor) = (
            DVector::from_iterator(block.left.ncols(), block.left.iter().copied()),
            block.right.column(0).into_owned(),
        );
        let sum = |row: &mut dyn Iterator<Item = (&f64, &Phasor)>| {
            row.fold(Phasor::default(), |sum, (m, v)| sum + v * *m)
        };
        let rows = |m: &DMatrix<f64>| -> Vec<Phasor> {
            (0..m.nrows()).map(|j| sum(&mut m.row(j).iter().zip(right_factor.iter()))).collect()
        };
        let (angles, rates, carry) = (rows(output), rows(carried), rows(&form.carried));
        let observe =
            |(angle, rate): (Phasor, Phasor)| PoleOutput { angle, rate, residue: rate + lambda * angle };
        let push = form.input.column_iter().map(|b| sum(&mut b.iter().zip(left_factor.iter()))).collect();
        Self {
            pole: Pole::new(lambda),
            weight: block.weight,
            growth: if lambda.re > 0.0 { libm::exp(lambda.re * window) } else { 1.0 },
            push,
            carry,
            outputs: angles.into_iter().zip(rates).map(observe).collect(),
            left: left_factor,
            right: right_factor,
        }
    }
}

impl Cluster {
    fn new(block: PoleBlock, form: &SplitPlant, (output, carried): (&DMatrix<f64>, &DMatrix<f64>)) -> Self {
        let complex = |m: &DMatrix<f64>| m.map(|re| Phasor { re, im: 0.0 });
        let t = &block.triangle;
        let angle = complex(output) * &block.right;
        let rate = complex(carried) * &block.right;
        let residue = &rate + &angle * t;
        let size = t.diagonal().iter().map(|z| abs(*z)).fold(0.0, f64::max);
        let (window, growth) = if t.nrows() == 2 {
            let fastest = t.diagonal().iter().map(|z| z.re).fold(0.0, f64::max);
            let window = (12.0 / size.max(0.01 * form.matrix.norm())).min(core::f64::consts::LN_2 / fastest);
            (window, libm::exp(fastest * window))
        } else {
            // The logarithmic norm bounds the growth of any e^(T h).
            let symmetric = (t + t.adjoint()) * Phasor { re: 0.5, im: 0.0 };
            let fastest = symmetric.symmetric_eigenvalues().iter().copied().fold(0.0, f64::max);
            let window =
                if fastest > 0.0 { (core::f64::consts::LN_2 / fastest).min(LONGEST) } else { f64::INFINITY };
            (window, if fastest > 0.0 { libm::exp(fastest * window) } else { 1.0 })
        };
        Self {
            window,
            growth,
            push: &block.left * complex(&form.input),
            carry: complex(&form.carried) * &block.right,
            jerk: &residue * t,
            angle,
            rate,
            residue,
            block,
        }
    }
}

/// Returns disjoint pairs of poles that do not grow and are near enough to beat.
fn beats(poles: &[SimplePole]) -> Vec<(usize, usize, f64, f64)> {
    let mut beats: Vec<(usize, usize, f64, f64)> = Vec::new();
    for (i, one) in poles.iter().enumerate() {
        let accepted =
            |k: usize, beats: &[(usize, usize, f64, f64)]| beats.iter().any(|(a, b, ..)| *a == k || *b == k);
        if accepted(i, &beats) || one.pole.lambda.re > 1e-12 * one.pole.size {
            continue;
        }
        let near = |(j, other): (usize, &SimplePole)| {
            let apart = abs(one.pole.lambda - other.pole.lambda);
            let beat = j > i && apart < 0.02 * one.pole.size && other.weight == one.weight;
            (beat && other.pole.lambda.re <= 1e-12 * one.pole.size && !accepted(j, &beats))
                .then_some((j, apart))
        };
        let nearest = poles.iter().enumerate().filter_map(near).min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((j, apart)) = nearest {
            beats.push((i, j, apart, 13.0 / one.pole.size));
        }
    }
    beats
}
