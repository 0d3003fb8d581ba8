//! Addresses of sources and sinks as the user types them: `KIND://PLACE?option=value&option`. Parsing only; opening is done by
//! [`sources`](crate::sources) and [`sinks`](crate::sinks).

use std::fmt;
use std::net::{SocketAddr, ToSocketAddrs};
use std::str::FromStr;

use crate::LiveError;
use crate::error::Context;

/// The address of the camera of this machine.
const WEBCAM: &str = "webcam";

/// A source or a sink, not yet opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Address {
    /// Kind of the source or sink: `vmc`, `osc`, `json` …
    pub kind: String,
    /// Its place: a host and a port, a file, `-`.
    pub place: String,
    options: Vec<(String, String)>,
    typed: String,
}

impl FromStr for Address {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected KIND://PLACE, as vmc://127.0.0.1:39539, found {text}");
        // A webcam needs no place: any free port will do.
        let whole = match text.split('?').next() {
            Some(WEBCAM) => text.replacen(WEBCAM, "webcam://127.0.0.1:0", 1),
            _ => text.to_owned(),
        };
        // json:- and json:FILE are no URLs, and neither are these all.
        let (kind, rest) = whole.split_once(':').ok_or_else(wrong)?;
        let rest = rest.strip_prefix("//").unwrap_or(rest);
        let (place, options) = rest.split_once('?').unwrap_or((rest, ""));
        if kind.is_empty() || place.is_empty() {
            return Err(wrong());
        }
        let option = |text: &str| {
            let (name, value) = text.split_once('=').unwrap_or((text, ""));
            (name.to_owned(), value.to_owned())
        };
        let options = options
            .split('&')
            .filter(|o| !o.is_empty())
            .map(option)
            .collect();
        let typed = text.split('?').next().unwrap_or(text).to_owned();
        Ok(Self {
            kind: kind.to_owned(),
            place: place.to_owned(),
            options,
            typed,
        })
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.typed)
    }
}

impl Address {
    /// The place as a socket's address; the first one that a name resolves to.
    ///
    /// # Errors
    /// A place that is no HOST:PORT, or a name that has no address.
    pub fn socket(&self) -> Result<SocketAddr, LiveError> {
        let mut found = self
            .place
            .to_socket_addrs()
            .with_context(|| format!("{self}: expected HOST:PORT, as 127.0.0.1:39539"))?;
        let none = || LiveError::Address(format!("{self}: no address found for this host name"));
        found.next().ok_or_else(none)
    }

    /// The value of an option as it was typed.
    pub fn text(&self, name: &str) -> Option<&str> {
        let mut options = self.options.iter();
        options
            .find(|(n, _)| n == name)
            .map(|(_, value)| value.as_str())
    }

    /// The value of an option, as a number if it has one; `None` if it was not given.
    ///
    /// # Errors
    /// A value that is no number, or below 0.
    pub fn number(&self, name: &str, bare: f64) -> Result<Option<f64>, LiveError> {
        let Some((_, value)) = self.options.iter().find(|(n, _)| n == name) else {
            return Ok(None);
        };
        if value.is_empty() {
            return Ok(Some(bare));
        }
        match value.parse::<f64>() {
            Ok(number) if number.is_finite() && number >= 0.0 => Ok(Some(number)),
            _ => Err(LiveError::Address(format!(
                "{self}: option {name} expects a number, 0 or more, found {value}"
            ))),
        }
    }

    /// Refuses options that are not among `known`.
    ///
    /// # Errors
    /// Such an option.
    pub fn allow(&self, known: &[&str]) -> Result<(), LiveError> {
        let mut names = self.options.iter().map(|(name, _)| name.as_str());
        let Some(name) = names.find(|name| !known.contains(name)) else {
            return Ok(());
        };
        Err(LiveError::Address(match known {
            [] => format!("{self}: takes no options, found {name}"),
            _ => format!(
                "{self}: no option {name}; the options are {}",
                known.join(", ")
            ),
        }))
    }
}

/// Warning about a socket that listens to everybody, which is a choice.
pub(crate) fn openness(at: SocketAddr) -> Option<String> {
    at.ip().is_unspecified().then(|| {
        let port = at.port();
        format!(
            "{at} accepts data from every machine that can reach this one; 127.0.0.1:{port} accepts data from this machine only"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_as_they_are_typed() {
        let address: Address = "clip:///tmp/a b.bvh?speed=2&loop".parse().unwrap();
        assert_eq!(
            (address.kind.as_str(), address.place.as_str()),
            ("clip", "/tmp/a b.bvh")
        );
        assert_eq!(address.number("speed", 1.0).unwrap(), Some(2.0));
        assert_eq!(address.number("loop", 7.0).unwrap(), Some(7.0));
        assert_eq!(address.number("loss", 1.0).unwrap(), None);
        assert!(address.allow(&["speed"]).is_err() && address.allow(&["speed", "loop"]).is_ok());
        let plain: Address = "json:-".parse().unwrap();
        assert_eq!((plain.kind.as_str(), plain.place.as_str()), ("json", "-"));
        assert!("vmc".parse::<Address>().is_err() && "vmc://".parse::<Address>().is_err());
        let socket: Address = "vmc://127.0.0.1:39539".parse().unwrap();
        assert_eq!(socket.socket().unwrap().port(), 39539);
        assert!(
            "vmc://127.0.0.1"
                .parse::<Address>()
                .unwrap()
                .socket()
                .is_err()
        );
        assert!(
            "clip:a?speed=fast"
                .parse::<Address>()
                .unwrap()
                .number("speed", 1.0)
                .is_err()
        );
    }
}
