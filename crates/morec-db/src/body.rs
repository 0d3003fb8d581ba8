//! Roles set by the user: the joint of each body part, in place of the roles that import inferred. Used by the command
//! (`db clips --set-role`) and the studio.

use std::collections::BTreeMap;

use morec::roles::{Role, RoleMap};
use rusqlite::{OptionalExtension, params};

use crate::motion::{roles_from_json, roles_to_json};
use crate::{ClipId, DbError, MotionDb};

impl MotionDb {
    /// Says which joints of clips play which parts, all or none, as one step. What depends on it (feature rows) is made anew
    /// when it is asked for.
    ///
    /// # Errors
    /// There is no such clip, or its skeleton has no such joint.
    pub fn set_roles(&mut self, clips: &[(ClipId, RoleMap)]) -> Result<(), DbError> {
        let what = format!("roles of {} clips", clips.len());
        self.edit(&what, |conn| {
            for (id, roles) in clips {
                let sql = "SELECT c.name, k.joints FROM clips c JOIN skeletons k ON k.id = c.skeleton WHERE c.id = ?1";
                let found: Option<(String, i64)> = conn
                    .prepare_cached(sql)?
                    .query_row(params![id.0], |row| Ok((row.get("name")?, row.get("joints")?)))
                    .optional()?;
                let (name, joints) =
                    found.ok_or_else(|| DbError::unknown("clip", &format!("#{}", id.0)))?;
                let given = Role::ALL.into_iter().filter_map(|role| roles.joint(role));
                if let Some(joint) = given.max().filter(|joint| *joint as i64 >= joints) {
                    return Err(DbError::Invalid(format!(
                        "clip {name} has {joints} joints, and no joint number {joint}"
                    )));
                }
                let sql = "UPDATE clips SET roles = ?2 WHERE id = ?1 AND roles <> ?2";
                conn.prepare_cached(sql)?
                    .execute(params![id.0, roles_to_json(roles)])?;
            }
            Ok(())
        })
    }

    /// Roles of every clip; empty for a clip whose stored roles are damaged.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn roles(&self) -> Result<BTreeMap<ClipId, RoleMap>, DbError> {
        let sql =
            "SELECT c.id, c.roles, k.joints FROM clips c JOIN skeletons k ON k.id = c.skeleton";
        let mut statement = self.conn.prepare(sql)?;
        let rows = statement.query_map([], |row| {
            let (json, joints): (String, i64) = (row.get("roles")?, row.get("joints")?);
            let roles = roles_from_json(&json, joints.max(0) as usize).unwrap_or_default();
            Ok((ClipId(row.get("id")?), roles))
        })?;
        Ok(rows.collect::<Result<_, _>>()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::database_of_waves;
    use morec::features::FeatureParams;

    #[test]
    fn roles_that_somebody_says_are_kept_and_taken_back_and_rows_follow() {
        let (_folder, mut db) = database_of_waves(1);
        let id = db.clips(&crate::ClipFilter::default()).unwrap()[0].id;
        let params = FeatureParams::default();
        let found = db.clip(id).unwrap().roles;
        let rows = db.rows(&params, &()).unwrap();
        let mut wrong = found.clone();
        wrong.set(Role::LeftHand, found.joint(Role::RightHand));
        wrong.set(Role::RightHand, None);
        db.set_roles(&[(id, wrong.clone())]).unwrap();
        assert_eq!(db.clip(id).unwrap().roles, wrong);
        assert_eq!(db.roles().unwrap()[&id], wrong);
        assert_ne!(db.rows(&params, &()).unwrap()[0].bones, rows[0].bones);
        db.undo(None).unwrap();
        assert_eq!(db.clip(id).unwrap().roles, found);
        assert_eq!(db.rows(&params, &()).unwrap()[0].bones, rows[0].bones);
        let mut beyond = RoleMap::default();
        beyond.set(Role::Hips, Some(1000));
        assert!(matches!(
            db.set_roles(&[(id, beyond)]),
            Err(DbError::Invalid(_))
        ));
    }
}
