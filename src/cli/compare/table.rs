use super::{Compared, Row};
use std::time::Duration;
use terrell::measure::{Disagreement, Faces, Figures};

const HEADS: [&str; 10] = [
    "method",
    "silhouette px (beyond)",
    "edge px (beyond)",
    "distance",
    "Doppler",
    "light RMS",
    "light worst",
    "same face",
    "FLIP",
    "once + a picture",
];

/// Before the table: the scene, and what it is compared with.
pub fn title(compared: &Compared) -> String {
    let mut line = format!("{}; against {}", compared.what, compared.against);
    if compared.faces() == Some(Faces::Renumbered) {
        line.push_str(", whose faces are numbered otherwise");
    }
    line
}

/// A scene's table, aligned, for a terminal.
pub fn plain(compared: &Compared) -> String {
    let mut lines: Vec<Vec<String>> = vec![HEADS.map(str::to_owned).to_vec()];
    lines.extend(compared.rows.iter().flat_map(cells));
    let columns = HEADS.len();
    let width = |c: usize| lines.iter().filter(|l| l.len() == columns).map(|l| l[c].chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|c| width(c).unwrap_or(0)).collect();
    let mut text = String::new();
    for line in &lines {
        let mut written = String::new();
        for (i, cell) in line.iter().enumerate() {
            let pad = " ".repeat(widths[i].saturating_sub(cell.chars().count()));
            // Names to the left, numbers to the right; a reason is as long as it is.
            let reason = line.len() < columns && i > 0;
            written += &if i == 0 || reason { format!("{cell}{pad}") } else { format!("  {pad}{cell}") };
            if reason || (i == 0 && line.len() < columns) {
                written += "  ";
            }
        }
        text.push_str(written.trim_end());
        text.push('\n');
    }
    text
}

/// All scenes' table, for a page in Markdown.
pub fn markdown(all: &[Compared]) -> String {
    let mut text =
        format!("| scene | {} |\n|---|---|{}\n", HEADS.join(" | "), "--:|".repeat(HEADS.len() - 1));
    for compared in all {
        for row in &compared.rows {
            for mut cells in cells(row) {
                cells.resize(HEADS.len(), String::new());
                text.push_str(&format!("| {} | {} |\n", compared.name, cells.join(" | ")));
            }
        }
    }
    text
}

fn cells(row: &Row) -> Vec<Vec<String>> {
    let name = row.way.name.to_owned();
    let drawn = match &row.drawn {
        Ok(drawn) => drawn,
        Err(reason) => return vec![vec![name, reason.clone()]],
    };
    let times = times(drawn.once, drawn.picture);
    let Some(found) = &drawn.found else {
        let mut cells = vec![name, "reference".to_owned()];
        cells.resize(HEADS.len() - 1, "–".to_owned());
        cells.push(times);
        return vec![cells];
    };
    let mut lines = vec![figures(name, &found.comparison.whole, number(found.perceived.mean), times)];
    if let Some(inner) = &found.comparison.inner {
        let name = format!("{}, inner pixels", row.way.name);
        lines.push(figures(name, inner, "–".into(), "–".into()));
    }
    lines
}

fn figures(name: String, figures: &Figures, flip: String, times: String) -> Vec<String> {
    let Figures { silhouette, edges, distance, doppler, radiance, radiance_same_face, .. } = figures;
    vec![
        name,
        pixels(silhouette),
        pixels(edges),
        or_dash(distance.map(|worst| worst.relative)),
        or_dash(doppler.map(|worst| worst.relative)),
        number(radiance.relative_rms),
        number(radiance.worst),
        or_dash(radiance_same_face.map(|light| light.worst)),
        flip,
        times,
    ]
}

fn or_dash(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), number)
}

/// "12 (0)".
fn pixels(found: &Option<Disagreement>) -> String {
    found.as_ref().map_or_else(|| "–".into(), |found| format!("{} ({})", found.pixels, found.beyond))
}

/// Two digits: "0.012", "1.2e-7".
pub fn number(value: f64) -> String {
    match value {
        0.0 => "0".into(),
        v if v.is_infinite() => "∞".into(),
        v if v.abs() < 1e-3 => format!("{v:.1e}"),
        v if v.abs() < 0.1 => format!("{v:.4}"),
        v => format!("{v:.3}"),
    }
}

/// "0.4 + 12.1 ms".
pub fn times(once: Duration, picture: Duration) -> String {
    let ms = |time: Duration| 1e3 * time.as_secs_f64();
    format!("{:.1} + {:.1} ms", ms(once), ms(picture))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let all = [0.0, 1.24e-7, 0.0123, 0.5, f64::INFINITY].map(number);
        assert_eq!(all, ["0", "1.2e-7", "0.0123", "0.500", "∞"]);
        assert_eq!(times(Duration::from_micros(440), Duration::from_millis(12)), "0.4 + 12.0 ms");
    }
}
