"""Python beside the page of exercise 7.3."""

from loopbook.pid import PID
from loopbook.transfer import step_response  # noqa: F401

from_panel = PID.from_panel
