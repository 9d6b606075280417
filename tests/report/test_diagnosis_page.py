import html.parser
import re
import shutil
import subprocess

import pytest

from armscope.report.pages.diagnosis import write_report
from armscope.report.sections.assumptions import assumptions
from armscope.report.sections.registry import SECTIONS
from armscope.verdict.schema import WaterfallStep
from armscope.verdict.sentences import headline
from tests.report import verdicts
from tests.report.verdicts import CASES

PAGES = ["five", "clean", "unknowns", "cannot_tell"]
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


class Page(html.parser.HTMLParser):
    """What a test asks of a page: its text, its ids, and everything it refers to."""

    def __init__(self, source):
        super().__init__()
        self.text, self.ids, self.references, self.tags, self.open = "", [], [], [], []
        self.feed(source)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag not in ("meta", "link", "img", "br", "hr", "input"):
            self.open.append(tag)
        for name, value in attrs:
            if name == "id":
                self.ids.append(value)
            if name in ("src", "href", "data", "action", "srcset"):
                self.references.append(value)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, f"</{tag}> closes something else"

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "script"):
            self.text += data

    @property
    def words(self):
        return re.sub(r"\s+", " ", self.text)


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Where the page of a case is; it is written when it is first asked for, whichever test asks."""
    folder = tmp_path_factory.mktemp("reports")

    def page(name):
        path = folder / name / "report.html"
        if not path.exists():
            case = CASES[name]()
            write_report(case.verdict, path.parent)
        return path

    return page


@pytest.fixture(scope="module")
def five(pages):
    """The page with five effects, for tests that open it in a browser."""
    return pages("five")


@pytest.fixture(scope="module", params=PAGES)
def written(request, pages):
    path = pages(request.param)
    source = path.read_text()
    return CASES[request.param](), path, source, Page(source)


def test_the_page_needs_nothing_but_itself(written):
    _, _, source, page = written
    assert all(ref.startswith("#") or ref == "work-order.html" for ref in page.references)
    assert not {"link", "iframe", "object"} & set(page.tags)
    assert "default-src 'none'" in source.split("<title>")[0]  # the browser itself refuses to fetch anything
    style = source.split("<style>", 1)[1].split("</style>")[0]
    assert "url(" not in style
    assert "@import" not in style


def test_every_link_inside_the_page_leads_somewhere(written):
    page = written[3]
    assert {ref[1:] for ref in page.references if ref.startswith("#")} <= set(page.ids)
    assert len(page.ids) == len(set(page.ids))
    assert page.open == []


def test_the_answer_stands_first(written):
    case, _, _, page = written
    causes, _, rest = headline(case.verdict).partition(". ")
    first, *others = causes.split("; ")
    lines = [f"{first}."] if not others else [first, *(other[:1].upper() + other[1:] for other in others)]
    assert 0 <= page.words.find(" ".join([*lines, rest]).strip()) < 400


def test_every_effect_has_its_card_with_how_to_confirm_and_cure(written):
    case, _, _, page = written
    anchors = [anchor for anchor in page.ids if anchor.startswith("effect-")]
    assert len(anchors) == len(case.verdict.effects)
    for effect in case.verdict.effects:
        if not effect.minor:
            assert effect.confirm in page.words
            assert effect.cure in page.words
            assert effect.physics in page.words


def test_the_figures_are_files_too(written):
    case, path, _, page = written
    figures = path.parent / "figures"
    names = {file.stem for file in figures.iterdir()}
    assert {"arm", "along_joints"} <= names
    assert ("waterfall" in names) == bool(case.verdict.waterfall)
    for file in figures.iterdir():
        assert file.suffix == ".svg"
        drawn = file.read_text().replace(' style="background: #fff"', "")
        assert drawn in path.read_text(), "the page shows what the file holds"
    assert page.tags.count("img") == 0


def test_suspect_rows_and_next_poses_are_listed(pages):
    page = Page(pages("five").read_text())
    assert "These rows fit so badly" in page.words
    assert re.search(r"\b17\s+0\.430\s+0\.06", page.words)
    undecided = Page(pages("cannot_tell").read_text())
    assert undecided.words.count("pose") > 5
    assert "Measuring each about 3 times would settle it." in undecided.words


def test_text_from_outside_is_shown_not_run(pages):
    """A notice (or a name in a table) may hold anything."""
    source = pages("cannot_tell").read_text()
    assert "<no name>" not in source
    assert "&lt;no name&gt;" in source


def test_a_limit_of_the_verdict_stands_before_its_details(pages):
    page = Page(pages("cannot_tell").read_text())
    assert page.words.index("40 rows are fewer") < page.words.index("Where the trouble is")


def test_the_path_of_the_table_stays_private(written):
    case, _, source, _ = written
    assert "somebody" in case.verdict.source
    assert "somebody" not in source


def test_what_was_not_recorded_is_said():
    case = verdicts.single()
    told = " ".join(assumptions(case.verdict, case.arm, case.recordings))
    assert "temperature (thermal expansion)" in told
    assert "masses that robot.yaml states" in told


def test_where_nothing_was_fitted_nothing_is_promised(pages):
    """No model, no number for it, no validation, no advice to act on."""
    page = Page(pages("cannot_tell").read_text())
    assert "No effect was fitted" in page.words
    assert "error with the fitted model" not in page.words
    assert "What to do" not in page.words


def test_the_same_verdict_gives_the_same_page(pages, tmp_path):
    case = CASES["cannot_tell"]()
    again = write_report(case.verdict, tmp_path)
    assert again.read_bytes() == pages("cannot_tell").read_bytes()


MEASURE = """<script>addEventListener("load", () => {
  const wide = [...document.querySelectorAll("main *")].filter(e => !e.closest(".scroll, .wide")
    && !e.closest("svg") && e.getBoundingClientRect().right > innerWidth + 1).length;
  const high = document.documentElement.scrollHeight;
  document.querySelectorAll("details").forEach(d => { d.open = true; });
  const drawn = [...document.querySelectorAll(".wide svg")];
  const broken = drawn.filter(i => i.getBoundingClientRect().width < 100).length;
  document.querySelectorAll("figure.field").forEach(f => f.field.draw());
  document.body.innerHTML = `MEASURED ${wide} too wide, ${broken} broken of ${drawn.length}, `
    + `${document.documentElement.scrollWidth <= innerWidth} at ${innerWidth}, ${high} high`;
});</script>"""


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
@pytest.mark.parametrize("width", [1280, 500])
def test_a_browser_shows_it_whole_at_desktop_and_narrow_width(five, tmp_path, width):
    source = five.read_text()
    measured = tmp_path / "page.html"
    measured.write_text(source.replace("</body>", f"{MEASURE}</body>"))
    flags = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--virtual-time-budget=4000",
        f"--user-data-dir={tmp_path}/b",
    ]
    # every name resolves to nothing: what the page shows, it shows without a network
    offline = ["--host-resolver-rules=MAP * ~NOTFOUND", f"--window-size={width},3000"]
    shot = tmp_path / "page.png"
    done = subprocess.run(
        [CHROMIUM, *flags, *offline, f"--screenshot={shot}", "--dump-dom", measured.as_uri()],
        capture_output=True, text=True, timeout=90, check=False,
    )  # fmt: skip
    images = len(list((five.parent / "figures").glob("*.svg")))
    assert f"MEASURED 0 too wide, 0 broken of {images}, true at {width}" in done.stdout, done.stderr[-500:]


ABOVE_THE_FOLD = ("nats", "driver", "posture to posture", "pose to pose", "everywhere")


def test_plain_words_stand_above_the_fold(written):
    """Up to where the trouble is: what a service engineer reads first."""
    page = written[3]
    first = page.words[: page.words.index("The arm in one of the recorded poses")].lower()
    assert [word for word in ABOVE_THE_FOLD if word in first] == []


def test_explained_never_stands_beside_more_than_noise(tmp_path):
    told = verdicts.Notice("model error", "What is left is more than noise, and no effect explains it: joint 2 errs.")
    case = verdicts.case(effects=(verdicts.compliance(),), notices=(told,))
    source = write_report(case.verdict, tmp_path).read_text()
    assert '<span class="tag depends">partly explained</span>' in source
    assert 'class="tag holds"' not in source.split("<body>")[1]


def test_errors_are_promised_for_other_rows_only_where_these_confirm_the_model(tmp_path):
    for after, confirmed in ((0.1, True), (6.8, False)):
        case = verdicts.case(effects=(verdicts.compliance(),), held_out=verdicts.HeldOut(1.3, after))
        report = write_report(case.verdict, tmp_path / str(confirmed))
        for page in (report, report.with_name("work-order.html")):
            source = page.read_text()
            assert ("predicted worse with this model" in source) != confirmed
        assert ("Errors are those to expect on new poses" in report.read_text()) == confirmed
        assert ("on poses that took no part in the fit" in report.with_name("work-order.html").read_text()) == confirmed
        assert ('class="tag holds"' in report.read_text().split("<body>")[1]) == confirmed


def test_what_is_expected_of_a_step_is_as_sure_as_parts_of_the_rows_are_alike(tmp_path):
    for spread, told in ((0.325, True), (float("nan"), False)):
        steps = (WaterfallStep("free frames", 1.25, 1.3, spread),)
        case = verdicts.case(
            effects=(verdicts.compliance(),), held_out=verdicts.HeldOut(1.3, 0.1, folds=5), waterfall=steps
        )
        report = write_report(case.verdict, tmp_path / str(told))
        for page in (report, report.with_name("work-order.html")):
            text = page.read_text().replace("\u00a0", " ")
            assert ("± 25 %" in text) == told
        text = report.read_text().replace("\u00a0", " ")
        assert ("5 parts that were held out by turns had 1.3 mm ± 25 %" in text) == told
        assert not re.search(r"[a-z]\.<a", text), "a space stands between sentences"


def test_a_value_beyond_what_arms_have_is_not_printed(tmp_path):
    numbers = verdicts.Parameter("a", "mm", 844.0, 65.0), verdicts.Parameter("alpha", "rad", 7e-4, 1e-5)
    case = verdicts.case(effects=(verdicts.found("link_geometry", "link 2", *numbers),))
    path = write_report(case.verdict, tmp_path)
    order = path.with_name("work-order.html")
    for page in (path, order):
        assert "844" not in page.read_text().split("application/json")[0]
    assert not path.with_name("corrected_dh.csv").exists(), "a table without it would be half of one"
    assert "enter nothing before" in order.read_text()
    assert "corrected_dh.csv" not in order.read_text()
    assert "undetermined" in path.read_text()
    assert "844" not in case.verdict.headline


def test_every_section_that_applies_stands_on_the_page_in_its_order_and_is_linked(written):
    case, _, _, page = written
    wanted = [section.name for section in SECTIONS if section.applies(case.verdict)]
    folded = {section.name for section in SECTIONS if section.folded}
    shown = [name for name in page.ids if name in {section.name for section in SECTIONS}]
    assert shown == sorted(wanted, key=folded.__contains__), "what is folded stands below"
    assert [ref[1:] for ref in page.references if ref[1:] in wanted][: len(wanted)] == wanted


def test_a_section_is_a_file_of_its_own_and_its_figures_are():
    names = [section.name for section in SECTIONS]
    assert len(set(names)) == len(names)
    drawing = [figure for section in SECTIONS for figure in section.figures]
    assert len({figure.__module__ for figure in drawing}) == len(drawing)


def test_without_an_atlas_there_is_no_section_for_it(tmp_path):
    case = verdicts.case(rows=40, atlas=None, waterfall=())
    page = Page(write_report(case.verdict, tmp_path).read_text())
    assert "atlas" not in page.ids
    assert "#atlas" not in page.references
