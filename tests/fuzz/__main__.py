"""`python -m tests.fuzz [reader ...] --seconds 60 --seed 1`: bad files for every reader; failures are kept as cases."""

from __future__ import annotations

import argparse
import hashlib
import math
import resource
import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path

import numpy as np

from armscope.core.inputs import InputError
from tests.fuzz.mutation import mutated
from tests.fuzz.readers import READERS

CASES = Path(__file__).parent / "cases"
LONGEST_S, MOST_MEMORY_MB = 2.0, 500.0


def used_mb() -> float:
    """The most memory that this process has had so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def failure_of(name: str, path: Path) -> str:
    """Why a reader's answer to a file is none; empty where it is one."""
    started, before = time.process_time(), used_mb()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            READERS[name].read(path)
    except InputError as error:
        if len(str(error)) > 20_000 or "\x1b" in str(error):
            return f"an error of {len(str(error))} characters"
    except Exception:
        return traceback.format_exc()
    took = time.process_time() - started
    if took > LONGEST_S:
        return f"took {took:.1f} s"
    return f"took {used_mb() - before:.0f} MB" if used_mb() - before > MOST_MEMORY_MB else ""


def fuzz(
    name: str, seconds: float, seed: int, keep: Path | None, files: float = math.inf
) -> tuple[int, dict[str, bytes]]:
    """Bad files for one reader, for so long or so many: how many, and one for each kind of failure."""
    rng, seeds = np.random.default_rng([seed, *name.encode()]), [path.read_bytes() for path in READERS[name].seeds]
    found: dict[str, bytes] = {}
    count, end = 0, time.perf_counter() + seconds
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"bad{READERS[name].suffix}"
        last = None if keep is None else keep / f"{name}.last"
        while time.perf_counter() < end and count < files:
            content = mutated(seeds[rng.integers(len(seeds))], seeds, rng)
            path.write_bytes(content)
            if last is not None:  # what brings the process down is there to be looked at
                last.write_bytes(content)
            failure = failure_of(name, path)
            count += 1
            kind = "\n".join(line for line in failure.splitlines()[-8:] if 'File "' in line) or failure[:20]
            if failure and kind not in found:
                found[kind] = content
                print(f"{name}: {failure}", file=sys.stderr)
        if last is not None:
            last.unlink(missing_ok=True)
    return count, found


def main() -> None:
    """Fuzz some readers, or all, for so many seconds together."""
    options = argparse.ArgumentParser()
    options.add_argument("readers", nargs="*")
    options.add_argument("--seconds", type=float, default=60)
    options.add_argument("--files", type=float, default=math.inf, help="at most so many for each reader")
    options.add_argument("--seed", type=int, default=int(time.time()))
    options.add_argument("--keep", type=Path, default=CASES, help="where failing files go")
    given = options.parse_args()
    names = given.readers or list(READERS)
    failed = 0
    given.keep.mkdir(parents=True, exist_ok=True)
    for name in names:
        count, found = fuzz(name, given.seconds / len(names), given.seed, given.keep, given.files)
        print(f"{name}: {count} files, {len(found)} failures")
        failed += len(found)
        for content in found.values():
            case = given.keep / name / f"{hashlib.sha256(content).hexdigest()[:12]}{READERS[name].suffix}"
            case.parent.mkdir(exist_ok=True)
            case.write_bytes(content)
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
