//! Ctrl-C, and what else asks a program to end.

use std::sync::atomic::{AtomicBool, Ordering};
use terrell::picture::remove_unfinished;

/// As a shell says of what was ended by Ctrl-C.
pub const STOPPED: i32 = 130;

static ASKED: AtomicBool = AtomicBool::new(false);
/// Whether the work looks at [`ASKED`] from time to time.
static HEEDED: AtomicBool = AtomicBool::new(false);

/// From now on nothing half-written is left when the program is asked to end.
pub fn watch() {
    // Where it cannot be had, the system's own way stays.
    let _ = ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) || !HEEDED.load(Ordering::Relaxed) {
            remove_unfinished();
            std::process::exit(STOPPED);
        }
    });
}

/// Whether the program was asked to end: whoever looks ends by itself; asked again, it ends at once.
pub fn is_asked() -> bool {
    HEEDED.store(true, Ordering::Relaxed);
    ASKED.load(Ordering::Relaxed)
}
