"""Negative controls by the hundred: false claims, changed claims and tableaux; Coq computes all answers."""

import random
import re
from dataclasses import replace

import pytest

from kernel.needs import needs_coq
from roadproof.evidence.certificate import read_certificate
from roadproof.kernel.coq import ready
from roadproof.kernel.source import HEAD, module
from roadproof.kernel.statement import state
from roadproof.kernel.tableau import RULES, coq_tree, lines, read_lines
from roadproof.proving.properties import template_properties
from roadproof.shipped import shipped
from roadproof.spec.library import bundled_library
from roadproof.verdict import Verdict

DONORS = ("P1-scenario-04-base", "P5-scenario-04-base", "P6-scenario-01-base", "P1-scenario-02-ext")
FALSE = """
F danger(SV,POV)
G danger(SV,POV)
not F danger(SV,POV)
scenario_4(SV,POV,L) -> G danger(SV,POV)
scenario_4(SV,POV,L) -> danger(SV,POV)
dangerArises(SV,POV) -> scenario_4(SV,POV,L)
scenario_4(SV,POV,L) -> scenario_4(POV,SV,L)
scenario_4(SV,POV,L) <-> scenario_3(SV,POV,L)
disturb_4(SV,POV,L) -> dangerArises(SV,POV)
behaviourPOV_4(POV,SV,L) -> F danger(SV,POV) and aheadOf(SV,POV)
F aheadOf(SV,POV) -> aheadOf(SV,POV)
aheadOf(SV,POV) -> G aheadOf(SV,POV)
(F aheadOf(SV,POV)) and (F aheadOf(POV,SV)) -> F (aheadOf(SV,POV) and aheadOf(POV,SV))
F[0, minDanger] aheadOf(SV,POV) -> F[0, minSafe] aheadOf(SV,POV)
(atLane(SV,L) U aheadOf(SV,POV)) -> atLane(SV,L)
(atLane(SV,L) U[1 s, 2 s] aheadOf(SV,POV)) -> (atLane(SV,L) U aheadOf(SV,POV))
F aheadOf(SV,POV) -> (atLane(SV,L) U aheadOf(SV,POV))
(some M in lanes: atLane(SV,M)) -> every M in lanes: atLane(SV,M)
every M in adjacentLanes(L): atLane(SV,M)
some M in adjacentLanes(L): atLane(SV,M) or not atLane(SV,M)
minSafe <= minDanger
minDanger > 0 s
initSafe(SV,POV) -> G instSafe(SV,POV)
""".strip().splitlines()


def computed(modules):
    """What the checker of Tableau.v answers to each claim with its tableau, as Coq computes it."""
    return answers_to(part for x in modules for part in (*opened(x), f"{asked(x)}End {x.name}.\n"))


def computed_of(x, tableaux):
    """What it answers to each of the tableaux for one claim."""
    out = [x.text[: x.text.index("Definition tableau")]]
    for number, tableau in enumerate(tableaux):
        out.append(f"Definition tableau{number} : tree := (\n" + "\n".join(coq_tree(tableau)) + ").\n")
        out.append(asked(x).replace(" tableau)", f" tableau{number})"))
    return answers_to([without_lemmas(text) for text in out] + [f"End {x.name}.\n"])


def opened(x):
    """A module up to its theorem."""
    yield without_lemmas(x.text.partition("Theorem proved")[0])


def without_lemmas(text):
    return re.sub(r"Lemma (?:.|\n)*?Qed\.\n", "", text)


def asked(x):
    """The question whether the tableau of a module is accepted."""
    end = x.text.partition("Theorem proved")[2]
    parameters, facts = re.search(r"accepted (\[.*?\]) bounds (\[.*?\]) claim", end, re.DOTALL).groups()
    return f"Eval vm_compute in (accepts {parameters} bounds {facts} claim tableau).\n"


def answers_to(parts):
    with ready() as coq:
        ran = coq.run(HEAD + "".join(parts))
    assert ran.code == 0, ran.complained[:500]
    return [answer == "true" for answer in re.findall(r"= (true|false)\n", ran.said)]


def donors():
    certificates = {name: read_certificate(shipped("proofs") / f"{name}.json") for name in DONORS}
    return {name: (x, read_lines(x.tableau)) for name, x in certificates.items()}


def put(number, certificate, tableau):
    return module(f"n{number}", state(certificate, bundled_library()), tableau)


@needs_coq
def test_no_tableau_of_another_claim_proves_a_false_one():
    controls = [
        x.claim for x in template_properties() if x.expected is Verdict.REFUTED and x.set_name == "base"
    ]
    assert len(FALSE) + len(controls) >= 25
    modules, right = [], 0
    for certificate, tableau in donors().values():
        modules.append(put(len(modules), certificate, tableau))
        for claim in (*FALSE, *controls):
            modules.append(put(len(modules), replace(certificate, claim=claim), tableau))
    answers = computed(modules)
    assert len(answers) == len(modules)
    for place, answer in enumerate(answers):
        assert answer == (place % (len(FALSE) + len(controls) + 1) == 0), modules[place].text
        right += not answer
    assert right >= 100


# The last ones stay true: of two untils one is enough, and what danger and safety are is the same throughout.
CHANGED = [
    ("initSafe SV POV and roadSector_4 SV POV and", "Truth true and roadSector_4 SV POV and"),
    ("F (initSafe a b and (F danger a b))", "G (initSafe a b and (F danger a b))"),
    ("F (initSafe a b and (F danger a b))", "F[1, inf) (initSafe a b and (F danger a b))"),
    ("F (initSafe a b and (F danger a b))", "F (initSafe a b and (F danger b a))"),
    ("F (initSafe a b and (F danger a b))", "F (initSafe a b and (G danger a b))"),
    ("claim : formula := scenario_4 SV POV L", "claim : formula := not (scenario_4 SV POV L)"),
    ("claim : formula := scenario_4 SV POV L", "claim : formula := scenario_4 POV SV L"),
]
STILL_TRUE = [
    ("laneKeep SV L U danger SV POV", "laneKeep SV L"),
    ("decel POV SV L U danger SV POV", "decel POV SV L"),
    ("instSafe (a b : vehicle) : formula := not rss", "instSafe (a b : vehicle) : formula := rss"),
    ("rssViolation_lon a b and", "rssViolation_lon b a and"),
]


@needs_coq
def test_a_changed_definition_makes_another_claim():
    """Where it makes the claim false, the proof fails; where not, it may stand, as a proof of that."""
    certificate, tableau = donors()["P1-scenario-04-base"]
    modules = []
    for old, new in (*CHANGED, *STILL_TRUE):
        x = put(len(modules), certificate, tableau)
        flat = re.sub(r"\n  +", " ", x.text)
        assert old in flat, old
        modules.append(replace(x, text=flat.replace(old, new, 1)))
    answers = computed(modules)
    assert len(answers) == len(modules)
    assert not any(answers[: len(CHANGED)])


@needs_coq
@pytest.mark.parametrize("name", DONORS)
def test_changed_tableaux_are_refused(name):
    """Numbers, moments, multipliers, rules, order: what is accepted nevertheless has another multiplier."""
    r = random.Random(name)
    certificate, tableau = donors()[name]
    changed = []
    for _ in range(60):
        place = r.randrange(len(tableau))
        node = tableau[place]
        kinds = RULES[node.rule][0]
        spot = r.randrange(len(kinds))
        arguments = list(node.arguments)
        match kinds[spot]:
            case "i":
                arguments[spot] += r.choice([1, 2, -1 if arguments[spot] else 3])
            case "m":
                row = list(arguments[spot]) or [0]
                row[r.randrange(len(row))] += r.choice([1, -1])
                arguments[spot] = tuple(row)
            case "w":
                items = list(arguments[spot])
                if not items:
                    continue
                at = r.randrange(len(items))
                number, factor = items[at]
                items[at] = r.choice([(number + 1, factor), (number, -factor), (number, factor * 0)])
                arguments[spot] = tuple(items)
            case "c":
                arguments[spot] += "_"
        new = (*tableau[:place], replace(node, arguments=tuple(arguments)), *tableau[place + 1 :])
        if new != tableau:
            changed.append((kinds[spot], node, new))
    answers = computed_of(put(0, certificate, tableau), [tableau, *(new for _, _, new in changed)])
    assert answers[0]
    assert len(answers) == len(changed) + 1
    kept = [(kind, node) for (kind, node, _), answer in zip(changed, answers[1:], strict=True) if answer]
    # A constraint that follows from others may stand in place of them, a new time may have any free number,
    # and one fact in place of another that closes the branch as well: these prove the claim, too.
    assert len(changed) - len(kept) >= 35, kept


def test_lines_are_read_as_they_were_written_and_nothing_else_is():
    _, tableau = donors()["P1-scenario-04-base"]
    written = lines(tableau)
    assert read_lines(written) == tableau
    hostile = [
        "",
        "Alpha",
        "Alpha x",
        "Alpha -1",
        "Alpha 1e3",
        "Alpha 1 1",
        "alpha 1",
        "Axiom 1",
        "Alpha 1).",
        "Cut 1/0",
    ]
    hostile += [
        'NewRoad 1 a"',
        "NewRoad 1 a)",
        "Alpha \u0661",
        "CloseLinear 1*",
        "CloseLinear 1*1/00",
        "Alpha 999999",
    ]
    for line in hostile:
        with pytest.raises(Exception, match="tableau"):
            read_lines((line,))
    for broken in (written[:-1], (*written, "Alpha 1"), ()):
        with pytest.raises(Exception, match="tableau"):
            read_lines(broken)
