//! From light without bounds to what a screen has: exposure and tone curve.

use crate::color::linear_of;
use crate::spectrum::luminance;

/// How light becomes a picture of values from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Development {
    /// Light is multiplied by two to the power of this.
    pub ev: f32,
    /// What becomes of it then.
    pub tone: Tone,
}

/// Curves from light to what is shown. Colours sRGB does not have lose colour until it has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Tone {
    /// As it is; what is brighter than white is clipped, channel by channel.
    #[default]
    Linear,
    /// As film: soft shadows and shoulders, very bright colours turn white. K. Narkowicz's fit (2016) of the curve of
    /// the Academy Color Encoding System, channel by channel.
    Filmic,
    /// Evenly by the logarithm of luminance, twelve octaves from black to white; colours stay.
    Log,
}

/// Octaves of luminance the logarithmic curve shows.
pub const LOG_OCTAVES: f32 = 12.0;

/// The highest exposure metering asks for: a million times, the way from daylight to moonlight. What is darker is dark.
pub const MOST_METERED: f32 = 20.0;

/// The share of what is bright that is brighter than what metering makes [`Tone::white`].
const BRIGHTER: f64 = 0.05;

impl Tone {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Linear, Self::Filmic, Self::Log];

    /// The light that is shown nearly as bright as can be: where metering puts bright parts.
    pub fn white(self) -> f32 {
        match self {
            Self::Linear => 0.95,
            Self::Filmic => 1.2,
            Self::Log => 1.0,
        }
    }

    /// The exposure that puts the bright parts of a picture at [`white`](Self::white): all but one in twenty of its
    /// points that are not black are darker. In hundredths; 0 if all is black, and never more than
    /// [`MOST_METERED`].
    pub fn metered(self, colors: impl IntoIterator<Item = [f32; 3]>) -> f32 {
        let brightest = |c: [f32; 3]| c.into_iter().fold(0.0, f32::max);
        let mut light: Vec<f32> =
            colors.into_iter().map(brightest).filter(|v| *v > 0.0 && v.is_finite()).collect();
        if light.is_empty() {
            return 0.0;
        }
        let at = ((light.len() - 1) as f64 * (1.0 - BRIGHTER)) as usize;
        let (_, bright, _) = light.select_nth_unstable_by(at, f32::total_cmp);
        (((self.white() / *bright).log2() * 100.0).round() / 100.0).min(MOST_METERED)
    }
}

impl std::fmt::Display for Tone {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Linear => "linear",
            Self::Filmic => "filmic",
            Self::Log => "log",
        })
    }
}

impl Default for Development {
    /// Light as it is.
    fn default() -> Self {
        Self { ev: 0.0, tone: Tone::Linear }
    }
}

impl Development {
    /// What is shown of linear light, linear too, from 0 to 1 (NaN is 0 when it is encoded).
    pub fn shown(&self, light: [f32; 3]) -> [f32; 3] {
        let mut shown = [light];
        self.show(&mut shown);
        shown[0]
    }

    /// [`shown`](Self::shown) for many colours, each in the place of the light.
    pub fn show(&self, colors: &mut [[f32; 3]]) {
        let factor = self.ev.exp2();
        colors.as_flattened_mut().iter_mut().for_each(|v| *v *= factor);
        if colors.as_flattened().iter().any(|v| *v < 0.0) {
            colors.iter_mut().for_each(|color| *color = within_gamut(*color));
        }
        match self.tone {
            Tone::Linear => {}
            // In a loop of plain arithmetic, which compilers make vectors of.
            Tone::Filmic => colors.as_flattened_mut().iter_mut().for_each(|v| *v = filmic(*v)),
            Tone::Log => colors.iter_mut().for_each(|color| *color = logarithmic(*color)),
        }
    }
}

/// Mixed with the grey of the same luminance until nothing is negative.
#[inline]
fn within_gamut(color: [f32; 3]) -> [f32; 3] {
    let least = color[0].min(color[1]).min(color[2]);
    if least >= 0.0 || least.is_nan() {
        return color;
    }
    let grey = luminance(color);
    if grey <= 0.0 {
        return [0.0; 3];
    }
    let keep = grey / (grey - least);
    color.map(|v| (grey + keep * (v - grey)).max(0.0))
}

#[inline]
fn filmic(v: f32) -> f32 {
    // Far above, where squares would be too large, it is what it tends to.
    let v = if v > 1e4 { 1e4 } else { v };
    let shown = v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14);
    if shown > 1.0 { 1.0 } else { shown }
}

fn logarithmic(color: [f32; 3]) -> [f32; 3] {
    let bright = luminance(color);
    if bright.is_nan() || bright <= 0.0 {
        return [0.0; 3];
    }
    let shown = linear_of((1.0 + bright.log2() / LOG_OCTAVES).clamp(0.0, 1.0));
    // Divided first: what is shown of very bright light is far less than it.
    color.map(|v| v / bright * shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_rise_and_end_at_white() {
        for tone in Tone::ALL {
            let shown = |v: f32| Development { ev: 0.0, tone }.shown([v; 3])[0];
            let mut last = -1.0;
            for i in 0..2000 {
                let v = (f32::from(i as u16) / 100.0 - 14.0).exp2();
                let now = shown(v);
                let possible = tone == Tone::Linear || (0.0..=1.0).contains(&now);
                // To rounding.
                assert!(now > last - 1e-6 && possible, "{tone} {v} {now}");
                last = now;
            }
            assert_eq!(shown(0.0), 0.0);
            assert!(shown(tone.white()) > 0.8, "{tone} {}", shown(tone.white()));
            assert!(shown(1e35).is_finite());
        }
        // A step of exposure is a factor of two.
        let exposed = Development { ev: 3.0, tone: Tone::Linear };
        assert_eq!(exposed.shown([0.1, 0.2, 0.0]), [0.8, 1.6, 0.0]);
        // Half way down the logarithm: sRGB's middle code.
        let middle = Development { ev: 0.0, tone: Tone::Log }.shown([2f32.powi(-6); 3])[0];
        assert!((middle - linear_of(0.5)).abs() < 1e-6);
    }

    #[test]
    fn colours_srgb_does_not_have_keep_their_luminance() {
        let shown = Development::default().shown([1.0, 0.4, -0.2]);
        assert!(shown.iter().all(|v| *v >= 0.0) && shown[2] < 1e-6);
        assert!((luminance(shown) - luminance([1.0, 0.4, -0.2])).abs() < 1e-6);
        assert_eq!(Development::default().shown([0.0, -0.1, 0.0]), [0.0; 3]);
    }

    #[test]
    fn metering_leaves_one_in_twenty_above_white() {
        let colors = (1..=1000).map(|i| [i as f32, 0.0, 0.0]).chain([[0.0; 3]; 5000]);
        let ev = Tone::Linear.metered(colors);
        assert!((ev.exp2() * 950.0 / 0.95 - 1.0).abs() < 0.01, "{ev}");
        assert_eq!(Tone::Linear.metered([[0.0; 3]; 4]), 0.0);
        assert_eq!(Tone::Filmic.metered([]), 0.0);
        assert_eq!(Tone::Filmic.metered([[1e-30; 3]]), MOST_METERED);
        assert_eq!(Tone::Linear.metered([[f32::NAN; 3], [0.95; 3]]), 0.0);
    }
}
