use super::canvas::{Canvas, Ink, LIGHT, SHADE, polygon};
use super::{Shot, number, text};
use crate::color::{Coloring, OCTAVES, encoded, false_color};
use glam::DVec2;

/// How what is seen has become a picture: the exposure, the tone curve, or the scale of false colours; at the upper
/// left.
pub(super) fn draw(canvas: &mut Canvas, shot: &Shot<'_>) {
    let lines = lines(shot);
    let em = 0.8 * canvas.em();
    let left = canvas.margin();
    let mut y = canvas.margin() + em;
    let room = canvas.width() - 2.0 * canvas.margin();
    let scaled = shot.coloring == Coloring::Doppler;
    // Behind it all, legible on anything.
    let widest = lines.iter().map(|line| text::width(line, em).min(room)).fold(0.0, f64::max);
    let bar = if scaled { bar_width(canvas, em) } else { 0.0 };
    let bottom = y + 1.35 * em * (lines.len() - 1) as f64 + if scaled { 2.6 * em } else { 0.0 };
    let half = 0.5 * canvas.margin();
    let (from, to) = (DVec2::splat(half), DVec2::new(left + widest.max(bar) + half, bottom + half));
    if let Some(plate) = polygon(&[from, DVec2::new(to.x, from.y), to, DVec2::new(from.x, to.y)]) {
        canvas.fill(&plate, SHADE);
    }
    for line in lines {
        // What does not fit is smaller.
        let em = em * (room / text::width(&line, em)).min(1.0);
        text::write(canvas, &line, em, DVec2::new(left, y), LIGHT);
        y += 1.35 * em;
    }
    if scaled {
        scale(canvas, DVec2::new(left, y - 0.7 * em), em);
    }
}

fn lines(shot: &Shot<'_>) -> Vec<String> {
    let ev = shot.development.ev;
    let exposure = format!("{} EV, {}", number::signed(f64::from(ev), 2), shot.development.tone);
    match shot.coloring {
        Coloring::Doppler if ev == 0.0 => vec!["D = ν observed / ν emitted".into()],
        Coloring::Doppler => vec!["D = ν observed / ν emitted".into(), exposure],
        coloring => vec![format!("{coloring}, {exposure}")],
    }
}

fn bar_width(canvas: &Canvas, em: f64) -> f64 {
    (0.3 * canvas.width()).max(6.0 * em).min(canvas.width() - 2.0 * canvas.margin())
}

/// A bar of all false colours, by the logarithm of D, with its powers of two.
fn scale(canvas: &mut Canvas, left_top: DVec2, em: f64) {
    let width = bar_width(canvas, em);
    let (left, top, bottom) = (left_top.x, left_top.y, left_top.y + 0.8 * em);
    let right = left + width;
    let steps = 120;
    for step in 0..steps {
        let [from, to] = [step, step + 1].map(|i| left + width * f64::from(i) / f64::from(steps));
        let octave = OCTAVES * (2.0 * (f64::from(step) + 0.5) / f64::from(steps) - 1.0);
        let [r, g, b] = false_color(octave.exp2()).map(encoded);
        let ink: Ink = [r, g, b, 255];
        // A little wider, so that no gaps are seen between them.
        let corners = [(from, top), (to + 0.5, top), (to + 0.5, bottom), (from, bottom)];
        if let Some(path) = polygon(&corners.map(|(x, y)| DVec2::new(x.min(right), y))) {
            canvas.fill(&path, ink);
        }
    }
    for (octave, label) in [(-5.0, "1/32"), (-3.0, "1/8"), (-1.0, "1/2"), (1.0, "2"), (3.0, "8"), (5.0, "32")]
    {
        // In a narrow one, the ends and the middle ones make do.
        if width < 12.0 * em && (octave as i32).abs() == 3 {
            continue;
        }
        let em = 0.75 * em;
        let half = 0.5 * text::width(label, em);
        let at = left + width * 0.5 * (1.0 + octave / OCTAVES);
        let start = (at - half).clamp(left, right - 2.0 * half);
        text::write(canvas, label, em, DVec2::new(start, bottom + 1.1 * em), LIGHT);
    }
}
