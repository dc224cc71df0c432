"""The help of the program, with commands by job. It imports nothing that starts slowly."""

import os

_JOBS: dict[str, tuple[str, ...]] = {
    "read the library": ("list", "show"),
    "ask about scenarios and formulas": ("prove", "witness", "compare", "explore", "check"),
    "analyse a set of scenarios": (
        *("overlap", "order", "redundancy", "coverage", "classify", "preventable", "catalogue"),
    ),
    "work with recordings and maps": ("monitor", "compile", "evaluate", "simulate", "convert", "road"),
    "show and share results": ("report", "trace", "assurance", "bundle", "atlas", "export", "studio"),
    "set up": ("completion", "cache"),
}
_OTHERS = "other commands"
_HEAD = "Compiles driving scenarios to proofs, witnesses and monitors."
_FOOT = """\
options:
  -h, --help   print this text and exit; COMMAND --help explains a command
  --version    print the version and exit

examples:
  roadproof show 4            scenario 4, deceleration ahead, and the definitions that it uses
  roadproof witness 4         a drive on which it holds, judged exactly
  roadproof prove P4          a property of the scenarios, proved for all time

exit codes: 0 as expected, 10 refuted or unexpected, 20 unknown, 30 cross-check failed,
            2 usage, 3 bad input, 4 missing solver, 70 our fault, 130 interrupted, 143 ended
"""


def _find_commands(folder: str) -> dict[str, str]:
    """The sub-commands with their summaries, by job: the modules in a folder that have a summary."""
    files = sorted(x for x in os.listdir(folder) if x.endswith(".py"))
    found = {x[:-3]: text for x in files if (text := _summary(os.path.join(folder, x)))}
    known = [name for names in _JOBS.values() for name in names if name in found]
    return {name: found[name] for name in [*known, *sorted({*found} - {*known})]}


def _summary(file: str) -> str:
    """The text of ``SUMMARY`` in a module, a literal on one line without escapes; empty where it has none."""
    with open(file, encoding="utf-8") as module:
        for line in module:
            if line.startswith("SUMMARY = "):
                return line.partition('"')[2].rpartition('"')[0]
    return ""


COMMANDS = _find_commands(os.path.dirname(__file__))


def jobs() -> dict[str, list[str]]:
    """The sub-commands by job."""
    found = {job: [name for name in names if name in COMMANDS] for job, names in _JOBS.items()}
    others = [*COMMANDS][sum(map(len, found.values())) :]
    return found | ({_OTHERS: others} if others else {})


def overview() -> str:
    """The help of the program."""
    blocks = ["usage: roadproof COMMAND [OPTION ...] [ARGUMENT ...]", _HEAD]
    for job, names in jobs().items():
        blocks.append("\n".join([f"{job}:", *(f"  {name:<12} {COMMANDS[name]}" for name in names)]))
    return "\n\n".join([*blocks, _FOOT])
