"""`python -m armscope` and the command `armscope`: even while it imports, Ctrl-C is answered in one line."""

import gc
import os
import sys


def main() -> None:
    """Run the command line."""
    gc.set_threshold(20_000, 20, 20)  # imports make many objects and no rubbish: a tenth of their time
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # looking for them takes as long as reading YAML
    try:
        from armscope.cli import main as run
        from armscope.core.deferral import defer

        defer("numpy", "f2py", "testing")  # SciPy imports them with all else of NumPy: a tenth of what a check takes
    except KeyboardInterrupt:
        print("armscope: interrupted; nothing was left half-written", file=sys.stderr)
        sys.exit(130)
    run()


if __name__ == "__main__":
    main()
