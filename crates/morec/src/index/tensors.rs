//! Named tensors of numbers in the bytes of a file, little-endian, and the checks of their sizes and values.

use std::borrow::Cow;
use std::collections::BTreeMap;

use safetensors::tensor::{Dtype, SafeTensors, View};

use crate::classes::ClassId;
use crate::features::Rows;

use super::IndexError;

/// One table as it lies in the file.
#[derive(Debug, Clone)]
pub struct Tensor {
    dtype: Dtype,
    shape: Vec<usize>,
    bytes: Vec<u8>,
}

impl View for &Tensor {
    fn dtype(&self) -> Dtype {
        self.dtype
    }
    fn shape(&self) -> &[usize] {
        &self.shape
    }
    fn data(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(&self.bytes)
    }
    fn data_len(&self) -> usize {
        self.bytes.len()
    }
}

impl Tensor {
    /// Single-precision numbers in a line.
    pub fn of_f32(values: &[f32]) -> Self {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        Self {
            dtype: Dtype::F32,
            shape: vec![values.len()],
            bytes,
        }
    }

    /// Whole numbers in a line.
    pub fn of_u32(values: impl Iterator<Item = u32>) -> Self {
        let bytes: Vec<u8> = values.flat_map(u32::to_le_bytes).collect();
        Self {
            dtype: Dtype::U32,
            shape: vec![bytes.len() / 4],
            bytes,
        }
    }

    /// A table of rows: as bytes, in steps of `step` column by column, if there is one; else in full.
    pub fn of_rows<'r>(
        rows: impl Iterator<Item = &'r [f32]>,
        dim: usize,
        step: Option<&[f32]>,
    ) -> Self {
        let (dtype, bytes): (_, Vec<u8>) = match step {
            Some(step) => {
                let quantum = |(v, s): (&f32, &f32)| {
                    if *s > 0.0 {
                        (v / s).round() as i8 as u8
                    } else {
                        0
                    }
                };
                (
                    Dtype::I8,
                    rows.flat_map(|r| r.iter().zip(step).map(quantum)).collect(),
                )
            }
            None => (
                Dtype::F32,
                rows.flat_map(|r| r.iter().flat_map(|v| v.to_le_bytes()))
                    .collect(),
            ),
        };
        let width = if step.is_some() { 1 } else { 4 };
        Self {
            dtype,
            shape: vec![bytes.len() / (dim.max(1) * width), dim],
            bytes,
        }
    }
}

/// A checksum over a manifest (its own checksum field being 0) and all tensors in order of names.
pub fn checksum(manifest_json: &str, tensors: &BTreeMap<String, Tensor>) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(manifest_json.as_bytes());
    for (name, tensor) in tensors {
        hasher.update(format!("{name} {:?} {:?}", tensor.dtype, tensor.shape).as_bytes());
        hasher.update(&tensor.bytes);
    }
    hasher.finalize()
}

/// The tensors of an opened file.
pub struct Tables(BTreeMap<String, Tensor>);

impl Tables {
    /// Copies every tensor out of `file`.
    pub fn of(file: &SafeTensors<'_>) -> Self {
        let copy = |(name, view): (String, safetensors::tensor::TensorView<'_>)| {
            let (dtype, shape) = (view.dtype(), view.shape().to_vec());
            (
                name,
                Tensor {
                    dtype,
                    shape,
                    bytes: view.data().to_vec(),
                },
            )
        };
        Self(file.tensors().into_iter().map(copy).collect())
    }

    /// All of them, by name.
    pub fn all(&self) -> &BTreeMap<String, Tensor> {
        &self.0
    }

    fn get(&self, name: &str, dtype: Dtype) -> Result<&Tensor, IndexError> {
        let tensor = self
            .0
            .get(name)
            .ok_or_else(|| IndexError::Content(format!("no tensor {name:?}")))?;
        if tensor.dtype == dtype {
            return Ok(tensor);
        }
        Err(IndexError::Content(format!(
            "tensor {name:?}: expected {dtype:?}, found {:?}",
            tensor.dtype
        )))
    }

    /// A tensor of finite single-precision numbers.
    ///
    /// # Errors
    /// The tensor is missing, has another type, or contains a value that is not finite.
    pub fn f32s(&self, name: &str) -> Result<Vec<f32>, IndexError> {
        let bytes = self.get(name, Dtype::F32)?.bytes.as_chunks::<4>().0.iter();
        let values: Vec<f32> = bytes.map(|b| f32::from_le_bytes(*b)).collect();
        if values.iter().all(|v| v.is_finite()) {
            return Ok(values);
        }
        Err(IndexError::Content(format!(
            "tensor {name:?} contains a value that is not finite"
        )))
    }

    /// A tensor of whole numbers.
    ///
    /// # Errors
    /// The tensor is missing or has another type.
    pub fn u32s(&self, name: &str) -> Result<Vec<u32>, IndexError> {
        let bytes = self.get(name, Dtype::U32)?.bytes.as_chunks::<4>().0.iter();
        Ok(bytes.map(|b| u32::from_le_bytes(*b)).collect())
    }

    /// True if the file has this tensor.
    pub fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// The steps in which the `width` columns of stored rows are rounded, each 0 or more; `None` if the file has no such tensor.
    ///
    /// # Errors
    /// The tensor has another width, or contains a negative step.
    pub fn steps(&self, name: &str, width: usize) -> Result<Option<Vec<f32>>, IndexError> {
        if !self.has(name) {
            return Ok(None);
        }
        let step = self.f32s(name)?;
        if step.len() != width {
            return Err(IndexError::Content(format!(
                "tensor {name:?}: expected {width} values, found {}",
                step.len()
            )));
        }
        match step.iter().position(|s| *s < 0.0) {
            None => Ok(Some(step)),
            Some(column) => Err(IndexError::Content(format!(
                "tensor {name:?}: expected steps of 0 or more, found {} in column {column}",
                step[column]
            ))),
        }
    }

    /// A table of rows of `dim` values, stored in steps of `step` or in full, cut into pieces of `lengths` rows.
    pub fn pieces(
        &self,
        name: &str,
        dim: usize,
        lengths: &[u32],
        step: Option<&[f32]>,
    ) -> Result<Vec<Rows>, IndexError> {
        let values: Vec<f32> = match step {
            Some(step) => {
                let bytes = &self.get(name, Dtype::I8)?.bytes;
                bytes
                    .chunks(dim.max(1))
                    .flat_map(|r| r.iter().zip(step).map(|(q, s)| f32::from(*q as i8) * s))
                    .collect()
            }
            None => self.f32s(name)?,
        };
        // A finite step times a whole number need not be finite.
        if !values.iter().all(|v| v.is_finite()) {
            let message = format!("tensor {name:?} contains a value that is not finite");
            return Err(IndexError::Content(message));
        }
        let rows: u64 = lengths.iter().map(|l| u64::from(*l)).sum();
        if rows * dim as u64 != values.len() as u64 {
            let message = format!(
                "tensor {name:?}: expected {rows} rows of {dim}, found {} values",
                values.len()
            );
            return Err(IndexError::Content(message));
        }
        let mut rest = values.as_slice();
        let mut cut = |length: &u32| {
            let (piece, after) = rest.split_at(*length as usize * dim);
            rest = after;
            Rows::from_values(dim, piece.to_vec())
        };
        Ok(lengths.iter().map(&mut cut).collect())
    }
}

/// A class's number as tables hold it.
pub(super) fn class_id(number: u32) -> Result<ClassId, IndexError> {
    u16::try_from(number)
        .map(ClassId)
        .map_err(|_| IndexError::Content(format!("class number {number}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_steps_make_infinite_are_refused() {
        let rows = [[1.0f32, -2.0], [3.0, 4.0]];
        let tensor = Tensor::of_rows(rows.iter().map(|r| r.as_slice()), 2, Some(&[1.0, 1.0]));
        let tables = Tables(BTreeMap::from([("rows".to_owned(), tensor)]));
        let pieces = |step: &[f32]| tables.pieces("rows", 2, &[1, 1], Some(step));
        assert_eq!(pieces(&[1.0, 1.0]).unwrap()[1].row(0), [3.0, 4.0]);
        let error = pieces(&[1.0, f32::MAX]).err().unwrap().to_string();
        assert!(error.contains("not finite"), "{error}");
    }

    #[test]
    fn steps_that_could_not_be_written_again_are_refused() {
        let steps = |values: &[f32]| {
            let tables = Tables(BTreeMap::from([(
                "step".to_owned(),
                Tensor::of_f32(values),
            )]));
            tables.steps("step", 2)
        };
        assert_eq!(steps(&[0.0, 0.5]).unwrap(), Some(vec![0.0, 0.5]));
        let refused = |values: &[f32]| steps(values).unwrap_err().to_string();
        let error = refused(&[0.5, -0.25]);
        assert!(error.contains("found -0.25 in column 1"), "{error}");
        assert!(refused(&[0.5]).contains("expected 2 values, found 1"));
    }
}
