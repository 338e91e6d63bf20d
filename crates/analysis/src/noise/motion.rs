//! Outputs of a loop at any time of its period, as rows over the states at the start and the draws since.

use std::collections::BTreeMap;

use flexsc_numerics::quadrature::nodes;
use nalgebra::{DMatrix, RowDVector};

use super::period_rows::Piece;
use crate::eigenvalues::eigenvalues;
use crate::margins::frequency_response::modulus;
use crate::open_loop::attitude_rows::seconds;
use crate::open_loop::sampling::held;

/// Output of a loop.
#[derive(Clone, Debug)]
pub enum OutputRow {
    /// Row over the states of the body.
    Body(RowDVector<f64>),
    /// Command of the law about an axis, held from sample to sample.
    Command(usize),
}

/// Time in a piece, its weight, and the response of outputs then to the states at the start and to the torques.
struct QuadratureNode {
    time: f64,
    weight: f64,
    flow: DMatrix<f64>,
    forced: DMatrix<f64>,
}

/// Motion over a period at all of its times.
#[derive(Clone, Debug)]
pub struct Motion {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    pieces: Vec<Piece>,
    outputs: Vec<OutputRow>,
    /// Largest frequency of the body (rad/s).
    fastest: f64,
}

impl Motion {
    /// Creates the motion of a body x' = a x + b u over these pieces of a period.
    pub fn new((a, b): (&DMatrix<f64>, &DMatrix<f64>), pieces: Vec<Piece>, outputs: Vec<OutputRow>) -> Self {
        let poles = eigenvalues(a).unwrap_or_default();
        let fastest = poles.iter().map(|pole| modulus(*pole)).fold(0.0, f64::max);
        Self { a: a.clone(), b: b.clone(), pieces, outputs, fastest }
    }

    /// Returns the rows of outputs at a time within the period (fs).
    pub fn rows_at_ticks(&self, outputs: &[usize], time: i64) -> DMatrix<f64> {
        let place = self.pieces.partition_point(|piece| piece.from <= time);
        let piece = &self.pieces[place.max(1) - 1];
        self.rows(outputs, piece, &held(&self.a, &self.b, seconds(time - piece.from)))
    }

    /// Returns the rows of outputs at a time within the period (s), which need not be a whole number of femtoseconds.
    pub fn rows_at(&self, outputs: &[usize], time: f64) -> DMatrix<f64> {
        let place = self.pieces.partition_point(|piece| seconds(piece.from) <= time);
        let piece = &self.pieces[place.max(1) - 1];
        self.rows(outputs, piece, &held(&self.a, &self.b, time - seconds(piece.from)))
    }

    /// Calls a function with times, weights and rows, such that the weighted sum of products of two rows is their integral
    /// over an interval of the period (s). `fastest` (rad/s) is that of a further factor.
    pub fn integrate(
        &self,
        outputs: &[usize],
        [from, to]: [f64; 2],
        fastest: f64,
        mut at: impl FnMut(f64, f64, &DMatrix<f64>),
    ) {
        let rate = 2.0 * self.fastest + fastest;
        let mut known: BTreeMap<[u64; 2], Vec<QuadratureNode>> = BTreeMap::new();
        for piece in &self.pieces {
            let start = seconds(piece.from);
            let [first, last] = [from, to].map(|end| (end - start).clamp(0.0, seconds(piece.length)));
            if last <= first {
                continue;
            }
            let times = known.entry([first.to_bits(), last.to_bits()]).or_insert_with(|| {
                let node = |(time, weight): (f64, f64)| {
                    let (flow, forced) = held(&self.a, &self.b, first + time);
                    let (flow, forced) = (self.body_rows(outputs, &flow), self.body_rows(outputs, &forced));
                    QuadratureNode { time: first + time, weight, flow, forced }
                };
                nodes(last - first, rate).into_iter().map(node).collect()
            });
            for QuadratureNode { time, weight, flow, forced } in times.iter() {
                let mut rows = flow * &piece.body + forced * &piece.torque;
                self.fill_commands(outputs, piece, &mut rows);
                at(start + time, *weight, &rows);
            }
        }
    }

    /// Returns the products of the outputs' rows and a matrix; 0 for a command.
    fn body_rows(&self, outputs: &[usize], matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let mut rows = DMatrix::zeros(outputs.len(), matrix.ncols());
        for (place, output) in outputs.iter().enumerate() {
            if let OutputRow::Body(row) = &self.outputs[*output] {
                rows.row_mut(place).copy_from(&(row * matrix));
            }
        }
        rows
    }

    fn fill_commands(&self, outputs: &[usize], piece: &Piece, rows: &mut DMatrix<f64>) {
        for (place, output) in outputs.iter().enumerate() {
            if let OutputRow::Command(axis) = self.outputs[*output] {
                rows.row_mut(place).copy_from(&piece.command.row(axis));
            }
        }
    }

    fn rows(
        &self,
        outputs: &[usize],
        piece: &Piece,
        (flow, forced): &(DMatrix<f64>, DMatrix<f64>),
    ) -> DMatrix<f64> {
        let (flow, forced) = (self.body_rows(outputs, flow), self.body_rows(outputs, forced));
        let mut rows = flow * &piece.body + forced * &piece.torque;
        self.fill_commands(outputs, piece, &mut rows);
        rows
    }
}
