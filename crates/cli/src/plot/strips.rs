//! Strips above figures over time: modes of operation, eclipses, blinded star trackers, filters, actuators at limits, failures.

use flexsc_core::control::actuator::SATURATION_GAP;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{self, Light, Orbit};
use flexsc_figure::{Figure, RGBColor, Strip, StripSpan, colour, palette};

use super::cycle_data::CycleData;
use super::figure_spec::RunData;
use super::motion::DominantModeEstimate;
use super::run_events::RunEvents;
use super::{flywheel, time, wheels};

/// Colours of the modes, in the order of the scenario, and how much of them there is in white.
const MODES: [RGBColor; 6] =
    [colour::ORANGE, colour::GREEN, colour::BLUE, colour::VERMILLION, colour::SKY, colour::GREY];
const PALE: f64 = 0.4;
const WHITE: RGBColor = RGBColor(255, 255, 255);
const ECLIPSE: RGBColor = RGBColor(70, 80, 90);
const BLINDED: RGBColor = RGBColor(142, 90, 160);
/// Share of a limit from which on an actuator is at it.
const AT_LIMIT: f64 = 0.999;
/// Part of the run up to which a gap between times at a limit is closed.
const GAP_SHARE: f64 = 2e-3;

/// Interval of time (s).
type Interval = [f64; 2];

/// Adds a strip for each kind of event of the run that the figure's time shows.
pub fn add(mut figure: Figure, run: &RunData<'_>) -> Figure {
    let axis = time(0.0..1.0).name;
    let is_over_time = figure.panels.last().is_some_and(|panel| panel.x.name == axis);
    if let Some(first) = figure.panels.first_mut().filter(|_| is_over_time) {
        let shown = &first.x.range;
        let is_shown = |span: &StripSpan| span.from < shown.end && span.to > shown.start;
        first.strips = all(run).into_iter().filter(|strip| strip.spans.iter().any(is_shown)).collect();
    }
    figure
}

fn all(run: &RunData<'_>) -> Vec<Strip> {
    let story = run.story;
    let [speed, torque] = at_limits(run);
    let uniform = |name: &str, colour: RGBColor, intervals: &[Interval]| {
        let span = |[from, to]: &Interval| StripSpan { from: *from, to: *to, name: String::new(), colour };
        Strip { name: name.to_owned(), spans: intervals.iter().map(span).collect() }
    };
    vec![
        modes(story),
        uniform("eclipse", ECLIPSE, &eclipses(run.cycles, story.end)),
        uniform("tracker blinded", BLINDED, &story.blinded),
        uniform("filter gated", colour::GREY, &filter_intervals(run, |estimate| estimate.gated)),
        uniform("lock lost", colour::VERMILLION, &filter_intervals(run, |estimate| estimate.lost)),
        uniform("wheel at limit", colour::RED, &speed),
        uniform("torque at limit", colour::RED, &torque),
        failures(story),
    ]
}

fn modes(story: &RunEvents) -> Strip {
    let span = |(place, start): (usize, &super::run_events::ModeStart)| StripSpan {
        from: start.time,
        to: story.modes.get(place + 1).map_or(story.end, |next| next.time),
        name: story.scenario.mode.get(start.index).map_or_else(String::new, |mode| mode.name.clone()),
        colour: palette::between(&[WHITE, MODES[start.index % MODES.len()]], PALE),
    };
    Strip { name: "mode".to_owned(), spans: story.modes.iter().enumerate().map(span).collect() }
}

fn failures(story: &RunEvents) -> Strip {
    let span = |failing: &flexsc_core::scenario::FailureInterval| StripSpan {
        from: failing.interval.start().seconds(),
        to: failing.interval.end().map_or(story.end, Instant::seconds),
        name: if failing.of.is_empty() { kind_of_part(&failing.part) } else { failing.of.clone() },
        colour: colour::ORANGE,
    };
    Strip { name: "failure".to_owned(), spans: story.scenario.failures().iter().map(span).collect() }
}

/// Returns the kind of a part in words: `sensor[3].star_tracker` as "star tracker".
fn kind_of_part(key: &str) -> String {
    key.rsplit('.').next().unwrap_or(key).replace('_', " ")
}

/// Returns the intervals in which a filter of one axis says something of itself (s).
fn filter_intervals(run: &RunData<'_>, is_so: fn(&DominantModeEstimate) -> bool) -> Vec<Interval> {
    let estimates = run.motion.estimates.iter();
    intervals(estimates.map(|estimate| (estimate.time, is_so(estimate))), run.story.end, 0.0)
}

/// Returns the intervals of the rows in shadow (s).
fn eclipses(cycles: &CycleData, end: f64) -> Vec<Interval> {
    intervals(cycles.rows::<Orbit>().map(|(time, row)| (time, row.light == Light::Shadow)), end, 0.0)
}

/// Returns the intervals in which a wheel is at the limit of its speed, and at that of its torque (s).
fn at_limits(run: &RunData<'_>) -> [Vec<Interval>; 2] {
    let RunData { story, motion, cycles, .. } = run;
    let gap = SATURATION_GAP.min(GAP_SHARE * story.end);
    let is_at = |value: f64, limit: Option<f64>| limit.is_some_and(|limit| value.abs() >= AT_LIMIT * limit);
    if let Some(limit) = flywheel::speed_limit(story) {
        let speeds = motion.time.iter().zip(&motion.wheel[0]);
        let at = speeds.map(|(time, speed)| (*time, is_at(*speed, Some(limit))));
        return [intervals(at, story.end, gap), Vec::new()];
    }
    let [speed, torque] = wheels::limits(story);
    let of = |limit: Option<f64>, value_of: fn(&record::Wheel) -> f64| {
        let any = |row: &record::Wheels| row.wheels.iter().any(|wheel| is_at(value_of(wheel), limit));
        intervals(cycles.rows::<record::Wheels>().map(|(time, row)| (time, any(row))), story.end, gap)
    };
    [of(speed, |wheel| wheel.speed_rad_s), of(torque, |wheel| wheel.torque_nm)]
}

/// Returns the intervals in which rows say yes (s), each row until the next; shorter gaps than `gap` are closed.
fn intervals(rows: impl Iterator<Item = (f64, bool)>, end: f64, gap: f64) -> Vec<Interval> {
    let mut intervals: Vec<Interval> = Vec::new();
    let mut since = None;
    let close = |intervals: &mut Vec<Interval>, from: f64, to: f64| match intervals.last_mut() {
        Some(last) if from - last[1] < gap => last[1] = to,
        _ => intervals.push([from, to]),
    };
    for (time, is_so) in rows {
        match (is_so, since) {
            (true, None) => since = Some(time),
            (false, Some(from)) => {
                close(&mut intervals, from, time);
                since = None;
            }
            _ => {}
        }
    }
    if let Some(from) = since {
        close(&mut intervals, from, end);
    }
    intervals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_hold_until_the_next_and_short_gaps_are_closed() {
        let rows = [(0.0, false), (1.0, true), (2.0, false), (2.5, true), (4.0, false), (9.0, true)];
        assert_eq!(intervals(rows.into_iter(), 10.0, 0.0), [[1.0, 2.0], [2.5, 4.0], [9.0, 10.0]]);
        assert_eq!(intervals(rows.into_iter(), 10.0, 1.0), [[1.0, 4.0], [9.0, 10.0]]);
    }
}
