//! Flying through the gate at 0.99 of the speed of light, looking forward, then backward; on the left the same flight
//! as it was thought to look before relativity.
//!
//! ```sh
//! cargo run --release --example gate_flythrough -- gate.mp4     # or .gif, .apng
//! ```

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;
use terrell::exposure::Exposure;
use terrell::picture::{Movie, MovieFormat, pixels_srgb};
use terrell::render::{Options, render};
use terrell::scene::{Animation, Camera, Scene, builtin_scene};
use terrell::tone::Tone;

/// A film's frames, one after the other: at one exposure, so that nothing flickers.
fn frames(scene: &Scene, cameras: &[Camera]) -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    let options = Options::default();
    let development = Exposure::Auto.of_film(Tone::Filmic, scene, cameras, &options)?;
    let frame = |camera| Ok(pixels_srgb(&render(scene, camera, &options, |_| ())?.0, &development));
    cameras.iter().map(frame).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "gate_flythrough.mp4".into()));
    let format = MovieFormat::of(&path).ok_or("write to a .mp4, .gif or .apng file")?;
    let (width, height) = (640, 360);
    let mut movie = Movie::new(format, BufWriter::new(File::create(&path)?), 2 * width, height, 30.0)?;
    for name in ["gate", "gate_back"] {
        let mut scene = builtin_scene(name)?.scene();
        scene.view.size = [width, height];
        let animation = scene.animation.clone().ok_or("the scene is filmed")?;
        let animation = Animation { frames: 90, ..animation };
        let (standard, slow) = animation.standard(&scene)?;
        let right = frames(&scene, &animation.cameras(&scene)?)?;
        for (left, right) in frames(&standard, &slow)?.iter().zip(&right) {
            let row = 3 * width as usize;
            let rows = left.chunks_exact(row).zip(right.chunks_exact(row));
            movie.push(&rows.flat_map(|(a, b)| [a, b].concat()).collect::<Vec<_>>())?;
        }
    }
    movie.finish()?;
    println!("{}", path.display());
    Ok(())
}
