"""No command ends in a traceback, or touches a file that is not its own, whatever file it is given."""

import numpy as np
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError
from tests.fuzz.mutation import mutated
from tests.fuzz.readers import EXAMPLE, MAPPING, RAW, READERS

MOVING = EXAMPLE.parent / "moving-arm"

FILES = 12
QUICK = "--resamples 0 --no-cross-validation --no-report"
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
    ("recordings.csv", f"diagnose BAD -r ROBOT -o OUT {QUICK}"),
    ("robot.yaml", f"diagnose RECORDINGS -r BAD -o OUT {QUICK}"),
    ("priors.yaml", f"diagnose RECORDINGS -r ROBOT -o OUT --priors BAD {QUICK}"),
    ("motions.csv", "check BAD -r ARM"),
    ("robot.yaml", "check MOTIONS -r BAD"),
    ("motions.csv", "diagnose BAD -r ARM -o OUT --no-report --anyway"),
    ("urdf", "diagnose MOTIONS -r BAD -o OUT --no-report"),
    ("motion model.yaml", "predict BAD MOTIONS -o OUT.csv"),
    ("motions.csv", "predict TORQUES BAD -o OUT.csv"),
    ("raw.csv", "import BAD -m MAPPING -o OUT.csv"),
    ("dh table", "init - -o OUT.yaml"),
    ("robot.yaml", "poses -r BAD -o OUT.csv --count 12 --candidates 60"),
    ("robot.yaml", "excite BAD -o OUT.csv --rounds 1"),
    ("motion mapping.yaml", "import RAW -m BAD -o OUT.csv"),
    ("moving robot.yaml", "check MOTIONS -r BAD"),
    ("motion verdict.json", "excite ARM -o OUT.csv --rounds 1 --separate BAD"),
    ("verdict.json", "excite ARM -o OUT.csv --rounds 1 --separate BAD"),
    ("fleet.csv", "fleet page BAD --verdicts OUT -o OUT"),
    ("sweep.csv", "sweep draw BAD -o OUT"),
    ("reference.yaml", "real protocol RECORDINGS ROBOT BAD -o OUT"),
]
SLOW = {"excite": 3, "poses": 3, "diagnose": 5}
"""Files of those whose good ones take long."""
OF_RESULTS = {"paper", "proof", "closed-loop", "regions", "products", "cross-table", "full-pose", "schema"}
"""Experiments: what they read is written by steps before them, and `tests/test_cli.py` gives them other files."""


@pytest.mark.parametrize(("kind", "line"), LINES, ids=[line for _, line in LINES])
def test_a_bad_file_is_an_answer_or_one_error_and_no_file_is_touched(kind, line, tmp_path):
    rng, reader = np.random.default_rng([3, *line.encode()]), READERS[kind]
    seeds = [path.read_bytes() for path in reader.seeds if "one-effect" not in path.name]
    places = {name: tmp_path / file for name, file in (("MODEL", "model.yaml"), ("PATH", "path.csv"), ("OUT", "out"))}
    places |= {"ROBOT": EXAMPLE / "robot.yaml", "RECORDINGS": EXAMPLE / "recordings.csv", "RAW": RAW}
    places |= {"ARM": MOVING / "robot.yaml", "MOTIONS": READERS["motions.csv"].seeds[0], "MAPPING": MAPPING}
    places["TORQUES"] = READERS["motion model.yaml"].seeds[0]
    places["BAD"] = tmp_path / ("domain.json" if kind == "domain.json" else f"bad{reader.suffix}")
    places["MODEL"].write_bytes(model := _five_effects("model.yaml"))
    places["PATH"].write_bytes(path := READERS["path.csv"].seeds[0].read_bytes())
    for _ in range(SLOW.get(line.split()[0], FILES)):
        (tmp_path / "domain.json").write_bytes(_five_effects("domain.json"))
        bad = mutated(seeds[rng.integers(len(seeds))], seeds, rng)
        places["BAD"].write_bytes(bad)
        words = [_placed(word, places) for word in line.split()]
        error = CliRunner().invoke(app, words, input=bad if kind == "dh table" else None).exception
        assert error is None or isinstance(error, InputError | SystemExit), (bad, error)
        assert places["BAD"].read_bytes() == bad
        assert places["MODEL"].read_bytes() == model
        assert places["PATH"].read_bytes() == path


BAD_OPTIONS = [
    "diagnose RECORDINGS -r ROBOT -o OUT --seed -1",
    "fit-error-model RECORDINGS -r ROBOT -o OUT.json --method swarm --seed -1",
    "compensate MODEL PATH -o OUT.csv --allowed-outside nan",
    "compensate MODEL PATH -o OUT.csv --allowed-outside inf",
    "poses -r ROBOT -o OUT.csv --candidates 40 --radius-mm inf",
    "poses -r ROBOT -o OUT.csv --candidates 40 --radius-mm 1e9",
    "poses -r ROBOT -o OUT.csv --candidates 40 --floor-mm nan",
    "poses -r ROBOT -o OUT.csv --candidates 40 --noise-mm inf",
    "poses -r ROBOT -o OUT.csv --candidates 40 --effects ,",
    "excite ARM -o OUT.csv --rounds 1 --period-s inf",
    "excite ARM -o OUT.csv --rounds 1 --period-s 1e300",
    "excite ARM -o OUT.csv --rounds 1 --rate-hz 1e308",
    "excite ARM -o OUT.csv --rounds 1 --radius-mm 1e9",
]
"""Found by attacking: each ended in a traceback, or was taken for a number."""


@pytest.mark.parametrize("line", BAD_OPTIONS)
def test_a_number_that_no_command_can_follow_is_one_error(line, tmp_path):
    places = {"ROBOT": EXAMPLE / "robot.yaml", "RECORDINGS": EXAMPLE / "recordings.csv", "OUT": tmp_path / "out"}
    places |= {"ARM": MOVING / "robot.yaml", "PATH": READERS["path.csv"].seeds[0], "MODEL": tmp_path / "model.yaml"}
    places["MODEL"].write_bytes(_five_effects("model.yaml"))
    (tmp_path / "domain.json").write_bytes(_five_effects("domain.json"))
    error = CliRunner().invoke(app, [_placed(word, places) for word in line.split()]).exception
    assert isinstance(error, InputError) or (isinstance(error, SystemExit) and error.code == 2), error
    assert not list(tmp_path.glob("out*"))


def _five_effects(kind):
    """The file of a kind that belongs to the example's arm."""
    return next(path for path in READERS[kind].seeds if path.stem == "five-effects").read_bytes()


def _placed(word, places):
    name, dot, ending = word.partition(".")
    return f"{places[name]}{dot}{ending}" if name in places else word


def test_every_command_that_reads_a_users_file_is_given_bad_ones():
    known = {line.split()[0] for _, line in LINES}
    names = set()
    for group in app.registered_groups:
        for command in group.typer_instance.registered_commands:
            own = command.name or command.callback.__name__.rstrip("_").replace("_", "-")
            names.add(group.name if group.name else own)
    assert names - known - OF_RESULTS == set()
