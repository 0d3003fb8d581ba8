//! Options of a simulated bad network.

use morec_live::Accidents;

/// Options of a simulated bad network.
#[derive(clap::Args, Debug, Clone, Copy, PartialEq)]
#[command(next_help_heading = "Network")]
pub struct NetworkArgs {
    /// Lose this share of the packets, 0 to 1
    #[arg(hide_short_help = true, long, value_name = "SHARE", default_value = "0", value_parser = share)]
    pub loss: f64,
    /// Let this share of the packets be overtaken by the next, 0 to 1
    #[arg(hide_short_help = true, long, value_name = "SHARE", default_value = "0", value_parser = share)]
    pub reorder: f64,
    /// Delay each packet by a random time up to this, milliseconds
    #[arg(hide_short_help = true, long, value_name = "MS", default_value = "0", value_parser = millis)]
    pub jitter: f64,
    /// Seed of these faults
    #[arg(hide_short_help = true, long, value_name = "N", default_value = "1")]
    pub seed: u64,
}

impl NetworkArgs {
    /// The accidents that the options ask for.
    pub fn accidents(&self) -> Accidents {
        Accidents {
            loss: self.loss,
            reorder: self.reorder,
            jitter_secs: self.jitter / 1000.0,
            seed: self.seed,
        }
    }
}

/// Reads a number from 0 to 1.
fn share(text: &str) -> Result<f64, String> {
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
