-- Schema 3: places of classes, and who made a step.

-- The place of a class, from 0, by which programs give it a key and a colour. Kept by name, so that a class that is removed and
-- comes back has the place that it had; no part of the history.
CREATE TABLE class_places (
    name TEXT PRIMARY KEY,
    place INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
-- Until now the order of the names was the order of the keys.
INSERT INTO class_places (name, place)
    SELECT name, (SELECT count(*) FROM classes o WHERE o.name < c.name) FROM classes c;

ALTER TABLE edits ADD COLUMN made_by TEXT NOT NULL DEFAULT ''; -- the program; empty: not known
