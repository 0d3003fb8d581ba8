//! Moments as dates in UTC, ISO 8601.

use std::time::{SystemTime, UNIX_EPOCH};

/// The present time to the second, `2026-11-21T04:46:50Z`.
pub fn now() -> String {
    let secs = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |d| d.as_secs() as i64);
    format!("{}Z", to_the_second(secs))
}

/// Seconds since 1970 to the thousandth, `2026-11-21T04:46:50.123Z`; not before 1970.
pub fn with_millis(secs: f64) -> String {
    let millis = (secs * 1000.0).round().max(0.0) as i64;
    format!("{}.{:03}Z", to_the_second(millis / 1000), millis % 1000)
}

/// Seconds since 1970, `2026-11-21T04:46:50`.
pub fn to_the_second(secs: i64) -> String {
    let (days, time) = (secs.div_euclid(86_400), secs.rem_euclid(86_400));
    let (year, month, day) = civil(days);
    format!(
        "{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}",
        time / 3600,
        time / 60 % 60,
        time % 60
    )
}

/// Year, month and day of a day counted from 1970-01-01, in the Gregorian calendar. Years are counted from March,
/// so that the leap day is their last.
fn civil(days: i64) -> (i64, i64, i64) {
    let since_0000_03_01 = days + 719_468;
    let era = since_0000_03_01.div_euclid(146_097);
    let day_of_era = since_0000_03_01.rem_euclid(146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 {
        month_from_march + 3
    } else {
        month_from_march - 9
    };
    (year_of_era + era * 400 + i64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::{civil, with_millis};

    #[test]
    fn days_are_dates() {
        assert_eq!(civil(0), (1970, 1, 1));
        assert_eq!(civil(-1), (1969, 12, 31));
        assert_eq!(civil(11_016), (2000, 2, 29));
        assert_eq!(civil(20_778), (2026, 11, 21));
    }

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(with_millis(0.0), "1970-01-01T00:00:00.000Z");
        assert_eq!(with_millis(951_782_400.5), "2000-02-29T00:00:00.500Z");
        assert_eq!(with_millis(1_793_248_010.0), "2026-10-29T04:26:50.000Z");
        assert_eq!(with_millis(4_107_542_399.999), "2100-02-28T23:59:59.999Z");
        assert_eq!(with_millis(4_107_542_400.0), "2100-03-01T00:00:00.000Z");
    }
}
