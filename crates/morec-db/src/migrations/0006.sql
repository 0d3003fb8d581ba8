-- Schema 6: a video beside a clip. The file stays where it is.

CREATE TABLE videos (
    clip INTEGER PRIMARY KEY REFERENCES clips ON DELETE CASCADE,
    path TEXT NOT NULL CHECK (path <> ''),
    offset_secs REAL NOT NULL           -- time of the video at which the clip begins
) STRICT;
CREATE TRIGGER videos_inserted AFTER INSERT ON videos BEGIN
    INSERT INTO was (edit, tab, present, c0) SELECT id, 'videos', 0, NEW.clip FROM edits WHERE open = 1;
END;
CREATE TRIGGER videos_updated BEFORE UPDATE ON videos BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2) SELECT id, 'videos', 1, OLD.clip, OLD.path, OLD.offset_secs FROM edits
        WHERE open = 1;
END;
CREATE TRIGGER videos_deleted BEFORE DELETE ON videos BEGIN
    INSERT INTO was (edit, tab, present, c0, c1, c2) SELECT id, 'videos', 1, OLD.clip, OLD.path, OLD.offset_secs FROM edits
        WHERE open = 1;
END;
