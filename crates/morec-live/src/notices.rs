//! Notices about received data, passed from a source's thread to the caller.

use std::sync::{Arc, Mutex, PoisonError};

/// This many different ones are shown.
const MAX_SHOWN: usize = 8;

/// Texts of a source for the user; copies share them.
#[derive(Debug, Clone, Default)]
pub struct Notices {
    left: Arc<Mutex<Left>>,
}

#[derive(Debug, Default)]
struct Left {
    /// Notices that were given already.
    known: Vec<String>,
    /// To be shown.
    texts: Vec<String>,
    full: bool,
}

impl Notices {
    /// Leaves `text` about something at `place`, unless the same was said of an earlier place. A sender that is wrong is
    /// wrong in every line.
    pub fn add(&self, place: impl FnOnce() -> String, text: String) {
        let mut left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
        if left.known.contains(&text) || left.full {
            return;
        }
        if left.known.len() == MAX_SHOWN {
            left.full = true;
            left.texts
                .push("further errors are counted but not shown".to_owned());
            return;
        }
        left.texts.push(format!("{}: {text}", place()));
        left.known.push(text);
    }

    /// Leaves `text`, once.
    pub fn tell(&self, text: String) {
        let mut left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
        if left.known.len() < MAX_SHOWN && !left.known.contains(&text) {
            left.texts.push(text.clone());
            left.known.push(text);
        }
    }

    /// Takes what was left since the last time.
    pub fn take(&self) -> Vec<String> {
        let mut left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut left.texts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_mistake_is_shown_once_and_not_too_many() {
        let notices = Notices::default();
        for line in 0..100 {
            notices.add(|| format!("line {line}"), format!("mistake {}", line % 20));
        }
        let texts = notices.take();
        assert_eq!(texts.len(), MAX_SHOWN + 1);
        assert_eq!(texts[0], "line 0: mistake 0");
        assert!(texts[MAX_SHOWN].contains("not shown"));
        assert!(notices.take().is_empty());
    }
}
