"""Texts behind options, of which one part is right and another is not; options that exclude each other."""

import argparse
import shutil
import subprocess
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from roadproof.errors import UsageError
from roadproof.extensions.catalogue.settings import driver_models_or_none
from roadproof.extensions.drivers.settings import initial_values
from roadproof.extensions.exchange.streaming.arithmetic import HELPERS
from roadproof.extensions.exchange.streaming.c_files import FLAGS
from roadproof.extensions.pages.command_lines import flags_of
from roadproof.extensions.surveys.settings import text_or_none
from roadproof.extensions.traffic import readers as of_traffic
from roadproof.frontends.settings import readers
from roadproof.frontends.settings.flags import read_keywords
from roadproof.frontends.settings.option import Option
from roadproof.frontends.settings.questions import Prove

FAST = "v_lon(SV) > 30 m/s -> v_lon(SV) > 20 m/s"

READ: list[tuple[Any, dict[str, Any], tuple[str, ...]]] = [
    (readers.decimal, {"0.5": 0.5, "1000000": 1e6}, ("0", "-1", "1000001", "1e3", "x", "", "nan", "inf")),
    (readers.whole(1, 9), {"1": 1, "9": 9}, ("0", "10", "-1", "1.0", "", "x", "+1")),
    (readers.whole(0), {"0": 0, "1000000": 10**6}, ("-1", "1000001", "x")),
    (readers.seconds, {"6": Fraction(6), "3/5": Fraction(3, 5)}, ("0", "-1", "1/0", "1e3", "x", "")),
    (of_traffic.seconds_or_zero, {"0": Fraction(0), "0.6": Fraction(3, 5)}, ("-0.1", "1e3", "x", "")),
    (readers.named("L"), {"a": ("L", "a"), "M=a": ("M", "a"), "M=a=b": ("M=a", "b")}, ()),
    (of_traffic.mapping_of("SV=a"), {"SV=a,A=b": {"SV": "a", "A": "b"}}, ("SV=a,SV=b", "SV=", "=a", "A=a,")),
    (readers.assignment("--param"), {"rho = 1": ("rho", "1")}, ("rho=", "=1", "rho", "")),
    (readers.items_of("names"), {"a, b": ("a", "b")}, ("a,,b", "a,", ",", "")),
    (of_traffic.frame_range, {"1-3": (1, 3)}, ("1", "1-", "-3", "a-b")),
    (initial_values, {"Ve0=1,2": ("Ve0", ["1", "2"])}, ("Ve0", "Ve0=", "Ve0= ")),
    (driver_models_or_none, {"none": (), "a,b": ("a", "b")}, ("a,,b",)),
    (text_or_none, {"": None, "a": "a"}, ()),
    (readers.folder, {"a": Path("a")}, ("",)),
]  # fmt: skip


@pytest.mark.parametrize(("read", "right", "wrong"), READ, ids=range(len(READ)))
def test_texts_that_are_read_whole_or_refused(
    read: Any, right: dict[str, Any], wrong: tuple[str, ...]
) -> None:
    assert {text: read(text) for text in right} == right
    for text in wrong:
        with pytest.raises(UsageError):
            read(text)


def test_spec_sets_are_all_named() -> None:
    assert readers.set_names(["base,ext", "extA"]) == ("base", "ext", "extA")
    for wrong in (["base,"], ["", "ext"], ["base", ","]):
        with pytest.raises(UsageError):
            readers.set_names(wrong)


def test_the_least_value_of_an_option_is_allowed() -> None:
    option = Option("--count", "K", least=1)
    option.check("count", 1)
    for wrong in (0, -1, 1.5, "1", None):
        with pytest.raises(UsageError, match="greater than 0"):
            option.check("count", wrong)
    choice = Option("--lanes", None, choices=("same", "any"))
    choice.check("lanes", "any")
    with pytest.raises(UsageError, match="write 'same' or 'any'"):
        choice.check("lanes", "other")
    with pytest.raises(UsageError, match="path of a folder"):
        Option("--out", "DIR").check("out", "")


def test_flags_of_settings_give_the_same_settings() -> None:
    from roadproof.frontends.settings.flags import add_flags

    asked = Prove(drive=False, effort=7.0, declared=True, expect="REFUTED")
    parser = argparse.ArgumentParser()
    add_flags(parser, Prove)
    words = flags_of(asked)
    assert "--no-drive" in words
    keywords = read_keywords(parser.parse_args(words), Prove)
    assert Prove.of(keywords) == asked
    assert {*keywords} == {x for x, option in Prove.options().items() if option.flag and option.keyword}


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"vehicles": "truck"}, "require assume=motion"),
        ({"assume": "motion", "vehicles": {"POV": "truck"}}, "vehicle POV: the claim mentions SV"),
        ({"assume": "motion", "engine": "milp"}, "assume nothing"),
        ({"kernel": "coq", "engine": "smt"}, "omit kernel"),
    ],
)
def test_options_that_have_no_meaning_together_are_refused(options: dict[str, Any], told: str) -> None:
    with pytest.raises(UsageError, match=told):
        rp.prove(FAST, jobs=1, **options)


@pytest.mark.parametrize("what", [("P1", FAST), (4, FAST)])
def test_the_list_and_claims_of_ones_own_are_not_mixed(what: Any) -> None:
    with pytest.raises(UsageError, match="not both"):
        rp.prove(*what, jobs=1)
    with pytest.raises(UsageError, match="requires claims of your own"):
        rp.prove("P1", assume="motion", jobs=1)


# --- monitors in C -----------------------------------------------------------------------------------


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler: install gcc or clang")
@pytest.mark.parametrize("flags", [FLAGS, "-Werror"])
def test_numbers_of_a_sample_that_are_not_finite_in_c(flags: str, tmp_path: Path) -> None:
    """With the flags that compile names, and with those of a compiler by default, whose math.h has finite."""
    values = ["-INFINITY", "INFINITY", "NAN", "-DBL_MAX", "DBL_MAX", "0.0", "-0.0", "-1.0"]
    lines = [f'    printf("%d ", is_finite({x}));' for x in values]
    lines += [f'    printf("%g ", inverse({x}));' for x in ("0.0", "-0.0", "2.0", "-4.0")]
    lines += ['    printf("%g %g ", larger(-1.0, 2.0), smaller(-1.0, 2.0));']
    head = "#include <float.h>\n#include <math.h>\n#include <stdio.h>\n"
    body = "\n".join([*HELPERS.values(), "int main(void)\n{", *lines, "    return 0;\n}\n"])
    (tmp_path / "main.c").write_text(head + body)
    subprocess.run(["cc", *flags.split(), "-o", "main", "main.c", "-lm"], cwd=tmp_path, check=True)
    done = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [*"00011111", "inf", "inf", "0.5", "-0.25", "2", "-1"]


@pytest.mark.parametrize(
    ("formula", "checked"),
    [
        ("v_lon(SV) > v_lon(POV)", 2),
        ("v_lon(SV) > 3 m/s", 1),
        ("max(v_lon(SV), v_lon(POV)) > 3 m/s", 3),
        ("s(SV) / length(POV) > 2", 2),
    ],
)
def test_both_sides_of_a_comparison_are_looked_at_in_c(formula: str, checked: int) -> None:
    [source] = [x for name, x in rp.compile(formula).files.items() if name.endswith(".c")]
    assert source.count("fine &= is_finite(") == checked
