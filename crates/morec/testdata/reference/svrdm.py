"""Figures of a prototype of the thesis's recogniser on made rows: see README.md.

pip install numpy numba; python svrdm.py FOLDER_OF_THE_PROTOTYPE > svrdm.json
"""
import json, sys
import numpy as np, numba as nb

sys.path.insert(0, sys.argv[1])
import thesis_2009 as proto

PIVOTS, REDUCED, CHUNK, RATE, ACCEPT = 3, 5, 16, 120.0, 0.92
CLASSES = ["a", "b", "c", "d", "e"]


@nb.njit
def longest(r, s, eps):
    """The prototype's nedr, but of equally cheap paths the longest."""
    m, n = len(r), len(s)
    cost = np.zeros((m + 1, n + 1), np.int64)
    steps = np.zeros((m + 1, n + 1), np.int64)
    for i in range(m + 1):
        for j in range(n + 1):
            if i == 0 or j == 0:
                cost[i, j] = steps[i, j] = i + j
                continue
            g = 0 if abs(r[i - 1] - s[j - 1]) <= eps else 1
            c, l = cost[i - 1, j - 1] + g, steps[i - 1, j - 1] + 1
            for a, b in ((i - 1, j), (i, j - 1)):
                if cost[a, b] + 1 < c or (cost[a, b] + 1 == c and steps[a, b] + 1 > l):
                    c, l = cost[a, b] + 1, steps[a, b] + 1
            cost[i, j], steps[i, j] = c, l
    return cost[m, n] / max(steps[m, n], 1)


printed = proto.nedr
differ = [0, 0]


def nedr(r, s, eps):
    # Rows and profiles are in single precision here and in morec.
    r, s, eps = np.asarray(r, np.float32), np.asarray(s, np.float32), np.float32(eps)
    found = longest(r, s, eps)
    differ[0] += 1
    differ[1] += found != printed(r.astype(float), s.astype(float), float(eps))
    return found


proto.nedr = nedr


class Thesis(proto.Thesis):
    def proj(self, raw):
        return super().proj(raw).astype(np.float32).astype(float)


def made(rng, frames, parts):
    """Smooth rows: a few sines a column."""
    t = np.arange(frames)[:, None] / RATE
    return sum(a * np.sin(2 * np.pi * f * t + p) for a, f, p in parts)


def whole(rows):
    """Thousandths, as the file keeps them."""
    return np.clip(np.round(rows * 1000), -1000, 1000).astype(int)


def rows_of(ints):
    return (ints / 1000).astype(np.float32).astype(float)


rng = np.random.default_rng(5)
dim = 4 * PIVOTS
shapes = {c: [(rng.uniform(-0.4, 0.4, dim), rng.uniform(0.2, 1.2, dim), rng.uniform(0, 6.3, dim)) for _ in range(2)] for c in CLASSES}
rest = rng.uniform(-0.3, 0.3, dim)


def perform(c, frames, spread):
    parts = [(a * (1 + spread * rng.normal(size=dim)), f * (1 + spread * rng.normal()), p + spread * rng.normal(size=dim)) for a, f, p in shapes[c]]
    envelope = np.sin(np.pi * (np.arange(frames) + 0.5) / frames)[:, None] ** 0.5
    return whole(rest + envelope * made(rng, frames, parts))


lengths = {"a": 100, "b": 128, "c": 150, "d": 176, "e": 210}
samples = [(perform(c, int(lengths[c] * rng.uniform(0.85, 1.15)), 0.04), c) for c in CLASSES for _ in range(5)]


def idle(frames):
    parts = [(rng.uniform(-0.05, 0.05, dim), rng.uniform(0.1, 0.5, dim), rng.uniform(0, 6.3, dim))]
    return whole(rest + made(rng, frames, parts))


# Samples as they were, on and off the grid of chunks, and new performances, with idling between them.
stream, truth = [idle(64)], []
order = [(i, "known") for i in rng.permutation(len(samples))[:9]] + [(c, "new") for c in CLASSES]
for n, (what, kind) in enumerate(order):
    rows, c = samples[what] if kind == "known" else (perform(what, lengths[what], 0.02), what)
    at = sum(map(len, stream))
    truth.append([at, at + len(rows), CLASSES.index(c), kind])
    stream += [rows, idle(int(rng.integers(10, 70)) if n % 2 else 32 - (at + len(rows)) % 16)]
stream = np.concatenate(stream)


def tree_parts(tree):
    vectors, nodes = [], []

    def rows(xs):
        vectors.extend(x.tolist() for x in xs)
        return list(range(len(vectors) - len(xs), len(vectors)))

    def visit(node):
        at = len(nodes)
        nodes.append(None)
        if isinstance(node, str):
            nodes[at] = {"leaf": CLASSES.index(node)}
            return at
        branch = {"sigma_full": node.sf, "exemplars": [rows(node.Aa), rows(node.Ab)],
                  "factor": [node.L[0, 0], node.L[1, 0], node.L[1, 1]], "sigma_reduced": node.sr,
                  "points": node.Z.tolist(), "weights": [node.w1.tolist(), node.w2.tolist()],
                  "classes": [sorted(map(CLASSES.index, side)) for side in node.desc]}
        branch["children"] = [visit(node.ca), visit(node.cb)]
        nodes[at] = {"branch": branch}
        return at

    visit(tree)
    return {"dim": len(vectors[0]), "vectors": [v for x in vectors for v in x], "nodes": nodes}


def segments(model, raw):
    """For every segment: start and stop chunk, values of the first directions, class, confidence."""
    a, found = model.proj(raw), []
    for stop in range(1, len(a) // CHUNK + 1):
        for chunks in range(4, min(20, stop) + 1):
            rows = a[(stop - chunks) * CHUNK:stop * CHUNK]
            w, v = model.eig((rows.T @ rows)[None])
            v = proto.fixsigns(v, model.W)
            x = model.fv(w, v)
            c = proto.classify(model.tree, x, ACCEPT)[0]
            conf = 0.0
            if c is not None:
                z, mean = rows @ v[0, 0], model.len[c]
                e = min(nedr(z, t, model.eps) for t in model.mv[c])
                conf = (1 - .9 / (1 + np.exp(-30 * e + 15))) * np.exp(-(len(z) - mean) ** 2 / (2 * (.25 * mean) ** 2))
            found.append((stop - chunks, stop, x[0], c, conf))
    return found


def figures(scaling, variant):
    model = Thesis(k=2, r=REDUCED, var=variant)
    model.fit([(rows_of(x), c) for x, c in samples], [rows_of(stream)] + [rows_of(x) for x, _ in samples])
    model.eps = np.float32(model.eps)
    found = segments(model, rows_of(stream))
    detections = model.stream(rows_of(stream), T=ACCEPT, chunk=CHUNK)
    centred = np.concatenate([rows_of(stream)] + [rows_of(x) for x, _ in samples]) - model.mu
    values = np.linalg.eigvalsh(centred.T @ centred)[::-1]
    profiles = [(c, z) for c in CLASSES for z in model.mv[c]]
    return {
        "scaling": scaling,
        "pca": {"mean": model.mu.tolist(), "axes": model.V.T.ravel().tolist(), "eigenvalues": np.maximum(values, 0).tolist(), "rows": len(centred)},
        "signs": model.W.ravel().tolist(),
        "tree": tree_parts(model.tree),
        "profiles": {"values": [round(float(v), 9) for _, z in profiles for v in z.astype(np.float32)], "lengths": [len(z) for _, z in profiles],
                     "classes": [CLASSES.index(c) for c, _ in profiles]},
        "mean_secs": [model.len[c] / RATE for c in CLASSES],
        "epsilon": float(model.eps),
        "features": [[s, e, [round(float(v), 9) for v in x]] for s, e, x, _, _ in found[::37]],
        "cells": [[s, e, CLASSES.index(c), round(float(v), 12)] for s, e, _, c, v in found if c is not None],
        "detections": [[int(s), int(e), CLASSES.index(c), round(float(v), 12)] for s, e, c, v, _ in detections],
    }


out = {"pivots": PIVOTS, "rate_hz": RATE, "chunk_frames": CHUNK, "accept": ACCEPT, "truth": truth,
       "stream": stream.ravel().tolist(), "models": [figures("unit_range", "01"), figures("singular_share", "eig")]}
json.dump(out, sys.stdout, separators=(",", ":"))
print(len(stream), "frames;", [(len(m["cells"]), len(m["detections"])) for m in out["models"]], "cells and detections;",
      f"{differ[1]} of {differ[0]} distances differ from the printed choice of path", file=sys.stderr)
