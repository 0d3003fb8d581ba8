//! Where events go.

use std::io::{BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result, bail};
use morec::live::Phase;

use super::address::Address;
use super::osc::OscSink;
use super::websocket::WebSocketSink;
use super::{Said, Sink};
use crate::output;

/// Opens a sink as it was typed; says where it is, if that was left open.
pub fn open(address: &Address) -> Result<Box<dyn Sink>> {
    Ok(match address.kind.as_str() {
        "terminal" => Box::new(Terminal),
        "json" if address.place == "-" => Box::new(JsonLines(Box::new(std::io::stdout()))),
        "json" => {
            let file =
                output::growing(Path::new(&address.place)).with_context(|| address.to_string())?;
            Box::new(JsonLines(Box::new(BufWriter::new(file))))
        }
        "osc" => Box::new(OscSink::open(address)?),
        "ws" => Box::new(WebSocketSink::open(address)?),
        other => bail!(
            "{address}: no sink is called {other}; there are terminal:-, json:-, json:FILE, osc://HOST:PORT, ws://HOST:PORT"
        ),
    })
}

/// One line for each motion, on standard output.
pub struct Terminal;

impl Sink for Terminal {
    fn tell(&mut self, said: &Said) -> Result<()> {
        let e = said.event;
        if e.phase != Phase::End {
            return Ok(());
        }
        let mut out = std::io::stdout().lock();
        writeln!(
            out,
            "{:9.2} to {:7.2} s  {:20} {:.2}  said {:.2} s after its end{}",
            e.start_secs,
            e.stop_secs,
            said.class,
            e.score,
            e.reported_secs - e.stop_secs,
            if e.actor.0 > 0 {
                format!("  (performer {})", e.actor.0)
            } else {
                String::new()
            },
        )?;
        Ok(out.flush()?)
    }
}

/// One JSON object a line.
struct JsonLines(Box<dyn Write>);

impl Sink for JsonLines {
    fn tell(&mut self, said: &Said) -> Result<()> {
        writeln!(self.0, "{}", said.json())?;
        // An event that waits in a buffer is late.
        Ok(self.0.flush()?)
    }
}

/// A sink that was opened, and how often it failed.
pub struct Outlet {
    address: Address,
    sink: Box<dyn Sink>,
    failures: u64,
}

impl Outlet {
    /// Opens a sink.
    pub fn open(address: &Address) -> Result<Self> {
        Ok(Self {
            address: address.clone(),
            sink: open(address)?,
            failures: 0,
        })
    }

    /// Tells an event; failures are counted, and the first is returned to be shown. A sink that fails does not end a
    /// session, unless it is standard output that nobody reads any more.
    pub fn tell(&mut self, said: &Said) -> Result<Option<String>> {
        let Err(error) = self.sink.tell(said) else {
            return Ok(None);
        };
        let broken = |e: &std::io::Error| e.kind() == std::io::ErrorKind::BrokenPipe;
        if error.downcast_ref::<std::io::Error>().is_some_and(broken) {
            return Err(error);
        }
        self.failures += 1;
        Ok((self.failures == 1).then(|| format!("{}: {error:#}", self.address)))
    }

    /// What to say of it at the end, if there is something.
    pub fn farewell(&self) -> Option<String> {
        (self.failures > 0).then(|| {
            format!(
                "{}: {} events could not be told",
                self.address, self.failures
            )
        })
    }
}
