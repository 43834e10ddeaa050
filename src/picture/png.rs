use crate::color::{encode, encoded};
use crate::film::{FLAGGED, Film};
use crate::tone::Development;
use rayon::prelude::*;
use std::io::Write;

/// The film as 8-bit sRGB, three bytes a pixel: developed, clipped to 0…1 and encoded (IEC 61966-2-1).
pub fn pixels_srgb(film: &Film, development: &Development) -> Vec<u8> {
    let mut pixels = vec![0; 3 * film.color.len()];
    const BLOCK: usize = 256;
    let blocks = pixels.par_chunks_mut(3 * BLOCK).zip(film.color.par_chunks(BLOCK)).enumerate();
    blocks.with_min_len(16).for_each(|(number, (pixels, colors))| {
        // Black stays black.
        if colors.as_flattened().iter().any(|v| *v != 0.0) {
            let shown = &mut [[0.0; 3]; BLOCK][..colors.len()];
            shown.copy_from_slice(colors);
            development.show(shown);
            encode(shown.as_flattened(), pixels);
        }
        // At any exposure.
        let numbered = pixels.chunks_exact_mut(3).zip(number * BLOCK..);
        for (pixel, _) in numbered.filter(|(_, i)| film.is_flagged(*i)) {
            pixel.copy_from_slice(&FLAGGED.map(encoded));
        }
    });
    pixels
}

/// Writes the film's colour as a PNG.
///
/// # Errors
/// If the writer fails.
pub fn write_png(film: &Film, development: &Development, to: impl Write) -> std::io::Result<()> {
    write_png_pixels(film.width, film.height, &pixels_srgb(film, development), to)
}

/// Writes 8-bit sRGB, three bytes a pixel, as a PNG.
///
/// # Errors
/// If the writer fails, or there are not three bytes a pixel.
pub fn write_png_pixels(width: u32, height: u32, pixels: &[u8], to: impl Write) -> std::io::Result<()> {
    use image::ImageEncoder;
    if pixels.len() as u64 != 3 * u64::from(width) * u64::from(height) {
        return Err(std::io::Error::other("a picture needs three bytes a pixel"));
    }
    image::codecs::png::PngEncoder::new(to)
        .write_image(pixels, width, height, image::ExtendedColorType::Rgb8)
        .map_err(|e| match e {
            image::ImageError::IoError(e) => e,
            other => std::io::Error::other(other),
        })
}
