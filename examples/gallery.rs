//! Draws every picture and film of the README and docs/ anew, to docs/images/.
//!
//! ```sh
//! cargo run --release --example gallery
//! ```

use std::path::Path;
use std::process::{Command, exit};

/// File in docs/images/ and the words after `terrell`.
const PICTURES: &[(&str, &[&str])] = &[
    ("cube_rest.png", &["render", "cube", "--beta", "0", SIZE, SMOOTH]),
    ("cube.png", &["render", "cube", SIZE, SMOOTH]),
    ("gate_rest.png", &["render", "gate", "--beta", "0", SIZE, SMOOTH]),
    ("gate.png", &["render", "gate", SIZE, SMOOTH]),
    ("lattice_rest.png", &["render", "lattice", "--beta", "0", SIZE, SMOOTH]),
    ("lattice.png", &["render", "lattice", SIZE, SMOOTH]),
    ("lattice_doppler.png", &["render", "lattice", "--color", "doppler", SIZE, SMOOTH]),
    ("gate_back.png", &["render", "gate_back", SIZE, SMOOTH]),
    ("sphere.png", &["render", "sphere", SIZE, SMOOTH]),
    ("street.png", &["render", "street", SIZE, SMOOTH]),
    ("train.png", &["render", "train", SIZE, SMOOTH]),
    (
        "lattice_drawn.png",
        &[
            "render",
            "lattice",
            "--size=960x540",
            "--edges",
            "--axes",
            "--scale-bar",
            "--caption",
            "β = {beta}, γ = {gamma}",
        ],
    ),
    ("gate_painted.png", &["render", "gate", "--size=960x540", "--raster=skia", "--edges=all"]),
    (
        "cube.gif",
        &["animate", "cube", "--beside-standard", "--size=320x180", "--frames=60", "--fps=20", "--samples=4"],
    ),
    (
        "gate.gif",
        &["animate", "gate", "--beside-standard", "--size=320x180", "--frames=60", "--fps=20", "--samples=4"],
    ),
];

const SIZE: &str = "--size=640x360";
const SMOOTH: &str = "--samples=16";

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/images");
    for (file, words) in PICTURES {
        let output = folder.join(file);
        let mut cargo = Command::new(env!("CARGO"));
        cargo
            .args(["run", "--release", "--quiet", "--bin", "terrell", "--"])
            .args(*words)
            .arg("-o")
            .arg(output);
        if !cargo.current_dir(env!("CARGO_MANIFEST_DIR")).status().is_ok_and(|status| status.success()) {
            eprintln!("{file} could not be drawn");
            exit(1);
        }
    }
}
