#!/usr/bin/env python3
"""bench/criteria_for_robots.py [--robots 12] [--candidates 300] [--arms WORD] [--criteria A,B] [--seed 1] [--csv FILE]

Which criterion plans best for robots with effects that the fitted model lacks? Plans of N of the candidates by each
criterion, judged on the simulated robots of bench/ensemble.py at other configurations, against 200 random subsets: mean of
ln(error / random median), its worst tenth, and the share of random subsets that are better. numpy alone; an own search."""
import argparse
import csv
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np  # noqa: E402

import ensemble  # noqa: E402

NOISE = 60e-6  # what stays at a pose and is no effect, 1σ along an axis
TIMES = (1, 1.5, 2, 4, 10)
# `auto` of the program: o1, and from so many times the smallest number of poses on its bias without a truth.
AUTO_BIAS_FROM, AUTO_FEW, AUTO_MORE = 1.5, "o1", "smooth 2"


def kernel_features(f, length, count):
    """Pivoted Cholesky of exp(−|f − f'|²/2ℓ²) on the rows of f: n × count."""
    n = len(f)
    left, phi = np.ones(n), np.zeros((n, count))
    for k in range(count):
        i = int(np.argmax(left))
        if left[i] < 1e-6:
            break
        row = np.exp(-((f - f[i]) ** 2).sum(1) / (2 * length ** 2)) - phi @ phi[i]
        phi[:, k] = row / np.sqrt(left[i])
        left = np.maximum(0, left - phi[:, k] ** 2)
    return phi


def joint_features(pool, harmonics=2):
    """cos and sin of each joint and of its multiples, of variance 1 together."""
    low, high = pool.arm.limits.T
    angle = np.where(pool.arm.sliding, np.pi * (pool.q - low) / (high - low), pool.q)
    waves = [wave(k * angle) for k in range(1, harmonics + 1) for wave in (np.cos, np.sin)]
    return np.hstack(waves) / np.sqrt(harmonics * angle.shape[1])


class Problem:
    """Candidates of one arm with whitened J and the prior information on parameters with tolerances."""

    def __init__(self, pool):
        self.pool = pool
        self.J = pool.J / NOISE
        self.n, self.r, self.m = self.J.shape
        self.shift = np.tile(np.eye(3), (self.r // 3, 1))
        self.place, self.there = self.J, self.shift
        columns = pool.raw.shape[2]
        # Base and targets may be anywhere.
        flat = np.zeros(columns)
        flat[:6] = flat[6 + 6 * pool.arm.joints:] = 1
        unit = np.linalg.norm(pool.basis, axis=1)
        unit[unit == 0] = 1
        scale = np.full(columns, pool.LENGTH)
        for block in range(pool.arm.joints + 1):
            scale[6 * block:6 * block + 3] = pool.ANGLE
        V = pool.basis / scale[:, None]
        self.known = V.T @ ((1 - flat)[:, None] * V)
        self.weak = 1e-6 * np.eye(self.m)
        self.nuisance = np.linalg.svd(V[flat == 1].T, full_matrices=False)[0]
        self.finish()

    def finish(self):
        self.B = np.einsum("nrk,nrl->kl", self.place, self.place) / (self.n * self.place.shape[1])


class Determinant:
    def __init__(self, problem, prior, nuisance):
        self.J, self.P = problem.J, problem.known if prior else problem.weak
        self.N = problem.nuisance if nuisance else None
        self.base = np.einsum("nrk,kb->nrb", self.J, self.N) if nuisance else None

    def begin(self, S):
        self.M = self.P + np.einsum("nrk,nrl->kl", self.J[S], self.J[S])

    def move(self, i, sign):
        self.M = self.M + sign * self.J[i].T @ self.J[i]

    def scan(self):
        """Value with each candidate added."""
        r = self.J.shape[1]
        V = np.linalg.inv(self.M + 1e-9 * np.eye(len(self.M)))
        value = np.linalg.slogdet(np.eye(r) + np.einsum("nrk,nsk->nrs", self.J @ V, self.J))[1] - np.linalg.slogdet(V)[1]
        if self.N is not None:
            W = np.linalg.inv(self.N.T @ self.M @ self.N)
            value -= np.linalg.slogdet(np.eye(r) + np.einsum("nrk,nsk->nrs", self.base @ W, self.base))[1]
            value += np.linalg.slogdet(W)[1]
        return value


class MeanSquare:
    """−Σ weight · ln(mean squared error, at the candidates, of the plain fit under effects F u, u ~ N(0, τ² I))."""

    def __init__(self, problem, prior, scenarios):
        self.J, self.P, self.B = problem.J, problem.known if prior else problem.weak, problem.B
        self.n, self.r, self.m = self.J.shape
        self.scenarios = scenarios  # list of (weight, τ, F n × rows × p, of the places n × rows × p, share held)
        count = self.n * problem.place.shape[1]
        self.D = [np.einsum("nrm,nrp->mp", problem.place, there) / count for *_, there, _ in scenarios]
        self.whole = [(there ** 2).sum() / count for *_, there, _ in scenarios]

    def begin(self, S):
        self.M = self.P + np.einsum("nrk,nrl->kl", self.J[S], self.J[S])
        self.G = [np.einsum("nrm,nrp->mp", self.J[S], F[S]) for _, _, F, _, _ in self.scenarios]

    def move(self, i, sign):
        self.M = self.M + sign * self.J[i].T @ self.J[i]
        for s, (_, _, F, _, _) in enumerate(self.scenarios):
            self.G[s] = self.G[s] + sign * self.J[i].T @ F[i]

    def scan(self):
        V = np.linalg.inv(self.M + 1e-9 * np.eye(self.m))
        JV = self.J @ V
        inverse = np.linalg.inv(np.eye(self.r) + np.einsum("nrk,nsk->nrs", JV, self.J))
        Q = np.einsum("nrk,nsk->nrs", JV @ self.B, JV)
        plain = np.trace(self.B @ V) - np.einsum("nrs,nsr->n", inverse, Q)
        total = 0
        for s, (weight, tau, F, _, held) in enumerate(self.scenarios):
            value = (1 + tau ** 2 * (1 - held)) * plain + tau ** 2 * (1 - held)
            if tau > 0:
                X = V @ self.G[s]
                rho = inverse @ (F - self.J @ X)
                base = np.sum(X * (self.B @ X)) - 2 * np.sum(X * self.D[s]) + self.whole[s]
                first = np.sum((JV @ (self.B @ X - self.D[s])) * rho, (1, 2))
                second = np.einsum("nrs,nrs->n", Q, rho @ rho.transpose(0, 2, 1))
                value = value + tau ** 2 * (base + 2 * first + second)
            total = total - weight * np.log(np.maximum(value, 1e-300))
        return total


def exchange(criterion, S, passes=4):
    """Best single exchanges until none gains."""
    S = list(S)
    criterion.begin(S)
    for _ in range(passes):
        gained = False
        for k in range(len(S)):
            old = S[k]
            criterion.move(old, -1)
            value = criterion.scan()
            kept = value[old]
            taken = S[:k] + S[k + 1:]
            value[taken] = -np.inf
            best = int(np.argmax(value))
            if value[best] > kept + 1e-9:
                S[k], gained = best, True
            criterion.move(S[k], +1)
        if not gained:
            break
    return S


def shifts(problem, phi):
    """Effect that shifts the tip along each axis by features φ of the configuration."""
    p = phi.shape[1]
    F = np.einsum("rd,np->nrdp", problem.shift, phi).reshape(problem.n, problem.r, 3 * p)
    there = np.einsum("rd,np->nrdp", problem.there, phi).reshape(problem.n, -1, 3 * p)
    return F, there, (phi ** 2).sum(1).mean()


class WithEffect:
    """Problem whose fit estimates an effect of this size, too."""

    def __init__(self, problem, size, F, there, _):
        columns = size * there
        self.J = np.concatenate([problem.J, size * F], 2)
        self.place = np.concatenate([problem.place, columns], 2)
        self.n, self.r, self.m = self.J.shape
        self.weak = np.eye(self.m)
        self.weak[:problem.m, :problem.m] = problem.weak
        self.B = np.einsum("nrk,nrl->kl", self.place, self.place) / (self.n * self.place.shape[1])


def turns(problem):
    """Effect in each joint's reading: two waves of the joint's own angle, all joints' alike, RMS 1 along an axis."""
    pool = problem.pool
    low, high = pool.arm.limits.T
    angle = np.where(pool.arm.sliding, np.pi * (pool.q - low) / (high - low), pool.q)
    columns = [pool.along(j) * wave(k * angle[:, j])[:, None]
               for j in range(pool.arm.joints) for k in (1, 2) for wave in (np.cos, np.sin)]
    F = np.stack(columns, 2)
    there = F[:, :len(problem.there)]
    unit = np.sqrt((there ** 2).sum(2).mean())
    return F / unit, there / unit, 1.0


def criteria(problem):
    """By name; an effect's size is in units of the noise. `smooth 2` is the program's criterion bias without a truth,
    `variance` its test_pose at the candidates, `estimated 2` the same for a fit that estimates the effect, too.
    main() adds `auto`, which is one of them at each number of poses."""
    none = (np.zeros((problem.n, problem.r, 1)), np.zeros((problem.n, len(problem.there), 1)), 1.0)
    table = {"o1": Determinant(problem, False, False), "ds": Determinant(problem, False, True),
             "o1 prior": Determinant(problem, True, False), "variance": MeanSquare(problem, False, [(1, 0, *none)])}
    effects = {"smooth": shifts(problem, kernel_features(problem.pool.f, np.pi / 3, 32)),
               "shifts": shifts(problem, joint_features(problem.pool)), "turns": turns(problem)}
    for size in (1, 2):
        for name, effect in effects.items():
            table[f"{name} {size}"] = MeanSquare(problem, True, [(1, size, *effect)])
    estimated = WithEffect(problem, 2, *effects["smooth"])
    table["estimated 2"] = MeanSquare(estimated, False, [(1, 0, np.zeros((problem.n, problem.r, 1)), none[1], 1.0)])
    return table


class Judge:
    """RMS error at other configurations of the fit to subsets, one value per robot: noise exact, effects as drawn."""

    def __init__(self, problem, pool, test, robots, rng):
        self.p = problem
        self.L = test.J.reshape(-1, problem.m) / NOISE
        self.A = self.L.T @ self.L / len(self.L)
        low, high = np.log(ensemble.RATIO)
        drawn = [ensemble.effect([pool, test], rng) for _ in range(robots)]
        size = np.exp(rng.uniform(low, high, robots))
        self.size = size
        self.y = np.stack([s * own for (own, _), s in zip(drawn, size)], 2)
        self.b = np.stack([s * there for (_, there), s in zip(drawn, size)], 2).reshape(-1, robots)
        self.Lb, self.bb = self.L.T @ self.b / len(self.L), (self.b ** 2).mean(0)

    def __call__(self, S, prior):
        J = self.p.J[S].reshape(-1, self.p.m)
        M = J.T @ J + (self.p.known if prior else self.p.weak)
        V = np.linalg.inv(M + 1e-9 * np.eye(self.p.m))
        X = V @ (J.T @ self.y[S].reshape(len(J), -1))
        bias = np.sum(X * (self.A @ X), 0) - 2 * np.sum(X * self.Lb, 0) + self.bb
        return np.sqrt(np.trace(self.A @ V) + bias)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", type=int, default=12)
    parser.add_argument("--candidates", type=int, default=300)
    parser.add_argument("--arms", default="")
    parser.add_argument("--criteria", default="")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--subsets", type=int, default=200)
    parser.add_argument("--times", default=",".join(map(str, TIMES)))
    parser.add_argument("--csv")
    options = parser.parse_args()
    times = [float(t) for t in options.times.split(",")]
    rows = []
    for number, arm in enumerate(ensemble.arms()):
        if options.arms not in arm.name:
            continue
        rng = np.random.default_rng([options.seed, number])
        pool = ensemble.Pool(arm, options.candidates, rng)
        test = ensemble.Pool(arm, 200, rng, pool)
        problem = Problem(pool)
        judge = Judge(problem, pool, test, options.robots, rng)
        table = criteria(problem)
        for word in times:
            N = int(np.ceil(word * pool.smallest))
            subsets = [rng.choice(problem.n, N, replace=False) for _ in range(options.subsets)]
            random = {prior: np.array([judge(S, prior) for S in subsets]) for prior in (False, True)}
            start = exchange(Determinant(problem, True, False), subsets[0])
            plans = {name: exchange(criterion, start) for name, criterion in table.items()
                     if not options.criteria or name in options.criteria.split(",")}
            automatic = AUTO_MORE if word >= AUTO_BIAS_FROM else AUTO_FEW
            if automatic in plans:
                plans["auto"] = plans[automatic]
            for name, S in plans.items():
                for prior in (False, True):
                    error = judge(S, prior)
                    for i in range(options.robots):
                        others = random[prior][:, i]
                        rows.append((arm.name, word, N, name, prior, judge.size[i], error[i] / np.median(others),
                                     (others < error[i]).mean()))
        print(arm.name, pool.parameters, "parameters", flush=True)
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as file:
            out = csv.writer(file)
            out.writerow(("arm", "times", "poses", "criterion", "tolerances right", "size", "ratio", "better"))
            out.writerows(rows)
    names = list(dict.fromkeys(r[3] for r in rows))
    for prior in (False, True):
        print("\nfit with the tolerances" if prior else "\nplain fit")
        print(f"{'':16s}" + "".join(f"{'N = ' + format(t, 'g') + ' × smallest':>26s}" for t in times) + f"{'all':>26s}")
        for name in names:
            line = f"{name:16s}"
            for t in times + [None]:
                mine = [r for r in rows if r[3] == name and r[4] == prior and (t is None or r[1] == t)]
                ratio = np.log([r[6] for r in mine])
                better = np.array([r[7] for r in mine])
                line += f"  {np.mean(ratio):+.3f} {np.quantile(ratio, .9):+.3f} {100 * better.mean():3.0f} {100 * np.mean(better <= .1):3.0f} %"
            print(line)
    print("\nmean ln ratio, its worst tenth, mean share of random subsets that are better, share of robots where it is ≤ 10 %")


if __name__ == "__main__":
    main()
