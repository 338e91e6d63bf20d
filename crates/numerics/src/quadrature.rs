//! Gauss-Legendre quadrature of functions that are smooth between breaks.

/// Number of nodes of a panel: exact to degree 31.
const NODES: usize = 16;

/// Maximum length of a panel of [`nodes`], in radians of the fastest motion.
const TURN: f64 = 16.0;

/// Maximum error of the mean over a panel of [`nodes`], relative to the amplitude of an oscillation.
const LEFT: f64 = 1e-15;

/// Nodes from 0 on of the rule of Gauss and Kronrod, with their weights and those of Gauss' rule.
const KRONROD: [[f64; 3]; 8] = [
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
    [0.949_107_912_342_758_5, 0.063_092_092_629_978_56, 0.129_484_966_168_869_7],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_19, 0.0],
    [0.741_531_185_599_394_5, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
    [0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9],
    [0.207_784_955_007_898_47, 0.204_432_940_075_298_89, 0.0],
    [0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4],
];

/// Returns the integral of `f(middle, t)` over the pieces between breaks, where `middle` is a time inside the piece
/// that contains t. Panels are at most `panel` long; over a panel of four radians the integral is exact to rounding.
pub fn integral(breaks: &[f64], panel: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    let rule = rule();
    let mut total = 0.0;
    for ends in breaks.windows(2) {
        let (from, length) = (ends[0], ends[1] - ends[0]);
        let middle = from + 0.5 * length;
        let count = (length / panel).ceil().clamp(1.0, 1e5) as usize;
        let half = 0.5 * length / count as f64;
        for i in 0..count {
            let centre = from + half * (2 * i + 1) as f64;
            total += rule.iter().map(|(x, weight)| weight * f(middle, centre + half * x)).sum::<f64>() * half;
        }
    }
    total
}

/// Returns times and weights for an integral from 0 to `length` (s), the earliest first, for functions that change no
/// faster than `fastest` (rad/s): the mean of an oscillation errs by at most 1e-15 of its amplitude, or 1e-6 at twice
/// that frequency.
pub fn nodes(length: f64, fastest: f64) -> Vec<(f64, f64)> {
    let turn = length * fastest;
    let panels = (turn / TURN).ceil().clamp(1.0, 1e6);
    let half = 0.5 * length / panels;
    let count = enough(0.5 * turn / panels);
    let rule: Vec<(f64, f64)> = (0..count).rev().map(|i| node(count, i)).collect();
    let panel = |i: usize| {
        let centre = half * (2 * i + 1) as f64;
        rule.iter().map(move |(x, weight)| (centre + half * x, half * weight))
    };
    (0..panels as usize).flat_map(panel).collect()
}

/// Returns the nodes on [-1, 1] of the rule of Gauss and Kronrod with 15 nodes \[Piessens83\], each with its weight, and that of Gauss' rule
/// with 7 nodes among them, whose difference bounds the error.
pub fn kronrod() -> impl Iterator<Item = [f64; 3]> {
    let sides = |[node, fine, coarse]: [f64; 3]| {
        let other = (node > 0.0).then_some([-node, fine, coarse]);
        other.into_iter().chain([[node, fine, coarse]])
    };
    KRONROD.into_iter().flat_map(sides)
}

/// Returns the number of nodes that suffices for the mean of exp(i x s) over s in [-1, 1]: the error of n nodes is at
/// most 4^n n!^4 / ((2 n + 1) (2 n)!^3) times the derivative of order 2 n.
fn enough(x: f64) -> usize {
    let (mut remainder, mut n) = (1.0, 0.0);
    while remainder > LEFT && n < 2.0 * TURN {
        n += 1.0;
        let odd = 2.0 * n - 1.0;
        remainder *= x * x * n / (2.0 * (2.0 * n + 1.0) * odd * odd);
    }
    // Minimum for slowly varying accelerations.
    (n as usize).max(4)
}

/// Returns nodes and weights on [-1, 1], the last first.
fn rule() -> [(f64, f64); NODES] {
    std::array::from_fn(|i| node(NODES, i))
}

/// Returns root number `i` of the Legendre polynomial of degree `count`, by Newton's method, and its weight.
#[inline]
fn node(count: usize, i: usize) -> (f64, f64) {
    let n = count as f64;
    let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
    let mut slope = 1.0;
    for _ in 0..6 {
        let (mut before, mut value) = (1.0, x);
        for k in 2..=count {
            let k = k as f64;
            (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
        }
        slope = n * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_to_degree_31_and_four_radians_are_exact() {
        let power = |t: f64, n: i32| (0..n).fold(1.0, |p, _| p * t);
        assert!(
            (integral(&[0.0, 2.0], 9.0, |_, t| power(t, 31)) / (power(2.0, 32) / 32.0) - 1.0).abs() < 1e-13
        );
        let sine = integral(&[0.0, 1.0, 40.0], 4.0, |_, t| libm::sin(t));
        assert!((sine - (1.0 - libm::cos(40.0))).abs() < 1e-13);
    }

    #[test]
    fn both_rules_of_kronrod_are_exact_to_their_degrees() {
        let sum =
            |degree: i32, which: usize| kronrod().map(|node| node[which] * node[0].powi(degree)).sum::<f64>();
        for half in 0..=11 {
            let exact = 2.0 / f64::from(2 * half + 1);
            assert!((sum(2 * half, 1) - exact).abs() < 1e-15, "{half}");
            assert!((sum(2 * half, 2) - exact).abs() < 1e-15 || half > 6, "{half}");
        }
        assert_eq!(kronrod().count(), 15);
    }

    #[test]
    fn nodes_average_signals_up_to_their_band() {
        for turn in [0.0, 1e-3, 0.4, 2.0, 7.9, 15.9, 16.1, 40.0, 300.0] {
            let nodes = nodes(2.5, turn / 2.5);
            assert!(nodes.windows(2).all(|pair| pair[0].0 < pair[1].0), "{turn}");
            // Not many more than needed: about one per radian.
            assert!(nodes.len() as f64 <= 1.1 * turn + 7.0, "{turn} {}", nodes.len());
            let mean = |f: &dyn Fn(f64) -> f64| nodes.iter().map(|(t, w)| w * f(*t)).sum::<f64>() / 2.5;
            assert!((mean(&|_| 1.0) - 1.0).abs() < 1e-15 && (mean(&|t| t * t * t) - 3.90625).abs() < 1e-14);
            for (factor, tolerance) in [(0.3, 2e-15), (1.0, 2e-15), (2.0, 1e-6)] {
                let w = factor * turn / 2.5;
                if w == 0.0 {
                    continue;
                }
                let exact = libm::cos(1.25 * w + 0.3) * libm::sin(1.25 * w) / (1.25 * w);
                let off = mean(&|t| libm::cos(w * t + 0.3)) - exact;
                assert!(off.abs() < tolerance, "{turn} {factor}: {off:e}");
            }
        }
    }
}
