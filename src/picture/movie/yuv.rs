use rayon::prelude::*;

/// Y′CbCr by BT.709 in limited range, 4:2:0, each chroma sample the mean of its 2×2 pixels: what H.264 is given.
pub(super) struct Planes {
    /// Of the luma plane, even; a last odd column or row of the picture is repeated.
    pub width: usize,
    pub height: usize,
    pub y: Vec<u8>,
    pub cb: Vec<u8>,
    pub cr: Vec<u8>,
}

/// Weights of R, G, B in luma, BT.709.
const LUMA: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Fixed-point fraction bits.
const BITS: u32 = 16;

const fn round(v: f64) -> i32 {
    if v < 0.0 { -((0.5 - v) as i32) } else { (v + 0.5) as i32 }
}

const fn fixed(weights: [f64; 3], scale: f64) -> [i32; 3] {
    let scale = scale * (1 << BITS) as f64;
    let sum = round((weights[0] + weights[1] + weights[2]) * scale);
    let (r, b) = (round(weights[0] * scale), round(weights[2] * scale));
    // Green takes what is left, so that grey stays grey and white white.
    [r, sum - r - b, b]
}

const Y: [i32; 3] = fixed(LUMA, 219.0 / 255.0);
const CB: [i32; 3] = fixed([-LUMA[0], -LUMA[1], 1.0 - LUMA[2]], 224.0 / 255.0 / (2.0 * (1.0 - LUMA[2])));
const CR: [i32; 3] = fixed([1.0 - LUMA[0], -LUMA[1], -LUMA[2]], 224.0 / 255.0 / (2.0 * (1.0 - LUMA[0])));

/// `offset` plus the weighted mean of 2^`log_count` pixels, given their sum.
fn weigh(weights: [i32; 3], sum: [i32; 3], log_count: u32, offset: i32) -> u8 {
    let bits = BITS + log_count;
    let weighed: i32 = weights.iter().zip(sum).map(|(w, s)| w * s).sum();
    ((weighed + (offset << bits) + (1 << (bits - 1))) >> bits) as u8
}

impl Planes {
    /// Black planes for pictures of this size.
    pub fn new(width: usize, height: usize) -> Self {
        let (width, height) = (width.next_multiple_of(2), height.next_multiple_of(2));
        let chroma = vec![128; width * height / 4];
        Self { width, height, y: vec![16; width * height], cb: chroma.clone(), cr: chroma }
    }

    /// Converts a picture of 3 bytes a pixel and `width` pixels a row, of the size the planes were made for.
    pub fn fill(&mut self, rgb: &[u8], width: usize) {
        let last = rgb.len() / (3 * width) - 1;
        let (pixels, plane) = (|y: usize| rgb[3 * width * y..][..3 * width].as_chunks::<3>().0, self.width);
        self.y
            .par_chunks_exact_mut(2 * plane)
            .zip(self.cb.par_chunks_exact_mut(plane / 2))
            .zip(self.cr.par_chunks_exact_mut(plane / 2))
            .enumerate()
            .for_each(|(pair, ((luma, cb), cr))| {
                let (upper, lower) = (pixels(2 * pair), pixels(last.min(2 * pair + 1)));
                let (luma_upper, luma_lower) = luma.split_at_mut(plane);
                for i in 0..plane / 2 {
                    let mut sum = [0; 3];
                    for x in [2 * i, 2 * i + 1] {
                        let column = x.min(width - 1);
                        for (row, luma) in [(upper, &mut *luma_upper), (lower, &mut *luma_lower)] {
                            let pixel = row[column].map(i32::from);
                            luma[x] = weigh(Y, pixel, 0, 16);
                            sum = [sum[0] + pixel[0], sum[1] + pixel[1], sum[2] + pixel[2]];
                        }
                    }
                    cb[i] = weigh(CB, sum, 2, 128);
                    cr[i] = weigh(CR, sum, 2, 128);
                }
            });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a step of rounding, and three weights that are half of 2⁻¹⁶ off times 255.
    const ROUNDING: f64 = 0.5 + 3.0 * 0.5 * 255.0 / 65536.0;

    #[test]
    fn agrees_with_bt709_in_floating_point() {
        for color in 0..1 << 12 {
            let rgb = [color >> 8, color >> 4 & 15, color & 15].map(|v| 17 * v as u8);
            let mut planes = Planes::new(2, 2);
            planes.fill(&rgb.repeat(4), 2);
            let [r, g, b] = rgb.map(|v| f64::from(v) / 255.0);
            let luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            let near = |byte: u8, exact: f64| (f64::from(byte) - exact).abs() <= ROUNDING;
            assert!(planes.y.iter().all(|&y| near(y, 16.0 + 219.0 * luma)), "{rgb:?}");
            assert!(near(planes.cb[0], 128.0 + 224.0 * (b - luma) / 1.8556), "{rgb:?}");
            assert!(near(planes.cr[0], 128.0 + 224.0 * (r - luma) / 1.5748), "{rgb:?}");
        }
    }

    #[test]
    fn chroma_is_the_mean_and_edges_are_repeated() {
        // 3×3: red on the left, then black; the last row white.
        let (red, black, white) = ([255, 0, 0], [0; 3], [255; 3]);
        let rgb = [red, black, black, red, black, black, white, white, white].concat();
        let mut planes = Planes::new(3, 3);
        planes.fill(&rgb, 3);
        assert_eq!((planes.width, planes.height), (4, 4));
        assert_eq!(planes.y[..8], [63, 16, 16, 16, 63, 16, 16, 16]);
        assert_eq!(planes.y[8..], [235; 8]);
        // Half of red's Cr, 240 − 128.
        assert_eq!(planes.cr, [184, 128, 128, 128]);
        assert_eq!(planes.cb, [115, 128, 128, 128]);
    }
}
