"""Which cut-ins, decelerations and cut-outs a driver model prevents: plates with drives on both sides.

Imports the drivers, whose formulas it searches and judges.
"""
