//! `--on CLASS=COMMAND`: runs programs when a motion of a class ends.

use std::process::{Child, Command, Stdio};
use std::str::FromStr;

use anyhow::{Result, bail};
use morec::index::MotionIndex;
use morec::labels::hint;
use morec::live::Phase;
use morec_live::NamedEvent;

/// Commands under way at once, of all classes; what would be one more does not run.
const MOST_AT_ONCE: usize = 16;

/// `CLASS=COMMAND`: a program and its arguments, split as a shell splits them and given to no shell.
#[derive(Debug, Clone, PartialEq)]
pub struct OnClass {
    class: String,
    program: String,
    arguments: Vec<String>,
}

impl FromStr for OnClass {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (class, command) = text.split_once('=').ok_or("expected CLASS=COMMAND")?;
        let words = shlex::split(command).ok_or("a quote is not closed")?;
        let mut words = words.into_iter();
        Ok(Self {
            class: class.to_owned(),
            program: words.next().ok_or("expected a command after the =")?,
            arguments: words.collect(),
        })
    }
}

/// Runs the commands of classes.
pub struct ClassCommands {
    commands: Vec<OnClass>,
    running: Vec<(String, Child)>,
}

impl ClassCommands {
    /// For classes of an index.
    ///
    /// # Errors
    /// A class that the index does not have.
    pub fn new(commands: &[OnClass], index: &MotionIndex) -> Result<Self> {
        let classes = index.model.classes();
        let known: Vec<String> = classes.iter().map(|c| c.name.clone()).collect();
        if let Some(on) = commands.iter().find(|on| !known.contains(&on.class)) {
            let hint = hint(&on.class, &known);
            bail!("--on: the index has no class {}{hint}", on.class);
        }
        Ok(Self {
            commands: commands.to_vec(),
            running: Vec::new(),
        })
    }

    /// Starts the commands of a motion that has happened, or of a repetition that is an event of its own, and does not wait
    /// for them; gives what went wrong with these or with earlier ones.
    pub fn run(&mut self, said: &NamedEvent<'_>) -> Vec<String> {
        let mut wrong = self.ended();
        if !matches!(said.event.phase, Phase::End | Phase::Repetition) {
            return wrong;
        }
        for on in self.commands.iter().filter(|on| on.class == said.class) {
            if self.running.len() >= MOST_AT_ONCE {
                let program = &on.program;
                wrong.push(format!(
                    "--on {}: {program} was not started, because {MOST_AT_ONCE} commands are still running",
                    on.class
                ));
                continue;
            }
            let event = said.event;
            let child = Command::new(&on.program)
                .args(&on.arguments)
                .env("MOREC_CLASS", said.class)
                .env("MOREC_PHASE", event.phase.name())
                .env("MOREC_SCORE", format!("{:.3}", event.score))
                .env("MOREC_START", format!("{:.3}", event.span.start_secs))
                .env("MOREC_STOP", format!("{:.3}", event.span.stop_secs))
                .stdin(Stdio::null())
                .spawn();
            match child {
                Ok(child) => self.running.push((on.class.clone(), child)),
                Err(error) => wrong.push(format!("--on {}: {}: {error}", on.class, on.program)),
            }
        }
        wrong
    }

    /// Forgets commands that have ended; gives those that failed.
    fn ended(&mut self) -> Vec<String> {
        let mut wrong = Vec::new();
        self.running
            .retain_mut(|(class, child)| match child.try_wait() {
                Ok(None) => true,
                Ok(Some(status)) if status.success() => false,
                Ok(Some(status)) => {
                    wrong.push(format!("--on {class}: the command ended with {status}"));
                    false
                }
                Err(error) => {
                    wrong.push(format!("--on {class}: {error}"));
                    false
                }
            });
        wrong
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_split_as_typed_and_mistakes_are_named() {
        let on: OnClass = "wave=xdotool key 'ctrl+alt a' \"b c\"".parse().unwrap();
        assert_eq!(
            (on.class.as_str(), on.program.as_str()),
            ("wave", "xdotool")
        );
        assert_eq!(on.arguments, ["key", "ctrl+alt a", "b c"]);
        let equal: OnClass = "wave=a x=y".parse().unwrap();
        assert_eq!(equal.arguments, ["x=y"]);
        for (text, why) in [
            ("wave", "CLASS=COMMAND"),
            ("wave=", "a command"),
            ("wave=a 'b", "quote"),
        ] {
            assert!(text.parse::<OnClass>().unwrap_err().contains(why), "{text}");
        }
    }
}
