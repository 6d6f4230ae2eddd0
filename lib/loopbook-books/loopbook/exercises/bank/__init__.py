"""The exercises of the chapters, a module each."""

from exercisebook.bank import Bank

BANK = Bank(__name__)
chapters, exercises, title = BANK.chapters, BANK.exercises, BANK.title
