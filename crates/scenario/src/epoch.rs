//! Date of a run's start, as a count of nanoseconds.

use std::fmt;

use flexsc_formats::document::{ConfigError, DATE};
use serde::Deserializer;
use serde::de::{Error, Visitor};
use toml::value::Datetime;

/// Deserialises a date and time.
pub fn parse<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Datetime>, D::Error> {
    struct Date;
    impl Visitor<'_> for Date {
        type Value = Datetime;

        fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
            formatter.write_str("a date and time without quotes, such as 2026-03-20T14:46:00Z")
        }

        fn visit_str<E: Error>(self, text: &str) -> Result<Datetime, E> {
            text.parse().map_err(E::custom)
        }
    }
    deserializer.deserialize_newtype_struct(DATE, Date).map(Some)
}

/// Checks that a scenario's `epoch` is a date and time from 1970 to 2500.
pub fn validate(epoch: Option<&Datetime>) -> Option<ConfigError> {
    let why = "must be a date and time from 1970 to 2500, such as 2026-03-20T14:46:00Z; a second 60 is a leap second, at the \
               end of June or December, UTC";
    epoch.filter(|epoch| nanoseconds_since_1970(epoch).is_none()).map(|_| ConfigError::new("epoch", why))
}

/// Returns the nanoseconds since 1970 of a date and time as a scenario would write it, such as `2026-03-20T14:46:00Z`;
/// `None` for another text, or a date outside 1970 to 2500.
pub fn date_from_text(text: &str) -> Option<u64> {
    nanoseconds_since_1970(&text.parse().ok()?)
}

/// Returns the nanoseconds since 1970 of a date and time, which is UTC unless it has an offset; `None` outside 1970 to
/// 2500, and for a second 60 that cannot be a leap second. A leap second has the count of the second after it.
pub fn nanoseconds_since_1970(epoch: &Datetime) -> Option<u64> {
    let (date, time) = (epoch.date?, epoch.time?);
    // Days in the civil calendar, with years that begin in March, so that a leap day comes last.
    let (year, month) = (i64::from(date.year), i64::from(date.month));
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let days = 365 * year + year.div_euclid(4) - year.div_euclid(100)
        + year.div_euclid(400)
        + (153 * month + 2) / 5
        + i64::from(date.day)
        - 719_469;
    let offset = match epoch.offset {
        Some(toml::value::Offset::Custom { minutes }) => i64::from(minutes) * 60,
        _ => 0,
    };
    let clock =
        i64::from(time.hour) * 3600 + i64::from(time.minute) * 60 + i64::from(time.second.unwrap_or(0));
    let seconds = u64::try_from(days * 86_400 + clock - offset).ok()?;
    let nanoseconds = u64::from(time.nanosecond.unwrap_or(0));
    let count = (date.year < 2500).then(|| seconds * 1_000_000_000 + nanoseconds)?;
    (time.second != Some(60) || follows_leap_second(count)).then_some(count)
}

/// Returns true if a leap second may be inserted before a count of nanoseconds since 1970: at the end of June or December, UTC.
fn follows_leap_second(nanoseconds: u64) -> bool {
    let Some(Datetime { date: Some(day), time: Some(time), .. }) = date(nanoseconds) else { return false };
    matches!((day.month, day.day), (1 | 7, 1)) && time.hour == 0 && time.minute == 0 && time.second == Some(0)
}

/// Returns the date and time, UTC, of a count of nanoseconds since 1970; `None` after 2500.
pub fn date(nanoseconds: u64) -> Option<Datetime> {
    let (seconds, fraction) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
    let (days, clock) = (seconds / 86_400, seconds % 86_400);
    // Years that begin in March, in eras of 400 years from 0000-03-01.
    let past = days + 719_468;
    let (era, in_era) = (past / 146_097, past % 146_097);
    let year = (in_era - in_era / 1460 + in_era / 36_524 - in_era / 146_096) / 365;
    let in_year = in_era - (365 * year + year / 4 - year / 100);
    let month = (5 * in_year + 2) / 153;
    let day = in_year - (153 * month + 2) / 5 + 1;
    let (month, turned) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    let (year, hour, minute, second) = (year + 400 * era + turned, clock / 3600, clock / 60 % 60, clock % 60);
    let text = format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{fraction:09}Z");
    text.parse().ok().filter(|_| year < 2500)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_their_counts() {
        for text in [
            "1970-01-01T00:00:00Z",
            "2000-02-29T23:59:59.123456789Z",
            "2006-06-26T18:52:04.079712Z",
            "2100-03-01T12:00:00Z",
        ] {
            let count = nanoseconds_since_1970(&text.parse().expect("a date")).expect("a count");
            let found = date(count).expect("a date");
            assert_eq!(nanoseconds_since_1970(&found), Some(count), "{text} {found}");
            assert!(found.to_string().starts_with(&text[..19]), "{text} {found}");
        }
        assert_eq!(date(u64::MAX), None);
    }

    #[test]
    fn epochs_count_from_1970() {
        let at = |text: &str| nanoseconds_since_1970(&text.parse().expect("a date"));
        assert_eq!(at("1970-01-01T00:00:00Z"), Some(0));
        // date --utc --date=2026-03-20T14:46:00Z +%s
        assert_eq!(at("2026-03-20T14:46:00Z"), Some(1_774_017_960_000_000_000));
        assert_eq!(at("2024-02-29T23:59:59.5+01:00"), Some(1_709_247_599_500_000_000));
        assert_eq!(at("1969-12-31T23:00:00Z"), None);
        assert_eq!(at("2026-03-20"), None);
    }

    /// A leap second ends the UTC day at the end of June or December; no other minute has a second 60.
    #[test]
    fn leap_seconds_end_half_years() {
        let at = |text: &str| nanoseconds_since_1970(&text.parse().expect("a date"));
        assert_eq!(at("2016-12-31T23:59:60Z"), at("2017-01-01T00:00:00Z"));
        assert_eq!(at("2015-07-01T01:59:60.5+02:00"), at("2015-07-01T00:00:00.5Z"));
        for text in [
            "2027-03-21T00:00:60Z",
            "2016-12-31T23:58:60Z",
            "2016-12-30T23:59:60Z",
            "2017-01-01T23:59:60+02:00",
        ] {
            assert_eq!(at(text), None, "{text}");
        }
    }
}
