//! A published set of points, and its comparison with the names of a clip.

use super::place::{Expression, PointJoint};
use crate::roles::Role;

/// A set of points that somebody published.
pub(super) struct PointSet {
    /// Its name in reports.
    pub(super) name: &'static str,
    /// Its points, blanks between them; `?` stands for `l` and `r`. In the order of their numbers, where points without
    /// names are numbered.
    pub(super) points: &'static str,
    /// True if points may come as numbers alone.
    pub(super) numbered: bool,
    /// True if points are recognised by these names; false where the names are everybody's, and only numbers tell.
    pub(super) by_name: bool,
    /// The point or points of each role: [`Expression`]s.
    pub(super) roles: &'static [(&'static str, &'static str)],
    /// The places at which roles that `roles` leaves open are looked for: the same for other names.
    pub(super) more_roles: &'static [(&'static str, &'static str)],
}

/// A known set of points that a clip's points belong to, and the roles in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Recognised {
    /// The set's name.
    pub set: &'static str,
    /// The point of each role, in the order of [`Role::ALL`].
    pub roles: Vec<(Role, PointJoint)>,
}

/// Roles that make a body; fewer are chance.
pub(super) const LEAST_ROLES: usize = 5;

impl Recognised {
    pub(super) fn has_hips(&self) -> bool {
        let known = |role| self.roles.iter().any(|(known, _)| *known == role);
        known(Role::LeftThigh) && known(Role::RightThigh)
    }
}

impl PointSet {
    pub(super) fn names(&self) -> impl Iterator<Item = String> + '_ {
        self.points.split_whitespace().flat_map(|name| {
            let sides: &[&str] = if name.contains('?') {
                &["l", "r"]
            } else {
                &[""]
            };
            sides.iter().map(move |side| name.replace('?', side))
        })
    }

    pub(super) fn len(&self) -> usize {
        self.names().count()
    }

    /// The share of the set's points that are there, 0 to 1.
    pub(super) fn coverage(&self, names: &[String]) -> f64 {
        let common = self.names().filter(|name| names.contains(name)).count();
        common as f64 / self.len() as f64
    }

    /// Twice the points in common over all points of both, 0 to 1.
    pub(super) fn likeness(&self, names: &[String]) -> f64 {
        let (mut own, mut common) = (0, 0);
        for name in self.names() {
            own += 1;
            common += usize::from(names.contains(&name));
        }
        2.0 * common as f64 / (own + names.len()) as f64
    }

    /// The roles of points of these normalised names, if that makes a body.
    pub(super) fn assign(&self, names: &[String]) -> Option<Recognised> {
        let mut roles: Vec<(Role, PointJoint)> = Vec::new();
        for table in [self.roles, self.more_roles] {
            for (role, expression) in table.iter().flat_map(sided) {
                let known = |r: Role| roles.iter().any(|(known, _)| *known == r);
                let Some(role) = Role::from_name(&role).filter(|&r| !known(r)) else {
                    continue;
                };
                let place = Expression::new(&expression).place(names, &roles);
                // A shoulder that plays the upper arm is no collar.
                if let Some(place) = place.filter(|p| !roles.iter().any(|(_, q)| q == p)) {
                    roles.push((role, place));
                }
            }
        }
        roles.sort_by_key(|(role, _)| role.index());
        (roles.len() >= LEAST_ROLES).then_some(Recognised {
            set: self.name,
            roles,
        })
    }
}

/// An entry of a table for each side it names.
fn sided((role, expression): &(&str, &str)) -> Vec<(String, String)> {
    if !role.starts_with("?_") {
        return vec![((*role).to_owned(), (*expression).to_owned())];
    }
    [("left_", "l"), ("right_", "r")]
        .iter()
        .map(|(side, letter)| (role.replace("?_", side), expression.replace('?', letter)))
        .collect()
}
