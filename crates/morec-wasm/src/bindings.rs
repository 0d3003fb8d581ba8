//! The JavaScript interface of index files and recognition.

use std::sync::Arc;

use js_sys::{Array, ArrayBuffer, Date, Float64Array, JSON, JsString, Object};
use morec::live::{Event, PerformerStream, StreamOptions};
use morec::{MotionIndex, roles::Role};
use serde::Serialize;
use serde::de::DeserializeOwned;
use wasm_bindgen::prelude::*;

use crate::EventRow;

/// A defect of morec becomes an exception with its place, in place of `unreachable`.
#[wasm_bindgen(start)]
fn start() {
    std::panic::set_hook(Box::new(|panic| {
        wasm_bindgen::throw_str(&panic.to_string())
    }));
}

/// The version of morec.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// Names of the parts of the body, in the order of `Clip.positions`.
#[wasm_bindgen]
pub fn roles() -> Vec<String> {
    Role::ALL.map(|role| role.name().to_owned()).to_vec()
}

/// A trained index.
#[wasm_bindgen(js_name = Index)]
pub struct JsIndex {
    pub(crate) index: Arc<MotionIndex>,
    pub(crate) notes: Vec<String>,
}

#[wasm_bindgen(js_class = Index)]
impl JsIndex {
    /// Reads the bytes of an index file.
    #[wasm_bindgen(js_name = fromBytes)]
    pub fn from_bytes(bytes: &[u8]) -> Result<JsIndex, JsError> {
        Ok(Self {
            index: Arc::new(MotionIndex::from_bytes(bytes)?),
            notes: Vec::new(),
        })
    }

    /// The bytes of its file.
    #[wasm_bindgen(js_name = toBytes)]
    pub fn to_bytes(&self) -> Result<Vec<u8>, JsError> {
        Ok(self.index.to_bytes()?)
    }

    /// Names of its classes.
    #[wasm_bindgen(getter)]
    pub fn classes(&self) -> Vec<String> {
        let classes = self.index.model.classes().iter();
        classes.map(|class| class.name.clone()).collect()
    }

    /// Notes of training about its clips and labels, one sentence each.
    #[wasm_bindgen(getter)]
    pub fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The index with thresholds for this many false alarms a minute.
    #[wasm_bindgen(js_name = withSensitivity)]
    pub fn with_sensitivity(&self, alarms_per_minute: f64) -> Result<JsIndex, JsError> {
        let model = self.index.model.with_sensitivity(alarms_per_minute)?;
        let index = MotionIndex {
            model,
            ..(*self.index).clone()
        };
        Ok(Self {
            index: Arc::new(index),
            notes: self.notes.clone(),
        })
    }

    /// A recogniser of a stream of points of these names.
    pub fn recognizer(
        &self,
        points: Vec<String>,
        options: &JsValue,
    ) -> Result<JsRecognizer, JsError> {
        let options = match json("options", options)? {
            Some(text) => StreamOptions::from_json(&text)?,
            None => StreamOptions::default(),
        };
        let names: Vec<&str> = points.iter().map(String::as_str).collect();
        Ok(JsRecognizer {
            stream: PerformerStream::of_points(&self.index, &names, &options)?,
            index: self.index.clone(),
            nothing: Object::freeze(&Array::new()).into(),
        })
    }
}

/// One performer's stream.
#[wasm_bindgen(js_name = Recognizer)]
pub struct JsRecognizer {
    stream: PerformerStream,
    index: Arc<MotionIndex>,
    /// What most pushes return.
    nothing: JsValue,
}

#[wasm_bindgen(js_class = Recognizer)]
impl JsRecognizer {
    /// Takes a frame; returns the events that it settled.
    pub fn push(&mut self, time_secs: f64, positions: &JsValue) -> Result<JsValue, JsError> {
        let values = self.stream.values();
        copy(positions, values)?;
        let events = self.stream.push_values(time_secs, Date::now() / 1000.0);
        events_of(events, &self.index.model, &self.nothing)
    }

    /// Ends the stream.
    pub fn finish(&mut self) -> Result<JsValue, JsError> {
        events_of(self.stream.finish(), &self.index.model, &self.nothing)
    }

    /// What is wrong with the stream, in sentences.
    pub fn diagnosis(&self) -> Vec<String> {
        self.stream.findings()
    }

    /// Shortest time from the end of a motion to its report, seconds.
    #[wasm_bindgen(getter)]
    pub fn latency_secs(&self) -> f64 {
        self.stream.latency_secs().unwrap_or_default()
    }
}

fn events_of(
    events: &[Event],
    model: &morec::index::Model,
    nothing: &JsValue,
) -> Result<JsValue, JsError> {
    if events.is_empty() {
        return Ok(nothing.clone());
    }
    let rows: Vec<EventRow<'_>> = events.iter().map(|e| EventRow::new(e, model)).collect();
    to_js(&rows)
}

/// Copies numbers of a typed array, or of an array of numbers, exactly as many as `values` has.
pub(crate) fn copy(positions: &JsValue, values: &mut [f64]) -> Result<(), JsError> {
    let expected = || {
        format!(
            "positions: expected {} numbers, x, y, z of each point",
            values.len()
        )
    };
    if !(ArrayBuffer::is_view(positions) || Array::is_array(positions)) {
        return Err(JsError::new(&expected()));
    }
    // What is called is `length` and, in the copy, `TypedArray.prototype.set`: they are those of any array.
    let array: &Float64Array = positions.unchecked_ref();
    let found = array.length() as usize;
    if found != values.len() {
        return Err(JsError::new(&format!("{}, found {found}", expected())));
    }
    array.copy_to(values);
    Ok(())
}

/// `value` as objects, arrays and numbers.
pub(crate) fn to_js(value: &impl Serialize) -> Result<JsValue, JsError> {
    let text = serde_json::to_string(value)?;
    JSON::parse(&text).map_err(|_| JsError::new("an internal error: invalid JSON"))
}

/// What was given as `name`, as text; `None` if nothing was.
fn json(name: &str, value: &JsValue) -> Result<Option<String>, JsError> {
    if value.is_undefined() || value.is_null() {
        return Ok(None);
    }
    let text: Option<JsString> = JSON::stringify(value).ok();
    let text = text.and_then(|text| text.as_string());
    let text = text.ok_or_else(|| JsError::new(&format!("{name}: expected a plain object")))?;
    Ok(Some(text))
}

/// What was given as `name`; `None` if nothing was.
pub(crate) fn given<T: DeserializeOwned>(
    name: &str,
    value: &JsValue,
) -> Result<Option<T>, JsError> {
    let Some(text) = json(name, value)? else {
        return Ok(None);
    };
    let value = serde_json::from_str(&text);
    Ok(Some(value.map_err(|error| {
        JsError::new(&format!("{name}: {error}"))
    })?))
}
