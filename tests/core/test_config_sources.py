"""A number that is set anew does not keep the source of the one that it replaces."""

from pathlib import Path

import yaml

from armscope.core.config import with_own_sources

DEFAULT = {"seed": 1, "identification": {"poses": {"value": 85, "source": "Sec. 4"}, "seeds": 3}}


def test_a_number_set_without_a_source_says_so_and_what_it_was() -> None:
    changed = {"seed": 2, "identification": {"poses": {"value": 60, "source": "Sec. 4"}, "seeds": 4}}
    mended = with_own_sources(changed, DEFAULT)
    assert mended["identification"]["poses"]["value"] == 60
    assert mended["identification"]["poses"]["source"] == ("set for this run, without a source (default: 85, Sec. 4)")
    assert (mended["seed"], mended["identification"]["seeds"]) == (2, 4)
    assert changed["identification"]["poses"]["source"] == "Sec. 4", "what was given stays as it was"


def test_a_source_of_its_own_is_kept_and_so_is_what_is_not_changed() -> None:
    own = {"identification": {"poses": {"value": 60, "source": "our lab has time for 60"}}}
    assert with_own_sources(own, DEFAULT) == own
    assert with_own_sources(DEFAULT, DEFAULT) == DEFAULT


def test_the_projects_own_small_run_gives_a_source_for_every_number_that_it_changes() -> None:
    folder = Path(__file__).parents[2] / "config"
    default, small = (yaml.safe_load((folder / name).read_text()) for name in ("config.yaml", "small.yaml"))

    def merged(under: dict, over: dict) -> dict:
        both = {**under, **over}
        shared = [name for name in over if isinstance(over[name], dict) and isinstance(under.get(name), dict)]
        return {**both, **{name: merged(under[name], over[name]) for name in shared}}

    used = merged(default, small)
    assert with_own_sources(used, default) == used
