"""No reader raises anything but InputError, whatever file it is given, within bounds of time and memory."""

import gzip
import subprocess
import sys

import hypothesis
import pytest
from hypothesis import strategies as st

from tests.fuzz.__main__ import CASES, failure_of
from tests.fuzz.mutation import ODD_VALUES, changed, places, text_of, tree_of
from tests.fuzz.readers import READERS, ROOT

FILES = 8
"""For each reader; `make fuzz` tries them for an hour."""
MANY_PURPOSES = ("mapping.yaml", "config.yaml", "poses.csv")
"""Some of their seeds are good for other raw files, a part of a whole, or paths of points."""
TREES = [name for name, reader in READERS.items() if reader.suffix in (".yaml", ".json")]
FOUND = sorted(CASES.glob("*/*"))


@pytest.mark.parametrize("name", READERS)
def test_the_files_to_begin_from_are_good(name, tmp_path):
    for seed in READERS[name].seeds:
        path = tmp_path / seed.name
        path.write_bytes(seed.read_bytes())
        if name not in MANY_PURPOSES:
            READERS[name].read(path)
        assert failure_of(name, path) == ""


@pytest.fixture(scope="module")
def fuzzed(tmp_path_factory):
    """One process for all readers, as `make fuzz` has it: its start takes longer than a reader's files."""
    kept = tmp_path_factory.mktemp("kept")
    command = [sys.executable, "-m", "tests.fuzz", "--files", FILES, "--seconds", 250, "--seed", 1, "--keep", kept]
    done = subprocess.run([*map(str, command)], cwd=ROOT, capture_output=True, text=True, check=False, timeout=280)
    return dict(line.split(": ", 1) for line in done.stdout.splitlines()), done.stderr


@pytest.mark.parametrize("name", READERS)
def test_bytes_that_were_changed_are_an_answer_or_one_error(name, fuzzed):
    counts, failures = fuzzed
    assert counts.get(name) == f"{FILES} files, 0 failures", failures


@pytest.mark.parametrize("name", TREES)
@pytest.mark.parametrize("trees", [20, pytest.param(80, marks=pytest.mark.long)])
def test_values_that_were_swapped_are_an_answer_or_one_error(name, trees, tmp_path_factory):
    drawn = hypothesis.settings(max_examples=trees, deadline=None, derandomize=True, database=None)
    path = tmp_path_factory.mktemp("tree") / f"bad{READERS[name].suffix}"
    drawn(hypothesis.given(st.data())(lambda data: swapped(name, path, data)))()


def swapped(name, path, data):
    reader = READERS[name]
    tree = tree_of(data.draw(st.sampled_from(reader.seeds)))
    for _ in range(data.draw(st.integers(1, 2))):
        place = data.draw(st.sampled_from(places(tree)))
        what = data.draw(st.sampled_from(["swap", "swap", "drop", "rename", "double"]))
        tree = changed(tree, place, what, data.draw(st.sampled_from(ODD_VALUES)))
    path.write_bytes(text_of(tree, reader.suffix))
    assert failure_of(name, path) == ""


@pytest.mark.parametrize("case", FOUND, ids=[f"{path.parent.name}-{path.stem}" for path in FOUND])
def test_what_was_found_once_stays_mended(case, tmp_path):
    path = tmp_path / case.name
    path.write_bytes(case.read_bytes())
    assert failure_of(case.parent.name, path) == ""


def aliases():
    lists = "a: &a [1,2,3,4,5,6,7,8,9]\n"
    lists += "".join(f"{chr(98 + i)}: &{chr(98 + i)} [{','.join(['*' + chr(97 + i)] * 9)}]\n" for i in range(9))
    return lists.encode()


def many_joints():
    joints = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="continuous"><parent link="l{i}"/><child link="l{i + 1}"/></joint>'
        for i in range(3000)
    )
    return f'<robot name="a">{joints}<link name="l3000"/></robot>'.encode()


def entities():
    longer = b"".join(b'<!ENTITY %c "%s">' % (98 + i, b"&%c;" % (97 + i) * 10) for i in range(9))
    return b'<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa">' + longer + b']><robot name="&j;"/>'


BOMBS = {
    "aliases": aliases,
    "deep lists": lambda: b"[" * 900_000,
    "deep mappings": lambda: b'{"a":' * 180_000,
    "long number": lambda: b"a: " + b"9" * 900_000,
    "many numbers": lambda: b"k: [" + b"1.5, " * 170_000 + b"1]",
    "many keys": lambda: b"".join(b"k%d: 1\n" % i for i in range(80_000)),
    "sixties": lambda: b"a: " + b":".join([b"1"] * 400_000),
    "long word": lambda: b"a" * 900_000,
    "commas": lambda: b"," * 900_000,
    "many columns": lambda: b",".join(b"q%d_rad" % i for i in range(90_000)) + b"\n" + b",".join([b"0"] * 90_000),
    "quotation mark": lambda: b'q1_rad,x_mm,y_mm,z_mm\n"' + b"1,2\n" * 200_000,
    "long rows": lambda: b"q1_rad,x_mm,y_mm,z_mm\n" + b"1,2,3,4\n" * 100_000,
    "nulls": lambda: bytes(900_000),
    "many joints": many_joints,
    "deep elements": lambda: b"<robot>" + b"<a>" * 200_000,
    "entities": entities,
    "long name": lambda: b"q1_rad," + b"_" * 900_000 + b"\n1,2\n3,4\n",
    "short lines": lambda: b"1 2 3 4\n" * 110_000,
    "many rows": lambda: b"name: a\ndh:\n  joints:\n" + b"  - {a_mm: 1, alpha_deg: 90, d_mm: 1}\n" * 20_000,
}
"""Small files that would take all time or memory, made when they are asked for."""


LATER = ("many numbers", "many rows", "sixties", "short lines", "deep elements")
"""What takes no other way through a reader than many keys do, but for the rows of an arm."""


@pytest.mark.parametrize(
    ("kind", "readers"),
    [
        *(pytest.param(kind, READERS, marks=[pytest.mark.long] * (kind in LATER), id=kind) for kind in BOMBS),
        pytest.param("many rows", ["robot.yaml"], id="many rows of an arm"),
    ],
)
def test_a_file_below_a_megabyte_takes_bounded_time_and_memory(kind, readers, tmp_path):
    content = BOMBS[kind]()
    for name in readers:
        reader = READERS[name]
        path = tmp_path / f"{name}-bomb{reader.suffix}"
        path.write_bytes(content)
        assert failure_of(name, path) == "", name


def test_a_packed_bomb_is_refused(tmp_path):
    packed = gzip.compress(b"1,2,3,4\n" * 20_000_000, mtime=0)
    assert len(packed) < 1_000_000
    for name in ("recordings.csv", "domain.json", "errormodel.json", "raw.csv"):
        path = tmp_path / f"{name}.gz"
        path.write_bytes(packed)
        assert failure_of(name, path) == "", name
