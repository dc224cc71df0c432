"""What an answer can rest on."""

from typing import TypeAlias

from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import Judged
from roadproof.evidence.refutation import Countermodel

Evidence: TypeAlias = Certificate | Judged | Countermodel
