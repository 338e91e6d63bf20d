//! Discrete-time linear system as a block of a linear loop: laws, sensors and settled estimators.

use nalgebra::DMatrix;

/// Linear system `x[k+1] = a x + b u`, `y = c x + d u`.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearBlock {
    /// State matrix, of shape (states, states).
    pub a: DMatrix<f64>,
    /// Input matrix, of shape (states, inputs).
    pub b: DMatrix<f64>,
    /// Output matrix, of shape (outputs, states).
    pub c: DMatrix<f64>,
    /// Feedthrough matrix, of shape (outputs, inputs).
    pub d: DMatrix<f64>,
    /// Names and units of the states.
    pub states: Vec<BlockState>,
}

/// Name and unit of a state of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockState {
    /// Name of the state.
    pub name: String,
    /// Unit of the state.
    pub unit: &'static str,
}

impl BlockState {
    /// Creates a state.
    pub fn new(name: impl Into<String>, unit: &'static str) -> Self {
        Self { name: name.into(), unit }
    }
}

impl LinearBlock {
    /// Creates a block without states.
    pub fn from_gain(d: DMatrix<f64>) -> Self {
        let (outputs, inputs) = d.shape();
        Self {
            a: DMatrix::zeros(0, 0),
            b: DMatrix::zeros(0, inputs),
            c: DMatrix::zeros(outputs, 0),
            d,
            states: Vec::new(),
        }
    }

    /// Returns the series of this block and one that reads its outputs.
    #[must_use]
    pub fn then(self, after: Self) -> Self {
        let (first, second) = (self.a.nrows(), after.a.nrows());
        let order = first + second;
        let mut a = DMatrix::zeros(order, order);
        a.view_mut((0, 0), (first, first)).copy_from(&self.a);
        a.view_mut((first, 0), (second, first)).copy_from(&(&after.b * &self.c));
        a.view_mut((first, first), (second, second)).copy_from(&after.a);
        let mut b = DMatrix::zeros(order, self.b.ncols());
        b.view_mut((0, 0), self.b.shape()).copy_from(&self.b);
        b.view_mut((first, 0), (second, self.b.ncols())).copy_from(&(&after.b * &self.d));
        let mut c = DMatrix::zeros(after.c.nrows(), order);
        c.view_mut((0, 0), (after.c.nrows(), first)).copy_from(&(&after.d * &self.c));
        c.view_mut((0, first), after.c.shape()).copy_from(&after.c);
        let d = &after.d * &self.d;
        let states = self.states.into_iter().chain(after.states).collect();
        Self { a, b, c, d, states }
    }

    /// Returns blocks that do not act on each other as one block.
    pub fn parallel(blocks: Vec<Self>) -> Self {
        let all = |part: fn(&Self) -> &DMatrix<f64>| diagonal(&blocks.iter().map(part).collect::<Vec<_>>());
        let (a, b, c, d) =
            (all(|block| &block.a), all(|block| &block.b), all(|block| &block.c), all(|block| &block.d));
        Self { a, b, c, d, states: blocks.into_iter().flat_map(|block| block.states).collect() }
    }
}

/// Returns the block-diagonal matrix of these blocks.
pub fn diagonal(blocks: &[&DMatrix<f64>]) -> DMatrix<f64> {
    let rows = blocks.iter().map(|block| block.nrows()).sum();
    let columns = blocks.iter().map(|block| block.ncols()).sum();
    let (mut whole, mut row, mut column) = (DMatrix::zeros(rows, columns), 0, 0);
    for block in blocks {
        whole.view_mut((row, column), block.shape()).copy_from(*block);
        row += block.nrows();
        column += block.ncols();
    }
    whole
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    /// A first-order lag with feedthrough, x+ = a x + u, y = c x + d u.
    fn lag(a: f64, c: f64, d: f64) -> LinearBlock {
        LinearBlock {
            a: dmatrix![a],
            b: dmatrix![1.0],
            c: dmatrix![c],
            d: dmatrix![d],
            states: vec![BlockState::new("lag", "rad")],
        }
    }

    /// Outputs of a block under inputs of one column, sample by sample.
    fn outputs(block: &LinearBlock, inputs: &[f64]) -> Vec<f64> {
        let mut x = DMatrix::zeros(block.a.nrows(), 1);
        let step = |u: &f64| {
            let u = DMatrix::from_element(block.b.ncols(), 1, *u);
            let y = (&block.c * &x + &block.d * &u)[(0, 0)];
            x = &block.a * &x + &block.b * &u;
            y
        };
        inputs.iter().map(step).collect()
    }

    #[test]
    fn a_series_filters_one_after_the_other() {
        let inputs = [1.0, -0.5, 0.25, 2.0, 0.0];
        let (first, second) = (lag(0.5, 2.0, 1.0), lag(-0.25, 1.0, 3.0));
        let expected = outputs(&second, &outputs(&first, &inputs));
        assert_eq!(outputs(&first.then(second), &inputs), expected);
    }

    #[test]
    fn parallel_blocks_do_not_act_on_each_other() {
        let both =
            LinearBlock::parallel(vec![lag(0.5, 2.0, 1.0), LinearBlock::from_gain(dmatrix![3.0, 4.0])]);
        assert_eq!(both.a, dmatrix![0.5]);
        assert_eq!(both.b, dmatrix![1.0, 0.0, 0.0]);
        assert_eq!(both.c, dmatrix![2.0; 0.0]);
        assert_eq!(both.d, dmatrix![1.0, 0.0, 0.0; 0.0, 3.0, 4.0]);
    }
}
