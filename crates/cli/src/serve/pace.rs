//! Pace of a run in lockstep: as fast as its client answers, with the wall clock, or as its client requests cycles.

use std::time::{Duration, Instant as WallInstant};

use flexsc_core::numerics::time::Instant;

/// Largest lag of a run behind the wall clock that it catches up with.
const LARGEST_LAG: Duration = Duration::from_millis(100);

/// Pace of a run.
#[derive(Copy, Clone, Debug)]
pub enum Pace {
    /// The next cycle begins with the answer to the last one.
    Free,
    /// Cycles begin with the wall clock, on which the run began at this instant.
    RealTime(Option<WallInstant>),
    /// Each cycle begins when the client requests it.
    Step,
}

impl Pace {
    /// Returns the code of the pace in a welcome.
    pub fn code(self) -> u8 {
        match self {
            Self::Free => 0,
            Self::RealTime(_) => 1,
            Self::Step => 2,
        }
    }

    /// Returns the time to wait until the instant `now` of the run; `None` if it has come, or is not waited for.
    pub fn wait(&mut self, now: Instant) -> Option<Duration> {
        let Self::RealTime(began) = self else { return None };
        let at = Duration::try_from_secs_f64(now.seconds()).ok()?;
        let began = began.get_or_insert_with(WallInstant::now);
        let elapsed = began.elapsed();
        if let Some(wait) = at.checked_sub(elapsed).filter(|wait| !wait.is_zero()) {
            return Some(wait);
        }
        *began += elapsed.saturating_sub(at).saturating_sub(LARGEST_LAG);
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_core::numerics::time::Span;

    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    #[test]
    fn a_run_follows_the_wall_clock_and_does_not_catch_up_long_delays() {
        assert_eq!(Pace::Free.wait(at(1e6)), None);
        let mut pace = Pace::RealTime(None);
        assert_eq!(pace.wait(at(0.0)), None);
        let wait = pace.wait(at(1000.0)).expect("in the future");
        assert!(wait > Duration::from_secs(990), "{wait:?}");
        let hour = Duration::from_secs(3600);
        let mut late = Pace::RealTime(WallInstant::now().checked_sub(hour));
        assert_eq!(late.wait(at(0.0)), None);
        let wait = late.wait(at(1.0)).expect("not an hour to catch up");
        assert!(wait > Duration::from_millis(500), "{wait:?}");
    }
}
