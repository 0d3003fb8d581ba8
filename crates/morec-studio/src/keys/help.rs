//! The page of keys.

/// Entries of the page of keys: area, keys, effect.
pub const HELP: &[(&str, &str, &str)] = &[
    (
        "Anywhere",
        "Ctrl 1 … 5",
        "Library, Label, Classes, Train, Live",
    ),
    ("Anywhere", "Ctrl Z, Ctrl Shift Z", "undo, redo"),
    (
        "Anywhere",
        "Ctrl O, Ctrl I",
        "open a database, import clips",
    ),
    ("Anywhere", "Ctrl T", "train"),
    ("Anywhere", "Ctrl H, F1", "history, this page"),
    ("Library", "Ctrl A", "select all clips of the list"),
    (
        "Library, labels",
        "Ctrl F",
        "search clips; Down goes to the first hit",
    ),
    (
        "Library, labels",
        "Up, Down",
        "the clip above, below in the list",
    ),
    ("Train", "Up, Down", "the moment above, below in the list"),
    (
        "Classes, Live",
        "Up, Down",
        "the sample, hit, set, group or recognised motion above, below",
    ),
    (
        "Library, Train",
        "Home, End",
        "the first, the last of the list",
    ),
    (
        "Lists",
        "Up, Down, Home, End, Enter",
        "in the focused list (Tab); Page Up, Page Down: ten lines",
    ),
    (
        "Library",
        "1 … 9",
        "label the selected clips as a whole with this class",
    ),
    (
        "Library",
        "B",
        "use the selected clips as background, or stop using them",
    ),
    ("Playing", "Space", "play, stop"),
    (
        "Playing",
        "J  K  L",
        "play backwards, stop, play forwards; again: faster",
    ),
    ("Playing", "Left Right  , .", "a frame back, a frame on"),
    ("Playing", "Shift Left Right", "a second back, a second on"),
    (
        "Labels, classes",
        "Home, End",
        "to the beginning, to the end",
    ),
    ("Playing", "O", "loop the selected stretch or label"),
    ("Playing", "I", "stay inside the segment between the cuts"),
    (
        "Labels",
        "1 … 9 held",
        "while playing: label the motion as long as the key is held",
    ),
    (
        "Labels",
        "1 … 9 tapped",
        "count repetitions: each tap ends one and begins the next",
    ),
    (
        "Labels",
        "1 … 9, selected",
        "label the selected stretch, or change the selected label's class",
    ),
    ("Labels", "Escape", "end the selection"),
    (
        "Labels, live",
        "Q, W",
        "like 1 … 9, for any class; W chooses the class by its first letters",
    ),
    ("Labels", "S, M", "split at the playhead, merge"),
    (
        "Labels",
        "[  ]",
        "move start, stop of the selected label to the playhead",
    ),
    (
        "Labels",
        "Ctrl Left Right",
        "move the selected label by a frame",
    ),
    ("Labels", "Alt Left Right", "move its start by a frame"),
    ("Labels", "Alt Shift Left Right", "move its stop by a frame"),
    ("Labels", "Delete", "remove the selected labels"),
    ("Labels", "Tab, Enter", "move to the next label, select it"),
    (
        "Proposals",
        "A, R, N",
        "accept, reject, then the next doubtful one is shown; the next",
    ),
    (
        "Annotators",
        "A, B, E",
        "take the label of A, of B, keep both; the next is shown",
    ),
    (
        "Searching",
        "F, C",
        "find motions like the selection; compare with the nearest",
    ),
    ("Cuts", "X", "cut at the playhead"),
    (
        "Cuts",
        "Ctrl Left Right  [ ]",
        "move the selected cut by a frame, to the playhead",
    ),
    ("Cuts", "Delete", "remove the selected cut"),
    ("Timeline", "+  −  0", "zoom in, zoom out, the whole clip"),
    (
        "Live",
        "1 … 9",
        "label the last motion, or the selected stretch, with this class",
    ),
    ("Live", "0", "mark it as background (none of the classes)"),
    ("Live", "Space, R", "start or stop, record a take"),
    (
        "Live",
        "Left Right, End",
        "move back, forward in the last minutes; to the present",
    ),
];
