//! The sampled loop of the wheel-controlled spacecraft: spectral radii, angles, settling times, maps.
//!
//! Golden numbers: tests/golden/loop_oracle.py, NumPy and SciPy.

use flexsc_core::Scenario;
use flexsc_core::analysis::sampled_loop::{DiscretePlant, Gains, SampledLoop, Scaling, SettlingWindow, map};
use flexsc_core::control::law::Differentiation;

use crate::study::{close, pairs};
use crate::util::Dir;

/// The set that reproduces the papers' settling times: they print neither wheel nor period.
pub const FITTED: &str = r#"duration = 600.0
[body.planar]
angle = 0.06
modes = [
    { frequency = 0.3, gain = 1.44 }, { frequency = 0.8, gain = 0.21 },
    { frequency = 1.0, gain = 0.165 }, { frequency = 2.0, gain = 0.72 },
]
[actuator.wheel]
gain = 5e-4
back_emf = 1e-4
[law.pd]
k_p = 7.5
k_d = 275.0
period = 0.3
differentiation = "raw"
"#;

pub const WINDOW: SettlingWindow = SettlingWindow { band: 0.003, horizon: 2000.0 };
pub const GAINS: Gains = Gains { low: -2.0, high: 6.0, step: 0.05 };

pub fn fitted() -> SampledLoop {
    SampledLoop::from_scenario(&Scenario::parse("fitted.toml", FITTED).expect("valid")).expect("a loop").0
}

pub fn at(of: &SampledLoop, frequency: f64) -> DiscretePlant<'_> {
    DiscretePlant::new(of, &of.ratios(frequency, Scaling::All))
}

#[test]
fn angles_and_spectral_radii() {
    // (frequency of the first mode, gain of the extra loop, spectral radius, angle at 30, 60, 120, 180 s).
    let exact = [
        (
            0.3,
            0.0,
            0.998_961_065_6,
            [6.838_532_896_7e-3, -1.933_063_297_5e-2, 6.397_906_598_3e-3, -1.805_240_273_8e-3],
        ),
        (
            0.3,
            1.2,
            0.998_920_612_3,
            [9.607_692_169_1e-3, -2.234_195_376_3e-2, 8.361_338_192e-3, -2.900_655_940_7e-3],
        ),
        (
            0.2,
            0.0,
            0.998_917_952_4,
            [1.477_580_781_3e-2, -1.992_289_388e-2, 8.386_662_579_5e-3, -3.020_589_641_4e-3],
        ),
        (
            0.1,
            0.0,
            0.998_845_153_8,
            [1.022_409_979_1e-2, -1.091_753_117_1e-2, 5.065_223_561_3e-3, -1.183_326_714_8e-3],
        ),
        (
            0.05,
            0.0,
            0.999_786_614_5,
            [2.584_140_527_9e-3, 3.222_946_385_7e-3, -8.478_564_216_7e-3, 2.299_678_254_1e-3],
        ),
    ];
    let of = fitted();
    for (frequency, gain, radius, angles) in exact {
        let closed = at(&of, frequency).closed(gain);
        let ours = closed.spectral_radius();
        assert!((ours - radius).abs() < 1e-10, "{frequency}, {gain}: {ours}");
        let x = closed.angles(601);
        for (sample, angle) in [100, 200, 400, 600].into_iter().zip(angles) {
            assert!((x[sample] - angle).abs() < 1e-12, "{frequency}, {gain}, {sample}: {}", x[sample]);
        }
    }
    for (frequency, gain, radius) in [(0.1, 1.2, 0.999_100_528_6), (0.1, -0.5, 0.998_853_113_6)] {
        let ours = at(&of, frequency).closed(gain).spectral_radius();
        assert!((ours - radius).abs() < 1e-10, "{frequency}, {gain}: {ours}");
    }
}

#[test]
fn settling_times() {
    let of = fitted();
    // The last sample outside, and where the angle itself enters the band, from samples 100 times as dense.
    for (frequency, gain, horizon, sample, entry) in [
        (0.2, 0.0, 2000.0, 180.3, Some(180.513)),
        (0.15, 0.0, 2000.0, 196.5, None),
        (0.12, 0.0, 2000.0, 265.5, None),
        (0.1, 0.0, 2000.0, 351.0, None),
        (0.1, -0.5, 2000.0, 207.3, None),
        (0.05, 0.0, 2000.0, 1521.6, Some(1521.795)),
        // Samples after a shorter horizon do not count.
        (0.05, 0.0, 1500.0, 1421.4, Some(1421.67)),
        (0.1, 1.2, 600.0, 586.8, None),
        (0.1, 1.2, 2000.0, 807.0, None),
    ] {
        let settling = at(&of, frequency).closed(gain).settle(SettlingWindow { horizon, ..WINDOW });
        let (time, crossing) = (settling.time_s.expect("settled"), settling.crossing_s.expect("settled"));
        assert!((time - sample).abs() < 1e-9, "{frequency}, {gain}: {time}");
        assert!((0.0..0.3).contains(&(crossing - time)), "{time} {crossing}");
        // Dense samples come each 3 ms, and two decimals are known.
        assert!(entry.is_none_or(|entry| (crossing - entry).abs() < 0.008), "{crossing}");
    }
    // A loop that is outside the band at the horizon has not settled.
    let closed = at(&of, 0.05).closed(0.0);
    assert_eq!(closed.settle(SettlingWindow { horizon: 1521.6, ..WINDOW }).time_s, None);
    assert!(closed.settle(SettlingWindow { horizon: 1521.9, ..WINDOW }).time_s.is_some());
    assert_eq!(closed.settle(SettlingWindow { band: 0.07, ..WINDOW }).time_s, Some(0.0));
    assert_eq!(closed.settle(SettlingWindow { band: 0.07, ..WINDOW }).crossing_s, Some(0.0));
}

#[test]
fn the_slowest_pair_envelops_what_is_left() {
    let of = fitted();
    let closed = at(&of, 0.05).closed(0.0);
    let slowest = closed.slowest(0.003).expect("eigenvalues");
    close(slowest.radius, closed.spectral_radius(), 1e-14);
    // Late in the run nothing else is left: the largest angle of a swing touches the envelope.
    let x = closed.angles(6000);
    let left = |k: usize| slowest.amplitude_rad * slowest.radius.powf(k as f64);
    let touched = (5000..6000).map(|k| x[k].abs() / left(k)).fold(0.0, f64::max);
    assert!((touched - 1.0).abs() < 2e-3, "{touched}");
    // The envelope bounds the settling time, and is within half a swing of it.
    let (time, bound) = (closed.settle(WINDOW).time_s.expect("settled"), slowest.settling_s.expect("stable"));
    let swing = 0.3 * std::f64::consts::PI / slowest.turn_rad.abs();
    assert!(time <= bound && bound < time + swing, "{time} {bound} {swing}");
}

#[test]
fn the_integral_and_the_shaped_command() {
    let mut of = fitted();
    let x = at(&of, 0.2).closed(1.2).angles(6667);
    let itae: f64 = x.iter().enumerate().map(|(k, x)| 0.09 * k as f64 * x.abs()).sum();
    close(at(&of, 0.2).closed(1.2).settle(WINDOW).itae_rad_s2, itae, 1e-12);
    // A command that is never shaped, computed by the nonlinear path.
    let scenario = |set: &str| {
        let text = FITTED.replace("[law.pd]", &format!("{set}\n[law.pd]"));
        SampledLoop::from_scenario(&Scenario::parse("shaped.toml", &text).expect("valid")).expect("a loop").0
    };
    let idle = scenario("limit = 1e9");
    for (shaped, linear) in pairs(at(&idle, 0.2).closed(1.2).angles(6667).iter(), &x) {
        assert!((shaped - linear).abs() < 1e-13);
    }
    // A dead zone leaves what a command within it would have moved: u never answers angles of less than 1e-4/7.5 rad.
    let dead = at(&scenario("dead_zone = 0.05"), 0.2).closed(0.0).angles(6667);
    let late = |x: &[f64]| x[6000..].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    assert!(late(&x) < 1e-5 && late(&dead) > 1e-3, "{:e} {:e}", late(&x), late(&dead));
    // A limit slows the start: the rate cannot grow beyond b limit t.
    of = scenario("limit = 0.1");
    let limited = at(&of, 0.2).closed(0.0).angles(11);
    assert!((limited[10] - 0.06).abs() < 5e-4 * 0.1 * 3.535 * 4.5 * 1.01);
}

#[test]
fn delays() {
    let of = fitted();
    // One period late is the same, whether the loop says so or the state holds the command.
    let late = |delay: f64| SampledLoop { delay, ..of.clone() };
    let one = late(0.3);
    let closed = DiscretePlant::new(&one, &[1.0; 4]).closed(0.5);
    assert_eq!(closed.free.nrows(), 12);
    let (x, y) = (closed.angles(50), DiscretePlant::new(&of, &[1.0; 4]).closed(0.5).angles(50));
    assert_eq!(x[1].to_bits(), x[0].to_bits());
    assert!((x[1] - y[1]).abs() > 1e-6);
    // A part of a period: so close to none, or to a whole one, it is nearly that.
    for (delay, like) in [(1e-6, &y), (0.3 - 1e-6, &x), (0.3 + 1e-6, &x)] {
        let late = late(delay);
        let angles = DiscretePlant::new(&late, &[1.0; 4]).closed(0.5).angles(50);
        assert!(pairs(angles.iter(), like.iter()).all(|(a, b)| (a - b).abs() < 1e-7), "{delay}");
    }
    // Halved periods with every second sample: a delay of half a period, by hand.
    let half = late(0.15);
    let fine = late(0.0);
    let fine = SampledLoop { period: 0.15, ..fine };
    let step = DiscretePlant::new(&fine, &[1.0; 4]).closed(0.0);
    let x = DiscretePlant::new(&half, &[1.0; 4]).closed(0.0).angles(40);
    let mut state = step.start.clone();
    let (mut last, mut u) = ((&step.angle * &state).x, 0.0);
    for angle in x {
        let y = (&step.angle * &state).x;
        assert!((y - angle).abs() < 1e-14);
        state = &step.free * &state + &step.forced * u;
        u = -(7.5 * y + 275.0 * (y - last));
        last = y;
        state = &step.free * &state + &step.forced * u;
    }
}

#[test]
fn the_lower_edge_of_stability() {
    // y keeps the sign of the dominant mode's displacement down to 1 + gain = 0: on a grid of 0.1, -1 from 0.08 to 0.5
    // rad/s.
    let of = fitted();
    for (frequency, edge) in [(0.05, -0.9), (0.08, -1.0), (0.2, -1.0), (0.5, -1.0)] {
        let held = at(&of, frequency);
        let lowest =
            (-30..10).map(|n| 0.1 * f64::from(n)).find(|gain| held.closed(*gain).spectral_radius() < 1.0);
        assert!((lowest.expect("stable somewhere") - edge).abs() < 1e-9, "{frequency}: {lowest:?}");
        assert!(held.closed(59.9).spectral_radius() < 1.0);
    }
}

/// The longest period, on a grid of 0.05 s, up to which every loop is stable.
fn longest(of: &SampledLoop, frequency: f64, scaling: Scaling) -> f64 {
    let periods: Vec<f64> = (1..60).map(|n| 0.05 * f64::from(n)).collect();
    let cells = map(of, &[frequency], &periods, scaling, |_| 0.0, SettlingWindow { horizon: 1.0, ..WINDOW });
    let stable = cells.iter().take_while(|cell| cell.spectral_radius < 1.0).count();
    periods[stable.saturating_sub(1)]
}

#[test]
fn the_longest_periods() {
    let of = fitted();
    for (frequency, limit) in [(0.05, 1.95), (0.1, 1.75), (0.15, 1.4), (0.2, 1.1), (0.3, 0.75)] {
        let period = longest(&of, frequency, Scaling::All);
        assert!((period - limit).abs() < 1e-9, "{frequency}: {period}");
        let period = longest(&of, frequency, Scaling::First);
        assert!((period - 0.75).abs() < 1e-9, "{frequency}, others fixed: {period}");
    }
}

#[test]
fn a_band_of_frequencies_can_be_unstable() {
    // The exact rate, one sample late, slow samples and a wheel that damps as much as the law.
    let (period, back_emf, authority) = (14.0, 0.02, 1e-4);
    let of = SampledLoop {
        period,
        delay: period,
        back_emf,
        authority,
        differentiation: Differentiation::Exact,
        ..fitted()
    };
    let unstable: Vec<u32> = (50..=200)
        .step_by(5)
        .filter(|n| {
            let ratios = of.ratios(1e-3 * f64::from(*n), Scaling::First);
            DiscretePlant::new(&of, &ratios).closed(0.0).spectral_radius() >= 1.0
        })
        .collect();
    assert_eq!(unstable, (70..=155).step_by(5).collect::<Vec<_>>());
}

#[test]
fn a_map_is_its_cells() {
    let of = fitted();
    let (frequencies, periods) = ([0.1, 0.2, 0.3], [0.1, 0.3, 3.0, 0.7]);
    let window = SettlingWindow { horizon: 400.0, ..WINDOW };
    let gain = |frequency: f64| 4.0 * frequency;
    let cells = map(&of, &frequencies, &periods, Scaling::First, gain, window);
    assert_eq!(cells.len(), 12);
    for (index, cell) in cells.iter().enumerate() {
        let (frequency, period) = (frequencies[index / 4], periods[index % 4]);
        assert_eq!((cell.frequency_rad_s, cell.period_s), (frequency, period));
        let one = SampledLoop { period, ..of.clone() };
        let closed = DiscretePlant::new(&one, &[frequency / 0.3, 1.0, 1.0, 1.0]).closed(4.0 * frequency);
        assert_eq!(cell.spectral_radius.to_bits(), closed.spectral_radius().to_bits());
        assert_eq!(cell.settling_s, closed.settle(window).time_s);
    }
    assert!(cells[2].spectral_radius > 1.0 && cells[2].settling_s.is_none());
}

#[test]
fn what_is_no_sampled_loop() {
    let dir = Dir::with(&["relay-fixed", "rotation-sine"]);
    dir.run("tune relay-fixed.toml").exits(2).says(&["law: must be `pd`"]);
    dir.write("fitted.toml", FITTED);
    for (arguments, words) in [
        ("tune fitted.toml --frequency 0.3:0.1:4", "LO:HI:COUNT"),
        ("tune fitted.toml --gain 1:2", "LO:HI:COUNT"),
        ("tune fitted.toml --limit 0", "--limit must be a positive number, got 0"),
        ("tune fitted.toml --robust 1.5", "--robust must be 0 or more and below 1, got 1.5"),
        ("tune fitted.toml --band 0", "--band must be a positive number, got 0"),
        ("tune fitted.toml --set body.planar.angle=0", "the band be given"),
        ("tune fitted.toml --set body.planar.modes=[]", "must have a mode"),
        ("tune fitted.toml --set actuator={hold={period=0.3}}", "must be `wheel` or `ideal`"),
        ("map fitted.toml --frequency 0.1:0.3:3", "--period"),
        (
            "map fitted.toml --frequency 0.1:0.3:3 --period 0.3:0.3:1 --gain nan",
            "must be a number, or a number with a unit, got `nan`",
        ),
    ] {
        dir.run(arguments).exits(2).says(&[words]);
    }
}
