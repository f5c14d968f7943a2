"""Draw all pictures of the pages: `python -m docs.figures [FOLDER]` (`make figures`)."""

from __future__ import annotations

import sys
from pathlib import Path

from docs.figures import all_ink, commands, head, photograph, pulses, readme, tape

PICTURES = Path(__file__).parents[1] / "pictures"


def main(folder: Path) -> None:
    """Draw all pictures into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for figures in (readme, head, pulses, tape, commands, photograph, all_ink):
        figures.main(folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES)
