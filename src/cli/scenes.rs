use super::Fault;
use clap::Args;
use std::io::Write;
use terrell::scene::builtin_scenes;

/// List the scenes that ship, or print one as TOML to start from
#[derive(Args)]
#[command(after_help = "Examples:\n  terrell scenes\n  terrell scenes cube > my.toml")]
pub struct Scenes {
    /// Print this scene as TOML
    name: Option<String>,
}

impl Scenes {
    pub fn run(self) -> Result<(), Fault> {
        let mut out = std::io::stdout().lock();
        match self.name {
            None => {
                for scene in builtin_scenes() {
                    writeln!(out, "{:<10}{}", scene.name, scene.about)?;
                }
            }
            Some(name) => {
                let scene = builtin_scenes().iter().find(|s| s.name == name);
                let scene = scene.ok_or_else(|| {
                    let names: Vec<_> = builtin_scenes().iter().map(|s| s.name).collect();
                    format!("there is no scene '{name}'; there is {}", names.join(", "))
                })?;
                write!(out, "{}", scene.toml)?;
            }
        }
        Ok(out.flush()?)
    }
}
