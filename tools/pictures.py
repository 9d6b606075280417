"""The picture of a report that README and the documentation show, made anew from its example.

python -m tools.pictures [FOLDER]   # docs/figures; needs Debian's chromium
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from io import BytesIO
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[1]
EXAMPLE, PICTURE = ROOT / "examples" / "one-effect", "report-one-effect.png"
WIDE, HIGH, COLOURS = 940, 1230, 128
"""Pixels: down to where the arm ends; as many colours as the page has, and a third of the bytes of all."""
CHROMIUM = (
    "chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-background-networking",
)  # fmt: skip


def take(folder: Path) -> Path:
    """Diagnose the example and photograph the top of its report."""
    with tempfile.TemporaryDirectory() as made:
        diagnose = [sys.executable, "-m", "armscope", "diagnose", str(EXAMPLE), "-o", f"{made}/out", "--quiet"]
        subprocess.run(diagnose, check=True)
        window = [f"--window-size={WIDE},{HIGH}", f"--user-data-dir={made}/profile", f"--screenshot={made}/page.png"]
        subprocess.run([*CHROMIUM, *window, f"file://{made}/out/report.html"], check=True, capture_output=True)
        shot = Image.open(BytesIO(Path(made, "page.png").read_bytes())).convert("RGB")
    shot.quantize(COLOURS, dither=Image.Dither.NONE).save(folder / PICTURE, optimize=True)
    return folder / PICTURE


if __name__ == "__main__":
    if shutil.which(CHROMIUM[0]) is None:
        raise SystemExit("chromium is not installed: apt-get install chromium")
    print(take(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "figures"))
