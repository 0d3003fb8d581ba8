-- Schema 2: one history for changes of every kind, and checksums for what is kept.

-- Rows as they were before each step touched them, of all tables whose changes can be taken back; columns in the order in
-- which the table's own triggers below name them, its key first. They have no types: values keep theirs.
CREATE TABLE was (
    seq INTEGER PRIMARY KEY,
    edit INTEGER NOT NULL REFERENCES edits ON DELETE CASCADE,
    tab TEXT NOT NULL,
    present INTEGER NOT NULL,           -- 0: there was no such row, and only its key stands here
    c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13, c14, c15, c16
);
CREATE INDEX was_by_edit ON was (edit, tab);
CREATE INDEX was_by_row ON was (tab, c0);

ALTER TABLE edits ADD COLUMN undone INTEGER NOT NULL DEFAULT 0;
ALTER TABLE edits ADD COLUMN bytes INTEGER NOT NULL DEFAULT 0; -- of motion and indexes that the step keeps
CREATE INDEX edits_open ON edits (open) WHERE open = 1;

-- Steps of schema 1: samples are put back before classes, so they stand behind them.
INSERT INTO was (edit, tab, present, c0, c1)
    SELECT edit, 'classes', name IS NOT NULL, id, name FROM classes_before ORDER BY edit, seq;
INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5, c6, c7, c8, c9)
    SELECT edit, 'samples', clip IS NOT NULL, id, clip, class, start_secs, stop_secs, whole_clip, state, score, set_by,
        set_secs FROM samples_before ORDER BY edit, seq;
DROP TRIGGER classes_inserted;
DROP TRIGGER classes_changed;
DROP TRIGGER classes_deleted;
DROP TRIGGER samples_inserted;
DROP TRIGGER samples_changed;
DROP TRIGGER samples_deleted;
DROP TABLE classes_before;
DROP TABLE samples_before;

-- Feature rows are made again: those of schema 1 have no checksum that would tell whether they are whole.
DELETE FROM feature_rows;
ALTER TABLE feature_rows ADD COLUMN sum BLOB; -- BLAKE3 of recipe, bones and bytes

-- Of each table's rows: the exclusive or of their BLAKE3 hashes. Motion and indexes have checksums inside.
CREATE TABLE digests (
    tab TEXT PRIMARY KEY,
    sum BLOB NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TRIGGER files_inserted AFTER INSERT ON files BEGIN
    INSERT INTO was (edit, tab, present, c0) SELECT id, 'files', 0, NEW.id FROM edits WHERE open = 1;
END;
CREATE TRIGGER files_changed BEFORE UPDATE ON files BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5, c6, c7) SELECT id, 'files', 1, OLD.id, OLD.hash,
        OLD.path, OLD.skeleton_path, OLD.format, OLD.bytes, OLD.imported_secs, OLD.warnings FROM edits WHERE open = 1;
END;
CREATE TRIGGER files_deleted BEFORE DELETE ON files BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5, c6, c7) SELECT id, 'files', 1, OLD.id, OLD.hash,
        OLD.path, OLD.skeleton_path, OLD.format, OLD.bytes, OLD.imported_secs, OLD.warnings FROM edits WHERE open = 1;
END;
CREATE TRIGGER file_copies_inserted AFTER INSERT ON file_copies BEGIN
    INSERT INTO was (edit, tab, present, c0, c1) SELECT id, 'file_copies', 0, NEW.file, NEW.path FROM edits WHERE open
        = 1;
END;
CREATE TRIGGER file_copies_deleted BEFORE DELETE ON file_copies BEGIN
    INSERT INTO was (edit, tab, present, c0, c1) SELECT id, 'file_copies', 1, OLD.file, OLD.path FROM edits WHERE open
        = 1;
END;
CREATE TRIGGER refused_inserted AFTER INSERT ON refused BEGIN
    INSERT INTO was (edit, tab, present, c0) SELECT id, 'refused', 0, NEW.path FROM edits WHERE open = 1;
END;
CREATE TRIGGER refused_changed BEFORE UPDATE ON refused BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2) SELECT id, 'refused', 1, OLD.path, OLD.reason, OLD.tried_secs
        FROM edits WHERE open = 1;
END;
CREATE TRIGGER refused_deleted BEFORE DELETE ON refused BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2) SELECT id, 'refused', 1, OLD.path, OLD.reason, OLD.tried_secs
        FROM edits WHERE open = 1;
END;
CREATE TRIGGER clips_inserted AFTER INSERT ON clips BEGIN
    INSERT INTO was (edit, tab, present, c0) SELECT id, 'clips', 0, NEW.id FROM edits WHERE open = 1;
END;
CREATE TRIGGER clips_changed BEFORE UPDATE ON clips BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13, c14, c15, c16)
        SELECT id, 'clips', 1, OLD.id, OLD.name, OLD.file, OLD.character, OLD.skeleton, OLD.frames, OLD.rate_hz,
        OLD.rest_frames, OLD.repaired_frames, OLD.roles, OLD.facts, OLD.max_angle_rad, OLD.max_position_metres,
        OLD.source, OLD.licence, OLD.subject, CASE WHEN OLD.motion IS NOT NEW.motion THEN OLD.motion END FROM edits
        WHERE open = 1;
END;
CREATE TRIGGER clips_deleted BEFORE DELETE ON clips BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13, c14, c15, c16)
        SELECT id, 'clips', 1, OLD.id, OLD.name, OLD.file, OLD.character, OLD.skeleton, OLD.frames, OLD.rate_hz,
        OLD.rest_frames, OLD.repaired_frames, OLD.roles, OLD.facts, OLD.max_angle_rad, OLD.max_position_metres,
        OLD.source, OLD.licence, OLD.subject, OLD.motion FROM edits WHERE open = 1;
END;
CREATE TRIGGER tags_inserted AFTER INSERT ON tags BEGIN
    INSERT INTO was (edit, tab, present, c0, c1) SELECT id, 'tags', 0, NEW.clip, NEW.tag FROM edits WHERE open = 1;
END;
CREATE TRIGGER tags_deleted BEFORE DELETE ON tags BEGIN
    INSERT INTO was (edit, tab, present, c0, c1) SELECT id, 'tags', 1, OLD.clip, OLD.tag FROM edits WHERE open = 1;
END;
CREATE TRIGGER segments_inserted AFTER INSERT ON segments BEGIN
    INSERT INTO was (edit, tab, present, c0) SELECT id, 'segments', 0, NEW.id FROM edits WHERE open = 1;
END;
CREATE TRIGGER segments_changed BEFORE UPDATE ON segments BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5) SELECT id, 'segments', 1, OLD.id, OLD.clip,
        OLD.method, OLD.kind, OLD.start_secs, OLD.stop_secs FROM edits WHERE open = 1;
END;
CREATE TRIGGER segments_deleted BEFORE DELETE ON segments BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5) SELECT id, 'segments', 1, OLD.id, OLD.clip,
        OLD.method, OLD.kind, OLD.start_secs, OLD.stop_secs FROM edits WHERE open = 1;
END;
CREATE TRIGGER classes_inserted AFTER INSERT ON classes BEGIN
    INSERT INTO was (edit, tab, present, c0) SELECT id, 'classes', 0, NEW.id FROM edits WHERE open = 1;
END;
CREATE TRIGGER classes_changed BEFORE UPDATE ON classes BEGIN
    INSERT INTO was (edit, tab, present, c0, c1) SELECT id, 'classes', 1, OLD.id, OLD.name FROM edits WHERE open = 1;
END;
CREATE TRIGGER classes_deleted BEFORE DELETE ON classes BEGIN
    INSERT INTO was (edit, tab, present, c0, c1) SELECT id, 'classes', 1, OLD.id, OLD.name FROM edits WHERE open = 1;
END;
CREATE TRIGGER samples_inserted AFTER INSERT ON samples BEGIN
    INSERT INTO was (edit, tab, present, c0) SELECT id, 'samples', 0, NEW.id FROM edits WHERE open = 1;
END;
CREATE TRIGGER samples_changed BEFORE UPDATE ON samples BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5, c6, c7, c8, c9) SELECT id, 'samples', 1, OLD.id,
        OLD.clip, OLD.class, OLD.start_secs, OLD.stop_secs, OLD.whole_clip, OLD.state, OLD.score, OLD.set_by,
        OLD.set_secs FROM edits WHERE open = 1;
END;
CREATE TRIGGER samples_deleted BEFORE DELETE ON samples BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4, c5, c6, c7, c8, c9) SELECT id, 'samples', 1, OLD.id,
        OLD.clip, OLD.class, OLD.start_secs, OLD.stop_secs, OLD.whole_clip, OLD.state, OLD.score, OLD.set_by,
        OLD.set_secs FROM edits WHERE open = 1;
END;
CREATE TRIGGER indexes_inserted AFTER INSERT ON indexes BEGIN
    INSERT INTO was (edit, tab, present, c0) SELECT id, 'indexes', 0, NEW.id FROM edits WHERE open = 1;
END;
CREATE TRIGGER indexes_changed BEFORE UPDATE ON indexes BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4) SELECT id, 'indexes', 1, OLD.id, OLD.name,
        OLD.trained_secs, OLD.samples, CASE WHEN OLD.bytes IS NOT NEW.bytes THEN OLD.bytes END FROM edits WHERE open =
        1;
END;
CREATE TRIGGER indexes_deleted BEFORE DELETE ON indexes BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2, c3, c4) SELECT id, 'indexes', 1, OLD.id, OLD.name,
        OLD.trained_secs, OLD.samples, OLD.bytes FROM edits WHERE open = 1;
END;

-- Feature rows are of the motion that a clip has now.
CREATE TRIGGER clips_moved AFTER UPDATE OF motion, roles, rest_frames ON clips
WHEN OLD.motion IS NOT NEW.motion OR OLD.roles <> NEW.roles OR OLD.rest_frames <> NEW.rest_frames BEGIN
    DELETE FROM feature_rows WHERE clip = NEW.id;
END;
