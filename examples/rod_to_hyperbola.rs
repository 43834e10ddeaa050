//! A straight rod across the motion, as it looks: the nodes of its polyline as CSV, for a plot.
//!
//! `cargo run --example rod_to_hyperbola > rod.csv`

use glam::DVec3;
use terrell::apparent::{Field, Rod};
use terrell::geodesic::{Celerity, Event, Tetrad};
use terrell::relativity::{ApparentMap, Motion};
use terrell::scene::{Lens, Projection};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The rod passes at a distance of 2; the camera looks across its motion.
    let celerity = Celerity::from_beta(DVec3::X * 0.95)?;
    let motion = Motion { celerity, origin: Event::new(-2.0, 0.0, 2.0, 0.0) };
    let camera = Tetrad::new(Event::origin(), Celerity::at_rest(), DVec3::Y, DVec3::Z)?;
    let map = ApparentMap::new(&motion, &camera);

    let lens = Lens::new(Projection::Pinhole, 90.0, 1000, 1000)?;
    let rod = Rod { from: DVec3::new(0.0, 0.0, -4.0), to: DVec3::new(0.0, 0.0, 4.0) };
    let nodes = rod.polyline(&map, &Field::new(&lens), 0.25);

    println!("t,right,up,forward,pixel_x,pixel_y");
    for node in &nodes {
        let DVec3 { x, y, z } = node.apparent;
        let pixel = lens.pixel(node.apparent).map_or(String::from(","), |p| format!("{},{}", p.x, p.y));
        println!("{},{x},{y},{z},{pixel}", node.t);
    }
    eprintln!("{} pieces keep it within a quarter of a pixel", nodes.len() - 1);
    Ok(())
}
