//! Options of a stream.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{EventOptions, Model, SensitivityError};
use crate::SignedAxis;
use crate::index::PerformerError;
use crate::roles::mapping::Mapping;
use crate::templates::PerformerKind;

/// The longest [`StreamOptions::refractory_secs`].
const MOST_REFRACTORY_SECS: f64 = 3600.0;

/// Options of one performer's stream. Command, Python, npm and the engines use the same names and defaults.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StreamOptions {
    /// Accepted false alarms a minute in background motion: 0.1 is strict, 1 is generous. As trained by default.
    pub sensitivity: Option<f64>,
    /// The expected performer: `auto`, `teacher`, `anyone`.
    pub performer: PerformerKind,
    /// Also report motions before they end: events of the phases start, update and cancel.
    pub tentative: bool,
    /// Make each repetition of an activity an event of its own, of the phase repetition.
    pub each_repetition: bool,
    /// Say how far each gesture that ends, and each repetition that is an event, was from the nearest sample: angle, pace, worst bone.
    pub deviation: bool,
    /// Report with each frame how far every class has come, how like it is to a sample and at what pace: events of the phase progress. Of
    /// templates only.
    pub progress: bool,
    /// A motion of the same class that ends less than this after the one before it is not reported, seconds.
    pub refractory_secs: f64,
    /// Roles of joints or points that the names do not identify.
    pub roles: Mapping,
    /// The axis that points up in the stream; `-y` for landmarks of pictures.
    pub up: SignedAxis,
}

impl Default for StreamOptions {
    fn default() -> Self {
        Self {
            sensitivity: None,
            performer: PerformerKind::default(),
            tentative: false,
            each_repetition: false,
            deviation: false,
            progress: false,
            refractory_secs: 0.0,
            roles: Mapping::default(),
            up: SignedAxis::Y,
        }
    }
}

/// An invalid option. The message begins with the option's name.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OptionError {
    /// The option does not exist, or has an invalid value.
    #[error("{0}")]
    Value(String),
    /// The index does not have this sensitivity.
    #[error("sensitivity: {0}")]
    Sensitivity(#[from] SensitivityError),
    /// The index does not have a gate for this performer.
    #[error("performer: {0}")]
    Performer(#[from] PerformerError),
    /// The refractory time is below 0, above one hour, or not a number.
    #[error("refractory_secs: expected 0 to {MOST_REFRACTORY_SECS}, found {0}")]
    Refractory(f64),
}

impl StreamOptions {
    /// Reads options from the text of a JSON object. Missing options, and those that are null, have their defaults.
    ///
    /// # Errors
    /// An option does not exist, or has an invalid value.
    pub fn from_json(text: &str) -> Result<Self, OptionError> {
        let given: Map<String, Value> =
            serde_json::from_str(text).map_err(|e| OptionError::Value(format!("options: {e}")))?;
        let given = given.into_iter().filter(|(_, value)| !value.is_null());
        let mut options = Map::new();
        for (name, value) in given {
            let one = Value::Object(Map::from_iter([(name.clone(), value.clone())]));
            let read = serde_json::from_value::<Self>(one);
            read.map_err(|error| OptionError::Value(format!("{name}: {error}")))?;
            options.insert(name, value);
        }
        serde_json::from_value(Value::Object(options))
            .map_err(|error| OptionError::Value(error.to_string()))
    }

    /// `model` adjusted to the sensitivity and the performer of these options.
    ///
    /// # Errors
    /// The model has no rates of false alarms or no relaxed gate, or the sensitivity is not above 0.
    pub fn tuned(&self, mut model: Model) -> Result<Model, OptionError> {
        if let Some(alarms_per_minute) = self.sensitivity {
            model = model.with_sensitivity(alarms_per_minute)?;
        }
        if self.performer != PerformerKind::Auto {
            model = model.with_performer(self.performer)?;
        }
        Ok(model)
    }

    /// The selection of events, and their refractory time.
    ///
    /// # Errors
    /// The refractory time is below 0 or above one hour.
    pub fn events(&self) -> Result<EventOptions, OptionError> {
        if !(0.0..=MOST_REFRACTORY_SECS).contains(&self.refractory_secs) {
            return Err(OptionError::Refractory(self.refractory_secs));
        }
        Ok(EventOptions {
            tentative: self.tentative,
            each_repetition: self.each_repetition,
            deviation: self.deviation,
            progress: self.progress,
            refractory_secs: self.refractory_secs,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_come_back_from_json_and_mistakes_are_named() {
        let options = StreamOptions {
            sensitivity: Some(0.5),
            performer: PerformerKind::Anyone,
            tentative: true,
            roles: Mapping::read(b"hips\tLHip+RHip\nleft_hand\tLWrist\nneck\t-").unwrap(),
            up: "-z".parse().unwrap(),
            ..StreamOptions::default()
        };
        let text = serde_json::to_string(&options).unwrap();
        assert!(text.contains(r#""neck":null"#), "{text}");
        assert_eq!(StreamOptions::from_json(&text).unwrap(), options);
        let error = |text: &str| StreamOptions::from_json(text).unwrap_err().to_string();
        let unknown = error(r#"{"early":true}"#);
        assert!(unknown.starts_with("early: unknown field"), "{unknown}");
        assert!(unknown.contains("tentative"), "{unknown}");
        assert!(error(r#"{"up":"w"}"#).starts_with("up: expected x, y, z"));
        assert!(error(r#"{"performer":"me"}"#).contains("`auto`, `teacher`, `anyone`"));
        let role = error(r#"{"roles":{"nose":"a"}}"#);
        assert!(role.starts_with("roles: line 1: expected a role"), "{role}");
        assert_eq!(
            StreamOptions::from_json(r#"{"roles":null}"#).unwrap(),
            StreamOptions::default()
        );
        let refused = |refractory_secs| {
            let options = StreamOptions {
                refractory_secs,
                ..StreamOptions::default()
            };
            options.events().unwrap_err().to_string()
        };
        assert_eq!(
            refused(-1.0),
            "refractory_secs: expected 0 to 3600, found -1"
        );
        assert!(refused(f64::NAN).ends_with("found NaN"));
    }
}
