"""The heads under which `armscope --help` lists what is not for somebody's own arm."""

EXPERIMENTS = "Experiments (the workflow calls these)"
