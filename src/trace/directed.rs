use super::beam::RAYS;
use glam::DVec3;

/// Rays from the origin of a beam, side by side.
#[repr(align(64))]
#[derive(Clone, Copy)]
pub(super) struct Directed {
    pub count: usize,
    pub directions: [[f64; RAYS]; 3],
    /// 1/s of what they are known to hit already, s in units of the direction; 0 for nothing.
    pub nearness: [f64; RAYS],
    /// Doppler factors of what they would hit.
    pub dopplers: [f64; RAYS],
}

impl Default for Directed {
    fn default() -> Self {
        Self { count: 0, directions: [[0.0; RAYS]; 3], nearness: [0.0; RAYS], dopplers: [1.0; RAYS] }
    }
}

impl Directed {
    #[inline]
    pub fn direction(&self, i: usize) -> DVec3 {
        DVec3::from_array(self.directions.each_ref().map(|c| c[i]))
    }

    /// One more, of other rays.
    pub fn push_of(&mut self, other: &Self, i: usize) {
        self.dopplers[self.count] = other.dopplers[i];
        self.push(other.direction(i), other.nearness[i]);
    }

    /// One more.
    pub fn push(&mut self, direction: DVec3, nearness: f64) {
        let i = self.count;
        self.count += 1;
        for k in 0..3 {
            self.directions[k][i] = direction[k];
        }
        self.nearness[i] = nearness;
    }

    /// The way that all of them face; none if they differ.
    pub fn facing(&self) -> Option<(usize, bool)> {
        let (longest, backward) = facing(self.direction(0));
        let sign = if backward { -1.0 } else { 1.0 };
        let [along, first, second] = [0, 1, 2].map(|k| &self.directions[(longest + k) % 3][..self.count]);
        let mut all = true;
        for i in 0..along.len() {
            let size = sign * along[i];
            // Of two as long, facing() takes the first, which is no matter here.
            all &= (size >= first[i].abs()) & (size >= second[i].abs()) & (size > 0.0);
        }
        all.then_some((longest, backward))
    }
}

/// The longest component of a direction, and whether it is negative: rays that agree in that can be one beam.
#[inline]
pub(super) fn facing(direction: DVec3) -> (usize, bool) {
    let size = direction.abs();
    let longest = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    (longest, direction[longest] < 0.0)
}
