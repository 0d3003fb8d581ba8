//! A simulated bad network (loss, reordering, delay), for tests and `morec send`.

use morec::rng::Rng;

/// Probabilities of a bad network's faults; the default is a perfect one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accidents {
    /// The share of packets that are lost, 0 to 1.
    pub loss: f64,
    /// The share of packets that are overtaken by the next, 0 to 1.
    pub reorder: f64,
    /// Packets are delayed by up to this, seconds, each by another time.
    pub jitter_secs: f64,
    /// Seed of these accidents.
    pub seed: u64,
}

impl Default for Accidents {
    fn default() -> Self {
        Self {
            loss: 0.0,
            reorder: 0.0,
            jitter_secs: 0.0,
            seed: 1,
        }
    }
}

/// A network in some condition.
pub struct Network {
    accidents: Accidents,
    rng: Rng,
    /// A packet that is being overtaken.
    held: Option<Vec<u8>>,
    /// Packets lost so far.
    pub lost: u64,
    /// Packets overtaken so far.
    pub overtaken: u64,
}

impl Network {
    /// A network; the same options give the same accidents.
    pub fn new(accidents: &Accidents) -> Self {
        let rng = Rng::new(accidents.seed);
        Self {
            accidents: *accidents,
            rng,
            held: None,
            lost: 0,
            overtaken: 0,
        }
    }

    /// Carries `packet`: calls `arrive` for what comes out now.
    ///
    /// # Errors
    /// Those of `arrive`.
    pub fn carry<E>(
        &mut self,
        packet: &[u8],
        arrive: &mut impl FnMut(&[u8]) -> Result<(), E>,
    ) -> Result<(), E> {
        if self.rng.chance(self.accidents.loss) {
            self.lost += 1;
            return Ok(());
        }
        if self.held.is_none() && self.rng.chance(self.accidents.reorder) {
            self.held = Some(packet.to_vec());
            return Ok(());
        }
        arrive(packet)?;
        if let Some(held) = self.held.take() {
            self.overtaken += 1;
            arrive(&held)?;
        }
        Ok(())
    }

    /// Delay of the next packet, seconds.
    pub fn delay_secs(&mut self) -> f64 {
        if self.accidents.jitter_secs > 0.0 {
            self.rng.range(0.0, self.accidents.jitter_secs)
        } else {
            0.0
        }
    }
}
