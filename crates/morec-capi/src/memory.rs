//! Checked access to memory behind a caller's pointers. Except for exported functions that pass pointers on, all such access is
//! here.
//!
//! Pointers that are null, misaligned or longer than memory can be are refused. That a pointer points to the data its
//! function asks for cannot be checked: the caller must see to it.

use std::ffi::{CStr, c_char};
use std::mem::size_of;

use crate::MorecStatus;
use crate::status::CallError;

/// A struct may be this many bytes longer than this release's at most; more than that is not a size.
const LONGEST_STRUCT: usize = 1024;

/// A struct whose first field is `struct_size`, which says how much of it the caller knows.
///
/// # Safety
/// `repr(C)`, the first field a `usize`, every bit pattern a value (numbers and pointers only).
pub(crate) unsafe trait Versioned: Copy {
    /// Its name in C.
    const NAME: &'static str;
    /// Its size in the first release that had it. When a field is added at its end: `offset_of!(Self, that_field)`.
    const FIRST_SIZE: usize;
}

fn look<T>(pointer: *const T, what: &str) -> Result<(), CallError> {
    if pointer.is_null() {
        return Err(CallError::new(
            MorecStatus::NullPointer,
            format!("{what} is null"),
        ));
    }
    if !pointer.is_aligned() {
        return Err(CallError::invalid(format!(
            "{what} is not aligned to {} bytes",
            align_of::<T>()
        )));
    }
    Ok(())
}

/// The text at `pointer`.
///
/// # Safety
/// If it is not null, it points to bytes that end with a zero and stay as they are for `'a`.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, what: &str) -> Result<&'a str, CallError> {
    look(pointer, what)?;
    // SAFETY: not null; that it ends with a zero is the caller's promise.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str()
        .map_err(|_| CallError::invalid(format!("{what} is not UTF-8")))
}

/// The `len` values at `pointer`.
///
/// # Safety
/// If it is not null, it points to `len` values that stay as they are for `'a`. Any bit pattern must be a `T`.
pub(crate) unsafe fn values<'a, T: Copy>(
    pointer: *const T,
    len: usize,
    what: &str,
) -> Result<&'a [T], CallError> {
    look(pointer, what)?;
    if len
        .checked_mul(size_of::<T>())
        .is_none_or(|bytes| bytes > isize::MAX as usize)
    {
        return Err(CallError::invalid(format!(
            "{what}: {len} values do not fit into memory"
        )));
    }
    // SAFETY: not null, aligned, no longer than an object can be; the rest is the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(pointer, len) })
}

/// [`values`], or nothing if the pointer is null.
///
/// # Safety
/// As of [`values`].
pub(crate) unsafe fn values_if_any<'a, T: Copy>(
    pointer: *const T,
    len: usize,
    what: &str,
) -> Result<Option<&'a [T]>, CallError> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: as promised to this function.
    unsafe { values(pointer, len, what) }.map(Some)
}

/// Puts `value` where `pointer` points.
///
/// # Safety
/// If it is not null, a `T` may be written there.
pub(crate) unsafe fn put<T: Copy>(pointer: *mut T, value: T, what: &str) -> Result<(), CallError> {
    look(pointer, what)?;
    // SAFETY: not null, aligned; that it may be written to is the caller's promise.
    unsafe { pointer.write(value) };
    Ok(())
}

/// Reads the value at `pointer`.
///
/// # Safety
/// If it is not null, it points to a `T`. Any bit pattern must be a `T`.
pub(crate) unsafe fn get<T: Copy>(pointer: *const T, what: &str) -> Result<T, CallError> {
    look(pointer, what)?;
    // SAFETY: not null, aligned; that there is a value is the caller's promise.
    Ok(unsafe { pointer.read() })
}

/// The size that a struct says it has, if it is one that can be.
///
/// # Safety
/// If `pointer` is not null, it points to a `T` of any release.
unsafe fn struct_size<T: Versioned>(pointer: *const T) -> Result<usize, CallError> {
    look(pointer, T::NAME)?;
    // SAFETY: not null, aligned; the first field of every release is its size.
    let size = unsafe { pointer.cast::<usize>().read() };
    if (T::FIRST_SIZE..=LONGEST_STRUCT).contains(&size) {
        return Ok(size);
    }
    let text = format!("{}: struct_size is {size}; set it to sizeof({0})", T::NAME);
    Err(CallError::new(MorecStatus::StructSize, text))
}

/// Reads a struct of any release: what an older one lacks is 0, what a newer one has beyond this must be 0.
///
/// # Safety
/// If `pointer` is not null, it points to as many bytes as its first field says.
pub(crate) unsafe fn read_struct<T: Versioned>(pointer: *const T) -> Result<T, CallError> {
    // SAFETY: as promised to this function.
    let size = unsafe { struct_size(pointer) }?;
    // SAFETY: `size` bytes are there, by the caller's promise.
    let bytes = unsafe { std::slice::from_raw_parts(pointer.cast::<u8>(), size) };
    let known = size.min(size_of::<T>());
    if bytes[known..].iter().any(|byte| *byte != 0) {
        let text = format!(
            "{}: fields that this release does not know are set",
            T::NAME
        );
        return Err(CallError::new(MorecStatus::StructSize, text));
    }
    let mut value = std::mem::MaybeUninit::<T>::zeroed();
    // SAFETY: `known` bytes are there to read and to write, in different places.
    unsafe {
        std::ptr::copy_nonoverlapping(bytes.as_ptr(), value.as_mut_ptr().cast::<u8>(), known)
    };
    // SAFETY: every bit pattern is a value, says the trait.
    Ok(unsafe { value.assume_init() })
}

/// Writes as much of `value` as the caller's struct has room for, and leaves its `struct_size` as it is.
///
/// # Safety
/// If `pointer` is not null, as many bytes as its first field says may be written there.
pub(crate) unsafe fn write_struct<T: Versioned>(
    pointer: *mut T,
    value: &T,
) -> Result<(), CallError> {
    // SAFETY: as promised to this function.
    let size = unsafe { struct_size(pointer.cast_const()) }?;
    let (from, known) = (size_of::<usize>(), size.min(size_of::<T>()));
    // SAFETY: both have `known` bytes, and a value of ours is nowhere in the caller's.
    unsafe {
        let source = std::ptr::from_ref(value).cast::<u8>().add(from);
        std::ptr::copy_nonoverlapping(source, pointer.cast::<u8>().add(from), known - from);
    }
    Ok(())
}

/// Room for `capacity` structs of `size` bytes each, as the caller's release knows them.
pub(crate) struct Places<T> {
    first: *mut u8,
    size: usize,
    capacity: usize,
    of: std::marker::PhantomData<T>,
}

impl<T: Copy> Places<T> {
    /// Looks at what can be seen of them; `first_size` is the struct's size in the first release that had it.
    ///
    /// # Safety
    /// If it is not null, `capacity` times `size` bytes may be written to `pointer` as long as this lives.
    pub(crate) unsafe fn new(
        pointer: *mut T,
        size: usize,
        capacity: usize,
        first_size: usize,
        what: &str,
    ) -> Result<Self, CallError> {
        if capacity > 0 {
            look(pointer.cast_const(), what)?;
        }
        if !(first_size..=LONGEST_STRUCT).contains(&size) || !size.is_multiple_of(align_of::<T>()) {
            let text = format!(
                "{what}: the element size is given as {size}, in this release it is {}",
                size_of::<T>()
            );
            return Err(CallError::new(MorecStatus::StructSize, text));
        }
        if size
            .checked_mul(capacity)
            .is_none_or(|bytes| bytes > isize::MAX as usize)
        {
            return Err(CallError::invalid(format!(
                "{what}: {capacity} do not fit into memory"
            )));
        }
        Ok(Self {
            first: pointer.cast(),
            size,
            capacity,
            of: std::marker::PhantomData,
        })
    }

    /// Number of elements.
    pub(crate) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Puts `value` in place `index`, as much of it as there is room for; what the caller's release has beyond this
    /// becomes 0. Nothing happens beyond the last place.
    pub(crate) fn put(&mut self, index: usize, value: &T) {
        if index >= self.capacity {
            return;
        }
        let known = self.size.min(size_of::<T>());
        // SAFETY: the place is inside what may be written, says `new`; `known` is no longer than either.
        unsafe {
            let place = self.first.add(index * self.size);
            std::ptr::copy_nonoverlapping(std::ptr::from_ref(value).cast::<u8>(), place, known);
            place.add(known).write_bytes(0, self.size - known);
        }
    }
}

/// Writes `text` with a zero at its end into `size` bytes at `buffer`; if there is no room for all of it, the
/// characters that fit, and `false`.
///
/// # Safety
/// If it is not null, `size` bytes may be written to `buffer`.
pub(crate) unsafe fn write_text(
    buffer: *mut c_char,
    size: usize,
    text: &str,
) -> Result<bool, CallError> {
    if size == 0 {
        return Ok(false);
    }
    look(buffer.cast_const(), "the buffer")?;
    let room = text.len().min(size - 1);
    let fits = (0..=room)
        .rev()
        .find(|&end| text.is_char_boundary(end))
        .unwrap_or(0);
    // SAFETY: `fits` + 1 is at most `size`, and `size` bytes may be written, by the caller's promise.
    unsafe {
        std::ptr::copy_nonoverlapping(text.as_ptr(), buffer.cast::<u8>(), fits);
        buffer.add(fits).write(0);
    }
    Ok(fits == text.len())
}

/// Writes `text` with a zero at the end into `buffer`, and how many bytes that takes into `*needed`, if that is not null.
///
/// # Errors
/// `MOREC_STATUS_BUFFER_TOO_SMALL`: what fits was written.
///
/// # Safety
/// `buffer` is null or may be written to for `size` bytes; `needed` is null or may be written to.
pub(crate) unsafe fn give_text(
    (buffer, size): (*mut c_char, usize),
    needed: *mut usize,
    text: &str,
) -> Result<(), CallError> {
    let bytes = text.len() + 1;
    if !needed.is_null() {
        // SAFETY: as promised to this function.
        unsafe { put(needed, bytes, "needed") }?;
    }
    // SAFETY: as promised to this function.
    if unsafe { write_text(buffer, size, text) }? {
        return Ok(());
    }
    let text = format!("the text takes {bytes} bytes, the buffer has {size}");
    Err(CallError::new(MorecStatus::BufferTooSmall, text))
}
