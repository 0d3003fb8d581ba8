"""Reference figures of pose rows, principal components, kWAS and PPCA distances, in numpy and double precision.

    python3 pose_rows.py REFEREE_FOLDER > pose_rows.json

REFEREE_FOLDER holds clips/*.bvh (CMU skeleton, 120 Hz, a T-pose in frame 0) and labels.tsv. Written from the thesis (Bucur
2009: sections 3.4 to 3.6 and 4.2 to 4.4) alone, with whole matrices where the library goes clip by clip and frame by
frame. Only figures are printed, no motion but four pose rows of each signal clip.
"""
import csv, json, sys
import numpy as np

PIVOTS = ("Hips LHipJoint LeftUpLeg LeftLeg RHipJoint RightUpLeg RightLeg LowerBack Spine Spine1 "
          "LeftShoulder LeftArm LeftForeArm RightShoulder RightArm RightForeArm").split()
CLIPS = "basketball_1 basketball_3 jumping_1 running_1 signals_1 signals_2 signals_3 walking_01".split()
SIGNALS = ["signals_1", "signals_2", "signals_3"]


def mul(a, b):
    aw, av, bw, bv = a[:, :1], a[:, 1:], b[:, :1], b[:, 1:]
    w = aw * bw - (av * bv).sum(1, keepdims=True)
    return np.hstack([w, aw * bv + bw * av + np.cross(av, bv)])


def bvh(path):
    """Local quaternions (w first) by joint name, frames x 4; the skeleton's 16 pivots follow each other directly."""
    header, motion = open(path).read().split("MOTION")
    values = motion.split("\n", 3)[3].split()
    channels, joint = [], None
    for words in map(str.split, header.split("\n")):
        if words and words[0] in ("ROOT", "JOINT"):
            joint = words[1]
        elif words and words[0] == "CHANNELS":
            channels += [(joint, channel) for channel in words[2:]]
    table = np.array(values, float).reshape(-1, len(channels))
    rotations = {}
    for (joint, channel), column in zip(channels, table.T):
        if channel.endswith("rotation"):
            turn = np.zeros((len(column), 4))
            turn[:, 0] = np.cos(np.radians(column) / 2)
            turn[:, 1 + "XYZ".index(channel[0])] = np.sin(np.radians(column) / 2)
            rotations[joint] = mul(rotations[joint], turn) if joint in rotations else turn
    return rotations


def pose_rows(path):
    """Section 4.2: root as q(t+1) q*(t), the last repeated; children relative to their parents; signs continuous."""
    local = bvh(path)
    for q in local.values():
        q[0] = q[1]
    root = local["Hips"]
    turn = mul(root[1:], root[:-1] * [1, -1, -1, -1])
    turn *= np.where(turn[:, :1] < 0, -1, 1)
    columns = [np.vstack([turn, turn[-1]])]
    for name in PIVOTS[1:]:
        q = local[name]
        flips = np.where((q[1:] * q[:-1]).sum(1) < 0, -1, 1)
        first = -1 if q[0, 0] < 0 else 1
        columns.append(q * (first * np.concatenate([[1], np.cumprod(flips)]))[:, None])
    return np.hstack(columns)


def eigen(m):
    w, v = np.linalg.eigh(m)
    return np.maximum(w[::-1], 0), v[:, ::-1]


def kwas(a, b, k=12):
    (s, u), (l, v) = eigen(a.T @ a), eigen(b.T @ b)
    return sum((s[i] / s.sum() + l[i] / l.sum()) * abs(u[:, i] @ v[:, i]) for i in range(k)) / 2


def ppca(rows, start, first=150, ahead=150, step=10, quality=0.95, least=1e-10):
    """(row, H) of Algorithm 2's rounds from `start` on, with the full inverse covariance; r from the first round."""
    found, r, n = [], None, rows.shape[1]
    for end in range(start + first, len(rows) - ahead + 1, step):
        x = rows[start:end]
        mean = x.mean(0)
        w, v = eigen(np.cov(x.T))
        r = r or int(np.searchsorted(np.cumsum(w) / w.sum(), quality)) + 1
        noise = max(w[r:].sum() / (n - r), least)
        inverse = v @ np.diag(1 / np.concatenate([np.maximum(w[:r], noise), np.full(n - r, noise)])) @ v.T
        d = rows[end:end + ahead] - mean
        found.append([end, float(np.einsum("ij,jk,ik->i", d, inverse, d).mean())])
    return r, found


def main(folder):
    rows = {name: pose_rows(f"{folder}/clips/{name}.bvh") for name in CLIPS}
    everything = np.vstack(list(rows.values()))
    mean = everything.mean(0)
    values, axes = eigen((everything - mean).T @ (everything - mean))
    share = np.cumsum(values) / values.sum()
    reduced = {name: (x - mean) @ axes[:, :16] for name, x in rows.items()}
    samples = [(r["clip"], int(r["start"]), int(r["stop"]), r["class"])
               for r in csv.DictReader(open(f"{folder}/labels.tsv"), delimiter="\t") if r["clip"] in CLIPS]
    chosen = samples[::4]
    cut = [reduced[clip][start:stop] for clip, start, stop, _ in chosen]
    similar = [[i, j, kwas(cut[i], cut[j])] for i in range(len(cut)) for j in range(i + 1)]
    distances = {}
    for name in ("signals_1", "basketball_1", "basketball_3"):
        dims, h = ppca(rows[name], 0)
        distances[name] = {"dims": dims, "h": h}
    json.dump({
        "numpy": np.__version__,
        "clips": CLIPS,
        "pose_rows": {name: rows[name][100:104].tolist() for name in SIGNALS},
        "pca": {"rows": len(everything), "eigenvalues": values[:24].tolist(),
                "dims": {str(q): int(np.searchsorted(share, q)) + 1 for q in (0.9, 0.95, 0.99)}},
        "samples": [[clip, start, stop] for clip, start, stop, _ in chosen],
        "kwas": similar,
        "ppca": distances,
    }, sys.stdout, indent=None, separators=(",", ":"))
    print()


main(sys.argv[1])
