"""The prover: decides claims about all drives in dense time, with a certificate or a countermodel.

Imports solve and evidence; never encode.
"""
