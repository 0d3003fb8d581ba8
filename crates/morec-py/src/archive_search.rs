//! Searching archives: parts laid out for it, sketches of clips, and the plan of what to read.

use std::ops::Range;

use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use morec_db::search::{
    BoundDepth, Example, SearchIndex, SearchOptions, SearchPlan, SketchedClip, lower_bounds,
    sketch_of, windows_wanted,
};
use morec_db::{ClipId, bones_of_bits, clip_rows};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;
use rayon::prelude::*;

use crate::clip::PyClip;
use crate::database::{db_error, example_of};
use crate::errors::value_error;

/// Clips of a part of an archive, laid out for searching.
#[pyclass(frozen, module = "morec")]
pub struct SearchPart {
    index: SearchIndex,
}

/// An example to search for.
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

/// Clips by their numbers, with distances.
fn numbered(near: Vec<(ClipId, f32)>) -> Vec<(i64, f32)> {
    near.into_iter()
        .map(|(clip, distance)| (clip.0, distance))
        .collect()
}

#[pymethods]
impl SearchPart {
    /// For each clip its number, bones and packed rows.
    #[new]
    fn new(py: Python<'_>, clips: Vec<(i64, i64, PyBackedBytes)>) -> Self {
        let index = py.detach(|| {
            let rows = clips
                .par_iter()
                .filter_map(|(id, bones, rows)| clip_rows(ClipId(*id), *bones, rows));
            let rows: Vec<_> = rows.collect();
            SearchIndex::new(&rows, FeatureParams::default().tick_hz())
        });
        Self { index }
    }

    /// A stretch of one of the clips as an example, which is then no hit itself.
    fn example(&self, clip: i64, start: f64, stop: f64) -> PyResult<SearchExample> {
        let example = self.index.example(ClipId(clip), start..stop);
        let short = || value_error("the example must hold at least 0.1 s of motion");
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
        numbered(py.detach(|| self.index.nearest_clips(&example.example, &options)))
    }

    /// The clips of the nearest windows and how near these are, as `SearchPlan.found` takes them.
    fn nearest_windows(
        &self,
        py: Python<'_>,
        example: &SearchExample,
        limit: usize,
        mirror: bool,
        one_a_clip: bool,
    ) -> Vec<(i64, f32)> {
        let options = options(limit, mirror, one_a_clip);
        numbered(py.detach(|| self.index.nearest_windows(&example.example, &options)))
    }

    /// The hits, best first: clip, start, stop, score, warp distance, mirrored.
    fn search(
        &self,
        py: Python<'_>,
        example: &SearchExample,
        limit: usize,
        mirror: bool,
        one_a_clip: bool,
    ) -> Vec<(i64, f64, f64, f32, f32, bool)> {
        let options = options(limit, mirror, one_a_clip);
        let hits = py.detach(|| self.index.search(&example.example, &options));
        let hit = |h: morec_db::search::Hit| {
            (
                h.clip.0,
                h.span.start_secs,
                h.span.stop_secs,
                h.score,
                h.warp_distance,
                h.mirrored,
            )
        };
        hits.into_iter().map(hit).collect()
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
    let packed = py.detach(|| rows.to_packed(&FeatureParams::default()));
    Ok(PyBytes::new(py, &packed))
}

/// A table of sketches: the bones of each clip, where its sketch begins and the last ends, and the bytes of all.
type SketchColumns<'py> = (
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray1<'py, u8>,
);

/// Clips of tables of sketches, one after the other.
#[pyclass(frozen, module = "morec")]
pub struct SketchedClips {
    tables: Vec<Py<PyArray1<u8>>>,
    /// Of each clip its table, and where its sketch begins and ends.
    places: Vec<(u32, Range<u32>)>,
    bones: Vec<BoneSet>,
}

#[pymethods]
impl SketchedClips {
    /// Nothing is copied: the arrays are not to be changed.
    #[new]
    fn new(tables: Vec<SketchColumns<'_>>) -> PyResult<Self> {
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
            tables: kept,
            places,
            bones: all_bones,
        })
    }

    fn __len__(&self) -> usize {
        self.places.len()
    }

    /// A bound below the distance of all windows of each clip, or of those at the places `which`. `closely` is by eighths of
    /// windows, else by halves. A bound above `reach` says only that the clip is farther than that.
    #[pyo3(signature = (example, limit, mirror, one_a_clip, closely, reach, which=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "those of a search, and how it is done"
    )]
    fn bounds<'py>(
        &self,
        py: Python<'py>,
        example: &SearchExample,
        limit: usize,
        mirror: bool,
        one_a_clip: bool,
        closely: bool,
        reach: f32,
        which: Option<PyReadonlyArray1<'py, i64>>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let arrays: Vec<_> = self.tables.iter().map(|t| t.bind(py).readonly()).collect();
        let tables: Vec<&[u8]> = arrays
            .iter()
            .map(|array| array.as_slice())
            .collect::<Result<_, _>>()?;
        let clip = |at: usize| {
            let (table, span) = &self.places[at];
            let (table, span) = (*table as usize, span.start as usize..span.end as usize);
            SketchedClip {
                sketch: &tables[table][span],
                bones: self.bones[at],
            }
        };
        let options = options(limit, mirror, one_a_clip);
        let depth = if closely {
            BoundDepth::Eighths
        } else {
            BoundDepth::Halves
        };
        let example = &example.example;
        let bounds = match which {
            None => {
                let clips = (0..self.places.len()).into_par_iter().map(clip);
                py.detach(|| lower_bounds(example, &options, depth, reach, clips))
            }
            Some(which) => {
                let which = places_below(&which, self.places.len(), "the tables of sketches")?;
                let clips = which.into_par_iter().map(clip);
                py.detach(|| lower_bounds(example, &options, depth, reach, clips))
            }
        };
        Ok(PyArray1::from_vec(py, bounds))
    }
}

/// Windows that a search for this many hits looks at.
#[pyfunction]
pub fn search_windows(limit: usize) -> usize {
    windows_wanted(&options(limit, false, false))
}

/// Clips that a search reads in their order, and the point at which it has read enough.
#[pyclass(name = "SearchPlan", module = "morec")]
pub struct PySearchPlan {
    plan: SearchPlan,
}

/// Places, all of which are below `count`.
fn places_below(
    places: &PyReadonlyArray1<'_, i64>,
    count: usize,
    of: &str,
) -> PyResult<Vec<usize>> {
    let place = |at: &i64| usize::try_from(*at).ok().filter(|at| *at < count);
    let places: Option<Vec<usize>> = places.as_slice()?.iter().map(place).collect();
    places.ok_or_else(|| value_error(format!("no such clip in {of}")))
}

/// Windows by the numbers of their clips.
fn windows_of(windows: Vec<(i64, f32)>) -> Vec<(ClipId, f32)> {
    let window = |(clip, distance)| (ClipId(clip), distance);
    windows.into_iter().map(window).collect()
}

/// Places as an array.
fn places<'py>(py: Python<'py>, places: &[usize]) -> Bound<'py, PyArray1<i64>> {
    PyArray1::from_iter(py, places.iter().map(|at| *at as i64))
}

#[pymethods]
impl PySearchPlan {
    /// Of bounds by eighths if `closely`, else by halves.
    #[new]
    fn new(
        bounds: PyReadonlyArray1<'_, f32>,
        limit: usize,
        mirror: bool,
        one_a_clip: bool,
        closely: bool,
    ) -> PyResult<Self> {
        let options = options(limit, mirror, one_a_clip);
        let plan = match closely {
            true => SearchPlan::by_eighths(bounds.as_slice()?, &options),
            false => SearchPlan::new(bounds.as_slice()?, &options),
        };
        Ok(Self { plan })
    }

    /// Places of clips that have to be bound by eighths now.
    fn next_to_bound<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        places(py, &self.plan.next_to_bound())
    }

    /// Takes the bounds of the clips at these places.
    fn bound(
        &mut self,
        which: PyReadonlyArray1<'_, i64>,
        bounds: PyReadonlyArray1<'_, f32>,
    ) -> PyResult<()> {
        let which = places_below(&which, self.plan.len(), "the plan")?;
        self.plan.bound(&which, bounds.as_slice()?);
        Ok(())
    }

    /// Takes what another plan has found in clips at these places, which were read.
    fn known(&mut self, read: PyReadonlyArray1<'_, i64>, windows: Vec<(i64, f32)>) -> PyResult<()> {
        let read = places_below(&read, self.plan.len(), "the plan")?;
        self.plan.known(&read, &windows_of(windows));
        Ok(())
    }

    /// The distance beyond which no window counts, as far as it is known.
    fn reach(&self) -> f32 {
        self.plan.reach()
    }

    /// Places of clips that have to be read now; none if enough has been read.
    fn next_to_read<'py>(&mut self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        places(py, &self.plan.next_to_read())
    }

    /// Takes the nearest windows of clips that were read: their clips and distances.
    fn found(&mut self, windows: Vec<(i64, f32)>) {
        self.plan.found(&windows_of(windows));
    }

    /// Numbers of the clips that hold the nearest windows.
    fn chosen(&self) -> Vec<i64> {
        self.plan.chosen().into_iter().map(|clip| clip.0).collect()
    }
}

/// Adds what this module has.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<SearchPart>()?;
    module.add_class::<SearchExample>()?;
    module.add_class::<SketchedClips>()?;
    module.add_class::<PySearchPlan>()?;
    module.add_function(wrap_pyfunction!(search_example, module)?)?;
    module.add_function(wrap_pyfunction!(search_windows, module)?)?;
    module.add_function(wrap_pyfunction!(rows_packed, module)?)?;
    module.add_function(wrap_pyfunction!(sketch_kept, module)?)?;
    Ok(())
}
