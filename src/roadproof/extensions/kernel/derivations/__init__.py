"""Derivations of formulas on drives, in steps that proofs/kernel/Shown.v checks. Nothing here is trusted."""
