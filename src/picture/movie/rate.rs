/// Frames a second as a ratio: the three containers count in whole numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rate {
    /// So many frames …
    pub frames: u16,
    /// … in so many seconds.
    pub seconds: u16,
}

impl Rate {
    /// The simplest ratio that is this number to twelve digits, or the last of its continued fraction with terms
    /// below 65536, off by one part in 65536 at most: 29.97 is 2997/100, 30000/1001 stays itself. None if there is no such ratio.
    pub fn of(fps: f64) -> Option<Self> {
        let (mut frames, mut frames_before, mut seconds, mut seconds_before) = (1.0, 0.0, 0.0, 1.0);
        let mut rest = fps;
        loop {
            let whole = f64::floor(rest);
            let next = (whole * frames + frames_before, whole * seconds + seconds_before);
            // Written so that what is no number ends here too.
            if !(next.0 <= 65535.0 && next.1 <= 65535.0) {
                break;
            }
            (frames_before, seconds_before) = (frames, seconds);
            (frames, seconds) = next;
            if (frames / seconds - fps).abs() <= 1e-12 * fps {
                break;
            }
            rest = (rest - whole).recip();
        }
        (frames >= 1.0 && seconds >= 1.0).then_some(Self { frames: frames as u16, seconds: seconds as u16 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_rates_are_exact() {
        for (fps, frames, seconds) in [
            (25.0, 25, 1),
            (30.0, 30, 1),
            (60.0, 60, 1),
            (0.5, 1, 2),
            (1.0 / 3.0, 1, 3),
            (29.97, 2997, 100),
            (23.976, 2997, 125),
            (30000.0 / 1001.0, 30000, 1001),
            (12.5, 25, 2),
        ] {
            assert_eq!(Rate::of(fps), Some(Rate { frames, seconds }), "{fps}");
        }
        // The nearest of its fractions with few enough digits.
        assert_eq!(Rate::of(std::f64::consts::PI), Some(Rate { frames: 355, seconds: 113 }));
        for bad in [0.0, -25.0, f64::NAN, f64::INFINITY, 1e-9, 1e9] {
            assert_eq!(Rate::of(bad), None, "{bad}");
        }
    }
}
