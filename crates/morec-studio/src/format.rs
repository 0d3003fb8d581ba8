//! Numbers as people read them.

use morec_db::labels::{DbSample, SampleState};

/// A sample's class, and whether it is proposed.
pub fn class(sample: &DbSample) -> String {
    match sample.state {
        SampleState::Proposed => format!("proposed {}", sample.class),
        _ => sample.class.clone(),
    }
}

/// A time in a clip: `1:02.35`, below a minute `2.35 s`.
pub fn secs(secs: f64) -> String {
    match secs.abs() < 60.0 {
        true => format!("{secs:.2} s"),
        false => clock(secs, 2),
    }
}

/// Minutes and seconds, with this many decimals.
pub fn clock(secs: f64, decimals: usize) -> String {
    let sign = if secs < 0.0 { "-" } else { "" };
    // Rounded before it is divided: 59.999 s is 1:00.
    let unit = 10f64.powi(decimals as i32);
    let secs = (secs.abs() * unit).round() / unit;
    let (hours, minutes) = ((secs / 3600.0) as u64, (secs / 60.0) as u64 % 60);
    let width = if decimals > 0 { 3 + decimals } else { 2 };
    let rest = format!("{:0width$.decimals$}", secs % 60.0);
    match hours {
        0 => format!("{sign}{minutes}:{rest}"),
        _ => format!("{sign}{hours}:{minutes:02}:{rest}"),
    }
}

/// A length of time: `42 s`, `3.5 min`, `2.1 h`.
pub fn duration(secs: f64) -> String {
    match secs {
        s if s < 10.0 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// Seconds since 1970 as a date and a time in UTC: `2026-11-30 07:02:01 UTC`.
pub fn utc(secs: i64) -> String {
    let (days, time) = (secs.div_euclid(86_400), secs.rem_euclid(86_400));
    // Civil from days: H. Hinnant, "chrono-Compatible Low-Level Date Algorithms".
    let z = days + 719_468;
    let (era, day) = (z.div_euclid(146_097), z.rem_euclid(146_097));
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    let m = (5 * of_year + 2) / 153;
    let (date, month) = (
        of_year - (153 * m + 2) / 5 + 1,
        if m < 10 { m + 3 } else { m - 9 },
    );
    let year = year + era * 400 + i64::from(month <= 2);
    format!(
        "{year:04}-{month:02}-{date:02} {:02}:{:02}:{:02} UTC",
        time / 3600,
        time / 60 % 60,
        time % 60
    )
}

/// Changes of labels in words.
pub fn changed_labels(counts: &morec_db::labels::Added) -> String {
    let parts = [
        (counts.added, "added"),
        (counts.changed, "judged anew"),
        (counts.moved, "moved"),
        (counts.renamed, "renamed"),
        (counts.gone, "gone"),
        (counts.unchanged, "as before"),
        (counts.people, "people of clips"),
        (counts.annotated, "given an annotator"),
    ];
    let parts = parts.into_iter().filter(|(n, _)| *n > 0);
    let parts: Vec<String> = parts.map(|(n, what)| format!("{n} {what}")).collect();
    match parts.is_empty() {
        true => "no labels".to_owned(),
        false => format!("labels: {}", parts.join(", ")),
    }
}

/// One thing or several: `1 clip`, `2 clips`.
pub fn count(n: usize, what: &str) -> String {
    // "class" becomes "classes", "stretch" "stretches".
    let plural = match what.ends_with(['s', 'h']) {
        true => format!("{what}es"),
        false => format!("{what}s"),
    };
    match n {
        1 => format!("1 {what}"),
        n => format!("{} {plural}", grouped(n)),
    }
}

/// A number with thin gaps between thousands.
pub fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            out.push('\u{2009}');
        }
        out.push(digit);
    }
    out
}

/// The last part of a path: what a window says of a file.
pub fn file_name(path: &std::path::Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// A command line with absolute paths shortened to their last parts, for the line at the bottom of the window.
pub fn without_folders(line: &str) -> String {
    let mut quoted = false;
    let words = line.split(|letter| {
        quoted ^= letter == '\'';
        letter == ' ' && !quoted
    });
    let short = |word: &str| {
        let inside = word.trim_matches('\'');
        let (kind, path) = match inside.strip_prefix("clip://") {
            Some(path) => ("clip://", path),
            None => ("", inside),
        };
        let drive = path.get(1..3) == Some(":\\");
        let name = match path.starts_with('/') || drive {
            true => path.rsplit(['/', '\\']).next().unwrap_or(path),
            false => return word.to_owned(),
        };
        match name.contains(' ') {
            true => format!("'{kind}{name}'"),
            false => format!("{kind}{name}"),
        }
    };
    words.map(short).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_read_without_folders() {
        let line = "morec db cut /home/a/moves.mdb --method kernel";
        assert_eq!(
            without_folders(line),
            "morec db cut moves.mdb --method kernel"
        );
        let line = "morec train --db '/tmp/my moves/a b.mdb' -o studio.index";
        assert_eq!(
            without_folders(line),
            "morec train --db 'a b.mdb' -o studio.index"
        );
        let line = "morec live studio.index --listen clip:///tmp/a/walk.bvh";
        assert_eq!(
            without_folders(line),
            "morec live studio.index --listen clip://walk.bvh"
        );
        let line = "morec live studio.index --listen vmc://0.0.0.0:39539";
        assert_eq!(without_folders(line), line);
    }

    #[test]
    fn times_read_as_people_write_them() {
        assert_eq!(secs(2.345), "2.35 s");
        assert_eq!(clock(62.3, 1), "1:02.3");
        assert_eq!(clock(59.96, 1), "1:00.0");
        assert_eq!(clock(3725.0, 0), "1:02:05");
        assert_eq!(duration(42.2), "42 s");
        assert_eq!(utc(0), "1970-01-01 00:00:00 UTC");
        assert_eq!(utc(1_795_330_800), "2026-11-22 07:00:00 UTC");
        assert_eq!(count(2, "class"), "2 classes");
        assert_eq!(count(40, "stretch"), "40 stretches");
        assert_eq!(count(10_000, "clip"), "10\u{2009}000 clips");
    }
}
