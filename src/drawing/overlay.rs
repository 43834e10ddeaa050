use super::canvas::{Canvas, LIGHT, polylines};
use super::curves::Curves;
use super::mesh_edges::MeshEdges;
use super::scale_bar::ScaleBar;
use super::{Caption, Edges, axes, caption, legend};
use crate::apparent::Field;
use crate::color::Coloring;
use crate::film::Film;
use crate::relativity::ApparentMap;
use crate::scene::{Camera, Mesh, Projection, Scene};
use crate::tone::Development;
use glam::DVec2;
use std::sync::Arc;

/// What to draw on top of pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OverlayOptions {
    /// Edges of the meshes, as the curves they look like; what is hidden is not drawn.
    pub edges: Option<Edges>,
    /// The world's axes and the bodies' directions of motion, as the camera has them, in a corner.
    pub axes: bool,
    /// A bar of a round number of length units. It is as long as that length is seen at right angles to the line of
    /// sight, in the middle of the picture, at the apparent distance of what is seen there (or, if nothing is, of
    /// the nearest body whose middle is in the picture); the distance is written beside it.
    pub scale_bar: bool,
    /// Exposure and tone curve, or the scale of false colours, at the upper left.
    pub legend: bool,
    /// Text at the lower left.
    pub caption: Option<Caption>,
}

/// A panorama has no scale bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a panorama has no one scale, so it cannot have a scale bar; use a pinhole or a fisheye")]
pub struct NoScale;

/// What is drawn on top of the pictures of one scene: made once, drawn on every frame.
#[derive(Clone, Debug)]
pub struct Overlay {
    options: OverlayOptions,
    meshes: Vec<(Arc<Mesh>, Arc<MeshEdges>)>,
}

/// A picture that was taken, with what it shows.
#[derive(Clone, Copy, Debug)]
pub struct Shot<'a> {
    /// What was there.
    pub scene: &'a Scene,
    /// From where it was seen.
    pub camera: &'a Camera,
    /// What was seen.
    pub film: &'a Film,
    /// How far the film's outlines may be from where they belong, in pixels: the tolerance it was drawn with.
    pub tolerance: f64,
    /// What its colours are.
    pub coloring: Coloring,
    /// How they became a picture.
    pub development: Development,
}

/// Edges' width over that of other lines.
const EDGE: f64 = 1.2;

impl OverlayOptions {
    /// Whether nothing is to be drawn.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl Overlay {
    /// Finds the edges of the scene's meshes.
    ///
    /// # Errors
    /// If a scale bar is asked for in a panorama.
    pub fn new(scene: &Scene, options: OverlayOptions) -> Result<Self, NoScale> {
        if options.scale_bar && scene.view.projection == Projection::Panorama {
            return Err(NoScale);
        }
        let mut overlay = Self { options, meshes: Vec::new() };
        if let Some(which) = overlay.options.edges {
            for body in &scene.bodies {
                let edges = overlay.edges_of(&body.mesh, which);
                overlay.meshes.push((body.mesh.clone(), edges));
            }
        }
        Ok(overlay)
    }

    /// What is drawn.
    pub fn options(&self) -> &OverlayOptions {
        &self.options
    }

    fn edges_of(&self, mesh: &Arc<Mesh>, which: Edges) -> Arc<MeshEdges> {
        let known = self.meshes.iter().find(|(known, _)| Arc::ptr_eq(known, mesh));
        known.map_or_else(|| Arc::new(MeshEdges::new(mesh, which)), |(_, edges)| edges.clone())
    }

    /// Draws on a finished picture: 8-bit sRGB, three bytes a pixel, row by row from the top, as
    /// [`pixels_srgb`](crate::picture::pixels_srgb) makes of the film. Returns what could not be drawn and why, for
    /// people to read.
    ///
    /// # Panics
    /// If there are not three bytes for each of the film's pixels.
    pub fn draw(&self, pixels: &mut [u8], shot: &Shot<'_>) -> Vec<String> {
        let film = shot.film;
        assert_eq!(pixels.len(), 3 * film.body.len(), "three bytes a pixel");
        let mut notes = Vec::new();
        let Some(mut canvas) = Canvas::new(film.width, film.height, pixels) else { return notes };
        if let Some(which) = self.options.edges {
            self.draw_edges(&mut canvas, shot, which);
        }
        if self.options.axes {
            axes::draw(&mut canvas, shot.scene, shot.camera);
        }
        if self.options.legend {
            legend::draw(&mut canvas, shot);
        }
        let mut room = canvas.width() - 2.0 * canvas.margin();
        if self.options.scale_bar {
            match ScaleBar::of(shot) {
                Some(bar) => room -= bar.draw(&mut canvas) + canvas.margin(),
                None => notes.push("no scale bar: there is nothing in the picture to be measured".to_owned()),
            }
        }
        if let Some(caption) = &self.options.caption {
            caption::draw(&mut canvas, &caption.text(shot.scene, shot.camera), room);
        }
        canvas.write_to(pixels);
        notes
    }

    fn draw_edges(&self, canvas: &mut Canvas, shot: &Shot<'_>, which: Edges) {
        let lens = &shot.camera.lens;
        let field = Field::new(lens);
        let mut lines: Vec<Vec<DVec2>> = Vec::new();
        for (index, body) in shot.scene.bodies.iter().enumerate() {
            let map = ApparentMap::new(&body.motion, &shot.camera.observer);
            // Posed, it has the same triangles.
            let mesh = body.mesh_seen(&shot.camera.observer);
            let curves = Curves {
                film: shot.film,
                lens,
                field: &field,
                tolerance: shot.tolerance,
                body: index,
                mesh: &mesh,
                map: &map,
            };
            lines.extend(curves.seen(&self.edges_of(&body.mesh, which)));
        }
        if let Some(path) = polylines(lines.iter().map(Vec::as_slice)) {
            canvas.stroke_shaded(&path, EDGE * canvas.line(), LIGHT);
        }
    }
}
