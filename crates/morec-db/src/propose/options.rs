//! Options of proposals.

/// Options of proposals.
#[derive(Debug, Clone, PartialEq)]
pub struct ProposeOptions {
    /// Only these classes; all if empty. The others still say what a stretch is not.
    pub classes: Vec<String>,
    /// Samples of a class that look for others, at most.
    pub templates_a_class: usize,
    /// Rejected stretches that speak against others, at most.
    pub negatives: usize,
    /// Least probability; less likely stretches are proposed only where a class has too few other candidates.
    pub least: f32,
    /// Number of stretches of a class that are proposed however unlikely they are.
    pub always: usize,
}

impl Default for ProposeOptions {
    fn default() -> Self {
        Self {
            classes: Vec::new(),
            templates_a_class: 16,
            negatives: 120,
            least: 0.05,
            always: 5,
        }
    }
}
