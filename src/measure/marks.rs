use super::{Corners, Reference};
use crate::film::{Film, NOTHING};
use std::collections::HashMap;

/// Whether a film sees in a pixel what the reference sees there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// The same body and the same face, as far as they are known.
    Same,
    /// Another body, which the reference sees in one of the eight pixels around, or where its corners see several: an
    /// outline is off by a pixel at most.
    Silhouette,
    /// Another body, which the reference sees in none of the nine pixels, nor do the pixel's corners see several.
    BeyondSilhouette,
    /// Another face of the same body, which the reference sees in one of the eight pixels around, or where its corners see
    /// several.
    Edge,
    /// Another face of the same body, which the reference sees in none of the nine pixels, nor do the pixel's corners see
    /// several.
    BeyondEdge,
    /// The reference has no finite numbers there.
    LeftOut,
}

impl Mark {
    /// Whether both see the same body.
    pub fn is_same_body(self) -> bool {
        matches!(self, Self::Same | Self::Edge | Self::BeyondEdge)
    }
}

/// How faces are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Faces {
    /// By their numbers.
    Numbered,
    /// The reference has other numbers: each triangle stands for that face of the reference which most of its pixels
    /// see, be it a polygon of several triangles. Where triangles are about a pixel large this says nothing.
    Renumbered,
    /// Not at all: the reference has none.
    Unknown,
}

/// No face of the reference: of a triangle that is seen only where the reference sees other bodies.
const NONE: i32 = i32::MIN;

/// The mark of every pixel of two films of one size.
pub(super) fn marks(reference: &Reference, film: &Film) -> (Vec<Mark>, Faces) {
    let left_out = |i: usize| reference.left_out[i];
    if !reference.known.body {
        let mark = |i| if left_out(i) { Mark::LeftOut } else { Mark::Same };
        return ((0..film.body.len()).map(mark).collect(), Faces::Unknown);
    }
    let (faces, how) = faces_as_in(reference, film);
    let expected = &reference.film;
    let parted = |same: fn(&Corners) -> &Vec<bool>, i: usize| {
        reference.corners.as_ref().is_some_and(|corners| !same(corners)[i])
    };
    let mark = |i: usize| {
        if left_out(i) {
            return Mark::LeftOut;
        }
        let is_near = |same: &dyn Fn(usize) -> bool| around(film, i).any(|n| !left_out(n) && same(n));
        if film.body[i] != expected.body[i] {
            let near =
                parted(|corners| &corners.same_body, i) || is_near(&|n| expected.body[n] == film.body[i]);
            return if near { Mark::Silhouette } else { Mark::BeyondSilhouette };
        }
        if how == Faces::Unknown || film.body[i] == NOTHING || faces[i] == expected.face[i] {
            return Mark::Same;
        }
        let is_it = |n: usize| expected.body[n] == film.body[i] && expected.face[n] == faces[i];
        let near = parted(|corners| &corners.same_face, i) || is_near(&is_it);
        if near { Mark::Edge } else { Mark::BeyondEdge }
    };
    ((0..film.body.len()).map(mark).collect(), how)
}

/// The pixels around one, and it itself.
fn around(film: &Film, pixel: usize) -> impl Iterator<Item = usize> {
    let (width, height) = (film.width as usize, film.height as usize);
    let (x, y) = (pixel % width, pixel / width);
    let side = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    side(y, height).flat_map(move |y| side(x, width).map(move |x| y * width + x))
}

/// The film's faces in the reference's numbers.
fn faces_as_in(reference: &Reference, film: &Film) -> (Vec<i32>, Faces) {
    let expected = &reference.film;
    if !reference.known.face {
        return (Vec::new(), Faces::Unknown);
    }
    let both =
        |i: usize| !reference.left_out[i] && film.body[i] != NOTHING && film.body[i] == expected.body[i];
    let seen = (0..film.body.len()).filter(|&i| both(i));
    let (mut all, mut equal) = (0, 0);
    let mut votes: HashMap<(i32, i32), HashMap<i32, usize>> = HashMap::new();
    for i in seen {
        all += 1;
        equal += usize::from(film.face[i] == expected.face[i]);
        if reference.renumbered {
            *votes.entry((film.body[i], film.face[i])).or_default().entry(expected.face[i]).or_default() += 1;
        }
    }
    // Numbered otherwise, few are equal by chance.
    if !reference.renumbered || 2 * equal >= all {
        return (film.face.clone(), Faces::Numbered);
    }
    // Of several that are as frequent, the least: always the same.
    let most = |faces: &HashMap<i32, usize>| {
        faces.iter().max_by_key(|&(&face, &pixels)| (pixels, std::cmp::Reverse(face))).map_or(NONE, |f| *f.0)
    };
    let stands_for: HashMap<_, _> = votes.iter().map(|(triangle, faces)| (*triangle, most(faces))).collect();
    let face = |i: usize| stands_for.get(&(film.body[i], film.face[i])).copied().unwrap_or(NONE);
    ((0..film.body.len()).map(face).collect(), Faces::Renumbered)
}
