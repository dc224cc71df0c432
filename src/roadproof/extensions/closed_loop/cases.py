"""The cases of ``falsify`` for build servers: its scenarios."""

from collections.abc import Iterator
from pathlib import Path

from roadproof.extensions.closed_loop.claim_names import FAILS, claim_name
from roadproof.extensions.closed_loop.report import finding_text
from roadproof.extensions.closed_loop.view import FalsifyView
from roadproof.frontends.report.cases import Case, State, definition_location
from roadproof.library.specification import Specification
from roadproof.verdict import Verdict


def falsify_cases(view: FalsifyView, folder: Path | None, home: Specification) -> Iterator[Case]:
    """Yield a case for each scenario: failed where the controller fails, undecided where it was not shown."""
    for x in view.targets:
        states: dict[str, tuple[State, Verdict | None]] = {
            "FAILS": ("failed", Verdict.REFUTED),
            "SHOWN": ("passed", None),
            "IMPOSSIBLE": ("passed", None),
            "NOT SHOWN": ("undecided" if x.is_scenario else "skipped", Verdict.UNKNOWN),
            "ERROR": ("undecided", Verdict.UNKNOWN),
        }
        state, rule = states[x.finding]
        definition = home.definitions.get(x.name)
        yield Case(
            suite="scenarios" if x.is_scenario else "classes",
            name=x.name,
            state=state,
            rule=rule,
            message="" if state == "passed" else f"{x.finding} {finding_text(x)}",
            place=None if definition is None else definition_location(home, definition),
            evidence=folder / f"{claim_name(FAILS, x.name)}.json"
            if folder and x.finding == "FAILS"
            else None,
        )
