"""The symbols of the cheat sheet, as SymPy symbols."""

from sympy import symbols

K, T, T0, T1, T2, T3, theta, Tc, c = symbols("K T T_0 T_1 T_2 T_3 theta T_c c", positive=True)
Kp, Ti, Td, Tf, Ku, Pu, KpGG, Tou = symbols("K_p T_i T_d T_f K_u P_u K_pGG T_ou", positive=True)
zeta, beta, omega, sigma, a, r, tau, d, A = symbols("zeta beta omega sigma a r tau d A", positive=True)
C, G, G0 = symbols("C G G_0")
P, Q, rho, x, q, k, L, short = symbols(r"P Q rho x q k L \tilde{T}", positive=True)
