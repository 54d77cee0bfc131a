//! Imports in rust/core point down only: the order of layers, and the test of it.

use std::fs;
use std::path::{Path, PathBuf};

/// From the ground up. A module may use those on the lines before its own, and nothing else.
const LAYERS: &[&[&str]] = &[
    &["math"],
    &["error"],
    &["arena"],
    &["shapes"],
    &["body"],
    &["joint"],
    &["collision"],
    &["forces"],
    &["constraints"],
    &["solvers"],
    &["islands", "methods"],
    &["soft", "fluid"],
    &["world"],
    &["builders", "observe"],
    &["scenes"],
    &["report"],
];

/// What lib.rs re-exports from `error`, short because every module needs it.
const FROM_ERROR: [&str; 2] = ["Error", "Result"];

#[test]
fn imports_point_down() {
    let core = Path::new(env!("CARGO_MANIFEST_DIR")).join("rust/core");
    let mut faults = Vec::new();
    for path in rust_files(&core) {
        let name = path.strip_prefix(&core).expect("found below core").with_extension("");
        let module = name.iter().next().expect("a file has a name").to_string_lossy();
        if module != "lib" {
            let source = fs::read_to_string(&path).expect("a source file can be read");
            let found = faults_of(&module, &source);
            faults.extend(found.iter().map(|fault| format!("{}: {fault}", path.display())));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn a_fault_is_found() {
    for (module, source) in [
        ("shapes", "use crate::world::World;"),
        ("shapes", "use crate::{error::Result, body::Body};"),
        ("soft", "use crate::{\n    math::{Real, vec2},\n    fluid::Particles,\n};"),
        ("math", "fn f() -> crate::Error { todo!() }"),
        ("body", "use crate::World;"),
        ("gadgets", "use crate::math::Real;"),
    ] {
        assert_eq!(faults_of(module, source).len(), 1, "{module}: {source}");
    }
}

#[test]
fn what_is_allowed_passes() {
    for (module, source) in [
        ("shapes", "use crate::math::Real;\nuse crate::shapes::Circle;"),
        ("world", "use crate::{Error, Result, body::{Body, BodyDef}, islands};"),
        ("math", "//! See [`crate::world::World`].\nlet x = 1; // not crate::body"),
    ] {
        assert_eq!(faults_of(module, source), [""; 0], "{module}: {source}");
    }
}

/// Every .rs file below `folder`.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a source folder can be read") {
        let path = entry.expect("a folder can be listed").path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

/// What is wrong with the imports of one file of `module`.
fn faults_of(module: &str, source: &str) -> Vec<String> {
    let Some(layer) = layer_of(module) else {
        return vec![format!("{module} has no place in LAYERS; give it one in {}", file!())];
    };
    let judge = |used: &String| match layer_of(used) {
        None => Some(format!("write crate::<module>::…, not crate::{used}")),
        Some(other) if other < layer || used == module => None,
        Some(_) => Some(format!("{module} may not use crate::{used}, which is not below it")),
    };
    used_modules(source).iter().filter_map(judge).collect()
}

fn layer_of(module: &str) -> Option<usize> {
    let module = if FROM_ERROR.contains(&module) { "error" } else { module };
    LAYERS.iter().position(|layer| layer.contains(&module))
}

/// The first name of every path that starts with `crate::`, comments aside.
fn used_modules(source: &str) -> Vec<String> {
    let code: String =
        source.lines().flat_map(|line| [line.split("//").next().unwrap_or(""), "\n"]).collect();
    code.split("crate::").skip(1).flat_map(first_names).collect()
}

/// `a::b …` gives a; `{a::b, c::{d, e}} …` gives a and c.
fn first_names(path: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let Some(group) = path.strip_prefix('{') else {
        return vec![name(path)];
    };
    let mut depth = 1;
    let mut items = vec![String::new()];
    for c in group.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 1 => items.push(String::new()),
            _ if depth == 1 => items.last_mut().expect("never empty").push(c),
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    items.iter().map(|item| name(item)).filter(|item| !item.is_empty()).collect()
}
