//! Largest absolute value of a function that is smooth between breaks.

/// Returns a twenty-fourth of the period of a frequency (rad/s), a sampling step that resolves every peak.
pub fn sampling(frequency: f64) -> f64 {
    std::f64::consts::TAU / (24.0 * frequency.max(1e-9))
}

/// Largest absolute value, with its time.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PeakValue {
    /// Time (s) at which the value is reached.
    pub time: f64,
    /// Largest absolute value.
    pub value: f64,
}

/// Returns the largest absolute value of `f(middle, t)` over the pieces between `breaks`, where `middle` is a time
/// inside the piece that t belongs to: at the ends of a piece it selects the limit. Samples are at most `step` apart,
/// and at least 32 in a piece; candidates are refined to rounding.
pub fn largest(breaks: &[f64], step: f64, f: impl Fn(f64, f64) -> f64) -> PeakValue {
    largest_of_each(1, breaks, step, |middle, t| vec![f(middle, t)]).pop().unwrap_or_default()
}

/// Sample not smaller than its neighbours: middle of its piece, times of the sample before, itself and the next, value.
type PeakCandidate = (f64, f64, f64, f64, f64);

/// Returns the largest absolute value of each of `count` functions, which are evaluated together, as [`largest`] does.
pub fn largest_of_each(
    count: usize,
    breaks: &[f64],
    step: f64,
    f: impl Fn(f64, f64) -> Vec<f64>,
) -> Vec<PeakValue> {
    let mut candidates: Vec<Vec<PeakCandidate>> = vec![Vec::new(); count];
    for ends in breaks.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        let middle = 0.5 * (from + to);
        let points = ((to - from) / step).ceil().clamp(32.0, 1e6) as usize;
        let time = |i: usize| from + (to - from) * (i as f64 / points as f64);
        let samples: Vec<Vec<f64>> = (0..=points).map(|i| f(middle, time(i))).collect();
        for (index, candidates) in candidates.iter_mut().enumerate() {
            let value = |i: usize| samples[i][index].abs();
            for i in 0..=points {
                let (before, after) = (i.saturating_sub(1), (i + 1).min(points));
                if value(i) >= value(before) && value(i) >= value(after) {
                    candidates.push((middle, time(before), time(i), time(after), value(i)));
                }
            }
        }
    }
    let peak = |(index, candidates): (usize, Vec<PeakCandidate>)| {
        let coarse = candidates.iter().map(|candidate| candidate.4).fold(0.0, f64::max);
        let mut peak = PeakValue::default();
        for (middle, from, crest, to, value) in candidates {
            if value < 0.98 * coarse || coarse == 0.0 {
                continue;
            }
            let found = refined(|t| f(middle, t)[index].abs(), from, to);
            let found = if found.value > value { found } else { PeakValue { time: crest, value } };
            // Of peaks that are equal within rounding, the first counts.
            if found.value > peak.value * (1.0 + 1e-13) || peak.value == 0.0 {
                peak = found;
            }
        }
        peak
    };
    candidates.into_iter().enumerate().map(peak).collect()
}

/// Finds the maximum of a unimodal function by golden section.
fn refined(f: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> PeakValue {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let mut low = to - GOLDEN * (to - from);
    let mut high = from + GOLDEN * (to - from);
    let (mut at_low, mut at_high) = (f(low), f(high));
    // The value is flat: half the digits of the time give it to rounding.
    for _ in 0..40 {
        if at_low >= at_high {
            (to, high, at_high) = (high, low, at_low);
            low = to - GOLDEN * (to - from);
            at_low = f(low);
        } else {
            (from, low, at_low) = (low, high, at_high);
            high = from + GOLDEN * (to - from);
            at_high = f(high);
        }
    }
    if at_low >= at_high {
        PeakValue { time: low, value: at_low }
    } else {
        PeakValue { time: high, value: at_high }
    }
}
