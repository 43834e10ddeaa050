"""Makes rgb_basis.csv: three smooth reflectances that stand for red, green and blue.

Between 0 and 1, adding up to 1, as smooth as possible (least squares of second differences of
values every 5 nm, splines between), and such that under the
white of `white()` they have exactly the colours of the sRGB primaries for the CIE 1931 observer. After I. Mallett and
C. Yuksel, Spectral Primary Decomposition for Rendering with sRGB Reflectance (2019).

    pip install numpy scipy quadprog; python3 make_basis.py

Also prints the constants of the white in src/spectrum/white.rs.
"""
import os
import numpy as np
import quadprog
from scipy.interpolate import CubicSpline
from scipy.optimize import fsolve

HERE = os.path.dirname(os.path.abspath(__file__))
cmf = np.loadtxt(os.path.join(HERE, "cie1931_2deg_1nm.csv"), delimiter=",")
nm, xyz = cmf[:, 0], cmf[:, 1:]

# Linear sRGB from XYZ, IEC 61966-2-1 primaries and D65 white (0.3127, 0.3290).
def column(x, y):
    return np.array([x / y, 1.0, (1 - x - y) / y])
primaries = np.stack([column(0.64, 0.33), column(0.30, 0.60), column(0.15, 0.06)], axis=1)
scale = np.linalg.solve(primaries, column(0.3127, 0.3290))
xyz_from_rgb = primaries * scale
rgb_from_xyz = np.linalg.inv(xyz_from_rgb)

# CODATA 2018, exact.
H, C, K = 6.62607015e-34, 299792458.0, 1.380649e-23
def planck(nm, kelvin):
    l = nm * 1e-9
    return 2 * H * C**2 / l**5 / np.expm1(H * C / (l * K * kelvin))

CENTRE, WIDTH = 540.0, 50.0
def white(kelvin, more):
    return planck(nm, kelvin) * (1 + more * np.exp(-0.5 * ((nm - CENTRE) / WIDTH) ** 2))
def off(p):
    XYZ = xyz.T @ white(6500 + 1000 * p[0], p[1])
    rgb = rgb_from_xyz @ XYZ
    rgb /= XYZ[1]
    return [rgb[0] - rgb[1], rgb[2] - rgb[1]]
p = fsolve(off, [0.0, 0.03], xtol=1e-15)
kelvin, more = 6500 + 1000 * p[0], p[1]
print(f"white: {kelvin!r} K, {more!r} more at {CENTRE} nm; off {off(p)}")
w = white(kelvin, more)
w /= xyz[:, 1] @ w

# Unknown at knots, smooth (twice differentiable) between them, given by the nanometre.
STEP = 5
knots = np.arange(nm[0], nm[-1] + 1, STEP)
n = len(knots)
between = CubicSpline(knots, np.eye(n), bc_type="natural")(nm)          # values at nm from those at knots
to_rgb = rgb_from_xyz @ (xyz * w[:, None]).T @ between                 # 3 × n
second = np.diff(np.eye(n), 2, axis=0)
# Where hardly anything is seen they are drawn towards the grey that is assumed beyond.
unseen = np.diag(1e-3 * ((knots < 385) | (knots > 760)))
G = np.kron(np.eye(3), second.T @ second + unseen) + 1e-9 * np.eye(3 * n)
pull = np.kron(np.ones(3), np.diag(unseen) / 3)
equal = [np.concatenate([to_rgb[j] if i == k else np.zeros(n) for k in range(3)]) for i in range(2) for j in range(3)]
value = [1.0 if i == j else 0.0 for i in range(2) for j in range(3)]
# The third follows from the sum.
for k in range(n):
    row = np.zeros(3 * n)
    row[[k, n + k, 2 * n + k]] = 1
    equal.append(row)
    value.append(1.0)
A = np.vstack([np.array(equal), np.kron(np.eye(3), between)])
b = np.concatenate([value, np.zeros(3 * len(nm))])
x = quadprog.solve_qp(G, pull, A.T, b, len(equal))[0].reshape(3, n)
to_rgb, x = rgb_from_xyz @ (xyz * w[:, None]).T, np.maximum(x @ between.T, 0)
print("least, greatest, sum off:", x.min(), x.max(), abs(x.sum(0) - 1).max())
print("colours off:", abs(x @ to_rgb.T - np.eye(3)).max())
with open(os.path.join(HERE, "rgb_basis.csv"), "w") as f:
    f.write("# nm, red, green, blue: reflectances of the sRGB primaries; made by make_basis.py\n")
    for k, row in zip(nm, x.T):
        f.write(f"{k:.0f},{row[0]:.12f},{row[1]:.12f},{row[2]:.12f}\n")
