use crate::drawing::text;
use glam::DVec2;

/// A rectangle on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub low: DVec2,
    pub high: DVec2,
}

impl Area {
    pub fn overlaps(&self, other: &Self) -> bool {
        self.low.cmplt(other.high).all() && other.low.cmplt(self.high).all()
    }

    pub fn holds(&self, other: &Self) -> bool {
        self.low.cmple(other.low).all() && other.high.cmple(self.high).all()
    }

    pub fn around(middle: DVec2, half: DVec2) -> Self {
        Self { low: middle - half, high: middle + half }
    }

    /// The part of a line from `a` to `b` inside (by parameters; J. Y. Liang and B. A. Barsky, 1984).
    pub fn clipped(&self, [a, b]: [DVec2; 2]) -> Option<[DVec2; 2]> {
        let (mut from, mut to) = (0.0, 1.0);
        for axis in 0..2 {
            let (start, along) = (a[axis], b[axis] - a[axis]);
            let [near, far] = [self.low[axis], self.high[axis]].map(|side| (side - start) / along);
            if along == 0.0 {
                if !(self.low[axis]..=self.high[axis]).contains(&start) {
                    return None;
                }
            } else {
                from = f64::max(from, near.min(far));
                to = f64::min(to, near.max(far));
            }
        }
        (from <= to).then(|| [a.lerp(b, from), a.lerp(b, to)])
    }
}

/// A label to be written beside a point.
#[derive(Clone, Debug)]
pub(super) struct Wanted {
    pub text: String,
    pub at: DVec2,
}

/// Where a label is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placed {
    pub area: Area,
    /// So far from its point that a line has to lead to it.
    pub far: bool,
}

/// Places labels beside their points so that they cover neither each other nor a point nor the sides, and lines as little
/// as can be; those that come first have the choice, and what has no place stays out.
pub(super) fn place(
    wanted: &[Wanted],
    em: f64,
    points: &[Area],
    lines: &[[DVec2; 2]],
    bounds: &Area,
) -> Vec<Option<Placed>> {
    let mut placed: Vec<Option<Placed>> = Vec::with_capacity(wanted.len());
    for label in wanted {
        let half = 0.5 * DVec2::new(text::width(&label.text, em) + 4.0, 1.15 * em);
        let free = |area: &Area| {
            bounds.holds(area)
                && !points.iter().any(|point| point.overlaps(area))
                && !placed.iter().flatten().any(|other| other.area.overlaps(area))
        };
        let crossed = |area: &Area| lines.iter().filter(|line| area.clipped(**line).is_some()).count();
        let best = candidates(label.at, half)
            .filter(|(placed, _)| free(&placed.area))
            .map(|(placed, away)| (placed, away + 2.0 * crossed(&placed.area) as f64))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        placed.push(best.map(|(placed, _)| placed));
    }
    placed
}

/// Places around a point, and how little each is liked.
fn candidates(at: DVec2, half: DVec2) -> impl Iterator<Item = (Placed, f64)> {
    const TURNS: [(f64, f64); 8] = [
        (1.0, 0.0),
        (0.8, -0.8),
        (0.0, -1.0),
        (0.8, 0.8),
        (-1.0, 0.0),
        (0.0, 1.0),
        (-0.8, -0.8),
        (-0.8, 0.8),
    ];
    let gaps = [7.0, 16.0, 28.0, 42.0, 60.0];
    gaps.into_iter().enumerate().flat_map(move |(step, gap)| {
        TURNS.into_iter().enumerate().map(move |(turn, (x, y))| {
            let away = DVec2::new(x, y);
            let middle = at + away.signum_or_zero() * half + gap * away;
            let away = 1.5 * step as f64 + 0.1 * turn as f64;
            (Placed { area: Area::around(middle, half), far: step > 0 }, away)
        })
    })
}

trait SignumOrZero {
    fn signum_or_zero(self) -> Self;
}

impl SignumOrZero for DVec2 {
    fn signum_or_zero(self) -> Self {
        Self::new(
            if self.x == 0.0 { 0.0 } else { self.x.signum() },
            if self.y == 0.0 { 0.0 } else { self.y.signum() },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_cover_neither_each_other_nor_points() {
        let bounds = Area { low: DVec2::ZERO, high: DVec2::new(400.0, 300.0) };
        // A crowd, and some at the sides.
        let at = |i: u32| DVec2::new(f64::from(i * 37 % 80) * 5.0, f64::from(i * 53 % 61) * 5.0);
        let wanted: Vec<_> = (0..40).map(|i| Wanted { text: format!("label {i}"), at: at(i) }).collect();
        let points: Vec<_> = wanted.iter().map(|w| Area::around(w.at, DVec2::splat(5.0))).collect();
        let placed = place(&wanted, 12.0, &points, &[], &bounds);
        let areas: Vec<Area> = placed.iter().flatten().map(|p| p.area).collect();
        assert!(areas.len() > 20, "{} of 40", areas.len());
        for (i, a) in areas.iter().enumerate() {
            assert!(bounds.holds(a));
            assert!(!areas[..i].iter().chain(&points).any(|b| a.overlaps(b)), "{i}");
        }
    }

    #[test]
    fn a_label_keeps_off_a_line_where_it_can() {
        let bounds = Area { low: DVec2::ZERO, high: DVec2::splat(200.0) };
        let wanted = [Wanted { text: "here".into(), at: DVec2::splat(100.0) }];
        let lines = [[DVec2::new(0.0, 100.0), DVec2::new(200.0, 100.0)]];
        let right = place(&wanted, 10.0, &[], &[], &bounds)[0].unwrap().area;
        assert!(right.clipped(lines[0]).is_some());
        assert!(place(&wanted, 10.0, &[], &lines, &bounds)[0].unwrap().area.clipped(lines[0]).is_none());
    }

    #[test]
    fn lines_end_at_the_sides() {
        let area = Area { low: DVec2::ZERO, high: DVec2::new(4.0, 2.0) };
        let line =
            |a: [f64; 2], b: [f64; 2]| area.clipped([a.into(), b.into()]).map(|l| l.map(|p| p.to_array()));
        assert_eq!(line([-2.0, 0.0], [6.0, 2.0]), Some([[0.0, 0.5], [4.0, 1.5]]));
        assert_eq!(line([1.0, 5.0], [1.0, -5.0]), Some([[1.0, 2.0], [1.0, 0.0]]));
        assert_eq!([line([-1.0, 1.0], [1.0, 4.0]), line([5.0, 0.0], [5.0, 1.0])], [None; 2]);
    }
}
