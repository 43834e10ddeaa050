use super::bounds::{Bounder, Rect};
use super::{BAND, Drawable};
use crate::film::Samples;
use crate::scene::Lens;
use rayon::prelude::*;

/// Which triangles each band of rows must look at, in drawing order.
pub(super) struct Bins {
    /// By task, then by band.
    tasks: Vec<Vec<Vec<Binned>>>,
    /// Number of the first triangle of each body; one more at the end.
    first: Vec<u32>,
}

/// A triangle and the columns it may cover.
#[derive(Clone, Copy)]
pub(super) struct Binned {
    /// Number of the triangle, counted through all bodies.
    pub triangle: u32,
    pub x: [u32; 2],
    pub y: [u32; 2],
}

/// Triangles binned as one task.
const TASK: usize = 1 << 15;

impl Bins {
    pub fn new(bodies: &[Drawable<'_>], lens: &Lens, samples: &Samples) -> Self {
        let Self { first, .. } = Self::unbinned(bodies);
        let bounder = Bounder::new(lens, samples.range());
        let bands = lens.height().div_ceil(BAND) as usize;
        let mut tasks = Vec::new();
        for (body, &start) in bodies.iter().zip(&first) {
            let screen: Vec<[f32; 2]> =
                body.seen.vertices.par_iter().with_min_len(4096).map(|&v| bounder.project(v)).collect();
            let chunks = body.seen.triangles.par_chunks(TASK).enumerate();
            let binned: Vec<_> = chunks
                .map(|(chunk, triangles)| {
                    let mut bins: Vec<Vec<Binned>> = vec![Vec::new(); bands];
                    for (i, triangle) in triangles.iter().enumerate() {
                        let corners = triangle.corners;
                        let rects = bounder.bounds(corners.map(|v| screen[v as usize]), || {
                            corners.map(|v| body.seen.vertices[v as usize])
                        });
                        let number = start + (chunk * TASK + i) as u32;
                        for Rect { x, y } in rects.into_iter().flatten() {
                            for band in &mut bins[(y[0] / BAND) as usize..=((y[1] - 1) / BAND) as usize] {
                                band.push(Binned { triangle: number, x, y });
                            }
                        }
                    }
                    bins
                })
                .collect();
            tasks.extend(binned);
        }
        Self { tasks, first }
    }

    /// The numbers alone, for who finds the triangles of a pixel by another way.
    pub fn unbinned(bodies: &[Drawable<'_>]) -> Self {
        let mut first = vec![0u32];
        for body in bodies {
            let last = first[first.len() - 1];
            first.push(last + body.seen.triangles.len() as u32);
        }
        Self { tasks: Vec::new(), first }
    }

    pub fn of_band(&self, band: u32) -> impl Iterator<Item = &Binned> {
        self.tasks.iter().flat_map(move |task| &task[band as usize])
    }

    /// The columns each body's triangles may cover in a band.
    pub fn columns(&self, band: u32, bodies: usize) -> Vec<[u32; 2]> {
        let mut columns = vec![[u32::MAX, 0]; bodies];
        for binned in self.of_band(band) {
            let [from, to] = &mut columns[self.locate(binned.triangle).0];
            *from = (*from).min(binned.x[0]);
            *to = (*to).max(binned.x[1]);
        }
        columns
    }

    /// Position in `bodies` and number within the body.
    #[inline]
    pub fn locate(&self, triangle: u32) -> (usize, usize) {
        let body = if self.first.len() == 2 { 0 } else { self.first.partition_point(|&f| f <= triangle) - 1 };
        (body, (triangle - self.first[body]) as usize)
    }
}
