//! Opens the sinks on the command line, and prints events.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result};
use morec::index::MotionIndex;
use morec::live::Phase;
use morec_live::{Address, JsonLines, NamedEvent, Sink, WebcamPage, open_sink};

use crate::output;

/// Opens a sink as it was typed; says where it is, if that was left open.
fn open(address: &Address) -> Result<Box<dyn Sink>> {
    match address.kind.as_str() {
        "terminal" => Ok(Box::new(Terminal)),
        "json" if address.place == "-" => Ok(Box::new(JsonLines(io::stdout()))),
        "json" => {
            let file =
                output::growing(Path::new(&address.place)).with_context(|| address.to_string())?;
            Ok(Box::new(JsonLines(BufWriter::new(file))))
        }
        _ => {
            let opened = open_sink(address)?;
            opened
                .notes
                .iter()
                .for_each(|note| eprintln!("morec: {note}"));
            Ok(opened.sink)
        }
    }
}

/// One line for each motion, and each repetition that is an event of its own, on standard output.
pub struct Terminal;

impl Sink for Terminal {
    fn emit(&mut self, event: &NamedEvent<'_>) -> io::Result<()> {
        let e = event.event;
        let repeated = match (e.phase, e.repetitions) {
            (Phase::End, None) => String::new(),
            (Phase::End, Some(r)) => format!("  {} times, {:.2} s each", r.count, r.period_secs),
            (Phase::Repetition, Some(r)) => format!("  repetition {}", r.count),
            _ => return Ok(()),
        };
        let off = e.deviation.map_or_else(String::new, |d| {
            let (off, pace, worst) = (d.off_degrees, d.pace, d.worst_degrees);
            format!(
                "  {off:.0}° off, {}: {worst:.0}°, {pace:.2} × the time",
                d.worst_bone
            )
        });
        let performer = match e.actor.0 {
            0 => String::new(),
            number => format!("  (performer {number})"),
        };
        let mut out = crate::console::stdout();
        writeln!(
            out,
            "{:9.2} to {:7.2} s  {:20} {:.2}  reported {:.2} s after its end{repeated}{off}{performer}",
            e.span.start_secs,
            e.span.stop_secs,
            event.class,
            e.score,
            e.reported_secs - e.span.stop_secs,
        )?;
        out.flush()
    }
}

/// A sink that was opened, and how often it failed.
pub struct CountedSink {
    address: Address,
    sink: Box<dyn Sink>,
    failures: u64,
}

impl CountedSink {
    /// Opens a sink.
    pub fn open(address: &Address) -> Result<Self> {
        Ok(Self {
            address: address.clone(),
            sink: open(address)?,
            failures: 0,
        })
    }

    /// The page of the webcam at `address`.
    pub fn page(address: &Address, page: &WebcamPage) -> Self {
        Self {
            address: address.clone(),
            sink: Box::new(page.clone()),
            failures: 0,
        }
    }

    /// Emits an event; failures are counted, and the first is returned to be shown. A sink that fails does not end a
    /// session, unless it is standard output that nobody reads any more.
    pub fn emit(&mut self, event: &NamedEvent<'_>) -> Result<Option<String>> {
        let Err(error) = self.sink.emit(event) else {
            return Ok(None);
        };
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Err(error.into());
        }
        self.failures += 1;
        Ok((self.failures == 1).then(|| format!("{}: {error}", self.address)))
    }

    /// True if a record of the events lacks some, `dropped` of them before they came here: the record does not show it.
    pub fn is_incomplete(&self, dropped: u64) -> bool {
        self.failures + dropped > 0 && self.address.kind == "json"
    }

    /// Closing line about it, if there is one.
    pub fn farewell(&self) -> Option<String> {
        (self.failures > 0).then(|| {
            format!(
                "{}: {} events could not be delivered",
                self.address, self.failures
            )
        })
    }
}

/// Shows a bar for each class of an index on the page of a webcam.
pub fn show_classes(page: &WebcamPage, index: &MotionIndex) {
    let classes = index.model.classes().iter();
    page.classes(classes.map(|class| class.name.as_str()));
}
