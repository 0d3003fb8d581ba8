//! The package for Unity: its bindings are those of the header, and without the engine it finds what C finds.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::compiled::stream;
use crate::compilers::{libraries, succeed};
use crate::eight;
use mocap::testing::skipped;

fn package() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("unity")
}

/// `PascalCase` of what is left of a constant's name.
fn pascal(name: &str) -> String {
    let word = |word: &str| word[..1].to_owned() + &word[1..].to_lowercase();
    name.split('_').map(word).collect()
}

/// The type of a field or a parameter in C#; `None` for what the package does not use.
fn type_of(c: &str, is_field: bool) -> Option<String> {
    let (name, pointers) = (c.replace(['*', ' '], ""), c.matches('*').count());
    let name = name
        .trim_start_matches("const")
        .trim_start_matches("struct");
    let known = match (name, pointers) {
        ("size_t", 0) => "UIntPtr",
        ("uint64_t", 0) => "ulong",
        ("uint32_t", 0) => "uint",
        ("int32_t", 0) => "int",
        ("double", 0) => "double",
        (_, 0) => return None,
        (_, _) if is_field => "IntPtr",
        ("char" | "uint8_t", 1) => "byte[]",
        ("size_t", 1) => "out UIntPtr",
        ("int32_t", 1) => "out int",
        ("MorecIndex" | "MorecRecognizer", 1) => "IntPtr",
        (_, 2) => "out IntPtr",
        ("MorecEvent", 1) => "[In, Out] MorecEvent[]",
        (name, 1) => return Some(format!("ref {name}")),
        _ => return None,
    };
    Some(known.to_owned())
}

/// `type name` as C writes it: the type, with the star, and the name.
fn declared(c: &str) -> (&str, &str) {
    c.split_at(c.rfind([' ', '*']).map_or(0, |at| at + 1))
}

/// A function of the header in C#.
fn function(prototype: &str) -> Option<String> {
    let (head, rest) = prototype.split_once('(')?;
    let (result, name) = declared(head);
    let result = match result.trim() {
        "const char *" => "IntPtr",
        "int32_t" => "int",
        result => result,
    };
    let parameters = rest.trim_end_matches(");").split(',').map(str::trim);
    let parameters: Vec<String> = parameters
        .filter(|p| *p != "void")
        .map(|p| {
            let (c, name) = declared(p);
            Some(format!("{} {name}", type_of(c.trim(), false)?))
        })
        .collect::<Option<_>>()?;
    Some(format!(
        "        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]\n        public static extern {result} {name}({});\n",
        parameters.join(", ")
    ))
}

/// Constants, enums, structs and functions of the header, by the same names.
fn bindings(header: &str) -> String {
    let mut types = String::new();
    let mut native = String::new();
    let mut lines = header.lines();
    while let Some(line) = lines.next() {
        if let Some(constant) = line.strip_prefix("#define MOREC_")
            && let Some((name, value)) = constant.split_once(' ')
        {
            writeln!(native, "        public const int MOREC_{name} = {value};").unwrap();
        } else if let Some(name) = line.strip_prefix("enum ") {
            // `MorecStatus` has `MOREC_STATUS_OK`.
            let prefix = name.chars().flat_map(|c| {
                let start = c.is_uppercase().then_some('_');
                start.into_iter().chain([c.to_ascii_uppercase()])
            });
            let prefix = prefix.skip(1).chain(['_']).collect::<String>();
            writeln!(types, "    public enum {name}\n    {{").unwrap();
            for member in lines.by_ref().take_while(|l| *l != "};") {
                if let Some(member) = member.trim().strip_prefix(&prefix)
                    && let Some((name, value)) = member.split_once(' ')
                {
                    writeln!(types, "        {} {value}", pascal(name)).unwrap();
                }
            }
            types += "    }\n\n";
        } else if let Some(name) = line.strip_prefix("typedef struct Morec")
            && let Some(name) = name.strip_suffix(" {")
        {
            writeln!(
                types,
                "    [StructLayout(LayoutKind.Sequential)]\n    public struct Morec{name}\n    {{"
            )
            .unwrap();
            let fields = lines.by_ref().take_while(|l| !l.starts_with('}'));
            for field in fields.filter_map(|f| f.trim().strip_suffix(';')) {
                let (c, name) = declared(field);
                let kind = type_of(c.trim(), true).unwrap();
                writeln!(types, "        public {kind} {name};").unwrap();
            }
            types += "    }\n\n";
        } else if !line.starts_with([' ', '/']) && line.contains("morec_") {
            let mut prototype = line.to_owned();
            while !prototype.ends_with(");") {
                prototype += lines.next().unwrap();
            }
            native += &function(&prototype).unwrap_or_else(|| panic!("{prototype}"));
        }
    }
    format!(
        "// Made from include/morec.h, where everything is described: `MOREC_WRITE_HEADER=1 cargo test -p morec-capi` makes it again.\n\
        using System;\nusing System.Runtime.InteropServices;\n\nnamespace Morec\n{{\n{types}\
        \x20   public static class Native\n    {{\n\
        #if UNITY_IOS && !UNITY_EDITOR\n        const string Library = \"__Internal\";\n\
        #else\n        const string Library = \"morec_capi\";\n#endif\n\n\
        {native}\n\
        \x20       public static UIntPtr SizeOf<T>() {{ return (UIntPtr)Marshal.SizeOf(typeof(T)); }}\n    }}\n}}\n"
    )
}

#[test]
fn the_bindings_are_those_of_the_header() {
    let header = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/morec.h");
    let read = |path: &Path| {
        let text = fs::read_to_string(path).unwrap_or_default();
        text.replace("\r\n", "\n")
    };
    let made = bindings(&read(&header));
    let path = package().join("Runtime/Native.cs");
    if std::env::var_os("MOREC_WRITE_HEADER").is_some() {
        fs::write(&path, &made).unwrap();
    }
    assert!(
        read(&path) == made,
        "unity/Runtime/Native.cs is not what the header gives; MOREC_WRITE_HEADER=1 writes it anew"
    );
}

/// Unity leaves out files of a package that have no `.meta` beside them.
#[test]
fn every_file_of_the_package_has_its_meta_file() {
    for folder in [".", "Runtime", "Editor", "Tests"] {
        for entry in fs::read_dir(package().join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if !name.ends_with(".meta") && !name.ends_with('~') {
                let meta = path.with_file_name(format!("{name}.meta"));
                let text = fs::read_to_string(&meta).unwrap_or_default();
                assert!(text.contains("guid: "), "{} is missing", meta.display());
            }
        }
    }
}

#[test]
fn without_the_engine_it_finds_what_c_finds() {
    let runs = |name: &str| Command::new(name).arg("--version").output().is_ok();
    if cfg!(windows) || !runs("mcs") || !runs("mono") {
        skipped("no Mono (mcs, mono)");
        return;
    }
    let files = eight::files();
    let (program, poses) = (files.path("stream.exe"), files.path("poses.txt"));
    let expected = stream(&poses);
    let sources = ["MotionIndex", "MotionStream", "Native"]
        .map(|name| package().join(format!("Runtime/{name}.cs")));
    let mut compile = Command::new("mcs");
    compile.args(["-warnaserror", &format!("-out:{}", program.display())]);
    compile
        .args(&sources)
        .arg(package().join("Tests/StreamProgram.cs"));
    succeed(&mut compile).unwrap();
    let run = |arguments: &[&Path]| {
        let mut command = Command::new("mono");
        command.arg(&program).args(arguments);
        command.env("LD_LIBRARY_PATH", libraries());
        command.stdin(File::open(&poses).unwrap());
        command
    };
    let found = |arguments: &[&Path]| {
        String::from_utf8(succeed(&mut run(arguments)).unwrap().stdout).unwrap()
    };
    let index = Path::new(files.index.to_str().unwrap());
    assert_eq!(found(&[index]), expected);
    assert_eq!(found(&[index, Path::new("mirrored")]), expected);
    assert_eq!(found(&[index, Path::new("named")]), expected);
    let refused = run(&[&poses]).output().unwrap();
    let said = String::from_utf8_lossy(&refused.stderr);
    assert!(
        refused.status.code() == Some(1) && said.starts_with("BadIndex: "),
        "{said}"
    );

    // What needs the engine compiles against stand-ins for its types.
    let mut engine = Command::new("mcs");
    engine.args(["-target:library", "-define:UNITY_5_3_OR_NEWER"]);
    engine.arg(format!("-out:{}", files.path("engine.dll").display()));
    engine.args(&sources);
    let more = [
        "Runtime/MorecIndexAsset.cs",
        "Runtime/MorecRecognizer.cs",
        "Editor/IndexImporter.cs",
        "Samples~/Motions/WriteMotions.cs",
    ];
    engine.args(more.map(|file| package().join(file)));
    engine.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/unity_types.cs"));
    succeed(&mut engine).unwrap();
}
