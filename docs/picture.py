#!/usr/bin/env python3
"""Draws docs/stream.svg, which moves, from what `cargo run --release -- demo` leaves in morec-demo/. Standard library only.

    morec convert morec-demo/new/signals_2.mclip -o morec-demo/new/signals_2.bvh
    python3 docs/picture.py morec-demo docs/stream.svg 9.95 24.3    (from, to: seconds)
"""
import colorsys
import csv
import math
import pathlib
import sys

WIDTH, LEFT, RIGHT = 1120, 104, 28
FIGURES = 16
MOVES = 12
GROUND, SCALE = 222, 88  # y of the floor, pixels a metre
LANES = {"performed": 270, "recognised": 318}
BAR = 30
HUES = [212, 28, 140, 330, 265, 95, 0, 185]
TURN = math.radians(28)  # seen a little from the side, so that what moves forward is seen too


def read_bvh(path):
    """Joint names, parents, and for every frame the joints' positions."""
    words = path.read_text().split("MOTION")
    names, parents, offsets, channels, stack = [], [], [], [], []
    lines = iter(words[0].splitlines())
    in_end = False
    for line in lines:
        part = line.split()
        if not part:
            continue
        if part[0] in ("ROOT", "JOINT"):
            names.append(" ".join(part[1:]))
            parents.append(stack[-1] if stack else None)
            stack.append(len(names) - 1)
        elif part[0] == "End":
            in_end = True
        elif part[0] == "OFFSET" and not in_end:
            offsets.append([float(v) for v in part[1:4]])
        elif part[0] == "CHANNELS":
            channels.append(part[2:])
        elif part[0] == "}":
            if in_end:
                in_end = False
            else:
                stack.pop()
    table = words[1].split("\n")
    rate = 1 / float(next(line for line in table if line.startswith("Frame Time")).split()[-1])
    rows = [[float(v) for v in line.split()] for line in table if line[:1] in "-0123456789" and line.strip()]
    return names, rate, [pose(row, parents, offsets, channels) for row in rows]


def pose(row, parents, offsets, channels):
    values, positions, turns = iter(row), [], []
    for joint, parent in enumerate(parents):
        move, turn = list(offsets[joint]), IDENTITY
        for channel in channels[joint]:
            axis, value = "XYZ".index(channel[0]), next(values)
            if channel.endswith("position"):
                move[axis] = value
            else:
                turn = product(turn, rotation(axis, math.radians(value)))
        if parent is None:
            positions.append(move)
            turns.append(turn)
        else:
            positions.append([p + q for p, q in zip(positions[parent], apply(turns[parent], move))])
            turns.append(product(turns[parent], turn))
    return positions


IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def rotation(axis, angle):
    sin, cos = math.sin(angle), math.cos(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m = [list(r) for r in IDENTITY]
    m[i][i], m[i][j], m[j][i], m[j][j] = cos, -sin, sin, cos
    return m


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def apply(m, v):
    return [sum(m[i][k] * v[k] for k in range(3)) for i in range(3)]


CHAINS = [
    (["LeftUpLeg", "LeftLeg", "LeftFoot"], 5.5),
    (["RightUpLeg", "RightLeg", "RightFoot"], 5.5),
    (["LeftUpLeg", "RightUpLeg"], 5.5),
    (["Hips", "Neck"], 7.5),
    (["LeftArm", "RightArm"], 5.5),
    (["LeftArm", "LeftForeArm", "LeftHand"], 4.5),
    (["RightArm", "RightForeArm", "RightHand"], 4.5),
    (["Neck", "Head"], 4.5),
]


def seen(positions, x, unit):
    """Screen points of one pose, standing at `x`; the hips stay over `x`."""
    hips = positions[0]
    sin, cos = math.sin(TURN), math.cos(TURN)
    points = []
    for p in positions:
        dx, dz = p[0] - hips[0], p[2] - hips[2]
        points.append((x + (dx * cos + dz * sin) * unit, GROUND - p[1] * unit))
    return points


def line(points, width, colour, opacity=1.0):
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{path}" stroke="{colour}" stroke-width="{width}" opacity="{opacity}"/>'


def crown(neck, head):
    """The middle of the head, beyond its joint."""
    length = math.dist(neck, head) or 1
    return [h + (h - n) / length * 8 for h, n in zip(head, neck)]


def figure(names, poses, frame, rate, x, colour, unit):
    at = {name: i for i, name in enumerate(names)}
    points = seen(poses[frame], x, unit)
    out = []
    for hand in ("LeftHand", "RightHand"):
        past = range(max(0, frame - int(0.45 * rate)), frame + 1, 2)
        trail = [seen(poses[f], x, unit)[at[hand]] for f in past]
        out.append(line(trail, 2.2, colour, 0.35))
    for chain, width in CHAINS:
        out.append(line([points[at[name]] for name in chain], width, colour))
    top = crown(points[at["Neck"]], points[at["Head"]])
    out.append(f'<circle cx="{top[0]:.1f}" cy="{top[1]:.1f}" r="9.5" fill="{colour}" stroke="none"/>')
    return out


def animated(attribute, values, secs, extra=""):
    return f'<animate attributeName="{attribute}" dur="{secs:.2f}s" repeatCount="indefinite" values="{values}" {extra}/>'


def performer(names, poses, times, rate, place, secs, unit):
    """The performer as one who moves along with the playhead, `MOVES` poses a second."""
    at = {name: i for i, name in enumerate(names)}
    shown = [seen(poses[round(t * rate)], place(t), unit) for t in times]
    path = lambda points, chain: " ".join(f"{points[at[n]][0]:.0f},{points[at[n]][1]:.0f}" for n in chain)
    out = []
    for chain, width in CHAINS:
        values = [path(points, chain) for points in shown]
        move = animated("points", ";".join(values), secs)
        out.append(f'<polyline points="{values[0]}" stroke="#20262c" stroke-width="{width}">{move}</polyline>')
    heads = [crown(points[at["Neck"]], points[at["Head"]]) for points in shown]
    move = "".join(animated(a, ";".join(f"{h[k]:.0f}" for h in heads), secs) for k, a in enumerate(("cx", "cy")))
    out.append(f'<circle cx="{heads[0][0]:.0f}" cy="{heads[0][1]:.0f}" r="9.5" fill="#20262c" stroke="none">{move}</circle>')
    return out


def colour_of(hue, lightness, saturation):
    return "#" + "".join(f"{round(255 * v):02x}" for v in colorsys.hls_to_rgb(hue / 360, lightness, saturation))


def read_tsv(path):
    with path.open() as file:
        return list(csv.DictReader(file, delimiter="\t"))


def main():
    folder, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    begin, end = float(sys.argv[3]), float(sys.argv[4])
    clip = next((folder / "new").glob("*.bvh"))
    names, rate, poses = read_bvh(clip)
    secs = lambda row, key: float(row[key]) / rate
    truth = [(r["class"], secs(r, "start"), secs(r, "stop")) for r in read_tsv(folder / "truth.tsv")]
    found = [
        (r["class"], secs(r, "start"), secs(r, "stop"), secs(r, "reported_at"))
        for r in read_tsv(folder / "found.tsv")
    ]
    inside = lambda row: row[2] > begin and row[1] < end
    truth, found = list(filter(inside, truth)), list(filter(inside, found))
    classes = sorted({row[0] for row in truth} | {row[0] for row in found})
    hue = {c: HUES[i % len(HUES)] for i, c in enumerate(classes)}
    dark = lambda c: colour_of(hue[c], 0.40, 0.62)
    pale = lambda c: colour_of(hue[c], 0.86, 0.70)
    to_x = lambda s: LEFT + (min(max(s, begin), end) - begin) / (end - begin) * (WIDTH - LEFT - RIGHT)

    tall = max(p[names.index("Head")][1] for p in poses)
    unit = 1.62 / tall * SCALE
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} 388" width="{WIDTH}" height="388" role="img" '
        'font-family="Helvetica, Arial, sans-serif" font-size="14">',
        "<title>A stream of poses, what was performed in it, and what morec recognised</title>",
        f'<rect x="0.5" y="0.5" width="{WIDTH - 1}" height="387" rx="10" fill="#fcfcfb" stroke="#d9d9d4"/>',
        f'<line x1="{LEFT}" y1="{GROUND + 6}" x2="{WIDTH - RIGHT}" y2="{GROUND + 6}" stroke="#d9d9d4" stroke-width="2"/>',
        '<g fill="none" stroke-linecap="round" stroke-linejoin="round" opacity="0.45">',
    ]
    step = (end - begin) / FIGURES
    for i in range(FIGURES):
        at = begin + (i + 0.5) * step
        now = [row[0] for row in truth if row[1] <= at <= row[2]]
        colour = dark(now[0]) if now else "#9a9a94"
        out += figure(names, poses, round(at * rate), rate, to_x(at), colour, unit)
    count = round((end - begin) * MOVES)
    times = [begin + i / MOVES for i in range(count)]
    out.append('</g><g fill="none" stroke-linecap="round" stroke-linejoin="round">')
    out += performer(names, poses, times, rate, to_x, end - begin, unit)
    out.append("</g>")
    for name, y in [("stream", 160), *[(lane, y + 20) for lane, y in LANES.items()]]:
        out.append(f'<text x="18" y="{y}" fill="#55554f">{name}</text>')
    for lane, y in LANES.items():
        out.append(
            f'<rect x="{LEFT}" y="{y}" width="{WIDTH - LEFT - RIGHT}" height="{BAR}" rx="4" fill="#efefeb"/>'
        )
        for row in truth if lane == "performed" else found:
            x, width = to_x(row[1]), to_x(row[2]) - to_x(row[1])
            fill = pale(row[0]) if lane == "performed" else dark(row[0])
            ink = dark(row[0]) if lane == "performed" else "#ffffff"
            appears = ""
            if lane == "recognised":
                share = (row[3] - begin) / (end - begin)
                appears = animated("opacity", "0;1", end - begin, f'keyTimes="0;{share:.4f}" calcMode="discrete"')
            out.append(f"<g>{appears}")
            out.append(f'<rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="{BAR}" rx="4" fill="{fill}"/>')
            if lane == "performed" or width > 7.2 * len(row[0]) + 2:
                out.append(
                    f'<text x="{x + width / 2:.1f}" y="{y + 20}" text-anchor="middle" fill="{ink}">{row[0]}</text>'
                )
            if lane == "recognised":
                said = to_x(row[3])
                out.append(
                    f'<path d="M{said:.1f},{y + BAR + 2} l-5,9 h10 z" fill="{dark(row[0])}" stroke="none"/>'
                )
            out.append("</g>")
    for second in range(math.ceil(begin), math.floor(end) + 1):
        x = to_x(second)
        out.append(f'<line x1="{x:.1f}" y1="{GROUND + 6}" x2="{x:.1f}" y2="{GROUND + 12}" stroke="#b8b8b2"/>')
        if second % 2 == 0:
            out.append(
                f'<text x="{x:.1f}" y="{GROUND + 27}" text-anchor="middle" font-size="12" fill="#77776f">{second} s</text>'
            )
    out.append(
        f'<text x="{WIDTH - RIGHT}" y="377" text-anchor="end" font-size="12" fill="#77776f">'
        "▲ the moment of the report; grey: motion that is none of the classes</text>"
    )
    move = "".join(animated(attribute, f"{LEFT};{WIDTH - RIGHT}", end - begin) for attribute in ("x1", "x2"))
    out.append(f'<line x1="{LEFT}" x2="{LEFT}" y1="24" y2="352" stroke="#20262c" opacity="0.5">{move}</line>')
    out.append("</svg>")
    target.write_text("\n".join(out) + "\n")


main()
