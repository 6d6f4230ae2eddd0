"""Words that mean the same in control engineering."""

from exercisebook.kinds.words import also_said

also_said(
    "setpoint, reference, reference value, desired value, set value, SP",
    "control error, error, error signal, control deviation",
    "control signal, controller output, manipulated variable, MV",
    "disturbance, load, load disturbance",
    "process output, process variable, controlled variable, PV",
    "measurement noise, sensor noise, noise of the measurement",
    "unstable, not stable, instable",
    "direct, direct acting, direct action",
    "reverse, reverse acting, reverse action",
    "indicator, indicating",
    "controller, controlling",
    "transmitter, transmitting",
    "IAE, integral of the absolute error",
    "ISE, integral of the squared error",
    "ITAE, integral of time weighted absolute error",
    "more sluggish, sluggish, slower",
    "P, P controller",
    "PI, PI controller",
    "PD, PD controller",
    "PID, PID controller",
    "check valve, non return valve, one way valve",
    "column with trays, plate column",
    "hydraulic signal, hydraulic line",
    "pneumatic signal, pneumatic line",
    "hand valve, manual valve",
    "safety valve, relief valve",
)
