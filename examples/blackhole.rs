//! Meshes and a sky around a rotating black hole, as scenes that ship have it, from a camera of one's own.
//!
//! ```sh
//! cargo run --release --example blackhole -- hole.png
//! ```

use glam::DVec3;
use std::error::Error;
use std::path::PathBuf;
use terrell::color::Coloring;
use terrell::geodesic::{Event, KerrSchild};
use terrell::picture;
use terrell::plan::Method;
use terrell::render::{Options, render};
use terrell::scene::{Aim, Spacetime, builtin_scene};
use terrell::tone::Development;

fn main() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "blackhole.png".into()));
    let mut scene = builtin_scene("blackhole")?.scene();
    // Mass and spin, both lengths.
    scene.spacetime = Spacetime::Kerr(KerrSchild::new(1.0, 0.7)?);
    let place = DVec3::new(0.0, -18.0, 6.0);
    (scene.view.event, scene.view.aim) = (Event::at(0.0, place), Aim::Forward(-place));
    scene.view.size = [480, 270];
    // Bent light is followed by rays alone.
    let options = Options { method: Method::Trace, coloring: Coloring::Geometry, ..Options::default() };
    let (film, report) = render(&scene, &scene.camera()?, &options, |_| ())?;
    picture::write(&film, &Development::default(), &path)?;
    let count = report.rays.map(|rays| rays.count).unwrap_or_default();
    println!(
        "{}: {} rays, {} from bodies, {} from the sky, {} from the hole, {} could not be followed",
        path.display(),
        count.primary,
        count.bodies,
        count.sky,
        count.hole,
        count.failed()
    );
    Ok(())
}
