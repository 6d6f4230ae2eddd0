"""Python beside the page of exercise 4.3."""

from loopbook.laplace import initial_value, inverse  # noqa: F401
