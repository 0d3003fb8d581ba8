//! The JavaScript interface of clips and training.

use std::cell::RefCell;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use js_sys::Function;
use morec::classify::Classifier;
use morec::diagnosis::errors_of_clip;
use morec::files::FileReader;
use morec::formats::{Limits, from_positions};
use morec::import::{SignedAxis, normalize};
use morec::math::Vec3;
use morec::progress::Progress;
use morec::roles::Role;
use morec::{ImportOptions, Labels, Take, Trainer};
use wasm_bindgen::prelude::*;

use crate::bindings::{JsIndex, copy, given, to_js};

use crate::{DetectionRow, SampleRow, labels};
use morec_ops::{TrainSettings, from_fields};

/// A clip in metres, Y up.
#[wasm_bindgen(js_name = Clip)]
pub struct JsClip {
    take: Take,
}

/// The clips in the bytes of the file called `name`.
#[wasm_bindgen(js_name = readAll)]
pub fn read_all(bytes: &[u8], name: &str) -> Result<Vec<JsClip>, JsError> {
    let parsed = FileReader::default().parse(Path::new(name), bytes)?;
    let takes = parsed.into_takes(&ImportOptions::default())?;
    Ok(takes.into_iter().map(|take| JsClip { take }).collect())
}

#[wasm_bindgen(js_class = Clip)]
impl JsClip {
    /// A clip of named points: x, y, z of each, frame by frame, NaN where it was not seen.
    #[wasm_bindgen(js_name = fromPositions)]
    pub fn of_positions(
        name: &str,
        points: Vec<String>,
        rate_hz: f64,
        positions: &JsValue,
        frames: usize,
        up: Option<String>,
    ) -> Result<JsClip, JsError> {
        if !(rate_hz.is_finite() && rate_hz > 0.0) {
            let text = format!("rate_hz: expected a rate in Hz above 0, found {rate_hz}");
            return Err(JsError::new(&text));
        }
        let mut values = vec![0.0; 3 * points.len() * frames];
        copy(positions, &mut values)?;
        let count = points.len();
        let of_point = |(at, name): (usize, String)| {
            let place =
                |frame: usize| Vec3::from_column_slice(&values[3 * (frame * count + at)..][..3]);
            (name, (0..frames).map(place).collect::<Vec<_>>())
        };
        let points = points.into_iter().enumerate().map(of_point).collect();
        let loaded = from_positions(name, rate_hz, points, None, &Limits::default())?;
        let mut clips = loaded.clips.into_iter();
        let clip = clips
            .next()
            .ok_or_else(|| JsError::new("positions: contain no performer"))?;
        let options = ImportOptions {
            up: up.map(|up| up.parse::<SignedAxis>()).transpose()?,
            ..ImportOptions::default()
        };
        let mut take = normalize(clip, &options)?;
        take.warnings = loaded.warnings;
        Ok(Self { take })
    }

    /// The name by which labels refer to it.
    #[wasm_bindgen(getter)]
    pub fn name(&self) -> String {
        self.take.name().to_owned()
    }

    /// Number of frames.
    #[wasm_bindgen(getter)]
    pub fn frames(&self) -> usize {
        self.take.clip.frames
    }

    /// Frames a second.
    #[wasm_bindgen(getter)]
    pub fn rate_hz(&self) -> f64 {
        self.take.clip.rate_hz
    }

    /// Frames over rate.
    #[wasm_bindgen(getter)]
    pub fn duration_secs(&self) -> f64 {
        self.take.clip.duration_secs()
    }

    /// Repairs and oddities, and what spoils training and recognition, a sentence each.
    #[wasm_bindgen(getter)]
    pub fn warnings(&self) -> Vec<String> {
        let Take { clip, roles, .. } = &self.take;
        let errors = errors_of_clip(clip, roles, self.take.rest());
        let repairs = self.take.warnings.iter().map(ToString::to_string);
        repairs.chain(errors).collect()
    }

    /// Time of every frame, seconds.
    pub fn times(&self) -> Vec<f64> {
        self.take
            .poses()
            .into_iter()
            .map(|(secs, _)| secs)
            .collect()
    }

    /// x, y, z of each part of the body, frame by frame, metres; NaN where it is not known.
    pub fn positions(&self) -> Vec<f64> {
        let poses = self.take.poses().into_iter();
        poses
            .flat_map(|(_, pose)| {
                Role::ALL.map(|role| pose.get(role).unwrap_or_else(|| Vec3::repeat(f64::NAN)))
            })
            .flat_map(|at| [at.x, at.y, at.z])
            .collect()
    }
}

#[wasm_bindgen(js_class = Index)]
impl JsIndex {
    /// Recognises motions in a clip, as in a live stream.
    pub fn recognize(&self, clip: &JsClip) -> Result<JsValue, JsError> {
        let found = self.index.recognize(&clip.take)?;
        to_js(&found.iter().map(DetectionRow::from).collect::<Vec<_>>())
    }

    /// Classifies a whole clip that contains one motion.
    pub fn classify(&self, clip: &JsClip) -> Result<JsValue, JsError> {
        let (model, take) = (&self.index.model, &clip.take);
        let found = Classifier::new(model)?.classify(&take.clip, &take.roles, take.rest())?;
        to_js(&found.named(model))
    }
}

/// Material of a training run; `train` of the package is made of it.
#[wasm_bindgen(js_name = Training)]
#[derive(Default)]
pub struct JsTraining {
    takes: Vec<Take>,
    background: Vec<Take>,
}

#[wasm_bindgen(js_class = Training)]
impl JsTraining {
    /// Nothing yet.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a clip that labels are about.
    pub fn add(&mut self, clip: &JsClip) {
        self.takes.push(clip.take.clone());
    }

    /// Adds a clip that holds none of the classes.
    #[wasm_bindgen(js_name = addBackground)]
    pub fn add_background(&mut self, clip: &JsClip) {
        self.background.push(clip.take.clone());
    }

    /// Trains; `labels` is the text of a table or an array of rows, `progress` gets the stage, steps done and steps in
    /// all, and cancels with `false`.
    pub fn train(
        &self,
        labels: &JsValue,
        options: &JsValue,
        progress: Option<Function>,
    ) -> Result<JsIndex, JsError> {
        let labels = labels_of(labels)?;
        let fields: serde_json::Map<_, _> = given("options", options)?.unwrap_or_default();
        let settings: TrainSettings = from_fields(fields)?;
        let method = settings.template_options()?;
        LISTENER.set(progress);
        let listener = CallerProgress::default();
        let trained = Trainer::new()
            .labels(&labels)
            .background(&self.background)
            .classes(&settings.classes)
            .method(method)
            .progress(&listener)
            .train_with_report(&self.takes);
        LISTENER.set(None);
        let (index, report) = trained?;
        Ok(JsIndex {
            index: std::sync::Arc::new(index),
            notes: report.notes,
        })
    }
}

fn labels_of(given_labels: &JsValue) -> Result<Labels, JsError> {
    if let Some(table) = given_labels.as_string() {
        return Ok(Labels::read(table.as_bytes())?);
    }
    let rows: Vec<SampleRow> = given("labels", given_labels)?.unwrap_or_default();
    labels(rows).map_err(|error| JsError::new(&error))
}

thread_local! {
    /// Who is called with progress. Not in [`CallerProgress`], which threads may share.
    static LISTENER: RefCell<Option<Function>> = const { RefCell::new(None) };
}

/// Calls the caller's function; false from it cancels.
#[derive(Default)]
struct CallerProgress {
    cancelled: AtomicBool,
}

impl Progress for CallerProgress {
    fn report(&self, stage: &str, done: usize, total: usize) {
        let Some(listener) = LISTENER.with_borrow(Clone::clone) else {
            return;
        };
        let (done, total) = (done as f64, total as f64);
        let said = listener.call3(&JsValue::NULL, &stage.into(), &done.into(), &total.into());
        // An exception of the listener's cancels, too.
        if said.map_or(true, |said| said == JsValue::FALSE) {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}
