//! Fig. 1 of Nollert, Kraus and Ruder (2000): a lattice that passes overhead, at four speeds, a PNG each.
//!
//! ```sh
//! cargo run --release --example lattice -- pictures     # the folder is made if it is not there
//! ```

use glam::DVec3;
use std::error::Error;
use std::path::PathBuf;
use terrell::color::Coloring;
use terrell::geodesic::Celerity;
use terrell::picture;
use terrell::render::{Options, render};
use terrell::scene::{Speed, builtin_scene};
use terrell::tone::Development;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "lattice".into()));
    std::fs::create_dir_all(&folder)?;
    // Shapes alone: neither shift nor beaming.
    let options = Options { coloring: Coloring::Geometry, samples: 4, ..Options::default() };
    for beta in [0.0, 0.5, 0.9, 0.99] {
        let mut scene = builtin_scene("lattice")?.scene();
        scene.view.size = [640, 360];
        scene.set_speed(Speed::Along(Celerity::from_beta(DVec3::X * beta)?.magnitude()))?;
        let (film, _) = render(&scene, &scene.camera()?, &options, |_| ())?;
        let path = folder.join(format!("lattice_{:02.0}.png", 100.0 * beta));
        picture::write(&film, &Development::default(), &path)?;
        println!("{}", path.display());
    }
    Ok(())
}
