//! Kalman filters of the runs of a batch: samples are read ahead, and the matrix work is done for all lanes at once.

use super::Run;
use crate::estimator::kalman::{Filters, KalmanFilter};
use crate::lanes::Real;
use crate::metrics::Gather;

/// Returns true if all runs have filters, or none has.
pub fn agree(runs: &mut [Run]) -> bool {
    let count = runs.len();
    [0, count].contains(&all(runs).len())
}

/// Creates the filters that are processed in lanes; `None` for filters of another kind, which are updated run by run.
pub fn of<R: Real>(kind: R, runs: &mut [Run]) -> Option<Filters<R>> {
    Filters::new(kind, &mut all(runs))
}

fn all(runs: &mut [Run]) -> Vec<&mut KalmanFilter> {
    runs.iter_mut().filter_map(|run| run.simulation.filter()).map(|(filter, _)| filter).collect()
}

/// Processes the samples that are due. A run whose filter cannot be processed in the batch continues alone.
#[inline(always)]
pub fn sample<R: Real>(
    filters: &mut Filters<R>,
    runs: &mut [Run],
    gathers: &[Gather],
    due: &[bool; 16],
    kind: R,
) {
    let (mut takes, mut flags) = ([false; 16], [0.0; 16]);
    let (mut measured, mut moments) = ([0.0; 16], [0.0; 16]);
    let mut others = false;
    for (lane, run) in runs.iter_mut().enumerate() {
        if !run.goes_on {
            continue;
        }
        if !(due[lane] && run.simulation.samples()) {
            others = true;
            continue;
        }
        let angle = run.simulation.read_ahead().ok().flatten();
        let moment = run.simulation.filter().and_then(|(_, moment)| moment);
        if let Some(of) = angle.zip(moment).filter(|(_, moment)| moment.is_finite()) {
            (measured[lane], moments[lane]) = of;
            (takes[lane], flags[lane]) = (true, 1.0);
        } else {
            run.goes_on = false;
        }
    }
    if !takes.contains(&true) {
        return;
    }
    let before = others.then(|| filters.covariances());
    let mut each = all(runs);
    filters.take_means(&each);
    filters.predict(&each, kind.load(&moments));
    let predicted = filters.are_sound();
    filters.give_means(&mut each, &takes);
    let mut still = [0.0; 16];
    for (lane, filter) in each.iter().enumerate() {
        still[lane] = f64::from(u8::from(takes[lane] && filter.moves_too_little()));
    }
    let zero = kind.of(0.0);
    let [innovation, nis] = filters.learn(kind.load(&measured), zero.lt(kind.load(&still)));
    let sound = predicted & filters.are_sound() & zero.le(nis) & nis.le(kind.of(KalmanFilter::FARTHEST));
    filters.give_means(&mut each, &takes);
    if let Some(before) = before {
        filters.restore(&before, zero.lt(kind.load(&flags)));
    }
    let sound = R::select(sound, kind.of(1.0), zero);
    for (lane, filter) in each.iter_mut().enumerate() {
        if takes[lane] && sound.lane(lane) > 0.0 {
            filters.settle(lane, filter, still[lane] > 0.0, innovation.lane(lane), nis.lane(lane));
        }
    }
    filters.take_means(&each);
    let mut truths = vec![[0.0; 16]; filters.count()];
    let mut judged = false;
    for (lane, run) in runs.iter_mut().enumerate() {
        if !takes[lane] {
            continue;
        }
        if sound.lane(lane) == 0.0 {
            run.goes_on = false;
        } else if gathers[lane].assesses(run.simulation.now().seconds()) {
            judged = true;
            for (truth, value) in truths.iter_mut().zip(run.simulation.true_state()) {
                truth[lane] = value;
            }
        }
    }
    if judged {
        let mut truth = vec![zero; truths.len()];
        for at in 0..truths.len() {
            truth[at] = kind.load(&truths[at]);
        }
        let nees = filters.nees(&truth);
        for (lane, filter) in all(runs).into_iter().enumerate() {
            filter.assess_beside(nees.lane(lane));
        }
    }
}
