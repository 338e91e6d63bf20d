//! Interpolation of the motion between the rows of a log, by cubics through the values and the rates of both rows.

use super::motion::MotionData;

/// Largest number of points between two rows.
const MOST: usize = 12;
/// Intended phase of the fastest mode between two points (rad).
const TURN: f64 = 0.2;
/// Phase of a mode between two rows (rad) above which cubics do not approximate it.
const FAST: f64 = 2.0;

impl MotionData {
    /// Adds points between rows that are at most a period apart (s), if the fastest mode (rad/s) allows it. With a
    /// switching law, every switching has a row, so that the motion between rows is smooth.
    pub fn smoothed(&mut self, period: f64, fastest: f64) {
        let turn = period * fastest;
        if turn > FAST || self.time.len() < 2 || self.rate.len() < self.time.len() {
            return;
        }
        let points = if fastest > 0.0 { ((turn / TURN).ceil() as usize).clamp(1, MOST) } else { MOST };
        // New rows: the index of a row, and the fraction of the way to the next.
        let rows: Vec<(usize, f64)> = (0..self.time.len())
            .flat_map(|row| {
                let h = self.time.get(row + 1).map_or(0.0, |next| next - self.time[row]);
                let count = if h > 0.0 && h <= 1.000_001 * period { points } else { 1 };
                (0..count).map(move |point| (row, point as f64 / count as f64))
            })
            .collect();
        let time = &self.time;
        let straight = |values: &[f64]| -> Vec<f64> {
            let value_at = |(row, part): &(usize, f64)| match values.get(row + 1) {
                Some(next) if *part > 0.0 => values[*row] + part * (next - values[*row]),
                _ => values[*row],
            };
            if values.len() < time.len() { values.to_vec() } else { rows.iter().map(value_at).collect() }
        };
        let cubic = |x: &[f64], v: &[f64]| -> [Vec<f64>; 2] {
            let value_at = |(row, p): &(usize, f64)| {
                let row = *row;
                if *p == 0.0 {
                    return (x[row], v[row]);
                }
                let (h, q) = (time[row + 1] - time[row], 1.0 - p);
                let (a, b, da, db) = (x[row], x[row + 1], v[row], v[row + 1]);
                let value =
                    q * q * (1.0 + 2.0 * p) * a + p * p * (1.0 + 2.0 * q) * b + h * p * q * (q * da - p * db);
                let rate = 6.0 * p * q * (b - a) / h + q * (1.0 - 3.0 * p) * da + p * (3.0 * p - 2.0) * db;
                (value, rate)
            };
            let (values, rates) = rows.iter().map(value_at).unzip();
            [values, rates]
        };
        let [angle, rate] = cubic(&self.angle, &self.rate);
        let whole = self.modes.iter().chain(&self.mode_rates).all(|column| column.len() >= time.len());
        let mut modes = Vec::new();
        let mut mode_rates = Vec::new();
        if whole && self.modes.len() == self.mode_rates.len() {
            for (x, v) in self.modes.iter().zip(&self.mode_rates) {
                let [x, v] = cubic(x, v);
                modes.push(x);
                mode_rates.push(v);
            }
        }
        let elastic = if modes.is_empty() {
            straight(&self.elastic)
        } else {
            (0..rows.len()).map(|row| modes.iter().map(|mode| mode[row]).sum()).collect()
        };
        let goal = straight(&self.goal);
        let torques = self.torques.each_ref().map(|column| straight(column));
        let wheel = self.wheel.each_ref().map(|column| straight(column));
        let outputs = self.outputs.iter().map(|column| straight(column)).collect();
        self.time = straight(time);
        (self.angle, self.rate, self.elastic) = (angle, rate, elastic);
        (self.modes, self.mode_rates) = (modes, mode_rates);
        (self.goal, self.torques, self.wheel, self.outputs) = (goal, torques, wheel, outputs);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_are_met_between_rows_and_rows_stay() {
        let time: Vec<f64> = (0..40).map(|i| 2.0 * f64::from(i)).collect();
        let values_of = |f: fn(f64) -> f64| -> Vec<f64> { time.iter().map(|t| f(0.4 * t)).collect() };
        let rate: Vec<f64> = values_of(f64::cos).iter().map(|c| 0.4 * c).collect();
        let mut motion = MotionData {
            angle: values_of(f64::sin),
            rate: rate.clone(),
            elastic: values_of(f64::sin),
            modes: vec![values_of(f64::sin)],
            mode_rates: vec![rate],
            time: time.clone(),
            ..MotionData::default()
        };
        motion.smoothed(2.0, 0.4);
        assert_eq!(motion.time.len(), 39 * 4 + 1);
        for (row, t) in motion.time.iter().enumerate() {
            assert!((motion.angle[row] - (0.4 * t).sin()).abs() < 2e-3, "{t}");
            assert!((motion.rate[row] - 0.4 * (0.4 * t).cos()).abs() < 4e-3, "{t}");
            assert!((motion.elastic[row] - (0.4 * t).sin()).abs() < 2e-3, "{t}");
        }
        assert!(time.iter().all(|t| motion.time.contains(t)));
        // Gaps, and modes that are too fast for the rows, are not interpolated.
        let mut gap = MotionData {
            time: vec![0.0, 9.0],
            angle: vec![0.0, 1.0],
            rate: vec![0.0, 0.0],
            ..MotionData::default()
        };
        gap.smoothed(2.0, 0.4);
        assert_eq!(gap.time, [0.0, 9.0]);
        gap.smoothed(9.0, 3.0);
        assert_eq!(gap.time, [0.0, 9.0]);
    }
}
