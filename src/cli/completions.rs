use super::{Cli, Fault};
use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};
use std::io::Write;

/// Print what makes a shell complete terrell's words
#[derive(Args)]
#[command(after_help = "Examples:
  terrell completions bash > ~/.local/share/bash-completion/completions/terrell
  terrell completions zsh > ~/.zfunc/_terrell
  terrell completions fish > ~/.config/fish/completions/terrell.fish")]
pub struct Completions {
    /// Which shell
    shell: Shell,
}

impl Completions {
    pub fn run(self) -> Result<(), Fault> {
        let mut script = Vec::new();
        generate(self.shell, &mut Cli::command(), "terrell", &mut script);
        Ok(std::io::stdout().write_all(&script)?)
    }
}
