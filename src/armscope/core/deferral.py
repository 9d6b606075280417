"""Modules that a library imports and nobody here uses: read when first asked for, which is never."""

from __future__ import annotations

import importlib.util
import sys


def defer(package: str, *names: str) -> None:
    """Put off importing some modules of a package until something in them is asked for. ``names``: of its modules;
    those that are imported already, or are not there, are left as they are."""
    parent = sys.modules.get(package)
    for name in names if parent is not None else ():
        whole = f"{package}.{name}"
        spec = None if whole in sys.modules else importlib.util.find_spec(whole)
        if spec is None or spec.loader is None:
            continue
        spec.loader = importlib.util.LazyLoader(spec.loader)
        module = sys.modules[whole] = importlib.util.module_from_spec(spec)
        setattr(parent, name, module)
        spec.loader.exec_module(module)
