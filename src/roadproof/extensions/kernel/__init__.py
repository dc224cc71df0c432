"""Proofs checked by Coq, for those who trust no solver."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Proofs checked by Coq",
    audience="researchers",
    page="docs/how-to/solvers.md",
    kernels=("asking:KERNELS",),
)
