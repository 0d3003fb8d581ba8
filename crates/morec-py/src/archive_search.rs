//! Searching archives: parts laid out for it, sketches of clips, and the plan of what to read.

use std::ops::Range;

use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use morec_db::rows::ClipRows;
use morec_db::search::{
    Example, Hit, SearchIndex, SearchOptions, SearchPlan, SketchCodes, SketchedClip, SketchedClips,
    sketch_of, windows_wanted,
};
use morec_db::{ClipId, bones_of_bits, clip_rows};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;
use rayon::prelude::*;

use crate::clip::PyClip;
use crate::database::example_of;
use crate::errors::db_error;
use crate::errors::value_error;

/// Clips of a part of an archive, laid out for searching.
#[pyclass(frozen, module = "morec")]
pub struct SearchPart {
    index: SearchIndex,
}

/// A stretch to search for, prepared once for all parts.
#[pyclass(frozen, module = "morec")]
pub struct SearchExample {
    example: Example,
}

/// A stretch of a clip from elsewhere as an example.
#[pyfunction]
#[pyo3(signature = (clip, start, stop=None))]
pub fn search_example(clip: &PyClip, start: f64, stop: Option<f64>) -> PyResult<SearchExample> {
    Ok(SearchExample {
        example: example_of(&clip.data, start, stop).map_err(db_error)?,
    })
}

fn options(limit: usize, mirror: bool, one_a_clip: bool) -> SearchOptions {
    SearchOptions {
        limit,
        mirror,
        one_a_clip,
        ..SearchOptions::default()
    }
}

/// A clip as it is kept: number, bones, packed rows.
type NumberedRows = (i64, i64, PyBackedBytes);

/// Unpacks rows, in parallel; damaged ones are left out.
fn unpacked(clips: &[NumberedRows]) -> Vec<ClipRows> {
    let one = |(id, bones, rows): &NumberedRows| clip_rows(ClipId(*id), *bones, rows);
    clips.par_iter().filter_map(one).collect()
}

#[pymethods]
impl SearchPart {
    /// For each clip its number, bones and packed rows.
    #[new]
    fn new(py: Python<'_>, clips: Vec<NumberedRows>) -> Self {
        let tick_hz = FeatureParams::default().tick_hz();
        let index = py.detach(|| SearchIndex::new(&unpacked(&clips), tick_hz));
        Self { index }
    }

    /// A stretch of one of the clips as an example, which is then no hit itself.
    fn example(&self, clip: i64, start: f64, stop: f64) -> PyResult<SearchExample> {
        let example = self.index.example(ClipId(clip), start..stop);
        let short = || value_error("the example must contain at least 0.1 s of motion");
        Ok(SearchExample {
            example: example.ok_or_else(short)?,
        })
    }

    /// The nearest clips and how near they are: what a search in parts has to look at.
    fn nearest(
        &self,
        py: Python<'_>,
        example: &SearchExample,
        limit: usize,
        mirror: bool,
        one_a_clip: bool,
    ) -> Vec<(i64, f32)> {
        let options = options(limit, mirror, one_a_clip);
        let near = py.detach(|| self.index.nearest_clips(&example.example, &options));
        let numbered = |(clip, distance): (ClipId, f32)| (clip.0, distance);
        near.into_iter().map(numbered).collect()
    }

    /// Rows in all.
    #[getter]
    fn ticks(&self) -> usize {
        self.index.ticks()
    }
}

/// For each clip, of which bones and packed rows are given, its sketch; nothing where there is none.
#[pyfunction]
pub fn sketch_kept<'py>(
    py: Python<'py>,
    clips: Vec<(i64, PyBackedBytes)>,
) -> Vec<Option<Bound<'py, PyBytes>>> {
    let one =
        |(bones, rows): &(i64, PyBackedBytes)| sketch_of(&clip_rows(ClipId(0), *bones, rows)?);
    let sketches: Vec<Option<Vec<u8>>> = py.detach(|| clips.par_iter().map(one).collect());
    let bytes = |sketch: Option<Vec<u8>>| sketch.map(|bytes| PyBytes::new(py, &bytes));
    sketches.into_iter().map(bytes).collect()
}

/// Feature rows, (ticks, columns) of 6 for each bone and 4 of the root, packed as an archive holds them.
#[pyfunction]
pub fn rows_packed<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray2<'py, f32>,
) -> PyResult<Bound<'py, PyBytes>> {
    let columns = rows.shape()[1];
    if RowLayout::from_dim(columns).is_none() {
        return Err(value_error(format!(
            "rows: expected 6 columns for each bone and 4 of the root, found {columns}"
        )));
    }
    let rows = Rows::from_values(columns, rows.as_slice()?.to_vec());
    let packed = py.detach(|| rows.to_packed());
    Ok(PyBytes::new(py, &packed))
}

/// A table of sketches: the bones of each clip, where its sketch begins and the last ends, and the bytes of all.
type SketchColumns<'py> = (
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray1<'py, u8>,
);

/// Clips of tables of sketches, one after the other.
#[pyclass(frozen, name = "SketchedClips", module = "morec")]
pub struct PySketchedClips {
    tables: Vec<Py<PyArray1<u8>>>,
    /// Of each clip its table, and where its sketch begins and ends.
    places: Vec<(u32, Range<u32>)>,
    bones: Vec<BoneSet>,
    /// If there are many.
    codes: Option<SketchCodes>,
}

#[pymethods]
impl PySketchedClips {
    /// Nothing is copied: the arrays are not to be changed. More than `few` clips are searched by codes first.
    #[new]
    fn new(tables: Vec<SketchColumns<'_>>, few: usize) -> PyResult<Self> {
        let (mut kept, mut places, mut all_bones) = (Vec::new(), Vec::new(), Vec::new());
        for (number, (bones, starts, bytes)) in tables.iter().enumerate() {
            if starts.len() != bones.len() + 1 {
                return Err(value_error(format!(
                    "starts: expected {}, found {}",
                    bones.len() + 1,
                    starts.len()
                )));
            }
            for ends in starts.as_slice()?.windows(2) {
                let span = u32::try_from(ends[0]).ok().zip(u32::try_from(ends[1]).ok());
                let span = span.filter(|(start, end)| start <= end && *end as usize <= bytes.len());
                let (start, end) =
                    span.ok_or_else(|| value_error("starts beyond the bytes of sketches"))?;
                places.push((number as u32, start..end));
            }
            all_bones.extend(bones.as_slice()?.iter().map(|bits| bones_of_bits(*bits)));
            bytes.as_slice()?;
            kept.push(bytes.as_unbound().clone_ref(bytes.py()));
        }
        Ok(Self {
            codes: (places.len() > few).then(SketchCodes::default),
            tables: kept,
            places,
            bones: all_bones,
        })
    }

    fn __len__(&self) -> usize {
        self.places.len()
    }
}

/// The clips and the bytes of their tables, which Python holds meanwhile.
struct SketchView<'a> {
    clips: &'a PySketchedClips,
    tables: Vec<&'a [u8]>,
}

impl SketchedClips for SketchView<'_> {
    fn count(&self) -> usize {
        self.clips.places.len()
    }

    fn clip(&self, at: usize) -> SketchedClip<'_> {
        let (table, span) = &self.clips.places[at];
        SketchedClip {
            sketch: &self.tables[*table as usize][span.start as usize..span.end as usize],
            bones: self.clips.bones[at],
        }
    }
}

impl PySketchedClips {
    /// Does something with the sketches, without Python's lock.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&SketchView<'_>) -> T + Send,
    ) -> PyResult<T> {
        let held: Vec<_> = self.tables.iter().map(|t| t.bind(py).readonly()).collect();
        let tables = held.iter().map(|table| table.as_slice());
        let tables = tables.collect::<Result<_, _>>()?;
        let view = SketchView {
            clips: self,
            tables,
        };
        Ok(py.detach(|| work(&view)))
    }
}

/// Windows that a search for this many hits looks at.
#[pyfunction]
pub fn search_windows(limit: usize) -> usize {
    windows_wanted(&options(limit, false, false))
}

/// A hit: clip, start, stop, score, warp distance, mirrored.
type HitRow = (i64, f64, f64, f32, f32, bool);

fn hit_row(hit: Hit) -> HitRow {
    let (clip, span) = (hit.clip.0, hit.span);
    let (score, distance) = (hit.score, hit.warp_distance);
    let (start, stop) = (span.start_secs, span.stop_secs);
    (clip, start, stop, score, distance, hit.mirrored)
}

/// A search among clips of which there are sketches: says which of them to read, until it has read enough.
#[pyclass(name = "SearchPlan", module = "morec")]
pub struct PySearchPlan {
    plan: SearchPlan,
    clips: Py<PySketchedClips>,
}

#[pymethods]
impl PySearchPlan {
    #[new]
    fn new(
        clips: &Bound<'_, PySketchedClips>,
        example: &SearchExample,
        limit: usize,
        mirror: bool,
        one_a_clip: bool,
    ) -> PyResult<Self> {
        let options = options(limit, mirror, one_a_clip);
        let (tick_hz, codes) = (FeatureParams::default().tick_hz(), &clips.get().codes);
        let plan = clips.get().with(clips.py(), |sketches| {
            SearchPlan::new(
                &example.example,
                &options,
                tick_hz,
                sketches,
                codes.as_ref(),
            )
        })?;
        Ok(Self {
            plan,
            clips: clips.clone().unbind(),
        })
    }

    /// Places of clips that have to be read now; none if enough has been read: all that can count if it is `exact`, else the likeliest.
    fn next_to_read<'py>(
        &mut self,
        py: Python<'py>,
        exact: bool,
    ) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let plan = &mut self.plan;
        let places = self
            .clips
            .get()
            .with(py, |sketches| plan.next_to_read(exact, sketches))?;
        let places = places.into_iter().map(|at| at as i64);
        Ok(PyArray1::from_iter(py, places))
    }

    /// Takes clips that were read: number, bones and packed rows of each.
    fn take(&mut self, py: Python<'_>, clips: Vec<NumberedRows>) {
        let plan = &mut self.plan;
        py.detach(|| plan.take(&unpacked(&clips)));
    }

    /// The hits among the clips that were read, best first: clip, start, stop, score, warp distance, mirrored.
    fn hits(&self, py: Python<'_>) -> Vec<HitRow> {
        let hits = py.detach(|| self.plan.hits());
        hits.into_iter().map(hit_row).collect()
    }
}

/// Adds what this module has.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<SearchPart>()?;
    module.add_class::<SearchExample>()?;
    module.add_class::<PySketchedClips>()?;
    module.add_class::<PySearchPlan>()?;
    module.add_function(wrap_pyfunction!(search_example, module)?)?;
    module.add_function(wrap_pyfunction!(search_windows, module)?)?;
    module.add_function(wrap_pyfunction!(rows_packed, module)?)?;
    module.add_function(wrap_pyfunction!(sketch_kept, module)?)?;
    Ok(())
}
