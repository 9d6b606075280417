"""On a dark screen charts that were drawn for white paper turn dark, and keep their hues."""

import base64
import io
import shutil
import subprocess

import numpy as np
import pytest
from PIL import Image

from armscope.report.html import render_page

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
SIZE = 400


def seen(page, dark):
    """The middle of the left and of the right half of a page's chart, as a browser shows it."""
    picture = page.with_suffix(".png")
    subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--window-size={SIZE},{SIZE}",
         f"--user-data-dir={page.parent}/b",
         f"--blink-settings=preferredColorScheme={0 if dark else 1}", f"--screenshot={picture}", page.as_uri()],
        check=True, capture_output=True, timeout=120,
    )  # fmt: skip
    shown = np.asarray(Image.open(picture).convert("RGB")).astype(int)
    return shown[100, SIZE // 4], shown[100, 3 * SIZE // 4]


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_a_chart_does_not_glare_from_a_dark_page(tmp_path):
    chart = Image.new("RGB", (SIZE, SIZE), "white")
    chart.paste((0, 114, 178), (SIZE // 2, 0, SIZE, SIZE))
    packed = io.BytesIO()
    chart.save(packed, "png")
    figure = f'<figure><img src="data:image/png;base64,{base64.b64encode(packed.getvalue()).decode()}" alt=""></figure>'
    page = tmp_path / "page.html"
    page.write_text(render_page("base.html.j2").replace("<main>", f"<main>{figure}"))
    for dark in (False, True):
        paper, blue = seen(page, dark)
        assert (paper.max() < 60) == dark
        assert (paper.min() > 250) == (not dark)
        assert blue.argmax() == 2, "blue stays blue"
