"""Exercises of any subject that respond to answers: numbers of one's own, kinds of answers, diagnoses, hints, forms.

A package that adds kinds of answers names a module in the entry points `exercisebook.plugins`: importing it registers
them.
"""
