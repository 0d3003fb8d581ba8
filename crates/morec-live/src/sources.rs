//! Opens sources by their addresses.

use std::path::PathBuf;

use crate::axis::AxisOptions;
use crate::vmc::VmcOptions;
use morec::files::FileReader;
use morec::import::ImportOptions;
use morec::index::MotionIndex;
use morec::live::{OverflowPolicy, Source};
use morec::roles::mapping::Mapping;

use crate::axis::{AxisSource, axis_skeleton};
use crate::clip::ClipSource;
use crate::json::JsonSource;
use crate::vmc::VmcSource;
use crate::webcam::{WebcamPage, webcam};
use crate::{Address, LiveError, Notices};

/// Options of opening a source.
#[derive(Debug, Clone)]
pub struct SourceOptions<'a> {
    /// Exchange left and right, for VMC senders that show their performer as a mirror would.
    pub mirrored: bool,
    /// Performers that one VMC port, or one broadcast, follows at once.
    pub actors: usize,
    /// Leave out frames of VMC senders that show a T-pose too exact to be a person's.
    pub skip_t_pose: bool,
    /// A BVH file of the program at `axis://`, for how bones hang together and how long they are.
    pub axis_skeleton: Option<PathBuf>,
    /// The folder of MediaPipe's files, for the page at `webcam`.
    pub mediapipe: Option<PathBuf>,
    /// Roles of joints of clips, where inference fails.
    pub roles: Option<Mapping>,
    /// The index that will recognise: it knows the roles of joints of its own clips.
    pub index: Option<&'a MotionIndex>,
}

impl Default for SourceOptions<'_> {
    fn default() -> Self {
        let VmcOptions {
            mirrored,
            actors,
            skip_t_pose,
        } = VmcOptions::default();
        Self {
            mirrored,
            actors,
            skip_t_pose,
            axis_skeleton: None,
            mediapipe: None,
            roles: None,
            index: None,
        }
    }
}

/// A source that has been opened.
pub struct OpenSource {
    /// Listening, or playing.
    pub source: Box<dyn Source>,
    /// Behaviour when its frames are not taken in time: whether it can wait.
    pub overload: OverflowPolicy,
    /// Name of the source, with the port that was free if it asked for any.
    pub name: String,
    /// Notices about received data.
    pub notices: Notices,
    /// The page of `webcam`, which shows what it is told.
    pub page: Option<WebcamPage>,
}

/// Opens the source at `address`: `vmc://HOST:PORT`, `axis://HOST:PORT`, `axis+udp://HOST:PORT`, `json:-`,
/// `json+tcp://HOST:PORT`, `webcam`, `webcam://HOST:PORT` or `clip://FILE`.
///
/// # Errors
/// Another address, an option that the source does not have, a socket that cannot be opened, a file that cannot be read.
pub fn open_source(
    address: &Address,
    options: &SourceOptions<'_>,
) -> Result<OpenSource, LiveError> {
    match address.kind.as_str() {
        "vmc" => {
            let source = vmc(address, options)?;
            let (name, notices) = (format!("vmc://{}", source.address()?), source.notices());
            Ok(opened(source, OverflowPolicy::Drop, name, notices))
        }
        "axis" | "axis+udp" => {
            let skeleton = options.axis_skeleton.as_deref().map(axis_skeleton);
            let axis = AxisOptions {
                skeleton: skeleton.transpose()?.unwrap_or_default(),
                actors: options.actors,
            };
            let (source, name) = AxisSource::open(address, &axis)?;
            let notices = source.notices();
            Ok(opened(source, OverflowPolicy::Drop, name, notices))
        }
        "json" => {
            let source = JsonSource::open(address)?;
            let notices = source.notices();
            Ok(opened(
                source,
                OverflowPolicy::Wait,
                address.to_string(),
                notices,
            ))
        }
        "json+tcp" => {
            let (source, at) = JsonSource::listen(address)?;
            let notices = source.notices();
            Ok(opened(
                source,
                OverflowPolicy::Wait,
                format!("json+tcp://{at}"),
                notices,
            ))
        }
        "webcam" => {
            let (source, at, page) = webcam(address, options.mediapipe.as_deref())?;
            let notices = source.notices();
            let name = format!("webcam://{at}");
            Ok(OpenSource {
                page: Some(page),
                ..opened(source, OverflowPolicy::Drop, name, notices)
            })
        }
        "clip" => {
            let reader = FileReader {
                import: ImportOptions {
                    mapping: options.roles.clone(),
                    ..ImportOptions::default()
                },
                planar: options.index.is_some_and(MotionIndex::has_custom_roles),
                ..FileReader::default()
            };
            let source = ClipSource::open(address, options.index, &reader)?;
            let overload = match source.is_paced() {
                true => OverflowPolicy::Drop,
                false => OverflowPolicy::Wait,
            };
            Ok(opened(
                source,
                overload,
                address.to_string(),
                Notices::default(),
            ))
        }
        other => Err(LiveError::Address(format!(
            "{address}: no source is called {other}; the sources are vmc://HOST:PORT, axis://HOST:PORT, axis+udp://HOST:PORT, \
             json:-, json+tcp://HOST:PORT, webcam, clip://FILE"
        ))),
    }
}

fn opened(
    source: impl Source + 'static,
    overload: OverflowPolicy,
    name: String,
    notices: Notices,
) -> OpenSource {
    OpenSource {
        source: Box::new(source),
        overload,
        name,
        notices,
        page: None,
    }
}

fn vmc(address: &Address, options: &SourceOptions<'_>) -> Result<VmcSource, LiveError> {
    address.allow(&[])?;
    let vmc = VmcOptions {
        mirrored: options.mirrored,
        actors: options.actors,
        skip_t_pose: options.skip_t_pose,
    };
    VmcSource::bind(address.socket()?, &vmc)
}
