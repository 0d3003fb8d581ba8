//! The choice of one clip of a file: `FILE#2`, `FILE#name`.

use std::path::{Path, PathBuf};

use crate::clip::Clip;
use crate::formats::{ParseError, Place};

/// The file that `path` names and which of its clips: `FILE#2` is the second, `FILE#name` the one of that name. A file whose
/// own name has a `#` is that file.
pub fn split_choice(path: &Path) -> (PathBuf, Option<String>) {
    let text = path.to_string_lossy();
    if path.exists() {
        return (path.to_owned(), None);
    }
    for (at, _) in text
        .match_indices('#')
        .collect::<Vec<_>>()
        .into_iter()
        .rev()
    {
        let file = Path::new(&text[..at]);
        if file.is_file() || text[..at] == *"-" {
            return (file.to_owned(), Some(text[at + 1..].to_owned()));
        }
    }
    (path.to_owned(), None)
}

/// The clip of number `choice`, from 1, or of that name (all of it or what follows the file's).
pub(super) fn chosen(clips: Vec<Clip>, choice: &str) -> Result<Vec<Clip>, ParseError> {
    let named = |clip: &Clip| {
        let rest = clip.name.split_once('#').map(|(_, rest)| rest);
        let last = clip.name.rsplit('#').next();
        clip.name == choice || rest == Some(choice) || last == Some(choice)
    };
    let numbered = choice.parse::<usize>().ok();
    let numbered = numbered.filter(|n| (1..=clips.len()).contains(n));
    let place = clips.iter().position(named).or(numbered.map(|n| n - 1));
    let names: Vec<&str> = clips.iter().take(20).map(|c| c.name.as_str()).collect();
    let Some(place) = place else {
        let found = format!("{} clips: {}", clips.len(), names.join(", "));
        let expected = format!("a clip `{choice}` in the file");
        return Err(ParseError::new(Place::File, expected, found));
    };
    Ok(clips.into_iter().skip(place).take(1).collect())
}
