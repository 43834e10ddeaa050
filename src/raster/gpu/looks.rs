use super::records::{FaceRecord, MaterialRecord};
use crate::light::SeenShading;
use crate::scene::{Colors, EmissionLaw, Mesh, Paint};
use crate::spectrum::DopplerTable;
use std::sync::Arc;

/// What surfaces look like, as shaders read it.
#[derive(Default)]
pub(super) struct Looks {
    pub materials: Vec<MaterialRecord>,
    /// Columns of tables.
    pub nodes: Vec<[f32; 4]>,
    pub words: Vec<u32>,
    /// Tables that are there, with their first nodes.
    known: Vec<(*const DopplerTable, u32)>,
}

/// Where a body's looks begin.
pub(super) struct BodyLooks {
    material: u32,
    word: Words,
}

/// Where the words of its faces are.
enum Words {
    /// One colour for all of a material, a word after the other.
    OfMaterials(u32),
    /// So many for every face.
    OfFaces(u32, u32),
}

impl BodyLooks {
    /// Completes a face, whose material is counted from the body's first.
    pub fn finish(&self, face: &mut FaceRecord) {
        face.word = match self.word {
            Words::OfMaterials(first) => first + 3 * face.material,
            Words::OfFaces(first, count) => first + count * face.number,
        };
        face.material += self.material;
    }
}

impl Looks {
    /// A body's materials and its mesh's colours.
    pub fn add(&mut self, body: usize, mesh: &Mesh, shading: &SeenShading<'_>) -> BodyLooks {
        let material = self.materials.len() as u32;
        let paint = if mesh.paint.is_of_faces() { 1 } else { 3 };
        for index in 0..mesh.materials.len().max(1) {
            let record = self.material(body, index, paint, shading);
            self.materials.push(record);
        }
        let own = |face: usize, weights: [f64; 3]| {
            let colors = mesh.colors(face, weights, |_| [1.0; 3]);
            shine(colors, shading.is_lit(body, mesh.material_index(face)))
        };
        let first = self.words.len() as u32;
        let mut push = |color: [f32; 3]| self.words.extend(color.map(f32::to_bits));
        let word = match &mesh.paint {
            Paint::Uniform(paint) => {
                let plain = Colors { base: *paint, ..Colors::default() };
                for index in 0..mesh.materials.len().max(1) {
                    let colors = mesh.materials.get(index).map_or(plain, |m| m.colors(*paint, |_| [1.0; 3]));
                    push(shine(colors, shading.is_lit(body, index)));
                }
                Words::OfMaterials(first)
            }
            Paint::Faces(_) => {
                (0..mesh.triangles.len()).for_each(|face| push(own(face, [1.0, 0.0, 0.0])));
                Words::OfFaces(first, 3)
            }
            Paint::Vertices(_) => {
                for face in 0..mesh.triangles.len() {
                    for corner in 0..3 {
                        push(own(face, std::array::from_fn(|i| f64::from(u8::from(i == corner)))));
                    }
                }
                Words::OfFaces(first, 9)
            }
        };
        BodyLooks { material, word }
    }

    fn material(
        &mut self,
        body: usize,
        index: usize,
        paint: u32,
        shading: &SeenShading<'_>,
    ) -> MaterialRecord {
        let (unshifted, table, strength, law) = shading.surface(body, index).shining();
        let columns = unshifted.unwrap_or([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        let column = |i: usize| [columns[3 * i], columns[3 * i + 1], columns[3 * i + 2]];
        let (law, law_numbers) = match law {
            EmissionLaw::Isotropic => (0, [0.0; 2]),
            EmissionLaw::Cosine { power } => (1, [power, 0.0]),
            EmissionLaw::LimbDarkening { coefficients } => (2, coefficients),
        };
        let mut record = MaterialRecord {
            red: column(0),
            green: column(1),
            blue: column(2),
            strength,
            law,
            law_numbers: law_numbers.map(|n| n as f32),
            paint,
            ..MaterialRecord::default()
        };
        if let Some(table) = table {
            let (start, inverse_step, columns) = table.columns();
            (record.start, record.inverse_step) = (start as f32, inverse_step as f32);
            record.node = self.table(table, columns);
            record.count = (columns.len() / 3) as u32;
        }
        record
    }

    /// The place of a table's first column.
    fn table(&mut self, table: &Arc<DopplerTable>, columns: &[[f32; 4]]) -> u32 {
        let pointer = Arc::as_ptr(table);
        if let Some((_, first)) = self.known.iter().find(|(known, _)| *known == pointer) {
            return *first;
        }
        let first = self.nodes.len() as u32;
        self.nodes.extend(columns);
        self.known.push((pointer, first));
        first
    }
}

/// What of a surface's colours shines.
fn shine(colors: Colors, is_lit: bool) -> [f32; 3] {
    if is_lit { colors.emission } else { colors.sum() }
}
