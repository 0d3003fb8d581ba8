//! Classes: which key labels which, what is proposed, what is alike.

use std::collections::{BTreeMap, BTreeSet};

use morec::cluster::{Dendrogram, GroupNodes, KwasParams};

use super::columns::ClassColumns;
use crate::jobs::group::{ClusteredItems, GroupDepth};
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
    /// The classes in the order of their places: those of the keys 1 to 9, then others.
    pub order: Vec<String>,
    /// Their places, by which they have keys and colours; also of classes that are gone.
    places: BTreeMap<String, usize>,
    /// Classes that were named and have no label yet.
    pub added: Vec<String>,
    pub held: Option<Held>,
    /// The last tap of a key: place of its class, and the moment.
    pub tapped: Option<(usize, f64)>,
    /// The samples of each class as they are shown.
    pub columns: ClassColumns,
    pub groups: Option<ClusteredItems>,
    /// Counts up with every new grouping, and when it is cut elsewhere.
    pub grouping: u64,
    /// The result of a search by example, while it is shown.
    pub similar: Option<Similar>,
    /// True if searches look for the mirror image, too.
    pub mirror: bool,
    pub depth: GroupDepth,
    /// A class that is being renamed, and its new name so far.
    pub renaming: Option<(String, String)>,
    /// Proposals at least this likely are accepted at once, percent; [`LIKELY`] unless chosen.
    pub likely: Option<u8>,
    /// Hits of a search at least this like the example are labelled at once, percent.
    pub alike: Option<u8>,
    /// The name of a new class so far.
    pub adding: String,
    /// The class of the key Q.
    pub quick: Option<String>,
    /// The first letters of the class that shall have the key Q, while it is chosen.
    pub choosing: Option<String>,
}

impl Classes {
    /// Takes the classes that are there, each at its place. Gives the places of new ones.
    pub(super) fn follow(&mut self, snapshot: &Snapshot) -> BTreeMap<String, usize> {
        self.places.extend(snapshot.places.clone());
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
        self.settle()
    }

    /// Gives places to the classes that have none, and brings all into their order. Gives the new places.
    fn settle(&mut self) -> BTreeMap<String, usize> {
        let place = |name: &String| self.places.get(name).copied().unwrap_or(usize::MAX);
        self.order.sort_by_key(place);
        let (mut taken, mut new) = (BTreeSet::new(), Vec::new());
        for name in &self.order {
            match self.places.get(name) {
                Some(place) if taken.insert(*place) => {}
                _ => new.push(name.clone()),
            }
        }
        let free = (0..).filter(|place| !taken.contains(place));
        let new: BTreeMap<String, usize> = new.into_iter().zip(free).collect();
        self.places.extend(new.clone());
        self.order
            .sort_by_key(|name| self.places.get(name).copied());
        new
    }

    /// A new class without a label, at a place or at the first that is free. Gives new places.
    pub(super) fn add(&mut self, name: &str, place: Option<usize>) -> BTreeMap<String, usize> {
        self.added.push(name.to_owned());
        self.order.push(name.to_owned());
        let Some(place) = place else {
            return self.settle();
        };
        self.places.insert(name.to_owned(), place);
        self.settle();
        [(name.to_owned(), place)].into()
    }

    /// Gives a class the place of another, which takes its own. Gives the new places.
    pub(super) fn swap(&mut self, class: &str, place: usize) -> BTreeMap<String, usize> {
        let (Some(from), there) = (self.place(class), self.at(place).map(str::to_owned)) else {
            return BTreeMap::new();
        };
        let mut new = BTreeMap::from([(class.to_owned(), place)]);
        new.extend(there.map(|other| (other, from)));
        self.places.extend(new.clone());
        self.settle();
        new
    }

    /// Gives a class another name; its place stays.
    pub(super) fn rename(&mut self, from: &str, to: &str) {
        for name in self.order.iter_mut().filter(|n| *n == from) {
            to.clone_into(name);
        }
        if let Some(place) = self.places.get(from) {
            self.places.insert(to.to_owned(), *place);
        }
    }

    /// The place of a class, which its colour and its key go by.
    pub fn place(&self, class: &str) -> Option<usize> {
        let there = self.order.iter().any(|name| name == class);
        self.places.get(class).copied().filter(|_| there)
    }

    /// The class at a place.
    pub fn at(&self, place: usize) -> Option<&str> {
        let mut placed = self.placed();
        placed.find(|(at, _)| *at == place).map(|(_, name)| name)
    }

    /// The classes with their places, in their order.
    pub fn placed(&self) -> impl Iterator<Item = (usize, &str)> {
        let place = |name: &String| self.places.get(name).copied().unwrap_or(usize::MAX);
        self.order
            .iter()
            .map(move |name| (place(name), name.as_str()))
    }

    /// The first place that no class has.
    pub fn free_place(&self) -> usize {
        let taken: BTreeSet<usize> = self.placed().map(|(place, _)| place).collect();
        (0..).find(|place| !taken.contains(place)).unwrap_or(0)
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
        self.depth.groups = classes.len().max(groups.items.len().min(4)).max(1);
        self.depth.branches = None;
        self.groups = Some(groups);
        self.grouping += 1;
    }

    /// Cuts the hierarchy into so many groups, all branches alike.
    pub(super) fn cut_into(&mut self, groups: usize) {
        (self.depth.groups, self.depth.branches) = (groups.max(1), None);
        self.grouping += 1;
    }

    /// Takes one group of the hierarchy a step down or up.
    pub(super) fn step(&mut self, node: usize, step: impl Fn(&Dendrogram, &mut GroupNodes, usize)) {
        let Some(groups) = &self.groups else { return };
        let mut cut = groups.cut(&self.depth);
        if let Some(nodes) = groups.nodes() {
            step(nodes, &mut cut, node);
        }
        self.depth.branches = Some(cut);
        self.grouping += 1;
    }

    pub(super) fn group_by(&mut self, kwas: KwasParams) {
        self.depth.kwas = kwas;
        self.grouping += 1;
    }

    /// A name for the class of a key that has none yet.
    pub fn free_name(&self) -> String {
        (1..)
            .map(|n| format!("{FREE_NAME}{n}"))
            .find(|name| !self.order.contains(name))
            .unwrap_or_default()
    }
}

/// Beginning of the names of classes that a key has made.
const FREE_NAME: &str = "gesture ";

/// True of names that keys gave.
pub fn is_free_name(name: &str) -> bool {
    let number = name.strip_prefix(FREE_NAME);
    number.is_some_and(|n| n.parse::<u32>().is_ok())
}
