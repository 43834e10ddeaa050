//! Time against error of the ways to draw a scene, as a table; `terrell chart` draws it.
//!
//! ```sh
//! cargo run --release --example speed_vs_accuracy -- lattice
//! ```

use std::error::Error;
use terrell::measure::{Sweep, usual_ways};
use terrell::render::{Options, Raster};
use terrell::scene::builtin_scene;
use terrell::tone::Development;

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "cube".into());
    let mut scene = builtin_scene(&name)?.scene();
    scene.view.size = [320, 180];
    let camera = scene.camera()?;
    let options = Options::default();
    let mut ways = usual_ways(&options, &[1.0, 0.25], &[0.25], &[1, 4]);
    ways.retain(|way| way.options.raster != Raster::Wgpu);
    let sweep = Sweep { scene: &scene, camera: &camera, ways, reference_samples: 16, repeats: 5 };
    let points = sweep.run(&options, |_| Ok(Development::default()), || ())?;
    println!("{name}: milliseconds a picture, worst displacement in pixels, relative RMS of light");
    for point in points {
        let Ok(measured) = &point.measured else { continue };
        // What is not timed is there for its error alone.
        let Some(times) = &measured.frame else { continue };
        let time = 1e3 * times.seconds()[0];
        let displaced = point.displacement().map_or("-".to_owned(), |px| format!("{px:.1e}"));
        println!(
            "  {:<16} {time:>8.2} {displaced:>9} {:.1e}",
            point.way.series, measured.light.radiance.relative_rms
        );
    }
    Ok(())
}
