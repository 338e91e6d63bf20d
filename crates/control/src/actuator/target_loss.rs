//! Losses of the target: an actuator is at a limit, and the error grows meanwhile.
//!
//! A visit is a stay in a mode of operation with one target. Within a visit, times at limits that are less than 15 s apart are one
//! stay at limits. The target is lost if the error grows, from its start to 15 s after its end, beyond three times the largest
//! error shortly before. Acquisition does not count: it lasts from the start of a visit that finds another error than the one
//! before left until no actuator has been at a limit for as long.

use std::mem;

use flexsc_numerics::time::{Instant, Span};
use flexsc_record::TargetVisit;

use super::limits::ActuatorLimits;

/// Growth of the error above which a target is lost.
const GROWTH: f64 = 3.0;
/// Error that rounding alone may leave (rad).
const ROUNDING: f64 = 1e-9;
/// Longest gap between two times at a limit that are one stay (s); here, at least ten control cycles.
pub const SATURATION_GAP: f64 = 15.0;
const GAP_CYCLES: f64 = 10.0;

/// Loss of a target in a visit.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetLoss {
    /// Index of the mode of operation; 0 without modes.
    pub mode: usize,
    /// Index of the limit that was reached for the longest time.
    pub limit: usize,
    /// First instant at that limit.
    pub start: Instant,
    /// Time at that limit.
    pub time: Span,
    /// Largest error before (rad).
    pub error_before: f64,
    /// Largest error from the first instant at a limit on (rad).
    pub error: f64,
}

impl TargetLoss {
    /// Returns a description for the journal, with the name of the mode, if there are modes, and of the limit.
    pub fn text(&self, mode: Option<&str>, limit: &str) -> String {
        let mode = mode.map_or_else(String::new, |mode| format!(" in mode {mode}"));
        let Self { error, error_before, .. } = self;
        let (start, time) = (self.start.seconds(), self.time.seconds());
        format!(
            "the target is lost{mode}: {limit} for {time} s from {start} s on, error up to {error:.3e} rad after {error_before:.3e} rad"
        )
    }
}

/// Largest of the recent values, over at least one span and at most two.
#[derive(Copy, Clone, Debug)]
struct RecentPeak {
    span: Span,
    /// Start of the current span.
    since: Instant,
    /// Largest values of the span before and of the current one; NaN without one.
    peaks: [f64; 2],
}

impl RecentPeak {
    fn add(&mut self, now: Instant, value: f64) {
        if now.since(self.since) >= self.span {
            (self.since, self.peaks) = (now, [self.peaks[1], f64::NAN]);
        }
        self.peaks[1] = self.peaks[1].max(value);
    }

    /// Returns the largest recent value; NaN without one.
    fn get(&self) -> f64 {
        self.peaks[0].max(self.peaks[1])
    }
}

/// Stay of actuators at their limits.
#[derive(Clone, Debug)]
struct LimitStay {
    /// Last instant with an actuator at a limit.
    last: Instant,
    /// First instant at each limit, and the time there.
    limits: Vec<(Option<Instant>, Span)>,
    error_before: f64,
    error: f64,
}

impl LimitStay {
    /// Returns true if the error has grown as it does when a target is lost.
    fn loses(&self, floor: f64) -> bool {
        self.error > (GROWTH * self.error_before).max(floor)
    }

    /// Adds the times and errors of a later stay.
    fn merge(&mut self, later: Self) {
        for ((start, time), (other, more)) in self.limits.iter_mut().zip(later.limits) {
            *start = start.or(other);
            *time = *time + more;
        }
        self.error = self.error.max(later.error);
    }
}

/// Monitor of the losses of targets in a run, in bounded memory.
#[derive(Clone, Debug)]
pub struct TargetLossMonitor {
    /// For each mode of operation the instants from which on its law pursues a target or does not.
    pursuits: Vec<Vec<(Instant, bool)>>,
    /// For each mode of operation the error that is never a loss (rad).
    accepted: Vec<f64>,
    /// Longest gap of a stay.
    gap: Span,
    visit: Option<TargetVisit>,
    recent: RecentPeak,
    is_acquired: bool,
    /// Last instant at a limit, or start of the acquisition.
    last_limited: Instant,
    stay: Option<LimitStay>,
    /// Merged stays of the visit in which the target was lost, and true until the error is small again.
    lost: Option<LimitStay>,
    is_recovering: bool,
    /// Limits reached in the last cycle, and its instant.
    reached: Vec<usize>,
    before: Instant,
}

impl TargetLossMonitor {
    /// Creates the monitor of a run. `pursuits` has, for each mode of operation or once, the instants from which on its law pursues
    /// a target or does not, and `accepted` the error (rad) that is never a loss; `cycle` is the period of the observed cycles.
    pub fn new(pursuits: Vec<Vec<(Instant, bool)>>, accepted: Vec<f64>, cycle: Span) -> Self {
        let gap = Span::from_seconds(SATURATION_GAP.max(GAP_CYCLES * cycle.seconds()));
        Self {
            pursuits,
            accepted,
            gap,
            visit: None,
            recent: RecentPeak { span: gap, since: Instant::START, peaks: [f64::NAN; 2] },
            is_acquired: false,
            last_limited: Instant::START,
            stay: None,
            lost: None,
            is_recovering: false,
            reached: Vec::new(),
            before: Instant::START,
        }
    }

    /// Returns true if the law of a mode pursues a target at an instant.
    fn pursues(&self, mode: usize, now: Instant) -> bool {
        let Some(stages) = self.pursuits.get(mode) else { return false };
        stages.iter().rev().find(|(from, _)| *from <= now).is_some_and(|(_, pursues)| *pursues)
    }

    /// Observes a control cycle with its limits and its error (rad); returns the loss of the visit that it ends, if any.
    pub fn observe(
        &mut self,
        now: Instant,
        visit: TargetVisit,
        limits: &ActuatorLimits,
        error: f64,
    ) -> Option<TargetLoss> {
        let next = Some(visit).filter(|visit| self.pursues(visit.mode, now));
        let mut ended = None;
        if next != self.visit {
            ended = self.end_visit(now);
            let is_continued = self.visit.is_some() && error <= GROWTH * self.recent.get();
            self.visit = next;
            if !is_continued {
                self.recent.peaks = [f64::NAN; 2];
                (self.is_acquired, self.last_limited) = (false, now);
            }
        }
        if self.visit.is_some() {
            self.observe_error(now, limits, error);
        }
        ended
    }

    fn observe_error(&mut self, now: Instant, limits: &ActuatorLimits, error: f64) {
        self.add_time(now);
        self.reached.extend(limits.reached().map(|(index, ..)| index));
        let is_limited = !self.reached.is_empty();
        if self.is_recovering
            && let Some(lost) = &mut self.lost
        {
            lost.error = lost.error.max(error);
            self.is_recovering = error > GROWTH * lost.error_before;
        }
        if is_limited && self.is_acquired && self.stay.is_none() {
            let known = self.recent.get().max(error);
            let lost = self.lost.as_ref().filter(|_| self.is_recovering);
            self.stay = Some(LimitStay {
                last: now,
                limits: vec![(None, Span::ZERO); limits.count()],
                error_before: lost.map_or(known, |lost| lost.error_before),
                error,
            });
        }
        if let Some(stay) = &mut self.stay {
            stay.error = stay.error.max(error);
            for index in &self.reached {
                stay.limits[*index].0.get_or_insert(now);
            }
            if is_limited {
                stay.last = now;
            } else if now.since(stay.last) >= self.gap {
                self.end_stay();
            }
        }
        if is_limited {
            self.last_limited = now;
        } else if now.since(self.last_limited) >= self.gap {
            self.is_acquired = true;
        }
        self.recent.add(now, error);
    }

    /// Adds the time since the last cycle to the limits that were reached there.
    fn add_time(&mut self, now: Instant) {
        let span = now.since(self.before);
        for index in self.reached.drain(..) {
            if let Some(stay) = &mut self.stay {
                stay.limits[index].1 = stay.limits[index].1 + span;
            }
        }
        self.before = now;
    }

    fn end_stay(&mut self) {
        let accepted = self.visit.and_then(|visit| self.accepted.get(visit.mode).copied());
        let floor = accepted.unwrap_or(0.0).max(ROUNDING);
        let Some(stay) = self.stay.take().filter(|stay| stay.loses(floor)) else { return };
        self.is_recovering = true;
        match &mut self.lost {
            Some(lost) => lost.merge(stay),
            None => self.lost = Some(stay),
        }
    }

    /// Ends the visit, and returns the loss of its target, if any.
    pub fn end_visit(&mut self, now: Instant) -> Option<TargetLoss> {
        self.add_time(now);
        self.end_stay();
        self.is_recovering = false;
        let (mode, LimitStay { limits, error_before, error, .. }) =
            (self.visit?.mode, mem::take(&mut self.lost)?);
        let longest = |(best, most): (usize, Span), (index, (_, time)): (usize, &(_, Span))| {
            if *time > most { (index, *time) } else { (best, most) }
        };
        let (limit, time) = limits.iter().enumerate().fold((0, Span::ZERO), longest);
        let start = limits.get(limit).and_then(|(start, _)| *start)?;
        Some(TargetLoss { mode, limit, start, time, error_before, error })
    }
}
