//! Operators over time of the parser: windows, `until`, and events after `when`.

use flexsc_formats::document::number_in;

use super::super::condition::{ConditionFault, Expression, TimeWindow, Timed};
use super::super::quantity::ModeQuantity;
use super::{Parser, Place, fault};

impl Parser<'_> {
    /// Reads a part with `until` and the part after it, or a part alone.
    pub(super) fn until(&mut self) -> Result<Expression, ConditionFault> {
        self.skip_spaces();
        let start = self.at;
        let held = self.one()?;
        let end = self.at;
        if !self.operator("until", Place::Outermost)? {
            return Ok(held);
        }
        if held.has_timed(Timed::is_outermost) {
            return Err(fault(start..end, "has `until` or `when`, which cannot be within `until`"));
        }
        let window = self.window()?;
        let reached = self.inside(Place::Window, Self::one)?;
        Ok(Expression::Timed(Box::new(Timed::Until(held, window, reached))))
    }

    /// Takes an operator over time, if it comes next; `innermost` is the narrowest place that may have it.
    pub(super) fn operator(&mut self, word: &str, innermost: Place) -> Result<bool, ConditionFault> {
        if !self.take(word) {
            return Ok(false);
        }
        let why = match (&self.known.requirement, self.place) {
            (None, _) => {
                "is for requirements: a condition of a mode is tested at one instant, and `for` is how long it holds"
            }
            (_, Place::Instant) => {
                "cannot be in an event or in `during`, which are conditions at one instant"
            }
            (_, Place::Window) if innermost == Place::Outermost => {
                "cannot be within `always`, `eventually` or `until`"
            }
            _ => return Ok(true),
        };
        Err(fault(self.at - word.len()..self.at, why))
    }

    /// Reads the window of an operator, such as `[60 s, 300 s]`; without one, the rest of the run.
    pub(super) fn window(&mut self) -> Result<TimeWindow, ConditionFault> {
        let start = self.at + (self.rest().len() - self.rest().trim_start().len());
        if !self.take("[") {
            return Ok(TimeWindow::REST);
        }
        let Some(length) = self.rest().find(']') else {
            return Err(fault(start..start + 1, "has a bracket that is not closed"));
        };
        let whole = start..self.at + length + 1;
        let Some((from, to)) = self.rest()[..length].split_once(',') else {
            return Err(fault(
                whole,
                "needs two times, such as `[60 s, 300 s]`; the second one may be `end`",
            ));
        };
        let from = self.time(from, self.at)?;
        let to_at = self.at + length - to.len();
        let to = if to.trim() == "end" { None } else { Some(self.time(to, to_at)?) };
        if let Some(to) = to.filter(|to| *to < from) {
            return Err(fault(whole, format!("ends at {to} s, before it starts, at {from} s")));
        }
        self.at = whole.end;
        Ok(TimeWindow { from, to })
    }

    /// Reads a time of 0 or more from a text at a place.
    fn time(&self, text: &str, at: usize) -> Result<f64, ConditionFault> {
        let from = at + (text.len() - text.trim_start().len());
        let part = from..(from + text.trim().len()).max(from + 1).min(self.text.len());
        let time = number_in(text.trim(), "s").map_err(|why| fault(part.clone(), why))?;
        if time < 0.0 {
            return Err(fault(part, format!("must be a time of 0 s or more, got {time}")));
        }
        Ok(time)
    }

    /// Reads `within TIME` or `for TIME` before a sign, if it comes next.
    fn duration(&mut self, word: &str, innermost: Place) -> Result<Option<TimeWindow>, ConditionFault> {
        if !self.operator(word, innermost)? {
            return Ok(None);
        }
        let length = self.rest().find([',', ':']).unwrap_or(self.rest().len());
        let to = self.time(&self.rest()[..length], self.at)?;
        self.at += length;
        Ok(Some(TimeWindow { from: 0.0, to: Some(to) }))
    }

    /// Reads a part in another place.
    pub(super) fn inside(
        &mut self,
        place: Place,
        read: fn(&mut Self) -> Result<Expression, ConditionFault>,
    ) -> Result<Expression, ConditionFault> {
        let outside = std::mem::replace(&mut self.place, place);
        let inner = read(self);
        self.place = outside;
        inner
    }

    /// Reads an event: `mode enters NAME`, or a condition that becomes true.
    pub(super) fn trigger(&mut self) -> Result<Expression, ConditionFault> {
        let start = self.at;
        if self.take("mode") && self.take("enters") {
            self.skip_spaces();
            let part = self.next_part();
            self.at = part.end;
            return Ok(Expression::Flag(ModeQuantity::Mode(
                self.mode_index(part.clone(), &self.text[part])?,
            )));
        }
        self.at = start;
        self.instant()
    }

    /// Reads a condition without operators over time.
    pub(super) fn instant(&mut self) -> Result<Expression, ConditionFault> {
        self.inside(Place::Instant, Self::any)
    }

    /// Reads an event after `when`, its times `within` and `for`, and the expression that then holds.
    pub(super) fn when(&mut self) -> Result<Expression, ConditionFault> {
        let trigger = self.trigger()?;
        self.colon("the event")?;
        let within = self.duration("within", Place::Window)?;
        if within.is_some() {
            self.take(",");
        }
        let held = self.duration("for", Place::Window)?;
        if within.or(held).is_some() {
            self.colon("the time")?;
        }
        let inner = if within.or(held).is_some() { Place::Window } else { Place::Outermost };
        let mut then = self.inside(inner, Self::formula)?;
        if let Some(window) = held {
            then = then.always(window);
        }
        if let Some(window) = within {
            then = then.eventually(window);
        }
        Ok(Expression::Timed(Box::new(Timed::When(trigger, then))))
    }

    /// Reads a colon after a part of `when`.
    fn colon(&mut self, after: &str) -> Result<(), ConditionFault> {
        if self.take(":") {
            return Ok(());
        }
        let part = self.next_part();
        let part = if part.is_empty() { self.text.len().saturating_sub(1)..self.text.len() } else { part };
        Err(fault(part, format!("needs a `:` after {after} of `when`")))
    }
}
