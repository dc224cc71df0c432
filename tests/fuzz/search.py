"""Drives that exist, asked for: no engine may say that there is none, and what it finds must be one.

``witness.known`` makes a drive of the class that a NONE-WITHIN speaks of, and a formula that is true on it.
What the search hands out is judged again, replayed within its limits, and read in floats.
"""

from collections import Counter
from dataclasses import replace

from hypothesis import strategies as st

from fuzz.case import Disagreement
from judge.pinning import disagreement_on_drive
from roadproof.engines.search.search import find_witness, show_none
from roadproof.engines.setting import SearchOptions
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import Verdict
from searching.known import known

CHUNK = 20
UNITS = 5.0

cases = st.tuples(st.integers(0, 10**9), st.sampled_from(["milp", "smt"]))
"""(seed of a drive with a formula, engine)."""
notes: Counter[str] = Counter()


def check(case: tuple[int, str]) -> int:
    """1 where the engine has an answer about a drive that there is."""
    seed, engine = case
    there = known(seed)
    question = there.question()
    search_options = SearchOptions("any", engine=engine, effort=Effort(UNITS), refinements=1, explain=False)
    answer = find_witness(question, search_options)
    if answer.witness is None:
        answer = show_none(question, replace(search_options, explain=True))
    notes[str(answer.verdict)] += 1
    if answer.verdict in (Verdict.NONE_WITHIN, Verdict.IMPOSSIBLE):
        raise Disagreement(f"{answer.verdict} of a drive that is known, on {there.road}: {there.text}", case)
    if answer.witness is None:
        return 0
    found = answer.witness
    problems = (
        "" if judge(found.formula, found.drive).holds else "judged none",
        first_breach(found.drive, question.vehicles, None) or "",
        first_overlap(found.drive, question.grid.horizon) or "",
    )
    if any(problems):
        raise Disagreement(f"a drive is handed out that is {problems}: {there.text}", case)
    if disagreement_on_drive(found.formula, found.drive) not in (None, "doubtful"):
        raise Disagreement(f"a drive is handed out that floats say is none: {there.text}", case)
    return 1
