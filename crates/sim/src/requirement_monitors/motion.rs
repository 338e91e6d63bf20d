//! True motion as requirements over time read it: piece by piece, or as one value where the motion changes no result.

use flexsc_control::operation::ModeQuantity;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::polynomial::Polynomial;
use flexsc_numerics::signal::{SignalPiece, fit};
use flexsc_numerics::time::{Instant, Span};

use super::super::guidance::Guidance;
use super::super::loads::Loads;
use super::super::motion_limits::{MotionLimits, RESERVE};
use super::super::plant::{AppliedTorque, Plant};
use super::super::run_view::{motion_error, true_rate};
use super::{Observed, RequirementMonitors, curve, join, parts};

/// Radians of the fastest motion in a part that is fitted.
const REACH: f64 = 1.5;

impl RequirementMonitors {
    /// Adds the pieces of the true motion. Where none of its possible values changes a result, one of them stands for it.
    pub(super) fn add_motion(
        &mut self,
        span: [Instant; 2],
        (plant, guidance, loads): (&Plant, &Guidance, &Loads),
        pieces: &mut [Vec<SignalPiece>],
    ) {
        let [from, to] = span.map(Instant::seconds);
        let known = |(observed, pieces): (&Observed, &Vec<SignalPiece>)| {
            if observed.quantity.is_of_motion() {
                return [0.0, f64::INFINITY];
            }
            pieces.iter().map(SignalPiece::bounds).fold(
                [f64::INFINITY, f64::NEG_INFINITY],
                |[low, high], (l, h)| {
                    // A value that is not known is no range.
                    if l.is_nan() { [f64::NAN; 2] } else { [low.min(l), high.max(h)] }
                },
            )
        };
        let mut ranges: Vec<[f64; 2]> = self.quantities.iter().zip(&*pieces).map(known).collect();
        let mut is_ignored = self.ignore(to, &ranges);
        let copy = self.copy.take();
        if let Some(copy) = copy.as_ref().filter(|_| !is_ignored) {
            for (observed, range) in self.quantities.iter().zip(&mut ranges) {
                if observed.quantity.is_of_motion() {
                    *range = self.bounds(observed.quantity, copy, (plant, loads), span);
                }
            }
            is_ignored = self.ignore(to, &ranges);
        }
        if is_ignored {
            for ((observed, into), [low, high]) in self.quantities.iter().zip(&mut *pieces).zip(ranges) {
                if observed.quantity.is_of_motion() {
                    let value = if high.is_finite() { f64::midpoint(low, high) } else { low };
                    into.push(SignalPiece::constant(from, to, value, 0));
                }
            }
        } else if plant.quantities().one_axis().is_some() {
            self.add_one_axis(span, (plant, guidance, &loads.applied), pieces);
        } else if let Some(copy) = &copy {
            self.add_three_axis(span, copy, plant, pieces);
        }
        self.copy = copy;
        for pieces in pieces {
            join(pieces, [from, to]);
        }
    }

    /// Returns true if no requirement depends on the motion up to `to` (s) while each quantity stays within its range.
    pub(super) fn ignore(&self, to: f64, ranges: &[[f64; 2]]) -> bool {
        let of_motion = |place: &usize| self.quantities[*place].quantity.is_of_motion();
        self.monitors.iter().all(|(_, monitor, places)| {
            !places.iter().any(of_motion) || monitor.ignores(to, places.iter().map(|place| ranges[*place]))
        })
    }

    /// Returns bounds of a quantity of the motion about three axes over a segment, from its values at both ends and a bound
    /// of its rate of change.
    fn bounds(
        &self,
        quantity: ModeQuantity,
        (start, guidance): &(Plant, Guidance),
        (end, loads): (&Plant, &Loads),
        [since, now]: [Instant; 2],
    ) -> [f64; 2] {
        let anything = [0.0, f64::INFINITY];
        let jumps = guidance.next_target(since).is_some_and(|next| next <= now);
        if jumps || matches!(quantity, ModeQuantity::LineOfSight(_)) {
            return anything;
        }
        let h = now.since(since).seconds();
        let at_ends = |of: &dyn Fn(&Plant, Instant) -> f64| [of(start, since), of(end, now)];
        let largest = |[one, other]: [f64; 2]| one.max(other);
        let norm = |vector: [f64; 3]| Vector::from(vector).norm();
        let values = at_ends(&|plant, at| norm(self.error(quantity, plant, guidance, at)));
        let turns = quantity == ModeQuantity::PointingError;
        let rotation = if turns { self.hub_rotation } else { 0.0 };
        let torque = loads.torque_bound();
        let growth = largest(at_ends(&|plant, _| self.limits.growth(plant, rotation, torque)));
        let reference = largest(at_ends(&|_, at| guidance.reference_acceleration(at)));
        let acceleration = RESERVE * (growth + reference) + self.slew_acceleration;
        let rate = if turns {
            let rates = at_ends(&|plant, at| norm(motion_error(plant, guidance, at, true)));
            let elastic = at_ends(&|plant, _| MotionLimits::elastic_rate(plant, rotation));
            largest(rates) + RESERVE * largest(elastic) + acceleration * h
        } else {
            acceleration
        };
        let middle = 0.5 * (values[0] + values[1]);
        [(middle - 0.5 * rate * h).max(0.0), middle + 0.5 * rate * h]
    }

    /// Appends the pieces of the true motion about one axis.
    fn add_one_axis(
        &self,
        span: [Instant; 2],
        (plant, guidance, applied): (&Plant, &Guidance, &AppliedTorque),
        pieces: &mut [Vec<SignalPiece>],
    ) {
        let moving = self.quantities.iter().zip(pieces).filter(|(of, _)| of.quantity.is_of_motion());
        let mut moving: Vec<(&Observed, &mut Vec<SignalPiece>)> = moving.collect();
        if moving.is_empty() {
            return;
        }
        let least = moving.iter().map(|(of, _)| of.tolerance).fold(f64::INFINITY, f64::min);
        let mut reference = |times: &[f64]| {
            let at = |t: &f64| {
                let (angle, rate) = guidance.manoeuvre_state(Instant::START + Span::from_seconds(*t));
                vec![angle, rate]
            };
            Some(times.iter().map(at).collect())
        };
        plant.expand(span, applied, &mut |whole, _| {
            let (start, end) = (whole.from, whole.from + whole.length);
            let mut take = |begin: f64, length: f64, aims: &[Polynomial]| {
                let s = |t: f64| (t - start) / whole.length;
                let is_whole = begin == start && begin + length == end;
                let angle =
                    if is_whole { whole.angle } else { whole.angle.restrict(s(begin), s(begin + length)) };
                let rate = angle.derivative().scaled(1.0 / length);
                for (of, into) in &mut moving {
                    let polynomial = match of.quantity {
                        ModeQuantity::PointingError => angle.minus(&aims[0]),
                        ModeQuantity::TrueRateError => rate.minus(&aims[1]),
                        _ => rate,
                    };
                    if let Some(piece) = curve(begin, length, polynomial) {
                        piece.push_magnitude(into);
                    }
                }
            };
            fit([start, end], &[least, least], &mut reference, &mut take);
        });
    }

    /// Appends the pieces of the true motion about three axes, on a copy of the body at the start of the segment.
    fn add_three_axis(
        &self,
        [since, now]: [Instant; 2],
        copy: &(Plant, Guidance),
        plant: &Plant,
        pieces: &mut [Vec<SignalPiece>],
    ) {
        let (mut base, guidance) = (copy.0.clone(), &copy.1);
        let moving = self.quantities.iter().zip(pieces).filter(|(of, _)| of.quantity.is_of_motion());
        let mut moving: Vec<(&Observed, &mut Vec<SignalPiece>)> = moving.collect();
        let tolerances: Vec<f64> = moving.iter().flat_map(|(of, _)| [of.tolerance; 3]).collect();
        let quantities: Vec<ModeQuantity> = moving.iter().map(|(of, _)| of.quantity).collect();
        let [from, to] = [since, now].map(Instant::seconds);
        let fastest = base.fastest_frequency().max(plant.fastest_frequency());
        for part in parts([from, to], REACH / fastest, &[]) {
            let instant = |t: f64| (since + Span::from_seconds(t - from)).min(now);
            let start = instant(part[0]);
            if base.advance(start, &mut ()).is_err() || base.evaluate(start).is_err() {
                return;
            }
            let mut evaluate = |times: &[f64]| {
                let mut moving = base.clone();
                let at = |t: &f64| {
                    let at = instant(*t);
                    moving.advance(at, &mut ()).ok()?;
                    moving.evaluate(at).ok()?;
                    let of = |quantity: &ModeQuantity| self.error(*quantity, &moving, guidance, at);
                    Some(quantities.iter().flat_map(of).collect())
                };
                times.iter().map(at).collect()
            };
            let mut take = |begin: f64, length: f64, all: &[Polynomial]| {
                for ((of, into), parts) in moving.iter_mut().zip(all.chunks(3)) {
                    add_norm([begin, length], parts, of.tolerance, into);
                }
            };
            if !fit(part, &tolerances, &mut evaluate, &mut take) {
                return;
            }
        }
    }

    /// Returns the vector whose norm is a quantity of the true motion about three axes.
    fn error(&self, quantity: ModeQuantity, plant: &Plant, guidance: &Guidance, at: Instant) -> [f64; 3] {
        match quantity {
            ModeQuantity::TrueRate => true_rate(plant),
            ModeQuantity::TrueRateError => motion_error(plant, guidance, at, true),
            ModeQuantity::LineOfSight(line) => {
                self.lines.error(line, plant, guidance, at).unwrap_or_default().into()
            }
            _ => motion_error(plant, guidance, at, false),
        }
    }
}

/// Appends the norm of a vector over a part with a start and a length (s).
fn add_norm([begin, length]: [f64; 2], vector: &[Polynomial], tolerance: f64, into: &mut Vec<SignalPiece>) {
    let norm = |t: &f64| {
        let s = (t - begin) / length;
        vec![Vector::from_iterator(vector.iter().map(|component| component.at(s))).norm()]
    };
    let mut evaluate = |times: &[f64]| Some(times.iter().map(norm).collect());
    let mut take = |begin, length, all: &[Polynomial]| into.extend(curve(begin, length, all[0]));
    fit([begin, begin + length], &[tolerance], &mut evaluate, &mut take);
}
