//! Time on the screen, shared by all tracks of a timeline.

/// Room for the names of tracks.
pub const NAMES: f32 = 112.0;

/// Mapping of time to the screen.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// Left and right of the tracks.
    pub left: f32,
    pub width: f32,
    pub from: f64,
    pub to: f64,
}

impl Scale {
    pub fn x(&self, secs: f64) -> f32 {
        let share = (secs - self.from) / (self.to - self.from);
        self.left + (share * f64::from(self.width)) as f32
    }

    pub fn secs(&self, x: f32) -> f64 {
        self.from + f64::from((x - self.left) / self.width.max(1.0)) * (self.to - self.from)
    }

    pub fn points_per_sec(&self) -> f64 {
        f64::from(self.width) / (self.to - self.from)
    }

    pub fn right(&self) -> f32 {
        self.left + self.width
    }
}
