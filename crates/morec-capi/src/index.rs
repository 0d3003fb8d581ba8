//! Loading an index, and facts about it.

use std::ffi::c_char;
use std::path::Path;

use morec::index::MotionIndex;
use morec::live::Model;

use crate::handles::{self, MorecIndex};
use crate::memory::{self, Versioned};
use crate::status::{CallError, MorecStatus, guard};

/// Method of recognition of an index.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MorecMethod {
    /// Templates of joint positions, matched elastically in time.
    Templates = 0,
    /// The method of 2009, on joint rotations.
    Svrdm = 1,
}

/// Facts about an index.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MorecIndexFacts {
    /// Set to `sizeof(MorecIndexFacts)` before the call.
    pub struct_size: usize,
    /// Number of classes; they are numbered from 0.
    pub class_count: u32,
    /// Body parts that recognition uses: bit `r` for `MorecRole` `r`. If a stream lacks some, the others are compared.
    pub roles: u32,
    /// Number of training samples.
    pub sample_count: u64,
    /// Comparisons with the templates a second.
    pub tick_hz: f64,
    /// Method of recognition, a `MorecMethod`; later releases may add values. Not in the first version of this struct.
    pub method: i32,
    /// 1 if frames must have joint rotations, 0 if positions are enough. Not in the first version of this struct.
    pub needs_rotations: u32,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl Versioned for MorecIndexFacts {
    const NAME: &'static str = "MorecIndexFacts";
    const FIRST_SIZE: usize = std::mem::offset_of!(Self, method);
}

/// Loads an index from a file that `morec train` wrote. `path` is UTF-8.
///
/// Writes the handle to `*index`; release it with `morec_index_destroy`.
///
/// # Safety
/// `path` is null or ends with a zero; `index` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_index_load(
    path: *const c_char,
    index: *mut *mut MorecIndex,
) -> MorecStatus {
    guard(|| {
        // SAFETY: as promised to this function.
        let path = unsafe { memory::text(path, "path") }?;
        // SAFETY: as promised to this function.
        unsafe { memory::put(index, std::ptr::null_mut(), "index") }?;
        let loaded = load(Path::new(path))?;
        // SAFETY: as promised to this function.
        unsafe { memory::put(index, handles::give(loaded)?, "index") }
    })
}

/// Loads an index from the bytes of such a file. The bytes are not used after the call returns.
///
/// # Safety
/// `bytes` is null or points to `size` bytes; `index` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_index_from_memory(
    bytes: *const u8,
    size: usize,
    index: *mut *mut MorecIndex,
) -> MorecStatus {
    guard(|| {
        // SAFETY: as promised to this function.
        let bytes = unsafe { memory::values(bytes, size, "bytes") }?;
        // SAFETY: as promised to this function.
        unsafe { memory::put(index, std::ptr::null_mut(), "index") }?;
        let loaded = MotionIndex::from_bytes(bytes)
            .map_err(|error| CallError::new(MorecStatus::BadIndex, error.to_string()))?;
        // SAFETY: as promised to this function.
        unsafe { memory::put(index, handles::give(loaded)?, "index") }
    })
}

/// The index in a file.
pub(crate) fn load(path: &Path) -> Result<MotionIndex, CallError> {
    let shown = path.display();
    let bytes = std::fs::read(path)
        .map_err(|error| CallError::new(MorecStatus::File, format!("{shown}: {error}")))?;
    MotionIndex::from_bytes(&bytes)
        .map_err(|error| CallError::new(MorecStatus::BadIndex, format!("{shown}: {error}")))
}

/// Releases an index. Recognisers made from it stay valid.
#[unsafe(no_mangle)]
pub extern "C" fn morec_index_destroy(index: *mut MorecIndex) -> MorecStatus {
    guard(|| handles::take_back(index.cast_const()))
}

/// Fills in `*facts`, whose `struct_size` must be set.
///
/// # Safety
/// `facts` is null or points to a struct of the size it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_index_facts(
    index: *const MorecIndex,
    facts: *mut MorecIndexFacts,
) -> MorecStatus {
    guard(|| {
        let model = &handles::find(index)?.model;
        let known = MorecIndexFacts {
            struct_size: 0,
            class_count: model.classes().len() as u32,
            roles: model
                .roles()
                .filter(|role| role.is_of_body())
                .fold(0, |roles, role| roles | 1 << role.index()),
            sample_count: model
                .classes()
                .iter()
                .map(|class| class.samples as u64)
                .sum(),
            tick_hz: model.tick_hz(),
            method: match model {
                Model::Templates(_) => MorecMethod::Templates as i32,
                Model::Svrdm(_) => MorecMethod::Svrdm as i32,
            },
            needs_rotations: u32::from(model.needs_rotations()),
        };
        // SAFETY: as promised to this function.
        unsafe { memory::write_struct(facts, &known) }
    })
}

/// Writes the name of class `class_id` and a zero into the `size` bytes at `buffer`. UTF-8.
///
/// If `needed` is not null, it receives the number of bytes needed, with the zero. If `size` is smaller, the text is truncated,
/// zero-terminated, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL`. With a `size` of 0, `buffer` may be null.
///
/// # Safety
/// `buffer` is null or may be written to for `size` bytes; `needed` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_index_class_name(
    index: *const MorecIndex,
    class_id: u32,
    buffer: *mut c_char,
    size: usize,
    needed: *mut usize,
) -> MorecStatus {
    guard(|| {
        let index = handles::find(index)?;
        let classes = index.model.classes();
        let class = classes.get(class_id as usize).ok_or_else(|| {
            CallError::invalid(format!(
                "class {class_id}: the index has {}, numbered from 0",
                classes.len()
            ))
        })?;
        // A zero inside would end the name early for every reader of it.
        let name = class.name.replace('\0', " ");
        // SAFETY: as promised to this function.
        unsafe { memory::give_text((buffer, size), needed, &name) }
    })
}
