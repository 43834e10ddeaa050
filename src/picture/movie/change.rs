/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub left: usize,
    pub top: usize,
    pub width: usize,
    pub height: usize,
}

impl Rectangle {
    /// The bytes of its rows, in pictures of three bytes a pixel and `width` pixels a row.
    pub fn rows(self, width: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
        (self.top..self.top + self.height).map(move |y| {
            let first = 3 * (y * width + self.left);
            first..first + 3 * self.width
        })
    }
}

/// The smallest rectangle outside which two pictures are the same; where they are the same everywhere one pixel, for
/// GIF and APNG have no empty frames.
pub(super) fn changed(before: &[u8], after: &[u8], width: usize) -> Rectangle {
    let mut rows = before.chunks_exact(3 * width).zip(after.chunks_exact(3 * width)).enumerate();
    let differs = |(_, (a, b)): &(usize, (&[u8], &[u8]))| a != b;
    let (Some((top, _)), bottom) = (rows.clone().find(differs), rows.rfind(differs)) else {
        return Rectangle { left: 0, top: 0, width: 1, height: 1 };
    };
    let bottom = bottom.map_or(top, |(y, _)| y);
    let (mut left, mut right) = (3 * width, 0);
    for y in top..=bottom {
        let row = 3 * width * y..3 * width * (y + 1);
        let (a, b) = (&before[row.clone()], &after[row]);
        // Only what lies outside the span found so far.
        let differs = |&i: &usize| a[i] != b[i];
        left = (0..left).find(differs).unwrap_or(left);
        right = (right..3 * width).rfind(differs).unwrap_or(right);
    }
    Rectangle { left: left / 3, top, width: right / 3 - left / 3 + 1, height: bottom - top + 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smallest_rectangle() {
        let black = vec![0u8; 3 * 5 * 4];
        let with = |pixels: &[(usize, usize)]| {
            let mut picture = black.clone();
            for &(x, y) in pixels {
                picture[3 * (5 * y + x) + 1] = 9;
            }
            changed(&black, &picture, 5)
        };
        let rectangle = |left, top, width, height| Rectangle { left, top, width, height };
        assert_eq!(with(&[]), rectangle(0, 0, 1, 1));
        assert_eq!(with(&[(0, 0)]), rectangle(0, 0, 1, 1));
        assert_eq!(with(&[(4, 3)]), rectangle(4, 3, 1, 1));
        assert_eq!(with(&[(3, 1), (1, 2)]), rectangle(1, 1, 3, 2));
        assert_eq!(with(&[(0, 3), (4, 0)]), rectangle(0, 0, 5, 4));
        assert_eq!(with(&[(2, 1), (2, 3)]).rows(5).next(), Some(21..24));
    }
}
