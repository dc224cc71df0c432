"""The kinds of evidence that an answer can rest on."""

from typing import TypeAlias

from roadproof.evidence.answer_files import OwnEvidence
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.countermodel import Countermodel
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.none_within import NoneWithinFile

Evidence: TypeAlias = Certificate | JudgedDrive | Countermodel | NoneWithinFile | OwnEvidence
