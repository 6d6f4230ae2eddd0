"""What several exercises of chapter 12 need."""

#: Other names under which one knows the signals of the tank, as Figure 12.2 has them.
TANK_NAMES = {
    "start": ["button", "S"],
    "level": ["h", "LT1", "L"],
    "temperature": ["T", "TT1", "temp"],
    "inlet": ["V1", "u_valve_in", "inflow"],
    "outlet": ["V2", "u_valve_out", "drain", "discharge"],
    "heater": ["u_heat", "heating", "heating element"],
}


def listed(names):
    """Names in a sentence."""
    return ", ".join(names)


def written(lines, **numbers):
    """The lines of a chart with numbers in the places of their names; an empty line is none."""
    return "\n".join(lines).format(**{name: f"{float(x):g}" for name, x in numbers.items()}).replace("\n\n", "\n")
