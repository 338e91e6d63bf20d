//! Matrices of a compensator in discrete time, and discretisation of those in continuous time (\[FranklinPowell98\]).

use flexsc_formats::document::ConfigError;
use flexsc_numerics::exponential::exponential;
use flexsc_numerics::inverse::inverse;
use flexsc_numerics::quantity::Finite;
use nalgebra::DMatrix;

/// Matrices in discrete time.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteMatrices {
    /// State matrix A.
    pub a: DMatrix<f64>,
    /// Input matrix B.
    pub b: DMatrix<f64>,
    /// Output matrix C.
    pub c: DMatrix<f64>,
    /// Feedthrough matrix D.
    pub d: DMatrix<f64>,
}

/// Returns a matrix with `columns` columns, or the key of the first row with another length.
pub fn matrix(key: &str, rows: &[Vec<Finite>], columns: usize) -> Result<DMatrix<f64>, ConfigError> {
    match rows.iter().position(|row| row.len() != columns) {
        Some(row) => Err(ConfigError::new(
            format!("{key}[{row}]"),
            format!(
                "must have {columns} column{}, got {}",
                if columns == 1 { "" } else { "s" },
                rows[row].len()
            ),
        )),
        None => Ok(DMatrix::from_fn(rows.len(), columns, |row, column| rows[row][column].get())),
    }
}

impl DiscreteMatrices {
    /// Returns matrices of zeros for these numbers of states, inputs and outputs.
    pub fn zeros(order: usize, inputs: usize, outputs: usize) -> Self {
        Self {
            a: DMatrix::zeros(order, order),
            b: DMatrix::zeros(order, inputs),
            c: DMatrix::zeros(outputs, order),
            d: DMatrix::zeros(outputs, inputs),
        }
    }

    /// Discretises the matrices for samples `h` (s) apart, with the input held between them.
    pub fn held(self, h: f64) -> Self {
        let (order, inputs) = (self.a.nrows(), self.b.ncols());
        let mut whole = DMatrix::zeros(order + inputs, order + inputs);
        whole.view_mut((0, 0), (order, order)).copy_from(&(&self.a * h));
        whole.view_mut((0, order), (order, inputs)).copy_from(&(&self.b * h));
        let whole = exponential(&whole);
        let (a, b) = (whole.view((0, 0), (order, order)), whole.view((0, order), (order, inputs)));
        Self { a: a.into_owned(), b: b.into_owned(), ..self }
    }

    /// Discretises the matrices by s = 2/h (z - 1)/(z + 1), if possible: with L = (1 - A h/2)^-1, states (L (1 + A h/2)
    /// x), inputs L B h, outputs C L, and D + C L B h/2.
    pub fn tustin(self, h: f64) -> Option<Self> {
        let one = DMatrix::identity(self.a.nrows(), self.a.nrows());
        let half = &self.a * (0.5 * h);
        let inverse = if self.a.is_empty() { one.clone() } else { inverse(&one - &half)? };
        let (a, c) = (&inverse * (one + half), &self.c * &inverse);
        let b = inverse * &self.b * h;
        let d = &self.d + &c * &self.b * (0.5 * h);
        Some(Self { a, b, c, d })
    }
}
