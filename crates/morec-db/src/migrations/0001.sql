-- Schema 1. A migration that has been released is never edited; what comes next is 0002.sql.

-- A file that was read. Its content is known by its hash: the same bytes under another name are the same file.
CREATE TABLE files (
    id INTEGER PRIMARY KEY,
    hash BLOB NOT NULL UNIQUE,          -- BLAKE3 of the bytes, 32 bytes
    path TEXT NOT NULL,
    skeleton_path TEXT,                 -- of an AMC motion
    format TEXT NOT NULL,
    bytes INTEGER NOT NULL,
    imported_secs INTEGER NOT NULL,     -- since 1970, UTC
    warnings TEXT NOT NULL              -- JSON: what reading repaired or doubted
) STRICT;

-- Where else the same bytes were found.
CREATE TABLE file_copies (
    file INTEGER NOT NULL REFERENCES files ON DELETE CASCADE,
    path TEXT NOT NULL,
    PRIMARY KEY (file, path)
) STRICT, WITHOUT ROWID;

-- A file that could not be read; forgotten when it can be.
CREATE TABLE refused (
    path TEXT PRIMARY KEY,
    reason TEXT NOT NULL,
    tried_secs INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE skeletons (
    id INTEGER PRIMARY KEY,
    hash BLOB NOT NULL UNIQUE,          -- of names, parents and offsets
    joints INTEGER NOT NULL
) STRICT;

CREATE TABLE clips (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    file INTEGER NOT NULL REFERENCES files ON DELETE CASCADE,
    character INTEGER NOT NULL,         -- from 0, of the file
    skeleton INTEGER NOT NULL REFERENCES skeletons,
    frames INTEGER NOT NULL,
    rate_hz REAL NOT NULL,
    rest_frames INTEGER NOT NULL,       -- T-pose frames at the start
    repaired_frames INTEGER NOT NULL,
    roles TEXT NOT NULL,                -- JSON: joint number or null for each role, in their order
    facts TEXT NOT NULL,                -- JSON: what import inferred
    max_angle_rad REAL NOT NULL,        -- of the stored motion from the file's
    max_position_metres REAL NOT NULL,
    motion BLOB NOT NULL,               -- compressed clip, metres and Y up
    source TEXT,
    licence TEXT,
    subject TEXT
) STRICT;
CREATE INDEX clips_by_file ON clips (file);

CREATE TABLE tags (
    clip INTEGER NOT NULL REFERENCES clips ON DELETE CASCADE,
    tag TEXT NOT NULL,
    PRIMARY KEY (clip, tag)
) STRICT, WITHOUT ROWID;

-- Feature rows, made again whenever `recipe` is not what the program would use.
CREATE TABLE feature_rows (
    clip INTEGER PRIMARY KEY REFERENCES clips ON DELETE CASCADE,
    recipe TEXT NOT NULL,
    bones INTEGER NOT NULL,             -- bit set
    bytes BLOB NOT NULL
) STRICT;

-- Stretches that a method found; each run replaces what its method found in the clip before.
CREATE TABLE segments (
    id INTEGER PRIMARY KEY,
    clip INTEGER NOT NULL REFERENCES clips ON DELETE CASCADE,
    method TEXT NOT NULL,
    kind TEXT NOT NULL CHECK (kind IN ('motion', 'still', 'rest')),
    start_secs REAL NOT NULL,
    stop_secs REAL NOT NULL CHECK (stop_secs > start_secs)
) STRICT;
CREATE INDEX segments_by_clip ON segments (clip, method);

CREATE TABLE classes (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE CHECK (name <> '')
) STRICT;

CREATE TABLE samples (
    id INTEGER PRIMARY KEY,
    clip INTEGER NOT NULL REFERENCES clips ON DELETE CASCADE,
    class INTEGER NOT NULL REFERENCES classes ON DELETE CASCADE,
    start_secs REAL NOT NULL,
    stop_secs REAL NOT NULL CHECK (stop_secs > start_secs),
    whole_clip INTEGER NOT NULL CHECK (whole_clip IN (0, 1)),
    state TEXT NOT NULL CHECK (state IN ('accepted', 'proposed', 'rejected')),
    score REAL,
    set_by TEXT NOT NULL,
    set_secs INTEGER NOT NULL,
    UNIQUE (clip, class, start_secs, stop_secs)
) STRICT;
CREATE INDEX samples_by_class ON samples (class, state);

-- Trained indexes, with what taught them.
CREATE TABLE indexes (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    trained_secs INTEGER NOT NULL,
    samples TEXT NOT NULL,              -- JSON: clip, class, start, stop of each
    bytes BLOB NOT NULL
) STRICT;

-- Undo: each edit of classes or samples, and the rows as they were before it.
CREATE TABLE edits (
    id INTEGER PRIMARY KEY,
    what TEXT NOT NULL,
    set_secs INTEGER NOT NULL,
    open INTEGER NOT NULL DEFAULT 1     -- triggers write down what happens while an edit is open
) STRICT;
CREATE TABLE classes_before (
    seq INTEGER PRIMARY KEY,
    edit INTEGER NOT NULL REFERENCES edits ON DELETE CASCADE,
    id INTEGER NOT NULL,
    name TEXT                           -- NULL: there was no such row
) STRICT;
CREATE TABLE samples_before (
    seq INTEGER PRIMARY KEY,
    edit INTEGER NOT NULL REFERENCES edits ON DELETE CASCADE,
    id INTEGER NOT NULL,
    clip INTEGER,                       -- NULL: there was no such row
    class INTEGER, start_secs REAL, stop_secs REAL, whole_clip INTEGER, state TEXT, score REAL,
    set_by TEXT, set_secs INTEGER
) STRICT;

CREATE TRIGGER classes_inserted AFTER INSERT ON classes BEGIN
    INSERT INTO classes_before (edit, id) SELECT id, NEW.id FROM edits WHERE open = 1;
END;
CREATE TRIGGER classes_changed BEFORE UPDATE ON classes BEGIN
    INSERT INTO classes_before (edit, id, name) SELECT id, OLD.id, OLD.name FROM edits WHERE open = 1;
END;
CREATE TRIGGER classes_deleted BEFORE DELETE ON classes BEGIN
    INSERT INTO classes_before (edit, id, name) SELECT id, OLD.id, OLD.name FROM edits WHERE open = 1;
END;
CREATE TRIGGER samples_inserted AFTER INSERT ON samples BEGIN
    INSERT INTO samples_before (edit, id) SELECT id, NEW.id FROM edits WHERE open = 1;
END;
CREATE TRIGGER samples_changed BEFORE UPDATE ON samples BEGIN
    INSERT INTO samples_before (edit, id, clip, class, start_secs, stop_secs, whole_clip, state, score, set_by, set_secs)
    SELECT id, OLD.id, OLD.clip, OLD.class, OLD.start_secs, OLD.stop_secs, OLD.whole_clip, OLD.state, OLD.score,
        OLD.set_by, OLD.set_secs FROM edits WHERE open = 1;
END;
CREATE TRIGGER samples_deleted BEFORE DELETE ON samples BEGIN
    INSERT INTO samples_before (edit, id, clip, class, start_secs, stop_secs, whole_clip, state, score, set_by, set_secs)
    SELECT id, OLD.id, OLD.clip, OLD.class, OLD.start_secs, OLD.stop_secs, OLD.whole_clip, OLD.state, OLD.score,
        OLD.set_by, OLD.set_secs FROM edits WHERE open = 1;
END;
