//! Compilers of this machine, if it has any, and the library as they link it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A language that the header is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    C,
    Cpp,
}

/// A compiler.
#[derive(Debug, Clone)]
pub struct Compiler {
    pub command: String,
    pub language: Language,
}

impl Compiler {
    /// Those that there are, each once.
    pub fn all() -> Vec<Compiler> {
        let c = ["cc", "gcc", "clang"].map(|command| (command, Language::C));
        let cpp = ["c++", "g++", "clang++"].map(|command| (command, Language::Cpp));
        let mut seen = Vec::new();
        let mut found = Vec::new();
        for (command, language) in c.into_iter().chain(cpp) {
            let Ok(output) = Command::new(command).arg("--version").output() else {
                continue;
            };
            // `cc` is one of the others, by another name.
            let text = String::from_utf8_lossy(&output.stdout).replacen(command, "", 1);
            if output.status.success() && !seen.contains(&(text.clone(), language)) {
                seen.push((text, language));
                found.push(Compiler {
                    command: command.to_owned(),
                    language,
                });
            }
        }
        found
    }

    /// Compiles `source` into `program`; the strictest warnings are errors.
    pub fn build(
        &self,
        source: &Path,
        program: &Path,
        link: Link,
        sanitize: bool,
    ) -> Result<(), String> {
        let mut command = Command::new(&self.command);
        let standard = if self.language == Language::C {
            "-std=c99"
        } else {
            "-std=c++11"
        };
        command.args([standard, "-Wall", "-Wextra", "-pedantic", "-Werror", "-g"]);
        if sanitize {
            command.args(["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]);
        }
        if self.language == Language::Cpp {
            command.args(["-x", "c++"]);
        }
        command.arg(source).args(["-x", "none"]);
        command
            .arg("-I")
            .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("include"));
        link.add_to(&mut command);
        succeed(command.arg("-o").arg(program)).map(|_| ())
    }

    /// True if programs with sanitizers can be built and run here.
    pub fn sanitizes(&self, folder: &Path) -> bool {
        let (source, program) = (
            folder.join("empty.c"),
            folder.join(format!("empty-{}", self.command)),
        );
        std::fs::write(&source, "int main(void) { return 0; }\n").unwrap();
        let built = self.build(&source, &program, Link::Nothing, true);
        built
            .and_then(|()| succeed(&mut Command::new(&program)))
            .is_ok()
    }
}

/// Way in which a program is linked with the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Link {
    Nothing,
    Static,
    Shared,
}

impl Link {
    fn add_to(self, command: &mut Command) {
        let folder = libraries();
        match self {
            Link::Nothing => {}
            Link::Static => {
                command.arg(folder.join("libmorec_capi.a"));
                // What `rustc --print native-static-libs` names.
                let system: &[&str] = if cfg!(target_os = "macos") {
                    &["-lSystem", "-lc", "-lm"]
                } else {
                    &[
                        "-lgcc_s",
                        "-lutil",
                        "-lrt",
                        "-lpthread",
                        "-lm",
                        "-ldl",
                        "-lc",
                    ]
                };
                command.args(system);
            }
            Link::Shared => {
                command.arg("-L").arg(&folder).arg("-lmorec_capi");
                command.arg(format!("-Wl,-rpath,{}", folder.display()));
            }
        }
    }
}

/// Path of the library that was built with these tests: beside them.
pub fn libraries() -> PathBuf {
    std::env::current_exe()
        .unwrap()
        .parent()
        .unwrap()
        .to_owned()
}

/// Runs a command; its output, or what went wrong.
pub fn succeed(command: &mut Command) -> Result<Output, String> {
    let output = command
        .output()
        .map_err(|error| format!("{command:?}: {error}"))?;
    if output.status.success() {
        return Ok(output);
    }
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(format!("{command:?}: {}\n{said}", output.status))
}
