//! What networks do to packets, done on purpose: for trying things without a bad network at hand.

use morec::synth::Rng;

/// How bad it is to be.
#[derive(clap::Args, Debug, Clone, Copy, PartialEq)]
#[command(next_help_heading = "Network")]
pub struct Conditions {
    /// Lose this share of the packets, 0 to 1
    #[arg(long, value_name = "SHARE", default_value = "0", value_parser = share)]
    pub loss: f64,
    /// Let this share of the packets be overtaken by the next, 0 to 1
    #[arg(long, value_name = "SHARE", default_value = "0", value_parser = share)]
    pub reorder: f64,
    /// Delay packets by up to this, milliseconds, each by another time
    #[arg(long, value_name = "MS", default_value = "0", value_parser = millis)]
    pub jitter: f64,
    /// Seed of these accidents
    #[arg(long, value_name = "N", default_value = "1")]
    pub seed: u64,
}

/// A share of 1.
pub fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("expected a share from 0 to 1".to_owned()),
    }
}

fn millis(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(millis) if (0.0..=10_000.0).contains(&millis) => Ok(millis),
        _ => Err("expected milliseconds from 0 to 10000".to_owned()),
    }
}

/// A network in some condition.
pub struct Network {
    conditions: Conditions,
    rng: Rng,
    /// A packet that is being overtaken.
    held: Option<Vec<u8>>,
    /// Packets lost so far.
    pub lost: u64,
    /// Packets overtaken so far.
    pub overtaken: u64,
}

impl Network {
    /// A network; the same conditions give the same accidents.
    pub fn new(conditions: &Conditions) -> Self {
        let rng = Rng::new(conditions.seed);
        Self {
            conditions: *conditions,
            rng,
            held: None,
            lost: 0,
            overtaken: 0,
        }
    }

    /// Carries `packet`: calls `arrive` for what comes out now.
    pub fn carry<E>(
        &mut self,
        packet: &[u8],
        arrive: &mut impl FnMut(&[u8]) -> Result<(), E>,
    ) -> Result<(), E> {
        if self.rng.chance(self.conditions.loss) {
            self.lost += 1;
            return Ok(());
        }
        if self.held.is_none() && self.rng.chance(self.conditions.reorder) {
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

    /// How long the next packet takes, seconds.
    pub fn delay_secs(&mut self) -> f64 {
        if self.conditions.jitter > 0.0 {
            self.rng.range(0.0, self.conditions.jitter / 1000.0)
        } else {
            0.0
        }
    }
}
