//! Classes: which key labels which, what is proposed, what is alike.

use std::collections::BTreeSet;

use super::columns::ClassColumns;
use crate::jobs::group::ClusteredItems;
use crate::jobs::similar::Similar;
use crate::store::Snapshot;

/// Proposals at least this likely are accepted at once unless another threshold is chosen, percent.
pub const LIKELY: u8 = 80;

/// A class's key that is down.
#[derive(Debug, Clone, PartialEq)]
pub struct Held {
    pub slot: usize,
    /// Moment of the clip at which it went down.
    pub since_secs: f64,
    /// Time for which it has been down, seconds on the wall.
    pub wall_secs: f64,
}

/// The classes' own state.
#[derive(Default)]
pub struct Classes {
    /// The classes in the order of their keys: 1 to 9, then none.
    pub order: Vec<String>,
    /// Classes that were named and have no label yet.
    pub added: Vec<String>,
    pub held: Option<Held>,
    /// The last tap of a key: place of its class, and the moment.
    pub tapped: Option<(usize, f64)>,
    /// The samples of each class as they are shown.
    pub columns: ClassColumns,
    pub groups: Option<ClusteredItems>,
    /// Counts up with every new grouping.
    pub grouping: u64,
    /// The result of a search by example, while it is shown.
    pub similar: Option<Similar>,
    /// True if searches look for the mirror image, too.
    pub mirror: bool,
    /// Into how many groups the hierarchy is cut.
    pub depth: usize,
    /// A class that is being renamed, and its new name so far.
    pub renaming: Option<(String, String)>,
    /// Proposals at least this likely are accepted at once, percent; [`LIKELY`] unless chosen.
    pub likely: Option<u8>,
    /// The name of a new class so far.
    pub adding: String,
    /// The class of the key Q.
    pub quick: Option<String>,
    /// The first letters of the class that shall have the key Q, while it is chosen.
    pub choosing: Option<String>,
}

impl Classes {
    /// Keeps the order of the classes that are there, new ones behind.
    pub(super) fn follow(&mut self, snapshot: &Snapshot) {
        self.columns = ClassColumns::of(snapshot);
        let there: BTreeSet<&str> = snapshot.classes.iter().map(|c| c.name.as_str()).collect();
        self.added.retain(|name| !there.contains(name.as_str()));
        let added = self.added.clone();
        self.order
            .retain(|name| there.contains(name.as_str()) || added.contains(name));
        for class in &snapshot.classes {
            if !self.order.contains(&class.name) {
                self.order.push(class.name.clone());
            }
        }
    }

    /// The place of a class, which its colour and its key go by.
    pub fn place(&self, class: &str) -> Option<usize> {
        self.order.iter().position(|name| name == class)
    }

    /// The place of the class of the key Q.
    pub fn quick_place(&self) -> Option<usize> {
        self.place(self.quick.as_deref()?)
    }

    /// The key of the class at a place, as it is written on it; nothing if it has none.
    pub fn key_of(&self, place: usize) -> String {
        match place {
            0..9 => (place + 1).to_string(),
            _ if self.quick_place() == Some(place) => "Q".to_owned(),
            _ => String::new(),
        }
    }

    /// The classes whose names begin with `text`, whatever its case, then those that only contain it.
    pub fn matching(&self, text: &str) -> Vec<&str> {
        let text = text.trim().to_lowercase();
        let names = self.order.iter().map(String::as_str);
        let mut found: Vec<(bool, &str)> = names
            .filter_map(|name| {
                let at = name.to_lowercase().find(&text)?;
                Some((at > 0, name))
            })
            .collect();
        found.sort_by_key(|(inside, _)| *inside);
        found.into_iter().map(|(_, name)| name).collect()
    }

    pub(super) fn show_groups(&mut self, groups: ClusteredItems) {
        let classes: BTreeSet<_> = groups
            .items
            .iter()
            .filter_map(|i| i.class.as_ref())
            .collect();
        self.depth = classes.len().max(groups.items.len().min(4)).max(1);
        self.groups = Some(groups);
        self.grouping += 1;
    }

    /// A name for the class of a key that has none yet.
    pub fn free_name(&self) -> String {
        (1..)
            .map(|n| format!("gesture {n}"))
            .find(|name| !self.order.contains(name))
            .unwrap_or_default()
    }
}
