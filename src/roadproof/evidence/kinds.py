"""What an answer can rest on."""

from typing import TypeAlias

from roadproof.evidence.certificate import Certificate
from roadproof.evidence.countermodel import Countermodel
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.extensions.drivers.preventable.plate import BoundaryFile

Evidence: TypeAlias = Certificate | JudgedDrive | Countermodel | NoneWithinFile | BoundaryFile
