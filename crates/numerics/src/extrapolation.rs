//! Integration of y' = f(t, y) to a tolerance, by extrapolation of the modified midpoint rule (Gragg, Bulirsch,
//! Stoer).
//!
//! The error of the midpoint rule is a series in h², so that each further number of substeps removes two orders; a
//! step ends with the first column whose two best values agree to the tolerance.

/// Number of substeps of each column.
const SUBSTEPS: [u32; 9] = [2, 4, 6, 8, 10, 12, 14, 16, 18];

/// Right-hand side of a differential equation.
pub trait RightHandSide {
    /// Computes y' at (t, y) into `rate`.
    fn rate(&self, t: f64, y: &[f64], rate: &mut [f64]);
}

/// Integrator for equations of one dimension: tolerance and working memory.
#[derive(Clone, Debug)]
pub struct Extrapolation {
    tolerance: f64,
    /// Row i contains the extrapolation of the columns from i to the newest: the first row is the best value.
    table: Vec<Vec<f64>>,
    before: Vec<f64>,
    solution: Vec<f64>,
    rate: Vec<f64>,
}

impl Extrapolation {
    /// Creates an integrator whose steps err by at most `tolerance`, relative to the largest component of y or to 1.
    pub fn new(tolerance: f64, dimension: usize) -> Self {
        let zero = vec![0.0; dimension];
        Self {
            tolerance,
            table: vec![zero.clone(); SUBSTEPS.len()],
            before: zero.clone(),
            solution: zero.clone(),
            rate: zero,
        }
    }

    /// Advances y by one step of at most `h` (s) from t. Returns the step length and a suggestion for the next one.
    pub fn step(&mut self, field: &impl RightHandSide, t: f64, y: &mut [f64], mut h: f64) -> (f64, f64) {
        loop {
            if let Some(column) = self.converge(field, t, y, h) {
                y.copy_from_slice(&self.table[0]);
                let growth = match column {
                    0..=4 => 2.0,
                    5..=6 => 1.3,
                    _ => 1.0,
                };
                return (h, h * growth);
            }
            h *= 0.5;
        }
    }

    /// Returns the column with which a step of `h` (s) met the tolerance; `None` if no column did.
    fn converge(&mut self, field: &impl RightHandSide, t: f64, y: &[f64], h: f64) -> Option<usize> {
        let size = y.iter().fold(1.0_f64, |size, y| size.max(y.abs()));
        // Shorter steps would only add rounding; the caller detects non-finite values.
        let last_resort = h < 1e-9;
        for (column, substeps) in SUBSTEPS.into_iter().enumerate() {
            self.midpoint(field, t, y, h, column);
            // Neville's scheme in h², from the new column back to the first.
            let mut error = f64::INFINITY;
            for back in (0..column).rev() {
                let ratio = f64::from(substeps) / f64::from(SUBSTEPS[back]);
                let factor = 1.0 / (ratio * ratio - 1.0);
                let (older, newer) = self.table.split_at_mut(back + 1);
                error = 0.0;
                for (old, new) in older[back].iter_mut().zip(&newer[0]) {
                    let change = (new - *old) * factor;
                    *old = new + change;
                    error = error.max(change.abs());
                }
            }
            let unusable = self.table[0].iter().any(|y| !y.is_finite());
            if column >= 2 && (error <= self.tolerance * size || last_resort) || unusable && last_resort {
                return Some(column);
            }
        }
        None
    }

    /// Applies the modified midpoint rule with the substeps of a column, into its row.
    fn midpoint(&mut self, field: &impl RightHandSide, t: f64, y: &[f64], h: f64, column: usize) {
        let Self { table, before, solution, rate, .. } = self;
        let small = h / f64::from(SUBSTEPS[column]);
        before.copy_from_slice(y);
        field.rate(t, y, rate);
        for ((value, y), rate) in solution.iter_mut().zip(y).zip(rate.iter()) {
            *value = y + small * rate;
        }
        for k in 1..SUBSTEPS[column] {
            field.rate(t + f64::from(k) * small, solution, rate);
            for ((before, current), rate) in before.iter_mut().zip(solution.iter_mut()).zip(rate.iter()) {
                let next = *before + 2.0 * small * rate;
                *before = *current;
                *current = next;
            }
        }
        field.rate(t + h, solution, rate);
        let smooth = table[column].iter_mut().zip(before.iter()).zip(solution.iter().zip(rate.iter()));
        for ((value, before), (current, rate)) in smooth {
            *value = 0.5 * (before + current + small * rate);
        }
    }
}

/// Solution over time; its steps depend only on the initial state, not on when it is observed.
#[derive(Clone, Debug)]
pub struct Trajectory {
    integrator: Extrapolation,
    /// Steps around the current time: time since the start of the segment (s), and y.
    node: (f64, Vec<f64>),
    next: (f64, Vec<f64>),
    /// Length of the step after `next` (s).
    step: f64,
    /// Value of y at the last observed time.
    solution: Vec<f64>,
}

impl Trajectory {
    /// Creates a solution that begins with y; `step` limits the first step (s).
    pub fn new(tolerance: f64, y: Vec<f64>, step: f64) -> Self {
        Self {
            integrator: Extrapolation::new(tolerance, y.len()),
            node: (0.0, y.clone()),
            next: (0.0, y.clone()),
            step,
            solution: y,
        }
    }

    /// Returns y at the last observed time.
    pub fn current(&self) -> &[f64] {
        &self.solution
    }

    /// Begins a new segment at the last observed time.
    pub fn depart(&mut self) {
        self.node = (0.0, self.solution.clone());
        self.next = self.node.clone();
    }

    /// Advances by one step towards `h` (s) since the start of the segment, unless it was reached; returns true once
    /// it is reached.
    pub fn step_towards(&mut self, field: &impl RightHandSide, h: f64) -> bool {
        let Self { integrator, node, next, step, .. } = self;
        if next.0 < h {
            node.clone_from(next);
            let (took, then) = integrator.step(field, next.0, &mut next.1, *step);
            next.0 += took;
            *step = then;
        }
        next.0 >= h || !next.0.is_finite()
    }

    /// Returns y at `h` (s) since the start of the segment, which must not decrease between calls. The field's time
    /// counts from the start of the segment.
    pub fn at(&mut self, field: &impl RightHandSide, h: f64) -> &[f64] {
        while !self.step_towards(field, h) {}
        let Self { integrator, node, solution, .. } = self;
        // An observation between two steps changes neither.
        solution.clone_from(&node.1);
        let mut t = node.0;
        while t < h {
            t += integrator.step(field, t, solution, h - t).0;
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pendulum of unit frequency.
    struct Pendulum;

    impl RightHandSide for Pendulum {
        fn rate(&self, _: f64, y: &[f64], rate: &mut [f64]) {
            rate[0] = y[1];
            rate[1] = -libm::sin(y[0]);
        }
    }

    #[test]
    fn a_pendulum_comes_back_after_its_period() {
        // Period 4 K(sin(1)) for the amplitude 2 rad, by mpmath.
        let period = 8.349_752_926_918_495;
        let mut y = [2.0, 0.0];
        let (mut t, mut h, mut steps) = (0.0, 0.1, 0);
        let mut integrator = Extrapolation::new(1e-13, 2);
        while t < period {
            let (took, next) = integrator.step(&Pendulum, t, &mut y, f64::min(h, period - t));
            (t, h, steps) = (t + took, next, steps + 1);
        }
        assert!((y[0] - 2.0).abs() < 2e-12 && y[1].abs() < 2e-12, "{y:?}");
        assert!(steps < 40, "{steps} steps");
    }

    #[test]
    fn what_blows_up_ends() {
        struct Explosion;
        impl RightHandSide for Explosion {
            fn rate(&self, _: f64, y: &[f64], rate: &mut [f64]) {
                rate[0] = y[0] * y[0];
            }
        }
        let (mut y, mut t, mut h) = ([1.0], 0.0, 0.5);
        for _ in 0..10_000 {
            let (took, next) = Extrapolation::new(1e-10, 1).step(&Explosion, t, &mut y, h);
            (t, h) = (t + took, next);
        }
        assert!((t - 1.0).abs() < 1e-3 || !y[0].is_finite());
    }
}
