use glam::DVec2;

/// sRGB.
pub type Ink = [u8; 3];

/// Where a text is, from its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning is there.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// What is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// An open line.
    Line {
        /// Its corners.
        points: Vec<DVec2>,
        /// How wide it is.
        width: f64,
        /// How long its dashes and the gaps between them are; none of a whole line.
        dash: Option<f64>,
        /// Its colour.
        ink: Ink,
    },
    /// A filled polygon.
    Area {
        /// Its corners.
        corners: Vec<DVec2>,
        /// Its colour.
        ink: Ink,
    },
    /// A line of text.
    Text {
        /// What it says.
        text: String,
        /// On its base line.
        at: DVec2,
        /// The size of its letters, pixels an em.
        em: f64,
        /// Which part of it is there.
        anchor: Anchor,
        /// Whether it runs upwards rather than to the right.
        upwards: bool,
        /// Its colour; around the letters it is white.
        ink: Ink,
    },
    /// A table of coloured rectangles.
    Cells {
        /// Upper left corner.
        at: DVec2,
        /// Across and down.
        size: DVec2,
        /// How many stand beside each other.
        columns: usize,
        /// Row by row from the top.
        colors: Vec<Ink>,
    },
}

/// A figure laid out: what is drawn where, in pixels from the upper left, on white; later items cover earlier ones.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Page {
    /// Pixels across and down.
    pub size: DVec2,
    /// What it is, for who cannot see it.
    pub title: String,
    /// What is on it.
    pub items: Vec<Item>,
}

impl Page {
    pub(super) fn line(&mut self, points: impl Into<Vec<DVec2>>, width: f64, ink: Ink) {
        self.items.push(Item::Line { points: points.into(), width, dash: None, ink });
    }

    pub(super) fn dashed(&mut self, points: impl Into<Vec<DVec2>>, width: f64, dash: f64, ink: Ink) {
        self.items.push(Item::Line { points: points.into(), width, dash: Some(dash), ink });
    }

    pub(super) fn area(&mut self, corners: impl Into<Vec<DVec2>>, ink: Ink) {
        self.items.push(Item::Area { corners: corners.into(), ink });
    }

    pub(super) fn text(&mut self, text: &str, at: DVec2, em: f64, anchor: Anchor, ink: Ink) {
        self.items.push(Item::Text { text: text.to_owned(), at, em, anchor, upwards: false, ink });
    }

    pub(super) fn text_upwards(&mut self, text: &str, at: DVec2, em: f64, ink: Ink) {
        let anchor = Anchor::Middle;
        self.items.push(Item::Text { text: text.to_owned(), at, em, anchor, upwards: true, ink });
    }
}
