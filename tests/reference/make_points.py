#!/usr/bin/env python3
"""Writes points.json: apparent positions to 60 digits by a route of its own.

Solves the light cone in the world frame by the quadratic equation, with mpmath, and never uses the
light-cone formulas of the program. Needs: pip install mpmath. Run in this folder.
"""
import json
import random

import mpmath as mp

mp.mp.dps = 60
random.seed(20001)


def boost(u):
    g = mp.sqrt(1 + sum(c * c for c in u))
    L = mp.matrix(4, 4)
    L[0, 0] = g
    for i in range(3):
        L[0, i + 1] = L[i + 1, 0] = u[i]
        for j in range(3):
            L[i + 1, j + 1] = (1 if i == j else 0) + u[i] * u[j] / (1 + g)
    return L


def seen(u, x, A, O):
    """Apparent position relative to O, distance, Doppler factor."""
    u, x, A, O = ([mp.mpf(c) for c in v] for v in (u, x, A, O))
    L = boost(u)
    g = L[0, 0]
    # World line of the point: E(tau) = A + L (tau, x); solve (E - O)^2 = 0, earlier root.
    start = [A[i] - O[i] + sum(L[i, j + 1] * x[j] for j in range(3)) for i in range(4)]
    step = [L[i, 0] for i in range(4)]
    dot = lambda a, b: -a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    half, c = dot(start, step), dot(start, start)
    tau = half - mp.sqrt(half * half + c)  # step.step = -1
    E = [start[i] + tau * step[i] for i in range(4)]
    r = -E[0]
    # D = (k.u_observer)/(k.u_emitter) with k = E
    D = -r / dot(E, step) if r else mp.nan
    return E[1:], r, abs(1 / (dot(E, step) / E[0])) if r else mp.nan


def conditioning(u, x, A, O, exact, r):
    """Largest change of position over r when any one input moves by one unit in its last place."""
    worst = mp.mpf(0)
    for which in range(4):
        for i in range(len((u, x, A, O)[which])):
            for sign in (1, -1):
                inputs = [list(v) for v in (u, x, A, O)]
                c = inputs[which][i]
                if c == 0:
                    continue
                inputs[which][i] = mp.mpf(c) * (1 + sign * mp.mpf(2) ** -53)
                moved, _, _ = seen(*inputs)
                worst = max(worst, mp.sqrt(sum((a - b) ** 2 for a, b in zip(moved, exact))) / r)
    return worst


def direction():
    while True:
        v = [random.uniform(-1, 1) for _ in range(3)]
        n = sum(c * c for c in v) ** 0.5
        if 0.1 < n < 1:
            return [c / n for c in v]


rows = []
for kind in ("aligned", "general", "near axis", "slow", "near camera", "axis x"):
    for i in range(60):
        gamma = 10 ** random.uniform(0.01, 9)
        if kind == "slow":
            gamma = 1 + 10 ** random.uniform(-16, -3)
        speed = ((gamma - 1) * (gamma + 1)) ** 0.5 if kind != "slow" else 10 ** random.uniform(-9, -1)
        n = [random.choice((-1.0, 1.0)), 0.0, 0.0] if kind == "axis x" else direction()
        u = [float(c * speed) for c in n]
        x = [random.uniform(-5, 5) for _ in range(3)]
        A, O = [0.0] * 4, [0.0] * 4
        if kind == "general":
            A = [random.uniform(-8, 8) for _ in range(4)]
            O = [random.uniform(-8, 8) for _ in range(4)]
        if kind == "near axis":
            along = random.choice((-1, 1)) * 10 ** random.uniform(-1, 2)
            off = 10 ** random.uniform(-9, -2)
            side = direction()
            x = [along * n[j] + off * side[j] for j in range(3)]
        if kind == "near camera":
            x = [c * 1e-5 for c in x]
        E, r, D = seen(u, x, A, O)
        rows.append({
            "kind": kind, "u": u, "A": A, "O": O, "x_rest": x,
            "apparent": [float(c) for c in E], "r": float(r), "D": float(D),
            "condition": float(conditioning(u, x, A, O, E, r) * 2**53),
        })
        # The same with inputs that are exact in f32.
        u32 = rows[-1]
        import struct
        f = lambda v: struct.unpack("f", struct.pack("f", v))[0]
        u32["x_f32"] = [f(c) for c in x]
        E, r, D = seen(u, u32["x_f32"], A, O)
        u32["apparent_f32"] = [float(c) for c in E]
        u32["r_f32"], u32["D_f32"] = float(r), float(D)

note = ("X = L(u) X' + A, observer at O (all in one frame); apparent relative to O; condition: change of "
        "the apparent position over r per relative change of one input, worst input")
with open("points.json", "w") as out:
    out.write('{"note": %s, "rows": [\n' % json.dumps(note))
    out.write(",\n".join(json.dumps(row) for row in rows))
    out.write("\n]}\n")
