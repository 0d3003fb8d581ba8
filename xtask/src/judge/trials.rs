//! Trials: what teaches an index, and the clips that it is tested on, for every data set and scenario.

use std::collections::{BTreeMap, BTreeSet};

use morec::labels::Sample;
use morec::train::{TrainClip, is_built_in};
use morec_measure::crossval::{FoldBy, folds};
use morec_measure::perturb::Perturbation;

use super::sets::{DataSets, MotionSet, whole_clips};

/// Signals of the referee clips.
pub const SIGNALS: [&str; 7] = [
    "traveling",
    "illegal_dribble",
    "visible_count",
    "no_score",
    "hands_up",
    "pushing",
    "stop_clock",
];

/// Copies that are tested beside the clips, in rows of their own.
const COPIES: [&str; 4] = ["cam:1", "white:0.02", "speed:0.67", "speed:1.5"];

/// An index and its tests.
pub struct Trial<'a> {
    /// Distinguishes the trials of a row.
    pub name: String,
    pub teachers: Vec<&'a TrainClip>,
    pub background: Vec<&'a TrainClip>,
    pub lessons: Vec<Sample>,
    /// Samples of the teachers' clips that must be used for nothing.
    pub held_back: Vec<Sample>,
    pub tests: Vec<TrialTest<'a>>,
}

/// A clip that is tested, for a row of the table.
pub struct TrialTest<'a> {
    pub row: String,
    pub clip: &'a TrainClip,
    /// The samples in it; none where it is motion without the classes.
    pub truths: Vec<Sample>,
    pub unknown: bool,
    pub copy: Option<Perturbation>,
    /// The clip is classified as a whole, not played as a stream.
    pub classified: bool,
}

/// The trials of every data set and scenario that is there.
pub fn trials(sets: &DataSets) -> Vec<Trial<'_>> {
    let mut all = referee(sets);
    all.extend(everyday(sets));
    all.extend(exercises(sets));
    all.extend(gestures(sets));
    all.extend(sessions(sets));
    all.extend(actions(sets));
    all.extend(hands(sets));
    all.extend(cut_clips(sets));
    all.retain(|t| !t.lessons.is_empty());
    all
}

fn referee(sets: &DataSets) -> Vec<Trial<'_>> {
    let set = &sets.referee;
    let signals = set.of_classes(&SIGNALS);
    let active = set.named(&["jumping_", "soccer_", "running_"]);
    let others = sets.exercises.clips.iter().chain(&sets.segmentation.clips);
    let background: Vec<_> = active.into_iter().chain(others).collect();
    let quiet = set.named(&["walking_", "basketball_", "traffic_4"]);
    let mut all = Vec::new();
    for (by, name) in [(FoldBy::Clip, "by clip"), (FoldBy::Person, "by person")] {
        let row = format!("referee {name}");
        let plain = of_folds(&row, set, &signals, by, usize::MAX);
        all.extend(plain.into_iter().map(|t| t.with_unknown(&row, &quiet)));
        let row = format!("{row}, background");
        let named = of_folds(&row, set, &signals, by, usize::MAX).into_iter();
        all.extend(named.map(|t| Trial {
            background: background.clone(),
            ..t.with_unknown(&row, &quiet)
        }));
    }
    for trial in &mut all {
        if trial.tests.iter().any(|t| t.row == "referee by clip") {
            trial.add_copies();
        }
    }
    let strangers = of_folds("referee one", set, &signals, FoldBy::Person, 2);
    let silent = motion_without_classes(sets, &["run", "walk"], true);
    all.extend(
        strangers
            .into_iter()
            .map(|t| t.with_unknown("silence referee", &silent)),
    );
    for seed in 1..=3 {
        let row = "referee half";
        let halves = of_folds(row, set, &set.samples, FoldBy::Half { seed }, usize::MAX);
        let unknown: Vec<_> = sets.exercises.clips.iter().collect();
        all.extend(halves.into_iter().map(|t| t.with_unknown(row, &unknown)));
    }
    all
}

fn everyday(sets: &DataSets) -> Vec<Trial<'_>> {
    let set = &sets.everyday;
    let mut all = of_folds(
        "everyday by style",
        set,
        &set.samples,
        FoldBy::Person,
        usize::MAX,
    );
    for style in people(&set.samples) {
        let own = of_person(&set.samples, &style);
        let lessons = at_most(own, 2);
        let tested = set
            .clips
            .iter()
            .filter(|c| c.person.as_ref() != Some(&style));
        let mut trial = Trial::new("everyday one", set, lessons, tested, &set.samples);
        trial.add_classified();
        all.push(trial);
    }
    all
}

fn exercises(sets: &DataSets) -> Vec<Trial<'_>> {
    let set = &sets.exercises;
    of_folds(
        "exercises by clip",
        set,
        &set.samples,
        FoldBy::Clip,
        usize::MAX,
    )
}

/// Clips of the database that everyday motion is built in from, but those that are.
fn free_motion(sets: &DataSets) -> Vec<&TrainClip> {
    let is_new = |c: &&TrainClip| !is_built_in(&format!("cmu_{}", c.name));
    sets.free.clips.iter().filter(is_new).collect()
}

/// With named background and many samples: the verifier.
fn gestures(sets: &DataSets) -> Vec<Trial<'_>> {
    let set = &sets.gestures;
    let (others, wanted): (Vec<_>, Vec<_>) = set
        .samples
        .iter()
        .cloned()
        .partition(|s| s.class == "dontcare");
    let clips = |samples: &[Sample], person: &str, same: bool| -> Vec<&TrainClip> {
        let of = |s: &&Sample| (s.person.as_deref() == Some(person)) == same;
        let names: BTreeSet<&str> = samples.iter().filter(of).map(|s| s.clip.as_str()).collect();
        let named = set.clips.iter().filter(|c| names.contains(c.name.as_str()));
        named.collect()
    };
    let folds = people(&wanted).into_iter().map(|person| {
        let taught = wanted.iter().filter(|s| s.person.as_ref() != Some(&person));
        let row = "gestures by person, background";
        let tested = clips(&wanted, &person, true).into_iter();
        Trial {
            background: clips(&others, &person, false),
            ..Trial::new(row, set, taught.cloned().collect(), tested, &wanted)
        }
        .with_unknown(row, &clips(&others, &person, true))
    });
    folds.collect()
}

fn sessions(sets: &DataSets) -> Vec<Trial<'_>> {
    let lessons = (&sets.gestures, sets.session_lessons.as_slice());
    let mut all = of_sessions("sessions", lessons, &sets.sessions);
    let silent = motion_without_classes(sets, &["run", "walk"], false);
    let free = free_motion(sets);
    for trial in &mut all {
        if trial.tests.iter().any(|t| t.row == "sessions own") {
            trial.add_unknown("silence sessions", &silent);
            trial.add_unknown("free motion sessions", &free);
        }
    }
    let pair = ["clap", "wave"];
    let few = |samples: &[Sample]| -> Vec<Sample> {
        let wanted = samples.iter().filter(|s| pair.contains(&s.class.as_str()));
        wanted.cloned().collect()
    };
    let lessons = few(&sets.session_lessons);
    let tested = MotionSet {
        clips: Vec::new(),
        samples: few(&sets.sessions.samples),
    };
    for person in people(&lessons) {
        let taught = of_person(&lessons, &person);
        let others = sets
            .sessions
            .clips
            .iter()
            .filter(|c| c.person.as_ref() != Some(&person));
        let row = "sessions one, two classes";
        let trial = Trial::new(row, &sets.gestures, taught, others, &tested.samples);
        all.push(trial.with_unknown("free motion two classes", &free));
    }
    let idle: Vec<&TrainClip> = sets
        .gestures
        .clips
        .iter()
        .filter(|c| c.name.contains("_dontcare_"))
        .collect();
    for person in people(&sets.session_lessons) {
        let taught = sets
            .session_lessons
            .iter()
            .filter(|s| s.person.as_ref() != Some(&person));
        let own = sets
            .sessions
            .clips
            .iter()
            .filter(|c| c.person.as_ref() == Some(&person));
        let of_others = idle.iter().filter(|c| c.person.as_ref() != Some(&person));
        let row = "sessions many, background";
        let taught = taught.cloned().collect();
        all.push(Trial {
            background: of_others.copied().collect(),
            ..Trial::new(row, &sets.gestures, taught, own, &sets.sessions.samples)
        });
    }
    all
}

fn actions(sets: &DataSets) -> Vec<Trial<'_>> {
    let lessons = (&sets.actions, sets.actions.samples.as_slice());
    let mut all = of_sessions("actions", lessons, &sets.action_sessions);
    let silent = motion_without_classes(sets, &["run", "walk", "wave", "raise"], true);
    for trial in &mut all {
        if trial.tests.iter().any(|t| t.row == "actions own") {
            trial.add_unknown("silence actions", &silent);
            trial.add_unknown("free motion actions", &free_motion(sets));
        }
    }
    all
}

/// One person's lessons on cut clips of others: played as streams, and classified as wholes.
fn cut_clips(sets: &DataSets) -> Vec<Trial<'_>> {
    let actions = whole_clips(&sets.actions);
    let is_gesture = |s: &&Sample| s.class != "dontcare";
    let gestures: Vec<Sample> = (sets.gestures.samples.iter().filter(is_gesture))
        .cloned()
        .collect();
    let of = [
        (
            "gestures clips",
            &sets.gestures,
            &sets.session_lessons,
            gestures,
        ),
        (
            "actions clips",
            &sets.actions,
            &sets.actions.samples,
            actions,
        ),
    ];
    let mut all = Vec::new();
    for (name, set, lessons, truths) in of {
        for person in people(lessons) {
            let taught = of_person(lessons, &person);
            let is_other = |c: &&TrainClip| {
                c.person.as_ref() != Some(&person) && truths.iter().any(|s| s.clip == c.name)
            };
            let others = set.clips.iter().filter(is_other);
            let mut trial = Trial::new(&format!("{name} one"), set, taught, others, &truths);
            let dontcare = set
                .clips
                .iter()
                .filter(|c| c.name.contains("_dontcare_") && c.person.as_ref() != Some(&person));
            trial.add_unknown(&format!("{name} one"), &dontcare.collect::<Vec<_>>());
            trial.add_classified();
            all.push(trial);
        }
    }
    // All others teach.
    let set = &sets.gestures;
    let wanted: Vec<Sample> = (set.samples.iter().filter(is_gesture)).cloned().collect();
    let row = "gestures clips by person";
    for mut trial in of_folds(row, set, &wanted, FoldBy::Person, usize::MAX) {
        let others = trial
            .tests
            .iter()
            .filter_map(|t| t.clip.person.clone())
            .collect::<BTreeSet<_>>();
        let is_idle = |c: &&TrainClip| {
            c.name.contains("_dontcare_") && c.person.as_ref().is_some_and(|p| others.contains(p))
        };
        trial.tests.retain(|t| !t.truths.is_empty());
        trial.add_unknown(row, &set.clips.iter().filter(is_idle).collect::<Vec<_>>());
        trial.add_classified();
        all.push(trial);
    }
    all
}

/// Streams of hands, each quarter of them tested on what the others teach.
fn hands(sets: &DataSets) -> Vec<Trial<'_>> {
    const PARTS: usize = 4;
    let set = &sets.hands;
    let part_of = |name: &str| {
        set.clips
            .iter()
            .position(|c| c.name == name)
            .map(|at| at % PARTS)
    };
    let of_part = |part: usize| {
        let taught = set
            .samples
            .iter()
            .filter(|s| part_of(&s.clip) != Some(part));
        let tested = set.clips.iter().skip(part).step_by(PARTS);
        let trial = Trial::new(
            "hands by quarter",
            set,
            taught.cloned().collect(),
            tested,
            &set.samples,
        );
        Trial {
            name: format!("part {part}"),
            ..trial
        }
    };
    (0..PARTS).map(of_part).collect()
}

/// One person's lessons on the own session and on those of others, and everybody's on the session of the one left out.
fn of_sessions<'a>(
    name: &str,
    (teachers, lessons): (&'a MotionSet, &[Sample]),
    sessions: &'a MotionSet,
) -> Vec<Trial<'a>> {
    let mut all = Vec::new();
    for person in people(lessons) {
        let is_own = |c: &&TrainClip| c.person.as_ref() == Some(&person);
        let (own, others): (Vec<_>, Vec<_>) = sessions.clips.iter().partition(is_own);
        let taught = of_person(lessons, &person);
        let row = format!("{name} one");
        let mut one = Trial::new(
            &row,
            teachers,
            taught,
            others.into_iter(),
            &sessions.samples,
        );
        for copy in ["cam:1", "tilt:15", "occlude:0.2"] {
            one.add_copy(copy);
        }
        one.add_tests(
            &format!("{name} own"),
            own.iter().copied(),
            &sessions.samples,
        );
        all.push(one);
        let taught = lessons
            .iter()
            .filter(|s| s.person.as_ref() != Some(&person));
        let (row, taught) = (format!("{name} many"), taught.cloned().collect());
        all.push(Trial::new(
            &row,
            teachers,
            taught,
            own.into_iter(),
            &sessions.samples,
        ));
    }
    all
}

/// Clips without gestures, strikes and signals: those of everyday motion by class, and of other sets.
fn motion_without_classes<'a>(
    sets: &'a DataSets,
    everyday: &[&str],
    exercises: bool,
) -> Vec<&'a TrainClip> {
    let mut clips = sets.everyday.named(everyday);
    // Every fourth: twenty of each class are much alike.
    clips = clips.into_iter().step_by(4).collect();
    clips.extend(
        sets.referee
            .named(&["walking_", "running_", "basketball_", "jumping_"]),
    );
    if exercises {
        clips.extend(&sets.exercises.clips);
    } else {
        clips.extend(&sets.segmentation.clips);
    }
    clips
}

fn of_folds<'a>(
    row: &str,
    set: &'a MotionSet,
    samples: &[Sample],
    by: FoldBy,
    most: usize,
) -> Vec<Trial<'a>> {
    let person = |c: &TrainClip| c.person.clone().unwrap_or_else(|| c.name.clone());
    let persons: BTreeMap<String, String> = set
        .clips
        .iter()
        .map(|c| (c.name.clone(), person(c)))
        .collect();
    let pick = |places: &[usize]| {
        places
            .iter()
            .map(|&i| samples[i].clone())
            .collect::<Vec<_>>()
    };
    let of_fold = |fold: morec_measure::crossval::Fold| {
        let tested = set.clips.iter().filter(|c| fold.tested.contains(&c.name));
        let lessons = at_most(pick(&fold.taught), most);
        let mut trial = Trial::new(row, set, lessons, tested, samples);
        trial.held_back = pick(&fold.held_back);
        trial.name = fold.name;
        trial
    };
    folds(by, samples, &persons)
        .into_iter()
        .map(of_fold)
        .collect()
}

/// The first `most` samples of each class.
pub fn at_most(samples: Vec<Sample>, most: usize) -> Vec<Sample> {
    let mut counts = BTreeMap::<String, usize>::new();
    let kept = samples.into_iter().filter(|s| {
        let count = counts.entry(s.class.clone()).or_default();
        *count += 1;
        *count <= most
    });
    kept.collect()
}

pub fn people(samples: &[Sample]) -> BTreeSet<String> {
    samples.iter().filter_map(|s| s.person.clone()).collect()
}

pub fn of_person(samples: &[Sample], person: &str) -> Vec<Sample> {
    let own = samples
        .iter()
        .filter(|s| s.person.as_deref() == Some(person));
    own.cloned().collect()
}

impl<'a> Trial<'a> {
    /// Taught by `lessons` in clips of `set`, tested on `tested`.
    pub fn new(
        row: &str,
        set: &'a MotionSet,
        lessons: Vec<Sample>,
        tested: impl Iterator<Item = &'a TrainClip>,
        truths: &[Sample],
    ) -> Self {
        let names: BTreeSet<&str> = lessons.iter().map(|s| s.clip.as_str()).collect();
        let teachers = set.clips.iter().filter(|c| names.contains(c.name.as_str()));
        let persons: Vec<String> = people(&lessons).into_iter().collect();
        let mut trial = Self {
            name: persons.join("+"),
            teachers: teachers.collect(),
            background: Vec::new(),
            lessons,
            held_back: Vec::new(),
            tests: Vec::new(),
        };
        trial.add_tests(row, tested, truths);
        trial
    }

    fn add_tests(
        &mut self,
        row: &str,
        clips: impl Iterator<Item = &'a TrainClip>,
        samples: &[Sample],
    ) {
        self.tests.extend(clips.map(|clip| {
            TrialTest {
                row: row.to_owned(),
                clip,
                truths: samples
                    .iter()
                    .filter(|s| s.clip == clip.name)
                    .cloned()
                    .collect(),
                unknown: false,
                copy: None,
                classified: false,
            }
        }));
    }

    fn add_unknown(&mut self, row: &str, clips: &[&'a TrainClip]) {
        self.tests.extend(clips.iter().map(|clip| TrialTest {
            row: row.to_owned(),
            clip,
            truths: Vec::new(),
            unknown: true,
            copy: None,
            classified: false,
        }));
    }

    fn with_unknown(mut self, row: &str, clips: &[&'a TrainClip]) -> Self {
        self.add_unknown(row, clips);
        self
    }

    /// Classifies the clips as wholes, too.
    fn add_classified(&mut self) {
        let classified = self.tests.iter().map(|t| TrialTest {
            row: format!("{}, classified", t.row),
            clip: t.clip,
            truths: t.truths.clone(),
            unknown: t.unknown,
            copy: None,
            classified: true,
        });
        let classified: Vec<_> = classified.collect();
        self.tests.extend(classified);
    }

    fn add_copies(&mut self) {
        COPIES.iter().for_each(|copy| self.add_copy(copy));
    }

    /// Tests copies of the clips with samples too.
    fn add_copy(&mut self, copy: &str) {
        let known = self.tests.iter().filter(|t| !t.unknown && t.copy.is_none());
        let copies: Vec<_> = known
            .map(|t| TrialTest {
                row: format!("{}, {copy}", t.row),
                clip: t.clip,
                truths: t.truths.clone(),
                unknown: false,
                copy: copy.parse().ok(),
                classified: false,
            })
            .collect();
        self.tests.extend(copies);
    }
}
