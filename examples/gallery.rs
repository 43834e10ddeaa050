//! Draws every picture and film of the README and docs/ anew, to docs/images/.
//!
//! ```sh
//! cargo run --release --example gallery
//! ```

use std::path::Path;
use std::process::{Command, exit};

/// File in docs/images/ and the words after `terrell`; SAMPLE is a file of the example `textured_sample`.
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
    ("sample_rest.png", &["render", "SAMPLE", SIZE, SMOOTH, "--fov=60"]),
    ("sample.png", &["render", "SAMPLE", "--beta=0.9", SIZE, SMOOTH, "--fov=60"]),
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

/// Runs a program of this package.
fn run(kind: &str, program: &str, words: &[&str]) {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--release", "--quiet", kind, program, "--"]).args(words);
    if !cargo.current_dir(env!("CARGO_MANIFEST_DIR")).status().is_ok_and(|status| status.success()) {
        eprintln!("{program} {} did not work", words.join(" "));
        exit(1);
    }
}

fn main() {
    let sample = std::env::temp_dir().join("terrell_sample.glb");
    let sample = sample.to_string_lossy();
    run("--example", "textured_sample", &[&sample]);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/images");
    for (file, words) in PICTURES {
        let output = folder.join(file);
        let output = output.to_string_lossy();
        let words = words.iter().map(|word| if *word == "SAMPLE" { &*sample } else { *word });
        run("--bin", "terrell", &words.chain(["-o", &*output]).collect::<Vec<_>>());
    }
    // Nothing is left but the pictures.
    let _ = std::fs::remove_file(&*sample);
}
