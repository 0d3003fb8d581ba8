//! Moments as dates in UTC, ISO 8601.

use jiff::Timestamp;

/// Seconds since 1970 to the thousandth, `2026-11-21T04:46:50.123Z`; not before 1970.
pub fn with_millis(secs: f64) -> String {
    let millis = (secs * 1000.0).round().max(0.0) as i64;
    let moment = Timestamp::from_millisecond(millis).unwrap_or(Timestamp::MAX);
    moment.strftime("%FT%T%.3fZ").to_string()
}

/// Seconds since 1970, `2026-11-21T04:46:50`.
pub fn to_the_second(secs: i64) -> String {
    let moment = Timestamp::from_second(secs).unwrap_or_default();
    moment.strftime("%FT%T").to_string()
}

#[cfg(test)]
mod tests {
    use super::{to_the_second, with_millis};

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(to_the_second(-86_400), "1969-12-31T00:00:00");
        assert_eq!(with_millis(0.0), "1970-01-01T00:00:00.000Z");
        assert_eq!(with_millis(951_782_400.5), "2000-02-29T00:00:00.500Z");
        assert_eq!(with_millis(1_793_248_010.0), "2026-10-29T04:26:50.000Z");
        assert_eq!(with_millis(4_107_542_399.999), "2100-02-28T23:59:59.999Z");
        assert_eq!(with_millis(4_107_542_400.0), "2100-03-01T00:00:00.000Z");
    }
}
