"""``question.json``: a question as plain data, from which its claims are listed again."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from roadproof.errors import InputError
from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import Doc, read, write
from roadproof.evidence.heading import heading, library_of
from roadproof.evidence.specifications import load_specs_beside
from roadproof.evidence.strict import LARGEST_INDEX, Fields, JsonObject, read_json
from roadproof.extension import entries, imported
from roadproof.library.specification import Library
from roadproof.questions.basis import Basis
from roadproof.questions.drive_search_data import VehicleModel, vehicle_data, vehicles_of
from roadproof.questions.question import QUESTION, Question
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/question/1"


@dataclass(frozen=True, kw_only=True)
class BasisSays:
    """The definitions and limits that all claims of a question share."""

    sets: shared.SetNames
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    horizon: Annotated[Fraction, Doc("Seconds that are searched.")]
    objective: Annotated[str, Doc("What drives are like.")]
    vehicles: Annotated[Mapping[str, VehicleModel], Doc("Models by name; an empty name: all others.")]


@dataclass(frozen=True, kw_only=True)
class QuestionFile(headings.AnswerHeading):
    """A question: its kind, what its claims are read with, and what is asked."""

    schema: Literal["roadproof/question/1"] = SCHEMA
    question: Annotated[str, Doc("The command that asks it.")]
    basis: BasisSays
    asked: Annotated[object, Doc("What is asked beside.")]


def question_data(question: Question[Any]) -> JsonObject:
    """Return ``question.json`` as plain data."""
    file = QuestionFile(
        **heading(SCHEMA, question.basis.library),
        question=question.kind,
        basis=basis_data(question.basis),
        asked=write(question.settings),
    )
    return write(file)


def basis_data(basis: Basis) -> BasisSays:
    """Return what all claims are read with as data."""
    return BasisSays(
        sets=basis.set_names,
        options=basis.specification.options,
        parameters={name: str(x) for name, x in sorted(basis.all_values().items())},
        specs=tuple(Path(x.name).name for x in basis.library.files),
        horizon=basis.horizon,
        objective=basis.objective,
        vehicles={name: vehicle_data(x) for name, x in basis.vehicles.items()},
    )


def read_question(folder: Path, given: Sequence[Path] = ()) -> Question[Any]:
    """Return the question whose answers a folder holds.

    ``given``: specification files that lie below those in the folder, where it was asked with others than
    these alone. Raises ``InputError``.
    """
    path = folder / QUESTION
    content = read_json(path, LARGEST_INDEX)
    file = read(QuestionFile, content, str(path))
    kinds = entries("questions")
    if file.question not in kinds:
        raise InputError(f"{path}: question='{file.question[:40]}' is none of {', '.join(sorted(kinds))}")
    stored = file.basis
    library = _library_of(content, path, folder, given)
    specification = library.select(stored.sets[0], stored.options)
    values = {name: Fraction(x) for name, x in stored.parameters.items()}
    basis = Basis(
        specification,
        stored.sets,
        values,
        stored.horizon,
        objective=stored.objective,  # type: ignore[arg-type]
        vehicles=vehicles_of(stored.vehicles),
    )
    made: Callable[[Basis, object, str], Question[Any]] = imported("questions", file.question).of
    return made(basis, file.asked, f"{path}, asked")


def _library_of(content: object, path: Path, folder: Path, given: Sequence[Path]) -> Library:
    """Return the definitions that a question was asked with, on ``given`` files where it needs any."""
    fields = Fields(_mapping(content)["basis"], str(path))
    try:
        library, _ = load_specs_beside(fields, folder, ())
    except InputError:
        if not given:
            raise
    else:
        if not given or library.fingerprint == library_of(Fields(content, str(path))):
            return library
    return load_specs_beside(fields, folder, given)[0]


def _mapping(content: object) -> JsonObject:
    assert isinstance(content, dict)
    return content
