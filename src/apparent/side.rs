/// The nodes of one side of a triangle that is being cut, kept in a list; both its ends included.
#[derive(Clone, Copy)]
pub(super) struct Side {
    /// Where in the list they begin.
    pub start: usize,
    pub pieces: usize,
    pub reversed: bool,
    /// How much of the tolerance a piece uses up; what the pieces were before they were rounded up.
    pub fill: f64,
}

impl Side {
    /// Where in the list the `k`th node is.
    pub fn node(self, k: usize) -> usize {
        self.start + if self.reversed { self.pieces - k } else { k }
    }

    /// From one node to another.
    pub fn part(self, from: usize, to: usize) -> Self {
        let start = self.node(from).min(self.node(to));
        Self { start, pieces: to - from, ..self }
    }

    /// Length, measured in tolerances.
    pub fn extent(self) -> f64 {
        self.fill * self.pieces as f64
    }

    /// From its other end.
    pub fn turned(self) -> Self {
        Self { reversed: !self.reversed, ..self }
    }

    /// Of three sides the one to halve first: the longest that has inner nodes.
    pub fn longest(sides: &[Self; 3]) -> Option<usize> {
        (0..3)
            .filter(|&i| sides[i].pieces > 1)
            .max_by(|&i, &j| sides[i].extent().total_cmp(&sides[j].extent()))
    }
}
