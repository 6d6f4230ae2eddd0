"""The sections with settings of controllers: each is what a rule of the library returns for symbols."""

import functools

import sympy
from sympy import symbols

from cheat_sheet.letters import (
    T1,
    T2,
    T3,
    K,
    KpGG,
    Ku,
    Pu,
    T,
    Tc,
    Tou,
    c,
    r,
    tau,
    theta,
)
from cheat_sheet.section import Section
from cheat_sheet.stated import (
    RELAY,
)
from loopbook.approximation import SOPDT, pade
from loopbook.synthesis import IMC_TABLE, imc
from loopbook.tuning import RULES, simc
from plainmath.latex import latex


def skogestad():
    models = (
        SOPDT(K, T1, delay=theta), SOPDT(K, sympy.oo, delay=theta), SOPDT(K, T1, T2, theta),
        SOPDT(K, sympy.oo, T2, theta), SOPDT(K, sympy.oo, sympy.oo, theta),
    )  # fmt: skip
    rows = []
    for model in models:
        pid = simc(model, Tc, c)
        rows.append((undelayed(model.expr), *(sympy.factor(x) for x in (pid.Kp, pid.Ti, pid.Td))))
    note = r"$T_c = \theta$ if nothing else is known; $c = 4$, or less for loads to be forgotten sooner."
    header = (r"process, and $e^{-\theta s}$", "$K_p$", "$T_i$", "$T_d$")
    return Section("Skogestad's settings (SIMC), serial form", "10_tuning", tuple(rows), header, note)


def undelayed(H):
    return H.subs(theta, 0)


@functools.cache
def imc_row(name):
    """Model, integral time, K*Kp/Ti, Td*Ti and filter of a row of the IMC table, in the symbols of the sheet."""
    model, approximation = IMC_TABLE[name]
    pid = imc(model, Tc, **({"approximation": approximation} if approximation else {}))
    renamed = {symbols(old, positive=True): new for old, new in (("delay", theta), ("T1", T1), ("T2", T2), ("T3", T3))}
    # rows K and L have a zero: theirs are short in tau = T3*theta/(Tc + T3 + theta)
    long = {Tc: T3 * theta / tau - T3 - theta} if name in "KL" else {}
    ratio = symbols("K", positive=True) * pid.Kp / pid.Ti
    integral, product = (sympy.factor(x.subs(renamed).subs(long)) for x in (pid.Ti, pid.Td * pid.Ti))
    gain = 1 / sympy.factor(ratio.subs(renamed))
    return model.subs(renamed), sympy.expand(integral), gain, product, pid.Tf.subs(renamed)


def internal_model():
    rows = []
    for name in IMC_TABLE:
        model, integral, gain, product, _ = imc_row(name)
        approximation = IMC_TABLE[name][1]
        rows.append((name + ("*" if approximation is pade else ""), model, integral, gain, product))
    header = ("", "process", "$T_i$", r"$T_i/(K K_p)$", "$T_i T_d$")
    note = (
        r"*: by Pade, others by Taylor. I, J: filter $T_f = T_3$ besides. "
        r"K, L: $\tau = T_3 \theta/(T_c + T_3 + \theta)$."
    )
    return Section("Internal model control", "15_direct_synthesis", tuple(rows), header, note, small=True)


def settings(*needs):
    """What the rules for some needs give in the symbols of the sheet, all variants: {name: `PID`}."""
    values = {"K": K, "T": T, "delay": theta, "Ku": Ku, "Pu": Pu, "KpGG": KpGG, "Tou": Tou}
    return {
        name: rule.settings(values, **chosen)
        for rule in RULES.values()
        if rule.needs in needs
        for name, chosen in rule.variants.items()
    }


def row(name, *values):
    """A row of settings, without the terms that a controller does not have."""
    return name, *("" if x in (sympy.oo, 0) else x for x in values)


def experiments():
    found = settings("the ultimate gain and period", "the Good Gain experiment")
    rows = tuple(row(name, pid.Kp, pid.Ti, pid.Td) for name, pid in found.items())
    note = "A relay of amplitude $d$ with which the output oscillates by $\\pm A$ tells "
    note += f"$K_u = {latex(RELAY, flat=True)}$."
    header = ("experiment in the loop", "$K_p$", "$T_i$", "$T_d$")
    return Section("Settings from experiments", "16_tuning_relations", rows, header, note)


def in_r(name, pid, unit):
    """K*Kp, and the times in a unit, as functions of r."""
    values = (sympy.expand(K * pid.Kp), pid.Ti / unit, pid.Td / unit)
    return row(name, *(x.subs(theta, r * T) for x in values))


def reaction_curves():
    found = settings("a lag or an integrator with dead time")
    rows = tuple(in_r(name, pid, theta) for name, pid in found.items())
    header = (r"$0.1 \leq r \leq 1$", "$K K_p$", r"$T_i/\theta$", r"$T_d/\theta$")
    return Section("Settings from a step response", "16_tuning_relations", rows, header)


def lag_alone():
    found = settings("a lag with dead time")
    rows = tuple(in_r(name, pid, T) for name, pid in found.items())
    return Section(
        "Settings for a lag with dead time", "16_tuning_relations", rows, ("", "$K K_p$", "$T_i/T$", "$T_d/T$")
    )
