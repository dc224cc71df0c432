"""Certificates put to Coq, for those who trust no solver."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Proofs checked by Coq",
    audience="researchers",
    kernels=("asking:KERNELS",),
)
