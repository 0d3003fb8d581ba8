//! An event with the names of its class and source, as sinks write it.

use jiff::Timestamp;
use morec::live::{Event, Phase};

/// An event, its class's name and its source.
#[derive(Debug, Clone, Copy)]
pub struct NamedEvent<'a> {
    /// The event, with numbers of classes and performers.
    pub event: &'a Event,
    /// The class's name.
    pub class: &'a str,
    /// The name of its source.
    pub source: &'a str,
}

impl NamedEvent<'_> {
    /// True if it is the final word on a motion.
    pub fn is_final(&self) -> bool {
        self.event.phase == Phase::End
    }

    /// As one line of JSON, without the line's end.
    pub fn json(&self) -> String {
        let e = self.event;
        let mut line = serde_json::json!({
            "type": "motion",
            "phase": e.phase.name(),
            "class": self.class,
            "score": rounded(e.score, 4),
            "progress": rounded(e.progress, 3),
            "start_secs": rounded(e.span.start_secs, 4),
            "stop_secs": rounded(e.span.stop_secs, 4),
            "reported_secs": rounded(e.reported_secs, 4),
            "start_wall": with_millis(e.wall_at_secs(e.span.start_secs)),
            "stop_wall": with_millis(e.wall_at_secs(e.span.stop_secs)),
            "source": self.source,
            "actor": e.actor.0,
            "motion": e.motion,
            "sequence": e.sequence,
        });
        if let Some(repeated) = e.repetitions {
            line["repetitions"] = repeated.count.into();
            line["period_secs"] = rounded(repeated.period_secs, 3).into();
        }
        if let Some(pace) = e.pace {
            line["pace"] = rounded(pace, 3).into();
        }
        if let Some(deviation) = e.deviation {
            line["off_degrees"] = rounded(deviation.off_degrees, 2).into();
            line["worst_bone"] = deviation.worst_bone.into();
            line["worst_degrees"] = rounded(deviation.worst_degrees, 2).into();
        }
        line.to_string()
    }
}

fn rounded(value: f64, digits: i32) -> f64 {
    let scale = 10f64.powi(digits);
    (value * scale).round() / scale
}

/// Seconds since 1970 to the thousandth, `2026-11-21T04:46:50.123Z`; not before 1970.
fn with_millis(secs: f64) -> String {
    let millis = (secs * 1000.0).round().max(0.0) as i64;
    let moment = Timestamp::from_millisecond(millis).unwrap_or(Timestamp::MAX);
    moment.strftime("%FT%T%.3fZ").to_string()
}

#[cfg(test)]
mod tests {
    use super::with_millis;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(with_millis(0.0), "1970-01-01T00:00:00.000Z");
        assert_eq!(with_millis(951_782_400.5), "2000-02-29T00:00:00.500Z");
        assert_eq!(with_millis(1_793_248_010.0), "2026-10-29T04:26:50.000Z");
        assert_eq!(with_millis(4_107_542_399.999), "2100-02-28T23:59:59.999Z");
        assert_eq!(with_millis(4_107_542_400.0), "2100-03-01T00:00:00.000Z");
    }
}
