"""Pictures of an estimated pose and the truth: from the front and from the right, in the true chest's frame, centred between the true
shoulders."""
import html

import numpy as np

PX_PER_M, WIDTH, HEIGHT, UP_M = 150.0, 230, 235, 0.8
HEAD_M = 0.1
TRUTH, OURS = ("#a9a9b0", 6.0), ("#0b6e4f", 2.5)


def seen(points_m, view):
    """Picture positions of points given as right, up and back in metres. From the front the right hand is on the left; from the right
    the person faces right."""
    across = -points_m[..., 0] if view == "front" else -points_m[..., 2]
    return np.stack([WIDTH / 2 + PX_PER_M * across, PX_PER_M * (UP_M - points_m[..., 1])], -1)


def about(yaw_deg, middle_m, points_m):
    """Points in a frame at middle_m that faces yaw (0: -Z, positive turns left)."""
    cosine, sine = np.cos(np.radians(yaw_deg)), np.sin(np.radians(yaw_deg))
    x, y, z = np.moveaxis(points_m - middle_m, -1, 0)
    return np.stack([cosine * x - sine * z, y, sine * x + cosine * z], -1)


def forward(xyzw):
    """-Z rotated by a quaternion."""
    x, y, z, w = xyzw
    return -np.array([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])


def line(points, style, opacity=1.0):
    color, width = style
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return (f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round" '
            f'opacity="{opacity}"/>')


def body(place, shoulders, elbows, hands, head, style):
    """The left arm (paler), then the right one; the shoulder line, and a line from its centre to the head."""
    neck = line([place(shoulders.mean(0)), place(head)], (style[0], 0.5 * style[1]))
    arms = [line([place(shoulders[side]), place(elbows[side]), place(hands[side])], style, opacity) for side, opacity in ((0, 0.6), (1, 1.0))]
    return neck + line([place(shoulders[0]), place(shoulders[1])], style) + "".join(arms)


def picture(recording, truth, estimate, row, caption):
    """Both views of one frame."""
    middle = truth.shoulder_m[:, row].mean(0)
    local = lambda points: about(truth.yaw_deg[row], middle, points)
    head, hands = local(recording.head_m[row]), local(recording.hand_m[:, row])
    look = local(recording.head_m[row] + 2.0 * HEAD_M * forward(recording.head_xyzw[row]))
    views = ""
    for left, view in ((0, "front"), (WIDTH, "right")):
        place = lambda point: seen(point, view)
        drawn = "".join(body(place, local(which.shoulder_m[:, row]), local(which.elbow_m[:, row]), hands, head, style)
                        for which, style in ((truth, TRUTH), (estimate, OURS)))
        (x, y), marks = place(head), "".join('<circle cx="{:.1f}" cy="{:.1f}" r="5" fill="#1c1c1e"/>'.format(*place(hand)) for hand in hands)
        skull = f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{PX_PER_M * HEAD_M:.1f}" fill="#ececf0"/>{line([(x, y), place(look)], ("#1c1c1e", 1.5))}'
        views += f'<g transform="translate({left} 0)">{skull}{drawn}{marks}<text x="6" y="14" class="tick">from the {view}</text></g>'
    return (f'<figure><svg viewBox="0 0 {2 * WIDTH} {HEIGHT}" role="img" aria-label="{html.escape(caption)}">{views}</svg>'
            f"<figcaption>{html.escape(caption)}</figcaption></figure>")
