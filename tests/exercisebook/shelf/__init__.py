"""A small book of mechanics and heat, with an exercise of each sort, for the tests of what a book's exercises do."""

from exercisebook.bank import Bank

BANK = Bank(__name__)
exercise, progress = BANK.exercise, BANK.progress
