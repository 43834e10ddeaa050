//! Draws every picture and film of the README and docs/ anew, to docs/images/.
//!
//! ```sh
//! cargo run --release --example gallery
//! ```

use std::path::Path;
use std::process::{Command, exit};

/// File in docs/images/ and the words after `terrell`; SAMPLE is a file of the example `textured_sample`, STARS the scene
/// `blackhole` before another sky.
const PICTURES: &[(&str, &[&str])] = &[
    // Shapes: without shift and beaming.
    ("cube_rest.png", &["render", "cube", "--beta=0", SHAPE, SIZE, SMOOTH]),
    ("cube_shape.png", &["render", "cube", SHAPE, SIZE, SMOOTH]),
    ("gate_rest.png", &["render", "gate", "--beta=0", SHAPE, SIZE, SMOOTH]),
    ("gate.png", &["render", "gate", SHAPE, SIZE, SMOOTH]),
    ("gate_back.png", &["render", "gate_back", SHAPE, SIZE, SMOOTH]),
    ("lattice_rest.png", &["render", "lattice", "--beta=0", SHAPE, SIZE, SMOOTH]),
    ("lattice.png", &["render", "lattice", SHAPE, SIZE, SMOOTH]),
    ("sphere.png", &["render", "sphere", SHAPE, SIZE, SMOOTH]),
    ("street.png", &["render", "street", SHAPE, SIZE, SMOOTH]),
    ("train.png", &["render", "train", SHAPE, SIZE, SMOOTH]),
    (
        "lattice_drawn.png",
        &[
            "render",
            "lattice",
            SHAPE,
            "--size=960x540",
            "--edges",
            "--axes",
            "--scale-bar",
            "--caption",
            "β = {beta}, γ = {gamma}",
        ],
    ),
    ("gate_painted.png", &["render", "gate", SHAPE, "--size=960x540", "--raster=skia", "--edges=all"]),
    ("sample_rest.png", &["render", "SAMPLE", SHAPE, SIZE, SMOOTH, "--fov=60"]),
    ("sample.png", &["render", "SAMPLE", "--beta=0.9", SHAPE, SIZE, SMOOTH, "--fov=60"]),
    (
        "cube.gif",
        &["animate", "cube", "--beside-standard", SHAPE, SMALL, "--frames=60", "--fps=20", "--samples=4"],
    ),
    (
        "gate.gif",
        &["animate", "gate", "--beside-standard", SHAPE, SMALL, "--frames=60", "--fps=20", "--samples=4"],
    ),
    // Curved spacetime.
    ("blackhole.png", &["render", "blackhole", SIZE, "--samples=4"]),
    ("blackhole_stars.png", &["render", "STARS", SIZE, "--samples=4"]),
    // Rays.
    ("shadow_rest.png", &["render", "shadow", "--beta=0.001", SIZE, SMOOTH]),
    ("shadow.png", &["render", "shadow", SIZE, SMOOTH]),
    ("box_rest.png", &["render", "box", "--beta=0", SIZE, "--samples=100"]),
    ("box.png", &["render", "box", SIZE, "--samples=100"]),
    // Light.
    ("cube.png", &["render", "cube", SIZE, SMOOTH]),
    ("hot_rest.png", &["render", "hot", "--beta=0", SIZE, SMOOTH, "--legend"]),
    ("hot.png", &["render", "hot", SIZE, SMOOTH, "--legend"]),
    ("hot_log.png", &["render", "hot", SIZE, SMOOTH, "--tone=log", "--legend"]),
    ("sunlit_geometry.png", &["render", "sunlit", SIZE, SMOOTH, SHAPE, "--legend"]),
    ("sunlit.png", &["render", "sunlit", SIZE, SMOOTH, "--tone=log", "--legend"]),
    ("lattice_90_geometry.png", &["render", "lattice", SHAPE, SMALL, SMOOTH]),
    ("lattice_90_doppler.png", &["render", "lattice", "--color=doppler", "--legend", SMALL, SMOOTH]),
    ("lattice_90_flat.png", &["render", "lattice", "--color=flat", "--legend", SMALL, SMOOTH]),
    ("lattice_90_spectral.png", &["render", "lattice", "--legend", SMALL, SMOOTH]),
    ("lattice_99_geometry.png", &["render", "lattice", "--beta=0.99", SHAPE, SMALL, SMOOTH]),
    (
        "lattice_99_doppler.png",
        &["render", "lattice", "--beta=0.99", "--color=doppler", "--legend", SMALL, SMOOTH],
    ),
    ("lattice_99_flat.png", &["render", "lattice", "--beta=0.99", "--color=flat", "--legend", SMALL, SMOOTH]),
    ("lattice_99_spectral.png", &["render", "lattice", "--beta=0.99", "--legend", SMALL, SMOOTH]),
    ("gate_90_geometry.png", &["render", "gate", "--beta=0.9", SHAPE, SMALL, SMOOTH]),
    ("gate_90_doppler.png", &["render", "gate", "--beta=0.9", "--color=doppler", "--legend", SMALL, SMOOTH]),
    ("gate_90_flat.png", &["render", "gate", "--beta=0.9", "--color=flat", "--legend", SMALL, SMOOTH]),
    ("gate_90_spectral.png", &["render", "gate", "--beta=0.9", "--legend", SMALL, SMOOTH]),
    ("gate_99_geometry.png", &["render", "gate", SHAPE, SMALL, SMOOTH]),
    ("gate_99_doppler.png", &["render", "gate", "--color=doppler", "--legend", SMALL, SMOOTH]),
    ("gate_99_flat.png", &["render", "gate", "--color=flat", "--legend", SMALL, SMOOTH]),
    ("gate_99_spectral.png", &["render", "gate", "--legend", SMALL, SMOOTH]),
];

const SHAPE: &str = "--color=geometry";
const SMALL: &str = "--size=320x180";
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
    let stars = std::env::temp_dir().join("terrell_blackhole_stars.toml");
    let scene = include_str!("../assets/blackhole.toml").replace("\"checker\"", "\"stars\"");
    if let Err(e) = std::fs::write(&stars, scene) {
        eprintln!("{}: {e}", stars.display());
        exit(1);
    }
    let stars = stars.to_string_lossy();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/images");
    for (file, words) in PICTURES {
        let output = folder.join(file);
        let output = output.to_string_lossy();
        let words = words.iter().map(|word| match *word {
            "SAMPLE" => &*sample,
            "STARS" => &*stars,
            word => word,
        });
        run("--bin", "terrell", &words.chain(["-o", &*output]).collect::<Vec<_>>());
    }
    // Nothing is left but the pictures.
    let _ = std::fs::remove_file(&*sample);
    let _ = std::fs::remove_file(&*stars);
}
