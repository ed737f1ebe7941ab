#!/usr/bin/env python3
"""Draws the calibration of `neve check --predict`: of each quantity the value expected, with its interval, against that of
the full run, for the cases that had no part in choosing the intervals. docs/prediction/make writes calibration.svg.
"""

import math

import fit

units = {"spread": "m", "height": "m", "mean_J_P": "", "largest_piece": "", "force": "N"}
logarithmic = {"spread", "height", "force"}
side, gap, left, top, columns = 250, 62, 58, 64, 3
ink, soft, inside, outside = "#1c2430", "#8a94a3", "#1f5fb0", "#d2601a"


class Scale:
    """Places of values on a square, the same across and up."""

    def __init__(self, values, is_log):
        self.to = math.log if is_log else lambda x: x
        low, high = self.to(min(values)), self.to(max(values))
        self.low, self.width = low - 0.04 * (high - low), 1.08 * (high - low)
        steps = [m * 10 ** e for e in range(-4, 6) for m in ((1, 2, 5) if is_log else (0.5, 1, 2, 4))]
        if not is_log:
            step = next(s for s in sorted(steps) if self.width / s < 6)
            steps = [k * step for k in range(-1, 40)]
        self.ticks = [t for t in sorted(set(steps)) if (t > 0 or not is_log) and 0 < self.at(t) < 1]

    def at(self, value):
        return (self.to(value) - self.low) / self.width


def panel(cases, metric, share, x0, y0):
    points = [(case.of(metric)[0], *case.estimate(metric, share), case.holds(metric, share)) for case in cases]
    least = min(min(p[:2]) for p in points) / 2  # a logarithm has no place for 0
    spans = [(true, expected, max(expected - half, least), expected + half, held) for true, expected, half, held in points]
    scale = Scale([v for p in spans for v in p[:4]], metric in logarithmic)
    px, py = (lambda v: x0 + side * scale.at(v)), (lambda v: y0 + side * (1 - scale.at(v)))
    unit = f" ({units[metric]})" if units[metric] else ""
    held = sum(p[4] for p in spans)
    out = [f'<rect x="{x0}" y="{y0}" width="{side}" height="{side}" fill="#f7f9fb" stroke="#c7ced8"/>',
           f'<text x="{x0}" y="{y0 - 8}" font-weight="bold">{metric.replace("_", " ")}{unit}: '
           f'{held} of {len(spans)} hold</text>',
           f'<line x1="{x0}" y1="{y0 + side}" x2="{x0 + side}" y2="{y0}" stroke="{soft}"/>']
    for tick in scale.ticks:
        out.append(f'<text x="{px(tick):.1f}" y="{y0 + side + 15}" text-anchor="middle" fill="{soft}">{tick:g}</text>')
        out.append(f'<text x="{x0 - 6}" y="{py(tick) + 4:.1f}" text-anchor="end" fill="{soft}">{tick:g}</text>')
    for true, expected, low, high, is_held in spans:
        color = inside if is_held else outside
        out.append(f'<line x1="{px(true):.1f}" y1="{py(low):.1f}" x2="{px(true):.1f}" y2="{py(high):.1f}" '
                   f'stroke="{color}" stroke-width="1.5" opacity="0.55"/>')
        out.append(f'<circle cx="{px(true):.1f}" cy="{py(expected):.1f}" r="2.8" fill="{color}"/>')
    return out


def svg(cases):
    names = list(fit.shares)
    rows = -(-len(names) // columns)
    width, height = left + columns * (side + gap) - gap + 16, top + rows * (side + gap)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
           f'font-family="DejaVu Sans, sans-serif" font-size="12" fill="{ink}">',
           f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
           f'<text x="16" y="26" font-size="15">Expected at full resolution (up), with its interval, against the full run '
           f'(across); {len(cases)} cases</text>']
    for k, metric in enumerate(names):
        out += panel(cases, metric, fit.shares[metric], left + k % columns * (side + gap), top + k // columns * (side + gap))
    x, y = left + (columns - 1) * (side + gap), top + (rows - 1) * (side + gap) + 40
    for line, (color, text) in enumerate([(inside, "the interval holds the full run"), (outside, "it does not"),
                                          (soft, "expected = full run")]):
        mark = (f'<line x1="{x}" y1="{y - 4}" x2="{x + 16}" y2="{y - 4}" stroke="{color}"/>' if line == 2
                else f'<circle cx="{x + 8}" cy="{y - 4}" r="4" fill="{color}"/>')
        out += [mark, f'<text x="{x + 26}" y="{y}">{text}</text>']
        y += 24
    return "\n".join(out + ["</svg>", ""])
