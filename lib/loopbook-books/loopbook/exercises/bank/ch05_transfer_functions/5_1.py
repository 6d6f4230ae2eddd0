"""Python beside the page of exercise 5.1."""

from loopbook.transfer import poles as poles_of  # noqa: F401
