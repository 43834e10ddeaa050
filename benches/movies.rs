//! Cost and size of movies: 240 frames, 1280×720, of a flight through the gate (flat colours), of the lattice in
//! false colour (all colours there are), to MP4, GIF and APNG.
//!
//! `cargo bench --bench movies -- FOLDER` leaves the movies in FOLDER. The APNG is exact, so what another program
//! makes of the MP4 can be compared with it: `ffmpeg -i gate.mp4 -i gate.apng -lavfi psnr -f null -`.

use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use terrell::color::Coloring;
use terrell::picture::{Movie, MovieFormat, pixels_srgb};
use terrell::{render, scene};

const FRAMES: u32 = 240;

fn main() {
    let folder: PathBuf = std::env::args()
        .skip(1)
        .find(|a| !a.starts_with("--"))
        .map_or_else(|| std::env::temp_dir().join("terrell-movies"), PathBuf::from);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, coloring, from, step) in
        [("gate", Coloring::Geometry, -8.0, 0.06), ("lattice", Coloring::Doppler, -4.0, 0.035)]
    {
        let builtin = scene::builtin_scenes().iter().find(|s| s.name == name).unwrap();
        let mut scene = builtin.scene();
        scene.view.size = [1280, 720];
        let mut movies = ["mp4", "gif", "apng"].map(|ending| {
            let path = folder.join(name).with_extension(ending);
            let to = BufWriter::new(File::create(&path).unwrap());
            let format = MovieFormat::of(&path).unwrap();
            (path, Movie::new(format, to, 1280, 720, 25.0).unwrap(), Duration::ZERO)
        });
        for i in 0..FRAMES {
            scene.view.set_time(from + step * f64::from(i)).unwrap();
            let options = render::Options { coloring, ..Default::default() };
            let (film, _) = render::render(&scene, &scene.camera().unwrap(), &options, |_| ()).unwrap();
            let pixels = pixels_srgb(&film, &terrell::tone::Development::default());
            for (_, movie, spent) in &mut movies {
                let start = Instant::now();
                movie.push(&pixels).unwrap();
                *spent += start.elapsed();
            }
        }
        for (path, movie, spent) in movies {
            let start = Instant::now();
            movie.finish().unwrap();
            let ms = 1e3 * (spent + start.elapsed()).as_secs_f64() / f64::from(FRAMES);
            let bytes = path.metadata().unwrap().len();
            println!("{:40} {ms:6.1} ms a frame {:8.2} MB", path.display(), bytes as f64 / 1e6);
        }
    }
}
