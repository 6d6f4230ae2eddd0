"""What to ask oneself where words of control engineering are to choose from."""

from exercisebook.diagnoses.words import QUESTIONS

QUESTIONS += [
    (
        {"reverse", "direct"},
        "follow a rise of the measurement once round the loop: which way must the control signal go against it, "
        "and what does the actuator do with more signal?",
    ),
    ({"heating", "cooling"}, "does the measurement rise or fall when this actuator does more?"),
    ({"rises", "falls"}, "what changes first of what flows in and out, and in which direction?"),
    ({"stable", "unstable"}, "where do the poles of the closed loop lie?"),
    ({"overdamped", "underdamped"}, "how large is the damping, and are the poles real?"),
]
