"""Design instances: blocks n × r × m, by name. The same numbers on every machine, up to the last digits."""
import itertools

import numpy as np

import proved_optimum


def rotation(ax, ay, az):
    cx, sx, cy, sy, cz, sz = np.cos(ax), np.sin(ax), np.cos(ay), np.sin(ay), np.cos(az), np.sin(az)
    x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    return np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]) @ y @ x


def quadratic():
    """Full quadratic model, 5 factors on 7 levels: 1, x_i, x_i², x_i x_j."""
    g = np.array(list(itertools.product(np.linspace(-1, 1, 7), repeat=5)))
    pairs = [g[:, i] * g[:, j] for i in range(5) for j in range(i + 1, 5)]
    return np.column_stack([np.ones(len(g)), g, g ** 2, *pairs])[:, None]


def gaussian(n, r, m, seed):
    return np.random.default_rng(seed).standard_normal((n * r, m)).reshape(n, r, m)


def leg(p, R, a, b, u, length):
    q = p + R @ b - a
    along = u @ q
    rho = along - np.sqrt(along * along - (q @ q - length * length))
    e = (q - rho * u) / length
    own = R.T @ e
    return np.array([e[0], e[1], -own[0], -own[1], rho * e[0], 1.0])


def legs():
    for k in range(6):
        s = 1 if k % 2 else -1
        pa, pb = np.deg2rad(120 * (k // 2) + 20 * s), np.deg2rad(120 * (k // 2) + 35 * s)
        a = np.array([90 * np.cos(pa), 90 * np.sin(pa), 0.0])
        b = np.array([40 * np.cos(pb), 40 * np.sin(pb), 5.0])
        u = np.array([0.02 * np.cos(pa), 0.02 * np.sin(pa), 1.0])
        yield a, b, u / np.linalg.norm(u), 100.0


def platform(one_leg):
    """Six legs of constant length on sliders along z, random poses: one leg's rows, or all with their own columns."""
    rng, n = np.random.default_rng(20240003), 5000
    P = np.column_stack([rng.uniform(-2, 2, n), rng.uniform(-2, 2, n), rng.uniform(-0.2, 0.2, n)]) + [0, 0, 85.0]
    A = np.deg2rad(rng.uniform(-1, 1, (n, 3)))
    J = np.array([[leg(P[i], R, *own) for own in legs()] for i, R in enumerate(map(lambda a: rotation(*a), A))])
    J = J / np.linalg.norm(J, axis=0)
    if one_leg:
        return J[:, :1]
    blocks = np.zeros((n, 6, 36))
    for k in range(6):
        blocks[:, k, 6 * k:6 * k + 6] = J[:, k]
    return blocks


def study(*arguments):
    """Rows of the study whose optima bench/proved_optimum.py proves."""
    return proved_optimum.rows_of(*arguments)[:, None]


def make(name, *arguments):
    return np.ascontiguousarray({"quadratic": quadratic, "gaussian": gaussian, "platform": platform, "study": study}[name](*arguments))
