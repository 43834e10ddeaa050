use crate::color::{encoded, linear};
use glam::{DAffine2, DVec2};
use rayon::prelude::*;
use std::sync::{Arc, LazyLock};

/// A picture on a surface: red, green and blue by texture coordinates.
///
/// Coordinates run from (0, 0) at the picture's upper left corner to (1, 1) at its lower right, as in glTF.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The picture, shared between all who use it.
    pub picture: Arc<Picture>,
    /// What lies beyond 0 … 1, horizontally and vertically.
    pub wrap: [Wrap; 2],
    /// Whether texels are blocks when seen from near, not blended.
    pub blocky: bool,
    /// From the mesh's texture coordinates to the picture's.
    pub transform: DAffine2,
}

/// What a texture shows beyond its picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The picture mirrored, then again.
    Mirror,
    /// Its edge.
    Clamp,
}

/// A picture and its halvings, so that small and slanting views of it do not shimmer.
///
/// Kept as 8-bit sRGB; decoded before anything is averaged.
#[derive(Debug, PartialEq, Eq)]
pub struct Picture {
    /// What the file calls it.
    pub name: String,
    /// The file's own bytes, PNG or JPEG, for whoever writes the mesh to another file.
    pub file: Option<Vec<u8>>,
    levels: Vec<Level>,
}

#[derive(Debug, PartialEq, Eq)]
struct Level {
    size: [usize; 2],
    texels: Vec<[u8; 3]>,
}

/// The most texels of a picture; with its halvings it takes 4 bytes a texel.
pub const MAX_TEXELS: u64 = 1 << 26;

/// Looks taken along the longer axis of a pixel's footprint, at most. More slanting views are blurred.
const MOST_LOOKS: f64 = 16.0;

impl Picture {
    /// A picture of `width` × `height` sRGB texels, rows from the top; none if their number is wrong or zero.
    pub fn new(name: &str, width: u32, height: u32, texels: Vec<[u8; 3]>) -> Option<Self> {
        let size = [width as usize, height as usize];
        if texels.is_empty() || texels.len() != size[0].checked_mul(size[1])? {
            return None;
        }
        let mut levels = vec![Level { size, texels }];
        while let Some(last) = levels.last().filter(|l| l.size != [1, 1]) {
            levels.push(last.halved());
        }
        Some(Self { name: name.to_owned(), file: None, levels })
    }

    /// Width and height in texels.
    pub fn size(&self) -> [u32; 2] {
        self.levels[0].size.map(|s| s as u32)
    }

    /// The texels, sRGB, rows from the top.
    pub fn texels(&self) -> &[[u8; 3]] {
        &self.levels[0].texels
    }
}

/// The linear values of the 256 encoded ones.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|v| linear(v as u8)));

impl Level {
    /// Half as large (rounded down, but not below 1): every texel the average of those it covers, in linear light.
    fn halved(&self) -> Self {
        let size = self.size.map(|s| (s / 2).max(1));
        let columns: Vec<Vec<(usize, f32)>> =
            (0..size[0]).map(|x| shares(x, size[0], self.size[0])).collect();
        let row = |y: usize| {
            let lines = shares(y, size[1], self.size[1]);
            columns
                .iter()
                .map(|column| {
                    let mut sum = [0.0f32; 3];
                    for &(line, down) in &lines {
                        for &(x, across) in column {
                            let texel = self.texels[line * self.size[0] + x];
                            sum = [0, 1, 2].map(|i| sum[i] + down * across * LINEAR[texel[i] as usize]);
                        }
                    }
                    sum.map(encoded)
                })
                .collect::<Vec<_>>()
        };
        Self { size, texels: (0..size[1]).into_par_iter().flat_map_iter(row).collect() }
    }

    /// Linear colour at a point, blended from the four nearest texels.
    fn blended(&self, at: DVec2, wrap: [Wrap; 2]) -> [f32; 3] {
        let [x, y] = [(at.x, 0), (at.y, 1)].map(|(c, axis)| {
            let place = c * self.size[axis] as f64 - 0.5;
            let low = place.floor();
            let texel = |offset: f64| wrapped(low + offset, self.size[axis], wrap[axis]);
            ([texel(0.0), texel(1.0)], (place - low) as f32)
        });
        let texel =
            |i: usize, j: usize| self.texels[y.0[j] * self.size[0] + x.0[i]].map(|v| LINEAR[v as usize]);
        let mix = |a: [f32; 3], b: [f32; 3], t: f32| [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]));
        mix(mix(texel(0, 0), texel(1, 0), x.1), mix(texel(0, 1), texel(1, 1), x.1), y.1)
    }

    fn block(&self, at: DVec2, wrap: [Wrap; 2]) -> [f32; 3] {
        let [x, y] = [(at.x, 0), (at.y, 1)]
            .map(|(c, i)| wrapped((c * self.size[i] as f64).floor(), self.size[i], wrap[i]));
        self.texels[y * self.size[0] + x].map(|v| LINEAR[v as usize])
    }
}

/// The texels of `from` that texel `i` of `to` covers, with their shares of it.
fn shares(i: usize, to: usize, from: usize) -> Vec<(usize, f32)> {
    let scale = from as f64 / to as f64;
    let (start, end) = (i as f64 * scale, (i + 1) as f64 * scale);
    let last = (end.ceil() as usize).min(from);
    (start as usize..last)
        .map(|k| (k, ((end.min((k + 1) as f64) - start.max(k as f64)) / scale) as f32))
        .filter(|(_, share)| *share > 0.0)
        .collect()
}

fn wrapped(texel: f64, count: usize, wrap: Wrap) -> usize {
    let n = count as f64;
    let within = match wrap {
        Wrap::Repeat => texel.rem_euclid(n),
        Wrap::Mirror => {
            let there_and_back = texel.rem_euclid(2.0 * n);
            if there_and_back < n { there_and_back } else { 2.0 * n - 1.0 - there_and_back }
        }
        Wrap::Clamp => texel,
    };
    // A cast of NaN is 0.
    (within.max(0.0) as usize).min(count - 1)
}

impl Texture {
    /// A picture as most files use it: repeated, blended, as it is.
    pub fn of(picture: Arc<Picture>) -> Self {
        Self { picture, wrap: [Wrap::Repeat; 2], blocky: false, transform: DAffine2::IDENTITY }
    }

    /// Linear sRGB, averaged over a pixel at the mesh's texture coordinates `uv`; `step` is how these change
    /// from the pixel to its neighbours on the right and below.
    ///
    /// The pixel's footprint on the picture is an ellipse: up to 16 looks are taken along its longer axis, each
    /// as wide as its shorter one, between the two nearest halvings (as J. McCormack et al., *Feline*, 1999).
    pub fn at(&self, uv: DVec2, step: [DVec2; 2]) -> [f32; 3] {
        let levels = &self.picture.levels;
        let size = DVec2::from_array(levels[0].size.map(|s| s as f64));
        let at = self.transform.transform_point2(uv);
        let [a, b] = step.map(|s| self.transform.transform_vector2(s) * size);
        // Eigenvalues of the footprint's matrix are the squares of its axes.
        let (xx, yy) = (a.x * a.x + b.x * b.x, a.y * a.y + b.y * b.y);
        let xy = a.x * a.y + b.x * b.y;
        let (mean, half) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
        let (long, short) = ((mean + half).max(0.0).sqrt(), (mean - half).max(0.0).sqrt());
        if long <= 1.0 || long.is_nan() {
            return if self.blocky {
                levels[0].block(at, self.wrap)
            } else {
                levels[0].blended(at, self.wrap)
            };
        }
        let axis = DVec2::new(mean + half - yy, xy);
        let axis = if axis.length_squared() > 0.0 {
            axis.normalize()
        } else if xx >= yy {
            DVec2::X
        } else {
            DVec2::Y
        };
        let looks = (long / short.max(1.0)).ceil().min(MOST_LOOKS);
        let level = (long / looks).max(short).log2().clamp(0.0, (levels.len() - 1) as f64);
        let (fine, between) = (level as usize, level.fract() as f32);
        let coarse = (fine + 1).min(levels.len() - 1);
        let mut sum = [0.0; 3];
        for look in 0..looks as usize {
            let off = ((look as f64 + 0.5) / looks - 0.5) * long;
            let place = at + axis * off / size;
            let (near, far) =
                (levels[fine].blended(place, self.wrap), levels[coarse].blended(place, self.wrap));
            sum = [0, 1, 2].map(|i| sum[i] + near[i] + between * (far[i] - near[i]));
        }
        sum.map(|v| v / looks as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checks(size: u32) -> Texture {
        let texel = |i: u32| [if (i % size + i / size).is_multiple_of(2) { 255 } else { 0 }; 3];
        Texture::of(Arc::new(
            Picture::new("checks", size, size, (0..size * size).map(texel).collect()).unwrap(),
        ))
    }

    #[test]
    fn halving_keeps_the_light_of_any_size() {
        let texels: Vec<_> = (0..7 * 5).map(|i| [(i * 7) as u8, (255 - i * 3) as u8, 9]).collect();
        let mean = |level: &Level| {
            let sum: f32 = level.texels.iter().map(|t| LINEAR[t[0] as usize]).sum();
            sum / level.texels.len() as f32
        };
        let picture = Picture::new("p", 7, 5, texels).unwrap();
        let sizes: Vec<_> = picture.levels.iter().map(|l| l.size).collect();
        assert_eq!(sizes, [[7, 5], [3, 2], [1, 1]]);
        for level in &picture.levels {
            // Half a step of 8 bits, at this brightness, each time.
            assert!((mean(level) - mean(&picture.levels[0])).abs() < 0.006, "{:?}", level.size);
        }
        assert!(Picture::new("p", 2, 2, vec![[0; 3]; 3]).is_none());
        assert!(Picture::new("p", 0, 0, vec![]).is_none());
    }

    #[test]
    fn from_near_a_texel_is_itself_and_from_afar_the_average() {
        let checks = checks(64);
        let centre = |x: f64, y: f64| DVec2::new(x + 0.5, y + 0.5) / 64.0;
        assert_eq!(checks.at(centre(3.0, 3.0), [DVec2::ZERO; 2]), [1.0; 3]);
        assert_eq!(checks.at(centre(4.0, 3.0), [DVec2::ZERO; 2]), [0.0; 3]);
        let far = checks.at(DVec2::new(0.3, 0.7), [DVec2::X, DVec2::Y]);
        assert!((far[0] - 0.5).abs() < 0.01, "{far:?}");
        // Slanting: many texels one way, a tenth of one the other, along a row of one colour each.
        let stripes: Vec<_> =
            (0..64u32 * 64).map(|i| [if (i / 64).is_multiple_of(2) { 255 } else { 0 }; 3]).collect();
        let stripes = Texture::of(Arc::new(Picture::new("s", 64, 64, stripes).unwrap()));
        let along = stripes.at(centre(20.0, 4.0), [DVec2::X * (14.0 / 64.0), DVec2::Y * (0.1 / 64.0)]);
        assert!(along[0] > 0.99, "{along:?}");
        let across = stripes.at(centre(20.0, 4.0), [DVec2::X * (0.1 / 64.0), DVec2::Y * (14.0 / 64.0)]);
        assert!((across[0] - 0.5).abs() < 0.08, "{across:?}");
    }

    #[test]
    fn beyond_the_picture_it_repeats_mirrors_or_stays() {
        let ramp: Vec<_> = (0..4).map(|i| [(i * 80) as u8; 3]).collect();
        let mut texture = Texture::of(Arc::new(Picture::new("r", 4, 1, ramp).unwrap()));
        texture.blocky = true;
        let at = |texture: &Texture, x: f64| texture.at(DVec2::new(x, 0.5), [DVec2::ZERO; 2])[0];
        assert_eq!(at(&texture, 1.1), at(&texture, 0.1));
        assert_eq!(at(&texture, -0.1), at(&texture, 0.9));
        texture.wrap = [Wrap::Mirror; 2];
        assert_eq!(at(&texture, 1.1), at(&texture, 0.9));
        assert_eq!(at(&texture, -0.1), at(&texture, 0.1));
        texture.wrap = [Wrap::Clamp; 2];
        assert_eq!(at(&texture, 7.0), at(&texture, 0.9));
        assert_eq!(at(&texture, -7.0), at(&texture, 0.1));
        assert!(at(&texture, f64::NAN).is_finite());
    }
}
