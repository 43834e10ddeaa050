use crate::color::{OCTAVES, SCALE};
use crate::spectrum::luminance;
use crate::tone::LOG_OCTAVES;

const SIGHT: &str = include_str!("sight.wgsl");
const RASTER: &str = include_str!("raster.wgsl");
const FILM: &str = include_str!("film.wgsl");
const DEVELOP: &str = include_str!("develop.wgsl");
const TONE: &str = include_str!("tone.wgsl");

/// The shaders in WGSL, with their names: which triangle a pixel sees, what it shows, and its colour on a screen.
pub fn shaders() -> [(&'static str, String); 3] {
    let colors = colors();
    [
        ("raster", [SIGHT, RASTER].join("\n")),
        ("develop", [&colors, SIGHT, FILM, DEVELOP].join("\n")),
        ("tone", [&colors, SIGHT, FILM, TONE].join("\n")),
    ]
}

/// Constants that are kept in one place.
fn colors() -> String {
    let count = SCALE.len();
    let vector = |c: [f32; 3]| format!("vec3<f32>({:?}, {:?}, {:?})", c[0], c[1], c[2]);
    let weights = [0, 1, 2].map(|i| luminance(std::array::from_fn(|k| f32::from(u8::from(k == i)))));
    let stops: Vec<_> = SCALE.iter().map(|(stop, _)| format!("{stop:?}")).collect();
    let colors: Vec<_> = SCALE.iter().map(|(_, color)| vector(*color)).collect();
    format!(
        "const LUMINANCE = {};
const LOG_OCTAVES = {LOG_OCTAVES:?};
const FALSE_COUNT = {count}u;
const FALSE_OCTAVES = {OCTAVES:?};
const FALSE_STOPS = array<f32, {count}>({});
const FALSE_COLORS = array<vec3<f32>, {count}>({});
",
        vector(weights),
        stops.join(", "),
        colors.join(", ")
    )
}
