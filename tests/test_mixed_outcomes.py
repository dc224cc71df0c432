"""Exit codes of mixed outcomes: every sequence of up to four, in every order."""

from itertools import product

from roadproof.verdict import ExitCode, Verdict, exit_code

PROVED = Verdict.PROVED
GRAVITY = {
    (PROVED, PROVED): 0,
    (Verdict.REFUTED, Verdict.REFUTED): 0,
    (Verdict.REFUTED, PROVED): 10,
    (Verdict.PROVED_BOUNDED, PROVED): 10,
    (Verdict.UNKNOWN, PROVED): 20,
    (Verdict.UNKNOWN, Verdict.UNKNOWN): 20,
    (Verdict.CROSSCHECK_FAILED, PROVED): 30,
    (Verdict.CROSSCHECK_FAILED, Verdict.CROSSCHECK_FAILED): 30,
}
"""An outcome with what was expected, and the code that it has alone."""


def test_the_gravest_of_any_mixture_wins_wherever_it_stands() -> None:
    for length in range(5):
        for mixed in product(GRAVITY, repeat=length):
            assert exit_code(mixed) is ExitCode(max((GRAVITY[x] for x in mixed), default=0)), mixed
