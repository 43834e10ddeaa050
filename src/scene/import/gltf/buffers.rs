use super::super::{ImportError, ReadFile, beside};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Semantic;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

/// The bytes a file's accessors lead to.
pub(super) struct Buffers(Vec<Rc<Vec<u8>>>);

impl Buffers {
    /// What several buffers name is kept once.
    pub fn read(file: &gltf::Gltf, path: &Path, read: ReadFile<'_>) -> Result<Self, ImportError> {
        let fault = |message: String| ImportError::Contents { path: path.to_owned(), line: None, message };
        let mut kept: HashMap<Option<&str>, Rc<Vec<u8>>> = HashMap::new();
        if let Some(blob) = &file.blob {
            kept.insert(None, Rc::new(blob.clone()));
        }
        let contents = file.buffers().map(|buffer| {
            let uri = match buffer.source() {
                gltf::buffer::Source::Bin => None,
                gltf::buffer::Source::Uri(uri) => Some(uri),
            };
            let contents = match (kept.get(&uri), uri) {
                (Some(contents), _) => Rc::clone(contents),
                (None, Some(text)) => {
                    let contents = Rc::new(at_uri(text, path, read)?);
                    kept.insert(uri, Rc::clone(&contents));
                    contents
                }
                (None, None) => return Err(fault("its binary chunk is missing".into())),
            };
            if contents.len() < buffer.length() {
                let (found, needed) = (contents.len(), buffer.length());
                return Err(fault(format!(
                    "buffer {} has {found} of {needed} bytes; is the file whole?",
                    buffer.index()
                )));
            }
            Ok(contents)
        });
        Ok(Self(contents.collect::<Result<_, _>>()?))
    }

    /// How many bytes they have that are not in the file itself, each file's counted once.
    pub fn bytes_beside(&self, file: &gltf::Gltf) -> usize {
        let mut counted = HashSet::new();
        let beside = file.buffers().zip(&self.0).filter(|(buffer, _)| match buffer.source() {
            gltf::buffer::Source::Bin => false,
            gltf::buffer::Source::Uri(uri) => !uri.starts_with("data:") && counted.insert(uri.to_owned()),
        });
        beside.map(|(_, contents)| contents.len()).sum()
    }

    /// All of a buffer.
    pub fn get(&self, buffer: &gltf::Buffer<'_>) -> Option<&[u8]> {
        self.0.get(buffer.index()).map(|contents| contents.as_slice())
    }

    /// The bytes of a view; none if it leads beyond its buffer.
    pub fn view(&self, view: &gltf::buffer::View<'_>) -> Option<&[u8]> {
        self.get(&view.buffer())?.get(view.offset()..view.offset().checked_add(view.length())?)
    }

    /// The reader underneath trusts types and lengths; this does not.
    pub fn check(
        &self,
        accessor: &gltf::Accessor<'_>,
        what: &str,
        types: &[(Dimensions, DataType)],
    ) -> Result<(), String> {
        let found = (accessor.dimensions(), accessor.data_type());
        if !types.is_empty() && !types.contains(&found) {
            let index = accessor.index();
            return Err(format!(
                "accessor {index} ({what}) holds {found:?}, which the format does not allow there"
            ));
        }
        let fits = |view: &gltf::buffer::View<'_>, offset: usize, count: usize, size: usize| {
            let stride = view.stride().unwrap_or(size);
            let needed = count.checked_sub(1).and_then(|n| n.checked_mul(stride)?.checked_add(size));
            let end = needed.and_then(|n| n.checked_add(offset));
            let in_view = end.is_some_and(|end| end <= view.length());
            let there = self.get(&view.buffer()).map_or(0, <[u8]>::len);
            stride >= size
                && in_view
                && view.offset().checked_add(view.length()).is_some_and(|end| end <= there)
        };
        let mut good = match accessor.view() {
            Some(view) => fits(&view, accessor.offset(), accessor.count(), accessor.size()),
            // Zeros, only as a ground for sparse values; a file has at least an index for each.
            None => {
                let longest = self.0.iter().map(|contents| contents.len()).max();
                accessor.sparse().is_some() && accessor.count() <= longest.unwrap_or(0)
            }
        };
        if let Some(sparse) = accessor.sparse() {
            let indices = sparse.indices();
            good &= fits(&indices.view(), indices.offset(), sparse.count(), indices.index_type().size());
            good &= fits(&sparse.values().view(), sparse.values().offset(), sparse.count(), accessor.size());
        }
        if good {
            Ok(())
        } else {
            Err(format!("accessor {} reaches beyond its buffer; is the file whole?", accessor.index()))
        }
    }
}

/// What a URI in a file leads to.
pub(super) fn at_uri(uri: &str, path: &Path, read: ReadFile<'_>) -> Result<Vec<u8>, ImportError> {
    let message = "a data URI in it is not base64".to_owned();
    match uri.strip_prefix("data:") {
        Some(data) => {
            base64(data).ok_or(ImportError::Contents { path: path.to_owned(), line: None, message })
        }
        None => read(&beside(path, Path::new(&decoded(uri)))),
    }
}

/// A relative URI as a path: %20 is a space.
fn decoded(uri: &str) -> String {
    let mut out = Vec::new();
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = tail.get(..2).and_then(|hex| u8::from_str_radix(std::str::from_utf8(hex).ok()?, 16).ok());
        match code {
            Some(byte) if *first == b'%' => {
                out.push(byte);
                rest = &tail[2..];
            }
            _ => {
                out.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

fn base64(data: &str) -> Option<Vec<u8>> {
    let (_, text) = data.split_once(";base64,")?;
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0u32, 0);
    for byte in text.bytes().filter(|&b| b != b'=') {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push((bits >> count) as u8);
        }
    }
    Some(out)
}

pub(super) const INDEX_TYPES: [(Dimensions, DataType); 3] = [
    (Dimensions::Scalar, DataType::U8),
    (Dimensions::Scalar, DataType::U16),
    (Dimensions::Scalar, DataType::U32),
];

/// What glTF allows for the attributes that are read; empty for the others.
pub(super) fn allowed_types(semantic: &Semantic) -> &'static [(Dimensions, DataType)] {
    use DataType::{F32, U8, U16};
    use Dimensions::{Vec2, Vec3, Vec4};
    match semantic {
        Semantic::Positions | Semantic::Normals => &[(Vec3, F32)],
        Semantic::TexCoords(_) => &[(Vec2, F32), (Vec2, U8), (Vec2, U16)],
        Semantic::Colors(_) => &[(Vec3, F32), (Vec3, U8), (Vec3, U16), (Vec4, F32), (Vec4, U8), (Vec4, U16)],
        _ => &[],
    }
}
