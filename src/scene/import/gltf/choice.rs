//! Which of a file's scenes and cameras.

use crate::scene::View;
use crate::scene::file::did_you_mean;
use std::collections::HashSet;

/// A camera of the scene, as it is met in the tree.
pub(super) struct Found<'a> {
    /// What its node is called, and it itself.
    pub names: [Option<&'a str>; 2],
    /// What it sees; none of one without perspective.
    pub view: Option<View>,
    /// Whether it hangs on something animated.
    pub animated: bool,
}

/// The scene asked for; else the default one, else the first.
pub(super) fn scene<'a>(
    file: &'a gltf::Gltf,
    wanted: Option<&str>,
) -> Result<Option<gltf::Scene<'a>>, String> {
    let Some(wanted) = wanted else {
        return Ok(file.default_scene().or_else(|| file.scenes().next()));
    };
    let names: Vec<_> = file.scenes().map(|scene| [scene.name(), None]).collect();
    Ok(file.scenes().nth(chosen("scene", wanted, &names)?))
}

/// The camera asked for; else the first with perspective.
pub(super) fn camera<'a, 'b>(
    cameras: &'b [Found<'a>],
    wanted: Option<&str>,
) -> Result<Option<&'b Found<'a>>, String> {
    let Some(wanted) = wanted else {
        return Ok(cameras.iter().find(|camera| camera.view.is_some()));
    };
    let names: Vec<_> = cameras.iter().map(|camera| camera.names).collect();
    let found = &cameras[chosen("camera", wanted, &names)?];
    if found.view.is_none() {
        return Err(format!("camera '{wanted}' has no perspective, which is needed; choose another"));
    }
    Ok(Some(found))
}

/// The index of what is called so, or has that number from 1.
fn chosen(what: &str, wanted: &str, all: &[[Option<&str>; 2]]) -> Result<usize, String> {
    let is_called = |names: &[Option<&str>; 2]| names.contains(&Some(wanted));
    let number: Option<usize> = wanted.parse().ok();
    let numbered = number.filter(|n| (1..=all.len()).contains(n)).map(|n| n - 1);
    if let Some(index) = all.iter().position(is_called).or(numbered) {
        return Ok(index);
    }
    let mut known: Vec<String> = Vec::new();
    let mut told = HashSet::new();
    for (i, names) in all.iter().enumerate() {
        match names.iter().flatten().next() {
            Some(name) if told.insert(*name) => known.push((*name).to_owned()),
            Some(_) => {}
            None => known.push((i + 1).to_string()),
        }
    }
    let hint = match number {
        Some(_) if !all.is_empty() => format!("they count from 1 to {}: {}", all.len(), known.join(", ")),
        _ => did_you_mean(wanted, known.iter().map(String::as_str)),
    };
    Err(format!("there is no {what} '{wanted}' in it; {hint}"))
}
