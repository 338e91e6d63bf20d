//! Verdicts against counts by hand, Wilson's interval and Clopper-Pearson's confidence as SciPy has them.

use super::*;
use flexsc_scenario::RequirementSource;

fn requirement(level: f64, interpretation: Interpretation, wanted: Option<f64>) -> AssessedRequirement {
    AssessedRequirement {
        name: "jitter".to_owned(),
        source: RequirementSource::Metric("pointing_rms_rad".to_owned(), None),
        unit: "rad",
        limit: 10.0,
        written_limit: None,
        level,
        interpretation,
        confidence: wanted,
    }
}

fn judged(requirement: AssessedRequirement, runs: &[(f64, f64)]) -> RequirementVerdict {
    let empty = vec![Vec::new()];
    let requirements = vec![requirement];
    let counts = vec![[0; 2]; empty.len()];
    let mut all = RequirementRuns {
        requirements,
        counts,
        values: empty.clone(),
        shares: empty,
        ..RequirementRuns::default()
    };
    for (number, (value, share)) in (7..).zip(runs) {
        all.add_values(number, &[*value], &[*share]);
    }
    all.finish().remove(0)
}

#[test]
fn an_ensemble_is_judged_by_its_order_statistic() {
    let runs: Vec<(f64, f64)> = (1..=20).map(|run| (0.525 * f64::from(run), 1.0)).collect();
    // The largest is 10.5; the 19th is 9.975, by which 95 % of the runs are within the limit.
    let most = judged(requirement(0.95, Interpretation::Ensemble, None), &runs);
    assert_eq!((most.decision, most.value, most.runs_met), (Decision::Met, 0.525 * 19.0, 19));
    assert_eq!(most.worst, (26, 10.5));
    // scipy.stats.binomtest(19, 20).proportion_ci(0.95, "wilson")
    let [low, high] = most.interval();
    assert!((low - 0.763_868_806_553_258).abs() < 1e-14 && (high - 0.991_118_551_199_204_7).abs() < 1e-14);
    // scipy.stats.beta.cdf(0.05, 2, 19)
    let shown = most.confidence.expect("of a level below 1");
    assert!((shown.reached - 0.264_160_475_056_149_8).abs() < 1e-14, "{shown:?}");
    let all = judged(requirement(1.0, Interpretation::Ensemble, None), &runs);
    assert_eq!((all.decision, all.value, all.confidence), (Decision::Missed, 10.5, None));
}

#[test]
fn too_few_runs_decide_nothing() {
    let wanted = || requirement(0.95, Interpretation::Ensemble, Some(0.9));
    let few = judged(wanted(), &[(9.0, 1.0); 44]);
    assert_eq!(
        (few.decision, few.confidence.and_then(|shown| shown.runs_needed)),
        (Decision::Undecided, Some(45))
    );
    assert_eq!(judged(wanted(), &[(9.0, 1.0); 45]).decision, Decision::Met);
    // Two runs beyond the limit: 105 are needed.
    let mut runs = vec![(9.0, 1.0); 98];
    runs.extend([(11.0, 0.5); 2]);
    let two = judged(wanted(), &runs);
    assert_eq!(
        (two.decision, two.confidence.and_then(|shown| shown.runs_needed)),
        (Decision::Undecided, Some(105))
    );
}

#[test]
fn time_counts_in_the_worst_run_or_in_all_together() {
    // The value of a run is its quantile over time, the share that within the limit.
    let runs = [(8.0, 0.99), (11.0, 0.90), (9.0, 0.97)];
    let temporal = judged(requirement(0.95, Interpretation::Temporal, None), &runs);
    assert_eq!((temporal.decision, temporal.value, temporal.runs_met), (Decision::Missed, 11.0, 2));
    let mixed = judged(requirement(0.95, Interpretation::Mixed, None), &runs);
    assert!(
        mixed.decision == Decision::Met && mixed.value.is_nan() && (mixed.share - 2.86 / 3.0).abs() < 1e-15
    );
    assert_eq!(judged(requirement(0.955, Interpretation::Mixed, None), &runs).decision, Decision::Missed);
}

#[test]
fn a_run_without_a_value_meets_nothing() {
    let runs = [(8.0, 1.0), (f64::NAN, f64::NAN), (9.0, 1.0)];
    for interpretation in [Interpretation::Temporal, Interpretation::Ensemble, Interpretation::Mixed] {
        let found = judged(requirement(1.0, interpretation, None), &runs);
        assert!(
            found.decision == Decision::Missed && found.value.is_nan() && found.runs_met == 2,
            "{found:?}"
        );
    }
    // One of three runs may be beyond the limit.
    assert_eq!(judged(requirement(0.6, Interpretation::Ensemble, None), &runs).value, 9.0);
}
