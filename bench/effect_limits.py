#!/usr/bin/env python3
"""bench/effect_limits.py [--robots 66] [--seed 1] [--arms WORD]

May a calibration call its error small? The limit of docs/theory.md, eq. (51), (66) and (67), by numpy alone, on the simulated
robots of bench/ensemble.py with effects of 0 to 4 times the noise. Poses grow in the order of a greedy determinant; a robot is
done at the first number of poses whose limit is at most the required error. Per size of the effect: how often it is said,
how often falsely, and at how many times the smallest number of poses. Exit status 1 if falsely for more than 5 % of the robots
of a size (and three standard errors)."""
import argparse
import os
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np  # noqa: E402
from scipy.special import gammainc  # noqa: E402

import ensemble  # noqa: E402

SIZES = (0, 0.5, 1, 2, 4)
REQUIRED = (1, 2, 4, 8)  # times the noise of a reading, each for itself
TIMES = (1, 1.2, 1.5, 2, 3, 4)
LENGTHS = np.deg2rad([20, 60, 160])
EFFECTS, NOISES = np.geomspace(0.5, 16, 10), np.geomspace(1, 4, 12)
FULL = 5


def correlation(a, b, length):
    return np.exp(-((a[:, None] - b[None]) ** 2).sum(2) / (2 * length ** 2))


def covariance(K, a, b):
    """Of rows a (n × rows × twists) and b."""
    return np.einsum("ij,iru,jsu->irjs", K, a, b, optimize=True).reshape(a.shape[0] * a.shape[1], -1)


def twists(pool, at):
    """Derivatives of the targets along translations, and turns about their mean."""
    tips = pool.arm.place(pool.q[at])[2]
    d = tips - tips.mean(1, keepdims=True)
    turn = np.stack([np.cross(e, d) for e in np.eye(3)], 3).reshape(len(at), pool.rows, 3)
    return np.concatenate([np.broadcast_to(np.tile(np.eye(3), (d.shape[1], 1)), turn.shape), turn], 2)


class Limit:
    """Error at test configurations after a fit of some poses of the pool, readings in units of their noise."""

    def __init__(self, pool, test):
        self.pool, self.test, self.targets = pool, test, pool.rows // 3
        self.places = np.arange(0, len(test.q), 2)

    def of(self, poses, y):
        pool, m = self.pool, self.pool.parameters
        J = pool.J[poses].reshape(-1, m)
        Q, R = np.linalg.qr(J)
        G = np.linalg.solve(R, Q.T)
        r, freedom = y - Q @ (Q.T @ y), len(y) - m
        per_place = np.sqrt(len(self.places) * self.targets)
        L = self.test.J[self.places].reshape(-1, m) / per_place
        N = (L @ G) @ (L @ G).T
        here, there = twists(pool, poses), twists(self.test, self.places) / per_place
        weights, means, freedoms, power = [], [], [], None
        lever = np.linalg.norm(here[:, :, 3:]) / np.linalg.norm(here[:, :, :3])
        for length in LENGTHS:
            for turn in [0] + ([1 / lever] if lever > 1e-6 else []):
                size = np.array([1, 1, 1, turn, turn, turn])
                K = covariance(correlation(pool.f[poses], pool.f[poses], length), here * size, here * size)
                cross = L @ G @ covariance(correlation(pool.f[poses], self.test.f[self.places], length), here * size, there * size)
                E = L @ G @ K @ (L @ G).T - cross - cross.T + covariance(
                    correlation(self.test.f[self.places], self.test.f[self.places], length), there * size, there * size)
                P = K - Q @ (Q.T @ K)
                P -= (P @ Q) @ Q.T
                lam, V = np.linalg.eigh((P + P.T) / 2)
                lam, along = np.maximum(lam[::-1][:freedom], 0), (V[:, ::-1][:, :freedom].T @ r) ** 2
                if power is None:
                    power = min(1, FULL / max(1, lam.sum() ** 2 / max((lam ** 2).sum(), 1e-300) - FULL))
                share = np.where(np.arange(len(lam)) < FULL, 1, power)
                for tau in EFFECTS / np.sqrt(self.targets):
                    for s in NOISES:
                        v = s ** 2 + tau ** 2 * lam
                        weights.append(-(share * (np.log(v) + along / v)).sum() / 2)
                        mean = s ** 2 * np.trace(N) + tau ** 2 * np.trace(E)
                        squares = s ** 4 * (N ** 2).sum() + 2 * s ** 2 * tau ** 2 * (N * E).sum() + tau ** 4 * (E ** 2).sum()
                        means.append(mean)
                        freedoms.append(mean ** 2 / squares)
        return G @ y, quantile(np.array(weights), np.array(means), np.array(freedoms))


def quantile(log_weights, means, freedoms):
    w = np.exp(log_weights - log_weights.max())
    w /= w.sum()
    low, high = 0, np.sqrt(10 * means.max())
    for _ in range(40):
        u = (low + high) / 2
        low, high = (u, high) if (w * gammainc(freedoms / 2, u * u * freedoms / means / 2)).sum() < 0.95 else (low, u)
    return high


def greedy(pool, count, rng):
    """Poses by the determinant, each the best of 150."""
    M = 1e-6 * np.trace(pool.J[0].T @ pool.J[0]) * np.eye(pool.parameters)
    some, order = list(rng.permutation(len(pool.q))[:150]), []
    for _ in range(count):
        gains = [np.linalg.slogdet(np.eye(pool.rows) + pool.J[i] @ np.linalg.solve(M, pool.J[i].T))[1] for i in some]
        order.append(some.pop(int(np.argmax(gains))))
        M = M + pool.J[order[-1]].T @ pool.J[order[-1]]
    return np.array(order)


def run_robot(arm, rng):
    """Rows: size, required, said, true, times the smallest number of poses."""
    pool = ensemble.Pool(arm, 300, rng)
    test = ensemble.Pool(arm, 120, rng, within=pool)
    effect = ensemble.effect([pool, test], rng)
    x = np.linalg.lstsq(pool.J.reshape(-1, pool.parameters), effect[0].reshape(-1), rcond=None)[0]
    effect = [e - p.J @ x for e, p in zip(effect, (pool, test))]
    numbers = sorted({max(int(np.ceil(pool.smallest * t)), pool.smallest + 1) for t in TIMES})
    order, noise, limit = greedy(pool, numbers[-1], rng), rng.normal(size=(len(pool.q), pool.rows)), Limit(pool, test)
    for size in SIZES:
        steps = []
        for n in numbers:
            poses = order[:n]
            estimate, upper = limit.of(poses, (noise[poses] + size * effect[0][poses]).reshape(-1))
            missed = test.J @ estimate - size * effect[1]
            steps.append((n / pool.smallest, upper, np.sqrt((missed ** 2).sum() / (len(test.q) * limit.targets))))
        for required in REQUIRED:
            said = next((step for step in steps if step[1] <= required), None)
            yield size, required, said is not None, said is not None and said[2] > required, said[0] if said else np.nan


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--robots", type=int, default=66)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--arms", default="", help="those with this word in their name")
    options = parser.parse_args()
    arms = [arm for arm in ensemble.arms() if options.arms in arm.name]
    rows = []
    for i in range(options.robots):
        rows += run_robot(arms[i % len(arms)], np.random.default_rng([options.seed, i]))
        print(f"\r{i + 1} robots", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    rows, good = np.array(rows, float), True
    print("effect  required   said  falsely  median times the smallest number")
    for size in SIZES:
        for required in REQUIRED:
            own = rows[(rows[:, 0] == size) & (rows[:, 1] == required)]
            said = own[own[:, 2] == 1]
            print(f"{size:6g}  {required:8g}  {len(said) / len(own):5.0%}  {own[:, 3].mean():7.1%}  "
                  + (f"{np.median(said[:, 4]):.2g}" if len(said) else "-"))
            good &= own[:, 3].sum() <= 0.05 * len(own) + 3 * np.sqrt(0.05 * 0.95 * len(own))
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
