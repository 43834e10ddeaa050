use crate::film::Film;
use exr::prelude::*;
use std::io::{Seek, Write};

/// Writes everything the film holds as an OpenEXR file of 32-bit float channels: R G B (linear sRGB
/// radiance), distance (apparent r) and doppler, both 0 where nothing is seen, body and face, −1 there.
///
/// # Errors
/// If the writer fails.
pub fn write_exr(film: &Film, to: impl Write + Seek) -> std::io::Result<()> {
    let channel = |name: &str, values: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(values));
    let color = |i: usize| film.color.iter().map(|c| c[i]).collect();
    let index = |values: &[i32]| values.iter().map(|&v| v as f32).collect();
    let channels = AnyChannels::sort(
        [
            channel("R", color(0)),
            channel("G", color(1)),
            channel("B", color(2)),
            channel("distance", film.distance.clone()),
            channel("doppler", film.doppler.clone()),
            channel("body", index(&film.body)),
            channel("face", index(&film.face)),
        ]
        .into_iter()
        .collect(),
    );
    let size = (film.width as usize, film.height as usize);
    // In order, so that equal films are equal files.
    let encoding = Encoding {
        compression: Compression::ZIP16,
        line_order: LineOrder::Increasing,
        ..Encoding::default()
    };
    let layer = Layer::new(size, LayerAttributes::default(), encoding, channels);
    Image::from_layer(layer).write().to_buffered(to).map_err(|e| match e {
        Error::Io(e) => e,
        other => std::io::Error::other(other),
    })
}
