use super::file::did_you_mean;
use super::import::import_obj;
use super::{Mesh, Scene, parse_scene};
use std::path::Path;

/// A scene that ships inside the program.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// What `terrell render` calls it.
    pub name: &'static str,
    /// What it shows, in one line.
    pub about: &'static str,
    /// The scene as TOML.
    pub toml: &'static str,
}

impl Builtin {
    /// The scene.
    pub fn scene(&self) -> Scene {
        parse_scene(self.toml, Path::new(self.name)).expect("scenes that ship are read by a test")
    }
}

const SCENES: [Builtin; 12] = [
    Builtin {
        name: "cube",
        about: "a cube passing at 0.9c, seen as it appears abreast: it seems to turn (Fig. 2)",
        toml: include_str!("../../assets/cube.toml"),
    },
    Builtin {
        name: "gate",
        about: "inside a gate of two rows of six columns, flying through at 0.99c (Fig. 3)",
        toml: include_str!("../../assets/gate.toml"),
    },
    Builtin {
        name: "gate_back",
        about: "the same gate 340 m behind the camera, looking backward: it is seen at 24 m, and flat (--color geometry)",
        toml: include_str!("../../assets/gate_back.toml"),
    },
    Builtin {
        name: "lattice",
        about: "a lattice of spheres and rods passing overhead at 0.9c (Fig. 1)",
        toml: include_str!("../../assets/lattice.toml"),
    },
    Builtin {
        name: "hot",
        about: "the lattice, glowing at 4500 K: blue-white ahead, dull red behind (Eq. 3, 5)",
        toml: include_str!("../../assets/hot.toml"),
    },
    Builtin {
        name: "shadow",
        about: "a cube passing at 0.8c over a floor, under a lamp: its shadow is where it was",
        toml: include_str!("../../assets/shadow.toml"),
    },
    Builtin {
        name: "box",
        about: "a box lit by a glowing cube that flies through it at 0.5c, and mirrored in a ball: light of bodies on each other",
        toml: include_str!("../../assets/box.toml"),
    },
    Builtin {
        name: "sphere",
        about: "chequered spheres at rest, 0.5c, 0.9c and 0.99c: all outlines are circles, all are turned (--color geometry)",
        toml: include_str!("../../assets/sphere.toml"),
    },
    Builtin {
        name: "street",
        about: "a street with trams and cars at 0, 0.5c, 0.8c and 0.9c, in both directions (--color geometry)",
        toml: include_str!("../../assets/street.toml"),
    },
    Builtin {
        name: "sunlit",
        about: "balls at rest, 0.5c, 0.9c and 0.99c in the light of one sun, aberrated: ever thinner crescents",
        toml: include_str!("../../assets/sunlit.toml"),
    },
    Builtin {
        name: "train",
        about: "a train passing at 0.9c between the piers and the wall of a station: what hides what (--color geometry)",
        toml: include_str!("../../assets/train.toml"),
    },
    Builtin {
        name: "blackhole",
        about: "a globe and cubes around a rotating black hole, before a checkered sky: all of it bent, much of it seen twice",
        toml: include_str!("../../assets/blackhole.toml"),
    },
];

/// The scenes that ship.
pub fn builtin_scenes() -> &'static [Builtin] {
    &SCENES
}

/// No scene of that name ships.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no scene '{name}'; {hint}")]
pub struct NoSuchScene {
    /// What was asked for.
    pub name: String,
    /// The nearest name, or all there are.
    pub hint: String,
}

/// A scene that ships, by name.
///
/// # Errors
/// If there is none of that name.
pub fn builtin_scene(name: &str) -> Result<&'static Builtin, NoSuchScene> {
    SCENES.iter().find(|scene| scene.name == name).ok_or_else(|| NoSuchScene {
        name: name.to_owned(),
        hint: did_you_mean(name, SCENES.iter().map(|scene| scene.name)),
    })
}

/// Name, OBJ and MTL of a mesh in `assets/`.
macro_rules! meshes {
    ($($name:literal),*) => {
        [$((
            $name,
            include_str!(concat!("../../assets/", $name, ".obj")),
            include_str!(concat!("../../assets/", $name, ".mtl")),
        )),*]
    };
}

const MESHES: [(&str, &str, &str); 12] = meshes![
    "cube",
    "gate",
    "lattice",
    "globe",
    "ball",
    "plate",
    "street",
    "tram",
    "tram_green",
    "car",
    "station",
    "train"
];

/// The names of the meshes that ship.
pub fn builtin_meshes() -> impl Iterator<Item = &'static str> + Clone {
    MESHES.iter().map(|(name, ..)| *name)
}

/// A mesh that ships, by name.
pub fn builtin_mesh(name: &str) -> Option<Mesh> {
    let (name, obj, mtl) = MESHES.iter().find(|(n, ..)| *n == name)?;
    Some(import_obj(obj, mtl, name).expect("meshes that ship are read by a test").into_mesh())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_ships_can_be_read() {
        for scene in builtin_scenes() {
            let read = scene.scene();
            assert_eq!(read.name, scene.name);
            assert!(read.notes.is_empty(), "{:?}", read.notes);
            read.camera().unwrap();
        }
        for name in builtin_meshes() {
            builtin_mesh(name).unwrap().check().unwrap();
        }
        assert!(builtin_mesh("no such").is_none());
        assert_eq!(builtin_scene("gate").unwrap().name, "gate");
        assert_eq!(builtin_scene("stret").unwrap_err().hint, "did you mean 'street'?");
        assert!(builtin_scene("something else").unwrap_err().hint.contains("lattice"));
    }
}
