//! A report as people read it: in a terminal and in a notebook.

use pyo3::prelude::*;

use crate::stepping::StepReport;

/// A number to three digits, large and small ones with an exponent.
fn short(number: f64) -> String {
    let size = number.abs();
    if number == 0.0 || (1e-2..1e4).contains(&size) {
        let text = format!("{number:.3}");
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    format!("{number:.2e}")
}

fn time(seconds: f64) -> String {
    let (size, unit) = match seconds {
        s if s >= 1.0 => (1.0, "s"),
        s if s >= 1e-3 => (1e-3, "ms"),
        s if s >= 1e-6 => (1e-6, "µs"),
        _ => (1e-9, "ns"),
    };
    format!("{:.3} {unit}", seconds / size)
}

impl StepReport {
    /// What there is to tell, a name and a value each; what did not happen is left out.
    fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![("world time", format!("{} s", short(self.duration)))];
        let mut count = |name, number: u64| {
            if number > 0 {
                lines.push((name, number.to_string()));
            }
        };
        count("steps", self.steps);
        count("of them stiff, by radau5", self.stiff_steps);
        count("rejected", self.rejected);
        count("evaluations", self.evaluations);
        count("sweeps", self.sweeps);
        count("factorisations", self.factorisations);
        count("solves", self.solves);
        count("impacts", self.impacts);
        count("events", self.events);
        count("parts of a substep", u64::from(if self.parts > 1 { self.parts } else { 0 }));
        let mut measure = |name, number: f64, unit| {
            if number > 0.0 && number.is_finite() {
                lines.push((name, format!("{} {unit}", short(number))));
            }
        };
        measure("smallest step", self.smallest_step, "s");
        measure("residual", self.residual, "m/s");
        measure("overlap", self.overlap, "m");
        measure("gap of joints", self.gap, "m or rad");
        if let Some(estimate) = self.estimate {
            lines.push(("estimated error", format!("{} relative", short(estimate))));
        }
        if let Some((when, why)) = &self.fallback {
            lines.push(("doubled steps from", format!("{} s: {why}", short(*when))));
        }
        if !self.stages.is_empty() {
            let total: f64 = self.stages.values().sum();
            lines.push(("time", time(total)));
            let share = |(name, seconds): (&String, &f64)| {
                format!("{name} {} ({:.0} %)", time(*seconds), 100.0 * seconds / total)
            };
            lines.push(("of it", self.stages.iter().map(share).collect::<Vec<_>>().join(", ")));
        }
        lines
    }
}

#[pymethods]
impl StepReport {
    /// Name and value of what there is to tell; what did not happen is left out.
    fn rows(&self) -> Vec<(&'static str, String)> {
        self.lines()
    }

    fn __str__(&self) -> String {
        let lines = self.lines();
        let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or_default();
        let line = |(name, value): &(&str, String)| format!("{name:<width$}  {value}");
        lines.iter().map(line).collect::<Vec<_>>().join("\n")
    }

    /// For notebooks.
    fn _repr_html_(&self) -> String {
        let row = |(name, value): &(&str, String)| {
            let value = value.replace('&', "&amp;").replace('<', "&lt;");
            format!(
                "<tr><th style=\"text-align: left\">{name}</th><td style=\"text-align: left\">{value}</td></tr>"
            )
        };
        format!("<table>{}</table>", self.lines().iter().map(row).collect::<String>())
    }
}
