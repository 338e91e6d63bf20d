//! Poles and eigenvectors: F V = V T with T diagonal where the vectors allow it, polished beyond the accuracy of the
//! solver.
//!
//! The order of poles and of every sum is fixed, so that a plant has the same poles on every machine.

use flexsc_numerics::phasor::{Phasor, abs};
use nalgebra::{DMatrix, DVector};

use super::extended::residual;
use super::schur::Schur;

/// Relative distance below which poles are candidates for a cluster.
const NEAR: f64 = 3e-3;
/// Condition number of a pole beyond which near poles are clustered, and beyond which any pole joins its nearest
/// neighbour.
const NEAR_CONDITION: f64 = 30.0;
const CONDITION: f64 = 1e3;
/// Condition number of a cluster beyond which the whole matrix is kept as one block.
const LOST: f64 = 1e6;
/// Distance, relative to the norm, below which poles are not polished because the equations become singular.
const UNPOLISHED: f64 = 1e-8;

/// Group of poles with their invariant subspace: F `right` = `right` `triangle`, `left` `right` = 1.
#[derive(Clone, Debug, PartialEq)]
pub struct PoleBlock {
    pub triangle: DMatrix<Phasor>,
    pub right: DMatrix<Phasor>,
    pub left: DMatrix<Phasor>,
    /// Weight: 2 if the conjugate block, which is not stored, counts too; else 1.
    pub weight: f64,
}

impl PoleBlock {
    fn pole(&self) -> Phasor {
        self.triangle[(0, 0)]
    }

    /// Returns the condition number of the block, 1 for orthogonal eigenvectors.
    pub fn condition(&self) -> f64 {
        size(&self.left) * size(&self.right) / self.triangle.nrows() as f64
    }
}

/// Computes the blocks of a matrix. The rows of `seen` and `carried` are each output's weights of w and of the
/// integral of w, which determine the phase of each pole's vector. Returns `None` if there is no Schur form.
pub fn blocks(
    matrix: &DMatrix<f64>,
    output: &DMatrix<f64>,
    carried: &DMatrix<f64>,
) -> Option<Vec<PoleBlock>> {
    let order = matrix.nrows();
    let schur = Schur::new(matrix)?;
    let norm = matrix.norm();
    let poles = Spectrum::new(&schur);
    let mut groups = poles.singles();
    let mut blocks = gather(&schur, &poles, &groups, norm)?;
    // First poles near each other with nearly equal vectors, then any pole that cannot be distinguished from its
    // neighbour.
    for (nearest, condition) in [(true, NEAR_CONDITION), (false, CONDITION)] {
        let ill: Vec<usize> =
            blocks.iter().filter(|(b, _)| b.condition() > condition).map(|(_, i)| *i).collect();
        if ill.is_empty() {
            continue;
        }
        for pole in ill {
            poles.merge(pole, nearest, &mut groups);
        }
        blocks = gather(&schur, &poles, &groups, norm)?;
    }
    if blocks.iter().any(|(block, _)| block.condition() > LOST) {
        let unit = schur.basis.clone();
        let adjoint = unit.adjoint();
        return Some(vec![PoleBlock { triangle: schur.triangle, right: unit, left: adjoint, weight: 1.0 }]);
    }
    let mut blocks: Vec<PoleBlock> = blocks.into_iter().map(|(block, _)| block).collect();
    for _ in 0..2 {
        polish(&mut blocks, matrix, norm);
    }
    for block in blocks.iter_mut().filter(|block| block.triangle.nrows() == 1) {
        turn(block, output, carried, norm);
    }
    invert(&mut blocks, order)?;
    blocks.sort_by(|a, b| {
        let key = |block: &PoleBlock| (abs(block.pole()), block.pole().im);
        let ((x, u), (y, v)) = (key(a), key(b));
        x.total_cmp(&y).then(u.total_cmp(&v))
    });
    Some(blocks)
}

/// Eigenvalues, with the index of each one's conjugate.
struct Spectrum {
    poles: Vec<Phasor>,
    conjugate: Vec<usize>,
}

impl Spectrum {
    fn new(schur: &Schur) -> Self {
        let mut poles: Vec<Phasor> = schur.triangle.diagonal().iter().copied().collect();
        let largest = poles.iter().map(|pole| abs(*pole)).fold(0.0, f64::max);
        for pole in poles.iter_mut().filter(|pole| pole.im.abs() < 1e-13 * largest) {
            pole.im = 0.0;
        }
        let mut conjugate: Vec<usize> = (0..poles.len()).collect();
        for i in (0..poles.len()).filter(|i| poles[*i].im > 0.0) {
            let distance = |j: &usize| abs(poles[*j] - poles[i].conj());
            let free = (0..poles.len()).filter(|j| poles[*j].im < 0.0 && conjugate[*j] == *j);
            if let Some(j) = free.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
                (conjugate[i], conjugate[j]) = (j, i);
            }
        }
        Self { poles, conjugate }
    }

    /// Returns groups with one pole each: the group number of every pole.
    fn singles(&self) -> Vec<usize> {
        (0..self.poles.len()).collect()
    }

    /// Joins the group of a pole with that of its nearest neighbour outside, or with those of all poles near it; the
    /// conjugates are joined likewise.
    fn merge(&self, pole: usize, near: bool, groups: &mut [usize]) {
        let distance = |j: usize| abs(self.poles[j] - self.poles[pole]);
        let outside: Vec<usize> = (0..self.poles.len()).filter(|j| groups[*j] != groups[pole]).collect();
        let with: Vec<usize> = if near {
            let reach = NEAR * abs(self.poles[pole]);
            outside.into_iter().filter(|j| distance(*j) <= reach).collect()
        } else {
            outside.into_iter().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).into_iter().collect()
        };
        let mut join = |a: usize, b: usize| {
            let (from, to) = (groups[b], groups[a]);
            groups.iter_mut().filter(|group| **group == from).for_each(|group| *group = to);
        };
        for other in with {
            join(pole, other);
            join(self.conjugate[pole], self.conjugate[other]);
        }
        // A group with a conjugate pair must contain all conjugates.
        for i in 0..self.poles.len() {
            let conjugate = self.conjugate[i];
            if conjugate != i && groups[i] == groups[conjugate] {
                let group = groups[i];
                for j in (0..groups.len()).filter(|j| groups[*j] == group).collect::<Vec<_>>() {
                    let (from, to) = (groups[self.conjugate[j]], group);
                    groups.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
                }
            }
        }
    }
}

/// Computes the blocks of the groups, one per conjugate pair, each with the index of one of its poles.
fn gather(schur: &Schur, poles: &Spectrum, groups: &[usize], norm: f64) -> Option<Vec<(PoleBlock, usize)>> {
    let mut blocks = Vec::new();
    let mut done = vec![false; groups.len()];
    for first in 0..groups.len() {
        let members: Vec<usize> = (0..groups.len()).filter(|i| groups[*i] == groups[first]).collect();
        let mirrored = poles.conjugate[first];
        let own = groups[mirrored] == groups[first];
        if done[first] || (!own && poles.poles[first].im < 0.0) {
            continue;
        }
        for member in &members {
            done[*member] = true;
        }
        let weight = if own { 1.0 } else { 2.0 };
        let (basis, triangle) = schur.subspace(&members);
        let count = members.len();
        let coupling =
            (0..count).flat_map(|j| (0..j).map(move |i| (i, j))).map(|element| abs(triangle[element]));
        let coupled = coupling.fold(0.0, f64::max) > 64.0 * f64::EPSILON * norm;
        if count > 1 && coupled {
            let adjoint = basis.adjoint();
            blocks.push((PoleBlock { triangle, right: basis, left: adjoint, weight }, first));
            continue;
        }
        // A multiple pole with independent vectors is split into several poles.
        for (j, member) in members.iter().enumerate() {
            let mut pole = triangle[(j, j)];
            let mut vector = basis.columns(j, 1).into_owned();
            if poles.poles[*member].im == 0.0 && count == 1 {
                pole.im = 0.0;
                make_real(&mut vector);
            }
            let triangle = DMatrix::from_element(1, 1, pole);
            blocks.push((PoleBlock { triangle, left: vector.adjoint(), right: vector, weight }, *member));
        }
    }
    let mut bare: Vec<PoleBlock> = blocks.iter().map(|(block, _)| block.clone()).collect();
    invert(&mut bare, groups.len())?;
    Some(bare.into_iter().zip(blocks).map(|(block, (_, pole))| (block, pole)).collect())
}

/// Multiplies the vector of a real pole by a phase factor that makes it real.
fn make_real(vector: &mut DMatrix<Phasor>) {
    let largest = vector.iter().copied().fold(Phasor::default(), |a, b| if abs(b) > abs(a) { b } else { a });
    vector.apply(|v| *v = Phasor { re: (*v / largest).re, im: 0.0 });
}

/// Multiplies a vector by the phase factor that makes its largest output contribution a real number.
fn turn(block: &mut PoleBlock, output: &DMatrix<f64>, carried: &DMatrix<f64>, norm: f64) {
    let pole = block.pole();
    if pole.im == 0.0 || abs(pole) < 1e-13 * norm {
        return;
    }
    let measurement = |rows: &DMatrix<f64>, j: usize| {
        let row = rows.row(j);
        row.iter().zip(block.right.iter()).fold(Phasor::default(), |sum, (c, v)| sum + v * *c)
    };
    let observations = (0..output.nrows()).map(|j| measurement(output, j) + measurement(carried, j) / pole);
    let largest = observations.fold(Phasor::default(), |a, b| if abs(b) > abs(a) { b } else { a });
    if abs(largest) > 1e-14 * size(&block.right) {
        block.right.apply(|v| *v /= largest);
        block.left.apply(|w| *w *= largest);
    }
}

/// Applies a Newton step to every isolated pole, with the residual in extended precision.
fn polish(blocks: &mut [PoleBlock], matrix: &DMatrix<f64>, norm: f64) {
    let old = blocks.to_vec();
    let spread = |pole: Phasor, block: &PoleBlock| {
        let diagonal = block.triangle.diagonal();
        let (one, other) = (diagonal.iter(), diagonal.iter().map(Phasor::conj));
        one.copied()
            .chain(other.filter(|_| block.weight == 2.0))
            .map(|z| abs(z - pole))
            .fold(f64::INFINITY, f64::min)
    };
    for (index, block) in blocks.iter_mut().enumerate().filter(|(_, block)| block.triangle.nrows() == 1) {
        let pole = block.pole();
        let is_isolated =
            |(i, other): (usize, &PoleBlock)| i == index || spread(pole, other) > UNPOLISHED * norm;
        if !old.iter().enumerate().all(is_isolated) {
            continue;
        }
        let wrong = residual(matrix, block.right.column(0), pole);
        let mut step = DVector::zeros(matrix.nrows());
        for (i, other) in old.iter().enumerate() {
            for mirrored in [false, true] {
                if mirrored && other.weight < 2.0 {
                    continue;
                }
                let conjugated = |m: &DMatrix<Phasor>| if mirrored { m.conjugate() } else { m.clone() };
                let part = conjugated(&other.left) * &wrong;
                if i == index && !mirrored {
                    block.triangle[(0, 0)] = pole + part[0];
                    continue;
                }
                let count = other.triangle.nrows();
                let apart = DMatrix::from_diagonal_element(count, count, pole) - conjugated(&other.triangle);
                step += conjugated(&other.right) * apart.solve_upper_triangular(&part).unwrap_or(part);
            }
        }
        if block.weight < 2.0 {
            block.triangle[(0, 0)].im = pole.im;
            step.apply(|s| s.im = if pole.im == 0.0 { 0.0 } else { s.im });
        }
        block.right += step;
    }
}

/// Sets the left vectors to the inverse of the right ones, with one step of Newton's iteration.
fn invert(blocks: &mut [PoleBlock], order: usize) -> Option<()> {
    let mut right = DMatrix::zeros(order, order);
    let mut offset = 0;
    for block in blocks.iter() {
        let count = block.right.ncols();
        right.columns_mut(offset, count).copy_from(&block.right);
        offset += count;
        if block.weight == 2.0 {
            right.columns_mut(offset, count).copy_from(&block.right.conjugate());
            offset += count;
        }
    }
    // Vectors that are equal to the last bit have no inverse; a huge one marks them as ill-conditioned.
    let mut left =
        right.clone().lu().try_inverse().unwrap_or_else(|| DMatrix::from_element(order, order, HUGE));
    let rest = DMatrix::identity(order, order) - &left * &right;
    left += rest * left.clone();
    let mut offset = 0;
    for block in blocks.iter_mut() {
        let count = block.right.ncols();
        block.left = left.rows(offset, count).into_owned();
        let real = block.weight < 2.0 && count == 1 && block.right.iter().all(|v| v.im == 0.0);
        block.left.apply(|w| w.im = if real { 0.0 } else { w.im });
        offset += if block.weight == 2.0 { 2 * count } else { count };
    }
    (offset == order).then_some(())
}

const HUGE: Phasor = Phasor { re: 1e150, im: 0.0 };

fn size(matrix: &DMatrix<Phasor>) -> f64 {
    f64::sqrt(matrix.iter().map(Phasor::norm_sqr).sum())
}
