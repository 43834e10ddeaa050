use std::io::IsTerminal;

/// What is going on, on a terminal only.
pub struct Progress {
    terminal: bool,
}

impl Progress {
    pub fn new(quiet: bool) -> Self {
        Self { terminal: !quiet && std::io::stderr().is_terminal() }
    }

    pub fn show(&self, what: &str) {
        if self.terminal {
            eprint!("\r\x1b[K{what} …");
        }
    }

    pub fn clear(&self) {
        if self.terminal {
            eprint!("\r\x1b[K");
        }
    }
}
