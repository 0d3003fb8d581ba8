//! The shelf: sets of the same motion that were found without labels, until they are named.

use morec::TimeSpan;
use morec::discover::{RepetitionSet, SetInstance};
use morec_db::ClipId;
use morec_ops::{AloneStretch, DiscoveredSet, DiscoveredSets};

use crate::store::Snapshot;
use crate::stretch::Stretch;

/// Changes of the shelf that can be taken back.
const TAKEN_BACK: usize = 50;
/// No end moves so far that less than this share of an instance is left.
const LEAST_LEFT: f64 = 0.15;

/// Sets of the same motion, those that explain most first.
#[derive(Default)]
pub struct Shelf {
    pub sets: Vec<ShelfSet>,
    pub alone: Vec<AloneStretch>,
    /// Share of what moves that lies in sets.
    pub share_in_sets: f64,
    /// Clips that were not searched, in words.
    pub left_out: Option<String>,
    /// True while it is shown.
    pub open: bool,
    /// True while all strips play.
    pub playing: bool,
    clips: Vec<ClipId>,
    before: Vec<Vec<ShelfSet>>,
}

/// A set on the shelf, and what was decided about it.
#[derive(Debug, Clone, PartialEq)]
pub struct ShelfSet {
    /// Its number, from 1; a part that was split off has a new one.
    pub number: usize,
    /// Its instances, by clip and time.
    set: RepetitionSet,
    /// True if repetitions that follow each other at once are one.
    pub runs: bool,
    /// By how much every instance starts and stops later, in lengths of a repetition.
    pub ends: (f64, f64),
    /// Instances that will be split off, or joined with another set.
    pub marked: Vec<Stretch>,
    /// The class of its proposals.
    pub named: Option<String>,
}

/// Commands for the shelf; sets by their places.
#[derive(Debug, Clone, PartialEq)]
pub enum ShelfCommand {
    /// Looks for what repeats, in all clips.
    Discover,
    /// Shows the shelf, or the classes again.
    Show(bool),
    Play(bool),
    /// Takes the last change of the shelf back.
    TakeBack,
    Runs {
        set: usize,
        on: bool,
    },
    Ends {
        set: usize,
        ends: (f64, f64),
    },
    /// An instance was removed from its set.
    ThrowOut {
        set: usize,
        of: Stretch,
    },
    Mark {
        set: usize,
        of: Stretch,
    },
    /// The marked instances become a set of their own.
    Split(usize),
    /// A set becomes part of another.
    Join {
        set: usize,
        into: usize,
    },
    NotAMotion(usize),
    /// Instances become proposed samples of a class.
    Name {
        set: usize,
        name: String,
    },
    /// A named set is open to changes again.
    Reopen(usize),
}

impl Shelf {
    pub(in crate::state) fn of(found: DiscoveredSets) -> Self {
        let mut shelf = Self {
            left_out: found.left_out(),
            alone: found.alone,
            share_in_sets: found.share_in_sets,
            open: true,
            ..Self::default()
        };
        shelf.sets = found.sets.iter().map(|set| shelf.shelved(set)).collect();
        shelf
    }

    fn shelved(&mut self, found: &DiscoveredSet) -> ShelfSet {
        let instances = found.instances.iter().filter_map(|of| {
            let id = of.id?;
            let known = self.clips.iter().position(|clip| *clip == id);
            let clip = known.unwrap_or_else(|| {
                self.clips.push(id);
                self.clips.len() - 1
            });
            Some(SetInstance {
                clip,
                span: of.span,
                distance: of.distance,
            })
        });
        ShelfSet {
            number: found.set,
            set: RepetitionSet {
                instances: instances.collect(),
                explained_secs: found.explained_secs,
            },
            runs: false,
            ends: (0.0, 0.0),
            marked: Vec::new(),
            named: None,
        }
    }

    /// Opens named sets to changes again if no label of their class is left, as after undo.
    pub(in crate::state) fn follow(&mut self, snapshot: &Snapshot) {
        for set in &mut self.sets {
            let is_known = |name: &String| snapshot.samples.iter().any(|s| s.class == *name);
            set.named = set.named.take().filter(is_known);
        }
    }

    /// The instances of a set as they will be proposed, the outermost first: repetitions or runs, with its ends moved. What is left of one
    /// within its clip, of `secs_of` seconds.
    pub fn instances(&self, set: usize, secs_of: impl Fn(ClipId) -> f64) -> Vec<Stretch> {
        let Some(of) = self.sets.get(set) else {
            return Vec::new();
        };
        let mut instances = match of.runs {
            true => of.set.runs(),
            false => of.set.instances.clone(),
        };
        instances.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        let usual = of.set.length_secs();
        let moved = instances.iter().filter_map(|instance| {
            let clip = *self.clips.get(instance.clip)?;
            let length = if of.runs {
                usual
            } else {
                instance.span.duration_secs()
            };
            let (start, stop) = (instance.span.start_secs, instance.span.stop_secs);
            let start = (start + of.ends.0 * length).max(0.0);
            let stop = (stop + of.ends.1 * length).min(secs_of(clip));
            (start < stop).then(|| Stretch::new(clip, start..stop))
        });
        moved.collect()
    }

    /// Median length of a set's repetitions.
    pub fn length_secs(&self, set: usize) -> f64 {
        self.sets.get(set).map_or(0.0, |of| of.set.length_secs())
    }

    /// Numbers of clips that a set is in.
    pub fn clips_of(&self, set: usize) -> usize {
        self.sets.get(set).map_or(0, |of| of.set.clips())
    }

    fn remember(&mut self) {
        self.before.push(self.sets.clone());
        if self.before.len() > TAKEN_BACK {
            self.before.remove(0);
        }
    }

    /// True if a change can be taken back.
    pub fn can_take_back(&self) -> bool {
        !self.before.is_empty()
    }

    /// Takes the instances that `out` chooses from a set; runs with all repetitions in them.
    fn taken(&mut self, set: usize, out: impl Fn(&Stretch) -> bool) -> Vec<SetInstance> {
        let shown = self.instances(set, |_| f64::INFINITY);
        let out: Vec<Stretch> = shown.into_iter().filter(out).collect();
        let clips = &self.clips;
        let Some(of) = self.sets.get_mut(set) else {
            return Vec::new();
        };
        let (usual, ends) = (of.set.length_secs(), of.ends);
        let is_in = |instance: &SetInstance| {
            let length = if of.runs {
                usual
            } else {
                instance.span.duration_secs()
            };
            // The middle of a repetition, moved as it is shown.
            let middle = instance.span.middle_secs() + 0.5 * (ends.0 + ends.1) * length;
            let holds = |span: TimeSpan| span.start_secs <= middle && middle <= span.stop_secs;
            out.iter()
                .any(|o| clips.get(instance.clip) == Some(&o.clip) && holds(o.span))
        };
        let all = std::mem::take(&mut of.set.instances);
        let (taken, kept) = all.into_iter().partition(is_in);
        of.set.instances = kept;
        of.marked.clear();
        taken
    }

    /// Carries out what changes the shelf alone.
    pub(in crate::state) fn apply(&mut self, command: ShelfCommand) {
        let known = |set: usize| set < self.sets.len();
        match command {
            ShelfCommand::Runs { set, on } if known(set) => {
                self.remember();
                self.sets[set].runs = on;
                self.sets[set].marked.clear();
            }
            ShelfCommand::Ends { set, ends } if known(set) => {
                self.remember();
                let start = ends.0.clamp(-1.0, 1.0);
                self.sets[set].ends = (start, ends.1.clamp(start + LEAST_LEFT - 1.0, 1.0));
                self.sets[set].marked.clear();
            }
            ShelfCommand::ThrowOut { set, of } if known(set) => {
                self.remember();
                self.taken(set, |stretch| *stretch == of);
                self.sets.retain(|set| !set.set.instances.is_empty());
            }
            ShelfCommand::Mark { set, of } if known(set) => {
                let marked = &mut self.sets[set].marked;
                match marked.iter().position(|m| *m == of) {
                    Some(at) => {
                        marked.remove(at);
                    }
                    None => marked.push(of),
                }
            }
            ShelfCommand::Split(set) if known(set) && !self.sets[set].marked.is_empty() => {
                self.remember();
                let mut part = self.sets[set].clone();
                let marked = std::mem::take(&mut part.marked);
                part.set.instances = self.taken(set, |stretch| marked.contains(stretch));
                part.number = self.sets.iter().map(|set| set.number).max().unwrap_or(0) + 1;
                self.sets.insert(set + 1, part);
                self.sets.retain(|set| !set.set.instances.is_empty());
            }
            ShelfCommand::Join { set, into } if known(set) && known(into) && set != into => {
                self.remember();
                let instances = std::mem::take(&mut self.sets[set].set.instances);
                let whole = &mut self.sets[into];
                whole.set.instances.extend(instances);
                let place = |of: &SetInstance| (of.clip, of.span.start_secs);
                whole.set.instances.sort_by(|a, b| {
                    place(a)
                        .partial_cmp(&place(b))
                        .unwrap_or(std::cmp::Ordering::Equal)
                });
                whole.marked.clear();
                self.sets.remove(set);
            }
            ShelfCommand::NotAMotion(set) if known(set) => {
                self.remember();
                self.sets.remove(set);
            }
            ShelfCommand::Reopen(set) if known(set) => self.sets[set].named = None,
            ShelfCommand::TakeBack => {
                if let Some(sets) = self.before.pop() {
                    self.sets = sets;
                }
            }
            ShelfCommand::Show(open) => self.open = open,
            ShelfCommand::Play(on) => self.playing = on,
            // A set that went in the same frame.
            _ => {}
        }
    }
}
