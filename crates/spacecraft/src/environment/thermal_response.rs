//! Level of thermal bending: a first-order response to the part of the Sun's disc in view.
//!
//! Where the part in view f varies, between t0 and t1, level and f are tabulated at equal steps of the angle p with
//! t = t0 + (t1 - t0) (1 - cos p)/2, in which both are smooth though f starts and ends like the power 3/2 of time. Between
//! the nodes of the table the level is the cubic of the values and slopes there.

use std::f64::consts::PI;

use super::OrbitEnvironment;
use super::deferred::Deferred;

/// Number of intervals of a table.
const INTERVALS: usize = 64;

/// Level of the thermal bending with one time constant.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ThermalResponse {
    /// Time constant (s).
    time_constant: f64,
    /// Pieces of the run between edges of the shadow, in order.
    pieces: Deferred<Vec<Piece>>,
}

/// Level from an edge of the shadow to the next.
#[derive(Clone, Debug, PartialEq)]
struct Piece {
    /// Start (s).
    from: f64,
    /// Level at the start.
    level: f64,
    target: Target,
}

/// Target that a level approaches during a piece.
#[derive(Clone, Debug, PartialEq)]
enum Target {
    /// Constant target.
    Constant(f64),
    /// Target that varies for this duration (s): level and target at the nodes of the table.
    Varying(f64, Vec<[f64; 2]>),
}

impl ThermalResponse {
    /// Creates the response with a time constant (s).
    pub fn new(time_constant: f64) -> Self {
        Self { time_constant, pieces: Deferred::default() }
    }

    /// Returns the level at a time since the start (s) under a sky, relative to that at the start, at which the level is
    /// steady.
    pub fn level(&self, sky: &OrbitEnvironment, t: f64) -> f64 {
        let pieces = self.pieces.get_or(|| self.pieces(sky));
        let past = pieces.partition_point(|piece| piece.from <= t);
        past.checked_sub(1).map_or(0.0, |last| self.level_in(&pieces[last], t))
    }

    fn pieces(&self, sky: &OrbitEnvironment) -> Vec<Piece> {
        let start = sky.part_in_view(0.0);
        let mut edges: Vec<f64> = sky.shadow_edges().map(flexsc_numerics::time::Instant::seconds).collect();
        if edges.first().is_none_or(|first| *first > 0.0) {
            edges.insert(0, 0.0);
        }
        let mut pieces = Vec::new();
        let mut level = 0.0;
        for (index, from) in edges.iter().enumerate() {
            let to = edges.get(index + 1).copied();
            // After the last edge the target stays, as the run ends before the next.
            let middle = to.map_or(from + 1e-6, |to| 0.5 * (from + to));
            let part = sky.part_in_view(middle);
            let target = match to.filter(|_| part > 0.0 && part < 1.0) {
                Some(to) => Target::Varying(
                    to - from,
                    self.table([*from, to], level, |t| sky.part_in_view(t) - start),
                ),
                None => Target::Constant(part - start),
            };
            let piece = Piece { from: *from, level, target };
            level = to.map_or(level, |to| self.level_in(&piece, to));
            pieces.push(piece);
        }
        pieces
    }

    /// Returns level and target at the nodes of an interval.
    fn table(&self, [from, to]: [f64; 2], level: f64, target: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let node = |index: usize| {
            let part = libm::sin(0.5 * PI * index as f64 / INTERVALS as f64);
            from + (to - from) * part * part
        };
        let mut nodes = vec![[level, target(from)]];
        for index in 0..INTERVALS {
            let ([start, end], [level, before]) = ([node(index), node(index + 1)], nodes[index]);
            let [middle, after] = [0.5 * (start + end), end].map(&target);
            // Parabola of the target in the part of the interval that has passed.
            let curve = 2.0 * (before - 2.0 * middle + after);
            let [unit, linear, square] = responses((end - start) / self.time_constant);
            let driven = before * unit + (after - before - curve) * linear + curve * square;
            nodes.push([level * (1.0 - unit) + driven, after]);
        }
        nodes
    }

    fn level_in(&self, piece: &Piece, t: f64) -> f64 {
        match &piece.target {
            Target::Constant(aim) => {
                aim + (piece.level - aim) * libm::exp((piece.from - t) / self.time_constant)
            }
            Target::Varying(length, nodes) => {
                let past = ((t - piece.from) / length).clamp(0.0, 1.0);
                let angle = libm::acos(1.0 - 2.0 * past) * (INTERVALS as f64 / PI);
                let index = (angle as usize).min(INTERVALS - 1);
                let u = angle - index as f64;
                // Slopes by the part of the interval of the angle.
                let slope = |node: usize| {
                    let [level, target] = nodes[node];
                    let pace = 0.5 * length * libm::sin(PI * node as f64 / INTERVALS as f64);
                    (target - level) / self.time_constant * pace * (PI / INTERVALS as f64)
                };
                let ([a, _], [b, _]) = (nodes[index], nodes[index + 1]);
                let (da, db, v) = (slope(index), slope(index + 1), 1.0 - u);
                v * v * (a * (1.0 + 2.0 * u) + da * u) + u * u * (b * (1.0 + 2.0 * v) - db * v)
            }
        }
    }
}

/// Returns the responses, after an interval of z time constants, to the targets 1, s and s² with s from 0 to 1.
fn responses(z: f64) -> [f64; 3] {
    let unit = -libm::expm1(-z);
    if z > 1.0 {
        let linear = 1.0 - unit / z;
        return [unit, linear, 1.0 - 2.0 * linear / z];
    }
    // Series z k! sum (-z)^j/(k + j + 1)! without cancellation.
    let series = |k: f64| {
        let (mut term, mut sum) = (z / (k + 1.0), 0.0);
        for j in 1..20 {
            sum += term;
            term *= -z / (k + 1.0 + f64::from(j));
        }
        sum
    };
    [unit, series(1.0), series(2.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::Environment;
    use flexsc_numerics::time::Span;

    fn sky(text: &str) -> OrbitEnvironment {
        let around: Environment = flexsc_formats::document::from_text(text).unwrap();
        OrbitEnvironment::new(&around, Span::from_seconds(9000.0), None)
    }

    #[test]
    fn responses_to_powers_are_their_integrals() {
        for z in [1e-6, 0.3, 0.999, 1.001, 7.0, 1e3] {
            let found = responses(z);
            // The differential equation y' = z (s^k - y), by differences of the response at s = 1: y' = 0 for k = 0 with
            // y = 1 - exp(-z), and for k > 0 y_k = 1 - k y_{k-1}/z.
            assert!((found[0] + libm::exp(-z) - 1.0).abs() < 1e-15);
            assert!((z * (1.0 - found[1]) - found[0]).abs() < 1e-12 * z.max(1.0), "{z}");
            assert!((z * (1.0 - found[2]) - 2.0 * found[1]).abs() < 1e-12 * z.max(1.0), "{z}");
        }
    }

    /// Reference: Runge-Kutta steps of the fourth order, of 1 ms, between the edges.
    #[test]
    fn levels_follow_the_part_in_view() {
        for shape in ["cone", "cylinder"] {
            for angle in [0.5, 1.17, 1.19] {
                let sky = sky(&format!(
                    "orbit = {{ semi_major_axis = 6.878137e6, anomaly = 1.0 }}\nshadow = \"{shape}\"\nsun = [{}, 0, {}]",
                    libm::cos(angle),
                    libm::sin(angle)
                ));
                for time_constant in [0.5, 5.0, 300.0] {
                    let response = ThermalResponse::new(time_constant);
                    let start = sky.part_in_view(0.0);
                    let slope = |t: f64, level: f64| (sky.part_in_view(t) - start - level) / time_constant;
                    let edges = sky.shadow_edges().map(flexsc_numerics::time::Instant::seconds);
                    let (mut t, mut level, mut worst) = (0.0, 0.0, 0.0_f64);
                    for edge in edges.filter(|edge| *edge < 2600.0).chain([2600.0]) {
                        let steps = libm::ceil((edge - t) / 0.02).max(1.0);
                        let h = (edge - t) / steps;
                        for step in 0..steps as u32 {
                            let t = t + h * f64::from(step);
                            let a = slope(t, level);
                            let b = slope(t + 0.5 * h, level + 0.5 * h * a);
                            let c = slope(t + 0.5 * h, level + 0.5 * h * b);
                            let d = slope(t + h * (1.0 - 1e-6), level + h * c);
                            level += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
                            worst = worst.max((response.level(&sky, t + h) - level).abs());
                        }
                        t = edge;
                    }
                    assert!(worst < 1e-6, "{shape} {angle} {time_constant}: {worst:e}");
                }
            }
        }
    }
}
