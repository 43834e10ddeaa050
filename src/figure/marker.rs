use super::page::{Ink, Page};
use glam::DVec2;
use std::f64::consts::TAU;

/// Colours that also eyes without red or green tell apart (M. Okabe and K. Ito, *Color Universal Design*, 2008), darkest
/// on white first, and a grey.
pub const INKS: [Ink; 8] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [0, 0, 0],
    [230, 159, 0],
    [86, 180, 233],
    [127, 127, 127],
];

/// What stands for a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A disc.
    Circle,
    /// A square.
    Square,
    /// A triangle on its side.
    Triangle,
    /// A square on its corner.
    Diamond,
    /// A triangle on its corner.
    Inverted,
    /// Five corners.
    Pentagon,
    /// A cross of two bars.
    Cross,
    /// A cross of two slanting bars.
    Saltire,
}

impl Marker {
    /// All there are, in the order in which series without one of their own get them.
    pub const ALL: [Self; 8] = [
        Self::Circle,
        Self::Square,
        Self::Triangle,
        Self::Diamond,
        Self::Inverted,
        Self::Pentagon,
        Self::Cross,
        Self::Saltire,
    ];

    fn corners(self, at: DVec2, radius: f64) -> Vec<DVec2> {
        let around = |count: u32, first: f64, radius: f64| -> Vec<DVec2> {
            let corner = |i| DVec2::from_angle(TAU * (first + f64::from(i) / f64::from(count)));
            (0..count).map(|i| at + radius * corner(i)).collect()
        };
        // A twelve-sided star whose arms are a third as wide as it.
        let bars = |turn: f64| {
            let (long, short) = (1.15, 0.38);
            let arm = [(short, -short), (long, -short), (long, short)];
            let quarter = |q: u32| {
                arm.map(|(x, y)| {
                    DVec2::from_angle(TAU * (turn + 0.25 * f64::from(q))).rotate(DVec2::new(x, y))
                })
            };
            (0..4).flat_map(quarter).map(|p| at + radius * p).collect()
        };
        // Sizes that look alike.
        match self {
            Self::Circle => around(24, 0.0, radius),
            Self::Square => around(4, 0.125, 1.25 * radius),
            Self::Triangle => around(3, -0.25, 1.35 * radius),
            Self::Diamond => around(4, 0.0, 1.3 * radius),
            Self::Inverted => around(3, 0.25, 1.35 * radius),
            Self::Pentagon => around(5, -0.25, 1.15 * radius),
            Self::Cross => bars(0.0),
            Self::Saltire => bars(0.125),
        }
    }

    /// Draws it whole, or only its rim.
    pub(super) fn draw(self, page: &mut Page, at: DVec2, radius: f64, whole: bool, ink: Ink) {
        let corners = self.corners(at, radius);
        page.area(corners.clone(), if whole { ink } else { [255; 3] });
        let closed: Vec<DVec2> = corners.iter().chain(&corners[..1]).copied().collect();
        page.line(closed, 0.3 * radius, ink);
    }
}
