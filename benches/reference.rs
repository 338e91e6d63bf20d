//! The yardstick: \[Silaev\]'s case and nothing else, as one would write it by hand for speed.
//!
//! Two modes in local variables, f64 time, the platform's sine, no scenario, no record, no observer. The same exact
//! flow and the same certified search for crossings as the engine; and, for contrast, RK4 at a fixed step.

#![allow(clippy::disallowed_methods, reason = "the yardstick may use the platform's fastest sine")]
#![allow(clippy::needless_range_loop, reason = "indices keep the modes' arrays in step")]

/// The same case as a scenario: relay-quiet without its observer, switchings alone.
pub const EVENTS: &str = r"
duration = 20000.0
[body.planar]
angle = 4.5e-4
rate = 2.2e-5
modes = [
    { frequency = 0.44, gain = 0.0213, displacement = 2.75e-6 },
    { frequency = 0.755, gain = 0.0216 },
]
[law.relay]
dead_zone = 5e-4
hysteresis = 1e-4
strong = 4e-5
weak = 1e-6
k_t = 0.3389
";

/// Its observer, with 40 window means.
pub const WINDOWS: &str = "[estimator.envelope]\nwindow = 500.0\n";

const W: [f64; 2] = [0.44, 0.755];
const K: [f64; 2] = [0.0213, 0.0216];
const EPS: f64 = 5e-4;
const GAM: f64 = 1e-4;
const STRONG: f64 = 4e-5;
const WEAK: f64 = 1e-6;

#[derive(Copy, Clone)]
struct State {
    xb: f64,
    vb: f64,
    x: [f64; 2],
    y: [f64; 2],
}

const START: State = State { xb: 4.5e-4, vb: 2.2e-5, x: [2.75e-6, 0.0], y: [0.0, 0.0] };

/// One constant moment: centres, deviations and bounds.
struct Arc {
    from: State,
    m: f64,
    c: [f64; 2],
    d: [f64; 2],
    reach: f64,
    curvature: f64,
}

impl Arc {
    #[inline]
    fn new(from: State, m: f64) -> Self {
        let c = [K[0] * m / (W[0] * W[0]), K[1] * m / (W[1] * W[1])];
        let d = [from.x[0] - c[0], from.x[1] - c[1]];
        let r = [(d[0] * d[0] + from.y[0] * from.y[0]).sqrt(), (d[1] * d[1] + from.y[1] * from.y[1]).sqrt()];
        let curvature = m.abs() + W[0] * W[0] * r[0] + W[1] * W[1] * r[1];
        Self { from, m, c, d, reach: r[0] + r[1], curvature }
    }

    #[inline]
    fn at(&self, h: f64) -> (State, f64, f64) {
        let mut s = self.from;
        s.xb += h * (s.vb + 0.5 * self.m * h);
        s.vb += self.m * h;
        let (mut angle, mut rate) = (s.xb, s.vb);
        for i in 0..2 {
            let (sin, cos) = (W[i] * h).sin_cos();
            let y = self.from.y[i];
            s.x[i] = self.c[i] + self.d[i] * cos + y * sin;
            s.y[i] = y * cos - self.d[i] * sin;
            angle += s.x[i];
            rate += W[i] * s.y[i];
        }
        (s, angle, rate)
    }

    /// A first jump: until then the rigid parabola with both modes at full swing stays short of the level.
    #[inline]
    fn jump(&self, side: f64, level: f64) -> f64 {
        let gap = side * (level - self.from.xb - self.c[0] - self.c[1]) - self.reach;
        if gap <= 0.0 {
            return 0.0;
        }
        let (v, m) = (side * self.from.vb, side * self.m);
        let disc = v * v + 2.0 * m * gap;
        if disc < 0.0 || (v <= 0.0 && m <= 0.0) {
            return f64::INFINITY;
        }
        if v > 0.0 { 2.0 * gap / (v + disc.sqrt()) } else { (disc.sqrt() - v) / m }
    }

    #[inline]
    fn stride(&self, gap: f64, speed: f64) -> f64 {
        let root = (speed * speed + 2.0 * self.curvature * gap).sqrt();
        if speed > 0.0 { 2.0 * gap / (speed + root) } else { (root - speed) / self.curvature }
    }

    /// The first crossing of one of the levels, each with its side.
    #[inline]
    fn locate(&self, levels: &[(f64, f64)], limit: f64) -> Option<(f64, usize, State)> {
        let mut h = levels.iter().map(|&(side, level)| self.jump(side, level)).fold(f64::INFINITY, f64::min);
        loop {
            if h > limit {
                return None;
            }
            let (state, angle, rate) = self.at(h);
            let mut stride = f64::INFINITY;
            for (index, &(side, level)) in levels.iter().enumerate() {
                let gap = side * (level - angle);
                if gap <= 0.0 {
                    return Some((h, index, state));
                }
                stride = stride.min(self.stride(gap, side * rate));
            }
            let next = h + stride;
            h = if next > h { next } else { h.next_up() };
        }
    }
}

/// Events only: how many switchings there are until `end`, and the time of the last.
pub fn exact(k_t: f64, end: f64) -> (u32, f64) {
    const COAST: [(f64, f64); 2] = [(1.0, EPS), (-1.0, -EPS)];
    let (mut state, mut t, mut events, mut m) = (START, 0.0, 0, WEAK);
    loop {
        let Some((h, side, state_there)) = Arc::new(state, m).locate(&COAST, end - t) else {
            return (events, t);
        };
        (state, t, events) = (state_there, t + h, events + 1);
        let s = if side == 0 { 1.0 } else { -1.0 };
        let back = [(-s, s * (EPS - GAM))];
        let Some((h, _, state_there)) = Arc::new(state, -s * STRONG).locate(&back, end - t) else {
            return (events, t);
        };
        (state, t, events) = (state_there, t + h, events + 1);
        let brake = k_t * h;
        if t + brake > end {
            return (events, t);
        }
        state = Arc::new(state, s * STRONG).at(brake).0;
        (t, events) = (t + brake, events + 1);
        m = s * WEAK;
    }
}

/// The same with RK4 at a fixed step, switching at the first step past a level.
pub fn rk4(k_t: f64, end: f64, step: f64) -> u32 {
    type V = [f64; 6];
    let field = |v: &V, m: f64| -> V {
        [v[1], m, v[3], K[0] * m - W[0] * W[0] * v[2], v[5], K[1] * m - W[1] * W[1] * v[4]]
    };
    let along = |v: &V, d: &V, h: f64| -> V { std::array::from_fn(|i| v[i] + h * d[i]) };
    let mut v: V = [START.xb, START.vb, START.x[0], 0.0, 0.0, 0.0];
    let (mut events, mut m, mut side, mut phase) = (0, WEAK, 0.0, 0);
    let (mut pushed, mut until) = (0.0, 0.0);
    for index in 0..(end / step) as u64 {
        let t = index as f64 * step;
        let x = v[0] + v[2] + v[4];
        let before = phase;
        match phase {
            0 if x >= EPS || x <= -EPS => (side, phase, pushed) = (x.signum(), 1, t),
            1 if side * x <= EPS - GAM => (phase, until) = (2, t + k_t * (t - pushed)),
            2 if t >= until => phase = 0,
            _ => {}
        }
        if phase != before {
            events += 1;
            m = side * [WEAK, -STRONG, STRONG][phase];
        }
        let a = field(&v, m);
        let b = field(&along(&v, &a, 0.5 * step), m);
        let c = field(&along(&v, &b, 0.5 * step), m);
        let d = field(&along(&v, &c, step), m);
        for i in 0..6 {
            v[i] += step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        }
    }
    events
}
