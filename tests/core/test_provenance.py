"""A changed source reruns what depends on it and nothing else."""

import pytest

from armscope.core import provenance


def look_anew():
    """Sources are read and parsed once, since forty rules follow much the same ones."""
    for each in vars(provenance).values():
        if hasattr(each, "cache_clear"):
            each.cache_clear()


def test_a_module_depends_on_what_it_imports_at_any_depth():
    names = {path.name for path in provenance.sources("armscope.robot.kinematics")}
    assert {"kinematics.py", "arm.py", "description.py", "inputs.py"} <= names


def test_a_module_does_not_depend_on_its_users():
    assert not any("report" in path.parts for path in provenance.sources("armscope.robot.kinematics"))


def test_the_digest_follows_the_sources(monkeypatch, tmp_path):
    (tmp_path / "one.py").write_text("from armscope.two import x\n")
    (tmp_path / "two.py").write_text("x = 1\n")
    (tmp_path / "other.py").write_text("")
    monkeypatch.setattr(provenance, "PACKAGE", tmp_path)

    def digest():
        look_anew()
        return provenance.digest("armscope.one")

    before = digest()
    (tmp_path / "other.py").write_text("y = 2\n")
    assert digest() == before
    (tmp_path / "two.py").write_text("x = 2\n")
    assert digest() != before
    look_anew()


def test_an_unknown_module_is_an_error():
    with pytest.raises(ModuleNotFoundError, match="nothing is not a module"):
        provenance.sources("armscope.nothing")


def test_a_command_depends_on_itself_what_it_calls_and_what_it_imports(monkeypatch, tmp_path):
    module = "def one():\n    from armscope.two import x\n    return helper(x)\n"
    module += "def helper(x): return x\ndef other(): return {}\n"
    (tmp_path / "two.py").write_text("x = 1\n")
    monkeypatch.setattr(provenance, "PACKAGE", tmp_path)

    def digest(text):
        look_anew()
        (tmp_path / "one.py").write_text(text)
        return provenance.digest("armscope.one:one")

    before = digest(module.format(1))
    assert digest(module.format(2)) == before
    assert digest(module.format(1).replace("return x", "return -x")) != before
    (tmp_path / "two.py").write_text("x = 2\n")
    assert digest(module.format(1)) != before
    look_anew()
