use super::{Compared, Found};
use serde_json::{Value, json};
use terrell::measure::{Disagreement, Faces, Figures, Radiance, Worst};

/// A scene's comparison as JSON.
pub fn told(compared: &Compared) -> Value {
    json!({
        "scene": compared.name,
        "size": compared.size,
        "color": compared.options.coloring.to_string(),
        "exposure_ev": compared.development.ev,
        "tone": compared.development.tone.to_string(),
        "tolerance_px": compared.options.tolerance,
        "samples": compared.options.samples,
        "reference": compared.against,
        "reference_file": compared.reference_file,
        "reference_has": compared.known.map(|known| json!({
            "body": known.body, "face": known.face, "distance": known.distance, "doppler": known.doppler,
        })),
        "pixels_left_out": compared.left_out,
        "triangles": compared.triangles,
        "runs": compared.repeats,
        "threads": rayon::current_num_threads(),
        "methods": compared.rows.iter().map(|row| {
            let mut told = json!({ "method": row.way.name, "about": row.way.about });
            match &row.drawn {
                Err(reason) => told["failed"] = json!(reason),
                Ok(drawn) => {
                    told["pieces"] = json!(drawn.pieces);
                    told["seconds"] = json!({
                        "once_a_scene": drawn.once.as_secs_f64(),
                        "a_picture": drawn.picture.as_secs_f64(),
                    });
                    told["difference"] = drawn.found.as_ref().map_or(Value::Null, found);
                }
            }
            told
        }).collect::<Value>(),
        "notes": compared.notes,
    })
}

fn found(found: &Found) -> Value {
    let mut told = figures(&found.comparison.whole);
    told["flip"] = json!({ "mean": found.perceived.mean, "worst": found.perceived.worst });
    told["faces_by"] = json!(match found.comparison.faces {
        Faces::Numbered => Some("number"),
        Faces::Renumbered => Some("what most of their pixels see"),
        Faces::Unknown => None,
    });
    told["inner"] = json!(found.comparison.inner.as_ref().map(figures));
    told
}

fn figures(figures: &Figures) -> Value {
    json!({
        "pixels": figures.pixels,
        "silhouette": figures.silhouette.as_ref().map(disagreement),
        "edges": figures.edges.as_ref().map(disagreement),
        "distance": figures.distance.map(worst),
        "doppler": figures.doppler.map(worst),
        "radiance": radiance(figures.radiance),
        "radiance_same_face": figures.radiance_same_face.map(radiance),
        "pixels_not_finite": figures.not_finite,
    })
}

fn disagreement(found: &Disagreement) -> Value {
    json!({ "pixels": found.pixels, "beyond_a_pixel": found.beyond, "first_beyond": found.where_beyond })
}

fn worst(worst: Worst) -> Value {
    json!({ "worst_relative": worst.relative, "at": worst.at })
}

fn radiance(light: Radiance) -> Value {
    json!({
        "relative_rms": light.relative_rms,
        "worst_over_peak": light.worst,
        "at": light.at,
        "peak": light.peak,
    })
}
