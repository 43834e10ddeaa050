//! A night sky of our own: no real one, but the same everywhere.

use glam::DVec3;
use std::sync::LazyLock;

/// How many stars, about as many as are seen with a small telescope's finder.
const COUNT: usize = 24_000;

/// Standard deviation of a star's disc, radians: some two pixels of a picture of 60° and 720 rows, so that stars stay
/// stars in large pictures, too.
const RADIUS: f64 = 1.5e-3;

/// Footprints wider than this, radians, see less and less of single stars, and more of their mean.
const WIDEST: f64 = 0.02;

/// The greatest flux, of the least.
const BRIGHTEST: f64 = 400.0;

/// Radiance in the middle of a faint star's disc.
const FAINT: f64 = 0.05;

/// Belts by declination.
const BELTS: usize = 90;

struct Star {
    direction: DVec3,
    /// In red, green and blue, for an area of [`RADIUS`]².
    flux: [f64; 3],
}

/// The stars by belt, and in it by right ascension.
struct Sky {
    belts: Vec<Vec<(f64, Star)>>,
    mean: [f32; 3],
}

static SKY: LazyLock<Sky> = LazyLock::new(Sky::new);

/// Colours of stars of 3000, 4500, 6000, 9000 and 20 000 K, of luminance 1 or so.
const COLORS: [[f64; 3]; 5] =
    [[1.6, 0.88, 0.5], [1.3, 0.94, 0.7], [1.1, 0.97, 0.95], [0.9, 1.0, 1.25], [0.75, 1.0, 1.5]];

/// The next of evenly spread numbers from 0 to 1 (SplitMix64).
fn next(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

fn belt(declination: f64) -> usize {
    let place = (declination / std::f64::consts::PI + 0.5) * BELTS as f64;
    (place.max(0.0) as usize).min(BELTS - 1)
}

impl Sky {
    fn new() -> Self {
        let mut state = 1959;
        let mut belts: Vec<Vec<(f64, Star)>> = (0..BELTS).map(|_| Vec::new()).collect();
        let mut sum = [0.0; 3];
        for _ in 0..COUNT {
            let (z, turn) = (2.0 * next(&mut state) - 1.0, std::f64::consts::TAU * next(&mut state));
            let around = turn - std::f64::consts::PI;
            let across = (1.0 - z * z).sqrt();
            let direction = DVec3::new(across * around.cos(), across * around.sin(), z);
            // As many stars brighter than F as F^(−3/2), as where they are spread evenly in space.
            let flux = next(&mut state).max(1e-9).powf(-2.0 / 3.0).min(BRIGHTEST);
            let place = next(&mut state) * (COLORS.len() - 1) as f64;
            let (low, t) = ((place as usize).min(COLORS.len() - 2), place.fract());
            let color = [0, 1, 2].map(|i| COLORS[low][i] + t * (COLORS[low + 1][i] - COLORS[low][i]));
            let flux = color.map(|c| c * flux * FAINT * std::f64::consts::TAU);
            sum = [0, 1, 2].map(|i| sum[i] + flux[i]);
            belts[belt(z.asin())].push((around, Star { direction, flux }));
        }
        for belt in &mut belts {
            belt.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        let sphere = 4.0 * std::f64::consts::PI;
        Self { belts, mean: sum.map(|v| (v * RADIUS * RADIUS / sphere) as f32) }
    }
}

/// Linear sRGB radiance of the stars in a direction; `steps` are how it changes to the neighbouring pixels.
pub(super) fn radiance(direction: DVec3, steps: [DVec3; 2]) -> [f32; 3] {
    let sky = &*SKY;
    // The plane across, and the pixel's ellipse in it: its second moments, those of a star's disc added.
    let e1 = direction.any_orthonormal_vector();
    let e2 = direction.cross(e1);
    let [p, q] = steps.map(|s| [s.dot(e1), s.dot(e2)]);
    let widest = p[0].hypot(p[1]).max(q[0].hypot(q[1]));
    let blur = (0.5 * (widest / WIDEST - 1.0)).max(0.0);
    if widest.is_nan() || blur >= 1.0 {
        return sky.mean;
    }
    let [p, q] = [p, q].map(|v| v.map(|c| c / (1.0 + 2.0 * blur)));
    // Half a pixel is about two standard deviations of a box.
    const BOX: f64 = 0.25;
    let own = RADIUS * RADIUS;
    let xx = own + BOX * (p[0] * p[0] + q[0] * q[0]);
    let yy = own + BOX * (p[1] * p[1] + q[1] * q[1]);
    let xy = BOX * (p[0] * p[1] + q[0] * q[1]);
    let det = xx * yy - xy * xy;
    let reach = 3.5 * (xx + yy).sqrt();
    let (declination, around) = (direction.z.clamp(-1.0, 1.0).asin(), direction.y.atan2(direction.x));
    let mut sum = [0.0; 3];
    let mut add = |star: &Star| {
        let off = star.direction - direction;
        let (x, y) = (off.dot(e1), off.dot(e2));
        let square = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / det;
        if square < 12.25 && star.direction.dot(direction) > 0.0 {
            let weight = (-0.5 * square).exp() * own / (std::f64::consts::TAU * det.sqrt());
            sum = [0, 1, 2].map(|i| sum[i] + weight * star.flux[i]);
        }
    };
    for index in belt(declination - reach)..=belt(declination + reach) {
        let stars = &sky.belts[index];
        let farthest = (declination.abs() + reach).min(std::f64::consts::FRAC_PI_2);
        let width = if farthest.cos() > reach { reach / farthest.cos() } else { 4.0 };
        if width >= std::f64::consts::PI {
            stars.iter().for_each(|(_, star)| add(star));
            continue;
        }
        let mut range = |low: f64, high: f64| {
            let first = stars.partition_point(|(at, _)| *at < low);
            stars[first..].iter().take_while(|(at, _)| *at <= high).for_each(|(_, star)| add(star));
        };
        range(around - width, around + width);
        range(around - width + std::f64::consts::TAU, around + width + std::f64::consts::TAU);
        range(around - width - std::f64::consts::TAU, around + width - std::f64::consts::TAU);
    }
    let blur = blur as f32;
    [0, 1, 2].map(|i| sum[i] as f32 * (1.0 - blur) + sky.mean[i] * blur)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seen sharply or blurred, a patch of the sky has the same light.
    #[test]
    fn light_is_kept_whatever_the_footprint() {
        let mean = |step: f64| {
            let mut sum = 0.0;
            let n = 400;
            for i in 0..n {
                for j in 0..n {
                    // A patch of 0.4 by 0.4 around a pole of the belts' coordinates, and beyond it.
                    let at = |k: i32| (f64::from(k) / f64::from(n) - 0.5) * 0.4;
                    let n = DVec3::new(at(i), at(j) + 0.1, 1.0).normalize();
                    sum += f64::from(radiance(n, [DVec3::X * step, DVec3::Y * step])[1]);
                }
            }
            sum / f64::from(n * n)
        };
        let (sharp, blurred) = (mean(1e-3), mean(1e-2));
        // What bright stars near the patch's edge lose or gain.
        assert!((blurred / sharp - 1.0).abs() < 0.1, "{sharp} {blurred}");
        let whole = f64::from(radiance(DVec3::Z, [DVec3::X, DVec3::Y])[1]);
        assert!((0.5..2.0).contains(&(whole / sharp)), "{whole} {sharp}");
    }
}
