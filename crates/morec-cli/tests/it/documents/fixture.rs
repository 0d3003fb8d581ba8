//! Folders with the files that the documents name.

use std::path::Path;

use morec::formats::bvh;
use morec::synth::{DatabaseSpec, Person, Script, SyntheticTake, database};

use crate::kit::Folder;

/// Synthetic gestures, and the classes of the documents that they stand for.
const CLASSES: [(&str, &str); 3] = [
    ("raise_hands", "hands_up"),
    ("clap", "illegal_dribble"),
    ("circle", "traveling"),
];

/// A clip of both kinds of folders.
pub const CLIP: &str = "new/signals_3.bvh";

/// A folder that each document gets a copy of.
pub struct Fixture(Folder);

impl Fixture {
    /// No files.
    pub fn empty() -> Self {
        Self(Folder::with(&[]))
    }

    /// `clips/`, `new/`, `background/`, `recordings/`, labels, people, an index and detections, of synthetic people.
    pub fn synthetic() -> Self {
        let fixture = Self::empty();
        let spec = DatabaseSpec {
            people: 3,
            repetitions: 2,
            classes: CLASSES.map(|(gesture, _)| gesture).to_vec(),
            unknown_share: 0.4,
            rate_hz: 30.0,
            ..DatabaseSpec::default()
        };
        let (mut labels, mut people) = (
            "clip\tclass\tstart_secs\tstop_secs\n".to_owned(),
            "clip\tperson\n".to_owned(),
        );
        for (n, take) in database(7, &spec).iter().enumerate() {
            let name = format!("signals_{}", n + 1);
            let folder = if n < 2 { "clips" } else { "new" };
            fixture.write_clip(&format!("{folder}/{name}.bvh"), take);
            fixture.write_clip(&format!("recordings/{name}.bvh"), take);
            labels += &rows(&name, take);
            people += &format!("{name}\t{}\n", take.person);
        }
        for n in 1..=2 {
            let take = other_motion(n);
            fixture.write_clip(&format!("background/walk_0{n}.bvh"), &take);
            fixture.write_clip(&format!("recordings/walk_0{n}.bvh"), &take);
        }
        fixture.write("labels.tsv", labels.as_bytes());
        fixture.write("people.tsv", people.as_bytes());
        fixture.train(&["--everyday", "never"]);
        fixture
    }

    /// The same files of real people: two clips of one person, one of another, and other motion; `recordings/` has all.
    #[cfg(unix)]
    pub fn real(data: &Path) -> Self {
        let fixture = Self::empty();
        let link = |from: &str, to: &str| {
            let to = fixture.0.path().join(to);
            std::fs::create_dir_all(to.parent().unwrap()).unwrap();
            let from = std::fs::canonicalize(data.join(from)).unwrap();
            std::os::unix::fs::symlink(from, to).unwrap();
        };
        for entry in std::fs::read_dir(data.join("referee/clips")).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            let from = format!("referee/clips/{name}");
            link(&from, &format!("recordings/{name}"));
            let folder = match name.split('_').next() {
                Some("signals") if name.contains('3') => "new",
                Some("signals") => "clips",
                Some("jumping" | "soccer" | "running") => "background",
                _ => continue,
            };
            link(&from, &format!("{folder}/{name}"));
        }
        // Files, not folders: a folder that is a link is not searched.
        for (folder, skeleton) in [("exercises", "skeleton.asf"), ("segmentation", "86.asf")] {
            link(
                &format!("{folder}/{skeleton}"),
                &format!("background/{folder}/{skeleton}"),
            );
            for entry in std::fs::read_dir(data.join(folder).join("clips")).unwrap() {
                let name = entry.unwrap().file_name().into_string().unwrap();
                link(
                    &format!("{folder}/clips/{name}"),
                    &format!("background/{folder}/{name}"),
                );
            }
        }
        link("referee/labels.tsv", "labels.tsv");
        link("referee/people.tsv", "people.tsv");
        fixture.train(&[]);
        fixture
    }

    /// A copy of all files in a folder of its own.
    pub fn copy(&self) -> Folder {
        let folder = Folder::with(&[]);
        copy(self.0.path(), folder.path());
        folder
    }

    fn write(&self, path: &str, bytes: &[u8]) {
        let path = self.0.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    fn write_clip(&self, path: &str, take: &SyntheticTake) {
        let mut bytes = Vec::new();
        bvh::write(&take.clip, &mut bytes).unwrap();
        self.write(path, &bytes);
    }

    /// The index and the detections that chapters begin with.
    fn train(&self, more: &[&str]) {
        let words =
            "train --clips clips --labels labels.tsv --background background -o signs.index";
        let words: Vec<&str> = words.split(' ').chain(more.iter().copied()).collect();
        self.0.morec(&words).ok();
        self.0
            .morec(&["recognize", "signs.index", "new", "-o", "found.tsv"])
            .ok();
    }
}

/// Half a minute of motion that is none of the classes: two such clips are enough background for training to add none.
fn other_motion(seed: u64) -> SyntheticTake {
    let script = Script::new(seed, Person::draw(seed, 9));
    script
        .play("walk")
        .play("reach")
        .play("turn_round")
        .rest_until(32.0)
        .film("walk", 30.0)
        .unwrap()
}

/// A take's labels, under the names of the documents.
fn rows(name: &str, take: &SyntheticTake) -> String {
    let class = |gesture: &str| CLASSES.iter().find(|(g, _)| *g == gesture).unwrap().1;
    take.labels
        .iter()
        .map(|l| {
            format!(
                "{name}\t{}\t{:.3}\t{:.3}\n",
                class(l.class),
                l.span.start_secs,
                l.span.stop_secs
            )
        })
        .collect()
}

/// Copies files and folders; links stay links.
fn copy(from: &Path, to: &Path) {
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        let kind = entry.file_type().unwrap();
        if kind.is_dir() {
            std::fs::create_dir_all(&target).unwrap();
            copy(&entry.path(), &target);
        } else if kind.is_symlink() {
            #[cfg(unix)]
            std::os::unix::fs::symlink(std::fs::read_link(entry.path()).unwrap(), target).unwrap();
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}
