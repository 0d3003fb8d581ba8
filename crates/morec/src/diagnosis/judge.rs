//! Findings about a stream, derived from its measures. Thresholds of all findings are here.

use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

use crate::features::{Hand, MAX_GAP_SECS, Profile};
use crate::math::{Axis, Vec3};
use crate::roles::Role;

use super::figures::Diagnosis;
use super::finding::{Finding, Severity};
use super::role_set::RoleSet;

/// Findings of one diagnosis, at most one of a kind, the gravest first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Findings {
    items: [Option<Finding>; Self::MOST],
    count: usize,
}

impl Findings {
    const MOST: usize = 22;

    fn add(&mut self, finding: Option<Finding>) {
        if let (Some(finding), true) = (finding, self.count < Self::MOST) {
            self.items[self.count] = Some(finding);
            self.count += 1;
        }
    }

    /// One after the other, the gravest first.
    pub fn iter(&self) -> impl Iterator<Item = &Finding> {
        self.items.iter().flatten()
    }

    /// Number of findings.
    pub fn len(&self) -> usize {
        self.count
    }

    /// True if nothing was found.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The first finding of the gravest severity.
    pub fn worst(&self) -> Option<&Finding> {
        self.iter().next()
    }

    /// The bits of all kinds found.
    pub fn bits(&self) -> u32 {
        self.iter().fold(0, |bits, finding| bits | finding.bit())
    }
}

/// A finding with its words.
#[derive(Serialize)]
struct Worded<'a> {
    severity: Severity,
    text: String,
    #[serde(flatten)]
    finding: &'a Finding,
}

impl Serialize for Findings {
    /// A list of `{severity, text, kind, …}`.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(Some(self.count))?;
        for finding in self.iter() {
            list.serialize_element(&Worded {
                severity: finding.severity(),
                text: finding.to_string(),
                finding,
            })?;
        }
        list.end()
    }
}

/// Of sides that are exchanged, the [sum](SideEvidence::sum) is at most this.
const EXCHANGED: f64 = -0.08;

/// Steps between frames that cannot be seconds: more than a stream's longest gap, or less than any tracker's.
const NOT_SECS: (f64, f64) = (8e-4, MAX_GAP_SECS);
const LEAST_FRAMES: u64 = 12;

impl Diagnosis {
    /// Findings, the gravest first. Empty until there is a second of stream, or half a minute's worth of frames
    /// whose times cannot be believed.
    pub fn findings(&self) -> Findings {
        let mut found = Findings::default();
        if self.frames < LEAST_FRAMES {
            return found;
        }
        let time = self.time();
        let enough = self.secs >= 0.9 || time.is_some() || self.frames >= 120;
        if !enough {
            return found;
        }
        // Hands leave the picture all the time.
        let most_empty = if self.profile == Profile::Body {
            0.3
        } else {
            0.9
        };
        found.add(some(
            self.empty_share > most_empty,
            Finding::Nobody {
                share: self.empty_share,
            },
        ));
        found.add(time);
        if self.empty_share < 0.9 {
            match self.profile {
                Profile::Body => self.body(&mut found),
                _ => self.points(&mut found),
            }
            if time.is_none() {
                self.motion(&mut found);
            }
        }
        found.items[..found.count]
            .sort_by_key(|finding| std::cmp::Reverse(finding.map(|finding| finding.severity())));
        found
    }

    fn time(&self) -> Option<Finding> {
        if self.late_share > 0.2 {
            return Some(Finding::TimeStands {
                share: self.late_share,
            });
        }
        let interval_secs = 1.0 / self.rate_hz?;
        let (least, most) = NOT_SECS;
        some(
            !(least..most).contains(&interval_secs),
            Finding::TimeUnit { interval_secs },
        )
    }

    fn body(&self, found: &mut Findings) {
        let mut missing = self.missing;
        // Where hip joints are never seen, the shoulders take their place.
        let lacks = |left, right| missing.contains(left) || missing.contains(right);
        let blind =
            lacks(Role::LeftThigh, Role::RightThigh) && lacks(Role::LeftArm, Role::RightArm);
        found.add(some(blind, Finding::NoHeading));
        // Many skeletons have no shoulders and one spine joint: nothing is lost with them.
        for spare in [Role::LeftShoulder, Role::RightShoulder, Role::Torso] {
            missing = missing.iter().filter(|role| *role != spare).collect();
        }
        let exchanged = self.sides.sum().is_some_and(|sum| sum < EXCHANGED);
        let up = self.up_finding(exchanged);
        let turned = matches!(
            up,
            Some(Finding::UpsideDown { .. } | Finding::UpIsNotY { .. })
        );
        found.add(up);
        found.add(some(exchanged && !turned, Finding::SidesExchanged));
        self.joints(missing, found);
        let leg = self.leg_m.map(|leg| leg / self.metres_per_unit);
        found.add(leg.and_then(|leg| some(!self.unit_known, Finding::UnknownUnit { leg })));
    }

    /// Of hands, of tracked points and of custom skeletons.
    fn points(&self, found: &mut Findings) {
        // Between a finger's base and its tip no joint is needed.
        let ends = Hand::BOTH.map(|hand| hand.points().fingers.map(|f| [f[0], f[3]]));
        let is_needed =
            |role: &Role| !role.is_of_hand() || ends.as_flattened().as_flattened().contains(role);
        self.joints(self.missing.iter().filter(is_needed).collect(), found);
        let (losses, swaps) = (self.losses_per_minute, self.swaps_per_minute);
        found.add(some(losses > 2.0, Finding::HandLost { per_minute: losses }));
        found.add(some(swaps > 2.0, Finding::HandsSwap { per_minute: swaps }));
    }

    fn joints(&self, missing: RoleSet, found: &mut Findings) {
        found.add(some(
            !missing.is_empty(),
            Finding::JointsMissing { roles: missing },
        ));
        found.add(some(
            !self.flickering.is_empty(),
            Finding::JointsFlicker {
                roles: self.flickering,
            },
        ));
    }

    fn up_finding(&self, mirrored: bool) -> Option<Finding> {
        let (up, tilt_rad) = (Vec3::from(self.up?), self.tilt_rad?);
        let tilt = tilt_rad.to_degrees();
        if tilt > 135.0 {
            return Some(Finding::UpsideDown { mirrored });
        }
        if tilt > 60.0 {
            let axis = if up.x.abs() > up.z.abs() {
                Axis::X
            } else {
                Axis::Z
            };
            let negative = up[axis.index()] < 0.0;
            return Some(Finding::UpIsNotY {
                axis,
                negative,
                mirrored,
            });
        }
        some(self.stands && tilt > 12.0, Finding::Tilted { tilt_rad })
    }

    fn motion(&self, found: &mut Findings) {
        let frozen = self.still_secs >= 1.5;
        found.add(some(
            frozen,
            Finding::Frozen {
                secs: self.still_secs,
            },
        ));
        if let Some(noise_m) = self.metric_noise() {
            found.add(some(noise_m >= 0.006, Finding::Noisy { noise_m }));
        }
        found.add(some(
            self.spike_share > 0.003,
            Finding::Spikes {
                share: self.spike_share,
            },
        ));
        if let Some(rate_hz) = self.rate_hz {
            found.add(some(rate_hz < 9.5, Finding::SlowRate { rate_hz }));
        }
        found.add(some(
            self.lost_share > 0.05,
            Finding::FramesLost {
                share: self.lost_share,
            },
        ));
        found.add(some(
            self.repeated_share > 0.2 && !frozen,
            Finding::FramesRepeated {
                share: self.repeated_share,
            },
        ));
        if let Some(jitter_secs) = self.jitter_secs {
            found.add(some(
                jitter_secs > 0.04,
                Finding::UnevenArrival { jitter_secs },
            ));
        }
        let glides = self.standing_share.is_some_and(|share| share < 0.1);
        found.add(some(glides, Finding::MovingFloor));
        if let (Some(hips), Some(hands)) = (self.hips_m, self.hands_m) {
            found.add(some(hips < 0.001 && hands > 0.05, Finding::HipsFixed));
        }
    }
}

fn some(holds: bool, finding: Finding) -> Option<Finding> {
    holds.then_some(finding)
}
