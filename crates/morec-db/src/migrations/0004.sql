-- Schema 4: reports of trainings and cross-validations.

-- The last of each kind, in the order in which they were made; no part of the history. Numbers are not given again.
CREATE TABLE reports (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    kind TEXT NOT NULL,                 -- training, crossval
    made_secs INTEGER NOT NULL,
    title TEXT NOT NULL,
    report TEXT NOT NULL                -- JSON
) STRICT;
CREATE INDEX reports_by_kind ON reports (kind, id);
