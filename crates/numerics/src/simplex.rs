//! Bounded simplex method for small linear programmes: minimise c'x with A x = b and 0 <= x <= u.
//!
//! Intended for a few rows and some dozens of columns, solved repeatedly in a run: the basis is solved anew at each
//! pivot, so that rounding does not accumulate, and pivots follow Bland's rule, the least index first, which
//! terminates and has one result on every machine (\[Bland77\]). A library would bring sparse factorisations and its
//! own pivot rules, which could change the results in a log.

/// Limit on the pivots; beyond it the best point found is used. Bland's rule needs far fewer for such programmes.
const MOST: usize = 500;

/// Relative size below which numbers of a programme are rounding errors.
const ROUNDING: f64 = 1e-11;

/// Linear programme: columns of equal length, and the upper bound of each variable; the lower bound is 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearProgramme {
    columns: Vec<Vec<f64>>,
    most: Vec<f64>,
    rows: usize,
}

/// State of the method: the basis, and which variables outside of it are at their upper bound.
struct Tableau<'a> {
    columns: &'a [Vec<f64>],
    most: Vec<f64>,
    basis: Vec<usize>,
    values: Vec<f64>,
    above: Vec<bool>,
    rhs: Vec<f64>,
}

impl LinearProgramme {
    /// Creates a programme with the given number of rows, columns and upper bounds.
    pub fn new(rows: usize, columns: Vec<Vec<f64>>, most: Vec<f64>) -> Self {
        Self { columns, most, rows }
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the cheapest x with A x = s b, 0 <= x <= u, where s is the largest attainable fraction of b, up to 1;
    /// and s.
    pub fn cheapest(&self, b: &[f64], costs: &[f64]) -> (Vec<f64>, f64) {
        let (values, part, _) = self.cheapest_with_prices(b, costs);
        (values, part)
    }

    /// Returns what [`Self::cheapest`] returns, and the price of each row: the derivative of the cost in the row's right
    /// side. The prices are the solution of the dual programme.
    pub fn cheapest_with_prices(&self, b: &[f64], costs: &[f64]) -> (Vec<f64>, f64, Vec<f64>) {
        let (rows, count) = (self.rows, self.columns.len());
        // Each row is scaled to the size of 1.
        let size = |row: usize| self.columns.iter().map(|column| column[row].abs()).fold(0.0, f64::max);
        let scales: Vec<f64> =
            (0..rows).map(size).map(|size| if size > 0.0 { 1.0 / size } else { 1.0 }).collect();
        let largest = self.most.iter().copied().fold(0.0, f64::max);
        let demand = b.iter().zip(&scales).map(|(b, scale)| (b * scale).abs()).fold(0.0, f64::max);
        let unit = largest.min(demand);
        if demand == 0.0 || largest == 0.0 {
            return (vec![0.0; count], if demand == 0.0 { 1.0 } else { 0.0 }, vec![0.0; rows]);
        }
        // Solutions are scaled to the size of 1, however small the request. Columns: x in its unit and that of the
        // request, then s, then an initial slack for each row.
        let mut columns: Vec<Vec<f64>> = self
            .columns
            .iter()
            .map(|column| column.iter().zip(&scales).map(|(a, scale)| a * scale * (unit / demand)).collect())
            .collect();
        columns.push(b.iter().zip(&scales).map(|(b, scale)| -b * scale / demand).collect());
        for row in 0..rows {
            columns.push((0..rows).map(|other| if other == row { 1.0 } else { 0.0 }).collect());
        }
        let mut most: Vec<f64> = self.most.iter().map(|most| most / unit).collect();
        most.push(1.0);
        most.resize(columns.len(), 0.0);
        let mut tableau = Tableau {
            basis: (count + 1..columns.len()).collect(),
            values: vec![0.0; columns.len()],
            above: vec![false; columns.len()],
            rhs: vec![0.0; rows],
            columns: &columns,
            most,
        };
        let mut rising = vec![0.0; columns.len()];
        rising[count] = -1.0;
        tableau.minimise(&rising);
        // Rounding must not request more than is available.
        let part = tableau.values[count].clamp(0.0, 1.0);
        // That fraction is the request from here on; s is then fixed to zero.
        tableau.rhs = tableau.columns[count].iter().map(|value| -value * part).collect();
        (tableau.values[count], tableau.most[count], tableau.above[count]) = (0.0, 0.0, false);
        tableau.refresh();
        let dearest = costs.iter().map(|cost| cost.abs()).fold(f64::MIN_POSITIVE, f64::max);
        let mut scaled: Vec<f64> = costs.iter().map(|cost| cost / dearest).collect();
        scaled.resize(columns.len(), 0.0);
        tableau.minimise(&scaled);
        let basis_costs: Vec<f64> = tableau.basis.iter().map(|index| scaled[*index]).collect();
        let prices = tableau.solve(&basis_costs, true);
        let prices =
            prices.iter().zip(&scales).map(|(price, scale)| price * scale * (unit / demand) * dearest);
        (tableau.values[..count].iter().map(|value| value * unit).collect(), part, prices.collect())
    }
}

impl Tableau<'_> {
    /// Solves B y = v by elimination with the largest pivot; B' y = v if `transposed`.
    fn solve(&self, v: &[f64], transposed: bool) -> Vec<f64> {
        let n = self.basis.len();
        let entry = |row: usize, column: usize| {
            if transposed {
                self.columns[self.basis[row]][column]
            } else {
                self.columns[self.basis[column]][row]
            }
        };
        let mut matrix: Vec<Vec<f64>> =
            (0..n).map(|row| (0..n).map(|column| entry(row, column)).chain([v[row]]).collect()).collect();
        for pivot in 0..n {
            let best = (pivot..n).fold(pivot, |best, row| {
                if matrix[row][pivot].abs() > matrix[best][pivot].abs() { row } else { best }
            });
            matrix.swap(pivot, best);
            let (done, below) = matrix.split_at_mut(pivot + 1);
            let lead = &done[pivot];
            for row in below {
                let factor = row[pivot] / lead[pivot];
                row.iter_mut().zip(lead).skip(pivot).for_each(|(a, pivot_value)| *a -= factor * pivot_value);
            }
        }
        let mut found = vec![0.0; n];
        for row in (0..n).rev() {
            let known: f64 = (row + 1..n).map(|column| matrix[row][column] * found[column]).sum();
            found[row] = (matrix[row][n] - known) / matrix[row][row];
        }
        found
    }

    /// Moves from vertex to vertex until the costs no longer decrease.
    fn minimise(&mut self, costs: &[f64]) {
        for _ in 0..MOST {
            let basis_costs: Vec<f64> = self.basis.iter().map(|index| costs[*index]).collect();
            let prices = self.solve(&basis_costs, true);
            let Some((enters, sense)) = self.entering(costs, &prices) else { return };
            let column = self.solve(&self.columns[enters], false);
            // Step length and its limit: the entering variable at its other bound, or one of the basis at one of its
            // bounds.
            let (mut step, mut leaves) = (self.most[enters], None);
            for (place, (index, slope)) in self.basis.iter().zip(&column).enumerate() {
                let change = -sense * slope;
                if change.abs() <= ROUNDING {
                    continue;
                }
                let end = if change > 0.0 { self.most[*index] } else { 0.0 };
                let room = ((end - self.values[*index]) / change).max(0.0);
                let first = leaves.is_none_or(|(_, other): (usize, usize)| *index < other);
                if room < step - ROUNDING || room <= step + ROUNDING && leaves.is_some() && first {
                    (step, leaves) = (room.min(step), Some((place, *index)));
                }
            }
            for (index, slope) in self.basis.iter().zip(&column) {
                let value = self.values[*index] - sense * step * slope;
                self.values[*index] = value.clamp(0.0, self.most[*index]);
            }
            self.values[enters] = (self.values[enters] + sense * step).clamp(0.0, self.most[enters]);
            match leaves {
                None => self.above[enters] = sense > 0.0,
                Some((place, index)) => {
                    // Placed at the nearer bound.
                    self.above[index] = self.values[index] > 0.5 * self.most[index];
                    self.values[index] = if self.above[index] { self.most[index] } else { 0.0 };
                    self.basis[place] = enters;
                    self.refresh();
                }
            }
        }
    }

    /// Returns the first variable outside of the basis whose change lowers the costs, and the direction.
    fn entering(&self, costs: &[f64], prices: &[f64]) -> Option<(usize, f64)> {
        (0..self.columns.len()).find_map(|index| {
            if self.most[index] <= 0.0 || self.basis.contains(&index) {
                return None;
            }
            let worth: f64 = self.columns[index].iter().zip(prices).map(|(a, price)| a * price).sum();
            let reduced = costs[index] - worth;
            let tolerance = ROUNDING * (1.0 + worth.abs());
            match self.above[index] {
                false if reduced < -tolerance => Some((index, 1.0)),
                true if reduced > tolerance => Some((index, -1.0)),
                _ => None,
            }
        })
    }

    /// Computes the values of the basis from those outside of it.
    fn refresh(&mut self) {
        let mut remainder = self.rhs.clone();
        for (index, column) in self.columns.iter().enumerate() {
            if self.values[index] != 0.0 && !self.basis.contains(&index) {
                remainder
                    .iter_mut()
                    .zip(column)
                    .for_each(|(residual, a)| *residual -= a * self.values[index]);
            }
        }
        let found = self.solve(&remainder, false);
        for (index, value) in self.basis.clone().into_iter().zip(found) {
            self.values[index] = value.clamp(0.0, self.most[index]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with SciPy's `linprog`: tests/golden/jets_oracle.py.
    #[test]
    fn it_finds_what_scipy_finds() {
        let text = include_str!("../../../tests/golden/jets.csv");
        let (mut cases, mut short) = (0, 0);
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
            let (rows, count) = (numbers[0] as usize, numbers[1] as usize);
            let mut rest = numbers[2..].iter().copied();
            let mut next_values = |n: usize| -> Vec<f64> { rest.by_ref().take(n).collect() };
            let columns: Vec<Vec<f64>> = (0..count).map(|_| next_values(rows)).collect();
            let (most, costs, b, expected) =
                (next_values(count), next_values(count), next_values(rows), next_values(2));
            let programme = LinearProgramme::new(rows, columns.clone(), most.clone());
            let (x, part) = programme.cheapest(&b, &costs);
            let cost: f64 = x.iter().zip(&costs).map(|(x, cost)| x * cost).sum();
            assert!((part - expected[0]).abs() < 1e-9, "{cases}: {part} of it, not {}", expected[0]);
            assert!(
                (cost - expected[1]).abs() < 1e-9 * expected[1].max(1.0),
                "{cases}: {cost}, not {}",
                expected[1]
            );
            assert!(x.iter().zip(&most).all(|(x, most)| (0.0..=most * (1.0 + 1e-15)).contains(x)));
            for row in 0..rows {
                let sum: f64 = x.iter().zip(&columns).map(|(x, column)| x * column[row]).sum();
                assert!((sum - part * b[row]).abs() < 1e-9, "{cases}: row {row}");
            }
            cases += 1;
            short += usize::from(part < 1.0);
        }
        assert!(cases >= 200 && short >= 40, "{cases} {short}");
    }

    #[test]
    fn little_is_found_as_exactly_as_much() {
        let column = |angle: f64| vec![libm::cos(angle), libm::sin(angle), 0.3 * libm::sin(3.0 * angle)];
        let columns: Vec<Vec<f64>> = (0..9).map(|k| column(0.7 * f64::from(k))).collect();
        let programme = LinearProgramme::new(3, columns, vec![1.0; 9]);
        let costs = [1.0, 1.5, 2.0, 1.0, 1.5, 2.0, 1.0, 1.5, 2.0];
        let solution = |size: f64| programme.cheapest(&[0.02 * size, -0.01 * size, 0.004 * size], &costs);
        let (whole, part) = solution(1.0);
        assert!(part == 1.0 && whole.iter().any(|x| *x > 0.0));
        for size in [1e-3, 1e-7, 1e-12, 1e-20] {
            let (x, part) = solution(size);
            let off = x.iter().zip(&whole).map(|(x, whole)| (x / size - whole).abs()).fold(0.0, f64::max);
            assert!(part == 1.0 && off < 1e-12, "{size:e}: {part} {off:e}");
        }
    }

    /// Maximise t below three planes in two variables within a box: min over the weights of the planes in the dual.
    #[test]
    fn prices_solve_the_dual() {
        let planes = [([1.0, 0.5], 0.2), ([-1.0, 0.3], 0.4), ([0.1, -1.0], 0.3)];
        let mut columns: Vec<Vec<f64>> = planes.iter().map(|(g, _)| vec![-g[0], -g[1], 1.0]).collect();
        let mut costs: Vec<f64> = planes.iter().map(|(_, value)| *value).collect();
        for row in 0..2 {
            for sense in [1.0, -1.0] {
                columns.push((0..3).map(|other| if other == row { sense } else { 0.0 }).collect());
                costs.push(0.5);
            }
        }
        let programme = LinearProgramme::new(3, columns, vec![10.0; 7]);
        let (_, part, prices) = programme.cheapest_with_prices(&[0.0, 0.0, 1.0], &costs);
        assert!((part - 1.0).abs() < 1e-12, "{part}");
        let level =
            |d: &[f64]| planes.iter().map(|(g, m)| m + g[0] * d[0] + g[1] * d[1]).fold(f64::MAX, f64::min);
        assert!((level(&prices[..2]) - prices[2]).abs() < 1e-12, "{prices:?}");
        for (dx, dy) in [(1e-3, 0.0), (-1e-3, 0.0), (0.0, 1e-3), (0.0, -1e-3), (7e-4, 7e-4), (-7e-4, 7e-4)] {
            assert!(level(&[prices[0] + dx, prices[1] + dy]) < prices[2]);
        }
    }

    #[test]
    fn nothing_costs_nothing_and_what_cannot_be_is_not() {
        let programme = LinearProgramme::new(1, vec![vec![2.0], vec![3.0]], vec![1.0, 1.0]);
        assert_eq!(programme.cheapest(&[0.0], &[1.0, 1.0]), (vec![0.0, 0.0], 1.0));
        assert_eq!(programme.cheapest(&[-1.0], &[1.0, 1.0]).1, 0.0);
        let (x, part) = programme.cheapest(&[10.0], &[1.0, 1.0]);
        assert!((part - 0.5).abs() < 1e-14 && x.iter().all(|x| (x - 1.0).abs() < 1e-14), "{part} {x:?}");
        // The second variable is cheaper per unit of the constraint.
        let (x, _) = programme.cheapest(&[2.0], &[1.0, 1.0]);
        assert!(x[0] == 0.0 && (x[1] - 2.0 / 3.0).abs() < 1e-15, "{x:?}");
    }
}
