"""The definitions of a question, from the options that commands share."""

import argparse
from collections import deque
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from roadproof.errors import UsageError
from roadproof.frontends.cli.options import read_executor, write_build_results, write_json
from roadproof.frontends.cli.progress import Counter, tell_road, warn
from roadproof.frontends.settings.flags import read_flag, read_keywords
from roadproof.frontends.settings.groups import Readings
from roadproof.frontends.settings.option import Settings

if TYPE_CHECKING:
    from roadproof.frontends.api.definitions import Definitions
    from roadproof.frontends.api.question_answers import QuestionAnswers

A = TypeVar("A")


def read_definitions(args: argparse.Namespace, settings: type[Readings]) -> "Definitions":
    """The definitions that the flags of a question choose. Raises ``InputError``, ``UsageError``."""
    from roadproof.frontends.api.definitions import chosen_in, library_with

    args.specs = settings.with_files(args, args.specs or [])
    sets = read_flag(args, settings, "sets") or ("base",)
    library, readings = library_with(args.specs or ()), read_flag(args, settings, "readings")
    if len({*sets}) < len(sets):
        raise UsageError(f"--set {','.join(sets)}: a spec set is repeated; name each once")
    params = read_flag(args, settings, "params") if "params" in args else None
    return chosen_in(library, sets, readings, params, "--param ")


def study_keywords(args: argparse.Namespace, settings: type[Settings], beside_json: bool = False) -> Any:
    """The keyword arguments of a long question; its evidence goes to the folder of ``--out``.

    ``beside_json``: without that flag, it goes to FILE-evidence beside the file of ``--json``.
    """
    folder: Path | None = args.out
    if beside_json and folder is None and args.json not in (None, "-"):
        file = Path(args.json)
        folder = file.with_name(f"{file.stem}-evidence")
    shared = {"out": folder, "jobs": read_executor(args), "progress": Counter(), "say": warn}
    return read_keywords(args, settings) | shared


def in_order(names: Iterable[str], show: Callable[[str, A], None]) -> Callable[[str, A], None]:
    """A listener that shows answers in the order of ``names``, each once those before it are shown."""
    left, early = deque(names), dict[str, A]()

    def hear(name: str, answer: A) -> None:
        """Show an answer as soon as all that come before it are shown."""
        early[name] = answer
        while left and left[0] in early:
            first = left.popleft()
            show(first, early[first])

    return hear


def deliver(
    args: argparse.Namespace,
    answers: "QuestionAnswers[Any]",
    pictures: bool = False,
) -> int:
    """JSON, what is written to be looked at, and the text of an answer; its exit code."""
    if args.json:
        write_json(answers.as_data(), args.json)
    write_build_results(args, answers)
    if args.out is not None:
        answers.add_files(pictures)
    if args.json != "-":
        print(answers)
        for line in answers.supposed:
            print(line)
        for name, freedom in answers.library.freedom.items():
            print(f"{name} is {freedom}")
    for road in answers.roads:
        tell_road(road)
    return answers.exit_code
