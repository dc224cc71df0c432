"""How a question is asked whose answers are kept: definitions, choices, options, and the files it reads."""

import os
import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import roadproof as rp
from study.read_files import FILES

# `both` meets `bar` under two spec sets; `near` has a quantified variable that is called as a parameter is.
SPEC = """
param gap = 2 s where gap > 0 "a gap"
param low = 20 m/s where low > 0 "a speed"
param spare = 1 s "no definition uses it"
option pace = slow | quick "how fast"
option idle = no | yes "no definition depends on it"
def leaf(a: vehicle) "a leaf" := v_lon(a) > 8 m/s
def bar(a: vehicle) "a bar" := leaf(a)
def foo(a: vehicle) "a foo" := bar(a)
def both(a: vehicle) "two readings" := foo@mine(a) and foo(a)
def near(a: vehicle) "near" := (some gap in lanes: atLane(a, gap)) and v_lon(a) > gap*5 m/s^2
def paced(a: vehicle) "paced" := v_lon(a) > 25 m/s
when pace = quick { def paced(a: vehicle) "quick" := v_lon(a) > 29 m/s }
def apart(a: vehicle) "no definition uses it" := v_lon(a) > 1 m/s
set mine extends base "of my own" {
  def bar(a: vehicle) "a bar" := v_lon(a) > 5 m/s
}
def roadSector_90(SV, POV: vehicle) := true
def disturb_90(SV, POV: vehicle, L: lane) := v_lon(SV) > low and foo(SV)
def scenario_90(SV, POV: vehicle, L: lane) "fast"
  := initSafe(SV, POV) and roadSector_90(SV, POV) and disturb_90(SV, POV, L)
def roadSector_91(SV, POV: vehicle) := true
def disturb_91(SV, POV: vehicle, L: lane) := v_lon(SV) < 40 m/s and paced(POV) and near(SV)
def scenario_91(SV, POV: vehicle, L: lane) "slow"
  := initSafe(SV, POV) and roadSector_91(SV, POV) and disturb_91(SV, POV, L)
"""


@dataclass(frozen=True)
class StoredQuestion:
    """A specification text with further files, choices, options of the command, and contents of files.

    A file without content is not there.
    """

    text: str = SPEC
    specs: tuple[str, ...] = ()
    sets: tuple[str, ...] = ("base",)
    params: Mapping[str, Any] = field(default_factory=dict)
    options: Mapping[str, str] = field(default_factory=dict)
    more: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, str | None] = field(default_factory=lambda: FILES)

    @property
    def using(self) -> rp.Definitions:
        texts = [*self.specs, self.text]
        return rp.load(*self.sets, specs=texts, params=self.params, options=self.options)

    def edited(self, before: str, after: str) -> "StoredQuestion":
        assert self.text.count(before) == 1, before
        return replace(self, text=self.text.replace(before, after))

    def with_more(self, **more: Any) -> "StoredQuestion":
        return replace(self, more={**self.more, **more})

    def with_file(self, name: str, content: str | None) -> "StoredQuestion":
        return replace(self, files={**self.files, name: content})

    def place(self, folder: str) -> Path:
        """A folder of the files, written where it is in every asking."""
        home = Path(os.environ["XDG_CACHE_HOME"]) / "files"
        shutil.rmtree(home, ignore_errors=True)
        for name, content in self.files.items():
            (home / name).parent.mkdir(parents=True, exist_ok=True)
            if content is not None:
                (home / name).write_text(content, "utf-8")
        return home / folder


Change = Callable[[StoredQuestion], StoredQuestion]
