"""What all Python tests share: how hard hypothesis looks.

The fast profile tries the same cases each time.
"""

import os

from hypothesis import settings

settings.register_profile("fast", deadline=None, max_examples=100, derandomize=True)
settings.register_profile("deep", deadline=None, max_examples=20_000)
settings.load_profile(os.environ.get("CULBUTO_PROFILE", "fast"))
