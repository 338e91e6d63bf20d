//! Dates: the angle of Greenwich, and the year with its fraction.

use std::f64::consts::TAU;

use super::phase::remainder_of_product;

/// Seconds from 1970 to noon of the first day of 2000.
pub const J2000: f64 = 946_728_000.0;

/// Seconds of a day.
pub const DAY: f64 = 86_400.0;

/// Returns the angle of the meridian of Greenwich from the mean equinox (rad, 0 to 2 pi) at `epoch_ns` nanoseconds
/// after 1970, UTC: mean sidereal time by the formula of 1982, with UT1 = UTC.
pub fn greenwich(epoch_ns: u64) -> f64 {
    let days = (epoch_ns as f64 / 1e9 - J2000) / DAY;
    let centuries = days / 36_525.0;
    // Its 876600 hours a century are the days themselves; the next term is reduced to a day without loss.
    let seconds = 67_310.548_41
        + DAY * (days - days.floor())
        + remainder_of_product(8_640_184_812_866.0, days, 36_525e6 * DAY) / 36_525e6
        + centuries * centuries * (0.093_104 - centuries * 6.2e-6);
    TAU * (seconds / DAY).rem_euclid(1.0)
}

/// Returns the year with its fraction at `seconds` after 1970, UTC, in the Gregorian calendar.
pub fn year(seconds: f64) -> f64 {
    let days = seconds / DAY;
    let begins = |year: f64| {
        let past = year - 1.0;
        let leap_days = libm::floor(past / 4.0) - libm::floor(past / 100.0) + libm::floor(past / 400.0);
        // 1970 begins after 477 leap days.
        365.0 * (year - 1970.0) + leap_days - 477.0
    };
    // The estimate is at most one year off near the turn of a year.
    let near = libm::floor(1970.0 + days / 365.2425);
    let year = if days < begins(near) {
        near - 1.0
    } else if days >= begins(near + 1.0) {
        near + 1.0
    } else {
        near
    };
    year + (days - begins(year)) / (begins(year + 1.0) - begins(year))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn years_begin_on_the_first_of_january() {
        // Seconds since 1970 (`date --utc +%s`).
        for (seconds, exact) in [
            (0.0, 1970.0),
            (946_684_800.0, 2000.0),                   // 2000-01-01
            (951_782_400.0, 2000.0 + 59.0 / 366.0),    // 2000-02-29
            (1_735_689_600.0, 2025.0),                 // 2025-01-01
            (1_767_182_400.0, 2025.0 + 364.5 / 365.0), // 2025-12-31T12:00:00Z
            (1_767_225_600.0, 2026.0),                 // 2026-01-01
            (4_102_444_800.0, 2100.0),                 // 2100-01-01
            (4_133_980_800.0, 2101.0),                 // 2101-01-01
        ] {
            assert!((year(seconds) - exact).abs() < 1e-9, "{seconds}: {}", year(seconds));
        }
    }

    #[test]
    fn greenwich_is_where_erfa_has_it() {
        // Seconds since 1970 (`date --utc +%s`) and ERFA's gmst82 with UT1 = UTC (rad).
        for (seconds, angle) in [
            (1_774_017_960, 0.691_984_659), // 2026-03-20T14:46:00Z
            (1_782_030_240, 0.620_491_352), // 2026-06-21T08:24:00Z
            (1_795_478_400, 1.098_991_055), // 2026-11-24T00:00:00Z
            (1_798_977_600, 4.937_296_780), // 2027-01-03T12:00:00Z
            (1_914_517_800, 4.511_043_448), // 2030-09-01T18:30:00Z
        ] {
            let found = greenwich(seconds * 1_000_000_000);
            assert!((found - angle).abs() < 1e-9, "{seconds}: {found}");
        }
    }
}
