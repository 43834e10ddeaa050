use super::axis::{Axis, Ruler};
use super::heat_map::{HeatMap, shade};
use super::labels::{Area, Wanted, place};
use super::marker::Marker;
use super::page::{Anchor, Ink, Page};
use super::words::wrapped;
use crate::drawing::text;
use glam::DVec2;

/// A pair of axes and what lies between them.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Panel {
    /// Above it.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// A number everywhere, below all else.
    pub map: Option<HeatMap>,
    /// What is drawn, in this order.
    pub series: Vec<Series>,
    /// Beneath it, a paragraph each.
    pub notes: Vec<String>,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Series {
    /// As it is called in the legend; without a name it is not there. Series of one name look alike throughout a figure.
    pub name: String,
    /// In the order in which a line goes through them.
    pub points: Vec<Point>,
    /// The line through them.
    pub stroke: Stroke,
    /// Whether each has a marker.
    pub marked: bool,
    /// Its colour, if it is not to have the next that is free.
    pub ink: Option<Ink>,
    /// Its marker, likewise.
    pub marker: Option<Marker>,
}

/// A point of a series.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Point {
    /// Along x.
    pub x: f64,
    /// Along y.
    pub y: f64,
    /// How far x spreads, if that is to be drawn.
    pub x_spread: Option<[f64; 2]>,
    /// How far y spreads.
    pub y_spread: Option<[f64; 2]>,
    /// Written beside it, where there is room.
    pub label: String,
    /// Whether its marker is only a rim, as of less weight than others.
    pub hollow: bool,
}

/// How a line goes from point to point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Stroke {
    /// There is none.
    #[default]
    None,
    /// Straight.
    Line,
    /// Straight, in dashes.
    Dashed,
    /// First to the right, then up or down, broad and pale: what a front of the best rules out lies beyond it.
    Front,
}

impl Series {
    /// Markers alone.
    pub fn points(name: impl Into<String>, points: Vec<Point>) -> Self {
        Self { name: name.into(), points, marked: true, ..Self::default() }
    }

    /// A line alone.
    pub fn line(name: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let points = points.into_iter().map(|[x, y]| Point { x, y, ..Point::default() }).collect();
        Self { name: name.into(), points, stroke: Stroke::Line, ..Self::default() }
    }
}

/// How a series looks, once that is settled.
pub(super) type Look = (Marker, Ink);

pub(super) const EM: f64 = 14.0;
pub(super) const SMALL: f64 = 12.0;
pub(super) const LEADING: f64 = 1.35;
/// A marker's radius.
pub(super) const RADIUS: f64 = 4.6;
pub(super) const BLACK: Ink = [30; 3];
pub(super) const GREY: Ink = [95; 3];
const GRID: Ink = [225; 3];
const FINE_GRID: Ink = [242; 3];
const FRAME: Ink = [120; 3];
const FRONT: Ink = [190; 3];
/// Of a colour bar: from the panel, and across.
const BAR: [f64; 2] = [12.0, 16.0];
const GAP: f64 = 6.0;

/// What a panel needs around the area between its axes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Margins {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

/// A panel with its place.
pub(super) struct Laid<'a> {
    panel: &'a Panel,
    area: Area,
    x: Ruler,
    y: Ruler,
}

impl Panel {
    /// What it needs around itself if it is so large between its axes.
    pub(super) fn margins(&self, size: DVec2) -> Margins {
        let laid = Laid::new(self, DVec2::ZERO, size);
        let line = LEADING * EM;
        let title = wrapped(&self.title, EM, size.x).len() as f64;
        let notes = self.notes.iter().flat_map(|note| wrapped(note, SMALL, size.x)).count() as f64;
        Margins {
            left: laid.y.widest() + GAP + if self.y.label.is_empty() { 0.0 } else { line + GAP },
            right: self.map.as_ref().map_or(0.0, |map| {
                let label = if map.label.is_empty() { 0.0 } else { line };
                BAR[0] + BAR[1] + GAP + laid.colors(map).widest() + label
            }),
            top: if self.title.is_empty() { GAP } else { title * line + 0.4 * EM },
            bottom: GAP
                + line * if self.x.label.is_empty() { 1.0 } else { 2.1 }
                + notes * LEADING * SMALL
                + if notes > 0.0 { GAP } else { 0.0 },
        }
    }

    /// Draws it with its upper left corner between the axes at `at`.
    pub(super) fn draw(&self, page: &mut Page, at: DVec2, size: DVec2, look: &dyn Fn(&Series) -> Look) {
        let laid = Laid::new(self, at, size);
        laid.draw_ground(page);
        laid.draw_axes(page);
        laid.draw_series(page, look);
        laid.draw_words(page);
    }

    /// All numbers along an axis.
    fn values(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        let ends = self.map.iter().flat_map(move |map| if axis == 0 { map.x } else { map.y });
        let points = self.series.iter().flat_map(|series| &series.points);
        let of_points = points.flat_map(move |p| {
            let (value, spread) = if axis == 0 { (p.x, p.x_spread) } else { (p.y, p.y_spread) };
            [value].into_iter().chain(spread.into_iter().flatten())
        });
        ends.chain(of_points)
    }

    /// An axis, which a map fills if nothing else is said.
    fn axis(&self, axis: usize) -> Axis {
        let of_map = self.map.as_ref().map(|map| if axis == 0 { map.x } else { map.y });
        let axis = if axis == 0 { &self.x } else { &self.y };
        Axis { range: axis.range.or(of_map), ..axis.clone() }
    }
}

impl Ruler {
    /// The widest of what is written along it.
    fn widest(&self) -> f64 {
        let texts = self.ticks().into_iter().filter_map(|tick| tick.text);
        let texts = texts.chain(self.zero.as_ref().map(|(_, text)| text.clone()));
        texts.map(|text| text::width(&text, SMALL)).fold(0.0, f64::max)
    }
}

impl<'a> Laid<'a> {
    fn new(panel: &'a Panel, at: DVec2, size: DVec2) -> Self {
        let area = Area { low: at, high: at + size };
        let x = Ruler::new(&panel.axis(0), panel.values(0), [area.low.x, area.high.x]);
        let y = Ruler::new(&panel.axis(1), panel.values(1), [area.high.y, area.low.y]);
        Self { panel, area, x, y }
    }

    fn colors(&self, map: &HeatMap) -> Ruler {
        let [from, to] = map.range_of_colors();
        let axis = Axis { scale: map.scale, ..Axis::default() }.from_to(from, to);
        Ruler::new(&axis, std::iter::empty(), [self.area.high.y, self.area.low.y])
    }

    fn draw_ground(&self, page: &mut Page) {
        let Area { low, high } = self.area;
        if let Some(map) = &self.panel.map {
            let [[x0, x1], [y0, y1]] = [(&self.x, map.x), (&self.y, map.y)]
                .map(|(ruler, ends)| ends.map(|v| ruler.at(v).unwrap_or(0.0)));
            let at = DVec2::new(x0, y1);
            let size = DVec2::new(x1 - x0, y0 - y1);
            page.items.push(super::Item::Cells { at, size, columns: map.columns, colors: map.colors() });
            self.draw_color_bar(page, map);
            return;
        }
        for is_written in [false, true] {
            let ink = if is_written { GRID } else { FINE_GRID };
            for tick in self.x.ticks().into_iter().filter(|tick| tick.text.is_some() == is_written) {
                page.line([DVec2::new(tick.at, low.y), DVec2::new(tick.at, high.y)], 1.0, ink);
            }
            for tick in self.y.ticks().into_iter().filter(|tick| tick.text.is_some() == is_written) {
                page.line([DVec2::new(low.x, tick.at), DVec2::new(high.x, tick.at)], 1.0, ink);
            }
        }
        if self.y.zero.is_some() {
            let at = self.y.start();
            page.dashed([DVec2::new(low.x, at), DVec2::new(high.x, at)], 1.0, 4.0, FRAME);
        }
        if self.x.zero.is_some() {
            let at = self.x.start();
            page.dashed([DVec2::new(at, low.y), DVec2::new(at, high.y)], 1.0, 4.0, FRAME);
        }
    }

    fn draw_color_bar(&self, page: &mut Page, map: &HeatMap) {
        const STEPS: usize = 64;
        let Area { low, high } = self.area;
        let left = high.x + BAR[0];
        let colors = (0..STEPS).rev().map(|i| shade((i as f64 + 0.5) / STEPS as f64)).collect();
        let (at, size) = (DVec2::new(left, low.y), DVec2::new(BAR[1], high.y - low.y));
        page.items.push(super::Item::Cells { at, size, columns: 1, colors });
        outline(page, &Area { low: at, high: at + size });
        let ruler = self.colors(map);
        let right = left + BAR[1];
        for tick in ruler.ticks() {
            let Some(text) = tick.text else { continue };
            page.line([DVec2::new(right, tick.at), DVec2::new(right + 4.0, tick.at)], 1.0, FRAME);
            page.text(&text, DVec2::new(right + GAP, tick.at + 0.36 * SMALL), SMALL, Anchor::Start, BLACK);
        }
        let middle = DVec2::new(right + GAP + ruler.widest() + LEADING * EM - 3.0, 0.5 * (low.y + high.y));
        page.text_upwards(&map.label, middle, fitting(&map.label, EM, high.y - low.y), BLACK);
    }

    fn draw_axes(&self, page: &mut Page) {
        let Area { low, high } = self.area;
        outline(page, &self.area);
        let mut end = f64::NEG_INFINITY;
        let zero = |ruler: &Ruler| ruler.zero.clone().map(|(at, text)| (at, Some(text)));
        let ticks = |ruler: &Ruler| -> Vec<(f64, Option<String>)> {
            zero(ruler).into_iter().chain(ruler.ticks().into_iter().map(|t| (t.at, t.text))).collect()
        };
        for (at, text) in ticks(&self.x) {
            let long = if text.is_some() { 5.0 } else { 3.0 };
            page.line([DVec2::new(at, high.y), DVec2::new(at, high.y + long)], 1.0, FRAME);
            let Some(text) = text else { continue };
            // What would run into the one before stays out.
            let half = 0.5 * text::width(&text, SMALL);
            if at - half > end + 4.0 {
                let y = high.y + GAP + SMALL;
                page.text(&text, DVec2::new(at, y), SMALL, Anchor::Middle, BLACK);
                end = at + half;
            }
        }
        for (at, text) in ticks(&self.y) {
            let long = if text.is_some() { 5.0 } else { 3.0 };
            page.line([DVec2::new(low.x - long, at), DVec2::new(low.x, at)], 1.0, FRAME);
            if let Some(text) = text {
                page.text(&text, DVec2::new(low.x - GAP - 1.0, at + 0.36 * SMALL), SMALL, Anchor::End, BLACK);
            }
        }
        let (x, y) = (&self.panel.x.label, &self.panel.y.label);
        let below = high.y + GAP + SMALL + LEADING * EM;
        page.text(
            x,
            DVec2::new(0.5 * (low.x + high.x), below),
            fitting(x, EM, high.x - low.x),
            Anchor::Middle,
            BLACK,
        );
        let beside = low.x - 2.0 * GAP - self.y.widest() - 4.0;
        page.text_upwards(
            y,
            DVec2::new(beside, 0.5 * (low.y + high.y)),
            fitting(y, EM, high.y - low.y),
            BLACK,
        );
    }

    fn draw_words(&self, page: &mut Page) {
        let (Area { low, high }, panel) = (self.area, self.panel);
        let width = high.x - low.x;
        let title = wrapped(&panel.title, EM, width);
        for (i, line) in title.iter().enumerate() {
            let up = LEADING * EM * (title.len() - 1 - i) as f64 + 0.6 * EM;
            page.text(line, DVec2::new(low.x, low.y - up), EM, Anchor::Start, BLACK);
        }
        let mut y = high.y + 2.0 * GAP + LEADING * EM * if panel.x.label.is_empty() { 1.0 } else { 2.1 };
        for line in panel.notes.iter().flat_map(|note| wrapped(note, SMALL, width)) {
            y += LEADING * SMALL;
            page.text(&line, DVec2::new(low.x, y - 0.4 * SMALL), SMALL, Anchor::Start, GREY);
        }
    }

    fn place_of(&self, x: f64, y: f64) -> Option<DVec2> {
        Some(DVec2::new(self.x.at(x)?, self.y.at(y)?))
    }

    /// The segments of a line, as far as they are between the axes.
    fn segments(&self, series: &Series) -> Vec<[DVec2; 2]> {
        let places: Vec<Option<DVec2>> = series.points.iter().map(|p| self.place_of(p.x, p.y)).collect();
        let pairs = places.windows(2).filter_map(|pair| Some([pair[0]?, pair[1]?]));
        let parts = pairs.flat_map(|[a, b]| match series.stroke {
            Stroke::None => vec![],
            Stroke::Line | Stroke::Dashed => vec![[a, b]],
            Stroke::Front => {
                let corner = DVec2::new(b.x, a.y);
                vec![[a, corner], [corner, b]]
            }
        });
        parts.filter_map(|segment| self.area.clipped(segment)).collect()
    }

    fn draw_series(&self, page: &mut Page, look: &dyn Fn(&Series) -> Look) {
        let (mut lines, mut points, mut wanted) = (Vec::new(), Vec::new(), Vec::new());
        for series in &self.panel.series {
            let segments = self.segments(series);
            draw_line(page, series.stroke, joined(&segments), look(series).1);
            lines.extend(segments);
        }
        for series in &self.panel.series {
            let (marker, ink) = look(series);
            for point in &series.points {
                let Some(at) = self.place_of(point.x, point.y).filter(|at| self.holds(*at)) else { continue };
                if !point.label.is_empty() {
                    wanted.push((point.hollow, Wanted { text: point.label.clone(), at }, ink));
                }
                if series.marked {
                    for line in self.spreads(point, at) {
                        page.line(line, 1.2, ink);
                        lines.push(line);
                    }
                    marker.draw(page, at, RADIUS, !point.hollow, ink);
                    points.push(Area::around(at, DVec2::splat(1.3 * RADIUS)));
                }
            }
        }
        // Those of weight have the choice.
        wanted.sort_by_key(|(hollow, ..)| *hollow);
        let labels: Vec<Wanted> = wanted.iter().map(|(_, label, _)| label.clone()).collect();
        let placed = place(&labels, SMALL, &points, &lines, &self.area);
        for ((_, label, ink), placed) in wanted.iter().zip(placed) {
            let Some(placed) = placed else { continue };
            let Area { low, high } = placed.area;
            if placed.far {
                let end = label.at.clamp(low, high);
                page.line([label.at + (end - label.at).normalize_or_zero() * 1.3 * RADIUS, end], 0.7, *ink);
            }
            let base = DVec2::new(low.x + 2.0, 0.5 * (low.y + high.y) + 0.36 * SMALL);
            page.text(&label.text, base, SMALL, Anchor::Start, darker(*ink));
        }
    }

    fn holds(&self, at: DVec2) -> bool {
        self.area.holds(&Area { low: at, high: at })
    }

    /// How far a point spreads, as lines between the axes.
    fn spreads(&self, point: &Point, at: DVec2) -> impl Iterator<Item = [DVec2; 2]> {
        let across =
            |[a, b]: [f64; 2]| Some([DVec2::new(self.x.at(a)?, at.y), DVec2::new(self.x.at(b)?, at.y)]);
        let down =
            |[a, b]: [f64; 2]| Some([DVec2::new(at.x, self.y.at(a)?), DVec2::new(at.x, self.y.at(b)?)]);
        let lines = [point.x_spread.and_then(across), point.y_spread.and_then(down)];
        lines.map(|line| self.area.clipped(line?)).into_iter().flatten()
    }
}

/// Draws a line in its way, of which there are several where it is interrupted.
pub(super) fn draw_line(page: &mut Page, stroke: Stroke, lines: Vec<Vec<DVec2>>, ink: Ink) {
    for line in lines {
        match stroke {
            Stroke::None => {}
            Stroke::Line => page.line(line, 1.8, ink),
            Stroke::Dashed => page.dashed(line, 1.8, 5.0, ink),
            Stroke::Front => page.line(line, 5.0, FRONT),
        }
    }
}

/// Segments that follow each other, as lines.
fn joined(segments: &[[DVec2; 2]]) -> Vec<Vec<DVec2>> {
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    for &[a, b] in segments {
        match lines.last_mut() {
            Some(line) if line.last() == Some(&a) => line.push(b),
            _ => lines.push(vec![a, b]),
        }
    }
    lines
}

fn outline(page: &mut Page, Area { low, high }: &Area) {
    let corners = [*low, DVec2::new(high.x, low.y), *high, DVec2::new(low.x, high.y), *low];
    page.line(corners, 1.0, FRAME);
}

/// Letters small enough for a text to fit.
fn fitting(text: &str, em: f64, room: f64) -> f64 {
    em * (room / text::width(text, em).max(1.0)).min(1.0)
}

/// A colour for letters, which are thinner than markers.
fn darker(ink: Ink) -> Ink {
    ink.map(|v| (0.7 * f64::from(v)) as u8)
}
