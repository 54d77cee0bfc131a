"""The report: every scene by every method, as rows, figures and one page."""
