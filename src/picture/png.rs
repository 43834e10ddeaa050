use crate::film::Film;
use std::io::Write;

/// The film as 8-bit sRGB, three bytes a pixel: clipped to 0…1 and encoded (IEC 61966-2-1).
pub fn pixels_srgb(film: &Film) -> Vec<u8> {
    film.color.iter().flat_map(|color| color.map(encode)).collect()
}

fn encode(linear: f32) -> u8 {
    // A cast of NaN is 0: black.
    let v = linear.clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded + 0.5) as u8
}

/// Writes the film's colour as a PNG.
///
/// # Errors
/// If the writer fails.
pub fn write_png(film: &Film, to: impl Write) -> std::io::Result<()> {
    use image::ImageEncoder;
    image::codecs::png::PngEncoder::new(to)
        .write_image(&pixels_srgb(film), film.width, film.height, image::ExtendedColorType::Rgb8)
        .map_err(|e| match e {
            image::ImageError::IoError(e) => e,
            other => std::io::Error::other(other),
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::linear;

    #[test]
    fn srgb_there_and_back() {
        for v in 0..=255u8 {
            assert_eq!(encode(linear(v)), v);
        }
        assert_eq!(encode(f32::NAN), 0);
        assert_eq!(encode(7.0), 255);
        assert_eq!(encode(-1.0), 0);
    }
}
