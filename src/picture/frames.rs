use super::{WriteError, prepare, write_png_pixels};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A folder of frames, frame_00000.png and so on, and a list of what each of them shows, so that what is finished
/// need not be drawn again.
#[derive(Debug)]
pub struct FrameFolder {
    folder: PathBuf,
    list: List,
}

/// The list's name.
const LIST: &str = "frames.json";

#[derive(Debug, Default, Serialize, Deserialize)]
struct List {
    terrell: String,
    /// By name.
    frames: BTreeMap<String, Entry>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Entry {
    /// What the frame shows.
    shows: String,
    /// How long the file is: what someone cut off is no frame any more.
    bytes: u64,
}

/// Why frames cannot be written to a folder.
#[derive(Debug, thiserror::Error)]
pub enum FramesError {
    /// The system refuses.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Frames of someone else.
    #[error("{} holds frames that are not from here ({file} is not in its {LIST}); choose another folder", .folder.display())]
    Foreign {
        /// One of them.
        file: String,
        /// Where.
        folder: PathBuf,
    },
}

/// Name of a frame.
fn name(index: usize) -> String {
    format!("frame_{index:05}.png")
}

impl FrameFolder {
    /// Opens a folder, and makes it if it is not there.
    ///
    /// # Errors
    /// If it cannot be made or read, or holds frames that are not in its list.
    pub fn open(folder: &Path) -> Result<Self, FramesError> {
        let fault = |source| WriteError::Io { path: folder.to_owned(), source };
        if folder.is_file() {
            return Err(fault(std::io::ErrorKind::NotADirectory.into()).into());
        }
        std::fs::create_dir_all(folder).map_err(fault)?;
        // A list that cannot be read is none.
        let list: List = std::fs::read(folder.join(LIST))
            .ok()
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .unwrap_or_default();
        for entry in std::fs::read_dir(folder).map_err(fault)? {
            let file = entry.map_err(fault)?.file_name().to_string_lossy().into_owned();
            let is_frame = file.starts_with("frame_") && file.ends_with(".png");
            if is_frame && !list.frames.contains_key(&file) {
                return Err(FramesError::Foreign { file, folder: folder.to_owned() });
            }
        }
        Ok(Self { folder: folder.to_owned(), list })
    }

    /// Whether a frame is there and shows what `shows` stands for.
    pub fn is_finished(&self, index: usize, shows: &str) -> bool {
        let file = self.folder.join(name(index)).metadata().ok().filter(|about| about.is_file());
        let entry = self.list.frames.get(&name(index));
        entry.zip(file).is_some_and(|(entry, file)| entry.shows == shows && entry.bytes == file.len())
    }

    /// Whether a frame is there, whatever it shows.
    pub fn is_there(&self, index: usize) -> bool {
        self.folder.join(name(index)).is_file()
    }

    /// Takes away the frames behind the last of `count`: those of a longer film.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn shorten(&mut self, count: usize) -> Result<usize, FramesError> {
        let kept: Vec<String> = (0..count).map(name).collect();
        let surplus: Vec<String> =
            self.list.frames.keys().filter(|file| kept.binary_search(file).is_err()).cloned().collect();
        for file in &surplus {
            let path = self.folder.join(file);
            if path.is_file() {
                std::fs::remove_file(&path).map_err(|source| WriteError::Io { path, source })?;
            }
            self.list.frames.remove(file);
        }
        if !surplus.is_empty() {
            self.save()?;
        }
        Ok(surplus.len())
    }

    /// Writes a frame, whole or not at all: 8-bit sRGB, three bytes a pixel.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn push(
        &mut self,
        index: usize,
        shows: &str,
        [width, height]: [u32; 2],
        rgb: &[u8],
    ) -> Result<(), FramesError> {
        let path = self.folder.join(name(index));
        let mut png = Vec::new();
        let encoded = write_png_pixels(width, height, rgb, &mut png);
        encoded.map_err(|source| WriteError::Io { path: path.clone(), source })?;
        let frame = prepare(&path, |to| to.write_all(&png))?;
        // It is in the list before it has its name: a frame that is there is never of someone else.
        let entry = Entry { shows: shows.to_owned(), bytes: png.len() as u64 };
        self.list.frames.insert(name(index), entry);
        if !path.exists() {
            self.save()?;
            frame.finish()?;
        } else {
            // What was there shows something else from now on.
            frame.finish()?;
            self.save()?;
        }
        Ok(())
    }

    fn save(&mut self) -> Result<(), FramesError> {
        self.list.terrell = env!("CARGO_PKG_VERSION").to_owned();
        let list = &self.list;
        let pending = prepare(&self.folder.join(LIST), |to| {
            serde_json::to_writer_pretty(&mut *to, list)?;
            writeln!(to)
        })?;
        Ok(pending.finish()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finished_frames_are_known_and_changed_ones_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film");
        let mut frames = FrameFolder::open(&path).unwrap();
        for i in 0..3 {
            frames.push(i, &format!("scene {i}"), [1, 1], &[1, 2, 3]).unwrap();
        }
        let mut frames = FrameFolder::open(&path).unwrap();
        assert!((0..3).all(|i| frames.is_finished(i, &format!("scene {i}"))));
        assert!(!frames.is_finished(1, "another") && frames.is_there(1));
        std::fs::write(path.join("frame_00000.png"), "cut off").unwrap();
        assert!(!frames.is_finished(0, "scene 0"));
        assert!(!frames.is_finished(3, "scene 3") && !frames.is_there(3));
        std::fs::remove_file(path.join("frame_00001.png")).unwrap();
        assert!(!frames.is_finished(1, "scene 1"));
        assert_eq!(frames.shorten(1).unwrap(), 2);
        assert!(!path.join("frame_00002.png").exists());
        std::fs::write(path.join("frame_00007.png"), "mine").unwrap();
        assert!(
            matches!(FrameFolder::open(&path), Err(FramesError::Foreign { file, .. }) if file == "frame_00007.png")
        );
    }
}
