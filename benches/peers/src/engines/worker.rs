//! An engine of Python, in a process of its own that keeps its own CPU time: a line of JSON there, a line back
//! (`python/orders.py`).

use std::io::{BufRead, BufReader, Write};
use std::ops::Range;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::{Entrant, State};
use crate::Result;
use crate::scene::Scene;

/// Where the scripts are.
const SCRIPTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/python");

/// What the script understands.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Order<'a> {
    /// Make a scene; it answers null.
    Start(&'a Scene),
    /// Take steps from the first to before the last, of this length (s); it answers their CPU time (s).
    Advance(u32, u32, f64),
    /// It answers with its version.
    Version,
    /// It answers with a list of states.
    State,
}

/// What it answers.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Answer<T> {
    Done(T),
    Failed(String),
}

pub struct Worker {
    name: &'static str,
    process: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Worker {
    /// Starts the script of this name.
    pub fn new(name: &'static str, script: &str, python: Option<&str>) -> Result<Self> {
        let python = python.ok_or("it needs --python, an interpreter that has it")?;
        let mut process = Command::new(python)
            .arg(format!("{SCRIPTS}/{script}"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| format!("{python}: {error}"))?;
        let orders = process.stdin.take().ok_or("no pipe to Python")?;
        let answers = BufReader::new(process.stdout.take().ok_or("no pipe from Python")?);
        Ok(Self { name, process, orders, answers })
    }

    fn ask<T: DeserializeOwned>(&mut self, order: &Order) -> Result<T> {
        serde_json::to_writer(&mut self.orders, order)?;
        self.orders.write_all(b"\n")?;
        self.orders.flush()?;
        let mut line = String::new();
        if self.answers.read_line(&mut line)? == 0 {
            return Err(format!("the process of {} ended", self.name).into());
        }
        match serde_json::from_str(&line)? {
            Answer::Done(value) => Ok(value),
            Answer::Failed(message) => Err(message.into()),
        }
    }
}

impl Entrant for Worker {
    fn name(&self) -> &str {
        self.name
    }

    fn version(&mut self) -> Result<String> {
        self.ask(&Order::Version)
    }

    fn start(&mut self, scene: &Scene) -> Result<()> {
        self.ask(&Order::Start(scene))
    }

    fn advance(&mut self, scene: &Scene, steps: Range<u32>) -> Result<Duration> {
        let seconds: f64 = self.ask(&Order::Advance(steps.start, steps.end, scene.dt))?;
        Ok(Duration::try_from_secs_f64(seconds)?)
    }

    fn state(&mut self) -> Result<Vec<State>> {
        self.ask(&Order::State)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // Nothing is to be done about one that is gone already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
