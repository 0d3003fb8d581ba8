//! `morec.Database`: clips, labels and search in one file.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use morec::files::{FileReader, list};
use morec::labels::{ClipLength, Sample};
use morec::pivots::PivotSet;
use morec::progress::Progress;
use morec_db::labels::{LabelOptions, NewSample, SampleFilter, SampleState};
use morec_db::search::{Example, SearchIndex};
use morec_db::{ClipFilter, ClipId, ClipInfo, DbError, ImportOutcome, MotionDb};
use morec_ops::{
    CutSettings, GroupSettings, ImportSettings, ProposeSettings, SearchSettings, example_of_clip,
    example_of_database, largest_first,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::clip::PyClip;
use crate::clip_data::ClipData;
use crate::errors::{db_error, file_error, operation_error, value_error, warn};
use crate::job;
use crate::material::keywords;
use crate::tables::{plain, table};

/// A motion database: clips, cuts, classes and labels in one SQLite file, as `morec db` keeps it.
#[pyclass(frozen, name = "Database", module = "morec")]
pub struct PyDatabase {
    path: PathBuf,
    db: Mutex<Option<MotionDb>>,
    /// Rows of all clips, laid out for searching; made by the first search and dropped by every change.
    search: Mutex<Option<SearchIndex>>,
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl PyDatabase {
    /// Does `work` with the open database, other Python threads running meanwhile.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut MotionDb) -> Result<T, DbError> + Send,
    ) -> PyResult<T> {
        py.detach(|| match held(&self.db).as_mut() {
            Some(db) => work(db).map_err(db_error),
            None => Err(value_error(format!("{}: closed", self.path.display()))),
        })
    }

    /// Does `work` that takes long, with reports of its progress.
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(&mut MotionDb, &dyn Progress) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        job::run(py, progress, |progress| match held(&self.db).as_mut() {
            Some(db) => work(db, progress),
            None => Err(value_error("the database is closed")),
        })?
    }

    fn changed(&self) {
        *held(&self.search) = None;
    }
}

const CLIP: [&str; 12] = [
    "clip", "subject", "secs", "frames", "rate_hz", "joints", "format", "path", "source",
    "licence", "tags", "samples",
];

fn clip_row<'py>(py: Python<'py>, info: &ClipInfo) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("clip", &info.name)?;
    row.set_item("subject", &info.subject)?;
    row.set_item("secs", info.duration_secs())?;
    row.set_item("frames", info.frames)?;
    row.set_item("rate_hz", info.rate_hz)?;
    row.set_item("joints", info.joints)?;
    row.set_item("format", &info.format)?;
    row.set_item("path", &info.path)?;
    row.set_item("source", &info.source)?;
    row.set_item("licence", &info.licence)?;
    row.set_item("tags", &info.tags)?;
    row.set_item("samples", info.samples)?;
    Ok(row)
}

fn state(name: &str) -> PyResult<SampleState> {
    SampleState::from_name(name).ok_or_else(|| {
        value_error(format!(
            "state: expected \"accepted\", \"proposed\" or \"rejected\", found {name:?}"
        ))
    })
}

#[pymethods]
impl PyDatabase {
    #[new]
    #[pyo3(signature = (path, *, create=false))]
    fn new(py: Python<'_>, path: PathBuf, create: bool) -> PyResult<Self> {
        let db = py.detach(|| match create && !path.exists() {
            true => MotionDb::create(&path),
            false => MotionDb::open(&path),
        });
        Ok(Self {
            db: Mutex::new(Some(db.map_err(db_error)?)),
            path,
            search: Mutex::default(),
        })
    }

    /// Path of the file.
    #[getter]
    fn path(&self) -> &Path {
        &self.path
    }

    /// Closes the file; every other method then raises.
    fn close(&self) {
        *held(&self.db) = None;
        self.changed();
    }

    fn __enter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    #[pyo3(signature = (*_args))]
    fn __exit__(&self, _args: &Bound<'_, PyAny>) {
        self.close();
    }

    /// Counts of its contents.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let summary = self.with(py, |db| db.summary())?;
        plain(py, &summary)
    }

    /// Adds the clips of files and folders; what is there already is known by its content.
    #[pyo3(signature = (paths, *, progress=None, **settings))]
    fn import_files<'py>(
        &self,
        py: Python<'py>,
        paths: &Bound<'py, PyAny>,
        progress: Option<&Bound<'py, PyAny>>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings: ImportSettings = keywords(settings)?;
        let given = match paths.extract::<PathBuf>() {
            Ok(path) => vec![path],
            Err(_) => paths.extract()?,
        };
        let listing = list(&given).map_err(|error| file_error(&error))?;
        warn(
            py,
            listing
                .left_out
                .iter()
                .map(|error| format!("left out: {error}")),
        )?;
        let (files, reader) = (listing.clips, FileReader::default());
        self.changed();
        let report = self.run(py, progress, |db, progress| {
            let imported = settings.run(db, &files, &reader, progress);
            imported.map_err(db_error)
        })?;
        let mut rows = Vec::new();
        for (path, outcome) in &report.log.files {
            let row = PyDict::new(py);
            let (what, clips, mut notes) = match outcome {
                ImportOutcome::Imported { clips, warnings } => {
                    ("imported", clips.clone(), warnings.clone())
                }
                ImportOutcome::Known => ("known", vec![], vec![]),
                ImportOutcome::Copy { of } => ("copy", vec![], vec![of.display().to_string()]),
                ImportOutcome::Refused(refused) => {
                    ("refused", vec![], vec![refused.reason.clone()])
                }
            };
            let copies = report.near_copies.iter();
            let copies = copies.filter(|c| clips.contains(&c.copy) || clips.contains(&c.of));
            notes.extend(copies.map(ToString::to_string));
            row.set_item("path", path.to_string_lossy())?;
            row.set_item("outcome", what)?;
            row.set_item("clips", clips)?;
            row.set_item("notes", notes)?;
            rows.push(row);
        }
        table(py, &["path", "outcome", "clips", "notes"], rows)
    }

    /// The clips, by name: `*` stands for any text, `?` for one character.
    #[pyo3(signature = (name=None, *, subject=None, tag=None, class_name=None))]
    fn clips<'py>(
        &self,
        py: Python<'py>,
        name: Option<String>,
        subject: Option<String>,
        tag: Option<String>,
        class_name: Option<String>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let filter = ClipFilter {
            name,
            subject,
            tag,
            class: class_name,
        };
        let infos = self.with(py, |db| db.clips(&filter))?;
        let rows: PyResult<Vec<_>> = infos.iter().map(|info| clip_row(py, info)).collect();
        table(py, &CLIP, rows?)
    }

    /// A clip as it is kept: within half a degree and five millimetres of its file, unless the summary says more.
    fn clip(&self, py: Python<'_>, name: &str) -> PyResult<PyClip> {
        let (stored, info) = self.with(py, |db| {
            let info = db.find_clip(name)?;
            Ok((db.clip(info.id)?, info))
        })?;
        Ok(ClipData {
            clip: stored.clip,
            roles: stored.roles,
            rest: stored.rest,
            facts: "{}".to_owned(),
            warnings: Vec::new(),
            path: Some(PathBuf::from(info.path)),
            format: info.format,
        }
        .into())
    }

    /// The labels: accepted ones, or those of another state; all with `state=None`.
    #[pyo3(signature = (*, state=Some("accepted"), clip=None, class_name=None))]
    fn labels<'py>(
        &self,
        py: Python<'py>,
        state: Option<&str>,
        clip: Option<&str>,
        class_name: Option<String>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let state = state.map(self::state).transpose()?;
        let samples = self.with(py, |db| {
            let clip = clip.map(|name| db.find_clip(name)).transpose()?;
            db.samples(&SampleFilter {
                clip: clip.map(|info| info.id),
                class: class_name,
                state,
                annotator: None,
            })
        })?;
        let columns = [
            "clip",
            "class",
            "start_secs",
            "stop_secs",
            "person",
            "whole_clip",
            "state",
            "score",
            "annotators",
            "set_by",
        ];
        let mut rows = Vec::new();
        for s in &samples {
            let row = PyDict::new(py);
            row.set_item("clip", &s.clip_name)?;
            row.set_item("class", &s.class)?;
            row.set_item("start_secs", s.start_secs)?;
            row.set_item("stop_secs", s.stop_secs)?;
            row.set_item("person", &s.subject)?;
            row.set_item("whole_clip", s.whole_clip)?;
            row.set_item("state", s.state.name())?;
            row.set_item("score", s.score)?;
            row.set_item("annotators", &s.annotators)?;
            row.set_item("set_by", &s.set_by)?;
            rows.push(row);
        }
        table(py, &columns, rows)
    }

    /// Adds labels; all or none.
    #[pyo3(signature = (labels, *, state="accepted", by="user"))]
    fn label<'py>(
        &self,
        py: Python<'py>,
        labels: &Bound<'py, PyAny>,
        state: &str,
        by: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let state = self::state(state)?;
        let rows = py
            .import("morec._labels")?
            .call_method1("label_rows", (labels,))?;
        let labels = crate::material::labels(&rows)?;
        let (added, warnings) = self.with(py, |db| {
            let clips = db.clips(&ClipFilter::default())?;
            let length = |info: &ClipInfo| ClipLength {
                frames: info.frames,
                rate_hz: info.rate_hz,
            };
            let lengths = clips.iter().map(|c| (c.name.clone(), length(c))).collect();
            let resolved = labels.resolve(&lengths);
            if let Some(why) = resolved.doubtful_unit() {
                return Err(DbError::Invalid(format!("labels: {why}")));
            }
            if let Some(clip) = resolved.absent.keys().next() {
                // Says which names come near.
                db.find_clip(clip)?;
            }
            let described = clips.iter().filter(|clip| clip.subject.is_some());
            let described: BTreeSet<ClipId> = described.map(|clip| clip.id).collect();
            let ids: BTreeMap<String, ClipId> = clips.into_iter().map(|c| (c.name, c.id)).collect();
            let people = resolved.samples.iter();
            let people = people.filter_map(|s| Some((*ids.get(&s.clip)?, s.person.clone()?)));
            let options = LabelOptions {
                by: by.to_owned(),
                people: people
                    .filter(|(clip, _)| !described.contains(clip))
                    .collect(),
                ..LabelOptions::default()
            };
            let sample = |s: Sample| {
                Some(NewSample {
                    clip: *ids.get(&s.clip)?,
                    class: s.class,
                    start_secs: s.span.start_secs,
                    stop_secs: s.span.stop_secs,
                    whole_clip: s.whole_clip,
                    state,
                    score: None,
                })
            };
            let samples: Vec<NewSample> = resolved.samples.into_iter().filter_map(sample).collect();
            Ok((db.label(&samples, &options)?.counts, resolved.warnings))
        })?;
        warn(py, warnings.iter().map(|w| format!("labels: {w}")))?;
        plain(py, &added)
    }

    /// Segments similar to an example, most similar first.
    #[pyo3(signature = (example, start=0.0, stop=None, **settings))]
    fn search<'py>(
        &self,
        py: Python<'py>,
        example: &Bound<'py, PyAny>,
        start: f64,
        stop: Option<f64>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings: SearchSettings = keywords(settings)?;
        let name = example.extract::<String>().ok();
        let clip = match &name {
            Some(_) => None,
            None => crate::index::clips_of(example)?.into_iter().next(),
        };
        let data = clip.map(|clip| clip.get().data.clone());
        let (hits, names) = self.with(py, |db| {
            let mut search = held(&self.search);
            if search.is_none() {
                *search = Some(SearchIndex::of_db(db, &())?);
            }
            let Some(index) = search.as_ref() else {
                return Err(DbError::Cancelled);
            };
            let example = match (&name, &data) {
                (Some(name), _) => example_of_database(db, index, name, start, stop)?,
                (None, Some(data)) => example_of(data, start, stop)?,
                (None, None) => return Err(DbError::Invalid("no example".to_owned())),
            };
            let metric = settings.metric(db, index)?;
            let hits = index.search_by(&example, &settings.options(), metric.as_ref());
            Ok((hits, names(db)?))
        })?;
        let mut rows = Vec::new();
        for hit in hits {
            let row = PyDict::new(py);
            row.set_item("clip", names.get(&hit.clip))?;
            row.set_item("start_secs", hit.span.start_secs)?;
            row.set_item("stop_secs", hit.span.stop_secs)?;
            row.set_item("score", hit.score)?;
            row.set_item("warp_distance", hit.warp_distance)?;
            row.set_item("mirrored", hit.mirrored)?;
            rows.push(row);
        }
        let columns = [
            "clip",
            "start_secs",
            "stop_secs",
            "score",
            "warp_distance",
            "mirrored",
        ];
        table(py, &columns, rows)
    }

    /// Cuts clips where their behaviour changes, and keeps the cuts; a row for each clip.
    #[pyo3(signature = (name=None, *, progress=None, **settings))]
    fn cut<'py>(
        &self,
        py: Python<'py>,
        name: Option<String>,
        progress: Option<&Bound<'py, PyAny>>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings: CutSettings = keywords(settings)?;
        let cutter = settings.cutter(PivotSet::thesis());
        let cutter = cutter.map_err(operation_error)?;
        let filter = ClipFilter {
            name,
            ..ClipFilter::default()
        };
        let report = self.run(py, progress, |db, progress| {
            let clips = db.find_clips(&filter);
            let cut = clips.and_then(|clips| db.cut(&clips, &cutter, progress));
            cut.map_err(db_error)
        })?;
        warn(
            py,
            report
                .left
                .iter()
                .map(|(clip, why)| format!("not changed: {clip}: {why}")),
        )?;
        let mut rows = Vec::new();
        for cut in &report.cuts {
            rows.push(plain(py, cut)?.cast_into::<PyDict>()?);
        }
        table(py, &["clip", "secs", "cuts_secs", "still"], rows)
    }

    /// Groups of stretches that are alike, the largest first; a row for each stretch.
    #[pyo3(signature = (*, progress=None, **settings))]
    fn group<'py>(
        &self,
        py: Python<'py>,
        progress: Option<&Bound<'py, PyAny>>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings: GroupSettings = keywords(settings)?;
        let (stretches, groups, names) = self.run(py, progress, |db, progress| {
            let stretches = settings.stretches(db, progress).map_err(operation_error)?;
            let clusters = settings.clusters(stretches.iter().map(|of| &of.rows));
            let groups = largest_first(&clusters.map_err(operation_error)?);
            Ok((stretches, groups, names(db).map_err(db_error)?))
        })?;
        let mut rows = Vec::new();
        for (number, group) in groups.iter().enumerate() {
            for of in group.iter().map(|at| &stretches[*at]) {
                let row = PyDict::new(py);
                row.set_item("group", number + 1)?;
                row.set_item("clip", names.get(&of.clip))?;
                row.set_item("class", of.sample.as_ref().map(|(_, class)| class))?;
                row.set_item("start_secs", of.span.start_secs)?;
                row.set_item("stop_secs", of.span.stop_secs)?;
                rows.push(row);
            }
        }
        let columns = ["group", "clip", "class", "start_secs", "stop_secs"];
        table(py, &columns, rows)
    }

    /// Propose more samples of the labelled classes, most probable first, and store them in the state proposed.
    #[pyo3(signature = (*, progress=None, **settings))]
    fn propose<'py>(
        &self,
        py: Python<'py>,
        progress: Option<&Bound<'py, PyAny>>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings: ProposeSettings = keywords(settings)?;
        let (proposals, names) = self.run(py, progress, |db, progress| {
            let proposals = settings.run(db, progress).map_err(db_error)?;
            Ok((proposals, names(db).map_err(db_error)?))
        })?;
        let mut rows = Vec::new();
        for p in &proposals {
            let row = PyDict::new(py);
            row.set_item("clip", names.get(&p.clip))?;
            row.set_item("class", &p.class)?;
            row.set_item("start_secs", p.span.start_secs)?;
            row.set_item("stop_secs", p.span.stop_secs)?;
            row.set_item("score", p.score)?;
            rows.push(row);
        }
        table(
            py,
            &["clip", "class", "start_secs", "stop_secs", "score"],
            rows,
        )
    }

    /// Accepts the proposals of at least one score, rejects those below another; how many of each.
    #[pyo3(signature = (*, accept=None, reject=None, classes=vec![]))]
    fn judge(
        &self,
        py: Python<'_>,
        accept: Option<f64>,
        reject: Option<f64>,
        classes: Vec<String>,
    ) -> PyResult<(usize, usize)> {
        self.with(py, |db| {
            let judged = db.judge_by_score(&classes, (accept, reject), "user")?;
            Ok((judged.accepted, judged.rejected))
        })
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let path = self.path.display();
        match self.with(py, |db| db.summary()) {
            Ok(s) => format!(
                "<morec.Database {path}: {} clips, {:.1} min, {} labels>",
                s.clips,
                s.secs / 60.0,
                s.accepted
            ),
            Err(_) => format!("<morec.Database {path}: closed>"),
        }
    }
}

fn names(db: &MotionDb) -> Result<BTreeMap<ClipId, String>, DbError> {
    let clips = db.clips(&ClipFilter::default())?;
    Ok(clips.into_iter().map(|c| (c.id, c.name)).collect())
}

/// A stretch of a clip from elsewhere as an example.
pub fn example_of(
    data: &ClipData,
    start_secs: f64,
    stop_secs: Option<f64>,
) -> Result<Example, DbError> {
    let of = (&data.clip, &data.roles, &data.rest);
    example_of_clip(of, start_secs, stop_secs)
}
