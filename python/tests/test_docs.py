"""Every Python example of README and docs/python.md runs as it is written, from top to bottom."""
import re
import shutil

import pytest

import posewright as pw
from conftest import ROOT


@pytest.mark.parametrize("page, least", [("README.md", 1), ("docs/python.md", 9)])
def test_the_examples_of_the_documentation_run(page, least, examples, tmp_path, monkeypatch):
    text = (ROOT / page).read_text()
    shutil.copytree(examples / "kr270", tmp_path / "kr270")
    shutil.copytree(examples / "kr270", tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    # Searches that take long as they stand end with the best plan of one second.
    whole = pw.plan
    monkeypatch.setattr(pw, "plan", lambda *given, **named: whole(*given, **{**named, "time_limit": 1}))
    names = {}
    found = list(re.finditer(r"^```python\n(.*?)^```", text, re.S | re.M))
    assert len(found) >= least
    for block in found:
        # Lines of the document, so that a failure names them.
        code = "\n" * text[: block.start(1)].count("\n") + block.group(1)
        exec(compile(code, page, "exec"), names)
    if page == "docs/python.md":
        assert (tmp_path / "plan.json").exists() and (tmp_path / "route.json").exists()


def test_every_function_is_in_the_documentation():
    text = (ROOT / "docs" / "python.md").read_text()
    functions = [name for name in pw.__all__ if callable(getattr(pw, name)) and not isinstance(getattr(pw, name), type)]
    assert functions and all(f"pw.{name}(" in text for name in functions)
