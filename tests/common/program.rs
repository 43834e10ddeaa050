//! The program, run as its users run it.

use assert_cmd::Command;
use std::path::{Path, PathBuf};

/// Runs it in a folder.
pub fn terrell(words: &[&str], folder: &Path) -> std::process::Output {
    let mut command = Command::cargo_bin("terrell").unwrap();
    command.args(words).current_dir(folder).output().unwrap()
}

/// What it says where all goes well.
pub fn good(words: &[&str], folder: &Path) -> String {
    let out = terrell(words, folder);
    assert!(out.status.success(), "{words:?}: {}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).unwrap()
}

/// What it says of the user's mistake.
pub fn bad(words: &[&str], folder: &Path) -> String {
    let out = terrell(words, folder);
    let message = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(2), "{words:?}: {message}");
    assert!(message.starts_with("error: "), "{message}");
    message
}

/// Of a picture it has written.
pub fn pixels(path: PathBuf) -> image::RgbImage {
    image::open(path).unwrap().into_rgb8()
}
