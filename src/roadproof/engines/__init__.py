"""Finders of proofs and drives. Others check their answers: certificates in evidence, drives in semantics.

May import evidence, semantics, library, world and logic.
"""
