"""Faults planted in the source of a function, for one test: what is right is replaced by what is wrong."""

import inspect
import textwrap


def plant(monkeypatch, owner, name, right, wrong):
    """Put ``owner.name`` back with the one occurrence of ``right`` in its source replaced by ``wrong``."""
    function = getattr(owner, name)
    source = textwrap.dedent(inspect.getsource(function))
    assert source.count(right) == 1, f"{name} has {right!r} {source.count(right)} times"
    made = {}
    exec(compile(source.replace(right, wrong), f"<planted in {name}>", "exec"), function.__globals__, made)
    monkeypatch.setattr(owner, name, made[name])
