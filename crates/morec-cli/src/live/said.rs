//! An event with everything that a sink may want to tell of it.

use morec::live::{Event, Phase};

/// An event, its class's name and its source.
#[derive(Debug, Clone, Copy)]
pub struct Said<'a> {
    /// What the session said.
    pub event: &'a Event,
    /// The class's name.
    pub class: &'a str,
    /// The source as it was typed.
    pub source: &'a str,
}

impl Said<'_> {
    /// Whether it is the final word on a motion.
    pub fn is_final(&self) -> bool {
        self.event.phase == Phase::End
    }

    /// As one line of JSON, without the line's end.
    pub fn json(&self) -> String {
        let e = self.event;
        serde_json::json!({
            "type": "motion",
            "phase": e.phase.name(),
            "class": self.class,
            "score": rounded(e.score, 4),
            "progress": rounded(e.progress, 3),
            "start_secs": rounded(e.start_secs, 4),
            "stop_secs": rounded(e.stop_secs, 4),
            "reported_secs": rounded(e.reported_secs, 4),
            "start_wall": utc(e.wall_at_secs(e.start_secs)),
            "stop_wall": utc(e.wall_at_secs(e.stop_secs)),
            "source": self.source,
            "actor": e.actor.0,
            "motion": e.motion,
            "seq": e.sequence,
        })
        .to_string()
    }
}

fn rounded(value: f64, digits: i32) -> f64 {
    let scale = 10f64.powi(digits);
    (value * scale).round() / scale
}

/// Seconds since 1970 as `2026-11-21T04:46:50.123Z`.
pub fn utc(secs: f64) -> String {
    let millis = (secs * 1000.0).round().max(0.0) as u64;
    let (days, in_day) = (millis / 86_400_000, millis % 86_400_000);
    // Days to a date of the Gregorian calendar, by eras of 400 years that begin on the first of March.
    let shifted = days + 719_468;
    let (era, day) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day_of_year = day - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day_of_month = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    let (secs, millis) = (in_day / 1000, in_day % 1000);
    let (hours, minutes, secs) = (secs / 3600, secs / 60 % 60, secs % 60);
    format!("{year:04}-{month:02}-{day_of_month:02}T{hours:02}:{minutes:02}:{secs:02}.{millis:03}Z")
}

#[cfg(test)]
mod tests {
    use super::utc;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(utc(0.0), "1970-01-01T00:00:00.000Z");
        assert_eq!(utc(951_782_400.5), "2000-02-29T00:00:00.500Z");
        assert_eq!(utc(1_793_248_010.0), "2026-10-29T04:26:50.000Z");
        assert_eq!(utc(4_107_542_399.999), "2100-02-28T23:59:59.999Z");
        assert_eq!(utc(4_107_542_400.0), "2100-03-01T00:00:00.000Z");
    }
}
