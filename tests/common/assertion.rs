//! The program, run in a folder, with what must hold of it.

use assert_cmd::Command;
use std::path::Path;

/// Runs it.
pub fn terrell(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("terrell").unwrap().current_dir(folder).args(arguments).assert()
}

/// An empty one.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// Exit code 2, all the parts in the message, no file left behind that was not there.
pub fn refused(folder: &Path, arguments: &[&str], parts: &[&str]) {
    let files = || {
        let mut names: Vec<_> = std::fs::read_dir(folder).unwrap().map(|f| f.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = files();
    let output = terrell(folder, arguments).code(2).get_output().clone();
    let message = String::from_utf8(output.stderr).unwrap();
    for part in parts {
        assert!(message.contains(part), "{arguments:?} says\n{message}which lacks '{part}'");
    }
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(!message.contains("panicked"), "{message}");
    assert_eq!(files(), before, "{arguments:?} left something behind");
}
