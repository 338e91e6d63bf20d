//! Metrics of the rotations in the lanes of a batch, equal to those of single runs; bounds decide for all lanes at once
//! where they can.

use flexsc_numerics::lanes::{LaneFloat, Mask};
use flexsc_numerics::polynomial::TERMS;
use flexsc_numerics::polynomial_lanes::Polynomials;

use super::{ManoeuvreMetrics, integral};
use crate::metrics::MetricsCollector;

/// Piece of motion in each lane that has ended: one piece of each run.
#[derive(Debug)]
pub struct LanePiece<'a, R> {
    /// Start of the piece (s).
    pub from: R,
    /// Length of the piece (s).
    pub length: R,
    /// Taylor series of the coordinates of all lanes, ordered by terms.
    pub series: &'a [R],
    /// Number of coordinates.
    pub count: usize,
    /// Actuator torque without the back-EMF (N m).
    pub constant: R,
    /// Back-EMF for each unit of the rate (N m s), and true if it acts on the rate with the elastic part.
    pub back_emf: (R, bool),
    /// Torque commanded by the law (N m).
    pub feedback: R,
    /// Lanes whose motion counts.
    pub counts: &'a [bool],
}

/// Collector of the motions of runs in lanes, towards angle 0 from the start on.
#[derive(Clone, Debug)]
pub struct LaneManoeuvreMetrics<R> {
    torque: R,
    feedback: R,
    error: R,
    itae: (R, R),
}

impl<R: LaneFloat> LaneManoeuvreMetrics<R> {
    /// Creates an empty collector.
    #[inline(always)]
    pub fn new(kind: R) -> Self {
        let zero = kind.splat(0.0);
        Self { torque: zero, feedback: zero, error: zero, itae: (zero, zero) }
    }

    /// Records a piece of the motion of each run.
    #[inline(always)]
    pub fn observe(&mut self, runs: &mut [MetricsCollector], passed: &LanePiece<'_, R>) {
        let LanePiece { from, length, series, count, .. } = *passed;
        let zero = from.splat(0.0);
        let mut flags = [0.0; 16];
        for lane in 0..R::LANES {
            flags[lane] = f64::from(u8::from(passed.counts[lane]));
        }
        let counts = zero.lt(zero.load(&flags));
        let (mut angle, mut rigid) = ([zero; TERMS], [zero; TERMS]);
        for n in 0..series.len() / count {
            rigid[n] = series[n * count];
            angle[n] = rigid[n];
            for index in 1..count {
                angle[n] = angle[n] + series[n * count + index];
            }
        }
        let mut applied = [zero; TERMS];
        applied[0] = passed.constant;
        let (back_emf, total) = passed.back_emf;
        for n in 0..TERMS - 1 {
            let sensed = if total { angle[n + 1] } else { rigid[n + 1] };
            applied[n] = applied[n] - back_emf * (n + 1) as f64 * sensed;
        }
        let applied = Polynomials::new(&applied, length);
        self.torque = peak(&applied, self.torque, counts);
        self.feedback = R::select(counts, passed.feedback.abs().max(self.feedback), self.feedback);
        let error = Polynomials::new(&angle, length);
        self.error = peak(&error, self.error, counts);
        let [plain, weighted] = error.integrals();
        let mut area = (length * (from * plain + length * weighted)).abs();
        let inputs = [error.bounds().0, error.bounds().1, error.at(0.5), angle[0], from, length];
        let mut all = [[0.0; 16]; 6];
        for index in 0..6 {
            inputs[index].store(&mut all[index]);
        }
        for lane in 0..R::LANES {
            if !passed.counts[lane] {
                continue;
            }
            let Some(run) = runs[lane].rotation() else { continue };
            let [low, high, middle, start, begins, lasts] =
                [all[0][lane], all[1][lane], all[2][lane], all[3][lane], all[4][lane], all[5][lane]];
            if low < 0.0 && high > 0.0 {
                area = area.with_lane(lane, integral(&error.lane(lane), begins, lasts));
            }
            let verdict = run.judge(start);
            let band = verdict.band();
            if low > band || high < -band {
                if middle.abs() > band {
                    verdict.add_outside(begins + lasts * 0.0, begins + lasts * 1.0);
                }
            } else if !(low >= -band && high <= band) {
                verdict.observe(begins, lasts, &error.lane(lane));
            }
            let late = (run.late - begins) / lasts;
            if late < 1.0 {
                let late_error = error.lane(lane);
                let part = if late > 0.0 { late_error.restrict(late, 1.0) } else { late_error };
                run.error.1 = part.magnitude(run.error.1.max(0.0));
            }
        }
        let more = area - self.itae.1;
        let total = self.itae.0 + more;
        let lost = (total - self.itae.0) - more;
        self.itae = (R::select(counts, total, self.itae.0), R::select(counts, lost, self.itae.1));
    }

    /// Writes the results to the collector of each run.
    pub fn hand_over(self, runs: &mut [MetricsCollector]) {
        for (lane, run) in runs.iter_mut().enumerate() {
            if let Some(run) = run.rotation() {
                run.torque = (self.torque.lane(lane), self.feedback.lane(lane));
                run.error.0 = self.error.lane(lane);
                run.itae = (self.itae.0.lane(lane), self.itae.1.lane(lane));
            }
        }
    }
}

/// Returns the largest absolute values in the lanes that count, computed lane by lane where bounds do not decide.
#[inline(always)]
fn peak<R: LaneFloat>(polynomials: &Polynomials<R>, floor: R, counts: R::Mask) -> R {
    let (mut best, certain) = polynomials.magnitude(floor);
    if !(certain | !counts).all() {
        let doubtful = R::select(certain | !counts, floor.splat(0.0), floor.splat(1.0));
        for lane in 0..R::LANES {
            if doubtful.lane(lane) > 0.0 {
                best = best.with_lane(lane, polynomials.lane(lane).magnitude(floor.lane(lane)));
            }
        }
    }
    R::select(counts, best, floor)
}

impl ManoeuvreMetrics {
    /// Returns true if the goal is angle 0 from the start on, and no coordinates are observed.
    pub fn needs_angle_only(&self) -> bool {
        self.outputs.is_empty() && !self.planned && self.goal == flexsc_control::law::Setpoint::default()
    }
}
