//! One-axis motion as records receive it: piece by piece, in series that are exact to rounding.

use super::{Exerted, Motion, PlanarPlant};
use crate::body::Output;
use crate::flow::{Flown, Segment, Unfolding};
use crate::guard::Guard;
use crate::motion::crossing::locate;
use crate::motion::{Expansion, State, Stretch};
use crate::numerics::polynomial::{Polynomial, Series, TERMS};
use crate::record::{Course, Record, RecordError};
use crate::time::Instant;

/// Motion segment that is expanded in series from its start on.
enum Unfolded<'a> {
    Planar(&'a Segment, State),
    Chain(Flown<'a>),
    Coupled(Unfolding<'a>),
}

impl PlanarPlant {
    /// Records the motion of the segment that ends at `now`, piece by piece, if the record wants it.
    pub fn tell_course(
        &self,
        now: Instant,
        exerted: &Exerted,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        match record.course() {
            Course::None => Ok(()),
            Course::Beyond(band) if self.stays_within(band, now, record)? => Ok(()),
            _ => self.walk(now, exerted, |stretch| record.stretch(now, stretch)),
        }
    }

    /// Returns true if the angle is certain to stay within `band` (rad) of 0 on this segment until `until`: by bounds,
    /// which are cheap, or else by a search for a crossing.
    ///
    /// # Errors
    /// Fails if the record ends the search.
    pub fn stays_within(
        &self,
        band: f64,
        until: Instant,
        record: &mut dyn Record,
    ) -> Result<bool, RecordError> {
        let Motion::Planar(arc) = &self.motion else { return Ok(false) };
        let span = until.since(self.departed);
        let guards = [Guard::at_least(band), Guard::at_most(-band)];
        Ok(arc.stays_within(band, span.seconds())
            || arc.knows_bounds()
                && locate(arc, &guards, span, &mut self.state.clone(), || record.poll())?.is_none())
    }

    /// Expands the segment from its start to `until` and passes each piece to `take`.
    pub fn walk(
        &self,
        until: Instant,
        exerted: &Exerted,
        mut take: impl FnMut(&Stretch) -> Result<(), RecordError>,
    ) -> Result<(), RecordError> {
        self.pieces(until, |series, h, length| take(&self.observed(series, (h, length), exerted)))
    }

    /// Passes the series of each piece from the segment's start to `until` to `take`, with its begin after that start
    /// and its length (s).
    fn pieces(
        &self,
        until: Instant,
        mut take: impl FnMut(&Expansion, f64, f64) -> Result<(), RecordError>,
    ) -> Result<(), RecordError> {
        let span = until.since(self.departed).seconds();
        let mut unfolded = match &self.motion {
            Motion::Planar(arc) => Unfolded::Planar(arc, self.state.clone()),
            Motion::Chain(flight) => Unfolded::Chain(flight.unfold()),
            Motion::Coupled(coupling) => Unfolded::Coupled(coupling.unfold()),
            Motion::Lent(_) => return Ok(()),
        };
        let coordinates = match &self.motion {
            Motion::Chain(flight) => flight.coordinates(),
            Motion::Planar(_) | Motion::Coupled(_) | Motion::Lent(_) => self.state.modes.len() + 1,
        };
        let mut series = Expansion::new(coordinates);
        let mut h = 0.0;
        while h < span {
            let reach = match &mut unfolded {
                Unfolded::Planar(arc, state) => arc.expand(h, 0.5 * span, state, &mut series),
                Unfolded::Chain(flown) => flown.expand(h, 0.5 * span, &mut series),
                Unfolded::Coupled(unfolding) => unfolding.expand(h, span, &mut series),
            };
            // A motion at rest, or one that is not finite, is one piece.
            let next = if reach > 0.0 && h + reach > h { span.min(h + reach) } else { span };
            take(&series, h, next - h)?;
            h = next;
        }
        Ok(())
    }

    /// Returns the observed coordinates over a piece with begin `after` the segment's start and given length (s).
    fn observed(&self, series: &Expansion, (after, length): (f64, f64), exerted: &Exerted) -> Stretch {
        let Expansion { coordinates, command } = series;
        let add = |sum: &mut Series, weight: f64, of: &Series| {
            sum.iter_mut().zip(of).for_each(|(sum, c)| *sum += weight * c);
        };
        let mut angle = coordinates[0];
        let shows = match &self.motion {
            Motion::Planar(arc) => arc.shows_modes(),
            Motion::Coupled(_) | Motion::Lent(_) => true,
            Motion::Chain(_) => false,
        };
        if shows {
            coordinates[1..].iter().for_each(|mode| add(&mut angle, 1.0, mode));
        }
        let mut applied = *command;
        applied[0] += exerted.constant;
        let (back_emf, total) = exerted.back_emf;
        if back_emf != 0.0 {
            let felt = if total { &angle } else { &coordinates[0] };
            for n in 0..TERMS - 1 {
                applied[n] -= back_emf * (n + 1) as f64 * felt[n + 1];
            }
        }
        let output = |index: usize, output: &Output| {
            let mut sum = [0.0; TERMS];
            if let Motion::Chain(_) = &self.motion {
                // The outputs of a chain are the angles of its sections relative to the hub.
                add(&mut sum, 1.0, &coordinates[index + 1]);
                add(&mut sum, -1.0, &coordinates[0]);
            } else {
                add(&mut sum, output.rigid.get(), &coordinates[0]);
                let modes = output.modes.iter().zip(&coordinates[1..]);
                modes.for_each(|(weight, mode)| add(&mut sum, weight.get(), mode));
            }
            Polynomial::of(&sum, length)
        };
        Stretch {
            from: self.departed.seconds() + after,
            length,
            angle: Polynomial::of(&angle, length),
            outputs: self.outputs.iter().enumerate().map(|(index, of)| output(index, of)).collect(),
            applied: Polynomial::of(&applied, length),
            feedback: exerted.feedback,
        }
    }

    /// Expands the motion between two instants of this segment: passes the observed coordinates and the rigid angle of
    /// each piece to `take`.
    pub fn measure(
        &self,
        [since, until]: [Instant; 2],
        exerted: &Exerted,
        mut take: impl FnMut(&Stretch, &Polynomial),
    ) {
        let first = since.max(self.departed).since(self.departed).seconds();
        let _ = self.pieces(until, |series, h, length| {
            let late = (first - h).max(0.0);
            if late < length {
                let whole = self.observed(series, (h, length), exerted);
                let rigid = Polynomial::of(&series.coordinates[0], length);
                let from = late / length;
                if late > 0.0 {
                    let part = Stretch {
                        from: whole.from + late,
                        length: length - late,
                        angle: whole.angle.part(from, 1.0),
                        applied: whole.applied.part(from, 1.0),
                        ..whole
                    };
                    take(&part, &rigid.part(from, 1.0));
                } else {
                    take(&whole, &rigid);
                }
            }
            Ok(())
        });
    }
}
