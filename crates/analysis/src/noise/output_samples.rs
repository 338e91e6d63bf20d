//! Variances of weighted sums of an output's samples, exact for a loop.
//!
//! A sum is linear in the states at the start of the period of its first sample and in the draws since, so that its variance
//! needs no spectrum: the row over the states is carried from period to period, from the last sample to the first.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector, RowDVector};

use super::noisy_loop::NoisyLoop;
use super::sample_times::SamplePlace;

/// Largest number of times in a period whose rows are kept.
const MOST_KEPT: usize = 4096;

/// Samples of one output of a loop.
pub struct OutputSamples<'a> {
    noisy: &'a NoisyLoop,
    output: usize,
    /// Covariance of the states at the start of a period under all noise.
    covariance: DMatrix<f64>,
    /// Rows over the states and the draws of a period, by the time in it (fs).
    known: BTreeMap<i64, RowDVector<f64>>,
}

impl<'a> OutputSamples<'a> {
    /// Creates the samples of an output.
    pub fn new(noisy: &'a NoisyLoop, output: usize) -> Self {
        let zero = DMatrix::zeros(noisy.a.nrows(), noisy.a.nrows());
        let covariance = noisy.covariances.iter().fold(zero, |sum, own| sum + own);
        Self { noisy, output, covariance, known: BTreeMap::new() }
    }

    /// Returns the variance of a weighted sum of samples under all noise.
    pub fn variance(&mut self, places: &[SamplePlace], weights: &[f64]) -> f64 {
        let periods = places.last().map_or(0, |last| last.period + 1);
        let mut rows = self.period_rows(places, weights).into_iter().rev().peekable();
        let (mut ahead, mut sum) = (RowDVector::zeros(self.noisy.a.nrows()), 0.0);
        for period in (0..periods).rev() {
            let own = rows.next_if(|(at, _)| *at == period).map(|(_, row)| row);
            let [state, drawn] = self.carried(own.as_ref(), &ahead);
            sum += drawn.norm_squared();
            ahead = state;
        }
        sum + (&ahead * &self.covariance).dot(&ahead)
    }

    /// Returns the variance of each sample less the mean of all under all noise.
    pub fn variances_about_mean(&mut self, places: &[SamplePlace]) -> Vec<f64> {
        let order = self.noisy.a.nrows();
        let weights = vec![1.0 / places.len() as f64; places.len()];
        let rows: BTreeMap<usize, RowDVector<f64>> = self.period_rows(places, &weights).into_iter().collect();
        let periods = places.last().map_or(0, |last| last.period + 1);
        // Of each period, the mean's row over its states and its draws, by the samples from then on.
        let mut ahead = vec![[RowDVector::zeros(order), RowDVector::zeros(0)]; periods + 1];
        let mut variance = 0.0;
        for period in (0..periods).rev() {
            ahead[period] = self.carried(rows.get(&period), &ahead[period + 1][0]);
            variance += ahead[period][1].norm_squared();
        }
        variance += (&ahead[0][0] * &self.covariance).dot(&ahead[0][0]);
        // Covariance of the states at the start of a period with the part of the mean before it.
        let mut before = DVector::zeros(order);
        let mut found = Vec::with_capacity(places.len());
        let mut next = places.iter().peekable();
        for period in 0..periods {
            let [state, drawn] = &ahead[period];
            let with = &before + &self.covariance * state.transpose();
            while let Some(place) = next.next_if(|place| place.period == period) {
                let row = self.row(place.time);
                let (own, own_drawn) = row.columns_range_pair(..order, order..);
                let covariance = (own * &with)[0] + own_drawn.dot(drawn);
                let square = (own * &self.covariance).dot(&own) + own_drawn.norm_squared();
                found.push((square + variance - 2.0 * covariance).max(0.0));
            }
            if let Some(row) = rows.get(&period) {
                let (own, own_drawn) = row.columns_range_pair(..order, order..);
                before += &self.covariance * own.transpose();
                before = &self.noisy.a * before + &self.noisy.g * own_drawn.transpose();
            } else {
                before = &self.noisy.a * before;
            }
        }
        found
    }

    /// Returns a period's row over its states and its draws, whose later periods have the row `ahead` over the states at
    /// its end.
    fn carried(&self, own: Option<&RowDVector<f64>>, ahead: &RowDVector<f64>) -> [RowDVector<f64>; 2] {
        let (mut state, mut drawn) = (ahead * &self.noisy.a, ahead * &self.noisy.g);
        if let Some(row) = own {
            state += row.columns_range(..state.len());
            drawn += row.columns_range(state.len()..);
        }
        [state, drawn]
    }

    /// Returns the weighted sum of the rows of the samples in each period that has any.
    fn period_rows(&mut self, places: &[SamplePlace], weights: &[f64]) -> Vec<(usize, RowDVector<f64>)> {
        let mut found: Vec<(usize, RowDVector<f64>)> = Vec::new();
        for (place, weight) in places.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let row = self.row(place.time) * *weight;
            match found.last_mut() {
                Some((period, sum)) if *period == place.period => *sum += row,
                _ => found.push((place.period, row)),
            }
        }
        found
    }

    /// Returns the row of the output at a time of the period (fs).
    fn row(&mut self, time: i64) -> RowDVector<f64> {
        if let Some(row) = self.known.get(&time) {
            return row.clone();
        }
        let row: RowDVector<f64> = self.noisy.motion.rows_at_ticks(&[self.output], time).row(0).into();
        if self.known.len() < MOST_KEPT {
            self.known.insert(time, row.clone());
        }
        row
    }
}
