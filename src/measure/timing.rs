use std::time::{Duration, Instant};

/// How long something took, again and again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Times {
    /// Increasing.
    sorted: Vec<Duration>,
}

impl Times {
    /// Of runs in any order.
    ///
    /// # Panics
    /// If there are none.
    pub fn new(mut runs: Vec<Duration>) -> Self {
        assert!(!runs.is_empty(), "a time of something that was done");
        runs.sort_unstable();
        Self { sorted: runs }
    }

    /// Half of the runs took less, half more.
    pub fn median(&self) -> Duration {
        self.quantile(0.5)
    }

    /// What a quarter of the runs stayed below, and what three quarters did: with fewer than four runs nearly the least and
    /// the greatest.
    pub fn quartiles(&self) -> [Duration; 2] {
        [self.quantile(0.25), self.quantile(0.75)]
    }

    /// The shortest and the longest.
    pub fn range(&self) -> [Duration; 2] {
        [self.sorted[0], self.sorted[self.sorted.len() - 1]]
    }

    /// In seconds: the median, the quartiles, the least and the greatest.
    pub fn seconds(&self) -> [f64; 5] {
        let ([low, high], [least, most]) = (self.quartiles(), self.range());
        [self.median(), low, high, least, most].map(|time| time.as_secs_f64())
    }

    /// How many runs there were.
    pub fn runs(&self) -> usize {
        self.sorted.len()
    }

    /// Every time taken as so many parts of itself.
    pub fn divided(&self, by: u32) -> Self {
        Self { sorted: self.sorted.iter().map(|time| *time / by).collect() }
    }

    /// Linear between runs.
    fn quantile(&self, part: f64) -> Duration {
        let at = part * (self.sorted.len() - 1) as f64;
        let (below, above) = (self.sorted[at.floor() as usize], self.sorted[at.ceil() as usize]);
        below + (above - below).mul_f64(at.fract())
    }
}

/// Times several jobs, each as often: all of them one after the other, then again, so that what disturbs the machine for a
/// while disturbs all alike. One round before is not counted. A job that has taken all of `patience` is left alone from
/// then on, timed at least once. `job` does a job of this number; `done` hears of each run.
///
/// # Errors
/// The first that a job has.
pub fn interleaved<E>(
    jobs: usize,
    repeats: u32,
    patience: Duration,
    mut job: impl FnMut(usize) -> Result<(), E>,
    mut done: impl FnMut(),
) -> Result<Vec<Times>, E> {
    let mut runs = vec![Vec::with_capacity(repeats as usize); jobs];
    let mut spent = vec![Duration::ZERO; jobs];
    for round in 0..=repeats.max(1) {
        for number in 0..jobs {
            if spent[number] >= patience && !runs[number].is_empty() {
                continue;
            }
            let start = Instant::now();
            job(number)?;
            let took = start.elapsed();
            spent[number] += took;
            if round > 0 || took >= patience {
                runs[number].push(took);
            }
            done();
        }
    }
    Ok(runs.into_iter().map(Times::new).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_quartiles() {
        let of = |ms: &[u64]| Times::new(ms.iter().map(|&ms| Duration::from_millis(ms)).collect());
        let ms = |times: [Duration; 2]| times.map(|t| t.as_millis());
        let medians = [&[7][..], &[9, 1, 2], &[4, 2, 100, 1]].map(|list| of(list).median().as_millis());
        assert_eq!(medians, [7, 2, 3]);
        let five = of(&[50, 10, 40, 20, 30]);
        assert_eq!((ms(five.quartiles()), ms(five.range()), five.runs()), ([20, 40], [10, 50], 5));
        assert_eq!(of(&[10, 20]).divided(10).median(), Duration::from_micros(1500));
    }

    #[test]
    fn jobs_take_turns() {
        let (hour, mut order) = (Duration::from_secs(3600), Vec::new());
        let note = |job| {
            order.push(job);
            Ok::<_, ()>(())
        };
        let times = interleaved(3, 2, hour, note, || ()).unwrap();
        assert_eq!(order, [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert!(times.len() == 3 && times.iter().all(|t| t.runs() == 2));
        let fails = |job| if job == 1 { Err(job) } else { Ok(()) };
        assert_eq!(interleaved(2, 1, hour, fails, || ()), Err(1));
        // Without any patience the first run is the only one.
        let mut count = 0;
        let times = interleaved(2, 9, Duration::ZERO, |_| Ok::<_, ()>(()), || count += 1).unwrap();
        assert!(count == 2 && times.iter().all(|t| t.runs() == 1));
    }
}
