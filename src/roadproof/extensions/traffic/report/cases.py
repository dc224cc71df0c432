"""The cases of an evaluation: recordings, and facts that its results violate."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from roadproof.frontends.report.cases import Case, CaseRule, Location, State
from roadproof.verdict import Verdict


def recording_cases(
    names: Iterable[str], failed: Mapping[str, str], lost: Sequence[str], broken: Sequence[str], path: Path
) -> Iterator[Case]:
    """A case for each recording, and for each fact that the results violate; ``path``: the recordings.

    ``failed``: those that ``--keep-going`` skips, and why.
    """
    for name in names:
        reason = failed.get(name, "")
        state: State = "undecided" if name in lost else "skipped" if reason else "passed"
        rule = Verdict.UNKNOWN if name in lost else CaseRule.UNREADABLE
        yield Case(
            suite="recordings",
            name=name,
            state=state,
            rule=rule,
            message=reason,
            place=_recording_location(path, name),
        )
    for line in broken:
        yield Case(
            suite="facts",
            name=line,
            state="failed",
            rule=Verdict.CROSSCHECK_FAILED,
            message=line,
            place=Location(str(path)),
        )


def _recording_location(path: Path, name: str) -> Location:
    files = sorted(path.glob(f"{name}*")) if path.is_dir() else []
    return Location(str(files[0] if files else path))
