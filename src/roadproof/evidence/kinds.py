"""What an answer can rest on."""

from typing import TypeAlias

from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.refutation import Countermodel

Evidence: TypeAlias = Certificate | JudgedDrive | Countermodel
