"""The `culbuto` command as a shell sees it."""

import subprocess
import sys

import culbuto


def test_version() -> None:
    command = [sys.executable, "-m", "culbuto", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout == f"culbuto, version {culbuto.__version__}\n"
