"""The prover: a claim about all drives, in dense time, with a certificate or a counterexample.

Imports solve and evidence; never encode.
"""
