"""Numbers that decide have a unit, a meaning and a basis, and the page about them is what the code is."""

import ast
import importlib
import importlib.util
import linecache
import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from scipy.stats import chi
from tools import constants

from armscope.core.constants import BASES, Constants, Entry, entries
from armscope.inference.constants import BUDGET, PRIORS
from armscope.measurement.constants import NOISE, WEIGHTS

PACKAGE = Path(__file__).parents[2] / "src" / "armscope"


def bare_numbers(path: Path) -> Iterator[str]:
    """Names of a module's own numbers that no group of constants holds."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
            inside = list(ast.walk(node.value))
            literal = not any(isinstance(each, ast.Dict | ast.Call | ast.Name | ast.JoinedStr) for each in inside)
            values = [each.value for each in inside if isinstance(each, ast.Constant)]
            if literal and values and all(isinstance(value, int | float) for value in values):
                yield ast.unparse(node.target if isinstance(node, ast.AnnAssign) else node.targets[0])


def test_the_page_is_made_from_the_code_as_it_is() -> None:
    assert constants.PAGE.read_text(encoding="utf-8") == constants.page()


def test_every_number_has_a_meaning_and_a_basis() -> None:
    numbers = [number for group in constants.groups() for number in entries(group)]
    assert len(numbers) > 50
    for number in numbers:
        assert number.meaning, number
        assert number.basis.partition(":")[0] in BASES, number


@pytest.mark.parametrize("room", constants.ROOMS)
def test_no_number_decides_without_them(room: str) -> None:
    bare = {path.name: names for path in (PACKAGE / room).rglob("*.py") if (names := list(bare_numbers(path)))}
    assert not bare


GROUP = '''
from dataclasses import dataclass
from armscope.core.constants import Constants


@dataclass(frozen=True)
class Group(Constants):
    """A group."""

    much: float = 1.0
    """{said}"""
'''


def _loaded(file: Path) -> type[Constants]:
    spec = importlib.util.spec_from_file_location("group", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["group"] = module  # where a dataclass looks up its annotations
    linecache.checkcache(str(file))
    spec.loader.exec_module(module)
    group: type[Constants] = module.Group
    return group


def test_a_number_without_a_basis_is_noticed(tmp_path: Path) -> None:
    for said in ("how much", "how much; judgement", "how much; judgement: ", "how much; felt right: yes", "; measured"):
        group = tmp_path / "group.py"
        group.write_text(GROUP.format(said=said), encoding="utf-8")
        with pytest.raises(ValueError, match="basis"):
            entries(_loaded(group))
    module = tmp_path / "module.py"
    module.write_text(
        'A = 3\nB, C = 1.0, 2\nD: float = -1e-3\nE = "word"\nF = f(3)\n__all__ = ["A"]\n', encoding="utf-8"
    )
    assert list(bare_numbers(module)) == ["A", "(B, C)", "D"]


MODULES = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*constants.py") if path.parent.name != "core")


@pytest.mark.parametrize("module", [str(path) for path in MODULES])
def test_every_group_of_any_room_tells_of_its_numbers(module: str) -> None:
    home = importlib.import_module(f"armscope.{module.removesuffix('.py').replace('/', '.')}")
    own = [each for each in vars(home).values() if isinstance(each, type) and each.__module__ == home.__name__]
    assert all(entries(each) for each in own if issubclass(each, Constants))


@dataclass(frozen=True)
class Told(Constants):
    """Numbers and what stands below them."""

    long_m: float = 1.0
    """how long a thing
    is [m]; measured: with a ruler"""
    turns: int = 2
    """of a screw; convention"""


@dataclass(frozen=True)
class Silent(Constants):
    """A number of which nothing is said."""

    long_m: float = 1.0


@dataclass(frozen=True)
class Groundless(Constants):
    """A number that rests on nothing."""

    long_m: float = 1.0
    """how long a thing is [m]; judgement"""


def test_what_stands_below_a_number_is_read() -> None:
    assert entries(Told) == [
        Entry("long_m", 1.0, "m", "how long a thing is", "measured: with a ruler"),
        Entry("turns", 2, "", "of a screw", "convention"),
    ]
    for group in (Silent, Groundless):
        with pytest.raises(ValueError, match=r"long_m.*basis"):
            entries(group)


def test_groups_are_frozen() -> None:
    group = constants.groups()[0]
    with pytest.raises(AttributeError, match="cannot assign"):
        setattr(group(), entries(group)[0].name, 0)
    assert issubclass(group, Constants)


def test_derived_numbers_are_what_their_formulas_give() -> None:
    assert chi(3).sf(WEIGHTS.tuning_constant) == pytest.approx(1 / 6000, rel=0.15)
    assert BUDGET.most_orders == math.factorial(5)
    for nats in (PRIORS.sure_nats, NOISE.sure_nats):
        assert nats == pytest.approx(math.log(20), abs=0.01)
