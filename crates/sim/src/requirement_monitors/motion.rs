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
use super::{Observed, RequirementMonitors, SegmentEnd, curve, join, parts};

/// Radians of the fastest motion in a part that is fitted first: at least eight points in a period.
const REACH: f64 = 4.0;
/// Largest error (rad) over a segment for which the second derivative of its rotation vector is bounded, and the parts of that
/// bound: of accelerations, and of the square of the rate. Up to 1 rad, the vector's derivatives are 1.05 times those of the
/// error's rate, and 0.7 times its square; the rate changes by accelerations, and by its product with the reference's rate,
/// which is at most the sum of the rates of error and body.
const BENT: f64 = 1.0;
const BENT_BY: [f64; 2] = [2.0, 3.0];

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
        let (start, copy) = (self.start.take(), self.copy.take());
        let jumps = guidance.next_target(span[0]).is_some_and(|next| next <= span[1]);
        let is_free = jumps || guidance.has_unlimited_acceleration(span[0]);
        if let Some(start) = start.as_ref().filter(|_| !is_ignored && !is_free && self.is_bounded) {
            let end = self.at_end(plant, guidance, loads, span[1]);
            for (number, range) in ranges.iter_mut().enumerate() {
                if is_bounded(&self.quantities[number]) {
                    *range = self.bounds(number, [start, &end], to - from, loads.is_constant());
                }
            }
            is_ignored = self.ignore(to, &ranges);
        }
        let is_one_axis = plant.quantities().one_axis().is_some();
        if is_ignored && !(is_one_axis && self.kept.is_some()) {
            for number in 0..ranges.len() {
                self.add_any(number, start.as_ref(), [from, to], pieces);
            }
        } else if is_one_axis {
            self.add_one_axis(span, (plant, guidance, &loads.applied), pieces);
        } else if start.is_some() {
            let of_copy = copy.map(|copy| *copy);
            let (base, guidance) =
                of_copy.as_ref().map_or((plant, guidance), |(base, guidance)| (base, guidance));
            self.add_three_axis(span, (base.clone(), guidance), plant, pieces);
            for number in (0..ranges.len()).filter(|number| !self.quantities[*number].counts) {
                self.add_any(number, start.as_ref(), [from, to], pieces);
            }
        }
        for pieces in pieces {
            join(pieces, [from, to]);
        }
    }

    /// Returns true if one of the quantities at some places is of the motion.
    pub(super) fn depends_on_motion(quantities: &[Observed], places: &[usize]) -> bool {
        places.iter().any(|place| quantities[*place].quantity.is_of_motion())
    }

    /// Returns true if no requirement depends on the motion up to `to` (s) while each quantity stays within its range.
    pub(super) fn ignore(&self, to: f64, ranges: &[[f64; 2]]) -> bool {
        self.monitors.iter().all(|(_, monitor, places)| {
            !Self::depends_on_motion(&self.quantities, places)
                || monitor.ignores(to, places.iter().map(|place| ranges[*place]))
        })
    }

    /// Adds a value of a quantity of the motion that is within its range: that at the start of the segment, if it is known.
    fn add_any(
        &self,
        number: usize,
        start: Option<&SegmentEnd>,
        [from, to]: [f64; 2],
        pieces: &mut [Vec<SignalPiece>],
    ) {
        if self.quantities[number].quantity.is_of_motion() {
            let value = start.map_or(0.0, |start| start.errors[number].norm());
            pieces[number].push(SignalPiece::constant(from, to, value));
        }
    }

    /// Returns the values at an end of a segment from which bounds of the motion about three axes follow.
    pub(super) fn at_end(
        &self,
        plant: &Plant,
        guidance: &Guidance,
        loads: &Loads,
        now: Instant,
    ) -> SegmentEnd {
        let error = |observed: &Observed| {
            if observed.counts { self.error(observed.quantity, plant, guidance, now) } else { [0.0; 3] }
        };
        let torque = loads.torque_bound();
        let elastic = MotionLimits::elastic_rate(plant, self.hub_rotation);
        let mut growth = [0.0, self.hub_rotation].map(|rotation| self.limits.growth(plant, rotation, torque));
        let is_light_steady = self.sky.is_steady(ModeQuantity::TrueSunlight, now.seconds());
        let heated = MotionLimits::thermal_force(plant, now, is_light_steady);
        growth[1] += self.hub_rotation * (loads.modal_force_bound() + heated);
        let fastest = plant.fastest_frequency();
        let oscillation = fastest * elastic;
        let turns =
            self.quantities.iter().any(|own| own.counts && own.quantity == ModeQuantity::PointingError);
        let follows = self.quantities.iter().any(|own| own.counts && own.quantity != ModeQuantity::TrueRate);
        let rate = if turns { motion_error(plant, guidance, now, true) } else { [0.0; 3] };
        SegmentEnd {
            errors: self.quantities.iter().map(|observed| Vector::from(error(observed))).collect(),
            turning: Vector::from(rate).norm() + RESERVE * elastic,
            reference: if follows { guidance.reference_acceleration(now) } else { 0.0 },
            oscillation,
            fastest,
            bend: self.limits.bend(plant, [elastic, growth[1] + oscillation], torque, now),
            growth,
        }
    }

    /// Returns bounds of a quantity of the motion about three axes over a segment with a length (s), by its number and the values
    /// at both ends; `is_constant`: the loads are.
    fn bounds(&self, number: usize, ends: [&SegmentEnd; 2], h: f64, is_constant: bool) -> [f64; 2] {
        let quantity = self.quantities[number].quantity;
        let largest = |of: &dyn Fn(&SegmentEnd) -> f64| of(ends[0]).max(of(ends[1]));
        let turns = quantity == ModeQuantity::PointingError;
        let growth = largest(&|end| end.growth[usize::from(turns)]);
        let follows = quantity != ModeQuantity::TrueRate;
        let reference = if follows { largest(&|end| end.reference) } else { 0.0 };
        let slew = if follows { self.slew_acceleration } else { 0.0 };
        let acceleration = RESERVE * (growth + reference) + slew;
        let rate = if turns { largest(&|end| end.turning) + acceleration * h } else { acceleration };
        let vectors = ends.map(|end| end.errors[number]);
        let [one, other] = vectors.map(|vector| vector.norm());
        let (middle, most) = (f64::midpoint(one, other), one.max(other));
        let [low, high] = [(middle - 0.5 * rate * h).max(0.0), middle + 0.5 * rate * h];
        let is_steady = self.is_steady && is_constant;
        let bend = match quantity {
            ModeQuantity::PointingError if high < BENT => {
                // Loads that change can make vibrations grow; under steady ones their free part keeps its size.
                let growth = |end: &SegmentEnd| end.fastest * (end.growth[1] - end.growth[0]);
                let grown = if is_steady { 0.0 } else { h * largest(&growth) };
                let oscillation = RESERVE * (largest(&|end| end.oscillation) + grown);
                BENT_BY[0] * (acceleration + oscillation) + BENT_BY[1] * rate * rate
            }
            ModeQuantity::TrueRate if is_steady => RESERVE * largest(&|end| end.bend),
            _ => return [low, high],
        };
        // The vector is near the straight line between its values at both ends.
        let (line, off) = (vectors[1] - vectors[0], bend * h * h / 8.0);
        let along = -vectors[0].dot(&line) / line.norm_squared();
        let nearest = (vectors[0] + line * if along > 0.0 { along.min(1.0) } else { 0.0 }).norm();
        [low.max(nearest - off), high.min(most + off)]
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

    /// Appends the pieces of the true motion about three axes, on a copy of the body that can return to the start of the segment.
    fn add_three_axis(
        &self,
        [since, now]: [Instant; 2],
        (mut base, guidance): (Plant, &Guidance),
        plant: &Plant,
        pieces: &mut [Vec<SignalPiece>],
    ) {
        let moving = self.quantities.iter().zip(pieces).filter(|(of, _)| of.counts);
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

/// Returns true for a quantity of the motion that counts, and has bounds.
fn is_bounded(observed: &Observed) -> bool {
    observed.counts && !matches!(observed.quantity, ModeQuantity::LineOfSight(_))
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
