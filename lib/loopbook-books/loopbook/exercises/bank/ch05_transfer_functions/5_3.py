"""Python beside the page of exercise 5.3."""

from loopbook.transfer import initial_gain, static_gain, step_response  # noqa: F401
