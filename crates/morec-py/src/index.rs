//! `morec.Index`: a trained index.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use morec::classify::Classifier;
use morec::features::all_bones_of_clip;
use morec::index::MotionIndex;
use morec::live::{RecognizerCache, StartError};
use morec_ops::RecognizeSettings;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::prelude::*;

use crate::clip::PyClip;
use crate::clip_data::ClipData;
use crate::errors::{library_error, morec_error, operation_error, value_error, warn};
use crate::job;
use crate::material::keywords;
use crate::recognizer::{PointLayout, PyRecognizer, stream_options};
use crate::tables::{FoundWithDeviation, detections, plain};

/// A trained model that recognises motions; immutable, stored in one file.
#[pyclass(frozen, name = "Index", module = "morec")]
pub struct PyIndex {
    pub index: Arc<MotionIndex>,
    /// Report of the training, if it was trained here.
    pub report: Option<serde_json::Value>,
}

impl From<MotionIndex> for PyIndex {
    fn from(index: MotionIndex) -> Self {
        Self {
            index: Arc::new(index),
            report: None,
        }
    }
}

/// Opens an index file.
#[pyfunction]
pub fn load(path: PathBuf) -> PyResult<PyIndex> {
    match MotionIndex::load(&path) {
        Ok(index) => Ok(index.into()),
        Err(morec::Error::Index(error)) => Err(morec_error(format!("{}: {error}", path.display()))),
        Err(error) => Err(library_error(error)),
    }
}

/// Read an index from the bytes of its file. Raises MorecError if they are not an index.
#[pyfunction]
pub fn index_from_bytes(bytes: &[u8]) -> PyResult<PyIndex> {
    Ok(MotionIndex::from_bytes(bytes).map_err(morec_error)?.into())
}

/// A sentence about the bones that the index uses and a clip does not show; `None` if it shows all.
fn lacks(index: &MotionIndex, data: &ClipData) -> Option<String> {
    if data.clip.frames == 0 {
        return None;
    }
    let shown = all_bones_of_clip(&data.clip, &data.roles, &data.rest);
    let lacking = index.lacks(&data.roles, shown);
    if lacking.is_empty() {
        return None;
    }
    let names = lacking.join(", ");
    Some(format!(
        "{}: bones of the index are missing in this clip and not used: {names}",
        data.clip.name
    ))
}

/// A clip with the roles that the index knows from its training clips.
fn completed(index: &MotionIndex, data: &Arc<ClipData>) -> ClipData {
    let mut data = (**data).clone();
    index.complete_roles(&mut data.roles, &data.clip.skeleton);
    data
}

impl PyIndex {
    /// The index as settings of recognition say.
    fn tuned(&self, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Arc<MotionIndex>> {
        let settings: RecognizeSettings = keywords(settings)?;
        if settings == RecognizeSettings::default() {
            return Ok(self.index.clone());
        }
        let model = settings.tuned(self.index.model.clone());
        let model = model.map_err(operation_error)?;
        Ok(Arc::new(MotionIndex {
            model,
            ..(*self.index).clone()
        }))
    }
}

/// Clips from what was given: a clip, a path, or several.
pub fn clips_of<'py>(given: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyClip>>> {
    if let Ok(clip) = given.cast::<PyClip>() {
        return Ok(vec![clip.clone()]);
    }
    let files = given.py().import("morec._files")?;
    files.call_method1("as_clips", (given,))?.extract()
}

#[pymethods]
impl PyIndex {
    /// Read an index from the bytes of its file. Raises MorecError if they are not an index.
    #[staticmethod]
    fn from_bytes(bytes: &[u8]) -> PyResult<Self> {
        index_from_bytes(bytes)
    }

    /// The bytes of the index file.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(
            py,
            &self.index.to_bytes().map_err(morec_error)?,
        ))
    }

    /// Part `part` of `of`: the templates of every `of`-th class.
    fn part(&self, part: usize, of: usize) -> PyResult<Self> {
        Ok(crate::parts::part_of(&self.index, part, of)?.into())
    }

    /// Writes the index file, whole or not at all.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        self.index.save(&path).map_err(library_error)
    }

    /// Recognise motions in clips, frame by frame as in a live stream.
    #[pyo3(signature = (clips, *, deviation=false, progress=None, **settings))]
    fn recognize<'py>(
        &self,
        py: Python<'py>,
        clips: &Bound<'py, PyAny>,
        deviation: bool,
        progress: Option<&Bound<'py, PyAny>>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let index = self.tuned(settings)?;
        let clips: Vec<Arc<ClipData>> = clips_of(clips)?
            .iter()
            .map(|clip| clip.get().data.clone())
            .collect();
        let all = job::run(py, progress, |progress| {
            let done = AtomicUsize::new(0);
            let recognizers = RecognizerCache::new(&index.model);
            let one = |data: &Arc<ClipData>| -> Option<Recognized> {
                if progress.cancelled() {
                    return None;
                }
                let data = completed(&index, data);
                let parts = (&data.clip, &data.roles, &data.rest);
                let found = recognizers.recognize_clip(parts.0, parts.1, parts.2);
                let found = found.map(|found| {
                    let deviations = match deviation {
                        true => morec_measure::explain::deviation(&index.model, parts, &found),
                        false => vec![None; found.len()],
                    };
                    found.into_iter().zip(deviations).collect()
                });
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress.report("recognising", done, clips.len());
                Some((data.clip.name.clone(), lacks(&index, &data), found))
            };
            clips.par_iter().map(one).collect::<Vec<_>>()
        })?;
        let mut found = Vec::new();
        for (clip, lacking, result) in all.into_iter().flatten() {
            warn(py, lacking)?;
            let result = result.map_err(|error| morec_error(format!("{clip}: {error}")))?;
            found.push((clip, result));
        }
        detections(py, &index.model, &found, deviation)
    }

    /// A recogniser for a live stream of joint positions.
    #[pyo3(signature = (joints, **options))]
    fn recognizer(
        &self,
        joints: &Bound<'_, PyAny>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyRecognizer> {
        let options = stream_options(options)?;
        let layout = match joints.cast::<PyClip>() {
            Ok(clip) => {
                let data = completed(&self.index, &clip.get().data);
                PointLayout::of_clip(&data.into())
            }
            Err(_) => PointLayout::of_names(joints.extract()?),
        };
        PyRecognizer::new(&self.index, layout, &options)
    }

    /// The class of each clip, as a list of dictionaries.
    fn classify<'py>(
        &self,
        py: Python<'py>,
        clips: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let clips: Vec<Arc<ClipData>> = clips_of(clips)?
            .iter()
            .map(|clip| clip.get().data.clone())
            .collect();
        let index = &self.index;
        let classifier = Classifier::new(&index.model).map_err(|e| value_error(e.to_string()))?;
        let found = py.detach(|| {
            let one = |data: &Arc<ClipData>| classified(index, &classifier, data);
            clips.par_iter().map(one).collect::<Result<Vec<_>, _>>()
        });
        plain(py, &found.map_err(morec_error)?)
    }

    /// The classes, each with its name, number of samples and number of people.
    #[getter]
    fn classes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.index.model.classes())
    }

    /// Names of the classes, in order.
    #[getter]
    fn class_names(&self) -> Vec<&str> {
        let classes = self.index.model.classes().iter();
        classes.map(|class| class.name.as_str()).collect()
    }

    /// The method of recognition: `"templates"` or `"svrdm"`.
    #[getter]
    fn method(&self) -> &'static str {
        self.index.model.method()
    }

    /// Origin of the index: date, version, clips, samples, background.
    #[getter]
    fn provenance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.index.provenance)
    }

    /// Report of the training; `None` for an index that was loaded.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.report
            .as_ref()
            .map(|report| plain(py, report))
            .transpose()
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let restore = py.import("morec._morec")?.getattr("index_from_bytes")?;
        Ok((restore, (self.to_bytes(py)?,)))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.index == other.index
    }

    fn __repr__(&self) -> String {
        let classes = self.class_names();
        let shown = classes
            .iter()
            .take(8)
            .copied()
            .collect::<Vec<_>>()
            .join(", ");
        let more = if classes.len() > 8 { ", …" } else { "" };
        format!(
            "<morec.Index: {} classes ({shown}{more}), {} samples, method {}>",
            classes.len(),
            self.index.provenance.samples,
            self.method()
        )
    }
}

type Recognized = (
    String,
    Option<String>,
    Result<FoundWithDeviation, StartError>,
);

/// A clip's class and the probabilities of all, as a JSON object.
fn classified(
    index: &MotionIndex,
    classifier: &Classifier,
    data: &Arc<ClipData>,
) -> Result<serde_json::Value, String> {
    let data = completed(index, data);
    let found = classifier.classify(&data.clip, &data.roles, &data.rest);
    let found = found.map_err(|error| format!("{}: {error}", data.clip.name))?;
    let found = found.named(&index.model);
    Ok(serde_json::json!({
        "clip": data.clip.name, "class": found.class, "probability": found.probability,
        "nearest": found.nearest, "probabilities": found.probabilities,
    }))
}
