//! Recognises a clip as if it had been sent over VMC, with simulated, repeatable faults of the network.

use morec::kinematics::WorldPose;
use morec::live::{
    Detection, Event, EventOptions, Frame, Model, Performer, Phase, SourceCounts, SourceEvent,
};
use morec_live::vmc::{Bundling, VmcOptions, VmcReceiver, VmcSender};

use morec_live::{Accidents, Network, PlayableClip};

/// Somebody stands still before the performance, until the receiver knows the skeleton.
const BEFORE_SECS: f64 = 1.0;

/// Sends `played` frame by frame, carries the packets and recognises what arrives. Times are the clip's.
pub fn recognise_over_vmc(
    model: &Model,
    played: &PlayableClip,
    bundle: Bundling,
    accidents: &Accidents,
) -> (Vec<Detection>, SourceCounts) {
    let mut sender = VmcSender::new(bundle, true);
    let mut network = Network::new(accidents);
    let mut over = Over {
        receiver: VmcReceiver::new(&VmcOptions::default()),
        performer: Performer::new(model, Default::default(), &EventOptions::default()),
        frame: Frame::default(),
        found: Vec::new(),
    };
    let (mut pose, mut now_secs) = (WorldPose::default(), 0.0f64);
    let rate_hz = played.clip.rate_hz;
    let before = (BEFORE_SECS * rate_hz) as usize;
    for step in 0..before + played.clip.frames - played.first {
        let time_secs = step as f64 / rate_hz;
        pose.set(&played.clip, played.first + step.saturating_sub(before));
        now_secs = now_secs.max(time_secs + network.delay_secs());
        for packet in sender.frame(time_secs, &pose, &played.roles) {
            // Taking a packet cannot fail.
            let _ = network.carry::<()>(packet, &mut |bytes| {
                over.receiver.packet((), now_secs, bytes);
                Ok(())
            });
        }
        over.take();
        over.receiver.tick(now_secs + (0.9 / rate_hz).min(0.006));
        over.take();
    }
    let Over {
        receiver,
        mut performer,
        mut found,
        ..
    } = over;
    found.extend(performer.finish().iter().filter_map(detection));
    // From the receiver's clock to the clip's.
    let shift_secs = (played.first as f64 - before as f64) / rate_hz;
    for d in &mut found {
        d.span = d.span.map(|secs| secs + shift_secs);
        d.span.start_secs = d.span.start_secs.max(0.0);
        d.reported_secs += shift_secs;
    }
    (found, receiver.counts())
}

struct Over {
    receiver: VmcReceiver<()>,
    performer: Performer,
    frame: Frame,
    found: Vec<Detection>,
}

impl Over {
    fn take(&mut self) {
        while let Some(next) = self.receiver.next(&mut self.frame) {
            let events = match next {
                SourceEvent::Rig(_, rig) => self.performer.set_rig(&rig),
                SourceEvent::Frame => self.performer.push(&self.frame),
                SourceEvent::Gone(_) => self.performer.finish(),
                SourceEvent::Quiet | SourceEvent::Ended => continue,
            };
            self.found.extend(events.iter().filter_map(detection));
        }
    }
}

fn detection(event: &Event) -> Option<Detection> {
    (event.phase == Phase::End).then(|| event.detection())
}
