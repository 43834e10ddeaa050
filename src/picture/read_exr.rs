use crate::film::{Film, IMPOSSIBLE, NOTHING};
use crate::measure::{Corners, Known, Reference};
use crate::scene::{MAX_PIXELS, MAX_SIDE, read_plain};
use exr::prelude::*;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Why a file cannot be compared with.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The system refuses.
    #[error("cannot read {}: {source}", .path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Not an OpenEXR file, or not whole.
    #[error("{}: not an OpenEXR file, or not whole: {reason}; give one with float channels R, G and B, such as terrell render writes", .path.display())]
    NotExr {
        /// Which.
        path: PathBuf,
        /// What its reader says.
        reason: String,
    },
    /// An OpenEXR file without what is needed.
    #[error("{}: {what}", .path.display())]
    Unfit {
        /// Which.
        path: PathBuf,
        /// What it lacks, or has and should not.
        what: String,
    },
}

/// The most channels of a file that are looked at.
const MOST_CHANNELS: usize = 64;

/// Reads an OpenEXR file to compare with: channels R, G and B of its first layer (linear sRGB radiance), and, where they
/// are there, distance, doppler, body, face (as [`write_exr`](super::write_exr) has them) and inner, which is 1 where all
/// corners of a pixel see the same. Pixels with numbers that are not finite are left out; distances and Doppler factors of
/// nothing may be what they like.
///
/// # Errors
/// If the file cannot be read, is no OpenEXR file or not whole, has no R, G, B or no finite pixel, or bodies and faces that
/// are no whole numbers.
pub fn read_reference(path: &Path) -> std::result::Result<Reference, ReadError> {
    let bytes = read_plain(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    parse(&bytes).map_err(|fault| match fault {
        Fault::NotExr(reason) => ReadError::NotExr { path: path.to_owned(), reason },
        Fault::Unfit(what) => ReadError::Unfit { path: path.to_owned(), what },
    })
}

enum Fault {
    NotExr(String),
    Unfit(String),
}

fn parse(bytes: &[u8]) -> std::result::Result<Reference, Fault> {
    let not_exr = |e: Error| Fault::NotExr(e.to_string());
    // Sizes first: a few bytes can ask for any amount of memory.
    let about = MetaData::read_from_buffered(bytes, false).map_err(not_exr)?;
    for header in &about.headers {
        let Vec2(width, height) = header.layer_size;
        let fits = width.max(height) <= MAX_SIDE as usize && width as u64 * height as u64 <= MAX_PIXELS;
        if !fits || header.channels.list.len() > MOST_CHANNELS {
            let channels = header.channels.list.len();
            let what = format!(
                "{width}x{height} pixels with {channels} channels are too many; each side can have {MAX_SIDE}, all of it {MAX_PIXELS}, with {MOST_CHANNELS} channels"
            );
            return Err(Fault::Unfit(what));
        }
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(std::io::Cursor::new(bytes))
        .map_err(not_exr)?;
    let Vec2(width, height) = image.layer_data.size;
    let channels = image.layer_data.channel_data.list;
    let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
    let whole = channels.into_iter().filter(|c| c.sampling == Vec2(1, 1));
    let values: HashMap<String, Vec<f32>> =
        whole.map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect())).collect();
    let missing: Vec<&str> = ["R", "G", "B"].into_iter().filter(|c| !values.contains_key(*c)).collect();
    if !missing.is_empty() {
        let [missing, names] = [missing.join(", "), names.join(", ")];
        return Err(Fault::Unfit(format!(
            "no channel {missing} of a value a pixel; there is {names}. Give a file with R, G and B"
        )));
    }
    reference(width as u32, height as u32, values)
}

fn reference(
    width: u32,
    height: u32,
    mut values: HashMap<String, Vec<f32>>,
) -> std::result::Result<Reference, Fault> {
    let mut film = Film::new(width, height);
    let pixels = film.color.len();
    let known = Known {
        distance: values.contains_key("distance"),
        doppler: values.contains_key("doppler"),
        body: values.contains_key("body"),
        // Of which body is not known without it.
        face: values.contains_key("face") && values.contains_key("body"),
    };
    let mut left_out = vec![false; pixels];
    let mut leave = |i: usize, finite: bool| left_out[i] |= !finite;
    for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
        for (i, v) in values[name].iter().enumerate() {
            leave(i, v.is_finite());
            film.color[i][channel] = if v.is_finite() { *v } else { 0.0 };
        }
    }
    let to: [(&str, &mut Vec<i32>, bool); 2] =
        [("body", &mut film.body, known.body), ("face", &mut film.face, known.face)];
    for (name, indices, _) in to.into_iter().filter(|(.., known)| *known) {
        for (i, v) in values[name].iter().enumerate() {
            leave(i, v.is_finite());
            if v.is_finite() {
                let number = *v as i32;
                // What our own films say of pixels that see no body.
                let least = if name == "body" { IMPOSSIBLE } else { NOTHING };
                if number as f32 != *v || number < least {
                    let (x, y) = (i as u64 % u64::from(width), i as u64 / u64::from(width));
                    return Err(Fault::Unfit(format!(
                        "channel {name} has {v} at pixel {x}, {y}: neither a number counted from 0 nor -1, which stands for nothing"
                    )));
                }
                indices[i] = number;
            }
        }
    }
    let to: [(&str, &mut Vec<f32>); 2] = [("distance", &mut film.distance), ("doppler", &mut film.doppler)];
    for (name, numbers) in to {
        for (i, v) in values.remove(name).into_iter().flatten().enumerate() {
            let is_nothing = known.body && film.body[i] == NOTHING;
            leave(i, v.is_finite() || is_nothing);
            numbers[i] = if v.is_finite() && !is_nothing { v } else { 0.0 };
        }
    }
    if left_out.iter().all(|left| *left) {
        return Err(Fault::Unfit("no pixel has finite numbers in all channels".into()));
    }
    let inner: Option<Vec<bool>> =
        values.remove("inner").map(|inner| inner.into_iter().map(|v| v == 1.0).collect());
    // Of what the corners see, faces or bodies, it does not say which.
    let corners = inner.as_ref().map(|inner| Corners { same_body: inner.clone(), same_face: inner.clone() });
    Ok(Reference { film, known, inner, corners, left_out, renumbered: true })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::write_exr;

    fn film() -> Film {
        let mut film = Film::new(20, 20);
        for i in 100..300 {
            (film.body[i], film.face[i]) = (i as i32 % 3, i as i32);
            (film.distance[i], film.doppler[i]) = (i as f32, 0.5);
            film.color[i] = [i as f32, 1.0, 0.25];
        }
        film
    }

    fn bytes(film: &Film) -> Vec<u8> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        write_exr(film, &mut bytes).unwrap();
        bytes.into_inner()
    }

    fn read(bytes: &[u8]) -> std::result::Result<Reference, String> {
        parse(bytes).map_err(|fault| match fault {
            Fault::NotExr(what) | Fault::Unfit(what) => what,
        })
    }

    #[test]
    fn what_is_written_is_read() {
        let read = read(&bytes(&film())).unwrap();
        assert_eq!(read.film, film());
        assert_eq!(read, Reference { renumbered: true, ..Reference::from(film()) });
    }

    #[test]
    fn numbers_that_are_none_are_left_out() {
        let mut film = film();
        film.color[7] = [f32::NAN, 0.0, 0.0];
        film.distance[200] = f32::INFINITY;
        // Of nothing.
        film.distance[3] = f32::INFINITY;
        let found = read(&bytes(&film)).unwrap();
        let left: Vec<usize> = (0..400).filter(|&i| found.left_out[i]).collect();
        assert_eq!((left, found.film.distance[3]), (vec![7, 200], 0.0));
        film.color = vec![[f32::NAN; 3]; 400];
        assert!(read(&bytes(&film)).unwrap_err().contains("no pixel"));
    }

    /// Whatever is broken in a file, it is said and nothing ends the program.
    #[test]
    fn broken_files_are_refused() {
        let whole = bytes(&film());
        for end in (0..whole.len()).step_by(7) {
            assert!(read(&whole[..end]).is_err(), "{end} of {} bytes", whole.len());
        }
        for at in 0..whole.len() {
            for flip in [0x01, 0x80, 0xff] {
                let mut broken = whole.clone();
                broken[at] ^= flip;
                let _ = read(&broken);
            }
        }
        assert!(read(b"\x89PNG").is_err());
    }
}
