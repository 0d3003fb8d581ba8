-- Schema 5: who labelled a sample. Several annotators may have said the same.

CREATE TABLE annotators (
    sample INTEGER NOT NULL REFERENCES samples ON DELETE CASCADE,
    annotator TEXT NOT NULL CHECK (annotator <> ''),
    PRIMARY KEY (sample, annotator)
) STRICT, WITHOUT ROWID;
CREATE TRIGGER annotators_inserted AFTER INSERT ON annotators BEGIN
    INSERT INTO was (edit, tab, present, c0, c1) SELECT id, 'annotators', 0, NEW.sample, NEW.annotator FROM edits
        WHERE open = 1;
END;
CREATE TRIGGER annotators_deleted BEFORE DELETE ON annotators BEGIN
    INSERT INTO was (edit, tab, present, c0, c1) SELECT id, 'annotators', 1, OLD.sample, OLD.annotator FROM edits
        WHERE open = 1;
END;
