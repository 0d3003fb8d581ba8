//! Fonts of the system for names whose letters the fonts of the program do not have.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use ab_glyph::{Font, FontRef};
use egui::epaint::text::{FontInsert, FontPriority, InsertFontFamily};
use egui::{Context, FontData, FontFamily, FontId};

use crate::state::State;

/// Where systems keep fonts that have many letters: Chinese, Japanese and Korean ones, and those that have Arabic, Hebrew and Thai ones.
const USUAL: [&str; 31] = [
    "/usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc",
    "/usr/share/fonts/noto-cjk/NotoSansCJK-Regular.ttc",
    "/usr/share/fonts/google-noto-cjk/NotoSansCJK-Regular.ttc",
    "/usr/share/fonts/google-noto-sans-cjk-fonts/NotoSansCJK-Regular.ttc",
    "/usr/share/fonts/google-noto-sans-cjk-vf-fonts/NotoSansCJK-VF.ttc",
    "/usr/share/fonts/truetype/noto/NotoSansCJK-Regular.ttc",
    "/usr/share/fonts/opentype/source-han-sans/SourceHanSans-Regular.ttc",
    "/usr/share/fonts/truetype/wqy/wqy-microhei.ttc",
    "/usr/share/fonts/wenquanyi/wqy-microhei/wqy-microhei.ttc",
    "/usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf",
    "/usr/share/fonts/opentype/ipafont-gothic/ipag.ttf",
    "/usr/share/fonts/truetype/nanum/NanumGothic.ttf",
    "/usr/share/fonts/truetype/noto/NotoSansArabic-Regular.ttf",
    "/usr/share/fonts/noto/NotoSansArabic-Regular.ttf",
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/System/Library/Fonts/Supplemental/Arial Unicode.ttf",
    "/Library/Fonts/Arial Unicode.ttf",
    "/System/Library/Fonts/PingFang.ttc",
    "/System/Library/Fonts/Hiragino Sans GB.ttc",
    "/System/Library/Fonts/AppleSDGothicNeo.ttc",
    "/System/Library/Fonts/GeezaPro.ttc",
    "C:\\Windows\\Fonts\\msyh.ttc",
    "C:\\Windows\\Fonts\\YuGothR.ttc",
    "C:\\Windows\\Fonts\\msgothic.ttc",
    "C:\\Windows\\Fonts\\malgun.ttf",
    "C:\\Windows\\Fonts\\simsun.ttc",
    "C:\\Windows\\Fonts\\segoeui.ttf",
    "C:\\Windows\\Fonts\\tahoma.ttf",
    "C:\\Windows\\Fonts\\leelawui.ttf",
];

/// Adds fonts as names need them.
pub struct Fonts {
    /// Files that are not in use, in order of preference.
    files: Vec<PathBuf>,
    /// The version of the database whose names were looked at last.
    seen: Option<u64>,
    /// Letters that were looked for.
    known: BTreeSet<char>,
    /// Those of them that no font has.
    missing: BTreeSet<char>,
}

impl Default for Fonts {
    fn default() -> Self {
        let usual = USUAL.into_iter().map(PathBuf::from);
        let own = std::env::home_dir().map(|home| fonts_of(&home));
        Self::of(usual.chain(own.into_iter().flatten()).collect())
    }
}

/// Fonts that a user has installed in their home folder, in order of their paths.
fn fonts_of(home: &Path) -> Vec<PathBuf> {
    let mut folders = [".local/share/fonts", ".fonts", "Library/Fonts"]
        .map(|folder| home.join(folder))
        .to_vec();
    let mut fonts = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let (path, kind) = (entry.path(), entry.file_type());
            let ending = path.extension().map(|e| e.to_ascii_lowercase());
            if kind.is_ok_and(|kind| kind.is_dir()) {
                folders.push(path);
            } else if ending.is_some_and(|e| e == "ttf" || e == "otf" || e == "ttc") {
                fonts.push(path);
            }
        }
    }
    fonts.sort();
    fonts
}

impl Fonts {
    /// Of these files, in order of preference.
    pub fn of(files: Vec<PathBuf>) -> Self {
        Self {
            files,
            seen: None,
            known: BTreeSet::new(),
            missing: BTreeSet::new(),
        }
    }

    /// Adds fonts for the names of a changed database. Names with a letter that no font has become `state.undrawn`.
    pub fn follow(&mut self, ctx: &Context, state: &mut State) {
        let Some(store) = &state.store else { return };
        if self.seen == Some(store.version) {
            return;
        }
        self.seen = Some(store.version);
        let clips = store.snapshot.clips.iter();
        let clips = clips.flat_map(|clip| clip.subject.iter().chain([&clip.name]));
        let classes = store.snapshot.classes.iter().map(|class| &class.name);
        let strange: BTreeSet<&String> = classes.chain(clips).filter(|n| !n.is_ascii()).collect();
        let letters = strange.iter().flat_map(|name| name.chars());
        let new: BTreeSet<char> = letters.filter(|c| !self.known.contains(c)).collect();
        let font = FontId::proportional(13.0);
        let has = |letter: &char| ctx.fonts_mut(|f| f.has_glyphs(&font, &letter.to_string()));
        self.missing.extend(new.iter().filter(|c| !has(c)));
        if new.iter().any(|letter| self.missing.contains(letter)) {
            self.add(ctx);
        }
        self.known.extend(new);
        let undrawn = strange.into_iter().filter(|name| {
            let mut letters = name.chars();
            letters.any(|letter| self.missing.contains(&letter))
        });
        state.undrawn = undrawn.cloned().collect();
    }

    /// Adds fonts that have letters that are missing.
    fn add(&mut self, ctx: &Context) {
        let missing = &mut self.missing;
        self.files.retain(|path| {
            if missing.is_empty() {
                return true;
            }
            let Ok(bytes) = std::fs::read(path) else {
                return true;
            };
            let before = missing.len();
            // A font that cannot be read is left alone.
            if let Ok(font) = FontRef::try_from_slice(&bytes) {
                missing.retain(|letter| font.glyph_id(*letter).0 == 0);
            }
            let helps = missing.len() < before;
            if helps {
                insert(ctx, &path.to_string_lossy(), bytes);
            }
            !helps
        });
    }
}

/// A font for what the others lack.
fn insert(ctx: &Context, name: &str, bytes: Vec<u8>) {
    let families = [FontFamily::Proportional, FontFamily::Monospace];
    let families = families.map(|family| InsertFontFamily {
        family,
        priority: FontPriority::Lowest,
    });
    let data = FontData::from_owned(bytes);
    ctx.add_font(FontInsert::new(name, data, families.to_vec()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fonts_of_a_user_are_found_in_folders_of_folders() {
        let home = tempfile::tempdir().unwrap();
        let write = |path: &str| {
            let path = home.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, b"").unwrap();
            path
        };
        let own = write(".fonts/Own.TTF");
        let deep = write(".local/share/fonts/nanum/NanumGothic.ttf");
        write(".local/share/fonts/readme.txt");
        assert_eq!(fonts_of(home.path()), [own, deep]);
    }
}
