use super::source::{Source, did_you_mean};
use super::tables::{AnimationTable, KeyTable};
use super::{SceneError, read_aim};
use crate::scene::{Animation, AnimationError, CameraPath, Key, Pace, PathError, Scene};
use toml::Spanned;

/// How the scene is filmed; what it does not say is as [usual](Animation::usual).
pub(super) fn read_animation(
    source: &Source<'_>,
    table: &AnimationTable,
    scene: &Scene,
) -> Result<Animation, SceneError> {
    let path = if table.key.is_empty() { None } else { Some(read_path(source, &table.key, scene)?) };
    let pace = match (&table.time, &table.apparent, &table.range) {
        (Some(time), Some(_), _) | (Some(time), _, Some(_)) => {
            return Err(
                source.at(time, "time goes by the clock, apparent and range by positions; one is enough")
            );
        }
        (Some(time), None, None) => Some(Pace::Clock(range(source, "time", time)?)),
        (None, Some(word), Some(place)) => {
            let name = word.get_ref();
            let names = || scene.bodies.iter().map(|b| b.name.as_str());
            if !names().any(|n| n == name) {
                let hint = did_you_mean(name, names().collect::<Vec<_>>());
                return Err(source.at(word, format!("apparent: there is no body '{name}'; {hint}")));
            }
            Some(Pace::Apparent { body: name.clone(), range: range(source, "range", place)? })
        }
        (None, Some(word), None) => {
            return Err(
                source.at(word, "apparent needs a range: lengths before and beyond abreast, as in [-6, 6]")
            );
        }
        (None, None, Some(place)) => {
            return Err(source.at(place, "a range needs a body: apparent = \"NAME\""));
        }
        (None, None, None) => path.as_ref().map(|p| Pace::Clock(p.clock_range())),
    };
    if let (Some(Pace::Apparent { .. }), Some(key)) = (&pace, table.key.first()) {
        return Err(source.at(&key.time, AnimationError::PathByPosition));
    }
    let usual = Animation::usual(scene);
    let usual_pace =
        || usual.clone().map(|u| u.pace).map_err(|e| source.fault(None, format!("[animation]: {e}")));
    let animation = Animation {
        frames: table.frames.as_ref().map_or(120, |n| *n.get_ref()),
        fps: table.fps.as_ref().map_or(Ok(30.0), |fps| source.finite("fps", fps))?,
        pace: pace.map_or_else(usual_pace, Ok)?,
        path,
    };
    if let Some(fps) = table.fps.as_ref().filter(|fps| *fps.get_ref() <= 0.0) {
        return Err(source.at(fps, "fps must be above 0"));
    }
    if let Some(frames) = table.frames.as_ref().filter(|n| *n.get_ref() == 0) {
        return Err(source.at(frames, AnimationError::Frames(0)));
    }
    Ok(animation)
}

fn range(source: &Source<'_>, key: &str, place: &Spanned<[f64; 2]>) -> Result<[f64; 2], SceneError> {
    let range = *place.get_ref();
    if range.iter().all(|v| v.abs() < 1e100) {
        Ok(range)
    } else {
        Err(source.at(place, format!("{key} = [{}, {}] is not finite or beyond 1e100", range[0], range[1])))
    }
}

fn read_path(source: &Source<'_>, tables: &[KeyTable], scene: &Scene) -> Result<CameraPath, SceneError> {
    if scene.view.celerity.moves() {
        let message = "the camera has a velocity and a path; one is enough";
        return Err(source.at(&tables[0].time, message));
    }
    let key = |table: &KeyTable| {
        Ok(Key {
            time: source.finite("time", &table.time)?,
            position: match &table.position {
                Some(position) => source.vector("position", position)?,
                None => scene.view.event.position(),
            },
            aim: read_aim(source, &table.look_at, &table.forward)?.unwrap_or(scene.view.aim),
            up: table.up.as_ref().map_or(Ok(scene.view.up), |up| source.vector("up", up))?,
            fov_deg: table.fov_deg.as_ref().map(|fov| source.finite("fov_deg", fov)).transpose()?,
        })
    };
    let keys = tables.iter().map(key).collect::<Result<_, SceneError>>()?;
    CameraPath::new(keys).map_err(|e| {
        let index = match e {
            PathError::TooFew => 0,
            PathError::Order(i) | PathError::Aim(i) | PathError::TooFast(i, _) => i,
        };
        source.at(&tables[index].time, format!("key: {e}"))
    })
}
