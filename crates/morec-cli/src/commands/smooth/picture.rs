//! `--plot`: a picture of one channel of a clip.

use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use morec::clip::{Clip, Skeleton};
use morec::labels::some_of;
use morec::smooth::{ChannelKind, CompressedClip};
use morec_measure::report::pictures::channel_chart;

use crate::output::{check_picture, write_whole};

/// Names of channels, behind that of a joint.
const CHANNELS: [(&str, ChannelKind, Option<usize>); 8] = [
    ("x", ChannelKind::Rotation, Some(0)),
    ("y", ChannelKind::Rotation, Some(1)),
    ("z", ChannelKind::Rotation, Some(2)),
    ("w", ChannelKind::Rotation, Some(3)),
    ("position", ChannelKind::Position, None),
    ("px", ChannelKind::Position, Some(0)),
    ("py", ChannelKind::Position, Some(1)),
    ("pz", ChannelKind::Position, Some(2)),
];

/// Draws what `channel` names.
pub fn write(clip: &Clip, compressed: &CompressedClip, channel: &str, path: &Path) -> Result<()> {
    let (joint, kind, axis) = find(&clip.skeleton, channel)?;
    let name = &clip.skeleton.joints()[joint].name;
    let chart = channel_chart(compressed, clip, joint, kind, axis)
        .ok_or_else(|| anyhow!("--plot {channel}: {name} does not move in its parent's frame"))?;
    check_picture(path)?;
    write_whole(path, |out| out.write_all(chart.svg().as_bytes()))
        .with_context(|| path.display().to_string())
}

/// A joint's name alone comes first: it may have points in it.
fn find(skeleton: &Skeleton, channel: &str) -> Result<(usize, ChannelKind, Option<usize>)> {
    if let Some(joint) = skeleton.find(channel) {
        return Ok((joint, ChannelKind::Rotation, None));
    }
    if let Some((name, ending)) = channel.rsplit_once('.')
        && let Some(joint) = skeleton.find(name)
    {
        let found = CHANNELS.iter().find(|(known, ..)| *known == ending);
        let names: Vec<&str> = CHANNELS.iter().map(|channel| channel.0).collect();
        let (_, kind, axis) = found.ok_or_else(|| {
            anyhow!(
                "--plot {channel}: expected one of {}, found {ending}",
                names.join(", ")
            )
        })?;
        return Ok((joint, *kind, *axis));
    }
    let names: Vec<String> = skeleton
        .joints()
        .iter()
        .map(|joint| joint.name.clone())
        .collect();
    bail!(
        "--plot {channel}: no such joint; the joints are {}",
        some_of(names.iter())
    )
}
