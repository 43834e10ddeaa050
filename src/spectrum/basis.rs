use super::observer::VISIBLE_NM;
use std::sync::LazyLock;

/// What is assumed of colours outside the visible, 360 to 830 nm: a colour says nothing of it, but a shift brings it to
/// light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Beyond {
    /// Every colour is the grey of its mean there; a tabulated spectrum has nothing beyond its table.
    #[default]
    Grey,
    /// As at the edge of the visible; a tabulated spectrum goes on as at its ends.
    Edge,
    /// There is no light outside the visible.
    Dark,
}

impl std::fmt::Display for Beyond {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Grey => "grey",
            Self::Edge => "edge",
            Self::Dark => "dark",
        })
    }
}

/// Beyond the visible colours fade to grey over so many nanometres.
const FADE_NM: f64 = 40.0;

/// By assets/color/make_basis.py, from 360 to 830 nm by 1 nm.
static REFLECTANCES: LazyLock<Vec<[f64; 3]>> = LazyLock::new(|| {
    include_str!("../../assets/color/rgb_basis.csv")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let mut values = line.split(',').skip(1).map(|v| v.parse().expect("a number"));
            std::array::from_fn(|_| values.next().expect("three numbers a line"))
        })
        .collect()
});

/// The reflectances at a wavelength that stand for red, green and blue: r, g and b times these is a smooth spectrum
/// whose colour is (r, g, b), under this crate's white.
///
/// Each is between 0 and 1, and together they are 1 (after I. Mallett and C. Yuksel 2019), except with
/// [`Beyond::Dark`].
pub fn reflectances(nm: f64, beyond: Beyond) -> [f64; 3] {
    let table = &*REFLECTANCES;
    let [first, last] = VISIBLE_NM;
    if (first..=last).contains(&nm) {
        let place = nm - first;
        let low = (place as usize).min(table.len() - 2);
        let t = place - low as f64;
        return std::array::from_fn(|i| table[low][i] + t * (table[low + 1][i] - table[low][i]));
    }
    let (edge, away) = if nm < first { (table[0], first - nm) } else { (table[table.len() - 1], nm - last) };
    match beyond {
        Beyond::Dark => [0.0; 3],
        Beyond::Edge => edge,
        Beyond::Grey => {
            let t = (away / FADE_NM).min(1.0);
            edge.map(|v| v + t * (1.0 / 3.0 - v))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reflectances_are_such_and_add_up() {
        for i in 0..4000 {
            let nm = 100.0 + 0.5 * f64::from(i);
            for beyond in [Beyond::Grey, Beyond::Edge] {
                let all = reflectances(nm, beyond);
                assert!(all.iter().all(|v| (0.0..=1.0 + 1e-12).contains(v)), "{nm} {all:?}");
                assert!((all.iter().sum::<f64>() - 1.0).abs() < 1e-11, "{nm} {all:?}");
            }
        }
        assert_eq!(reflectances(1000.0, Beyond::Dark), [0.0; 3]);
        assert_eq!(reflectances(200.0, Beyond::Grey), [1.0 / 3.0; 3]);
        // Continuous at both ends.
        for nm in VISIBLE_NM {
            let (inside, outside) = (
                reflectances(nm, Beyond::Grey),
                [nm - 1e-9, nm + 1e-9].map(|n| reflectances(n, Beyond::Grey)),
            );
            assert!(outside.iter().all(|o| (o[0] - inside[0]).abs() < 1e-9));
        }
    }
}
