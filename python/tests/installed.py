"""A wheel that was just installed, where nothing else of the tests is: it has this version and finds a moving square.

python python/tests/installed.py VERSION
"""

from __future__ import annotations

import sys

import numpy as np
import scenes
import veronese


def main(version: str) -> None:
    if veronese.__version__ != version:
        sys.exit(f"The wheel has version {veronese.__version__}, not {version}.")
    first, second = scenes.frame(0), scenes.frame(1)
    found = veronese.segment_pair(first, second, quality="fast")
    right = np.mean(found.labels == scenes.square_mask(0, inside=1, outside=0))
    if len(found.motions) != 2 or right < 0.98:
        sys.exit(f"{len(found.motions)} motions were found, and {right:.1%} of the pixels are right.")
    print(f"veronese {version} of {veronese.__file__} works.")


if __name__ == "__main__":
    main(sys.argv[1])
