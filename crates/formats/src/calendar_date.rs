//! Dates in the messages of the CCSDS (\[CCSDS502\]).

/// Returns the nanoseconds after 1970 of a date: `YYYY-MM-DDThh:mm:ss` or `YYYY-DDDThh:mm:ss`, with a fraction if any.
pub fn nanoseconds(text: &str) -> Option<u64> {
    let (date, time) = text.strip_suffix('Z').unwrap_or(text).split_once('T')?;
    let number = |text: &str, digits: usize, range: std::ops::RangeInclusive<i64>| {
        let is_number = text.len() == digits && text.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then(|| text.parse::<i64>().ok()).flatten().filter(|number| range.contains(number))
    };
    let (year, rest) = date.split_once('-')?;
    let year = number(year, 4, 1970..=2499)?;
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let before = if let Some((month, day)) = rest.split_once('-') {
        let (month, day) = (number(month, 2, 1..=12)? as usize, number(day, 2, 1..=31)?);
        let lengths = [31, if leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
        if day > lengths[month - 1] {
            return None;
        }
        lengths[..month - 1].iter().sum::<i64>() + day - 1
    } else {
        number(rest, 3, 1..=if leap { 366 } else { 365 })? - 1
    };
    let mut clock = time.splitn(3, ':');
    let (hour, minute) = (number(clock.next()?, 2, 0..=23)?, number(clock.next()?, 2, 0..=59)?);
    let seconds = clock.next()?;
    let (second, fraction) = seconds.split_once('.').unwrap_or((seconds, ""));
    let second = number(second, 2, 0..=59)?;
    if !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let digits: String = fraction.chars().chain("000000000".chars()).take(9).collect();
    let total = (((days_to(year) + before) * 24 + hour) * 60 + minute) * 60 + second;
    Some(u64::try_from(total).ok()? * 1_000_000_000 + digits.parse::<u64>().ok()?)
}

/// Returns the days from 1970 to the first day of a year.
pub fn days_to(year: i64) -> i64 {
    let past = year - 1;
    365 * (year - 1970) + past / 4 - past / 100 + past / 400 - 477
}

#[cfg(test)]
mod tests {
    use super::nanoseconds;

    #[test]
    fn dates_of_both_kinds_are_read() {
        for bad in
            ["2026-13-01T00:00:00", "2026-02-29T00:00:00", "2026-366T00:00:00", "1969-01-01T00:00:00", "x"]
        {
            assert_eq!(nanoseconds(bad), None, "{bad}");
        }
        assert_eq!(nanoseconds("2024-366T23:59:59.25Z"), nanoseconds("2024-12-31T23:59:59.25"));
        // date --utc --date=2026-11-24T00:00:00Z +%s: 1795478400.
        assert_eq!(nanoseconds("2026-11-24T00:00:00.500"), Some(1_795_478_400_500_000_000));
    }
}
