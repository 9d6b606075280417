"""`python -m armscope` and the command `armscope`: even while it imports, Ctrl-C is answered in one line."""

import os
import sys


def main() -> None:
    """Run the command line."""
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # looking for them takes as long as reading YAML
    try:
        from armscope.cli import main as run
    except KeyboardInterrupt:
        print("armscope: interrupted; nothing was left half-written", file=sys.stderr)
        sys.exit(130)
    run()


if __name__ == "__main__":
    main()
