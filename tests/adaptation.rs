//! The random search against an independent one: draw for draw, and over many seeds.

use flexsc_core::Simulation;
use flexsc_core::campaign::Campaign;
use flexsc_core::control::adaptation::{AdaptationKind, Decision, RandomSearchState, SearchStep};
use flexsc_core::numerics::time::{Instant, Span};

use crate::study::{close, scenario};

/// Generator of the numbers below: splitmix64.
struct SplitMix(u64);

impl SplitMix {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }
}

#[test]
fn search_freezes_where_an_independent_one_does() {
    // Seed, when the gain is frozen, at what, and the last window's mean: computed apart, with splitmix64 for draws.
    let exact = [(2153, 20_000.0, 0.338_913_4, 6.569_8e-6), (1491, 14_500.0, 0.338_918_4, 6.559_4e-6)];
    for (seed, frozen_at, k_t, level) in exact {
        let mut scenario = scenario("relay-adaptive", &[]);
        let Some(AdaptationKind::RandomSearch(constants)) = scenario.written.adaptation.take() else {
            panic!("no search")
        };
        let mut search = RandomSearchState::new(constants, 0.31);
        let mut draws = SplitMix(seed);
        let mut simulation = Simulation::new(&scenario, 0);
        let mut last = None;
        for window in 1..=40 {
            let now = Instant::START + Span::from_seconds(500.0 * f64::from(window));
            simulation.run_until(now, &mut ()).expect("a run");
            let mean = simulation.window_mean().expect("a mean");
            if let Some(step) = search.learn(now, mean, draws.uniform()) {
                simulation.set_parameter("k_t", step.gain);
                last = Some((now, step));
            }
        }
        let Some((at, SearchStep { decision: Decision::Freeze, gain, .. })) = last else {
            panic!("seed {seed}: not frozen: {last:?}")
        };
        assert_eq!(at.seconds(), frozen_at, "seed {seed}");
        assert!((gain - k_t).abs() < 6e-8, "seed {seed}: {gain}");
        let mean = simulation.window_mean().expect("a mean");
        close(mean, level, 2e-3);
    }
}

#[test]
fn adaptation_over_seeds_is_distributed_as_it_should_be() {
    // Over 1000 other seeds: 76.9 % frozen, median frozen gain 0.3359, median reduction 2.59. The bounds here are three
    // standard errors of 400 runs beside those 1000.
    let study = Campaign::new(scenario("relay-adaptive", &[]), "relay-adaptive", None).expect("a campaign");
    let mut frozen = Vec::new();
    let mut reduction = Vec::new();
    std::sync::Arc::new(study)
        .for_each_run::<()>(
            0..400,
            0,
            |run| Ok(Campaign::simulate(run, ())?),
            |outcome| {
                let Some(outcome) = outcome else { return Ok(()) };
                let metrics = outcome.metrics.expect("a run");
                let gain = metrics.number("gain_frozen").expect("a metric");
                if gain.is_finite() {
                    frozen.push(gain);
                    reduction.push(metrics.number("envelope_frozen_reduction").expect("a metric"));
                }
                Ok(())
            },
        )
        .expect("a campaign");
    let share = frozen.len() as f64 / 400.0;
    assert!((share - 0.769).abs() < 0.075, "{share} frozen");
    let median = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let gain = median(&mut frozen);
    assert!((gain - 0.3359).abs() < 0.0025, "median gain {gain}");
    let reduction = median(&mut reduction);
    assert!((reduction - 2.59).abs() < 0.2, "median reduction {reduction}");
}
