//! How far polygons, moved to where they are seen, are from rays traced back in time; by tolerance.
//!
//! ```sh
//! cargo run --release --example shading_vs_tracing -- street
//! ```

use std::error::Error;
use terrell::measure::{Comparison, Corners, Reference};
use terrell::plan::Method;
use terrell::render::{Options, render};
use terrell::scene::builtin_scene;

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "gate".into());
    let mut scene = builtin_scene(&name)?.scene();
    scene.view.size = [480, 270];
    let camera = scene.camera()?;
    let traced = Options { method: Method::Trace, ..Options::default() };
    let (film, _) = render(&scene, &camera, &traced, |_| ())?;
    let corners = Some(Corners::traced(&scene, &camera, &film)?);
    let reference = Reference { corners, ..Reference::from(film) };
    println!("{name}: pixels that see another body (more than a pixel off), and light, relative RMS");
    for tolerance in [4.0, 1.0, 0.25, 0.0625] {
        let options = Options { method: Method::Apparent, tolerance, ..Options::default() };
        let (film, report) = render(&scene, &camera, &options, |_| ())?;
        let seen = Comparison::new(&reference, &film)?.whole;
        let silhouette = seen.silhouette.map_or((0, 0), |found| (found.pixels, found.beyond));
        println!(
            "  {tolerance:>6} px: {:>6} pieces, {:>4} ({}), {:.1e}",
            report.pieces, silhouette.0, silhouette.1, seen.radiance.relative_rms
        );
    }
    Ok(())
}
