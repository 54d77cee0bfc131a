//! Work shared by threads so that the bits do not depend on how many there are: it is cut by what it is of, and each
//! piece is done by one thread in a fixed order.

use std::sync::Arc;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::{Error, Result};

/// Most threads.
pub const MOST_THREADS: u32 = 64;

/// Threads that work together; with one, nobody is asked.
#[derive(Clone, Default)]
pub struct Team(Option<Arc<ThreadPool>>);

impl std::fmt::Debug for Team {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Team({})", self.threads())
    }
}

impl Team {
    /// This many threads.
    ///
    /// # Errors
    /// A number that is not allowed, or a system that gives no more threads.
    pub fn new(threads: u32) -> Result<Self> {
        if !(1..=MOST_THREADS).contains(&threads) {
            return Err(Error::invalid("threads", threads, format!("1 to {MOST_THREADS}")));
        }
        if threads == 1 {
            return Ok(Self::default());
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads as usize).build();
        let pool =
            pool.map_err(|error| Error::invalid("threads", error, "what the system gives"))?;
        Ok(Self(Some(Arc::new(pool))))
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.0.as_ref().map_or(1, |pool| pool.current_num_threads())
    }

    /// Runs `work` so that [`Team::both`] in it shares.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Does two pieces of work, at once where there are threads.
    pub fn both(&self, a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
        if self.0.is_some() {
            rayon::join(a, b);
        } else {
            a();
            b();
        }
    }
}
