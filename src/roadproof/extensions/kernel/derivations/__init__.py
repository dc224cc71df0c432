"""Why a formula is true of a drive, in steps that proofs/kernel/Shown.v checks. Nothing here is trusted."""
