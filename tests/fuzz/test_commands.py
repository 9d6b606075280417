"""No command ends in a traceback, or touches a file that is not its own, whatever file it is given."""

import numpy as np
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError
from tests.fuzz.mutation import mutated
from tests.fuzz.readers import EXAMPLE, RAW, READERS

FILES = 12
LINES = [
    ("robot.yaml", "predict BAD RECORDINGS -o OUT.csv"),
    ("recordings.csv", "predict ROBOT BAD -o OUT.csv"),
    ("model.yaml", "predict BAD RECORDINGS -o OUT.csv"),
    ("errormodel.json", "predict BAD RECORDINGS -o OUT.csv --pose"),
    ("model.yaml", "compensate BAD PATH -o OUT.json"),
    ("errormodel.json", "compensate BAD PATH -o OUT.mod"),
    ("path.csv", "compensate MODEL BAD -o OUT.csv"),
    ("domain.json", "compensate MODEL PATH -o OUT.csv"),
    ("recordings.csv", "check BAD -r ROBOT"),
    ("robot.yaml", "check RECORDINGS -r BAD"),
    ("recordings.csv", "fit-error-model BAD -r ROBOT -o OUT.json"),
    ("mapping.yaml", "import RAW -m BAD -o OUT.csv.gz"),
    ("source.yaml", "fetch BAD -o OUT --recordings-dir ."),
    ("urdf", "check RECORDINGS -r BAD"),
    ("urdf", "init BAD -o OUT.yaml"),
    ("foreign.csv", "init BAD -o OUT.yaml"),
    ("recordings.csv", "compare RECORDINGS BAD -r ROBOT -o OUT"),
    ("recordings.csv", "calibrate BAD -r ROBOT -o OUT --splits 0"),
]


@pytest.mark.parametrize(("kind", "line"), LINES, ids=[line for _, line in LINES])
def test_a_bad_file_is_an_answer_or_one_error_and_no_file_is_touched(kind, line, tmp_path):
    rng, reader = np.random.default_rng([3, *line.encode()]), READERS[kind]
    seeds = [path.read_bytes() for path in reader.seeds if "one-effect" not in path.name]
    places = {name: tmp_path / file for name, file in (("MODEL", "model.yaml"), ("PATH", "path.csv"), ("OUT", "out"))}
    places |= {"ROBOT": EXAMPLE / "robot.yaml", "RECORDINGS": EXAMPLE / "recordings.csv", "RAW": RAW}
    places["BAD"] = tmp_path / ("domain.json" if kind == "domain.json" else f"bad{reader.suffix}")
    places["MODEL"].write_bytes(model := _five_effects("model.yaml"))
    places["PATH"].write_bytes(path := READERS["path.csv"].seeds[0].read_bytes())
    for _ in range(FILES):
        (tmp_path / "domain.json").write_bytes(_five_effects("domain.json"))
        bad = mutated(seeds[rng.integers(len(seeds))], seeds, rng)
        places["BAD"].write_bytes(bad)
        words = [_placed(word, places) for word in line.split()]
        error = CliRunner().invoke(app, words).exception
        assert error is None or isinstance(error, InputError | SystemExit), (bad, error)
        assert places["BAD"].read_bytes() == bad
        assert places["MODEL"].read_bytes() == model
        assert places["PATH"].read_bytes() == path


def _five_effects(kind):
    """The file of a kind that belongs to the example's arm."""
    return next(path for path in READERS[kind].seeds if path.stem == "five-effects").read_bytes()


def _placed(word, places):
    name, dot, ending = word.partition(".")
    return f"{places[name]}{dot}{ending}" if name in places else word
