//! Handles: numbers in the form of pointers, which are looked up and never dereferenced.
//!
//! A table says what each stands for, so a null, foreign or destroyed handle is found missing instead of crashing.
//! Numbers are odd, which no object's address is, and never given twice.

use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock};

use morec::index::MotionIndex;

use crate::MorecStatus;
use crate::status::CallError;
use crate::stream::Stream;

/// A loaded index. It does not change; any number of threads may use it at once.
pub struct MorecIndex(());

/// A recogniser of one performer's motions.
pub struct MorecRecognizer(());

/// An object behind a handle.
#[derive(Clone)]
enum Object {
    Index(Arc<MotionIndex>),
    Recognizer(Arc<Stream>),
}

#[derive(Default)]
struct HandleTable {
    objects: BTreeMap<usize, Object>,
    given: usize,
}

static TABLE: RwLock<HandleTable> = RwLock::new(HandleTable {
    objects: BTreeMap::new(),
    given: 0,
});

/// A kind of handle.
pub(crate) trait Handle: Sized {
    /// Type of the object behind it.
    type Of;
    /// Its name in messages, with its article.
    const NAME: &'static str;
    #[allow(private_interfaces)]
    fn wrap(of: Arc<Self::Of>) -> Object;
    #[allow(private_interfaces)]
    fn unwrap(object: &Object) -> Option<&Arc<Self::Of>>;
}

impl Handle for MorecIndex {
    type Of = MotionIndex;
    const NAME: &'static str = "an index";

    #[allow(private_interfaces)]
    fn wrap(of: Arc<MotionIndex>) -> Object {
        Object::Index(of)
    }

    #[allow(private_interfaces)]
    fn unwrap(object: &Object) -> Option<&Arc<MotionIndex>> {
        if let Object::Index(index) = object {
            Some(index)
        } else {
            None
        }
    }
}

impl Handle for MorecRecognizer {
    type Of = Stream;
    const NAME: &'static str = "a recogniser";

    #[allow(private_interfaces)]
    fn wrap(of: Arc<Stream>) -> Object {
        Object::Recognizer(of)
    }

    #[allow(private_interfaces)]
    fn unwrap(object: &Object) -> Option<&Arc<Stream>> {
        if let Object::Recognizer(stream) = object {
            Some(stream)
        } else {
            None
        }
    }
}

/// Puts `of` into the table; the handle is its number there.
pub(crate) fn give<H: Handle>(of: H::Of) -> Result<*mut H, CallError> {
    let mut table = TABLE.write().unwrap_or_else(PoisonError::into_inner);
    let number = table
        .given
        .checked_add(1)
        .and_then(|given| given.checked_mul(2)?.checked_add(1));
    let number =
        number.ok_or_else(|| CallError::new(MorecStatus::Internal, "no handles are left"))?;
    table.given += 1;
    table.objects.insert(number, H::wrap(Arc::new(of)));
    Ok(std::ptr::without_provenance_mut(number))
}

/// The object behind `handle`. It lives on while it is in use, even if it is destroyed meanwhile.
pub(crate) fn find<H: Handle>(handle: *const H) -> Result<Arc<H::Of>, CallError> {
    let table = TABLE.read().unwrap_or_else(PoisonError::into_inner);
    match table.objects.get(&handle.addr()) {
        Some(object) => H::unwrap(object).cloned().ok_or_else(|| other_kind::<H>()),
        None => Err(unknown::<H>(&table, handle.addr())),
    }
}

/// Takes `handle` back.
pub(crate) fn take_back<H: Handle>(handle: *const H) -> Result<(), CallError> {
    let mut table = TABLE.write().unwrap_or_else(PoisonError::into_inner);
    let number = handle.addr();
    match table.objects.get(&number) {
        Some(object) if H::unwrap(object).is_none() => Err(other_kind::<H>()),
        Some(_) => {
            let object = table.objects.remove(&number);
            // What it held is let go of after the table is free again: that may take a while.
            drop(table);
            drop(object);
            Ok(())
        }
        None => Err(unknown::<H>(&table, number)),
    }
}

fn other_kind<H: Handle>() -> CallError {
    CallError::new(
        MorecStatus::BadHandle,
        format!("this handle does not belong to {}", H::NAME),
    )
}

fn unknown<H: Handle>(table: &HandleTable, number: usize) -> CallError {
    if number == 0 {
        return CallError::new(
            MorecStatus::NullPointer,
            format!("expected {}, found null", H::NAME),
        );
    }
    let was = number % 2 == 1 && (1..=table.given).contains(&(number / 2));
    let text = if was {
        "this handle was destroyed"
    } else {
        "this is not a handle that morec created"
    };
    CallError::new(MorecStatus::BadHandle, text)
}
