//! The performers of a source: their places, and which have left.

use super::{MAX_PERFORMERS, PerformerId};

/// Places of the performers of a source, whose senders are distinguished by a key (`K`: a number, a connection, an address).
///
/// A sender keeps its place while it is silent, and returns to it, until another one needs it: new senders get places that
/// nobody has had, then those of senders that have gone.
#[derive(Debug, Clone)]
pub struct PerformerTable<K> {
    places: Vec<OccupiedPlace<K>>,
    most: usize,
}

#[derive(Debug, Clone)]
struct OccupiedPlace<K> {
    key: K,
    heard_secs: f64,
    gone: bool,
}

/// The way in which a sender comes to its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrival {
    /// It has been there all the time.
    Known,
    /// It had gone and is back.
    Returned,
    /// It is new, and so is its place.
    New,
    /// It is new; the sender that had the place has gone.
    Replaced,
}

impl<K: PartialEq> PerformerTable<K> {
    /// A table of `most` places, 1 to [`MAX_PERFORMERS`].
    pub fn new(most: usize) -> Self {
        Self {
            places: Vec::new(),
            most: most.clamp(1, MAX_PERFORMERS),
        }
    }

    /// Hears the sender `key` at `now_secs`: its place and how it comes to it; `None` if all places are taken by others.
    pub fn arrive(&mut self, key: K, now_secs: f64) -> Option<(PerformerId, Arrival)> {
        if let Some(place) = self.find(&key) {
            let returned = self.hear(place, now_secs);
            let arrival = if returned {
                Arrival::Returned
            } else {
                Arrival::Known
            };
            return Some((place, arrival));
        }
        let place = self.vacant()?;
        let new = OccupiedPlace {
            key,
            heard_secs: now_secs,
            gone: false,
        };
        match self.places.get_mut(place.index()) {
            Some(old) => {
                *old = new;
                Some((place, Arrival::Replaced))
            }
            None => {
                self.places.push(new);
                Some((place, Arrival::New))
            }
        }
    }

    /// The place that a new sender would get.
    pub fn vacant(&self) -> Option<PerformerId> {
        let count = self.places.len();
        let gone = || self.places.iter().position(|place| place.gone);
        let unused = (count < self.most).then_some(count);
        unused.or_else(gone).map(|at| PerformerId(at as u16))
    }

    /// The place of the sender `key`, present or gone.
    pub fn find(&self, key: &K) -> Option<PerformerId> {
        let at = self.places.iter().position(|place| place.key == *key)?;
        Some(PerformerId(at as u16))
    }

    /// Hears the sender at `place`; true if it had gone. `place` must be taken.
    ///
    /// # Panics
    /// Nobody has had `place` yet.
    pub fn hear(&mut self, place: PerformerId, now_secs: f64) -> bool {
        let place = &mut self.places[place.index()];
        place.heard_secs = now_secs;
        std::mem::take(&mut place.gone)
    }

    /// True if the sender at `place` has gone.
    pub fn is_gone(&self, place: PerformerId) -> bool {
        let place = self.places.get(place.index());
        place.is_some_and(|place| place.gone)
    }

    /// Keys of the senders that have not gone.
    pub fn present(&self) -> impl Iterator<Item = &K> {
        let present = self.places.iter().filter(|place| !place.gone);
        present.map(|place| &place.key)
    }

    /// Removes performers that have been silent for more than `silence_secs`; calls `gone` for each.
    pub fn leave_silent(
        &mut self,
        now_secs: f64,
        silence_secs: f64,
        gone: impl FnMut(PerformerId),
    ) {
        self.leave(|place| now_secs - place.heard_secs > silence_secs, gone);
    }

    /// Lets go the senders whose keys `leaves` chooses; calls `gone` for each that was present.
    pub fn leave_if(&mut self, leaves: impl Fn(&K) -> bool, gone: impl FnMut(PerformerId)) {
        self.leave(|place| leaves(&place.key), gone);
    }

    fn leave(
        &mut self,
        leaves: impl Fn(&OccupiedPlace<K>) -> bool,
        mut gone: impl FnMut(PerformerId),
    ) {
        for (at, place) in self.places.iter_mut().enumerate() {
            if !place.gone && leaves(place) {
                place.gone = true;
                gone(PerformerId(at as u16));
            }
        }
    }
}

/// The machine that holds the most places (`held` has the machine of each place), if it holds at least two more than `newcomer`:
/// the rule by which machines share places. O(places²).
pub fn largest_holder<M: Copy + PartialEq>(held: &[M], newcomer: M) -> Option<M> {
    let count = |machine: M| held.iter().filter(|other| **other == machine).count();
    let largest = held.iter().copied().max_by_key(|machine| count(*machine))?;
    (count(largest) >= count(newcomer) + 2).then_some(largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn senders_keep_their_places_until_others_need_them() {
        let mut table = PerformerTable::new(2);
        let id = |at| Some(PerformerId(at));
        assert_eq!(table.arrive('a', 0.0), Some((PerformerId(0), Arrival::New)));
        assert_eq!(table.arrive('b', 0.5), Some((PerformerId(1), Arrival::New)));
        assert_eq!(table.arrive('c', 0.6), None);
        let mut gone = vec![];
        table.leave_silent(1.2, 1.0, |place| gone.push(place));
        assert_eq!(gone, [PerformerId(0)]);
        assert!(table.is_gone(PerformerId(0)) && table.present().eq(&['b']));
        // Nobody leaves twice; who comes back finds the place.
        table.leave_silent(1.2, 1.0, |_| panic!("gone twice"));
        assert_eq!(
            table.arrive('a', 1.3),
            Some((PerformerId(0), Arrival::Returned))
        );
        assert_eq!(
            table.arrive('a', 1.4),
            Some((PerformerId(0), Arrival::Known))
        );
        table.leave_if(|key| *key == 'b', |place| gone.push(place));
        assert_eq!((gone.len(), table.vacant()), (2, id(1)));
        assert_eq!(
            table.arrive('c', 1.5),
            Some((PerformerId(1), Arrival::Replaced))
        );
        assert_eq!(
            (table.find(&'b'), table.find(&'c'), table.vacant()),
            (None, id(1), None)
        );
    }

    #[test]
    fn a_place_that_nobody_had_comes_before_one_of_somebody_who_has_gone() {
        let mut table = PerformerTable::new(3);
        table.arrive(1, 0.0);
        table.leave_if(|_| true, |_| ());
        assert_eq!(table.arrive(2, 0.0), Some((PerformerId(1), Arrival::New)));
    }
}
