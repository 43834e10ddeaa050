//! Times of several ways to do one thing.

use std::time::Instant;

/// Median seconds of each, run so many times in turns, so that what else the machine does falls on all of them alike.
pub fn median_seconds<const N: usize>(repeats: usize, mut runs: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut times = [(); N].map(|()| Vec::with_capacity(repeats));
    for _ in 0..repeats {
        for (run, times) in runs.iter_mut().zip(&mut times) {
            let start = Instant::now();
            run();
            times.push(start.elapsed().as_secs_f64());
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[repeats / 2]
    })
}
