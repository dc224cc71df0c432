"""What Coq accepts, what it refuses, and that nothing but its word counts."""

import re
import shutil
from dataclasses import replace

import roadproof as rp
from cli.test_schemas import validator
from extensions.kernel.needs import needs_coq
from roadproof.evidence.certificate_file import read_certificate, to_json
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.kernels import KernelVerdict
from roadproof.extensions.kernel import accept
from roadproof.extensions.kernel.accept import find_tableau, judge, prepare
from roadproof.extensions.kernel.coq import ready
from roadproof.frontends.api.checking import check
from roadproof.library.loading import bundled_library
from roadproof.runtime.package_data import shipped_folder

PROOFS = shipped_folder("proofs")
SHIPPED = sorted(x for x in PROOFS.glob("P*.json") if '"tableau"' in x.read_text("utf-8"))
ONE = PROOFS / "P1-scenario-04-base.json"


def ruling(certificate, library=None):
    with ready() as found:
        return judge(found, {"one": prepare("one", certificate, library or bundled_library())}).rulings["one"]


@needs_coq
def test_every_shipped_proof_is_accepted_and_so_is_the_index():
    assert len(SHIPPED) == 156
    checked = check(PROOFS, kernel="coq")
    assert checked.accepted, [x for x in checked.findings if x.outcome is not Acceptance.ACCEPTED]
    assert [x.kernel for x in checked.findings if x.kind == "certificate"] == ["accepted"] * 156
    assert [x.kernel for x in checked.findings if x.kind == "drive"] == ["accepted"] * 5
    assert checked.kernel is not None
    assert set(checked.kernel.axioms) <= accept.AXIOMS
    assert not [*validator("check.json").iter_errors(checked.as_data())]
    print(checked.kernel)


@needs_coq
def test_a_fact_that_is_not_proved_is_named():
    """The opposite of a fact about one instant that a proof uses."""
    certificate = read_certificate(PROOFS / "P3-scenario-03-extA.json")
    (lemma,) = certificate.lemmas
    false = replace(lemma, literals=tuple((name, not positive) for name, positive in lemma.literals))
    found = ruling(replace(certificate, lemmas=(false,)))
    assert (found.verdict, found.lemma, str(found)) == (KernelVerdict.UNKNOWN, 1, "unknown (lemma 1)")


@needs_coq
def test_one_that_is_refused_does_not_take_others_with_it():
    library = bundled_library()
    good = [
        read_certificate(x) for x in (ONE, PROOFS / "P7-ahead-base.json", PROOFS / "P3-scenario-03-extA.json")
    ]
    bad = replace(good[0], tableau=(*good[0].tableau[:-1], "CloseTruth 0"))
    other = replace(good[0], claim="scenario_4(SV,POV,L) -> G danger(SV,POV)")
    broken = replace(good[0], tableau=("Alpha",))
    order = [good[0], bad, good[1], other, broken, good[2]]
    with ready() as found:
        judged = judge(found, {f"n{k}": prepare(f"n{k}", x, library) for k, x in enumerate(order)})
    words = [judged.rulings[f"n{k}"].verdict for k in range(len(order))]
    assert words == ["accepted", "refused", "accepted", "refused", "refused", "accepted"]


def test_without_coqc_it_is_said_before_any_work(monkeypatch, tmp_path, capsys):
    from roadproof.frontends.cli.main import main

    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["check", str(ONE), "--kernel", "coq", "--jobs", "1"]) == 4
    assert "apt-get install -y coq" in capsys.readouterr().err


def test_a_program_that_says_yes_to_all_is_not_enough(monkeypatch, tmp_path):
    """An exit code of 0 without the axioms is no answer."""
    fake = tmp_path / "coqc"
    fake.write_text(
        '#!/bin/sh\ncase "$1" in --print-version) echo 8.16.1 4.13;; esac\n'
        'for f; do :; done\ncase "$f" in *.v) : > "${f%.v}.vo";; esac\n'
    )
    fake.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert ruling(read_certificate(ONE)).verdict is KernelVerdict.UNKNOWN


@needs_coq
def test_compiled_files_among_the_evidence_are_not_loaded(tmp_path, monkeypatch):
    """A theory in the folder that is checked, or in the one where the command runs, is not Coq's."""
    shutil.copy(ONE, tmp_path)
    for name in ("Meaning", "Tableau", "evidence"):
        (tmp_path / f"{name}.vo").write_bytes(b"forged")
        (tmp_path / f"{name}.v").write_text("Axiom absurd : False.")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COQPATH", str(tmp_path))
    monkeypatch.setenv("COQLIB", str(tmp_path))
    (finding,) = check(tmp_path / ONE.name, kernel="coq").findings
    assert finding.kernel == "accepted"


AT = "at minDanger = 0.6 s: F G[0, minDanger] rssViolation(SV,POV) -> F G[0, 0.5 s] rssViolation(SV,POV)"


@needs_coq
def test_proofs_at_values_are_accepted_with_the_values_put_in():
    """Not at another value, at which the claim is false."""
    proved = rp.prove(AT, kernel="coq", drive=False, jobs=1)
    assert [x["kernel"]["says"] for x in proved.as_data()["verdicts"]] == ["accepted"]
    certificate = proved.answers[0].certificate
    text = prepare("one", certificate, bundled_library()).module.text
    assert "At minDanger = 0.6 s: numbers in place of these parameters." in text
    assert "G[0, 3 # 5] rssViolation SV POV" in " ".join(text.split()).replace("(", "").replace(")", "")
    other = replace(certificate, assumed=replace(certificate.assumed, texts=("minDanger = 0.4 s",)))
    tableau = find_tableau(certificate, bundled_library())
    assert ruling(replace(certificate, tableau=tableau)).verdict is KernelVerdict.ACCEPTED
    assert ruling(replace(other, tableau=tableau)).verdict is KernelVerdict.REFUSED
    assert ruling(other).verdict is KernelVerdict.UNKNOWN


ODD = """
# (* "
def valid(a, b: vehicle) "is it *) Axiom x : False. (* " := v_lon(a) < v_lon(b)
def bounds(claim: vehicle) "x" := v_lon(claim) > 0 m/s
def Qed(some_: vehicle) := F bounds(some_)
def proved(a, b: vehicle, forall: lane) := valid(a, b) and Qed(a) and (some l in lanelets(forall): occ(a, l))
param Axiom = 1 s where Axiom >= 0 "x"
"""


@needs_coq
def test_definitions_called_like_words_of_coq_and_comments_that_would_end(tmp_path):
    """Names that would shadow what the printed file says, and a claim that would say more than a claim."""
    spec = tmp_path / "odd.spec"
    spec.write_text(ODD, "utf-8")
    home = rp.load(specs=[spec])
    claims = [
        'proved(SV,POV,L) -> F[0, 0 s] valid(SV, POV) # *) Axiom absurd : False. (* "',
        "G[0, Axiom] Qed(SV) -> G[0, Axiom] F bounds(SV)",
    ]
    found = rp.prove(*claims, using=home, kernel="coq", drive=False, jobs=1)
    assert [str(x) for x in found.kernel.rulings.values()] == ["accepted", "accepted"]
    certificate = found.answers[0].certificate
    text = prepare("one", certificate, found.library).module.text
    said = re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)
    assert "absurd" in text
    assert "absurd" not in said
    assert "Definition valid_2 (a b : vehicle) : formula := v_lon a < v_lon b." in said
    assert "Definition claim : formula := proved_2 SV POV L -> (F[0, 0] valid_2 SV POV)." in said


def test_files_are_only_written(tmp_path, capsys):
    from roadproof.frontends.cli.main import main

    assert main(["check", str(ONE), "--kernel", "coq", "--write", str(tmp_path / "v"), "--jobs", "1"]) == 0
    written = (tmp_path / "v" / "P1_scenario_04_base.v").read_text("ascii")
    assert "Definition claim : formula := scenario_4 SV POV L -> dangerArises SV POV." in written
    assert (tmp_path / "v" / "Roadproof" / "Tableau.v").exists()
    assert capsys.readouterr().out.startswith(
        f"wrote 1 file for coq to {tmp_path / 'v'}, and checked no evidence\n"
    )
    assert main(["check", str(ONE), "--write", str(tmp_path / "v"), "--jobs", "1"]) == 2


def test_a_certificate_with_its_tableau_is_read_as_it_was_written():
    certificate = read_certificate(ONE)
    assert certificate.tableau is not None
    assert to_json(certificate) == ONE.read_text("utf-8")
