//! Dates in UTC from counts of nanoseconds. As in the rest of flexsc, every day has 86 400 s.

/// Date and time of day.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct CivilDate {
    /// Year.
    pub year: u64,
    /// Month, from 1.
    pub month: u64,
    /// Day of the month, from 1.
    pub day: u64,
    /// Hour.
    pub hour: u64,
    /// Minute.
    pub minute: u64,
    /// Nanoseconds past the minute.
    pub nanoseconds: u64,
}

impl CivilDate {
    /// Creates the date of a number of nanoseconds since 1970.
    pub fn from_nanoseconds(since_1970: u64) -> Self {
        const MINUTE: u64 = 60_000_000_000;
        const DAYS_OF_400_YEARS: u64 = 146_097;
        let (minutes, nanoseconds) = (since_1970 / MINUTE, since_1970 % MINUTE);
        let (hours, minute) = (minutes / 60, minutes % 60);
        // Days since 1 March of the year 0, so that a leap day comes last in its year.
        let days = hours / 24 + 719_468;
        let (era, day) = (days / DAYS_OF_400_YEARS, days % DAYS_OF_400_YEARS);
        let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
        let day = day - (365 * year + year / 4 - year / 100);
        let from_march = (5 * day + 2) / 153;
        let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
        Self {
            year: 400 * era + year + u64::from(month < 3),
            month,
            day: day - (153 * from_march + 2) / 5 + 1,
            hour: hours % 24,
            minute,
            nanoseconds,
        }
    }

    /// Returns the date as `2026-03-20T14:46:00.000000000`.
    pub fn to_text(self) -> String {
        let Self { year, month, day, hour, minute, nanoseconds } = self;
        let (second, part) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
        format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{part:09}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        // date --utc --date=@SECONDS +%FT%T
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00"),
            (951_782_399, "2000-02-28T23:59:59"),
            (951_782_400, "2000-02-29T00:00:00"),
            (1_709_251_199, "2024-02-29T23:59:59"),
            (1_774_017_960, "2026-03-20T14:46:00"),
            (4_107_542_399, "2100-02-28T23:59:59"),
            (4_107_542_400, "2100-03-01T00:00:00"),
            (16_725_225_599, "2499-12-31T23:59:59"),
        ] {
            let date = CivilDate::from_nanoseconds(seconds * 1_000_000_000 + 5);
            assert_eq!(date.to_text(), format!("{text}.000000005"));
        }
    }
}
