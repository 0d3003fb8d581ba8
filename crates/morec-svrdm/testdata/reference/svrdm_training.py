"""Writes svrdm_training.json: optima by outside solvers, and the support vector tree by a prototype.

    python svrdm_training.py PROTOTYPE.py > svrdm_training.json

PROTOTYPE.py is the reference prototype of the thesis's method (not in this repository). Needs numpy, scipy,
scikit-learn and numba; see README.md for the versions the stored file was made with.

The prototype's optimiser stops when no weight moves by 1e-5; here it goes on to 1e-12, so that what is compared are
the algorithms, not where they stop.
"""

import importlib.util
import itertools
import json
import sys

import numpy as np
from scipy.optimize import lsq_linear
from sklearn.svm import OneClassSVM

T, OTHER, C = 1.0, 0.4, 10.0


def load(path):
    spec = importlib.util.spec_from_file_location("prototype", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    loose = module.sor
    module.sor = lambda k, y, tau, c: loose(k, y, tau, c, 1e-12, 3_000_000)
    return module


def kernel(a, b, sigma):
    return np.exp(-((a[:, None] - b[None]) ** 2).sum(-1) / (2 * sigma**2))


def box(rng, m, sigma, side):
    """A machine's problem by scipy's BVLS, an active-set method for bounded least squares."""
    x = rng.normal(size=(m, 3)) + np.where(np.arange(m) < m // 2, 0.0, 0.7)[:, None]
    sides = (np.arange(m) >= m // 2).astype(int)
    y = np.where(sides == side, 1.0, -1.0)
    tau = np.where(sides == side, T, -OTHER)
    q = y[:, None] * y[None] * kernel(x, x, sigma)
    root = np.linalg.cholesky(q).T
    found = lsq_linear(root, np.linalg.solve(root.T, tau), (0, C), method="bvls", tol=1e-15, max_iter=10_000)
    alpha = found.x
    return {
        "vectors": x.tolist(), "sides": sides.tolist(), "side": side, "sigma": sigma,
        "alpha": alpha.tolist(), "objective": float(0.5 * alpha @ q @ alpha - tau @ alpha),
    }


def sphere(rng, m, sigma):
    """The enclosing sphere by libsvm: its one-class machine with nu = 1/m is the same problem for this kernel."""
    x = rng.normal(size=(m, 4))
    k = kernel(x, x, sigma)
    machine = OneClassSVM(kernel="precomputed", nu=1.0 / m, tol=1e-12).fit(k)
    alpha = np.zeros(m)
    alpha[machine.support_] = machine.dual_coef_[0]
    alpha /= alpha.sum()
    return {
        "vectors": x.tolist(), "sigma": sigma, "alpha": alpha.tolist(),
        "radius": float(np.sqrt(1 - alpha @ k @ alpha)),
    }


def width(p, x):
    return {"vectors": x.tolist(), "sigma": float(p.sigma_est(x))}


def branch(p, a, b, probes):
    node = p.train_node(a, b)
    holds = lambda x: np.flatnonzero(p.mes(p.rbf(x, x, node.sf), 200_000) > 1e-6).tolist()
    return {
        "sides": [a.tolist(), b.tolist()], "sigma_full": float(node.sf), "exemplars": [holds(a), holds(b)],
        "factor": [float(v) for v in (node.L[0, 0], node.L[1, 0], node.L[1, 1])], "sigma_reduced": float(node.sr),
        "points": node.Z.tolist(), "probes": probes.tolist(), "outputs": np.stack(p.node_out(node, probes), 1).tolist(),
    }


def best_split(p, classes):
    """The prototype's clustering must have found what trying every split finds."""
    names = list(classes)
    sigma = p.sigma_est(np.vstack(list(classes.values())))
    alpha = {c: p.svrm(x, sigma) for c, x in classes.items()}
    g = np.array([[alpha[i] @ p.rbf(classes[i], classes[j], sigma) @ alpha[j] for j in names] for i in names])
    spread = lambda q: g[np.ix_(q, q)].trace() - g[np.ix_(q, q)].sum() / len(q)
    every = []
    for bits in range(1, 2 ** (len(names) - 1)):
        on = np.array([i > 0 and bool(bits >> (i - 1) & 1) for i in range(len(names))])
        every.append((spread(np.flatnonzero(~on)) + spread(np.flatnonzero(on)), on))
    return min(every, key=lambda e: e[0]), names


def splits(p, node, classes):
    """Whether clustering found the best split at every branch."""
    if isinstance(node, str):
        return True
    (_, on), names = best_split(p, classes)
    best = {frozenset(n for n, o in zip(names, on) if o), frozenset(n for n, o in zip(names, on) if not o)}
    if best != {frozenset(node.desc[0]), frozenset(node.desc[1])}:
        return False
    children = zip((node.ca, node.cb), node.desc)
    return all(splits(p, child, {c: classes[c] for c in side}) for child, side in children)


def tree(p, seed, names, each, dim, spread):
    """A tree over clouds: two families of classes, classes apart within a family."""
    rng = np.random.default_rng(seed)
    families = rng.normal(scale=0.25, size=(2, dim))
    centres = [families[i % 2] + rng.normal(scale=0.12, size=dim) + 0.5 for i in range(len(names))]
    classes = {n: c + rng.normal(scale=spread, size=(each, dim)) for n, c in zip(names, centres)}
    root = p.build(classes, np.random.default_rng(seed))
    if not splits(p, root, classes):
        return None
    near = [x + rng.normal(scale=0.3 * spread, size=x.shape) for x in classes.values()]
    probes = np.vstack(list(classes.values()) + near + [0.5 + rng.normal(scale=0.2, size=(40, dim))])
    named = p.classify(root, probes, 0.92)
    return {
        "classes": [x.tolist() for x in classes.values()], "root": [sorted(names.index(c) for c in s) for s in root.desc],
        "probes": probes.tolist(), "named": [None if c is None else names.index(c) for c in named],
    }


def signs(p, rng, m, r):
    v = rng.normal(size=(m, 1, r)) * np.linspace(1, 0.3, r)
    v /= np.linalg.norm(v, axis=2, keepdims=True)
    w = p.fixsigns_fit(v)[0]
    return {"eigenvectors": v[:, 0].tolist(), "direction": w.tolist()}


def main():
    p = load(sys.argv[1])
    rng = np.random.default_rng(2009)
    cloud = lambda m, dim, at=0.0, s=1.0: at + s * rng.normal(size=(m, dim))
    trees = (tree(p, seed, list("abcdef"), 6, 6, 0.05) for seed in itertools.count(1))
    found = {
        "boxes": [box(rng, m, s, side) for m in (6, 15, 30) for s in (0.3, 1.0, 2.5) for side in (0, 1)],
        "spheres": [sphere(rng, m, s) for m in (3, 12, 25) for s in (0.5, 1.5, 4.0)],
        "widths": [width(p, cloud(m, dim)) for m in (2, 5, 9, 20) for dim in (2, 8)],
        "branches": [
            branch(p, cloud(m, 6, 0.4, 0.1), cloud(m + 2, 6, 0.6, 0.1), cloud(10, 6, 0.5, 0.15)) for m in (3, 6, 9)
        ],
        "trees": [next(t for t in trees if t is not None) for _ in range(2)],
        "signs": [signs(p, rng, m, r) for m, r in ((5, 4), (30, 16))],
    }
    json.dump(found, sys.stdout, separators=(",", ":"))
    print()


if __name__ == "__main__":
    main()
