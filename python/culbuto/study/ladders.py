"""The steps and tolerances of a study."""

from __future__ import annotations

STEPS_A_RUN = tuple(2**k for k in range(4, 15))
STEPS_OF_A_WORLD = tuple(2**k for k in range(4, 11))
TOLERANCES = tuple(10.0**-k for k in range(2, 13))


def allowed(step: float, duration: float) -> float:
    """A step (s); `ValueError` if it is none."""
    if not 0 < step <= max(duration, step):
        message = f"a step is {step}; allowed: a number of seconds above 0"
        raise ValueError(message)
    return step
