use flip_rs::{DEFAULT_PPD, RgbImage, ldr_flip};

/// How different two pictures look to whoever flips between them, from 0 (not at all) to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perceived {
    /// Mean over all pixels.
    pub mean: f64,
    /// The greatest of any pixel.
    pub worst: f64,
}

/// Pictures that cannot be compared.
#[derive(Debug, thiserror::Error)]
#[error("the pictures cannot be compared as an eye would: {0}")]
pub struct FlipError(#[from] flip_rs::FlipError);

/// FLIP of two pictures of 8-bit sRGB, three bytes a pixel, both developed in the same way, on a screen of 3840 pixels
/// that is seen from as far away as it is wide (67 pixels a degree).
///
/// # Errors
/// If there are not three bytes for every pixel, or no pixels.
///
/// P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, *FLIP: A Difference Evaluator
/// for Alternating Images* (2020).
pub fn flip([width, height]: [u32; 2], reference: &[u8], picture: &[u8]) -> Result<Perceived, FlipError> {
    let image = |pixels: &[u8]| RgbImage::new(width as usize, height as usize, pixels.to_vec());
    let map = ldr_flip(&image(reference)?, &image(picture)?, DEFAULT_PPD)?;
    let pixels = map.pixels();
    let sum: f64 = pixels.iter().map(|&v| f64::from(v)).sum();
    let worst = pixels.iter().copied().fold(0.0, f32::max);
    Ok(Perceived { mean: sum / pixels.len() as f64, worst: f64::from(worst) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_differs_from_itself_and_white_from_black() {
        let picture: Vec<u8> = (0..3 * 32 * 24).map(|i| (i * 7 % 251) as u8).collect();
        assert_eq!(flip([32, 24], &picture, &picture).unwrap(), Perceived { mean: 0.0, worst: 0.0 });
        let (black, white) = (vec![0; 3 * 32 * 24], vec![255; 3 * 32 * 24]);
        let most = flip([32, 24], &black, &white).unwrap();
        // HyAB distances are scaled so that blue against green is 1; black against white is close.
        assert!(most.mean > 0.9 && most.worst <= 1.0, "{most:?}");
        assert!(flip([32, 24], &black, &white[3..]).is_err());
        assert!(flip([0, 0], &[], &[]).is_err());
    }
}
