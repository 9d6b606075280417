"""`snakemake --lint`, with the one message accepted that having one environment for all rules leaves.

All rules run in the environment of requirements.txt (pip, pinned), which `make` sets up; a conda environment or a
container per rule would be a second one to keep in step.
"""

import re
import subprocess
import sys

ACCEPTED = "Specify a conda environment or container for each rule."


def unaccepted(printed: str) -> list[str]:
    """Where each other message stands, and what it says.

    Args:
        printed: what `snakemake --lint` printed.

    Returns:
        One line per message, in their order.
    """
    messages, place = [], ""
    for line in printed.splitlines():
        if line.startswith("Lints for "):
            place = line.removeprefix("Lints for ").rstrip(":")
        title = re.match(r"    \* (.*?):?$", line)
        if title and title[1].rstrip(":") != ACCEPTED:
            messages.append(f"{place}: {title[1]}")
    return messages


def main() -> int:
    """Print every message that is not accepted; 1 if there is any, or if the linter did not get to its end."""
    run = subprocess.run([sys.executable, "-m", "snakemake", "--lint"], capture_output=True, text=True, check=False)
    printed = run.stdout + run.stderr
    if ACCEPTED not in printed:
        print(printed)
        return 1
    messages = unaccepted(printed)
    print("\n".join(messages) or f"Nothing but what is accepted: {ACCEPTED!r}")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
