//! Places of classes in a fixed order, from which programs derive keys and colours.
//!
//! They are kept by name and are no part of the history: a class that goes and comes back has the place that it had.

use std::collections::BTreeMap;

use rusqlite::params;

use crate::{DbError, MotionDb};

impl MotionDb {
    /// The place of each class, from 0, by name. Names of removed classes are included, so that a class that returns gets
    /// its place again.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn class_places(&self) -> Result<BTreeMap<String, usize>, DbError> {
        let sql = "SELECT name, place FROM class_places";
        let mut statement = self.conn.prepare(sql)?;
        let places = statement.query_map([], |row| {
            Ok((row.get(0)?, row.get::<_, i64>(1)?.max(0) as usize))
        })?;
        Ok(places.collect::<Result<_, _>>()?)
    }

    /// Sets the places of classes, without a step of the history.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn place_classes(&mut self, places: &BTreeMap<String, usize>) -> Result<(), DbError> {
        let tx = self.write()?;
        for (name, place) in places {
            let sql = "INSERT OR REPLACE INTO class_places (name, place) VALUES (?1, ?2)";
            tx.prepare_cached(sql)?
                .execute(params![name, *place as i64])?;
        }
        tx.commit()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::database_of_waves;

    #[test]
    fn places_are_kept_and_go_with_a_new_name() {
        let (_folder, mut db) = database_of_waves(1);
        let clip = db.clips(&Default::default()).unwrap()[0].clone();
        let whole = crate::labels::WholeClip {
            clip: clip.id,
            class: Some("wave".to_owned()),
            subject: None,
        };
        db.label_clips(&[whole], "test", None).unwrap();
        let steps = db.history().unwrap().len();
        db.place_classes(&[("wave".to_owned(), 4)].into()).unwrap();
        assert_eq!(db.history().unwrap().len(), steps, "no step to take back");
        db.rename_class("wave", "greet").unwrap();
        assert_eq!(db.class_places().unwrap()["greet"], 4);
        db.undo(None).unwrap();
        assert_eq!(db.class_places().unwrap()["wave"], 4);
    }
}
