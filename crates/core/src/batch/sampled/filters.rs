//! Kalman filters of the runs of a batch: samples are read ahead, and the matrix work is done for all lanes at once.

use flexsc_control::estimator::kalman::{FilterLanes, KalmanFilter};
use flexsc_numerics::lanes::LaneFloat;

use super::BatchedRun;
use crate::metrics::MetricsCollector;

/// Returns true if all runs have filters, or none has.
pub fn same_kind(runs: &mut [BatchedRun]) -> bool {
    let count = runs.len();
    [0, count].contains(&all(runs).len())
}

/// Creates the filters that are processed in lanes; `None` for filters of another kind, which are updated run by run.
pub fn from_runs<R: LaneFloat>(kind: R, runs: &mut [BatchedRun]) -> Option<FilterLanes<R>> {
    FilterLanes::new(kind, &mut all(runs))
}

fn all(runs: &mut [BatchedRun]) -> Vec<&mut KalmanFilter> {
    runs.iter_mut().filter_map(|run| run.simulation.filter()).map(|(filter, _)| filter).collect()
}

/// Processes the samples that are due. A run whose filter cannot be processed in the batch continues alone.
#[inline(always)]
pub fn process_samples<R: LaneFloat>(
    filters: &mut FilterLanes<R>,
    runs: &mut [BatchedRun],
    gathers: &[MetricsCollector],
    due: &[bool; 16],
    kind: R,
) {
    let (mut has_sample, mut flags) = ([false; 16], [0.0; 16]);
    let (mut measured, mut moments) = ([0.0; 16], [0.0; 16]);
    let mut others = false;
    for (lane, run) in runs.iter_mut().enumerate() {
        if !run.continues {
            continue;
        }
        if !(due[lane] && run.simulation.sample_is_due()) {
            others = true;
            continue;
        }
        let angle = run.simulation.read_sample_ahead().ok().flatten();
        let moment = run.simulation.filter().and_then(|(_, moment)| moment);
        if let Some(sample) = angle.zip(moment).filter(|(_, moment)| moment.is_finite()) {
            (measured[lane], moments[lane]) = sample;
            (has_sample[lane], flags[lane]) = (true, 1.0);
        } else {
            run.continues = false;
        }
    }
    if !has_sample.contains(&true) {
        return;
    }
    let before = others.then(|| filters.covariances());
    let mut each = all(runs);
    filters.load_means(&each);
    filters.predict(&each, kind.load(&moments));
    let predicted = filters.are_valid();
    filters.store_means(&mut each, &has_sample);
    let mut still = [0.0; 16];
    for (lane, filter) in each.iter().enumerate() {
        still[lane] = f64::from(u8::from(has_sample[lane] && filter.is_below_gate()));
    }
    let zero = kind.splat(0.0);
    let [sample, nis] = filters.update(kind.load(&measured), zero.lt(kind.load(&still)));
    let sound = predicted & filters.are_valid() & zero.le(nis) & nis.le(kind.splat(KalmanFilter::FARTHEST));
    filters.store_means(&mut each, &has_sample);
    if let Some(before) = before {
        filters.restore(&before, zero.lt(kind.load(&flags)));
    }
    let sound = R::select(sound, kind.splat(1.0), zero);
    for (lane, filter) in each.iter_mut().enumerate() {
        if has_sample[lane] && sound.lane(lane) > 0.0 {
            filters.apply(lane, filter, still[lane] > 0.0, sample.lane(lane), nis.lane(lane));
        }
    }
    filters.load_means(&each);
    let mut truths = vec![[0.0; 16]; filters.count()];
    let mut judged = false;
    for (lane, run) in runs.iter_mut().enumerate() {
        if !has_sample[lane] {
            continue;
        }
        if sound.lane(lane) == 0.0 {
            run.continues = false;
        } else if gathers[lane].is_assessed(run.simulation.now().seconds()) {
            judged = true;
            for (truth, value) in truths.iter_mut().zip(run.simulation.true_state()) {
                truth[lane] = value;
            }
        }
    }
    if judged {
        let mut truth = vec![zero; truths.len()];
        for index in 0..truths.len() {
            truth[index] = kind.load(&truths[index]);
        }
        let nees = filters.nees(&truth);
        for (lane, filter) in all(runs).into_iter().enumerate() {
            filter.set_lane_error(nees.lane(lane));
        }
    }
}
