# What all rules share: the checked configuration, where results go, and which sources a rule depends on.
import functools
import hashlib
import json
import shlex
import sys
from pathlib import Path

import yaml

from armscope.core.config import Config
from armscope.core.config import with_own_sources
from armscope.core.files import write_text
from armscope.core.inputs import InputError, validate
from armscope.core.provenance import digest

# `snakemake` may be called by its path, without the environment being activated
shell.prefix(f"set -euo pipefail; export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; ")

# a number that --configfile or --config sets must not stand in the report with the source of the one that it replaces
DEFAULTS = yaml.safe_load((Path(workflow.basedir) / "config" / "config.yaml").read_text(encoding="utf-8"))

try:
    CONFIG = validate(Config, with_own_sources(config, DEFAULTS), "configuration (config/config.yaml and what overrides it)")
except InputError as error:
    raise WorkflowError(str(error)) from None

RESULTS = CONFIG.results
RECORDINGS = CONFIG.recordings_dir
MOTIONS = Path(RECORDINGS).parent / "motions"


def settings(step, **parts):
    """The file with the parts of the configuration that a step follows: an input, so that a change reruns this step.

    It is written only when its content changes, beside and then renamed; a rule that names it says by its reason what changed.
    """
    content = json.dumps({name: _plain(part) for name, part in parts.items()}, indent=1) + "\n"
    path = Path(RESULTS) / "settings" / f"{step}.json"
    if not path.is_file() or path.read_text(encoding="utf-8") != content:
        write_text(path, content)
    return str(path)


def _plain(part):
    if isinstance(part, (tuple, list)):
        return [_plain(each) for each in part]
    return part.model_dump(mode="json") if hasattr(part, "model_dump") else part


def fit_settings(step, **changes):
    """What a fit follows, with some of the swarm's settings changed."""
    swarm = CONFIG.paper.swarm.model_copy(update=changes)
    return settings(step, seed=CONFIG.seed, models=CONFIG.paper.models, swarm=swarm)


def require_reach(robot, others, chosen):
    """Stop unless all test paths are within reach under every assumption that will be tried; checked when one changed."""
    files = [robot, *others, chosen]
    seen = hashlib.sha256(b"".join(Path(file).read_bytes() for file in files)).hexdigest()
    mark = Path(RESULTS) / "settings" / "reach.checked"
    if mark.is_file() and mark.read_text(encoding="utf-8") == seen:
        return
    from armscope.cli.paper_plans import follow_all  # slow to import, and seldom needed

    try:
        follow_all(robot, chosen)
    except InputError as error:
        raise WorkflowError(str(error)) from None
    write_text(mark, seen)


def code(*modules):
    """A digest of the package's sources that a rule uses, so that a changed one reruns it; asked for its jobs only."""
    return lambda wildcards: digest(*modules)


PROOF = f"{RESULTS}/proof"
HALVES = ("fixed", "fresh")
PARTS = {"small": 1, "full": CONFIG.proof.parts}
OF_PARTS = {"small": CONFIG.proof.small, "full": CONFIG.proof.parts}


def batches(size):
    """The batches that a proof's worlds are made and diagnosed in."""
    return [f"{half}-{part}" for half in HALVES for part in range(PARTS[size])]


def of_batches(pattern):
    """That file of every batch."""
    return lambda wildcards: expand(pattern, size=wildcards.size, batch=batches(wildcards.size))


def _missing(arm):
    files = [f"{RECORDINGS}/{arm.recordings}", f"{RECORDINGS}/{arm.robot}"]
    return next((file for file in files if not Path(file).is_file()), None)


# real arms whose recordings are there; the others are skipped with a reason
LEFT_OUT = set() if CONFIG.real_sets is None else {*CONFIG.real} - {*CONFIG.real_sets}
SKIPPED = {name: f"{_missing(arm)} is not there" for name, arm in CONFIG.real.items() if _missing(arm)}
SKIPPED |= dict.fromkeys(sorted(LEFT_OUT), "real_sets leaves it out")
REAL = [name for name in CONFIG.real if name not in SKIPPED]
for name, reason in SKIPPED.items():
    logger.warning(f"skipped: real arm {name}, because {reason}")


PROOF_REAL = f"{RESULTS}/proof_real"
CONCEALED_IN = [name for name in CONFIG.proof_real.sets or REAL if name in REAL]


def plant_settings(wildcards):
    """What effects are planted in the recordings of a real set, and how large."""
    arm, chosen = CONFIG.real[wildcards.set], CONFIG.proof_real
    return settings(
        f"plant/{wildcards.set}",
        seed=CONFIG.seed,
        title=wildcards.set,
        run=arm.run,
        first_id=arm.first_id,
        most_rows=chosen.most_rows,
        effects=chosen.effects,
        sizes=chosen.sizes,
    )


def recordings_of(wildcards):
    """The table of a real set."""
    return f"{RECORDINGS}/{CONFIG.real[wildcards.set].recordings}"


def robot_of(wildcards):
    """The nominal arm of a real set."""
    return f"{RECORDINGS}/{CONFIG.real[wildcards.set].robot}"


def raw_files(wildcards):
    """The raw files of a set; other files may lie beside them, such as one that was kept aside."""
    from armscope.recordings.importing.fetching import load_source

    source = load_source(f"config/recordings/{wildcards.public_set}/source.yaml")
    return [f"{RESULTS}/recordings/{wildcards.public_set}/raw/{file.name}" for file in source.files]


def urdf_of(moving_set):
    """The arm of a set: written beside its mapping, or in the local folder that stands in for the network."""
    places = [Path("config/motions", moving_set, "robot.urdf"), MOTIONS / moving_set / "robot.urdf"]
    return next((str(place) for place in places if place.is_file()), None)


def raw_motions(wildcards):
    """The raw files of a set of motions."""
    from armscope.recordings.importing.fetching import load_source

    source = load_source(f"config/motions/{wildcards.moving_set}/source.yaml")
    return [f"{RESULTS}/motions/{wildcards.moving_set}/raw/{file.name}" for file in source.files]


def proof_real_batches(pattern):
    """That file of every batch; columns can be withheld only where a load was recorded."""
    batches = [f"{name}-{part}" for name in CONCEALED_IN for part in ("original", "fixed", "fresh")]
    batches += [f"{name}-withheld" for name in CONCEALED_IN if CONFIG.real[name].loads_recorded]
    return [f"{PROOF_REAL}/{pattern.format(batch=batch)}" for batch in batches]

wildcard_constraints:
    study=r"paper|real/\w+/paper",
    set=r"\w+",


# two fleets may be called fleet.csv: the folder tells them apart
FLEET_IN = [name for name in (Path(CONFIG.fleet).parent.name,) if name not in ("", "config")]
FLEET = f"{RESULTS}/fleet/{'-'.join([*FLEET_IN, Path(CONFIG.fleet).stem])}"
ARMS_PER_JOB = 30  # a job starts once, and an arm takes one or two seconds


@functools.cache
def members():
    """The arms, read once and only when they are asked for: other targets start without."""
    from armscope.fleet.members import read_fleet

    try:
        return read_fleet(Path(CONFIG.fleet))
    except InputError as error:
        raise WorkflowError(str(error)) from None


if "fleet" in config:  # a table that somebody named: what is wrong with it is said at once, as of a sweep's, not from a rule
    members()


def fleet_parts():
    """In how many jobs they are diagnosed."""
    return -(-len(members()) // ARMS_PER_JOB)


def files_of_part(wildcards):
    """What the diagnoses of one job read; a file that is not there costs its own arm only: the page says why."""
    some = members()[int(wildcards.part)::fleet_parts()]
    files = {file for member in some for file in (member.robot, member.recordings)}
    return sorted(str(file) for file in files if file.is_file())
