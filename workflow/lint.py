"""`snakemake --lint`, with the one message accepted that having one environment for all rules leaves.

All rules run in the environment of requirements.txt (pip, pinned), which `make` sets up; a conda environment or a
container per rule would be a second one to keep in step.
"""

import json
import subprocess
import sys

ACCEPTED = "Specify a conda environment or container for each rule."


def main() -> int:
    """Print every other message; 1 if there is any."""
    command = [sys.executable, "-m", "snakemake", "--lint", "json"]
    printed = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    found = json.loads(printed[printed.index("{") :]) if "{" in printed else {}
    messages = [
        f"{place.get('rule') or place.get('snakefile')}: {lint['title']}"
        for places in found.values()
        for place in places
        for lint in place["lints"]
        if lint["title"] != ACCEPTED
    ]
    print("\n".join(messages) or f"Nothing but what is accepted: {ACCEPTED!r}")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
