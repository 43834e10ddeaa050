use crate::scene::{MAX_TEXELS, Picture};
use image::{ImageFormat, ImageReader, Limits};
use std::io::Cursor;

/// Decodes a PNG, JPEG, BMP or TGA picture; what it is made transparent by is left out.
///
/// Small files can hold huge pictures; those above [`MAX_TEXELS`] are refused before they fill the memory.
pub(in crate::scene) fn decode(name: &str, bytes: Vec<u8>) -> Result<Picture, String> {
    let fault = |e: &dyn std::fmt::Display| format!("the picture '{name}' cannot be read: {e}");
    let mut reader = ImageReader::new(Cursor::new(&bytes)).with_guessed_format().map_err(|e| fault(&e))?;
    if reader.format().is_none() {
        // TGA has no mark to be known by.
        if !name.to_lowercase().ends_with(".tga") {
            return Err(fault(&"it is no PNG, JPEG, BMP or TGA"));
        }
        reader.set_format(ImageFormat::Tga);
    }
    let format = reader.format();
    let mut limits = Limits::default();
    limits.max_image_width = Some(1 << 15);
    limits.max_image_height = Some(1 << 15);
    limits.max_alloc = Some(MAX_TEXELS * 8);
    reader.limits(limits);
    let picture = reader.decode().map_err(|e| fault(&e))?;
    let (width, height) = (picture.width(), picture.height());
    if u64::from(width) * u64::from(height) > MAX_TEXELS {
        return Err(fault(&format!("{width}x{height} is more than {MAX_TEXELS} texels")));
    }
    let texels = picture.into_rgb8().pixels().map(|p| p.0).collect();
    let mut picture = Picture::new(name, width, height, texels).ok_or_else(|| fault(&"it is empty"))?;
    if matches!(format, Some(ImageFormat::Png | ImageFormat::Jpeg)) {
        picture.file = Some(bytes);
    }
    Ok(picture)
}

/// Whether a file is named as pictures that can be read are.
pub(in crate::scene) fn is_picture_file(path: &std::path::Path) -> bool {
    const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "bmp", "tga"];
    path.extension().is_some_and(|e| ENDINGS.iter().any(|ending| e.eq_ignore_ascii_case(ending)))
}
