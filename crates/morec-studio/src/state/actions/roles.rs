//! Roles of joints, changed by hand.

use std::sync::Arc;

use morec::roles::{Role, RoleMap};
use morec_db::ClipId;

use crate::state::State;
use crate::store::{Edit, Snapshot};

impl State {
    /// The clips whose roles change with those of the clip that is shown: those with as many joints and the same roles until
    /// now are of the same rig.
    pub fn clips_of_roles(&self) -> Vec<ClipId> {
        let (Some(store), Some(clip)) = (&self.store, self.shown_clip()) else {
            return Vec::new();
        };
        if self.library.roles_of_one {
            return vec![clip.id];
        }
        let roles = store.snapshot.roles.get(&clip.id);
        let clips = store.snapshot.clips.iter();
        clips
            .filter(|c| c.joints == clip.joints && store.snapshot.roles.get(&c.id) == roles)
            .map(|c| c.id)
            .collect()
    }

    /// A joint plays a part of the body, in place of what it played before.
    pub(in crate::state) fn give_role(&mut self, role: Role, joint: Option<usize>) {
        let Some(motion) = &self.player.motion else {
            return;
        };
        let mut roles: RoleMap = motion.roles.clone();
        if roles.joint(role) == joint {
            self.library.role = None;
            return;
        }
        // A joint plays one part: two parts of one joint would be a bone without length.
        for other in Role::ALL {
            if joint.is_some() && roles.joint(other) == joint {
                roles.set(other, None);
            }
        }
        roles.set(role, joint);
        let clips = self.clips_of_roles().into_iter();
        let changed: Vec<(ClipId, RoleMap)> = clips.map(|id| (id, roles.clone())).collect();
        self.library.role = None;
        self.edit(Edit::Roles(changed));
    }

    /// Clips whose roles have changed are decoded anew; the one that is shown stays where it is.
    pub(in crate::state) fn roles_changed(&mut self, snapshot: &Snapshot) {
        self.motions.forget_changed(&snapshot.roles);
        let Some(shown) = self.player.motion.clone() else {
            return;
        };
        let same = |roles: &RoleMap| *roles == shown.roles;
        if snapshot.roles.get(&shown.id).is_none_or(same) {
            return;
        }
        self.reopening = Some(shown.id);
        self.want_motion(shown.id);
    }

    /// A clip that was decoded anew takes the place of what is shown of it.
    pub(in crate::state) fn reopened(&mut self, motion: &Arc<crate::body::ClipMotion>) {
        if self.reopening.take_if(|id| *id == motion.id).is_none() {
            return;
        }
        self.player.motion = Some(motion.clone());
        self.companions.all.clear();
        self.look_anew(motion);
    }
}
