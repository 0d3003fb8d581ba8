//! Points in time as dates in UTC (ISO 8601).

use jiff::Timestamp;

/// Seconds since 1970, `2026-11-21T04:46:50`.
pub fn to_the_second(secs: i64) -> String {
    let moment = Timestamp::from_second(secs).unwrap_or_default();
    moment.strftime("%FT%T").to_string()
}

#[cfg(test)]
mod tests {
    use super::to_the_second;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(to_the_second(-86_400), "1969-12-31T00:00:00");
        assert_eq!(to_the_second(951_782_400), "2000-02-29T00:00:00");
        assert_eq!(to_the_second(4_107_542_400), "2100-03-01T00:00:00");
    }
}
