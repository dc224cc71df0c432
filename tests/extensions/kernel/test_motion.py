"""Facts about motion and inductions in Coq: each schema is used, and no other formula is taken."""

from dataclasses import replace
from functools import cache
from shutil import which

import pytest

import roadproof as rp
from examples import some
from extensions.exchange.exporting.shipped_drives import shipped_drives
from extensions.kernel.needs import needs_coq, needs_ocaml
from extensions.kernel.reading import answers
from extensions.kernel.test_accept import ruling
from roadproof.evidence.kernels import KernelVerdict
from roadproof.extensions.kernel import extracted, ocaml
from roadproof.extensions.kernel.accept import CoqModule, find_tableau, judge, prepare
from roadproof.extensions.kernel.coq import ready
from roadproof.extensions.kernel.drive import drive_statement
from roadproof.extensions.kernel.printer import FIXED_SPACE, Printer
from roadproof.extensions.kernel.source import HEAD, Module, instance_text
from roadproof.extensions.kernel.statement import SCHEMAS, Instance, bounds_of
from roadproof.extensions.kernel.world import world_lines
from roadproof.library.assumption import ALL_SCHEMAS, INDUCTIONS
from roadproof.library.loading import bundled_library
from roadproof.library.motion import axiom_arguments, axiom_formula
from roadproof.logic import formula as f
from roadproof.logic.rewrite import parameters_of
from spec.motions import ABOUT, AXIOMS, specification
from spec.test_motion import FAULTS
from tables import read_table

PROVED = [tuple(x) for x in read_table(__file__, "proved")]
FILE = HEAD + "From Roadproof Require Import Motion Schemas.\n"


def test_every_schema_has_a_name_in_coq():
    assert {*SCHEMAS} == {*ALL_SCHEMAS} == {x for schemas, _ in PROVED for x in schemas.split()}


@cache
def proved():
    """The claims, proved and put to Coq, where it is there, in one file."""
    kernel = "coq" if which("coqc") else None
    return rp.prove(*(claim for _, claim in PROVED), kernel=kernel, drive=False, jobs=1)


@needs_coq
@pytest.mark.parametrize("number", range(len(PROVED)))
def test_a_claim_about_motions_is_accepted_and_rests_on_no_fact(number):
    schemas, claim = PROVED[number]
    certificate = proved().answers[number].certificate
    assert " ".join(sorted({x.schema for x in certificate.assumed.axioms})) == schemas
    entry = proved().as_data()["verdicts"][number]
    limits = len(certificate.assumed.limits)
    assert entry["kernel"] == {"says": "accepted", "reason": "", "premises": limits}
    told = proved().kernel_text().splitlines()[number]
    assert ("  assuming motion" in told) == claim.startswith("assuming motion")
    text = prepare("one", certificate, bundled_library()).module.text
    read, _, proof = text.partition("(* From here on it is proof")
    assert "motion_" not in read
    assert "induction_" not in read
    assert ("limit_1" in read) == bool(limits)
    theorem = "Meaning.valid " if {*schemas.split()} <= {*INDUCTIONS} else "Motion.valid_of_motions "
    assert f"Theorem proved : Roadproof.{theorem}bounds claim." in proof


# --- instances: each is taken, and nothing else is ------------------------------------------------


def instances():
    for axiom in AXIOMS:
        made = axiom_arguments(specification, ABOUT, axiom)
        yield Instance(SCHEMAS[axiom.schema], made, False), axiom_formula(specification, ABOUT, axiom)


@needs_coq
def test_instances_are_those_of_the_library_and_no_false_formula_is_one():
    """Each made in Python, with those of other arguments and schemas, and formulas that drives refute."""
    printer = Printer()
    pairs = [*instances()]
    schemas = [instance_text(printer, x) for x, _ in pairs]
    formulas = [printer.formula(x) for x in (*(x for _, x in pairs), *FAULTS.values())]
    bounds = bounds_of(specification, parameters_of(f.And(tuple(x for _, x in pairs))))
    kinds = (f'{"above_0" if strict else "at_least_0"} "{p}"' for p, strict in bounds.items())
    body = [*printer.things, *printer.definitions]
    body += [f"Definition all : list schema := [{'; '.join(schemas)}]."]
    body += [f"Definition said : list formula := [{'; '.join(f'({x})%formula' for x in formulas)}]."]
    body += [f"Definition bounds := [{'; '.join(kinds)}]."]
    body += ["Eval vm_compute in map (fun s => map (is_instance bounds [s]) said) all."]
    found = answers(FILE + "\n".join(body).replace(FIXED_SPACE, " "))
    expected = [x == y for _, x in pairs for y in (*(y for _, y in pairs), *FAULTS.values())]
    assert found == [str(x).lower() for x in expected]
    assert found.count("false") >= len(pairs) * len(FAULTS) >= 800


@needs_coq
def test_what_is_no_fact_is_no_instance():
    schemas, expected = zip(*read_table(__file__, "instances"), strict=True)
    asked = "; ".join(f"match says [] ({x}) with Some _ => true | None => false end" for x in schemas)
    said = answers(f'{FILE}Definition a : vehicle := "a".\nEval vm_compute in [{asked}].\n')
    assert dict(zip(schemas, said, strict=True)) == dict(zip(schemas, expected, strict=True))


@cache
def strict_certificate():
    claim = "G v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) -> G s(SV) < s(POV)"
    return rp.prove(claim, assume="motion", drive=False, jobs=1).answers[0].certificate


@needs_coq
def test_a_module_with_another_fact_claim_or_theorem_is_not_accepted():
    made = prepare("one", strict_certificate(), bundled_library()).module
    changes = read_table(__file__, "changes")
    modules = {"kept": CoqModule(made)}
    for number, (before, after, _) in enumerate(changes):
        assert made.text.count(before) == 1, before
        text = made.text.replace(before, after).replace("Module one.", f"Module n{number}.")
        changed = replace(made, name=f"n{number}", text=text.replace("End one.", f"End n{number}."))
        modules[changed.name] = CoqModule(changed)
    with ready() as coq:
        rulings = judge(coq, {"one" if x == "kept" else x: y for x, y in modules.items()}).rulings
    assert rulings["one"].verdict is KernelVerdict.ACCEPTED
    assert [rulings[f"n{k}"].text_with_premises for k in range(len(changes))] == [
        word for _, _, word in changes
    ]


@cache
def forms():
    """Certificates of claims under motion and of inductions, for the extracted program."""
    certificates = [x.certificate for x in proved().answers]
    return [prepare(f"n{k}", x, bundled_library(), extracted.proof) for k, x in enumerate(certificates)]


def told(texts):
    """The words of the extracted program about each form."""
    asked = {f"n{k}": CoqModule(Module(f"n{k}", x, (), 0)) for k, x in enumerate(texts)}
    with ocaml.ready() as program:
        return [str(x.verdict) for x in extracted.judge(program, asked).rulings.values()]


@needs_ocaml
def test_the_extracted_program_accepts_all_and_nothing_that_is_changed():
    texts = [x.module.text for x in forms()]
    assert told(texts) == ["accepted"] * len(PROVED)
    assert [x.limits for x in forms()] == [int("motion," in claim) for _, claim in PROVED]
    changed = []
    for before, after in read_table(__file__, "forms"):
        (text,) = [x for x in texts if before in x][:1]
        changed.append(text.replace(before, after, 1).replace(text.split()[1], f"n{len(changed)}", 1))
    assert told(changed) == ["refused"] * len(changed)


@needs_coq
def test_a_false_claim_is_refused_with_the_tableau_of_a_true_one():
    certificate = strict_certificate()
    tableau = find_tableau(certificate, bundled_library())
    assert ruling(replace(certificate, tableau=tableau)).verdict is KernelVerdict.ACCEPTED
    false = replace(certificate, claim="s(SV) < s(POV) -> G s(SV) < s(POV)", tableau=tableau)
    assert ruling(false).verdict is KernelVerdict.REFUSED


# --- drives -----------------------------------------------------------------------------------------


@needs_coq
def test_kept_drives_are_motions():
    """Of each drive file, the printed drive is proved to be one."""
    library = bundled_library()
    printed = [
        world_lines(drive_statement(x, library).world) for x in [*shipped_drives().values()][: some(72)]
    ]
    modules, goals = [], []
    for k, drive in enumerate(printed):
        lines = [
            f"Module n{k}.",
            "Definition the_drive : Roadproof.Drive.drive :=",
            *drive,
            f".\nEnd n{k}.\n",
        ]
        modules.append("\n".join(lines))
        goals.append(
            f"Lemma moves_{k} : Roadproof.Motion.motion (Roadproof.Drive.world_of n{k}.the_drive).\n"
            "Proof. apply Roadproof.Moves.drives_move; repeat constructor; unfold Q2R; simpl; lra. Qed.\n"
        )
    head = (
        "From Coq Require Import Reals Qreals Lra.\nFrom Roadproof Require Moves.\nImport Roadproof.Drive.\n"
    )
    with ready() as coq:
        ran = coq.run(
            "".join([HEAD, head, "Open Scope Q_scope.\n", *modules, "Close Scope Q_scope.\n", *goals])
        )
    assert ran.code == 0, ran.errors[:500]
    assert len(goals) >= 24
