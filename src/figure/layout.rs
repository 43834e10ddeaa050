use super::marker::{INKS, Marker};
use super::page::{Anchor, Page};
use super::panel::{
    BLACK, EM, GREY, LEADING, Look, Margins, Panel, RADIUS, SMALL, Series, Stroke, draw_line,
};
use super::words::wrapped;
use crate::drawing::text;
use glam::DVec2;

/// Panels on a page, with what there is to say of all of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// At the top.
    pub title: String,
    /// Beneath it, a paragraph each.
    pub subtitle: Vec<String>,
    /// Row by row.
    pub rows: Vec<Vec<Panel>>,
    /// How large panels are between their axes, pixels across and down.
    pub panel_size: [f64; 2],
    /// At the bottom, a paragraph each.
    pub notes: Vec<String>,
}

impl Default for Figure {
    fn default() -> Self {
        let (title, subtitle, rows, notes) = Default::default();
        Self { title, subtitle, rows, panel_size: [420.0, 320.0], notes }
    }
}

const TITLE: f64 = 20.0;
const MARGIN: f64 = 18.0;
/// Between panels.
const GAP: f64 = 26.0;
/// A line in the legend.
const SAMPLE: f64 = 26.0;

impl Figure {
    /// Lays it out.
    pub fn page(&self) -> Page {
        let size = DVec2::from_array(self.panel_size);
        let margins: Vec<Vec<Margins>> =
            self.rows.iter().map(|row| row.iter().map(|panel| panel.margins(size)).collect()).collect();
        let columns: Vec<[f64; 2]> = (0..margins.iter().map(Vec::len).max().unwrap_or(0))
            .map(|c| {
                let column = || margins.iter().filter_map(|row| row.get(c));
                [column().map(|m| m.left).fold(0.0, f64::max), column().map(|m| m.right).fold(0.0, f64::max)]
            })
            .collect();
        let of_columns: f64 = columns.iter().map(|[left, right]| left + size.x + right).sum();
        let width = (2.0 * MARGIN + of_columns + GAP * columns.len().saturating_sub(1) as f64).max(360.0);
        let mut page = Page { title: self.title.clone(), ..Page::default() };
        let mut y = self.draw_head(&mut page, width);
        for (row, margins) in self.rows.iter().zip(&margins) {
            let highest = |of: fn(&Margins) -> f64| margins.iter().map(of).fold(0.0, f64::max);
            y += highest(|m| m.top);
            let mut x = MARGIN;
            for (panel, [left, right]) in row.iter().zip(&columns) {
                x += left;
                panel.draw(&mut page, DVec2::new(x, y), size, &|series| self.look(series));
                x += size.x + right + GAP;
            }
            y += size.y + highest(|m| m.bottom) + 0.5 * GAP;
        }
        for line in self.notes.iter().flat_map(|note| wrapped(note, SMALL, width - 2.0 * MARGIN)) {
            y += LEADING * SMALL;
            page.text(&line, DVec2::new(MARGIN, y), SMALL, Anchor::Start, GREY);
        }
        page.size = DVec2::new(width, y + MARGIN);
        page
    }

    /// Title, what is beneath it, and the legend; where all that ends.
    fn draw_head(&self, page: &mut Page, width: f64) -> f64 {
        let room = width - 2.0 * MARGIN;
        let mut y = MARGIN;
        for line in wrapped(&self.title, TITLE, room) {
            y += LEADING * TITLE;
            page.text(&line, DVec2::new(MARGIN, y - 0.35 * TITLE), TITLE, Anchor::Start, BLACK);
        }
        for line in self.subtitle.iter().flat_map(|text| wrapped(text, SMALL, room)) {
            y += LEADING * SMALL;
            page.text(&line, DVec2::new(MARGIN, y - 0.2 * SMALL), SMALL, Anchor::Start, GREY);
        }
        y += 0.4 * EM;
        let mut x = MARGIN;
        let legend = self.legend();
        for (i, series) in legend.iter().enumerate() {
            let wide = SAMPLE + 6.0 + text::width(&series.name, EM);
            if i == 0 || x + wide > width - MARGIN {
                (x, y) = (MARGIN, y + 1.5 * EM);
            }
            let (marker, ink) = self.look(series);
            let middle = y - 0.36 * EM;
            let [from, to] = [x, x + SAMPLE].map(|x| DVec2::new(x, middle));
            draw_line(page, series.stroke, vec![vec![from, to]], ink);
            if series.marked {
                marker.draw(page, 0.5 * (from + to), RADIUS, true, ink);
            }
            page.text(&series.name, DVec2::new(x + SAMPLE + 6.0, y), EM, Anchor::Start, BLACK);
            x += wide + 18.0;
        }
        y + 0.8 * EM
    }

    /// A series of each name.
    fn legend(&self) -> Vec<&Series> {
        let mut legend: Vec<&Series> = Vec::new();
        for series in self.rows.iter().flatten().flat_map(|panel| &panel.series) {
            if !series.name.is_empty() && !legend.iter().any(|known| known.name == series.name) {
                legend.push(series);
            }
        }
        legend
    }

    /// How a series looks: as it says, or by its place among those that do not say.
    fn look(&self, series: &Series) -> Look {
        let unsaid = self.legend().into_iter().filter(|s| s.ink.is_none() && s.stroke != Stroke::Front);
        let place = unsaid.take_while(|s| s.name != series.name).count();
        let marker = series.marker.unwrap_or(Marker::ALL[place % Marker::ALL.len()]);
        (marker, series.ink.unwrap_or(INKS[place % INKS.len()]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Axis, HeatMap, Item, Point, Scale};
    use super::*;

    fn figure() -> Figure {
        let points = |k: f64| {
            let point = |i: i32| Point {
                x: 2f64.powi(i),
                y: k * 10f64.powi(-i),
                label: format!("{i} px"),
                x_spread: Some([1.9f64.powi(i), 2.2f64.powi(i)]),
                hollow: i % 2 == 1,
                ..Point::default()
            };
            (0..6).map(point).collect()
        };
        let mut panel = Panel {
            title: "points <of> two kinds".into(),
            x: Axis::log("time, ms"),
            y: Axis::log("error, px").with_zero("0"),
            series: vec![Series::points("one", points(1.0)), Series::points("two", points(3.0))],
            notes: vec!["a note".into()],
            ..Panel::default()
        };
        panel.series[1].points[3].y = 0.0;
        let map = HeatMap {
            label: "relative error".into(),
            scale: Scale::Log,
            range: Some([1e-8, 1.0]),
            x: [1.0, 1e3],
            y: [0.0, 180.0],
            columns: 40,
            values: (0..1200).map(|i| 10f64.powf(-8.0 * f64::from(i) / 1200.0)).collect(),
        };
        let (x, y) = (Axis::log("γ"), Axis::linear("angle, °"));
        let line = Series::line("limit", [[1.0, 10.0], [1e4, 300.0]]);
        let heat =
            Panel { title: "a map".into(), x, y, map: Some(map), series: vec![line], notes: Vec::new() };
        Figure {
            title: "A figure".into(),
            subtitle: vec!["in several words".into()],
            rows: vec![vec![panel, heat]],
            notes: vec!["β = 0.9".into()],
            ..Figure::default()
        }
    }

    #[test]
    fn all_that_is_said_is_on_the_page_and_within_it() {
        let page = figure().page();
        let texts: Vec<&str> = page
            .items
            .iter()
            .filter_map(|item| if let Item::Text { text, .. } = item { Some(text.as_str()) } else { None })
            .collect();
        for text in [
            "A figure",
            "time, ms",
            "error, px",
            "one",
            "two",
            "limit",
            "a note",
            "5 px",
            "10⁻⁵",
            "0",
            "relative error",
        ] {
            assert!(texts.contains(&text), "{text} of {texts:?}");
        }
        for item in &page.items {
            let points = match item {
                Item::Line { points, .. } | Item::Area { corners: points, .. } => points.clone(),
                Item::Cells { at, size, .. } => vec![*at, *at + *size],
                Item::Text { at, text, em, anchor: Anchor::Start, .. } => {
                    vec![*at, *at + DVec2::new(text::width(text, *em), 0.0)]
                }
                Item::Text { at, .. } => vec![*at],
            };
            let inside = |p: &DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(page.size).all();
            assert!(points.iter().all(inside), "{item:?} of {:?}", page.size);
        }
    }

    #[test]
    fn series_of_one_name_look_alike_and_others_do_not() {
        let mut figure = figure();
        let looks: Vec<Look> =
            figure.rows.iter().flatten().flat_map(|p| &p.series).map(|s| figure.look(s)).collect();
        assert!(looks[0] != looks[1] && looks[1] != looks[2] && looks[0].1 != looks[1].1);
        let mut twin = figure.rows[0][0].series[1].clone();
        twin.points.clear();
        figure.rows[0][1].series.push(twin.clone());
        assert_eq!(figure.look(&twin), looks[1]);
        assert_eq!(figure.legend().len(), 3);
    }

    #[test]
    fn a_page_is_painted_as_large_as_asked_for() {
        let page = figure().page();
        let (width, height, pixels) = page.pixels(1.5).unwrap();
        assert_eq!([width, height], (1.5 * page.size).to_array().map(|v| v.ceil() as u32));
        assert_eq!(pixels.len() as u32, 3 * width * height);
        assert!(pixels[..3] == [255; 3] && pixels.iter().any(|v| *v < 60));
        assert!(Figure::default().page().pixels(1.0).is_some());
    }
}
