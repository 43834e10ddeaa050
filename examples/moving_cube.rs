//! The paper's moving cube as a film: at 0, 0.5, 0.9 and 0.99 of the speed of light, frame by frame at the same
//! apparent places, so that only its looks differ.
//!
//! ```sh
//! cargo run --release --example moving_cube -- cube.gif     # or .mp4, .apng
//! ```

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;
use terrell::exposure::Exposure;
use terrell::geodesic::Celerity;
use terrell::picture::{Movie, MovieFormat, pixels_srgb};
use terrell::render::{Options, render};
use terrell::scene::{Animation, STANDARD_BETA, Speed, builtin_scene};
use terrell::tone::Tone;

/// Frames a speed.
const FRAMES: u32 = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "moving_cube.mp4".into()));
    let format = MovieFormat::of(&path).ok_or("write to a .mp4, .gif or .apng file")?;
    let mut scene = builtin_scene("cube")?.scene();
    scene.view.size = [640, 360];
    let animation = Animation { frames: FRAMES, ..Animation::usual(&scene)? };
    let [width, height] = scene.view.size;
    let mut movie = Movie::new(format, BufWriter::new(File::create(&path)?), width, height, 30.0)?;
    for beta in [STANDARD_BETA, 0.5, 0.9, 0.99] {
        scene.set_speed(Speed::Along(Celerity::from_beta(glam::DVec3::X * beta)?.vector().x))?;
        let (cameras, options) = (animation.cameras(&scene)?, Options::default());
        // Every speed at its own exposure: at 0.99c most of it is too dark for that of the first.
        let development = Exposure::Auto.of_film(Tone::Filmic, &scene, &cameras, &options)?;
        for camera in &cameras {
            let (film, _) = render(&scene, camera, &options, |_| ())?;
            movie.push(&pixels_srgb(&film, &development))?;
        }
    }
    movie.finish()?;
    println!("{}: {} frames", path.display(), 4 * FRAMES);
    Ok(())
}
