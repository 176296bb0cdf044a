"""The scenes of tests/portability/grip_hash.c and wall_hash.c, call by call, through the Python binding. Prints their two lines."""
import handhold as hh

ROTATION = (0.70710678118654757, 0.0, 0.0, 0.70710678118654757)


def clamped(x: float) -> float:
    return 0.0 if x < 0.0 else 1.0 if x > 1.0 else x


def devices_at(t_s: float) -> hh.TrackingSample:
    swing = clamped(t_s - 1.0) - 2.0 * clamped(t_s - 1.5) + clamped(2.0 * t_s - 4.5)
    sample = hh.TrackingSample(time_s=t_s, head=((0.0, 1.6, 0.0),), grab=(t_s >= 0.5, t_s >= 0.5))
    sample.hands = [((-0.2 - 0.4 * swing, 1.4, -0.43), ROTATION), ((0.2, 1.4 - 0.3 * clamped(t_s - 1.0), -0.43), ROTATION)]
    return sample


def grip_scene() -> str:
    with hh.World() as world:
        world.body_add(name="wall", shape=world.shape_add_box((1.0, 2.0, 0.1)), pose=((0.95, 1.5, -0.6),))
        link = world.shape_add_capsule(0.03, 0.05)
        last = None
        for i in range(12):
            body = world.body_add(name=f"link{i}", kind=hh.HH_DYNAMIC, shape=link, mass_kg=0.5, pose=((-0.2, 1.4 + 0.125 * i, -0.52),))
            if i > 0:
                world.joint_add(kind=hh.HH_BALL, body_a=last, body_b=body, frame=((-0.2, 1.4 + 0.125 * i - 0.0625, -0.52),))
            last = body
        box = world.shape_add_box((0.15, 0.1, 0.12))
        hull = world.shape_add_hull([(0.0, 0.2, 0.0), (0.2, -0.1, 0.0), (-0.1, -0.1, 0.15), (-0.1, -0.1, -0.15)])
        for i in range(20):
            world.body_add(name=f"crate{i}", kind=hh.HH_DYNAMIC, shape=box if i % 2 == 0 else hull, mass_kg=1.0 + 0.25 * i,
                           pose=((0.3 * (i % 5) - 0.6, 0.5 + 0.35 * (i // 5), -1.5),),
                           velocity_mps=(0.1 * (i % 3) - 0.1, 0.02 * i - 0.2, 0.3 - 0.03 * i), angular_velocity_radps=(0.5, 0.1 * i, -0.3))
        player = world.player_add(name="you")
        world.use_wrists(player)
        for frame in range(1, 271):
            world.step_player(1.0 / 90.0, player, [devices_at(frame / 90.0)])
        hands = world.player_pose(player).hands
        return f"0x{world.hash():016x} grips {hands[0].grip} {hands[1].grip}"


WALL_Z_M = -0.5
DT_S = 1.0 / 90.0


class Plane(hh.Surfaces):
    """The host's only surface."""

    wall = None

    def is_skipped(self, skip) -> bool:
        return any(one == self.wall for one in skip)

    def hit(self, x, y, distance_m):
        return hh.SurfaceHit(body=self.wall, point=(x, y, WALL_Z_M), normal=(0.0, 0.0, 1.0), distance_m=distance_m)

    def cast_ray(self, start, end, skip):
        if self.is_skipped(skip) or start.z < WALL_Z_M or end.z >= WALL_Z_M:
            return None
        part = (start.z - WALL_Z_M) / (start.z - end.z)
        return self.hit(start.x + part * (end.x - start.x), start.y + part * (end.y - start.y), 0.0)

    def closest_point(self, point, max_distance_m, skip):
        distance_m = 0.0 if point.z < WALL_Z_M else point.z - WALL_Z_M
        return None if self.is_skipped(skip) or distance_m > max_distance_m else self.hit(point.x, point.y, distance_m)

    def closest_point_on(self, body, point):
        return self.closest_point(point, 1e9, []) if body == self.wall else None


def wall_scene() -> str:
    with hh.World() as world:
        plane = Plane()
        world.set_surfaces(plane)
        plane.wall = world.body_add(name="wall", pose=((0.0, 1.5, WALL_Z_M),))
        player = world.player_add(name="you")
        world.use_wrists(player)
        grabs = 0
        for frame in range(1, 181):
            t_s = frame / 90.0
            sample = hh.TrackingSample(time_s=t_s, head=((0.0, 1.6, 0.0),), grab=(0, t_s >= 0.5))
            sample.hands = [((-0.2, 1.4, -0.43), ROTATION), ((0.2, 1.4, -0.43 + 0.2 * clamped(2.0 * (t_s - 1.0))), ROTATION)]
            world.begin_step(DT_S, [hh.PlayerInput(player=player, samples=[sample])])
            motion = world.player_motions()[0]
            start, speed = motion["origin"], motion["velocity_mps"]
            end = [start[axis] + DT_S * speed[axis] for axis in "xyz"]
            for hand in world.hand_constraints():
                end = [hand["anchor_end"]["position"][axis] - hand["target"]["position"][axis] for axis in "xyz"]
            world.end_step([hh.SolvedPlayer(player, end, [(e - start[axis]) / DT_S for e, axis in zip(end, "xyz")])])
            grabs += sum(event["kind"] == hh.HH_EVENT_GRABBED for event in world.events())
        moved_mm = -1000.0 * world.player_pose(player).origin.position.z
        return f"0x{world.hash():016x} grabs {grabs} moved_mm {moved_mm:.3f}"


if __name__ == "__main__":
    print(grip_scene())
    print(wall_scene())
