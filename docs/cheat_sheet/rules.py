"""The sections with settings of controllers: each is what a rule of the library returns for letters."""

import functools

import sympy
from sympy import symbols

from cheat_sheet.formulas import latex
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
from loopbook.transfer import (
    first_order,
)
from loopbook.tuning import (
    cohen_coon,
    good_gain,
    itae,
    modified_ziegler_nichols,
    simc,
    tyreus_luyben,
    ziegler_nichols_reaction,
    ziegler_nichols_ultimate,
)


def skogestad():
    models = (
        SOPDT(K, T1, delay=theta), SOPDT(K, sympy.oo, delay=theta), SOPDT(K, T1, T2, theta),
        SOPDT(K, sympy.oo, T2, theta), SOPDT(K, sympy.oo, sympy.oo, theta),
    )  # fmt: skip
    rows = []
    for model in models:
        settings = simc(model, Tc, c)
        rows.append((undelayed(model.expr), *(sympy.factor(x) for x in (settings.Kp, settings.Ti, settings.Td))))
    note = r"$T_c = \theta$ if nothing else is known; $c = 4$, or less for loads to be forgotten sooner."
    header = (r"process, and $e^{-\theta s}$", "$K_p$", "$T_i$", "$T_d$")
    return Section("Skogestad's settings (SIMC), serial form", "10_tuning", tuple(rows), header, note)


def undelayed(H):
    return H.subs(theta, 0)


@functools.cache
def imc_row(name):
    """Model, integral time, K*Kp/Ti, Td*Ti and filter of a row of the IMC table, in the letters of the sheet."""
    model, approximation = IMC_TABLE[name]
    settings = imc(model, Tc, **({"approximation": approximation} if approximation else {}))
    renamed = {symbols(old, positive=True): new for old, new in (("delay", theta), ("T1", T1), ("T2", T2), ("T3", T3))}
    # rows K and L have a zero: theirs are short in tau = T3*theta/(Tc + T3 + theta)
    long = {Tc: T3 * theta / tau - T3 - theta} if name in "KL" else {}
    ratio = symbols("K", positive=True) * settings.Kp / settings.Ti
    integral, product = (sympy.factor(x.subs(renamed).subs(long)) for x in (settings.Ti, settings.Td * settings.Ti))
    gain = 1 / sympy.factor(ratio.subs(renamed))
    return model.subs(renamed), sympy.expand(integral), gain, product, settings.Tf.subs(renamed)


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


def experiments():
    def row(name, rule):
        return (name, rule.Kp, "" if rule.Ti == sympy.oo else rule.Ti, "" if rule.Td == 0 else rule.Td)

    rows = (
        *(row(f"Ziegler-Nichols {kind}", ziegler_nichols_ultimate(Ku, Pu, kind)) for kind in ("P", "PI", "PID")),
        row("some overshoot", modified_ziegler_nichols(Ku, Pu, "some")),
        row("no overshoot", modified_ziegler_nichols(Ku, Pu, "none")),
        *(row(f"Tyreus-Luyben {kind}", tyreus_luyben(Ku, Pu, kind)) for kind in ("PI", "PID")),
        *(row(f"Good Gain {kind}", good_gain(KpGG, Tou, kind)) for kind in ("PI", "PID")),
    )
    note = f"A relay of amplitude $d$ that makes the output swing by $\\pm A$ tells $K_u = {latex(RELAY, flat=True)}$."
    header = ("experiment in the loop", "$K_p$", "$T_i$", "$T_d$")
    return Section("Settings from experiments", "16_tuning_relations", rows, header, note)


def in_r(settings):
    """K*Kp, Ti/theta and Td/theta of a rule, in r."""
    scaled = (sympy.expand(K * settings.Kp), settings.Ti / theta, settings.Td / theta)
    return ["" if x in (sympy.oo, 0) else x.subs(theta, r * T) for x in scaled]


def reaction_curves():
    model = first_order(K, T, theta)
    rules = (("Ziegler-Nichols", ziegler_nichols_reaction), ("Cohen-Coon", cohen_coon))
    rows = tuple((f"{name} {kind}", *in_r(rule(model, kind))) for name, rule in rules for kind in ("P", "PI", "PID"))
    header = (r"$0.1 \leq r \leq 1$", "$K K_p$", r"$T_i/\theta$", r"$T_d/\theta$")
    return Section("Settings from a step response", "16_tuning_relations", rows, header)


def least_itae():
    model, rows = first_order(K, T, theta), []
    for name, mode in (("load", "regulator"), ("setpoint", "servo")):
        for kind in ("PI", "PID"):
            settings = itae(model, kind, mode)
            scaled = (x.subs(theta, r * T) for x in (K * settings.Kp, settings.Ti / T, settings.Td / T))
            rows.append((f"{name}, {kind}", *("" if x == 0 else x for x in scaled)))
    return Section("Least ITAE", "16_tuning_relations", tuple(rows), ("", "$K K_p$", "$T_i/T$", "$T_d/T$"))
