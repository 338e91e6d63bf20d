//! One-axis motion as records receive it: piece by piece, in series that are exact to rounding.

use flexsc_dynamics::axis_model::AxisOutput;
use flexsc_dynamics::crossing::first_crossing;
use flexsc_dynamics::flow::{ChainExpansion, CoupledExpansion, UncoupledSegment};
use flexsc_dynamics::guard::Guard;
use flexsc_dynamics::{AxisState, MotionPiece, SeriesExpansion};
use flexsc_numerics::polynomial::{Polynomial, Series, TERMS};
use flexsc_numerics::time::Instant;
use flexsc_record::{Outputs, PieceDemand, Record, RecordError};

use super::super::one_axis_body::{OneAxisBody, OneAxisQuantities, output_row};
use super::{AppliedTorque, OneAxisFlow, OneAxisMotion};

/// Motion segment that is expanded in series from its start on.
enum SegmentExpansion<'a> {
    Uncoupled(&'a UncoupledSegment, AxisState),
    Chain(ChainExpansion<'a>),
    Coupled(CoupledExpansion<'a>),
}

impl OneAxisQuantities for OneAxisFlow {
    fn body(&self) -> &OneAxisBody {
        &self.body
    }

    fn output_row(&self) -> Option<Outputs> {
        match &self.motion {
            OneAxisMotion::Chain(flight) => output_row(flight.outputs()),
            OneAxisMotion::Uncoupled(_) | OneAxisMotion::Coupled(_) => self.body.output_row(),
        }
    }

    fn record_pieces(
        &self,
        now: Instant,
        applied: &AppliedTorque,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        match record.piece_demand() {
            PieceDemand::None => Ok(()),
            PieceDemand::Beyond(band) if self.stays_within(band, now, record)? => Ok(()),
            _ => self.pieces(now, |series, h, length| {
                record.piece(now, &self.observed_piece(series, (h, length), applied))
            }),
        }
    }

    fn expand(
        &self,
        [since, until]: [Instant; 2],
        applied: &AppliedTorque,
        take: &mut dyn FnMut(&MotionPiece, &Polynomial),
    ) {
        let first = since.max(self.departed).since(self.departed).seconds();
        let _ = self.pieces(until, |series, h, length| {
            let late = (first - h).max(0.0);
            if late < length {
                let whole = self.observed_piece(series, (h, length), applied);
                let rigid = Polynomial::from_series(&series.coordinates[0], length);
                let from = late / length;
                if late > 0.0 {
                    let part = MotionPiece {
                        from: whole.from + late,
                        length: length - late,
                        angle: whole.angle.restrict(from, 1.0),
                        applied: whole.applied.restrict(from, 1.0),
                        ..whole
                    };
                    take(&part, &rigid.restrict(from, 1.0));
                } else {
                    take(&whole, &rigid);
                }
            }
            Ok(())
        });
    }
}

impl OneAxisFlow {
    /// Returns true if the angle is certain to stay within `band` (rad) of 0 on this segment until `until`: by bounds,
    /// which are cheap, or else by a search for a crossing.
    ///
    /// # Errors
    /// Fails if the record ends the search.
    fn stays_within(&self, band: f64, until: Instant, record: &mut dyn Record) -> Result<bool, RecordError> {
        let OneAxisMotion::Uncoupled(arc) = &self.motion else { return Ok(false) };
        let span = until.since(self.departed);
        let guards = [Guard::at_least(band), Guard::at_most(-band)];
        Ok(arc.stays_within(band, span.seconds())
            || arc.has_bounds()
                && first_crossing(arc, &guards, span, &mut self.body.state.clone(), || record.poll())?
                    .is_none())
    }

    /// Passes the series of each piece from the segment's start to `until` to `take`, with its begin after that start
    /// and its length (s).
    fn pieces(
        &self,
        until: Instant,
        mut take: impl FnMut(&SeriesExpansion, f64, f64) -> Result<(), RecordError>,
    ) -> Result<(), RecordError> {
        let span = until.since(self.departed).seconds();
        let mut unfolded = match &self.motion {
            OneAxisMotion::Uncoupled(arc) => SegmentExpansion::Uncoupled(arc, self.body.state.clone()),
            OneAxisMotion::Chain(flight) => SegmentExpansion::Chain(flight.expansion()),
            OneAxisMotion::Coupled(coupling) => SegmentExpansion::Coupled(coupling.expansion()),
        };
        let coordinates = match &self.motion {
            OneAxisMotion::Chain(flight) => flight.coordinates(),
            OneAxisMotion::Uncoupled(_) | OneAxisMotion::Coupled(_) => self.body.state.modes.len() + 1,
        };
        let mut series = SeriesExpansion::new(coordinates);
        let mut h = 0.0;
        while h < span {
            let reach = match &mut unfolded {
                SegmentExpansion::Uncoupled(arc, state) => arc.expand(h, 0.5 * span, state, &mut series),
                SegmentExpansion::Chain(flown) => flown.expand(h, 0.5 * span, &mut series),
                SegmentExpansion::Coupled(unfolding) => unfolding.expand(h, span, &mut series),
            };
            // A motion at rest, or one that is not finite, is one piece.
            let next = if reach > 0.0 && h + reach > h { span.min(h + reach) } else { span };
            take(&series, h, next - h)?;
            h = next;
        }
        Ok(())
    }

    /// Returns the observed coordinates over a piece with begin `after` the segment's start and given length (s).
    fn observed_piece(
        &self,
        series: &SeriesExpansion,
        (after, length): (f64, f64),
        acting: &AppliedTorque,
    ) -> MotionPiece {
        let SeriesExpansion { coordinates, command } = series;
        let add = |sum: &mut Series, weight: f64, of: &Series| {
            sum.iter_mut().zip(of).for_each(|(sum, c)| *sum += weight * c);
        };
        let mut angle = coordinates[0];
        let shows = match &self.motion {
            OneAxisMotion::Uncoupled(arc) => arc.sensor_sees_modes(),
            OneAxisMotion::Coupled(_) => true,
            OneAxisMotion::Chain(_) => false,
        };
        if shows {
            coordinates[1..].iter().for_each(|mode| add(&mut angle, 1.0, mode));
        }
        let mut applied = *command;
        applied[0] += acting.constant;
        let (back_emf, total) = acting.back_emf;
        if back_emf != 0.0 {
            let sensed = if total { &angle } else { &coordinates[0] };
            for n in 0..TERMS - 1 {
                applied[n] -= back_emf * (n + 1) as f64 * sensed[n + 1];
            }
        }
        let output = |index: usize, output: &AxisOutput| {
            let mut sum = [0.0; TERMS];
            if let OneAxisMotion::Chain(_) = &self.motion {
                // The outputs of a chain are the angles of its sections relative to the hub.
                add(&mut sum, 1.0, &coordinates[index + 1]);
                add(&mut sum, -1.0, &coordinates[0]);
            } else {
                add(&mut sum, output.rigid.get(), &coordinates[0]);
                let modes = output.modes.iter().zip(&coordinates[1..]);
                modes.for_each(|(weight, mode)| add(&mut sum, weight.get(), mode));
            }
            Polynomial::from_series(&sum, length)
        };
        MotionPiece {
            from: self.departed.seconds() + after,
            length,
            angle: Polynomial::from_series(&angle, length),
            outputs: self.body.outputs.iter().enumerate().map(|(index, of)| output(index, of)).collect(),
            applied: Polynomial::from_series(&applied, length),
            feedback: acting.feedback,
        }
    }
}
