"""The judgement of a concrete test: exact for a drive, on samples for other files."""

from dataclasses import replace
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.catalogue.catalogue_data import ShownTarget
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.drive_targets import answer_of_drive
from roadproof.extensions.catalogue.entries import ConcreteTest, Freedom
from roadproof.extensions.catalogue.sample_targets import answer_of_samples
from roadproof.extensions.catalogue.target_formulas import ENDANGERED, TargetFormulas
from roadproof.extensions.catalogue.traces import digest_of
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.extensions.traffic.evaluate.decisions import Drivers
from roadproof.extensions.traffic.evaluate.one_trace import is_pair
from roadproof.library.scenarios import number_in


def judge_test(
    entry: ConcreteTest, formulas: TargetFormulas, freedom: Freedom, drivers: Drivers | None = None
) -> ConcreteAnswer:
    """Return the targets that a test shows, with the decisions of ``drivers``.

    The answer about a test that cannot be read has a fault.
    """
    digest = digest_of(entry.place)
    try:
        if entry.fault:
            raise InputError(entry.fault)
        if entry.place.endswith(".json") and not is_pair(entry.place):
            answer = answer_of_drive(entry, load_drive(Path(entry.place)), formulas, freedom, drivers)
        else:
            answer = answer_of_samples(entry, formulas, freedom, drivers)
    except InputError as error:
        answer = ConcreteAnswer(entry, entry.claims, fault=str(error))
    return replace(_confirmed(answer, formulas), sha256=digest)


def _confirmed(answer: ConcreteAnswer, formulas: TargetFormulas) -> ConcreteAnswer:
    """Return an answer without scenarios that begin as a restriction says and do not end so under its model.

    The restriction is a formula of a state; the model that is put into the test decides. Classes of the same
    vehicles are left out with them.
    """
    restriction = restriction_of(formulas.specification.options)
    if restriction is None:
        return answer
    model, side, decided = restriction.model, restriction.side, answer.decisions
    sides = {(x.scenario, x.vehicles): x.side for x in decided if x.driver == model}
    wrong = {
        (x.what, x.vehicles): sides.get((x.what, x.vehicles), "undecided")
        for x in answer.shown
        if number_in(x.what) in restriction.scenarios and sides.get((x.what, x.vehicles)) != side
    }
    others = {vehicles for _, vehicles in wrong}

    def stays(x: ShownTarget) -> bool:
        is_class = number_in(x.what) is None and x.what != ENDANGERED
        return (x.what, x.vehicles) not in wrong and not (is_class and x.vehicles in others)

    left = tuple(filter(stays, answer.shown))
    notes = (
        f"{what} begins as {side}, but is {actual} with {model} in place of SV"
        for (what, _), actual in wrong.items()
    )
    return replace(answer, shown=left, notes=(*answer.notes, *notes))
